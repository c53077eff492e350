// SPDX-License-Identifier: Apache-2.0
#include "topologyRefiner.h"

#include "fvarLevel.h"
#include "polygonRefinement.h"
#include "sizeChecker.h"
#include "topologyRefinement.h"
#include "vertexFan.h"

#include <deque>

namespace OpenSubdivHex::FarExt {

using internal::LevelSizes;
using internal::LevelTopology;
using internal::SizeChecker;

namespace {

// Checks the sizes of the levels that hexagonal steps make from a level, all known from its own.
Status checkHexagonalSizes(LevelTopology const &pLevel, std::vector<SizeChecker> checkers,
                           int refinementLevel) {
    for (std::size_t i = 0; i < checkers.size(); ++i) {
        LevelSizes sizes = internal::GetSizes(i == 0 ? pLevel : pLevel.fvarLevels[i - 1]->topology);
        for (int level = pLevel.depth + 1; level <= refinementLevel; ++level) {
            sizes = internal::GetChildSizes(sizes);
            if (Status status = checkers[i].Add(sizes); !status.IsOk()) {
                return status;
            }
        }
    }
    return Status();
}

// What tells the sizes of the levels of other schemes.
struct SchemeSizes {
    LevelSizes sizes;
    std::int64_t interiorEdges;
    std::int64_t closedVertices; // with faces all around
    std::int64_t closedCorners;  // of these faces
    std::int64_t digons;         // closed vertices with two faces

    bool IsClosed() const { return interiorEdges == sizes.edges; }
};

SchemeSizes getSchemeSizes(LevelTopology const &level) {
    SchemeSizes result = {internal::GetSizes(level), 0, 0, 0, 0};
    result.interiorEdges = level.numEdges - std::int64_t(level.boundaryEdges.size());
    for (Far::Index vert = 0; vert < level.numVertices; ++vert) {
        internal::ForEachFan(level, vert, [&](internal::VertexFan const &fan) {
            std::int64_t const size = fan.end - fan.begin;
            result.closedVertices += fan.isClosed ? 1 : 0;
            result.closedCorners += fan.isClosed ? size : 0;
            result.digons += fan.isClosed && size == 2 ? 1 : 0;
        });
    }
    return result;
}

// A quad per interior edge, a V-face per closed vertex but for digons, where two quads share an
// edge. The F-vertices of V-faces are closed, with four faces each, those of digons with three.
SchemeSizes getDooSabinSizes(SchemeSizes const &p) {
    std::int64_t const vFaces = p.closedVertices - p.digons;
    std::int64_t const vFaceCorners = p.closedCorners - 2 * p.digons;
    SchemeSizes result = {};
    result.sizes.vertices = p.sizes.corners;
    result.sizes.edges = p.sizes.corners + 2 * p.interiorEdges - p.digons;
    result.sizes.faces = p.sizes.faces + p.interiorEdges + vFaces;
    result.sizes.corners = p.sizes.corners + 4 * p.interiorEdges + vFaceCorners;
    result.interiorEdges = 2 * p.interiorEdges + vFaceCorners + p.digons;
    result.closedVertices = vFaceCorners + 2 * p.digons;
    result.closedCorners = 4 * vFaceCorners + 6 * p.digons;
    return result;
}

// Of a closed level: a V-face per vertex, of two F-vertices for each of its faces.
SchemeSizes getTriHexSizes(SchemeSizes const &p) {
    SchemeSizes result = {};
    result.sizes.vertices = p.sizes.corners;
    result.sizes.edges = p.sizes.corners + p.sizes.edges;
    result.sizes.faces = p.sizes.faces + p.closedVertices;
    result.sizes.corners = 3 * p.sizes.corners;
    result.interiorEdges = result.sizes.edges;
    result.closedVertices = result.sizes.vertices;
    result.closedCorners = result.sizes.corners;
    return result;
}

SchemeSizes getHexagonalSizes(SchemeSizes const &p) {
    SchemeSizes result = {};
    result.sizes = internal::GetChildSizes(p.sizes);
    result.interiorEdges = result.sizes.edges;
    return result;
}

// Checks the sizes of all levels of other schemes, as far as they are known beforehand: of borders
// Doo-Sabin's alone.
Status checkSchemeSizes(LevelTopology const &base, SchemeOptions schemeOptions, SizeChecker checker,
                        int refinementLevel) {
    SchemeSizes sizes = getSchemeSizes(base);
    Status status;
    for (int level = 1; level <= refinementLevel && status.IsOk(); ++level) {
        SchemeType const scheme = schemeOptions.GetSchemeOfLevel(level);
        if (scheme != SchemeType::DooSabin && !sizes.IsClosed()) {
            break;
        }
        sizes = scheme == SchemeType::DooSabin ? getDooSabinSizes(sizes)
                : scheme == SchemeType::TriHex ? getTriHexSizes(sizes)
                                               : getHexagonalSizes(sizes);
        status = checker.Add(sizes.sizes);
    }
    return status;
}

} // namespace

TopologyRefiner::TopologyRefiner(std::unique_ptr<LevelTopology> baseLevel, Sdc::Options sdcOptions,
                                 SchemeOptions schemeOptions)
    : _sdcOptions(sdcOptions), _schemeOptions(schemeOptions) {
    _topologies.push_back(std::move(baseLevel));
    setNumLevels(1);
}

TopologyRefiner::~TopologyRefiner() = default;

Status TopologyRefiner::checkLevel(int refinementLevel) {
    if (refinementLevel >= 0) {
        return Status();
    }
    return Status(StatusCode::InvalidArgument, ComponentType::Level, refinementLevel,
                  "refinement level " + std::to_string(refinementLevel) + " is negative");
}

Status TopologyRefiner::checkLastLevel(int refinementLevel) {
    if (refinementLevel <= kLastLevel) {
        return Status();
    }
    return Status(StatusCode::TooLarge, ComponentType::Level, refinementLevel,
                  "refinement level " + std::to_string(refinementLevel) + " is beyond level " +
                      std::to_string(kLastLevel) + ", the last that is made");
}

void TopologyRefiner::setNumLevels(int numLevels) {
    _levels.clear();
    for (int level = 0; level < numLevels; ++level) {
        _levels.emplace_back(_topologies[level].get());
    }
    _topologies[numLevels - 1]->child = nullptr;
}

std::vector<SizeChecker> TopologyRefiner::makeSizeCheckers() const {
    LevelTopology const &base = *_topologies[0];
    std::vector<SizeChecker> result = {SizeChecker(internal::GetSizes(base), "")};
    for (std::size_t channel = 0; channel < base.fvarLevels.size(); ++channel) {
        result.emplace_back(internal::GetSizes(base.fvarLevels[channel]->topology),
                            " in face-varying channel " + std::to_string(channel));
    }
    return result;
}

LevelTopology &TopologyRefiner::getLevelToFill(int level) {
    if (int(_topologies.size()) == level) {
        _topologies.push_back(std::make_unique<LevelTopology>());
    }
    LevelTopology &child = *_topologies[level];
    child.fvarLevels.resize(_topologies[0]->fvarLevels.size());
    for (std::unique_ptr<internal::FVarLevel> &channel : child.fvarLevels) {
        if (!channel) {
            channel = std::make_unique<internal::FVarLevel>();
        }
    }
    return child;
}

Status TopologyRefiner::refineHexagonally(int level, bool fullTopology,
                                          std::vector<SizeChecker> &checkers) {
    LevelTopology &parent = *_topologies[level - 1];
    Status status = checkers[0].Add(internal::GetChildSizes(internal::GetSizes(parent)));
    if (!status.IsOk()) {
        return status;
    }
    LevelTopology &child = getLevelToFill(level);
    internal::RefineTopology(parent, _sdcOptions, fullTopology, child);
    for (std::size_t channel = 0; channel < child.fvarLevels.size(); ++channel) {
        internal::FVarLevel &pChannel = *parent.fvarLevels[channel];
        internal::FVarLevel &cChannel = *child.fvarLevels[channel];
        internal::RefineTopology(pChannel.topology, _sdcOptions, fullTopology, cChannel.topology);
        internal::RelateFVarLevels(parent, child, pChannel, cChannel);
    }
    return Status();
}

Status TopologyRefiner::refineToPolygons(int level, bool fullTopology,
                                         internal::PolygonRules const &rules,
                                         std::vector<SizeChecker> &checkers) {
    LevelTopology &parent = *_topologies[level - 1];
    std::deque<internal::PolygonStep> steps;
    steps.emplace_back(parent, rules, _sdcOptions);
    for (std::unique_ptr<internal::FVarLevel> const &pChannel : parent.fvarLevels) {
        steps.emplace_back(pChannel->topology,
                           internal::GetRulesOfChannel(parent, rules, *pChannel), _sdcOptions);
    }
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (Status status = checkers[i].Add(steps[i].GetSizes()); !status.IsOk()) {
            return status;
        }
    }
    LevelTopology &child = getLevelToFill(level);
    steps[0].Refine(fullTopology, child);
    for (std::size_t channel = 0; channel < child.fvarLevels.size(); ++channel) {
        internal::FVarLevel &cChannel = *child.fvarLevels[channel];
        steps[channel + 1].Refine(fullTopology, cChannel.topology);
        internal::RelateFVarLevels(parent, child, *parent.fvarLevels[channel], cChannel);
    }
    return Status();
}

bool TopologyRefiner::RefineUniform(UniformOptions options, Status *status) {
    int const refinementLevel = options.refinementLevel;
    Status result = checkLevel(refinementLevel);
    if (result.IsOk()) {
        LevelTopology const &base = *_topologies[0];
        result = checkSizes(refinementLevel, [&](int level) {
            return _schemeOptions.IsHexagonal()
                       ? checkHexagonalSizes(base, makeSizeCheckers(), level)
                       : checkSchemeSizes(base, _schemeOptions, makeSizeCheckers()[0], level);
        });
    }
    if (!result.IsOk()) {
        return internal::Report(result, status);
    }
    result = replaceLevels([&] {
        std::vector<SizeChecker> checkers = makeSizeCheckers();
        for (int level = 1; level <= refinementLevel; ++level) {
            bool const fullTopology = level < refinementLevel || options.fullTopologyInLastLevel;
            internal::PolygonRules rules;
            rules.scheme = _schemeOptions.GetSchemeOfLevel(level);
            bool const isHexagonal = rules.scheme == SchemeType::Hexagonal;
            Status levelStatus;
            if (level == 2 && isHexagonal) {
                // All sizes are known by now, of borders too.
                levelStatus = checkHexagonalSizes(*_topologies[1], checkers, refinementLevel);
            }
            if (levelStatus.IsOk()) {
                levelStatus = isHexagonal ? refineHexagonally(level, fullTopology, checkers)
                                          : refineToPolygons(level, fullTopology, rules, checkers);
            }
            if (!levelStatus.IsOk()) {
                return levelStatus;
            }
        }
        setNumLevels(refinementLevel + 1);
        _uniformOptions = options;
        return Status();
    });
    return internal::Report(result, status);
}

void TopologyRefiner::Unrefine() {
    setNumLevels(1);
    ++_numRefinements;
    _isUniform = true;
    _uniformOptions = UniformOptions(0);
}

Sdc::Options::FVarLinearInterpolation
TopologyRefiner::GetFVarLinearInterpolation(int channel) const {
    return _topologies[0]->fvarLevels[channel]->linearInterpolation;
}

int TopologyRefiner::GetNumFVarValuesTotal(int channel) const {
    int sum = 0;
    for (TopologyLevel const &level : _levels) {
        sum += level.GetNumFVarValues(channel);
    }
    return sum;
}

int TopologyRefiner::GetNumVerticesTotal() const { return total(&TopologyLevel::GetNumVertices); }
int TopologyRefiner::GetNumEdgesTotal() const { return total(&TopologyLevel::GetNumEdges); }
int TopologyRefiner::GetNumFacesTotal() const { return total(&TopologyLevel::GetNumFaces); }
int TopologyRefiner::GetNumFaceVerticesTotal() const {
    return total(&TopologyLevel::GetNumFaceVertices);
}

int TopologyRefiner::total(int (TopologyLevel::*count)() const) const {
    int sum = 0;
    for (TopologyLevel const &level : _levels) {
        sum += (level.*count)();
    }
    return sum;
}

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "topologyRefiner.h"

#include "fvarLevel.h"
#include "polygonRefinement.h"
#include "sizeChecker.h"
#include "topologyRefinement.h"

#include <deque>

namespace OpenSubdivHex::FarExt {

using internal::LevelSizes;
using internal::LevelTopology;
using internal::SizeChecker;

namespace {

// Checks the sizes of levels that hexagonal steps make, all known from those of the base.
Status checkSizes(LevelTopology const &base, std::vector<SizeChecker> checkers,
                  int refinementLevel) {
    for (std::size_t i = 0; i < checkers.size(); ++i) {
        LevelSizes sizes = internal::GetSizes(i == 0 ? base : base.fvarLevels[i - 1]->topology);
        for (int level = 1; level <= refinementLevel; ++level) {
            sizes = internal::GetChildSizes(sizes);
            if (Status status = checkers[i].Add(sizes); !status.IsOk()) {
                return status;
            }
        }
    }
    return Status();
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
    if (result.IsOk() && _schemeOptions.IsHexagonal()) {
        result = checkSizes(*_topologies[0], makeSizeCheckers(), refinementLevel);
    }
    if (!result.IsOk()) {
        return internal::Report(result, status);
    }
    Unrefine();
    std::vector<SizeChecker> checkers = makeSizeCheckers();
    for (int level = 1; level <= refinementLevel && result.IsOk(); ++level) {
        bool const fullTopology = level < refinementLevel || options.fullTopologyInLastLevel;
        internal::PolygonRules rules;
        rules.scheme = _schemeOptions.GetSchemeOfLevel(level);
        result = rules.scheme == SchemeType::Hexagonal
                     ? refineHexagonally(level, fullTopology, checkers)
                     : refineToPolygons(level, fullTopology, rules, checkers);
    }
    if (result.IsOk()) {
        setNumLevels(refinementLevel + 1);
        _uniformOptions = options;
    } else {
        Unrefine();
    }
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

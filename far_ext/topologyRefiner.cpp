// SPDX-License-Identifier: Apache-2.0
#include "topologyRefiner.h"

#include "fvarLevel.h"
#include "topologyRefinement.h"

#include <limits>

namespace OpenSubdivHex::FarExt {

using internal::LevelSizes;
using internal::LevelTopology;

namespace {

constexpr std::int64_t kMaxCount = std::numeric_limits<Far::Index>::max();

struct Count {
    char const *name;
    std::int64_t value;
};

Status tooLarge(int level, Count const &count, std::string const &where) {
    return Status(StatusCode::TooLarge, ComponentType::Level, level,
                  "level " + std::to_string(level) + " would have " + std::to_string(count.value) +
                      " " + count.name + where +
                      ", more than the 2147483647 that 32-bit indices reach");
}

// Checks the sizes of all levels and their sums; the first level that exceeds 32 bits ends it, so
// that 64 bits suffice.
Status checkSizes(LevelTopology const &base, int refinementLevel, std::string const &where) {
    LevelSizes sizes = internal::GetSizes(base);
    LevelSizes total = sizes;
    for (int level = 1; level <= refinementLevel; ++level) {
        sizes = internal::GetChildSizes(sizes);
        total.vertices += sizes.vertices;
        total.edges += sizes.edges;
        total.faces += sizes.faces;
        total.corners += sizes.corners;
        // The edge-vertices are the longest array.
        for (Count const &count :
             {Count{"vertices", sizes.vertices}, Count{"edges", sizes.edges},
              Count{"faces", sizes.faces}, Count{"face-vertices", sizes.corners},
              Count{"edge-vertices", 2 * sizes.edges}}) {
            if (count.value > kMaxCount) {
                return tooLarge(level, count, where);
            }
        }
        for (Count const &count :
             {Count{"vertices", total.vertices}, Count{"edges", total.edges},
              Count{"faces", total.faces}, Count{"face-vertices", total.corners}}) {
            if (count.value > kMaxCount) {
                return tooLarge(level, count, where + " together with the levels before");
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

void TopologyRefiner::setNumLevels(int numLevels) {
    _levels.clear();
    for (int level = 0; level < numLevels; ++level) {
        _levels.emplace_back(_topologies[level].get());
    }
    _topologies[numLevels - 1]->child = nullptr;
}

bool TopologyRefiner::RefineUniform(UniformOptions options, Status *status) {
    int const refinementLevel = options.refinementLevel;
    if (refinementLevel < 0) {
        return internal::Report(
            Status(StatusCode::InvalidArgument, ComponentType::Level, refinementLevel,
                   "refinement level " + std::to_string(refinementLevel) + " is negative"),
            status);
    }
    LevelTopology const &base = *_topologies[0];
    Status sizes = checkSizes(base, refinementLevel, "");
    for (std::size_t channel = 0; channel < base.fvarLevels.size() && sizes.IsOk(); ++channel) {
        sizes = checkSizes(base.fvarLevels[channel]->topology, refinementLevel,
                           " in face-varying channel " + std::to_string(channel));
    }
    if (!sizes.IsOk()) {
        return internal::Report(sizes, status);
    }
    Unrefine();
    for (int level = 1; level <= refinementLevel; ++level) {
        if (int(_topologies.size()) == level) {
            _topologies.push_back(std::make_unique<LevelTopology>());
        }
        bool const fullTopology = level < refinementLevel || options.fullTopologyInLastLevel;
        LevelTopology &parent = *_topologies[level - 1];
        LevelTopology &child = *_topologies[level];
        internal::RefineTopology(parent, _sdcOptions, fullTopology, child);
        child.fvarLevels.resize(parent.fvarLevels.size());
        for (std::size_t channel = 0; channel < child.fvarLevels.size(); ++channel) {
            if (!child.fvarLevels[channel]) {
                child.fvarLevels[channel] = std::make_unique<internal::FVarLevel>();
            }
            internal::RefineFVarLevel(parent, *parent.fvarLevels[channel], _sdcOptions,
                                      fullTopology, *child.fvarLevels[channel]);
        }
    }
    setNumLevels(refinementLevel + 1);
    _uniformOptions = options;
    return internal::Report(Status(), status);
}

void TopologyRefiner::Unrefine() {
    setNumLevels(1);
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

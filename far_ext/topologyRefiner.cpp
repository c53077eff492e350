// SPDX-License-Identifier: Apache-2.0
#include "topologyRefiner.h"

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

Status tooLarge(int level, Count const &count, char const *where) {
    return Status(StatusCode::TooLarge, ComponentType::Level, level,
                  "level " + std::to_string(level) + " would have " +
                      std::to_string(count.value) + " " + count.name + where +
                      ", more than the 2147483647 that 32-bit indices reach");
}

// Checks the sizes of all levels and their sums; the first level that exceeds 32 bits ends it, so
// that 64 bits suffice.
Status checkSizes(LevelTopology const &base, int refinementLevel) {
    LevelSizes sizes = internal::GetSizes(base);
    LevelSizes total = sizes;
    for (int level = 1; level <= refinementLevel; ++level) {
        sizes = internal::GetChildSizes(sizes);
        total.vertices += sizes.vertices;
        total.edges += sizes.edges;
        total.faces += sizes.faces;
        total.corners += sizes.corners;
        // The edge-vertices are the longest array.
        for (Count const &count : {Count{"vertices", sizes.vertices}, Count{"edges", sizes.edges},
                                   Count{"faces", sizes.faces},
                                   Count{"face-vertices", sizes.corners},
                                   Count{"edge-vertices", 2 * sizes.edges}}) {
            if (count.value > kMaxCount) {
                return tooLarge(level, count, "");
            }
        }
        for (Count const &count : {Count{"vertices", total.vertices}, Count{"edges", total.edges},
                                   Count{"faces", total.faces},
                                   Count{"face-vertices", total.corners}}) {
            if (count.value > kMaxCount) {
                return tooLarge(level, count, " together with the levels before");
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
        return internal::Report(Status(StatusCode::InvalidArgument, ComponentType::Level,
                                       refinementLevel,
                                       "refinement level " + std::to_string(refinementLevel) +
                                           " is negative"),
                                status);
    }
    Status const sizes = checkSizes(*_topologies[0], refinementLevel);
    if (!sizes.IsOk()) {
        return internal::Report(sizes, status);
    }
    Unrefine();
    for (int level = 1; level <= refinementLevel; ++level) {
        if (int(_topologies.size()) == level) {
            _topologies.push_back(std::make_unique<LevelTopology>());
        }
        bool const fullTopology = level < refinementLevel || options.fullTopologyInLastLevel;
        internal::RefineTopology(*_topologies[level - 1], *_topologies[level], fullTopology);
    }
    setNumLevels(refinementLevel + 1);
    _uniformOptions = options;
    return internal::Report(Status(), status);
}

void TopologyRefiner::Unrefine() {
    setNumLevels(1);
    _uniformOptions = UniformOptions(0);
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

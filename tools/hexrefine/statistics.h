// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_STATISTICS_H
#define OPENSUBDIVHEX_TOOLS_STATISTICS_H

#include "far_ext/topologyRefiner.h"
#include "tools/mesh/mesh.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// The sizes of one level.
struct LevelStatistics {
    int vertices;
    int edges;
    int faces;
    int corners;
    int boundaryEdges;
    std::map<int, int> facesBySize; ///< number of faces by number of corners
};

/// The sizes of a face-varying channel.
struct ChannelStatistics {
    std::string name;
    int width;               ///< numbers per value
    std::vector<int> values; ///< number of values by level
};

/// How coplanar faces were refined.
struct CoplanarStatistics {
    double tolerance; ///< in degrees
    bool hasOpenGaps;
};

/// \brief What a run of hexrefine did: the content of `--stats`.
struct Statistics {
    std::string scheme;
    bool isTriHexFirst = false;
    std::optional<CoplanarStatistics> coplanar;
    std::string mask;
    std::string boundary;
    std::string evaluator;
    std::string input;
    std::vector<LevelStatistics> levels;
    struct {
        double read = 0;
        double validate = 0; ///< the checks of the base mesh and its import
        double refine = 0;
        double stencils = 0; ///< building the table
        double evaluate = 0;
        double write = 0;
        double render = 0;
    } milliseconds;
    int stencils = 0;         ///< for positions
    std::int64_t weights = 0; ///< of these stencils

    // The rules as used, and what they were used on.
    std::string creasingMethod;
    std::string fvarInterpolation;
    int creases = 0;
    int corners = 0;
    std::vector<int> holes;                   ///< number of faces that are holes by level
    std::vector<ChannelStatistics> channels;  ///< that were refined
    std::vector<std::string> channelsLeftOut; ///< that the output's format has no place for
};

std::vector<LevelStatistics> CountLevels(FarExt::TopologyRefiner const &refiner);

std::vector<int> CountHoles(FarExt::TopologyRefiner const &refiner);

/// The channels of \p refiner, which are those of \p mesh.
std::vector<ChannelStatistics> CountChannels(FarExt::TopologyRefiner const &refiner,
                                             Mesh const &mesh);

/// The most memory that this process has had so far; 0 where the system does not tell.
std::int64_t GetPeakMemoryBytes();

/// The statistics, and the peak memory, as a JSON text that ends in a line feed.
std::string FormatJson(Statistics const &statistics);

/// The statistics as lines for people.
std::string FormatSummary(Statistics const &statistics);

} // namespace OpenSubdivHex::Tools

#endif

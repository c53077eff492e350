// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_STATISTICS_H
#define OPENSUBDIVHEX_TUTORIALS_STATISTICS_H

#include "far_ext/topologyRefiner.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tutorials {

/// The sizes of one level.
struct LevelStatistics {
    int vertices;
    int edges;
    int faces;
    int corners;
    int boundaryEdges;
    std::map<int, int> facesBySize; ///< number of faces by number of corners
};

/// \brief What a run of hexrefine did: the content of `--stats`.
struct Statistics {
    std::string scheme;
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
    } milliseconds;
    int stencils = 0;
    std::int64_t weights = 0;
};

std::vector<LevelStatistics> CountLevels(FarExt::TopologyRefiner const &refiner);

/// The most memory that this process has had so far; 0 where the system does not tell.
std::int64_t GetPeakMemoryBytes();

/// The statistics, and the peak memory, as a JSON text that ends in a line feed.
std::string FormatJson(Statistics const &statistics);

/// The statistics as lines for people.
std::string FormatSummary(Statistics const &statistics);

} // namespace OpenSubdivHex::Tutorials

#endif

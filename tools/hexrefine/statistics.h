// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_STATISTICS_H
#define OPENSUBDIVHEX_TOOLS_STATISTICS_H

#include "adaptive.h"
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

/// A number that vertices or faces have.
struct PropertyStatistics {
    std::string name;
    std::string type; ///< as PLY has it
};

/// \brief The data of a mesh beside positions, faces and channels, in the order of the file.  Names
/// differ.
struct AttributeStatistics {
    std::vector<PropertyStatistics> vertexProperties;
    bool hasNormals = false; ///< among these, which are made 1 long
    std::vector<PropertyStatistics> faceProperties;
    std::vector<std::string> objects;
    std::vector<std::string> groups;
    std::vector<std::string> materials;
    std::vector<std::string> smoothingGroups;
    std::vector<std::string> materialLibraries; ///< as the output names them
};

/// How coplanar faces were refined.
struct CoplanarStatistics {
    double tolerance; ///< in degrees
    bool hasOpenGaps;
};

/// \brief The content of `--stats`: facts of a run of hexrefine.
struct Statistics {
    std::string scheme;
    std::string firstStep;
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
    AttributeStatistics attributes;           ///< that were kept
    std::vector<std::string> notRead;         ///< what else the input has
    std::vector<std::string> notWritten;      ///< what the output's format has no place for
    std::string outputFormat;                 ///< its extension
    std::optional<AdaptiveStatistics> adaptive;
};

std::vector<LevelStatistics> CountLevels(FarExt::TopologyRefiner const &refiner);

std::vector<int> CountHoles(FarExt::TopologyRefiner const &refiner);

/// The channels of \p refiner, which are those of \p mesh.
std::vector<ChannelStatistics> CountChannels(FarExt::TopologyRefiner const &refiner,
                                             Mesh const &mesh);

AttributeStatistics CountAttributes(Mesh const &mesh);

/// The most memory that this process has had so far; 0 where the system does not tell.
std::int64_t GetPeakMemoryBytes();

/// The statistics, and the peak memory, as a JSON text that ends in a line feed.
std::string FormatJson(Statistics const &statistics);

/// The statistics as lines for people.
std::string FormatSummary(Statistics const &statistics);

} // namespace OpenSubdivHex::Tools

#endif

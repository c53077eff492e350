// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_ADAPTIVE_H
#define OPENSUBDIVHEX_TOOLS_ADAPTIVE_H

#include "far_ext/topologyRefiner.h"
#include "tools/mesh/mesh.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace OpenSubdivHex::Tools {

/// What the command line says of --adaptive.
struct AdaptiveArguments {
    bool isAdaptive = false;
    std::vector<float> camera; ///< eye and target; empty: all of the mesh is seen
    float fieldOfView = 40;    ///< degrees
    std::string resolution = "1280x720";
    float pixelError = 0.5;
    bool isCulling = false;
    int maxLevel = 8;
};

/// Adds --adaptive, and the options that need it.
void AddAdaptiveOptions(CLI::App &app, AdaptiveArguments *arguments);

/// Throws CLI::ValidationError for options that are not for --adaptive.
void CheckAdaptiveOptions(CLI::App const &app, AdaptiveArguments const &arguments);

/// \brief What became of the cells of a mesh.
struct AdaptiveStatistics {
    std::vector<std::int64_t> facesByLevel;
    std::int64_t faces = 0;
    std::int64_t points = 0;
    std::int64_t outside = 0;       ///< cells that were left coarse, being outside of the picture
    std::int64_t backFacing = 0;    ///< and those facing away
    std::int64_t types = 0;         ///< of base faces
    std::int64_t hits = 0;          ///< base faces of a type that was known
    std::int64_t bytes = 0;         ///< of points and faces, as arrays
    std::vector<int> channelValues; ///< by channel
    int maxLevel = 0;               ///< the last level that may be made
    std::int64_t facesOfMaxLevel = 0;
    float pixelError = 0; ///< that was asked for
};

/// A camera, as BfrExt::Camera with y up.
struct AdaptiveCamera {
    double eye[3];
    double target[3];
    float fieldOfView;
    int width;
    int height;
};

/// What RefineAdaptively() tells of what it made.
struct AdaptiveCells {
    AdaptiveStatistics statistics;
    AdaptiveCamera camera;
    std::vector<int> faceLevels;
};

/// \brief Replaces the faces of \p mesh by the cells that are refined for a camera, and its values by
/// those at the vertices of cells.
///
/// Vertices are on the limit surface.  Properties of vertices are interpolated linearly, as in
/// refinement.  A value of a channel is one for each vertex and each side of a seam.  Holes are left
/// out.  Throws FileError, naming \p input, where a face has no surface.
AdaptiveCells RefineAdaptively(AdaptiveArguments const &arguments,
                               FarExt::TopologyRefiner const &refiner, std::string const &input,
                               Mesh *mesh);

} // namespace OpenSubdivHex::Tools

#endif

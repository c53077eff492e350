// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_ADAPTIVE_H
#define OPENSUBDIVHEX_TOOLS_ADAPTIVE_H

#include "far_ext/topologyRefiner.h"
#include "tools/mesh/pieceWriter.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace OpenSubdivHex::Tools {

/// Arguments of --adaptive.
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

/// \brief Counts of the cells of a mesh.
struct AdaptiveStatistics {
    static constexpr int kMaxReadSize = 65535; ///< sides of the largest face that can be refined

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
    float pixelError = 0;          ///< that was asked for
    std::int64_t facesNotRead = 0; ///< faces with more sides than can be refined
    int firstNotRead = 0;          ///< the base face of the first of these
    int sizeOfFirstNotRead = 0;
};

/// A camera, as BfrExt::Camera with y up.
struct AdaptiveCamera {
    double eye[3];
    double target[3];
    float fieldOfView;
    int width;
    int height;
};

/// \brief The cells of a mesh that are refined for a camera: they are written piece by piece as they are
/// made, and kept for a picture alone.
///
/// Vertices are on the limit surface.  Properties of vertices are interpolated linearly, as in
/// refinement.  A value of a channel is one for each vertex and each side of a seam.  Holes are left
/// out.
class AdaptiveRefinement {
public:
    /// \param mesh    that is refined, with what the file is to have: its labels are those of base faces,
    ///                its numbers those of the surface level; it must live as long
    /// \param output  the file, which Write() puts in its place; empty: none
    /// \param isKept  whether the cells are kept
    AdaptiveRefinement(Mesh const &mesh, std::string const &output, bool isKept);

    /// Refines the faces of the surface level, which \p refiner has.  Throws FileError, naming \p input,
    /// where a face has no surface.
    void Refine(AdaptiveArguments const &arguments, FarExt::TopologyRefiner const &refiner,
                std::string const &input);
    AdaptiveStatistics const &GetStatistics() const { return _statistics; }
    AdaptiveCamera const &GetCamera() const { return _camera; }

    /// @name Cells that are kept
    /// @{

    /// Positions, faces with their base faces, and infinitely sharp creases.
    Mesh const &GetMesh() const { return _kept; }
    /// By face.
    std::vector<int> const &GetFaceLevels() const { return _faceLevels; }
    /// @}

    /// Puts the file in its place.
    void Write() { _writer->Commit(_front); }

private:
    void take(Mesh const &piece, std::vector<int> const &faceLevels);

    Mesh const &_mesh;
    bool const _isKept;
    std::optional<PieceWriter> _writer;
    AdaptiveStatistics _statistics;
    AdaptiveCamera _camera{};
    Mesh _front; // vertices that come first
    Mesh _kept;
    std::vector<int> _faceLevels;
};

} // namespace OpenSubdivHex::Tools

#endif

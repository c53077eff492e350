// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_REFINEMENT_H
#define OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_REFINEMENT_H

#include "far_ext/export.h"
#include "far_ext/vtr/refinement.h"
#include "far_ext/vtr/refinementRules.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief Plain faces of one size that follow one another.
struct DeviceFaceRun {
    int size;
    std::uint32_t count;
    std::uint32_t firstCorner;
    /// Whether each vertex has a weight of its own: those of corner 0 stand twice in a row, so that
    /// every rotation of them is contiguous.
    bool isWeighted;
    std::uint32_t firstWeight;
    /// @name Else those of a PlainFaceMask
    /// @{
    float all;
    float self;
    float neighbor;
    float opposite;
    /// @}
};

/// \brief Vertices with three faces, and the mask that all these have, that follow one another and
/// keep their index.  The three corners of each are indices, from position firstIndex on.
struct DeviceVertexRun {
    std::uint32_t count;
    std::uint32_t firstVertex;
    std::uint32_t firstIndex;
    bool addsInTurn; ///< the F-vertices of the corners; else the last two first
};

/// \brief Any corner: its F-vertex is the sum of weights[firstWeight + j] indices[firstIndex + j],
/// j < size.
struct DeviceCorner {
    std::uint32_t corner;
    std::uint32_t size;
    std::uint32_t firstIndex;
    std::uint32_t firstWeight;
};

/// \brief Any V-vertex: from its first index on it has sources, each with a weight, and then corners,
/// whose F-vertices are summed up and multiplied by the weight behind those.  A vertex without sources
/// is plain: with the sum of its F-vertices, it is multiplied by the only weight.  Of one whose numCorners has
/// kEachHasAWeight, the F-vertex of each corner has a weight of its own, behind those of the sources.
struct DeviceVertex {
    static constexpr std::uint32_t kEachHasAWeight = 1U << 31;

    std::uint32_t child;
    std::uint32_t numSources;
    std::uint32_t numCorners;
    std::uint32_t firstIndex;
    std::uint32_t firstWeight;

    std::uint32_t GetNumCorners() const { return numCorners & ~kEachHasAWeight; }
};

/// \brief A refinement as a device evaluates it, with what the numbering does not give.
///
/// Nearly all faces and vertices of a refined level are in runs.  There, indices take 24 bytes for
/// each face of the parent that is no F-face, and 12 for each of its vertices: together about 5
/// bytes for a vertex that is made.  All others are listed, in \c corners and \c vertices, and so are
/// the corners of faces in runs that have rows of their own.
struct DeviceRefinement {
    Far::Index numVVertices = 0; ///< F-vertices follow in the child

    /// @name The vertices of the parent's faces, by corner
    /// Vertices of F-faces follow one another; the others are indices.
    /// @{
    std::uint32_t numConsecutiveCorners = 0;
    std::uint32_t firstConsecutiveVertex = 0;
    std::uint32_t firstListedVertex = 0; ///< position in indices
    /// @}

    std::vector<DeviceFaceRun> faceRuns;
    std::vector<DeviceCorner> corners; ///< some of them in runs: these come behind those
    std::vector<DeviceVertexRun> vertexRuns;
    std::vector<DeviceVertex> vertices;
    float vertexWeight = 1;    ///< of vertices in runs, and of each F-vertex around them ...
    bool averagesFaces = true; ///< ... unless this is false
};

/// \brief Prepares all refinements of a mesh, which lead from level 0 on.
///
/// \param rules    by refinement
/// \param weights  gets those that the refinements point to
/// \param result   one for each refinement
/// \param write    is called once \p result is there, with the number of indices and a function that
///                 writes them all to memory that it is given
///
/// \return  that of \p write; TooLarge, and how many there are, where there are more than 2^32 indices
///          or weights
OPENSUBDIVHEX_API FarExt::CallStatus MakeDeviceRefinements(
    std::vector<FarExt::internal::Refinement const *> const &refinements,
    std::vector<std::shared_ptr<FarExt::internal::RefinementRules const>> const &rules,
    std::vector<float> &weights, std::vector<DeviceRefinement> &result,
    std::function<FarExt::CallStatus(
        std::size_t numIndices, std::function<void(std::int32_t *)> const &fill)> const &write);

} // namespace OpenSubdivHex::OsdExt::internal

#endif

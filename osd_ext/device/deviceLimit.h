// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_LIMIT_H
#define OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_LIMIT_H

#include "deviceKernels.h"

#include "far_ext/export.h"
#include "far_ext/limit/regularFaces.h"

#include <cstdint>
#include <type_traits>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief A regular face, whose F-vertices have their limit in closed form: all that it depends on is in
/// the faces beyond the neighbours of its vertices, FarExt::internal::RegularFace::beyond.
struct DeviceRegularFace {
    std::uint32_t firstCorner;
    std::uint32_t beyond[FarExt::internal::kRegularFaceSize]; ///< the first corner of each
    /// The place of the neighbour in each, in three bits from the lowest on.
    std::uint32_t locals;
};

/// \brief An F-face that gives the limit of vertices of its own, but for those of regular faces: see
/// FarExt::internal::RegularFaces.  Others of its vertices are among those of DeviceLimit::vertices, and
/// made again.
struct DeviceOwnFace {
    std::uint32_t firstVertex; ///< the others follow
    /// Vertices of each face beyond, from the neighbour on.
    std::uint32_t around[FarExt::internal::kRegularFaceSize][FarExt::internal::kRegularFaceSize];
};

/// \brief The limit of a vertex as a sum of vertices of a level: each of \c numSources indices from
/// \c firstIndex on has three weights, of the point, du and dv, from \c firstWeight on.
struct DeviceLimitVertex {
    std::uint32_t vert;
    std::uint32_t numSources;
    std::uint32_t firstIndex;
    std::uint32_t firstWeight;
};

/// \brief The limit of a level as a device evaluates it: positions of faces, indices and weights are
/// in arrays of its own.
struct DeviceLimit {
    /// \brief Lattice faces of level 0 that have as many sides and the same halves (GroupByHalves), and all
    /// that is made in them.
    ///
    /// Their indices are in \c latticeIndices: of each place of a source those of all faces, then of each
    /// vertex of the orbits; kNoVertex where another face makes it.
    struct Lattice {
        int faceSize;
        std::uint32_t numFaces;
        std::uint32_t firstIndex;
        std::uint32_t firstOutput; ///< behind the sources
        std::uint32_t numOrbits;
        std::uint32_t numPairs;     ///< of orbits, these first: others have no mirror images
        std::vector<float> weights; ///< of each orbit those of AddOrbitWeights
    };
    static constexpr std::uint32_t kNoVertex = 0xffffffffu;

    /// Faces of one kind that have a mask in common.
    struct Set {
        std::uint32_t count = 0;
        std::uint32_t firstFace = 0;   ///< in \c regularFaces or \c ownFaces
        std::uint32_t firstVertex = 0; ///< of the last level: where the limit of corner 0 goes
        /// RegularLimitWeights, in their order.
        float weights[std::extent_v<decltype(DeviceParameters::regularWeights)>] = {};
    };
    struct OfLevel {
        Set fVertices; ///< none of the last level
        Set ownVertices;
        std::uint32_t firstVertex; ///< those whose limit is a sum of vertices of this level
        std::uint32_t numVertices;
    };
    std::vector<Lattice> lattices;
    std::vector<std::uint32_t> latticeIndices;
    std::vector<OfLevel> levels; ///< from 0 to the last one
    std::vector<DeviceRegularFace> regularFaces;
    std::vector<DeviceOwnFace> ownFaces;
    std::vector<DeviceLimitVertex> vertices; ///< those that no face makes, by level
    std::vector<std::uint32_t> sources;      ///< of these, the indices
    std::vector<float> weights;              ///< of these
};

/// \brief Prepares the limit at the vertices of the level of \p rows, one of \p mesh.
///
/// \return  as FarExt::internal::RegularFaces::FindMasks; TooLarge where 32 bits do not reach
OPENSUBDIVHEX_API FarExt::CallStatus MakeDeviceLimit(FarExt::internal::MeshLevels const &mesh,
                                                     FarExt::HexSchemeOptions const &schemeOptions,
                                                     FarExt::internal::LimitRows &rows,
                                                     DeviceLimit &limit);

} // namespace OpenSubdivHex::OsdExt::internal

#endif

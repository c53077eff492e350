// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_LIMIT_H
#define OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_LIMIT_H

#include "far_ext/export.h"
#include "far_ext/limit/regularFaces.h"

#include <cstdint>
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

/// \brief The limit of a vertex as a sum of vertices of its level: each of \c numSources indices from
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
    /// By level, from 0 to the one before the last; those of weights are the first 52 numbers of
    /// RegularLimitWeights.
    struct RegularLevel {
        std::uint32_t count = 0;
        std::uint32_t firstFace = 0;   ///< in \c faces
        std::uint32_t firstWeight = 0; ///< in \c weights
    };
    std::vector<RegularLevel> levels;
    std::vector<DeviceRegularFace> faces;
    std::vector<DeviceLimitVertex> vertices; ///< those that no regular face makes
    std::vector<std::uint32_t> sources;      ///< of these, the indices
    std::vector<float> weights;
};

/// \brief Prepares the limit at the vertices of the level of \p rows, one of \p mesh.
///
/// \return  as FarExt::internal::RegularFaces::FindMasks; TooLarge where 32 bits do not reach
OPENSUBDIVHEX_API FarExt::Status MakeDeviceLimit(FarExt::internal::MeshLevels const &mesh,
                                                 FarExt::HexSchemeOptions const &schemeOptions,
                                                 FarExt::internal::LimitRows &rows,
                                                 DeviceLimit &limit);

} // namespace OpenSubdivHex::OsdExt::internal

#endif

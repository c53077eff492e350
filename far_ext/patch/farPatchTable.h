// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_FAR_PATCH_TABLE_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_FAR_PATCH_TABLE_H

#include "far_ext/status.h"

#include <opensubdiv/far/patchTable.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Points as sums of what a patch table has for vertices, values or varying data, in either
/// precision: those of the other one are empty.
struct LocalPoints {
    int numControlPoints = 0; ///< whose indices come first; those of the points follow
    std::vector<int> sizes;
    std::vector<Far::Index> indices;
    std::vector<float> weights;
    std::vector<double> doubleWeights;
};

/// \brief The parts of a Far::PatchTable of Gregory patches.
struct PatchTableContent {
    bool isDouble = false;     ///< the weights of points
    bool isFVarDouble = false; ///< those of face-varying points

    std::vector<Far::Index> vertices; ///< 20 of each patch
    std::vector<Far::PatchParam> params;
    LocalPoints points;
    std::vector<Far::Index> varyingVertices; ///< 4 of each patch, or none
    LocalPoints varyingPoints;
    struct Channel {
        bool isLinear; ///< with 4 values for each patch, else 20
        std::vector<Far::Index> values;
        LocalPoints points; ///< of no matter where it is linear
    };
    std::vector<Channel> channels;
};

/// The patches that a table can have: each is a face in the terms of Far::PatchParam.
inline constexpr std::int64_t kMaxPatches = (1 << 28) - 1;

/// \brief Makes a Far::PatchTable of \p content, which is moved from.
///
/// Far's factory makes the table, of as many quads without neighbours, each of which is such a patch; what it
/// says is then replaced through references that Far's accessors give.  (The objects are not constant.)
///
/// \return  null where Far's factory makes something else
std::unique_ptr<Far::PatchTable const> MakeFarPatchTable(PatchTableContent content);

} // namespace OpenSubdivHex::FarExt::internal

#endif

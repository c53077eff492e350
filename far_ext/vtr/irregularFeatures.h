// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_IRREGULAR_FEATURES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_IRREGULAR_FEATURES_H

#include "refinement.h"

#include "far_ext/rules/mask.h"

namespace OpenSubdivHex::FarExt::internal {

/// Returns what the \p numFaces faces around a vertex are, of the sizes getSize(0 ... numFaces - 1).
template <typename GET_SIZE>
FacesAround FindFacesAround(int numFaces, GET_SIZE const &getSize) {
    constexpr int kTriangle = 3;
    constexpr int kQuad = 4;
    bool const areFour = numFaces == kMinIrregularFaces;
    for (int i = 0; i < numFaces; ++i) {
        if (getSize(i) != (areFour ? kQuad : kTriangle)) {
            return FacesAround::Others;
        }
    }
    return areFour ? FacesAround::Quads : FacesAround::Triangles;
}

/// \brief Fills irregularVerts and irregularCorners of \p level, the child of \p refinement, from
/// relations and tags of both: with what \p faceMask has masks of its own for.
///
/// Only levels behind hexagonal steps have any: V-vertices with four faces or more that are all
/// E-faces of six sides, and such E-faces beside F-faces of four.
void FindIrregularFeatures(FaceMask faceMask, Refinement const &refinement, Level &level);

} // namespace OpenSubdivHex::FarExt::internal

#endif

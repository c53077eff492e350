// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FACE_PATCHES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FACE_PATCHES_H

#include "bfrPlace.h"

#include "far_ext/patch/cellPatchPoints.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

class BaseType;

using FarExt::internal::kNumPatchPoints;

/// \brief The first level whose cells can be the patches of a base face, and the last one.
inline constexpr int kFirstPatchLevel = 2;
inline constexpr int kLastPatchLevel = 6;

/// \brief How many Gregory patches the cells of a level are in a base face.
///
/// They are in the order of the cells: depth first, with children in the order of RefineCell().
int GetNumFacePatches(FaceShape shape, int level);

/// A place in one of the patches of a face; its derivatives are there as far as they were asked for.
struct PatchPlace {
    int patch;
    double s;
    double t;
    Pair first[2];  ///< derivatives of s, and of t, by u and v
    Pair second[3]; ///< of (s, t), by u twice, by u and v, by v twice
};

/// Finds the patch of a place of a base face, with derivatives as far as \p numDerivatives asks: 0, 1 or 2.
PatchPlace FindPatchPlace(BfrPlace const &ofFace, FaceShape shape, int level, int numDerivatives);

/// \brief Makes the points of patches of a face from its control points.
///
/// \param control  points of the type, of \p size numbers each, from one to the next by \p stride
/// \param wanted   the patches, ascending; null: all
/// \param points   kNumPatchPoints for each patch of the face, likewise; those of other patches are left as they are
template <typename REAL>
void MakeFacePatchPoints(BaseType const &type, int faceSize, int level, REAL const *control,
                         int size, std::ptrdiff_t stride, std::vector<int> const *wanted,
                         REAL *points);

/// \brief Evaluates the patch of a place: the point, and derivatives by u and v as far as NUM_DERIVATIVES asks:
/// 0, 1 or 2.
///
/// \param points   those of all patches
/// \param results  the point; by u, by v; by u twice, by u and v, by v twice
template <int NUM_DERIVATIVES, typename REAL>
void EvaluatePlace(Bfr::Parameterization const &parameterization, FaceShape shape, Pair const &uv,
                   int level, REAL const *points, int size, std::ptrdiff_t stride,
                   REAL *const *results);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

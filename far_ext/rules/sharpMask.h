// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_SHARP_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_SHARP_MASK_H

namespace OpenSubdivHex::FarExt::internal {

/// \brief Weights of the two neighbors of a vertex V along a sharp line, in V' = rest V + left V_l + right V_r.
struct CreaseMask {
    double left;
    double right;
};

/// \brief The mask along a crease or sharp boundary, in a hexagonal step.
///
/// The sharp edges at V are of phase A, one unit long in the lattice, or *long*: diagonals and B boundaries, of
/// two units.  The masks reproduce linear functions:
///
/// | edges   | A and A                    | A and B                     | B and B                       |
/// |---------|----------------------------|-----------------------------|-------------------------------|
/// | V'      | (6 V + V_l + V_r)/8        | (5 V + 2 V_A + V_B)/8       | (26 V + 3 V_l + 3 V_r)/32     |
/// | bounded | (2 V + 3 V_l + 3 V_r)/8    | as above                    | as above                      |
///
/// \param isBounded  whether all points of a parabola shall move alike, which bounds the curvature of the curve;
///                   otherwise it grows by sqrt(3/2) per level at vertices of two A edges
constexpr CreaseMask ComputeCreaseMask(bool isLeftLong, bool isRightLong, bool isBounded) {
    if (isLeftLong && isRightLong) {
        return {3.0 / 32, 3.0 / 32};
    }
    if (isLeftLong || isRightLong) {
        return {isLeftLong ? 1.0 / 8 : 2.0 / 8, isRightLong ? 1.0 / 8 : 2.0 / 8};
    }
    return isBounded ? CreaseMask{3.0 / 8, 3.0 / 8} : CreaseMask{1.0 / 8, 1.0 / 8};
}

/// @name The masks of FirstStep::Truncate along a sharp line
/// New points have the second moment 2/9 along the line, as all have in a regular mesh of triangles.
/// @{

/// Of W in T = (2 V + W)/3, the point beside V on the sharp edge to W.
inline constexpr double kTruncateAlongEdge = 1.0 / 3;
/// Of each neighbor in V' = (7 V + V_l + V_r)/9.
inline constexpr double kTruncateAlongCrease = 1.0 / 9;
/// Of each neighbor along the line, for what the mean of the centroids around V would bring on both sides of it:
/// (V_l + V_r - 2 V)/6.
inline constexpr double kTruncateAround = 1.0 / 6;
/// @}

} // namespace OpenSubdivHex::FarExt::internal

#endif

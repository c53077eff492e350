// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_SHARP_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_SHARP_MASK_H

namespace OpenSubdivHex::FarExt::internal {

/// \brief Weights of the two neighbors of a vertex V along a sharp line, in V' = rest V + left V_l + right V_r.
struct CreaseMask {
    double left;
    double right;
};

/// Masks along lines by level.
enum class CreaseLevel {
    First, ///< of the first steps with FaceMask::Smooth, which has masks beside the line for these
    Plain, ///< of any step
    Bounded, ///< all points of a parabola move alike, which bounds the curvature of the curve
};

/// \brief The mask along a crease or sharp boundary, in a hexagonal step.
///
/// The sharp edges at V are of phase A, one unit long in the lattice, or *long*: diagonals and B boundaries, of
/// two units.  The masks reproduce linear functions:
///
/// | edges   | A and A                    | A and B                     | B and B                           |
/// |---------|----------------------------|-----------------------------|-----------------------------------|
/// | Plain   | (6 V + V_l + V_r)/8        | (5 V + 2 V_A + V_B)/8       | (26 V + 3 V_l + 3 V_r)/32         |
/// | Bounded | (2 V + 3 V_l + 3 V_r)/8    | as above                    | as above                          |
/// | First   | V                          | as above                    | (98 V + 15 V_l + 15 V_r)/128      |
///
/// With Plain alone curvature grows by sqrt(3/2) per level at vertices of two A edges.  With First the points of the
/// line spread along it as those inside do, behind the first step by 1/4 of the square of an edge.
constexpr CreaseMask ComputeCreaseMask(bool isLeftLong, bool isRightLong, CreaseLevel level) {
    if (isLeftLong && isRightLong) {
        return level == CreaseLevel::First ? CreaseMask{15.0 / 128, 15.0 / 128}
                                           : CreaseMask{3.0 / 32, 3.0 / 32};
    }
    if (isLeftLong || isRightLong) {
        return {isLeftLong ? 1.0 / 8 : 2.0 / 8, isRightLong ? 1.0 / 8 : 2.0 / 8};
    }
    return level == CreaseLevel::First     ? CreaseMask{0, 0}
           : level == CreaseLevel::Bounded ? CreaseMask{3.0 / 8, 3.0 / 8}
                                           : CreaseMask{1.0 / 8, 1.0 / 8};
}

/// \brief The masks of Smooth in the one face that a vertex V of a smooth sharp line has on a side of the line.
///
/// Behind an odd number of hexagonal steps that face is two half faces V, W, Q, P and their mirror image, else a
/// hexagon V, N, A, B, C, M between two A edges.  Weights are in the order of the vertices from the one whose
/// F-vertex is made.
///
/// With the masks of other faces the surface across the line would shrink by .3630 per step and the bend of the
/// line by .3062, so that the side had no tangent plane but by that bend, and curvature grew by 1.22.  With these and
/// the bounded mask of ComputeCreaseMask() the line and what lies across shrink by 1/2, the bend by 1/4, the twist
/// by .2496, and all else by .1127 or less: curvature is bounded.  The third weight in atVertex holds the 1/2; the
/// others are a fit to half discs of one face, where second derivatives are as even as they get.
struct OneFaceMask {
    double atVertex[6];   ///< of the F-vertex at V, for V, N, A, B, C, M
    double atNeighbor[6]; ///< of that at N, for N, A, B, C, M, V; at M the same the other way
    double atHalf[4];     ///< of that at P in a half face, for P, V, W, Q
    double farInHalf[4];  ///< of that at Q, for Q, W, V, P
};
inline constexpr OneFaceMask kOneFaceMask = {
    {61.4444 / 256, 57.5 / 256, 39.7778 / 256, 0, 39.7778 / 256, 57.5 / 256},
    {43.5 / 256, 124.5 / 256, 0, 46.0 / 256, 0, 42.0 / 256},
    {94.5 / 256, 75.0 / 256, 34.5 / 256, 52.0 / 256},
    {122.0 / 256, 39.5 / 256, 78.0 / 256, 16.5 / 256}};

/// @name The masks of FirstStep::Truncate along a sharp line
/// New points have the second moment 2/9 along the line, as all have in a regular mesh of triangles.
/// @{

/// Weight of W in T = (2 V + W)/3, the point beside V on the sharp edge to W.
inline constexpr double kTruncateAlongEdge = 1.0 / 3;
/// Weight of each neighbor in V' = (7 V + V_l + V_r)/9.
inline constexpr double kTruncateAlongCrease = 1.0 / 9;
/// Weight of each neighbor along the line: in the place of the mean of the centroids around V stands
/// (V_l + V_r - 2 V)/6.
inline constexpr double kTruncateAround = 1.0 / 6;
/// The most faces on a side of a line where it passes through the polygon of a vertex, whose masks have as many rows.
inline constexpr int kMaxPassedFaces = 64;
/// @}

} // namespace OpenSubdivHex::FarExt::internal

#endif

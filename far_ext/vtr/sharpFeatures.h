// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_SHARP_FEATURES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_SHARP_FEATURES_H

#include "refinement.h"

#include <opensubdiv/sdc/options.h>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Gives \p child, that of \p refinement, the tags that follow from those of its parent: sharpness of edges,
/// diagonals and vertices, one step less; holes; non-manifold vertices.
///
/// The child of a crease edge is the diagonal of its E-face; the children of a diagonal are that of
/// the F-face and the spokes at its ends.  An E-face is a hole when all faces of its edge are.
/// \p child has its relations; without full topology only the tags of faces are made.
void RefineTags(Refinement const &refinement, Sdc::Options sdcOptions, Level &child);

/// \brief The sharpness of all sharp edges that meet in a vertex: boundaries, crease edges and crease diagonals.
/// Those that several fans have on one line count once.
std::vector<float> GatherSharpness(Level const &level, Far::Index vert);

/// \brief Fills level.sharpVerts and level.sectorCorners from the level's boundaries and tags, with
/// Sdc::Crease's rules.
///
/// Where a vertex meets a crease or a sharp boundary, its sharp edges are crease edges and sharp
/// boundaries (phase A, one unit long in the lattice) and diagonals and B boundaries (two units
/// long).  Along two of them, with neighbours V_A and V_B at the end of an A and of a B,
///
///     A and A: V' = (6 V + V_l + V_r)/8      A and B: V' = (5 V + 2 V_A + V_B)/8
///     B and B: V' = (26 V + 3 V_l + 3 V_r)/32
///
/// which reproduces linear functions.  Behind the first steps A and A meet at vertices of level 0
/// alone, in every second level, and from kNumStepsToConstantMasks steps on
///
///     A and A: V' = (2 V + 3 V_l + 3 V_r)/8
///
/// so that all points of a parabola move alike, which bounds curvature of the curves; earlier, the
/// surface beside them would be less even.  It does not hold where one face lies between the two
/// edges, which would have no tangent plane, since what lies across would shrink as fast as the bend of
/// the curve, nor where several sheets share the curve: there its curvature grows by sqrt(3/2) per level.
void ComputeSharpMasks(Sdc::Options sdcOptions, Level &level);

} // namespace OpenSubdivHex::FarExt::internal

#endif

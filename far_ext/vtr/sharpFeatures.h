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
/// Edges of several fans on one line count once.
std::vector<float> GatherSharpness(Level const &level, Far::Index vert);

/// \brief Fills level.sharpVerts and level.sectorCorners from the level's boundaries and tags, with
/// Sdc::Crease's rules.
///
/// Where a vertex meets a crease or a sharp boundary, V' has the mask of ComputeCreaseMask.  From
/// kNumStepsToConstantMasks steps on it is the bounded one; earlier, the surface beside it would be less even.
/// RefinementRules turn those of level 0 into the ones of FaceMask::Smooth.
/// Never bounded are masks where several sheets share the curve and, but with FaceMask::Smooth, where one face lies
/// between the two edges: that would have no tangent plane, since what lies across would shrink as fast as the bend
/// of the curve.
void ComputeSharpMasks(TagOptions options, Level &level);

} // namespace OpenSubdivHex::FarExt::internal

#endif

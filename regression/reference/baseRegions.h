// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_BASE_REGIONS_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_BASE_REGIONS_H

#include "taggedReference.h"

#include <array>

namespace OpenSubdivHex::Regression {

/// \brief By face of the last of \p levels, the face of the first in which it lies: found by
/// following the lines that edges become, and filling what lies between them.
///
/// \param levels  each refined of the one before, by hexagonal steps; all edges of the first that
///                join two faces are infinitely sharp
/// \return        -1 for a face that is reached from none or from several faces of the first
std::vector<int> FindBaseRegions(std::vector<TaggedMesh> const &levels);

/// A polygon of the plane.
using ReferencePolygon = std::vector<std::array<double, 2>>;

/// \brief The pieces into which a regular polygon of \p size sides, 1 long and the first from (0, 0)
/// to (1, 0), falls in \p numLevels levels, as drawn on paper.
///
/// A polygon of n sides falls into one of half its size, around its centre, and n trapezoids, between
/// its sides and those of the small one.  A trapezoid, whose first side is twice as long as that
/// opposite to it, falls into four of half its size: one amid its first side, and three along its
/// other sides.
std::vector<ReferencePolygon> DivideBasePolygon(int size, int numLevels);

/// \brief A piece of a base face: a face, or half a hexagon, with the places of its corners in
/// the regular polygon that the base face is.
struct BasePiece {
    int baseFace;
    int face;
    std::vector<int> corners; ///< of the face; of half a hexagon from the start of its long side
    ReferencePolygon places;
    bool isHalf;
};

/// The faces of a base mesh.
std::vector<BasePiece> MakeBasePieces(TaggedMesh const &base);
/// \brief The pieces of \p child, which a hexagonal step made of \p mesh, that pieces of that fall in.
///
/// Faces at free boundaries are left out.
std::vector<BasePiece> RefineBasePieces(TaggedMesh const &mesh, TaggedMesh const &child,
                                        std::vector<BasePiece> const &pieces);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_LATTICE_PLACES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_LATTICE_PLACES_H

#include "cellType.h"
#include "halfCell.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Where the points of a half cell lie in a regular lattice, so that linear functions of these
/// places are kept: what they are at the points, a step makes of them at the points of the children,
/// and the surface has at its coordinates.
///
/// Places are in coordinates that steps turn, and make larger by 2.
///
/// \return  by point; empty where the patch is none of such a lattice, or a step does not keep places,
///          as with FaceMask::Average
std::vector<Pair> FindLatticePlaces(CellType const &type);

/// \brief Where the points of any half cell lie if the faces of its patch are drawn as regular polygons, and
/// half faces as half hexagons, one beside another from the cell on.
///
/// Where these do not fit around a vertex, a point has the place that it was given first.
std::vector<Pair> PlacePoints(FarExt::internal::CellPatch const &cell);

/// Such coordinates of those of HalfCell.
Pair ToLattice(Pair const &p);
/// And back.
Pair FromLattice(Pair const &p);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

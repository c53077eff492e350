// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_BFR_PLACE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_BFR_PLACE_H

#include "cellStencil.h"

#include <opensubdiv/bfr/parameterization.h>

namespace OpenSubdivHex::BfrExt::internal {

namespace Bfr = OpenSubdiv::Bfr;

/// A place in the parameter plane, and the derivatives of its coordinates by Bfr's u and v.
struct PlanePlace {
    Pair uv;
    Pair byU;
    Pair byV;
};
/// \brief Where (u, v) of a valid parameterization of Bfr, which are finite, lie in the parameter plane of the face.
///
/// This has the face as a regular polygon: a linear map takes a triangle of Bfr there, a bilinear one each
/// sub-face, whose image is the kite of a corner, the centre of the face, and the middles of two edges between them.
PlanePlace FindInPlane(Bfr::Parameterization const &parameterization, Pair const &uv);

/// A place of a base face, or of a child of it, given by (u, v) of one of Bfr's parameterizations of the face.
struct BfrPlace {
    BasePoint point;
    /// By coordinate by which CellStencil finds derivatives, the derivatives of it by Bfr's u and v.
    Pair toOwn[2];
};

/// \brief Finds a place inside of a face.
///
/// \param parameterization  a valid one
/// \param tolerance         that of FindBasePoint()
BfrPlace FindBfrPlace(Bfr::Parameterization const &parameterization, Pair const &uv,
                      double tolerance);
/// \brief The place i/n on an edge, in the direction of the face; i is less than n.
///
/// The derivatives at the middle of an edge are those of the second sub-face, in which Bfr has it.
BfrPlace MakeBfrEdgePlace(Bfr::Parameterization const &parameterization, int edge, int i, int n);

/// The same place in the child that has it.
BfrPlace MoveToChild(BfrPlace const &place, CellStep const &step, int faceSize);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

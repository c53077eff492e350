// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_BFR_PLACE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_BFR_PLACE_H

#include "cellStencil.h"

#include "far_ext/vtr/faceCoords.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace Bfr = OpenSubdiv::Bfr;
using FarExt::internal::PlanePlace;

/// A place of a base face, or of a child of it, given by (u, v) of one of Bfr's parameterizations of the face.
struct BfrPlace {
    BasePoint point;
    /// By coordinate by which CellStencil finds derivatives, the derivatives of it by u and v.
    Pair toOwn[2];
    Pair mixed; ///< and its second derivatives by both; of a base face
};

/// \brief Finds a place of a base face; of one outside, where the line from the centre to it leaves the face.  Its
/// coordinates are not numbers where u or v is none.
///
/// \param parameterization  a valid one; of FindInSubFaces() with sub-faces
/// \param shape             that of the face, as large as the parameterization's
/// \param tolerance         that of FindBasePoint()
BfrPlace FindInSubFaces(Bfr::Parameterization const &parameterization, FaceShape shape,
                        Pair const &uv, double tolerance);
OPENSUBDIVHEX_INLINE BfrPlace FindBfrPlace(Bfr::Parameterization const &parameterization,
                                           FaceShape shape, Pair const &uv, double tolerance) {
    if (parameterization.HasSubFaces()) {
        return FindInSubFaces(parameterization, shape, uv, tolerance);
    }
    return {FindBasePoint(shape, uv[0], uv[1], tolerance), {{1, 0}, {0, 1}}, {0, 0}};
}
/// \brief The place i/n on an edge, in the direction of the face; i is less than n.
///
/// The derivatives at the middle of an edge are those of the second sub-face, in which Bfr has it.
BfrPlace MakeBfrEdgePlace(Bfr::Parameterization const &parameterization, FaceShape shape, int edge,
                          int i, int n);

/// The place in the child that has it.
BfrPlace MoveToChild(BfrPlace const &place, CellStep const &step, FaceShape shape);

/// \brief Turns derivatives by the coordinates of the plane of a base face into those by u and v, number by number.
///
/// \param first   two rows
/// \param second  null, or three rows: of the first coordinate twice, of both, and of the second twice
template <typename REAL>
void ToUv(BfrPlace const &place, std::size_t size, REAL *const first[2], REAL *const second[3]) {
    if (second) {
        TurnSecondDerivatives(place.toOwn, size, second);
        for (std::size_t i = 0; i < size; ++i) {
            second[1][i] +=
                REAL(place.mixed[0] * double(first[0][i]) + place.mixed[1] * double(first[1][i]));
        }
    }
    TurnDerivatives(place.toOwn, size, first[0], first[1], first[0], first[1]);
}

} // namespace OpenSubdivHex::BfrExt::internal

#endif

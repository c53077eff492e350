// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_SHAPES_FLAT_SHAPES_H
#define OPENSUBDIVHEX_REGRESSION_SHAPES_FLAT_SHAPES_H

#include "shapes.h"

namespace OpenSubdivHex::Regression {

/// The surface of numX by numY by numZ unit cubes, one vertex in the origin.
Shape MakeBox(int numX, int numY, int numZ);

/// \brief An upright prism over a regular polygon of \p numSides sides with radius 1.
///
/// Each of its sides is numColumns by numRows quads, the bottom and the top one face each, with
/// vertices in the middle of straight lines where numColumns > 1.
Shape MakePrism(int numSides, int numColumns, int numRows);

/// \brief Closed shapes with flat sides of several faces and sharp bends between them, undeformed:
/// what GetShapes() are to the plain scheme, these are to coplanar refinement.
std::vector<Shape> const &GetFlatShapes();

} // namespace OpenSubdivHex::Regression

#endif

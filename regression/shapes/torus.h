// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_SHAPES_TORUS_H
#define OPENSUBDIVHEX_REGRESSION_SHAPES_TORUS_H

#include "shapes.h"

namespace OpenSubdivHex::Regression {

/// The faces of a torus.
enum class TorusFaces {
    Quads,
    Triangles,         ///< quads that are cut in two
    IrregularTriangles ///< the same, each quad along a diagonal by chance
};

/// The radii that tori have unless others are asked for.
inline constexpr double kTorusRadius = 3;
inline constexpr double kTubeRadius = 1;

/// \brief A torus of numU x numV quads, or of twice as many triangles, \p numU around the axis, its
/// vertices at equal angles: vertex numV u + v at u around the axis and at v around the tube.
Shape MakeTorus(int numU, int numV, TorusFaces faces, double radius = kTorusRadius,
                double tubeRadius = kTubeRadius);

} // namespace OpenSubdivHex::Regression

#endif

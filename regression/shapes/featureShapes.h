// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_SHAPES_FEATURE_SHAPES_H
#define OPENSUBDIVHEX_REGRESSION_SHAPES_FEATURE_SHAPES_H

#include "shapes.h"

namespace OpenSubdivHex::Regression {

/// The regular tilings of the plane.
enum class Tiling { Triangles, Quads, Hexagons };

/// \brief A regular planar piece of a tiling, undeformed, with edges of length 1: numX by numY
/// quads, each two triangles in a row of equilateral ones, or rows and columns of hexagons.
///
/// Rows of triangles and quads are straight lines y = const of the first numX + 1 vertices.
Shape MakeTiling(Tiling tiling, int numX, int numY);

/// \brief Shapes with tags, borders, face-varying channels and flaws, each feature alone and in
/// combination: what GetShapes() are to the plain scheme.  Sharpnesses are dyadic fractions, so
/// that their arithmetic is exact.  No two faces run an edge in the same direction.
std::vector<Shape> const &GetFeatureShapes();

/// GetShapes(), and behind them GetFeatureShapes().
std::vector<Shape> const &GetAllShapes();

/// The shape of that name; throws std::out_of_range if there is none.
Shape const &GetFeatureShape(std::string const &name);

/// A channel whose values are those of the vertices: no seams.
FVarChannel MakeVertexChannel(Shape const &shape);

/// A channel in which the values at both sides of the edges \p pairs (two vertices each) differ.
/// Around a vertex the corners that no cut edge parts share a value.
FVarChannel MakeSeamChannel(Shape const &shape, std::vector<int> const &pairs);

/// A channel in which no two faces share a value.
FVarChannel MakeFaceChannel(Shape const &shape);

} // namespace OpenSubdivHex::Regression

#endif

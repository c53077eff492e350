// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_MESHES_H
#define OPENSUBDIVHEX_REGRESSION_PERF_MESHES_H

#include "regression/shapes/shapes.h"

namespace OpenSubdivHex::Regression {

/// \brief The base meshes of the benchmarks: tori, larger than the shapes of the tests.
/// @{
Shape MakeQuadMesh();     ///< 1,536 quads
Shape MakeTriangleMesh(); ///< 5,120 triangles
Shape MakeHexMesh();      ///< 2,560 hexagons
/// 5,120 triangles, of which 4 to 8 meet at a vertex, as in meshes that were reduced.
Shape MakeIrregularMesh();
Shape MakeSmallQuadMesh(); ///< 384 quads, for many levels
/// As large as scans: 640,000 quads, or twice as many triangles.
Shape MakeLargeMesh(bool triangles);
/// 100,000 quads, and as many vertices: a control mesh that a device has to itself.
Shape MakeFrameMesh();
/// @}

/// The number of edges of a closed shape.
double CountEdges(Shape const &shape);

/// The vertices of a closed shape at \p level of the hexagonal scheme.
double CountHexVertices(Shape const &shape, int level);

/// The vertices of a closed shape after \p level steps of Catmull-Clark.
double CountCatmarkVertices(Shape const &shape, int level);

/// Counts the vertices of Doo-Sabin.
double CountDooSabinVertices(Shape const &shape, int level);

} // namespace OpenSubdivHex::Regression

#endif

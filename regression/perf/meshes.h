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
/// @}

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_TRIANGLE_INDICES_H
#define OPENSUBDIVHEX_OSD_EXT_TRIANGLE_INDICES_H

#include "polygonIndices.h"

namespace OpenSubdivHex::OsdExt {

/// \brief Index buffers of the triangles that draw a level: three corners each.
///
/// \code
///     OsdExt::TriangleIndices const triangles = OsdExt::CreateTriangleIndices(refiner->GetLevel(3));
///     Draw(triangles.vertices.data(), triangles.GetNumTriangles());
/// \endcode
struct TriangleIndices : DrawnFaces {
    /// How many there are.
    int GetNumTriangles() const { return int(faces.size()); }
};

/// \brief Triangulates polygons, in their order and orientation.  A polygon of n sides makes n - 2 triangles that zigzag
/// across it, so that no vertex has them all; one of less than three sides makes none.
///
/// Works in parallel, with the same result for any number of threads; several threads may call it at
/// once.  std::bad_alloc passes through.
OPENSUBDIVHEX_API TriangleIndices CreateTriangleIndices(PolygonIndices const &polygons);

/// \brief The triangles of CreatePolygonIndices(level, options, status).
///
/// Hexagons make four triangles, cut or not.
OPENSUBDIVHEX_API TriangleIndices CreateTriangleIndices(FarExt::TopologyLevel const &level,
                                                        DrawOptions const &options = DrawOptions(),
                                                        FarExt::CallStatus *status = nullptr);

} // namespace OpenSubdivHex::OsdExt

#endif

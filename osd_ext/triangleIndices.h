// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_TRIANGLE_INDICES_H
#define OPENSUBDIVHEX_OSD_EXT_TRIANGLE_INDICES_H

#include "polygonIndices.h"

namespace OpenSubdivHex::OsdExt {

/// \brief The faces of a level as triangles: three corners each.
struct TriangleIndices : DrawnFaces {
    /// How many there are.
    int GetNumTriangles() const { return int(faces.size()); }
};

/// \brief Triangulates polygons: one of n sides makes n - 2 triangles that zigzag across it, so that
/// no vertex collects them all, one of less than three none.  They are in the order and the orientation of the polygons.
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

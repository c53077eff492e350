// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HEXVIEW_DRAWN_TOPOLOGY_H
#define OPENSUBDIVHEX_TOOLS_HEXVIEW_DRAWN_TOPOLOGY_H

#include <vector>

namespace OpenSubdivHex::Tools {

constexpr int kLength = 3; ///< floats of a point

/// \brief The drawing of a surface without its points: polygons, and the triangles they are cut into.
///
/// Corners are sides of vertices: a vertex that a crease splits for shading has several, each with a
/// normal of its own.
struct DrawnTopology {
    std::vector<unsigned> sideVertices; ///< by side
    std::vector<int> polygonSizes;
    std::vector<int> polygonSides;  ///< by corner of a polygon
    std::vector<int> triangleSides; ///< by corner of a triangle
    std::vector<float> coords;      ///< u and v of each
    std::vector<int> triangleFaces; ///< base face and level by triangle
};

} // namespace OpenSubdivHex::Tools

#endif

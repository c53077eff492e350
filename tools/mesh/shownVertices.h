// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_SHOWN_VERTICES_H
#define OPENSUBDIVHEX_TOOLS_SHOWN_VERTICES_H

#include "far_ext/topologyLevel.h"
#include "mesh.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \name Vertices of a picture
/// Cameras look at these alone, and they alone have a size: the corners of all faces, and halves of
/// hexagons, that are no holes; where all are holes, of all faces.  In ascending order, each once.
/// @{
std::vector<int> FindShownVertices(FarExt::TopologyLevel const &level);
std::vector<int> FindShownVertices(Mesh const &mesh);
/// @}

/// The positions, x y z each, of \p vertices alone.
template <typename REAL>
std::vector<REAL> GatherPositions(std::vector<int> const &vertices,
                                  std::vector<REAL> const &positions) {
    std::vector<REAL> result;
    result.reserve(3 * vertices.size());
    for (int const vertex : vertices) {
        auto const position = positions.begin() + 3 * std::ptrdiff_t(vertex);
        result.insert(result.end(), position, position + 3);
    }
    return result;
}

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PATCH_CREASES_H
#define OPENSUBDIVHEX_TOOLS_PATCH_CREASES_H

#include "bfr_ext/levelTessellation.h"
#include "far_ext/surfaceFaces.h"
#include "far_ext/topologyLevel.h"
#include "mesh.h"

namespace OpenSubdivHex::Tools {

/// \brief Makes creases of what the infinitely sharp edges of a base face became in its tessellation, so
/// that normals have a side each there.  Each edge is done with the first of its faces.
///
/// \param base      the surface level
/// \param face      a surface face
/// \param vertices  of the tessellation's coords
inline void AddPatchCreases(FarExt::TopologyLevel const &base, int face,
                            BfrExt::LevelTessellation const &tessellation,
                            std::vector<int> const &vertices, MeshTags *tags) {
    int const numBoundary = tessellation.GetNumBoundaryCoords();
    FarExt::SurfaceFaces const faces(base.GetLevel());
    int place = 0;
    for (int local = 0; local < faces.GetShape(face).size; ++local) {
        int const end = place + tessellation.GetNumEdgeCoords(local) + 1;
        auto const [edge, isReversed] = faces.GetEdge(face, local);
        bool const isDiagonal = edge >= base.GetNumEdges();
        bool const isCrease =
            isDiagonal || (base.IsEdgeInfSharp(edge) && !base.IsEdgeBoundary(edge));
        for (; place < end; ++place) {
            if (isCrease && !isReversed) {
                for (int const coord : {place, (place + 1) % numBoundary}) {
                    tags->creaseVertices.push_back(vertices[std::size_t(coord)]);
                }
                tags->creaseSharpness.push_back(OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE);
            }
        }
    }
}

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PATCH_CREASES_H
#define OPENSUBDIVHEX_TOOLS_PATCH_CREASES_H

#include "bfr_ext/levelTessellation.h"
#include "far_ext/topologyLevel.h"
#include "mesh.h"

namespace OpenSubdivHex::Tools {

/// \brief Makes creases of what the infinitely sharp edges of a base face became in its tessellation, so
/// that normals have a side each there.  Each edge is done with the first of its faces.
///
/// \param vertices  of the tessellation's coords
inline void AddPatchCreases(FarExt::TopologyLevel const &base, int face,
                            BfrExt::LevelTessellation const &tessellation,
                            std::vector<int> const &vertices, MeshTags *tags) {
    int const numBoundary = tessellation.GetNumBoundaryCoords();
    FarExt::TopologyLevel::ConstIndexArray const edges = base.GetFaceEdges(face);
    int place = 0;
    for (int local = 0; local < edges.size(); ++local) {
        int const end = place + tessellation.GetNumEdgeCoords(local) + 1;
        bool const isFirst = base.GetEdgeFaces(edges[local])[0] == face;
        bool const isCrease =
            base.IsEdgeInfSharp(edges[local]) && !base.IsEdgeBoundary(edges[local]);
        for (; place < end; ++place) {
            if (isCrease && isFirst) {
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

// SPDX-License-Identifier: Apache-2.0
#include "meshCenter.h"

#include <stdexcept>

namespace OpenSubdivHex::Regression {

MeshCenter FindChild(MeshCenter center, FarExt::TopologyLevel const &level,
                     FarExt::TopologyLevel const &cLevel) {
    if (center.kind == CenterKind::Face) {
        return {CenterKind::Face, level.GetFaceChildFaces(center.index)[0]};
    }
    int const cVertex = level.GetVertexChildVertex(center.index);
    if (cVertex != Far::INDEX_INVALID) {
        return {CenterKind::Vertex, cVertex};
    }
    for (int face = 0; face < cLevel.GetNumFaces(); ++face) {
        if (cLevel.GetFaceParentVertex(face) == center.index) {
            return {CenterKind::Face, face};
        }
    }
    throw std::runtime_error("a vertex makes neither a vertex nor a face");
}

MeshCenter FindChild(MeshCenter center, OpenSubdiv::Far::TopologyLevel const &level,
                     OpenSubdiv::Far::TopologyLevel const &) {
    return {CenterKind::Vertex, center.kind == CenterKind::Vertex
                                    ? level.GetVertexChildVertex(center.index)
                                    : level.GetFaceChildVertex(center.index)};
}

} // namespace OpenSubdivHex::Regression

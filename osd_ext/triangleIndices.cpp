// SPDX-License-Identifier: Apache-2.0
#include "triangleIndices.h"

namespace OpenSubdivHex::OsdExt {

TriangleIndices CreateTriangleIndices(FarExt::TopologyLevel const &level, int vertexOffset) {
    TriangleIndices result;
    std::size_t const numTriangles =
        std::size_t(level.GetNumFaceVertices()) - 2 * std::size_t(level.GetNumFaces());
    result.vertices.reserve(3 * numTriangles);
    result.faces.reserve(numTriangles);
    result.baseFaces.reserve(numTriangles);

    for (Far::Index face = 0; face < level.GetNumFaces(); ++face) {
        Far::ConstIndexArray const verts = level.GetFaceVertices(face);
        int const baseFace = level.GetFaceBaseFace(face);
        auto add = [&](int i, int j, int k) {
            for (int corner : {i, j, k}) {
                result.vertices.push_back(vertexOffset + verts[corner]);
            }
            result.faces.push_back(face);
            result.baseFaces.push_back(baseFace);
        };
        // From both ends towards the middle, in turn.
        int low = 0;
        int high = verts.size() - 1;
        while (high - low >= 2) {
            add(low, low + 1, high);
            ++low;
            if (high - low >= 2) {
                add(low, high - 1, high);
                --high;
            }
        }
    }
    return result;
}

} // namespace OpenSubdivHex::OsdExt

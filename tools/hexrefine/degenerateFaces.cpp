// SPDX-License-Identifier: Apache-2.0
#include "degenerateFaces.h"

#include <algorithm>
#include <vector>

namespace OpenSubdivHex::Tools {

std::string DescribeDegenerateFaces(Mesh const &mesh) {
    int numFaces = 0;
    int firstFace = 0;
    std::vector<int> vertices;
    auto first = mesh.faceVertices.begin();
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        auto const last = first + mesh.faceSizes[std::size_t(face)];
        vertices.assign(first, last);
        std::sort(vertices.begin(), vertices.end());
        if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end() &&
            numFaces++ == 0) {
            firstFace = face;
        }
        first = last;
    }
    return numFaces == 0
               ? ""
               : std::to_string(numFaces) + (numFaces == 1 ? " face has" : " faces have") +
                     " a vertex several times, first face " + std::to_string(firstFace);
}

} // namespace OpenSubdivHex::Tools

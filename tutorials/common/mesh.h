// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_MESH_H
#define OPENSUBDIVHEX_TUTORIALS_MESH_H

#include <vector>

namespace OpenSubdivHex::Tutorials {

/// \brief A polygon mesh as flat arrays, the form that Far::TopologyDescriptor takes.
struct Mesh {
    std::vector<float> positions;  ///< x y z of each vertex
    std::vector<int> faceSizes;    ///< number of corners of each face
    std::vector<int> faceVertices; ///< vertices of all faces, one face after the other

    int GetNumVertices() const { return int(positions.size() / 3); }
    int GetNumFaces() const { return int(faceSizes.size()); }
};

} // namespace OpenSubdivHex::Tutorials

#endif

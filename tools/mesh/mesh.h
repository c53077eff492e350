// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_H
#define OPENSUBDIVHEX_TOOLS_MESH_H

#include <opensubdiv/sdc/options.h>

#include <optional>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief What makes some edges, vertices and faces of a mesh special, and the rules that its file
/// asks for.  Each edge, vertex and face is named once, with a sharpness above 0.
struct MeshTags {
    using Options = OpenSubdiv::Sdc::Options;

    std::vector<int> creaseVertices{}; ///< the two vertices of each crease edge
    std::vector<float> creaseSharpness{};
    std::vector<int> cornerVertices{};
    std::vector<float> cornerSharpness{};
    std::vector<int> holes{}; ///< faces
    std::optional<Options::VtxBoundaryInterpolation> boundary{};
    std::optional<Options::FVarLinearInterpolation> fvarInterpolation{};
    std::optional<Options::CreasingMethod> creasingMethod{};

    int GetNumCreases() const { return int(creaseSharpness.size()); }
    int GetNumCorners() const { return int(cornerSharpness.size()); }
    int GetNumHoles() const { return int(holes.size()); }
};

enum class FVarKind { Uv, Normal };

/// \brief Face-varying data: values, and the one that each face corner has.  Along a seam the faces
/// to both sides have different values at the same vertices.
struct FVarChannel {
    FVarKind kind = FVarKind::Uv;
    int width = 2; ///< floats per value
    std::vector<float> values{};
    std::vector<int> faceValues{}; ///< the value of each corner, parallel to Mesh::faceVertices

    int GetNumValues() const { return int(values.size() / std::size_t(width)); }
};

/// \brief A polygon mesh as flat arrays, the form that Far::TopologyDescriptor takes.
struct Mesh {
    std::vector<float> positions{};  ///< x y z of each vertex
    std::vector<int> faceSizes{};    ///< number of corners of each face
    std::vector<int> faceVertices{}; ///< vertices of all faces, one face after the other
    std::vector<FVarChannel> channels{};
    std::vector<float> vertexNormals{}; ///< x y z of each vertex, or empty; of a mesh to write
    MeshTags tags{};

    int GetNumVertices() const { return int(positions.size() / 3); }
    int GetNumFaces() const { return int(faceSizes.size()); }
};

} // namespace OpenSubdivHex::Tools

#endif

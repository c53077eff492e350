// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_H
#define OPENSUBDIVHEX_TOOLS_MESH_H

#include "numberType.h"

#include <opensubdiv/sdc/options.h>

#include <optional>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Sharp edges, sharp vertices and holes of a mesh, and the rules that its file
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

inline std::string GetName(FVarKind kind) { return kind == FVarKind::Uv ? "uv" : "normal"; }

/// The name of the vertex property that holds number \p k of such a value: s, t and r; nx, ny and nz.
inline std::string GetPropertyName(FVarKind kind, int k) {
    return kind == FVarKind::Uv ? std::string(1, "str"[k]) : std::string("n") + "xyz"[k];
}

/// \brief Face-varying data: values, and the one that each face corner has.  Along a seam the faces
/// to both sides have different values at the same vertices.
struct FVarChannel {
    FVarKind kind = FVarKind::Uv;
    int width = 2; ///< floats per value
    std::vector<float> values{};
    std::vector<int> faceValues{}; ///< the value of each corner, parallel to Mesh::faceVertices

    int GetNumValues() const { return int(values.size() / std::size_t(width)); }
};

/// \brief A number that each vertex has beside its position, such as the red of its colour.  Names
/// are those of PLY: red, green, blue and alpha; nx, ny and nz; s, t and r of texture coordinates; w is
/// the fourth coordinate of OBJ.  Values are refined as varying data.
struct VertexProperty {
    std::string name{};
    NumberType type = NumberType::Float; ///< that files hold
    std::vector<float> values{};
};

/// A number that each base face has, and with it the faces that are refined from it.
struct FaceProperty {
    std::string name{};
    NumberType type = NumberType::Float; ///< that files hold
    std::vector<double> values{};        ///< by base face
};

/// The statements of an OBJ file for a face, each as the words behind its keyword; empty without a
/// statement.
struct FaceLabel {
    std::string object{};    ///< o
    std::string groups{};    ///< g
    std::string material{};  ///< usemtl
    std::string smoothing{}; ///< s
};

inline bool operator==(FaceLabel const &a, FaceLabel const &b) {
    return a.object == b.object && a.groups == b.groups && a.material == b.material &&
           a.smoothing == b.smoothing;
}

/// \brief A polygon mesh as flat arrays, the form that Far::TopologyDescriptor takes.
///
/// Data of faces (labels, properties) are kept by base face: the face of the mesh that a face was
/// refined from.  In a mesh that was not refined each face is its own base face.
struct Mesh {
    std::vector<float> positions{};  ///< x y z of each vertex
    std::vector<int> faceSizes{};    ///< number of corners of each face
    std::vector<int> faceVertices{}; ///< vertices of all faces, one face after the other
    std::vector<FVarChannel> channels{};
    std::vector<VertexProperty> vertexProperties{};
    std::vector<FaceProperty> faceProperties{};
    std::vector<FaceLabel> labels{}; ///< that differ, in the order in which the file has them
    std::vector<int> faceLabels{};   ///< label of each base face; empty: there are none
    std::vector<int> baseFaces{};    ///< of each face; empty: the face itself
    std::vector<std::string> materialLibraries{}; ///< what OBJ's statements mtllib say
    std::vector<std::string> notRead{};  ///< names of what else the file has and this does not
    std::vector<std::string> warnings{}; ///< of what the file may have been meant to say
    MeshTags tags{};

    int GetNumVertices() const { return int(positions.size() / 3); }
    int GetNumFaces() const { return int(faceSizes.size()); }
    int GetBaseFace(int face) const {
        return baseFaces.empty() ? face : baseFaces[std::size_t(face)];
    }
};

/// The property of \p properties with this name; null if there is none.
template <typename PROPERTY>
PROPERTY const *FindProperty(std::vector<PROPERTY> const &properties, std::string const &name) {
    for (PROPERTY const &property : properties) {
        if (property.name == name) {
            return &property;
        }
    }
    return nullptr;
}

/// Adds \p name to Mesh::notRead, once.
inline void AddNotRead(std::string const &name, Mesh *mesh) {
    for (std::string const &other : mesh->notRead) {
        if (name == other) {
            return;
        }
    }
    mesh->notRead.push_back(name);
}

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#include "subdivisionPeer.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/CatmullClarkT.hh>

#include <stdexcept>

namespace OpenSubdivHex::Regression {
namespace {

using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;

class OpenMeshPeer : public SubdivisionPeer {
public:
    explicit OpenMeshPeer(Shape const &shape) {
        for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
            _base.add_vertex(Mesh::Point(float(shape.positions[i]), float(shape.positions[i + 1]),
                                         float(shape.positions[i + 2])));
        }
        std::vector<Mesh::VertexHandle> corners;
        int const *vertex = shape.faceVertices.data();
        for (int size : shape.faceSizes) {
            corners.clear();
            for (int i = 0; i < size; ++i) {
                corners.emplace_back(*vertex++);
            }
            if (!_base.add_face(corners).is_valid()) {
                throw std::runtime_error("OpenMesh refuses a face");
            }
        }
    }

    void Prepare() override { _mesh = std::make_unique<Mesh>(_base); }

    void Subdivide(int level) override {
        OpenMesh::Subdivider::Uniform::CatmullClarkT<Mesh, float> subdivider;
        subdivider.attach(*_mesh);
        if (!subdivider(std::size_t(level))) {
            throw std::runtime_error("OpenMesh did not subdivide");
        }
        subdivider.detach();
    }

    int GetNumVertices() const override { return int(_mesh->n_vertices()); }

    void Release() override { _mesh.reset(); }

private:
    Mesh _base;
    std::unique_ptr<Mesh> _mesh;
};

} // namespace

std::unique_ptr<SubdivisionPeer> MakeOpenMeshPeer(Shape const &shape) {
    return std::make_unique<OpenMeshPeer>(shape);
}

std::string GetOpenMeshVersion() {
    return std::to_string(OM_GET_VER) + "." + std::to_string(OM_GET_MAJ);
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "subdivisionPeer.h"

#ifdef PERF_HAS_CGAL
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>

#include <stdexcept>
#endif

namespace OpenSubdivHex::Regression {

#ifdef PERF_HAS_CGAL
namespace {

using Point = CGAL::Simple_cartesian<float>::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

class CgalPeer : public SubdivisionPeer {
public:
    explicit CgalPeer(Shape const &shape) {
        for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
            _base.add_vertex(Point(float(shape.positions[i]), float(shape.positions[i + 1]),
                                   float(shape.positions[i + 2])));
        }
        std::vector<Mesh::Vertex_index> corners;
        int const *vertex = shape.faceVertices.data();
        for (int size : shape.faceSizes) {
            corners.clear();
            for (int i = 0; i < size; ++i) {
                corners.emplace_back(unsigned(*vertex++));
            }
            if (_base.add_face(corners) == Mesh::null_face()) {
                throw std::runtime_error("CGAL refuses a face");
            }
        }
    }

    void Prepare() override { _mesh = std::make_unique<Mesh>(_base); }

    void Subdivide(int level) override {
        CGAL::Subdivision_method_3::DooSabin_subdivision(
            *_mesh, CGAL::parameters::number_of_iterations(unsigned(level)));
    }

    /// Without those that were removed and stay in its arrays.
    int GetNumVertices() const override { return int(_mesh->number_of_vertices()); }

    void Release() override { _mesh.reset(); }

private:
    Mesh _base;
    std::unique_ptr<Mesh> _mesh;
};

} // namespace

std::unique_ptr<SubdivisionPeer> MakeCgalPeer(Shape const &shape) {
    return std::make_unique<CgalPeer>(shape);
}

std::string GetCgalVersion() { return CGAL_VERSION_STR; }
#else
std::unique_ptr<SubdivisionPeer> MakeCgalPeer(Shape const &) { return nullptr; }

std::string GetCgalVersion() { return "none"; }
#endif

} // namespace OpenSubdivHex::Regression

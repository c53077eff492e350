// SPDX-License-Identifier: Apache-2.0
//
// Doo-Sabin with the Cosine mask is CGAL's DooSabin_subdivision.
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/flatShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

namespace OpenSubdivHex::Regression::dooSabinTest {

namespace {

using CgalMesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

using Point = std::array<double, 3>;

double distance(Point const &a, Point const &b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// A mesh whose numbering does not matter.
struct Polygons {
    std::vector<Point> points;
    std::vector<std::vector<int>> faces;
};

Polygons refineByCgal(Shape const &shape, int level) {
    CgalMesh mesh;
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        mesh.add_vertex({shape.positions[i], shape.positions[i + 1], shape.positions[i + 2]});
    }
    auto vertex = shape.faceVertices.begin();
    for (int size : shape.faceSizes) {
        std::vector<CgalMesh::Vertex_index> face;
        for (int i = 0; i < size; ++i) {
            face.push_back(CgalMesh::Vertex_index(*vertex++));
        }
        EXPECT_NE(mesh.add_face(face), CgalMesh::null_face());
    }
    CGAL::Subdivision_method_3::DooSabin_subdivision(mesh,
                                                     CGAL::parameters::number_of_iterations(level));
    mesh.collect_garbage();
    Polygons result;
    for (auto v : mesh.vertices()) {
        result.points.push_back({mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()});
    }
    for (auto f : mesh.faces()) {
        result.faces.emplace_back();
        for (auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
            result.faces.back().push_back(int(v.idx()));
        }
    }
    return result;
}

/// For each of \p others the point within \p tolerance of it, none twice; -1 where there is none.
std::vector<int> matchPoints(std::vector<Point> const &points, std::vector<Point> const &others,
                             double tolerance) {
    std::vector<std::pair<double, int>> byX;
    for (std::size_t i = 0; i < points.size(); ++i) {
        byX.emplace_back(points[i][0], int(i));
    }
    std::sort(byX.begin(), byX.end());
    std::vector<bool> isTaken(points.size());
    std::vector<int> matches;
    for (Point const &other : others) {
        int match = -1;
        auto place = std::lower_bound(byX.begin(), byX.end(), std::pair(other[0] - tolerance, -1));
        for (; match < 0 && place != byX.end() && place->first <= other[0] + tolerance; ++place) {
            int const candidate = place->second;
            if (!isTaken[candidate] && distance(points[candidate], other) <= tolerance) {
                match = candidate;
                isTaken[match] = true;
            }
        }
        matches.push_back(match);
    }
    return matches;
}

/// Faces that begin with their smallest vertex, in terms of \p newVertices.
std::set<std::vector<int>> normalized(std::vector<std::vector<int>> faces,
                                      std::vector<int> const &newVertices) {
    std::set<std::vector<int>> result;
    for (std::vector<int> &face : faces) {
        for (int &v : face) {
            v = newVertices[v];
        }
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        result.insert(face);
    }
    return result;
}

/// Positions by a stencil table of double precision.
Polygons refineByLibrary(Shape const &shape, int level) {
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask = FarExt::FaceMask::Cosine;
    options.hexSchemeOptions.schemeType = FarExt::SchemeType::DooSabin;
    ShapeDescriptor const descriptor(shape);
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
    EXPECT_TRUE(refiner && refiner->RefineUniform(level));
    using Factory = FarExt::StencilTableFactoryReal<double>;
    Factory::Options tableOptions;
    tableOptions.generateIntermediateLevels = false;
    auto const table = Factory::Create(*refiner, tableOptions);
    Polygons result;
    for (int i = 0; i < table->GetNumStencils(); ++i) {
        auto const stencil = table->GetStencil(i);
        Point point{};
        for (int j = 0; j < stencil.GetSize(); ++j) {
            for (int axis = 0; axis < 3; ++axis) {
                point[axis] += stencil.GetWeights()[j] *
                               shape.positions[3 * stencil.GetVertexIndices()[j] + axis];
            }
        }
        result.points.push_back(point);
    }
    FarExt::TopologyLevel const &topology = refiner->GetLevel(level);
    for (int f = 0; f < topology.GetNumFaces(); ++f) {
        auto const vertices = topology.GetFaceVertices(f);
        result.faces.emplace_back(vertices.begin(), vertices.end());
    }
    return result;
}

} // namespace

TEST(Cgal, DooSabinWithCosineMaskIsTheSame) {
    int numShapes = 0;
    for (auto const *shapes : {&GetManifoldShapes(), &GetFlatShapes()}) {
        for (Shape shape : *shapes) {
            shape.fvarChannels.clear();
            // CGAL takes no dihedra: two edges would join the same vertices.
            if (!shape.closed || shape.name.rfind("dihedron", 0) == 0) {
                continue;
            }
            ++numShapes;
            for (int level = 1; level <= GetTestLevel(shape, 3, 20000); ++level) {
                SCOPED_TRACE(shape.name + ", level " + std::to_string(level));
                Polygons const ours = refineByLibrary(shape, level);
                Polygons const theirs = refineByCgal(shape, level);
                ASSERT_EQ(ours.points.size(), theirs.points.size());
                ASSERT_EQ(ours.faces.size(), theirs.faces.size());
                std::vector<int> const matches = matchPoints(ours.points, theirs.points, 1e-12);
                ASSERT_EQ(std::count(matches.begin(), matches.end(), -1), 0);
                std::vector<int> same(ours.points.size());
                std::iota(same.begin(), same.end(), 0);
                EXPECT_EQ(normalized(theirs.faces, matches), normalized(ours.faces, same));
            }
        }
    }
    EXPECT_GE(numShapes, 20);
}

} // namespace OpenSubdivHex::Regression::dooSabinTest

// SPDX-License-Identifier: Apache-2.0
//
// Doo-Sabin with the Cosine mask is CGAL's DooSabin_subdivision.
#include "regression/reference/taggedReference.h"
#include "regression/shapes/flatShapes.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace OpenSubdivHex::Regression {

namespace {

using CgalMesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

/// A mesh without the numbering of its vertices and faces.
struct Polygons {
    ReferenceValues points;
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
    result.points.resize(mesh.number_of_vertices(), 3);
    for (auto v : mesh.vertices()) {
        result.points.row(v.idx()) << mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z();
    }
    for (auto f : mesh.faces()) {
        result.faces.emplace_back();
        for (auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
            result.faces.back().push_back(int(v.idx()));
        }
    }
    return result;
}

/// The row of \p points within \p tolerance of each row of \p others, no row twice; -1 where none is.
std::vector<int> matchPoints(ReferenceValues const &points, ReferenceValues const &others,
                             double tolerance) {
    std::vector<std::pair<double, int>> byX;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        byX.emplace_back(points(i, 0), int(i));
    }
    std::sort(byX.begin(), byX.end());
    std::vector<bool> isTaken(points.rows());
    std::vector<int> matches;
    for (Eigen::Index i = 0; i < others.rows(); ++i) {
        int match = -1;
        auto place =
            std::lower_bound(byX.begin(), byX.end(), std::pair(others(i, 0) - tolerance, -1));
        for (; match < 0 && place != byX.end() && place->first <= others(i, 0) + tolerance;
             ++place) {
            int const candidate = place->second;
            if (!isTaken[candidate] &&
                (points.row(candidate) - others.row(i)).norm() <= tolerance) {
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

Polygons refineByReference(Shape const &shape, int level) {
    TaggedBase base;
    base.numVertices = shape.GetNumVertices();
    base.faceSizes = shape.faceSizes;
    base.faceVertices = shape.faceVertices;
    base.vertexSharpness.resize(base.numVertices);
    base.nonManifoldVertices.resize(base.numVertices);
    TaggedMesh mesh = MakeTaggedMesh(base);
    Polygons result;
    result.points = Eigen::Map<ReferenceValues const>(shape.positions.data(), base.numVertices, 3);
    ReferenceStep step;
    step.scheme = ReferenceScheme::DooSabin;
    for (int i = 0; i < level; ++i) {
        TaggedMesh const child = Refine(mesh, step);
        result.points = Interpolate(mesh, child, ReferenceMask::Cosine, result.points);
        mesh = child;
    }
    for (auto const &face : mesh.faces) {
        result.faces.push_back(face.vertices);
    }
    return result;
}

} // namespace

TEST(Cgal, DooSabinWithCosineMaskIsTheSame) {
    int numShapes = 0;
    for (auto const *shapes : {&GetManifoldShapes(), &GetFlatShapes()}) {
        for (Shape const &shape : *shapes) {
            // CGAL takes no dihedra: two edges would join the same vertices.
            if (!shape.closed || shape.name.rfind("dihedron", 0) == 0) {
                continue;
            }
            ++numShapes;
            for (int level = 1; level <= GetTestLevel(shape, 3, 20000); ++level) {
                SCOPED_TRACE(shape.name + ", level " + std::to_string(level));
                Polygons const ours = refineByReference(shape, level);
                Polygons const theirs = refineByCgal(shape, level);
                ASSERT_EQ(ours.points.rows(), theirs.points.rows());
                ASSERT_EQ(ours.faces.size(), theirs.faces.size());
                double const size = ours.points.cwiseAbs().maxCoeff();
                std::vector<int> const matches =
                    matchPoints(ours.points, theirs.points, 1e-12 * size);
                ASSERT_EQ(std::count(matches.begin(), matches.end(), -1), 0);
                std::vector<int> same(ours.points.rows());
                std::iota(same.begin(), same.end(), 0);
                EXPECT_EQ(normalized(theirs.faces, matches), normalized(ours.faces, same));
            }
        }
    }
    EXPECT_GE(numShapes, 20);
}

} // namespace OpenSubdivHex::Regression

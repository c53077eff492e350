// SPDX-License-Identifier: Apache-2.0
#include "reference.h"

#include "regression/shapes/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace OpenSubdivHex::Regression::referenceTest {

namespace {

ReferenceMask const kMasks[] = {ReferenceMask::Average, ReferenceMask::Cosine,
                                ReferenceMask::Smooth};

ReferenceMesh makeMesh(Shape const &shape) {
    return MakeReferenceMesh(shape.positions, shape.faceSizes, shape.faceVertices);
}

ReferenceMesh makePolygon(int n) {
    std::vector<double> positions;
    std::vector<int> vertices;
    for (int i = 0; i < n; ++i) {
        positions.insert(positions.end(), {std::cos(2 * i * std::acos(-1.0) / n),
                                           std::sin(2 * i * std::acos(-1.0) / n), 0});
        vertices.push_back(i);
    }
    return MakeReferenceMesh(positions, {n}, vertices);
}

ReferenceMesh makeUnitCube() {
    std::vector<double> positions;
    for (int i = 0; i < 8; ++i) {
        positions.insert(positions.end(),
                         {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
    }
    return MakeReferenceMesh(
        positions, std::vector<int>(6, 4),
        {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5});
}

int findVertex(ReferenceLevel const &level, bool isFVertex, int vertex, int face = -1) {
    for (std::size_t i = 0; i < level.vertexOrigins.size(); ++i) {
        ReferenceVertexOrigin const &origin = level.vertexOrigins[i];
        if (origin.isFVertex == isFVertex && origin.vertex == vertex && origin.face == face) {
            return int(i);
        }
    }
    throw std::out_of_range("no such vertex");
}

void expectPoint(ReferenceLevel const &level, int vertex, double x, double y, double z) {
    ReferenceMesh::Point const &p = level.mesh.point(ReferenceMesh::VertexHandle(vertex));
    EXPECT_NEAR(p[0], x, 1e-15);
    EXPECT_NEAR(p[1], y, 1e-15);
    EXPECT_NEAR(p[2], z, 1e-15);
}

/// The weights of a face's vertices in the new point beside vertex 0, from unit impulses.
std::vector<double> faceMask(ReferenceMask mask, int n) {
    ReferenceMesh const mesh = makePolygon(n);
    ReferenceLevel const child = Refine(mesh, mask);
    ReferenceValues const impulses = ReferenceValues::Identity(n, n);
    ReferenceValues const result = Interpolate(mesh, child, mask, impulses);
    std::vector<double> weights(n);
    for (int i = 0; i < n; ++i) {
        weights[i] = result(findVertex(child, true, 0, 0), i);
    }
    return weights;
}

void expectWeights(ReferenceMask mask, std::vector<double> expected, double denominator) {
    std::vector<double> const weights = faceMask(mask, int(expected.size()));
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(weights[i], expected[i] / denominator, 1e-15) << "weight " << i;
    }
}

std::array<std::size_t, 3> counts(ReferenceMesh const &mesh) {
    return {mesh.n_vertices(), mesh.n_edges(), mesh.n_faces()};
}

int countBoundaryEdges(ReferenceMesh const &mesh) {
    int count = 0;
    for (auto edge : mesh.edges()) {
        count += mesh.is_boundary(edge);
    }
    return count;
}

} // namespace

TEST(Reference, CubeCounts) {
    using Counts = std::array<std::size_t, 3>;
    ReferenceMesh mesh = makeUnitCube();
    EXPECT_EQ(counts(mesh), (Counts{8, 12, 6}));
    for (Counts expected : {Counts{32, 48, 18}, Counts{128, 192, 66}, Counts{512, 768, 258}}) {
        mesh = Refine(mesh, ReferenceMask::Average).mesh;
        EXPECT_EQ(counts(mesh), expected);
    }
}

TEST(Reference, PaperMasks) {
    expectWeights(ReferenceMask::Average, {14, 5, 5}, 24);
    expectWeights(ReferenceMask::Average, {9, 3, 1, 3}, 16);
    expectWeights(ReferenceMask::Average, {13, 4, 1, 1, 1, 4}, 24);
    expectWeights(ReferenceMask::Cosine, {4, 1, 1}, 6);
    expectWeights(ReferenceMask::Cosine, {9, 3, 1, 3}, 16);
    expectWeights(ReferenceMask::Cosine, {11, 4, 2, 1, 2, 4}, 24);
    expectWeights(ReferenceMask::Smooth, {4, 1, 1}, 6);
    expectWeights(ReferenceMask::Smooth, {9, 3, 1, 3}, 16);
    expectWeights(ReferenceMask::Smooth, {7, 3, 1, 1, 1, 3}, 16);
}

TEST(Reference, MasksSumToOne) {
    for (ReferenceMask mask : kMasks) {
        for (int n = 3; n < 40; ++n) {
            double sum = 0;
            for (double weight : faceMask(mask, n)) {
                EXPECT_GE(weight, -1e-16);
                sum += weight;
            }
            EXPECT_NEAR(sum, 1, 1e-14) << n;
        }
    }
}

TEST(Reference, CubePositions) {
    // The face z = -1 at the vertex (-1, -1, -1): (9 (-1) + 3 (1 - 1) + 1)/16 = -1/2 in x and y.
    ReferenceLevel const child = Refine(makeUnitCube(), ReferenceMask::Average);
    expectPoint(child, findVertex(child, true, 0, 0), -0.5, -0.5, -1);
    expectPoint(child, findVertex(child, true, 7, 1), 0.5, 0.5, 1);
    // The average of (-1, -1, -1) and its three new points, which are that one turned.
    expectPoint(child, findVertex(child, false, 0), -0.75, -0.75, -0.75);
    expectPoint(child, findVertex(child, false, 7), 0.75, 0.75, 0.75);
}

TEST(Reference, TrianglePositions) {
    std::vector<double> const positions{0, 0, 0, 24, 0, 0, 0, 48, 24};
    ReferenceLevel const child =
        Refine(MakeReferenceMesh(positions, {3}, {0, 1, 2}), ReferenceMask::Average);
    EXPECT_EQ(counts(child.mesh), (std::array<std::size_t, 3>{6, 9, 4}));
    expectPoint(child, findVertex(child, true, 0, 0), 5, 10, 5);
    expectPoint(child, findVertex(child, true, 1, 0), 14, 10, 5);
    expectPoint(child, findVertex(child, true, 2, 0), 5, 28, 14);
    // One face: the average of the vertex and its one new point.
    expectPoint(child, findVertex(child, false, 0), 2.5, 5, 2.5);
    expectPoint(child, findVertex(child, false, 1), 19, 5, 2.5);
    expectPoint(child, findVertex(child, false, 2), 2.5, 38, 19);
}

TEST(Reference, TriangleFaces) {
    ReferenceLevel const child = Refine(makePolygon(3), ReferenceMask::Average);
    for (auto face : child.mesh.faces()) {
        ReferenceFaceOrigin const &origin = child.faceOrigins[face.idx()];
        std::vector<int> vertices;
        for (auto v : child.mesh.fv_range(face)) {
            vertices.push_back(v.idx());
        }
        std::vector<int> expected;
        if (origin.isEFace) {
            int const v0 = origin.edgeVertices[0];
            int const v1 = origin.edgeVertices[1];
            EXPECT_EQ(v1, (v0 + 1) % 3);
            expected = {findVertex(child, false, v0), findVertex(child, false, v1),
                        findVertex(child, true, v1, 0), findVertex(child, true, v0, 0)};
        } else {
            EXPECT_EQ(origin.face, 0);
            expected = {findVertex(child, true, 0, 0), findVertex(child, true, 1, 0),
                        findVertex(child, true, 2, 0)};
        }
        ASSERT_EQ(vertices.size(), expected.size());
        auto const start = std::find(vertices.begin(), vertices.end(), expected[0]);
        std::rotate(vertices.begin(), start, vertices.end());
        EXPECT_EQ(vertices, expected);
    }
}

TEST(Reference, EFaceOfInteriorEdge) {
    // Two triangles a = 0 1 2 and b = 1 0 3 on the edge 0-1.
    ReferenceMesh const mesh =
        MakeReferenceMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0}, {3, 3}, {0, 1, 2, 1, 0, 3});
    ReferenceLevel const child = Refine(mesh, ReferenceMask::Average);
    int hexagons = 0;
    for (auto face : child.mesh.faces()) {
        if (child.mesh.valence(face) != 6) {
            continue;
        }
        ++hexagons;
        ReferenceFaceOrigin const &origin = child.faceOrigins[face.idx()];
        ASSERT_TRUE(origin.isEFace);
        int const v0 = origin.edgeVertices[0];
        int const v1 = origin.edgeVertices[1];
        ASSERT_EQ(v0 + v1, 1);
        int const a = v0;
        int const b = v1;
        std::vector<int> const expected{
            findVertex(child, false, v0),   findVertex(child, true, v0, b),
            findVertex(child, true, v1, b), findVertex(child, false, v1),
            findVertex(child, true, v1, a), findVertex(child, true, v0, a)};
        std::vector<int> vertices;
        for (auto v : child.mesh.fv_range(face)) {
            vertices.push_back(v.idx());
        }
        std::rotate(vertices.begin(), std::find(vertices.begin(), vertices.end(), expected[0]),
                    vertices.end());
        EXPECT_EQ(vertices, expected);
    }
    EXPECT_EQ(hexagons, 1);
}

TEST(Reference, CountsOfEveryShape) {
    for (Shape const &shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        ReferenceMesh mesh = makeMesh(shape);
        EXPECT_EQ(countBoundaryEdges(mesh) == 0, shape.closed);
        int const numLevels = GetTestLevel(shape, 3, 20000);
        for (int level = 1; level <= numLevels; ++level) {
            ReferenceMesh const child = Refine(mesh, ReferenceMask::Smooth).mesh;
            std::size_t corners = 0;
            for (auto face : mesh.faces()) {
                corners += mesh.valence(face);
            }
            std::size_t const boundary = countBoundaryEdges(mesh);
            EXPECT_EQ(child.n_vertices(), mesh.n_vertices() + corners);
            EXPECT_EQ(child.n_edges(), 2 * corners + boundary);
            EXPECT_EQ(child.n_faces(), mesh.n_faces() + mesh.n_edges());
            EXPECT_EQ(std::size_t(countBoundaryEdges(child)), boundary);
            EXPECT_EQ(int(child.n_vertices()) - int(child.n_edges()) + int(child.n_faces()),
                      int(mesh.n_vertices()) - int(mesh.n_edges()) + int(mesh.n_faces()));
            mesh = child;
        }
    }
}

TEST(Reference, NewFacesKeepTheOrientation) {
    // One level only: from level 2 on the paper's boundary rule folds the border over.
    ReferenceMesh const mesh = Refine(makePolygon(5), ReferenceMask::Average).mesh;
    for (auto face : mesh.faces()) {
        EXPECT_GT(mesh.calc_face_normal(face)[2], 0.99);
    }
}

TEST(Reference, VaryingIsLinear) {
    Shape const &shape = GetShape("mixedPatch");
    ReferenceMesh const mesh = makeMesh(shape);
    ReferenceLevel const child = Refine(mesh, ReferenceMask::Cosine);
    ReferenceValues const values = GetPoints(mesh).leftCols(2);
    ReferenceValues const result = InterpolateVarying(mesh, child, values);
    ASSERT_EQ(result.rows(), Eigen::Index(child.mesh.n_vertices()));
    ASSERT_EQ(result.cols(), 2);
    for (Eigen::Index i = 0; i < result.rows(); ++i) {
        ReferenceVertexOrigin const &origin = child.vertexOrigins[i];
        Eigen::RowVectorXd expected = values.row(origin.vertex);
        if (origin.isFVertex) {
            Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(2);
            int n = 0;
            for (auto v : mesh.fv_range(ReferenceMesh::FaceHandle(origin.face))) {
                sum += values.row(v.idx());
                ++n;
            }
            expected = (expected + sum / n) / 2;
        }
        EXPECT_LT((result.row(i) - expected).norm(), 1e-15);
    }
}

TEST(Reference, IsolatedVertexStays) {
    Shape const &shape = GetShape("isolatedVertex");
    ReferenceLevel const child = Refine(makeMesh(shape), ReferenceMask::Average);
    expectPoint(child, findVertex(child, false, 2), shape.positions[6], shape.positions[7],
                shape.positions[8]);
}

TEST(Reference, RefusesNonManifoldMeshes) {
    std::vector<double> const positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0};
    EXPECT_THROW(MakeReferenceMesh(positions, {3, 3, 3}, {0, 1, 2, 1, 0, 3, 0, 1, 4}),
                 std::runtime_error);
    EXPECT_THROW(MakeReferenceMesh(positions, {3, 3}, {0, 1, 2, 0, 1, 3}), std::runtime_error);
    EXPECT_THROW(MakeReferenceMesh(positions, {3, 3}, {0, 1, 2, 2, 3, 4}), std::runtime_error);
}

} // namespace OpenSubdivHex::Regression::referenceTest

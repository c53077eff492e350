// SPDX-License-Identifier: Apache-2.0
//
// The tagged reference's steps of other schemes and of coplanar faces.
#include "largestValue.h"
#include "taggedReference.h"

#include "regression/shapes/flatShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace OpenSubdivHex::Regression::schemeReferenceTest {

namespace {

using Counts = std::array<std::size_t, 3>;

TaggedMesh makeMesh(Shape const &shape) {
    TaggedBase base;
    base.numVertices = shape.GetNumVertices();
    base.faceSizes = shape.faceSizes;
    base.faceVertices = shape.faceVertices;
    base.vertexSharpness.resize(base.numVertices);
    base.freeBoundaries = true;
    return MakeTaggedMesh(base);
}

ReferenceValues positionsOf(Shape const &shape) {
    return Eigen::Map<ReferenceValues const>(shape.positions.data(), shape.GetNumVertices(), 3);
}

Counts counts(TaggedMesh const &mesh) {
    return {mesh.vertices.size(), mesh.edges.size(), mesh.faces.size()};
}

std::size_t countCorners(TaggedMesh const &mesh) {
    std::size_t count = 0;
    for (TaggedMesh::Face const &face : mesh.faces) {
        count += face.vertices.size();
    }
    return count;
}

std::size_t countBoundaryEdges(TaggedMesh const &mesh) {
    return std::count_if(mesh.edges.begin(), mesh.edges.end(),
                         [](TaggedMesh::Edge const &edge) { return edge.sides.size() == 1; });
}

ReferenceStep schemeStep(ReferenceScheme scheme) {
    ReferenceStep step;
    step.scheme = scheme;
    return step;
}

/// Each directed edge is run once, and once in the other direction, and the faces of a vertex are
/// as many as follow one another around it.
void expectWatertight(TaggedMesh const &mesh) {
    std::map<std::pair<int, int>, int> uses;
    for (TaggedMesh::Face const &face : mesh.faces) {
        ASSERT_GE(face.vertices.size(), 3u);
        for (std::size_t i = 0; i < face.vertices.size(); ++i) {
            ++uses[{face.vertices[i], face.vertices[(i + 1) % face.vertices.size()]}];
        }
    }
    ASSERT_EQ(uses.size(), 2 * mesh.edges.size());
    for (auto const &[edge, count] : uses) {
        ASSERT_EQ(count, 1);
        ASSERT_EQ(uses.count({edge.second, edge.first}), 1u);
    }
    for (TaggedMesh::Edge const &edge : mesh.edges) {
        ASSERT_EQ(edge.sides.size(), 2u);
        ASSERT_EQ(mesh.GetStart(edge.sides[0]), mesh.GetEnd(edge.sides[1]));
        ASSERT_EQ(mesh.GetEnd(edge.sides[0]), mesh.GetStart(edge.sides[1]));
    }
    for (TaggedMesh::Vertex const &vertex : mesh.vertices) {
        ASSERT_GE(vertex.corners.size(), 2u);
        TaggedMesh::Side corner = vertex.corners[0];
        for (std::size_t i = 0; i < vertex.corners.size(); ++i) {
            TaggedMesh::Face const &face = mesh.faces[corner.face];
            int const before = (corner.place + int(face.edges.size()) - 1) % int(face.edges.size());
            auto const &sides = mesh.edges[face.edges[before]].sides;
            corner = sides[sides[0].face == corner.face && sides[0].place == before ? 1 : 0];
            ASSERT_EQ(corner.face == vertex.corners[0].face, i + 1 == vertex.corners.size());
        }
    }
}

std::vector<std::vector<int>> facesOf(TaggedMesh const &mesh) {
    std::vector<std::vector<int>> faces;
    for (TaggedMesh::Face const &face : mesh.faces) {
        faces.push_back(face.vertices);
    }
    return faces;
}

/// Whether two adjacent edges are the only ones of a vertex: its polygon would have two sides.
bool hasTwoSidedVertices(TaggedMesh const &mesh) {
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [](TaggedMesh::Vertex const &vertex) { return vertex.corners.size() == 2; });
}

/// Calls check(mesh, positions) for all closed shapes.
template <typename CHECK>
void forEachClosed(CHECK const &check) {
    for (auto const *shapes : {&GetManifoldShapes(), &GetFlatShapes()}) {
        for (Shape const &shape : *shapes) {
            if (shape.closed && shape.GetNumFaces() < 2000) {
                SCOPED_TRACE(shape.name);
                check(makeMesh(shape), positionsOf(shape));
            }
        }
    }
}

} // namespace

TEST(SchemeReference, DooSabinCounts) {
    int numMeshes = 0;
    forEachClosed([&](TaggedMesh mesh, ReferenceValues const &) {
        if (hasTwoSidedVertices(mesh)) {
            return;
        }
        ++numMeshes;
        for (int level = 1; level <= 2; ++level) {
            TaggedMesh const child = Refine(mesh, schemeStep(ReferenceScheme::DooSabin));
            auto const [numVertices, numEdges, numFaces] = counts(mesh);
            EXPECT_EQ(counts(child), (Counts{countCorners(mesh), 4 * numEdges,
                                             numFaces + numEdges + numVertices}));
            ASSERT_NO_FATAL_FAILURE(expectWatertight(child));
            mesh = child;
        }
    });
    EXPECT_GT(numMeshes, 20);
}

TEST(SchemeReference, TriHexCounts) {
    forEachClosed([](TaggedMesh mesh, ReferenceValues const &) {
        for (int level = 1; level <= 2; ++level) {
            TaggedMesh const child = Refine(mesh, schemeStep(ReferenceScheme::TriHex));
            auto const [numVertices, numEdges, numFaces] = counts(mesh);
            EXPECT_EQ(counts(child), (Counts{2 * numEdges, 3 * numEdges, numFaces + numVertices}));
            ASSERT_NO_FATAL_FAILURE(expectWatertight(child));
            for (TaggedMesh::Vertex const &vertex : child.vertices) {
                ASSERT_EQ(vertex.corners.size(), 3u);
            }
            mesh = child;
        }
    });
}

TEST(SchemeReference, BordersDropTheirFaces) {
    // Two by two quads: only the middle vertex has a face around it.
    Shape grid;
    grid.positions.resize(27);
    grid.faceSizes.assign(4, 4);
    grid.faceVertices = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7};
    TaggedMesh const mesh = makeMesh(grid);
    TaggedMesh const dooSabin = Refine(mesh, schemeStep(ReferenceScheme::DooSabin));
    EXPECT_EQ(counts(dooSabin), (Counts{16, 24, 9}));
    EXPECT_EQ(countBoundaryEdges(dooSabin), 12u);
    TaggedMesh const triHex = Refine(mesh, schemeStep(ReferenceScheme::TriHex));
    EXPECT_EQ(counts(triHex), (Counts{16, 20, 5}));
    ASSERT_EQ(triHex.faces[4].vertices.size(), 8u);
    EXPECT_EQ(countBoundaryEdges(triHex), 16u);
}

TEST(SchemeReference, TriHexPositions) {
    Shape triangle;
    triangle.positions = {0, 0, 0, 9, 0, 0, 0, 18, 27};
    triangle.faceSizes = {3};
    triangle.faceVertices = {0, 1, 2};
    TaggedMesh const mesh = makeMesh(triangle);
    TaggedMesh const child = Refine(mesh, schemeStep(ReferenceScheme::TriHex));
    ASSERT_EQ(counts(child), (Counts{3, 3, 1}));
    // The centroid is (3, 6, 9).
    ReferenceValues expected(3, 3);
    expected << 4, 2, 3, 4, 8, 12, 1, 8, 12;
    EXPECT_LT(
        GetLargestValue(Interpolate(mesh, child, ReferenceMask::Smooth, positionsOf(triangle)) -
                        expected),
        1e-14);
    EXPECT_EQ(child.faces[0].vertices, (std::vector<int>{0, 1, 2}));
}

TEST(SchemeReference, FlatEdgesOfABox) {
    Shape const box = MakeBox(2, 2, 2);
    TaggedMesh mesh = makeMesh(box);
    for (auto const &[tolerance, expected] : {std::pair{0.1, 24}, {89.0, 24}, {91.0, 48}}) {
        std::vector<bool> const flat = FindFlatEdges(mesh, positionsOf(box), tolerance);
        EXPECT_EQ(std::count(flat.begin(), flat.end(), true), expected) << tolerance;
    }
    // A crease or a corner is never flat: the box's side with 4 quads has 4 flat edges, all of
    // which end in its middle.
    mesh.vertices[0].sharpness = 2;
    std::vector<bool> const flat = FindFlatEdges(mesh, positionsOf(box), 180);
    EXPECT_EQ(std::count(flat.begin(), flat.end(), true),
              48 - int(mesh.vertices[0].corners.size()));
    mesh.vertices[0].sharpness = 0;
    mesh.edges[5].sharpness = 0.5f;
    EXPECT_FALSE(FindFlatEdges(mesh, positionsOf(box), 180)[5]);
}

TEST(SchemeReference, CoplanarBoxCounts) {
    Shape const box = MakeBox(2, 2, 2);
    TaggedMesh mesh = makeMesh(box);
    ReferenceValues positions = positionsOf(box);
    EXPECT_EQ(counts(mesh), (Counts{26, 48, 24}));
    for (Counts const &expected : {Counts{116, 216, 102}, Counts{524, 912, 390}}) {
        ReferenceStep step;
        step.flatEdges = FindFlatEdges(mesh, positions, 0.1);
        TaggedMesh const child = Refine(mesh, step);
        EXPECT_EQ(counts(child), expected);
        positions = Interpolate(mesh, child, ReferenceMask::Average, positions);
        mesh = child;
    }
}

TEST(SchemeReference, OpenBoxHasGaps) {
    Shape const box = MakeBox(2, 2, 2);
    TaggedMesh const mesh = makeMesh(box);
    ReferenceStep step;
    step.flatEdges = FindFlatEdges(mesh, positionsOf(box), 0.1);
    step.closeGaps = false;
    TaggedMesh const child = Refine(mesh, step);
    // A quad for each side's middle and a triangle at both sides of the 12 vertices on its edges.
    EXPECT_EQ(countBoundaryEdges(child), 6u * 4 + 12u * 2 * 3);
    EXPECT_EQ(counts(child), (Counts{116, 216, 102 - 6 - 24}));
}

TEST(SchemeReference, CoplanarIsWatertight) {
    for (Shape const &shape : GetFlatShapes()) {
        SCOPED_TRACE(shape.name);
        for (ReferenceMask mask : {ReferenceMask::Average, ReferenceMask::Smooth}) {
            for (double tolerance : {0.1, 20.0, 100.0}) {
                TaggedMesh mesh = makeMesh(shape);
                ReferenceValues positions = positionsOf(shape);
                for (int level = 1; level <= GetTestLevel(shape, 4, 10000); ++level) {
                    ReferenceStep step;
                    step.flatEdges = FindFlatEdges(mesh, positions, tolerance);
                    TaggedMesh const child = Refine(mesh, step);
                    ASSERT_NO_FATAL_FAILURE(expectWatertight(child));
                    // V' = V - c + C, E' = 4E + R, F' = F + E + R + c.
                    auto const [numVertices, numEdges, numFaces] = counts(mesh);
                    std::size_t const c = numVertices + countCorners(mesh) - child.vertices.size();
                    std::size_t const r = child.faces.size() - numFaces - numEdges - c;
                    EXPECT_EQ(child.edges.size(), 4 * numEdges + r);
                    positions = Interpolate(mesh, child, mask, positions);
                    mesh = child;
                }
            }
        }
    }
}

TEST(SchemeReference, AllFlatIsDooSabin) {
    forEachClosed([](TaggedMesh mesh, ReferenceValues positions) {
        // The quads of a dihedron have no area, and so no normal.
        int const numLevels = hasTwoSidedVertices(mesh) ? 1 : 2;
        for (int level = 1; level <= numLevels; ++level) {
            ReferenceStep step;
            step.flatEdges = FindFlatEdges(mesh, positions, 180);
            ASSERT_EQ(std::count(step.flatEdges.begin(), step.flatEdges.end(), false), 0);
            TaggedMesh const child = Refine(mesh, step);
            TaggedMesh const dooSabin = Refine(mesh, schemeStep(ReferenceScheme::DooSabin));
            EXPECT_EQ(facesOf(child), facesOf(dooSabin));
            ReferenceValues const expected =
                Interpolate(mesh, dooSabin, ReferenceMask::Cosine, positions);
            positions = Interpolate(mesh, child, ReferenceMask::Cosine, positions);
            EXPECT_EQ(positions, expected);
            mesh = child;
        }
    });
}

TEST(SchemeReference, NoFlatEdgeIsHexagonal) {
    forEachClosed([](TaggedMesh const &mesh, ReferenceValues const &) {
        ReferenceStep step;
        step.flatEdges.resize(mesh.edges.size());
        EXPECT_EQ(facesOf(Refine(mesh, step)), facesOf(Refine(mesh)));
    });
}

} // namespace OpenSubdivHex::Regression::schemeReferenceTest

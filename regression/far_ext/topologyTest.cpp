// SPDX-License-Identifier: Apache-2.0
#include "baseDifference.h"
#include "referenceMatch.h"

#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace OpenSubdivHex::Regression::topologyTest {

using Far::INDEX_INVALID;
using FarExt::CallStatus;
using FarExt::FaceKind;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

using IndexArray = Far::ConstIndexArray;

std::vector<int> toVector(IndexArray array) { return std::vector<int>(array.begin(), array.end()); }

/// A face turned so that its smallest vertex comes first.
std::vector<int> rotated(std::vector<int> face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

/// Incidence found by search from the face-vertices of a level alone.
struct Incidence {
    struct Side {
        int face;
        int place; ///< of the edge, or of the vertex, in the face
    };

    explicit Incidence(TopologyLevel const &level) : vertexFaces(level.GetNumVertices()) {
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            IndexArray const verts = level.GetFaceVertices(f);
            for (int i = 0; i < verts.size(); ++i) {
                sides[{verts[i], verts[(i + 1) % verts.size()]}].push_back({f, i});
                vertexFaces[verts[i]].push_back({f, i});
                ++numCorners;
            }
        }
    }

    std::map<std::pair<int, int>, std::vector<Side>> sides; ///< by the edge as the face runs it
    std::vector<std::vector<Side>> vertexFaces;
    int numCorners = 0;
};

void expectInventory(TopologyLevel const &level, Incidence const &incidence) {
    std::set<std::pair<int, int>> edges;
    int numBoundaryEdges = 0;
    for (auto const &[edge, sides] : incidence.sides) {
        ASSERT_EQ(sides.size(), 1u);
        edges.insert(std::minmax(edge.first, edge.second));
        numBoundaryEdges += incidence.sides.count({edge.second, edge.first}) == 0;
    }
    EXPECT_EQ(level.GetNumFaceVertices(), incidence.numCorners);
    EXPECT_EQ(level.GetNumEdges(), int(edges.size()));
    EXPECT_EQ(level.GetNumBoundaryEdges(), numBoundaryEdges);
    EXPECT_TRUE(level.HasFullTopology());
}

void expectEdges(TopologyLevel const &level, Incidence const &incidence) {
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        IndexArray const verts = level.GetEdgeVertices(e);
        IndexArray const faces = level.GetEdgeFaces(e);
        Far::ConstLocalIndexArray const places = level.GetEdgeFaceLocalIndices(e);
        ASSERT_EQ(verts.size(), 2);
        ASSERT_EQ(places.size(), faces.size());
        // The first face runs the edge from its first vertex to its second, the other back.
        auto const first = incidence.sides.find({verts[0], verts[1]});
        auto const second = incidence.sides.find({verts[1], verts[0]});
        ASSERT_TRUE(first != incidence.sides.end());
        bool const isBoundary = second == incidence.sides.end();
        ASSERT_EQ(faces.size(), isBoundary ? 1 : 2);
        ASSERT_EQ(faces[0], first->second[0].face);
        ASSERT_EQ(places[0], first->second[0].place);
        if (!isBoundary) {
            ASSERT_EQ(faces[1], second->second[0].face);
            ASSERT_EQ(places[1], second->second[0].place);
        }
        ASSERT_EQ(level.IsEdgeBoundary(e), isBoundary);
        ASSERT_FALSE(level.IsEdgeNonManifold(e));
        ASSERT_EQ(level.FindEdge(verts[0], verts[1]), e);
        ASSERT_EQ(level.FindEdge(verts[1], verts[0]), e);
    }
}

void expectFaceEdges(TopologyLevel const &level) {
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        IndexArray const verts = level.GetFaceVertices(f);
        IndexArray const edges = level.GetFaceEdges(f);
        ASSERT_EQ(edges.size(), verts.size());
        for (int i = 0; i < verts.size(); ++i) {
            std::vector<int> expected{verts[i], verts[(i + 1) % verts.size()]};
            std::vector<int> actual = toVector(level.GetEdgeVertices(edges[i]));
            std::sort(expected.begin(), expected.end());
            std::sort(actual.begin(), actual.end());
            ASSERT_EQ(actual, expected);
        }
    }
}

void expectVertices(TopologyLevel const &level, Incidence const &incidence) {
    std::vector<std::vector<int>> vertexEdges(level.GetNumVertices());
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        for (int v : level.GetEdgeVertices(e)) {
            vertexEdges[v].push_back(e);
        }
    }
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        IndexArray const faces = level.GetVertexFaces(v);
        IndexArray const edges = level.GetVertexEdges(v);
        Far::ConstLocalIndexArray const facePlaces = level.GetVertexFaceLocalIndices(v);
        Far::ConstLocalIndexArray const edgePlaces = level.GetVertexEdgeLocalIndices(v);

        std::vector<std::pair<int, int>> expectedFaces;
        for (Incidence::Side const &side : incidence.vertexFaces[v]) {
            expectedFaces.emplace_back(side.face, side.place);
        }
        ASSERT_EQ(facePlaces.size(), faces.size());
        std::vector<std::pair<int, int>> actualFaces;
        for (int i = 0; i < faces.size(); ++i) {
            actualFaces.emplace_back(faces[i], facePlaces[i]);
            ASSERT_EQ(level.GetVertexCorner(v, i),
                      level.GetFaceFirstCorner(faces[i]) + facePlaces[i]);
        }
        std::sort(actualFaces.begin(), actualFaces.end());
        ASSERT_EQ(actualFaces, expectedFaces);

        std::vector<int> actualEdges = toVector(edges);
        std::sort(actualEdges.begin(), actualEdges.end());
        ASSERT_EQ(actualEdges, vertexEdges[v]);
        ASSERT_EQ(edgePlaces.size(), edges.size());
        int numBoundaryEdges = 0;
        for (int i = 0; i < edges.size(); ++i) {
            ASSERT_EQ(level.GetEdgeVertices(edges[i])[edgePlaces[i]], v);
            numBoundaryEdges += level.IsEdgeBoundary(edges[i]);
        }

        // Counter-clockwise: face i leaves the vertex along edge i and comes back along i + 1.
        for (int i = 0; i < faces.size(); ++i) {
            IndexArray const faceEdges = level.GetFaceEdges(faces[i]);
            int const place = facePlaces[i];
            ASSERT_EQ(faceEdges[place], edges[i]);
            ASSERT_EQ(faceEdges[(place + faceEdges.size() - 1) % faceEdges.size()],
                      edges[(i + 1) % edges.size()]);
        }
        bool const isBoundary = numBoundaryEdges > 0;
        ASSERT_EQ(level.IsVertexBoundary(v), isBoundary);
        ASSERT_EQ(level.IsVertexCorner(v), faces.size() == 1);
        ASSERT_EQ(level.IsVertexNonManifold(v), faces.size() == 0); // as Far tags it
        if (faces.size() > 0) {
            ASSERT_EQ(level.IsVertexValenceRegular(v),
                      isBoundary ? faces.size() <= 2 : faces.size() == 3);
        }
    }
}

void expectRelations(Shape const &shape, int numLevels) {
    SCOPED_TRACE(shape.name);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, numLevels);
    for (int depth = 0; depth <= numLevels; ++depth) {
        SCOPED_TRACE("level " + std::to_string(depth));
        TopologyLevel const &level = refiner->GetLevel(depth);
        EXPECT_EQ(level.GetDepth(), depth);
        Incidence const incidence(level);
        ASSERT_NO_FATAL_FAILURE(expectInventory(level, incidence));
        ASSERT_NO_FATAL_FAILURE(expectEdges(level, incidence));
        ASSERT_NO_FATAL_FAILURE(expectFaceEdges(level));
        ASSERT_NO_FATAL_FAILURE(expectVertices(level, incidence));
    }
}

/// A shape without one of its faces.
Shape without(Shape shape, int face) {
    shape.name += " without face " + std::to_string(face);
    auto const size = shape.faceSizes.begin() + face;
    auto const first =
        shape.faceVertices.begin() + std::accumulate(shape.faceSizes.begin(), size, 0);
    shape.faceVertices.erase(first, first + *size);
    shape.faceSizes.erase(size);
    return shape;
}

/// The closed-form numbering of far_ext/INDEXING.md, literally.
void expectNumbering(TopologyLevel const &parent, TopologyLevel const &child) {
    int const numV = parent.GetNumVertices();
    int const numC = parent.GetNumFaceVertices();
    int const numF = parent.GetNumFaces();
    int const numE = parent.GetNumEdges();
    ASSERT_EQ(child.GetNumVertices(), numV + numC);
    ASSERT_EQ(child.GetNumFaces(), numF + numE);
    ASSERT_EQ(child.GetNumEdges(), 2 * numC + parent.GetNumBoundaryEdges());
    ASSERT_EQ(child.GetNumBoundaryEdges(), parent.GetNumBoundaryEdges());
    int corner = 0;
    for (int f = 0; f < numF; ++f) {
        IndexArray const verts = parent.GetFaceVertices(f);
        int const first = corner;
        ASSERT_EQ(parent.GetFaceFirstCorner(f), first);
        ASSERT_EQ(child.GetFaceFirstCorner(f), first);
        ASSERT_EQ(parent.GetFaceChildFaces(f).size(), 1);
        ASSERT_EQ(parent.GetFaceChildFaces(f)[0], f);
        ASSERT_EQ(parent.GetFaceChildVertex(f), INDEX_INVALID);
        std::vector<int> fVertices;
        std::vector<int> fEdges;
        for (int i = 0; i < verts.size(); ++i, ++corner) {
            int const next = first + (i + 1) % verts.size();
            ASSERT_EQ(toVector(child.GetEdgeVertices(corner)),
                      (std::vector<int>{numV + corner, numV + next}));
            ASSERT_EQ(toVector(child.GetEdgeVertices(numC + corner)),
                      (std::vector<int>{verts[i], numV + corner}));
            fVertices.push_back(numV + corner);
            fEdges.push_back(corner);
        }
        ASSERT_EQ(toVector(child.GetFaceVertices(f)), fVertices);
        ASSERT_EQ(toVector(child.GetFaceEdges(f)), fEdges);
        ASSERT_EQ(toVector(parent.GetFaceChildVertices(f)), fVertices);
        ASSERT_EQ(toVector(parent.GetFaceChildEdges(f)), fEdges);
    }
    int rank = 0;
    for (int e = 0; e < numE; ++e) {
        IndexArray const verts = parent.GetEdgeVertices(e);
        ASSERT_EQ(parent.GetEdgeChildFace(e), numF + e);
        ASSERT_EQ(parent.GetEdgeChildVertex(e), INDEX_INVALID);
        IndexArray const childEdges = parent.GetEdgeChildEdges(e);
        IndexArray const eFace = child.GetFaceVertices(numF + e);
        if (parent.IsEdgeBoundary(e)) {
            int const childEdge = 2 * numC + rank++;
            ASSERT_EQ(toVector(childEdges), std::vector<int>{childEdge});
            ASSERT_EQ(toVector(child.GetEdgeVertices(childEdge)), toVector(verts));
            ASSERT_EQ(eFace.size(), 4);
            ASSERT_EQ(eFace[1], verts[1]);
        } else {
            ASSERT_EQ(childEdges.size(), 0);
            ASSERT_EQ(eFace.size(), 6);
            ASSERT_EQ(eFace[3], verts[1]);
        }
        ASSERT_EQ(eFace[0], verts[0]);
    }
    ASSERT_EQ(rank, parent.GetNumBoundaryEdges());
    for (int v = 0; v < numV; ++v) {
        ASSERT_EQ(parent.GetVertexChildVertex(v), v);
    }
}

void expectParents(TopologyLevel const &parent, TopologyLevel const &child) {
    for (int f = 0; f < child.GetNumFaces(); ++f) {
        bool const isEFace = f >= parent.GetNumFaces();
        ASSERT_EQ(child.GetFaceKind(f), isEFace ? FaceKind::Edge : FaceKind::Face);
        int const edge = isEFace ? f - parent.GetNumFaces() : INDEX_INVALID;
        ASSERT_EQ(child.GetFaceParentEdge(f), edge);
        int const face = isEFace ? parent.GetEdgeFaces(edge)[0] : f;
        ASSERT_EQ(child.GetFaceParentFace(f), face);
    }
}

/// Expects that an array lists, between the offsets, the result of a query for each component.
template <typename QUERY>
void expectList(IndexArray all, IndexArray offsets, int count, QUERY const &query) {
    ASSERT_EQ(offsets.size(), count + 1);
    ASSERT_EQ(all.size(), offsets[count]);
    for (int i = 0; i < count; ++i) {
        IndexArray const expected = query(i);
        ASSERT_EQ(offsets[i + 1] - offsets[i], expected.size());
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), all.begin() + offsets[i]));
    }
}

void expectWholeRelations(TopologyLevel const &level) {
    expectList(level.GetAllFaceVertices(), level.GetFaceOffsets(), level.GetNumFaces(),
               [&](int f) { return level.GetFaceVertices(f); });
    expectList(level.GetAllFaceEdges(), level.GetFaceOffsets(), level.GetNumFaces(),
               [&](int f) { return level.GetFaceEdges(f); });
    expectList(level.GetAllVertexFaces(), level.GetVertexFaceOffsets(), level.GetNumVertices(),
               [&](int v) { return level.GetVertexFaces(v); });
    expectList(level.GetAllVertexEdges(), level.GetVertexEdgeOffsets(), level.GetNumVertices(),
               [&](int v) { return level.GetVertexEdges(v); });
    IndexArray const edgeVertices = level.GetAllEdgeVertices(), edgeFaces = level.GetAllEdgeFaces();
    ASSERT_EQ(edgeVertices.size(), 2 * level.GetNumEdges());
    ASSERT_EQ(edgeFaces.size(), 2 * level.GetNumEdges());
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        IndexArray const verts = level.GetEdgeVertices(e), faces = level.GetEdgeFaces(e);
        ASSERT_TRUE(std::equal(verts.begin(), verts.end(), edgeVertices.begin() + 2 * e));
        ASSERT_TRUE(std::equal(faces.begin(), faces.end(), edgeFaces.begin() + 2 * e));
        ASSERT_EQ(edgeFaces[2 * e + 1] < 0, faces.size() == 1);
    }
}

void expectSameFaces(TopologyLevel const &level, ReferenceMatch const &match, int depth) {
    ReferenceMesh const &mesh = match.GetMesh(depth);
    ASSERT_EQ(level.GetNumVertices(), int(mesh.n_vertices()));
    ASSERT_EQ(level.GetNumEdges(), int(mesh.n_edges()));
    ASSERT_EQ(level.GetNumFaces(), int(mesh.n_faces()));
    std::set<int> const vertices(match.GetVertices(depth).begin(), match.GetVertices(depth).end());
    std::set<int> const faces(match.GetFaces(depth).begin(), match.GetFaces(depth).end());
    ASSERT_EQ(vertices.size(), mesh.n_vertices());
    ASSERT_EQ(*vertices.begin(), 0);
    ASSERT_EQ(*vertices.rbegin(), level.GetNumVertices() - 1);
    ASSERT_EQ(faces.size(), mesh.n_faces());
    ASSERT_EQ(*faces.begin(), 0);
    ASSERT_EQ(*faces.rbegin(), level.GetNumFaces() - 1);
    for (auto face : mesh.faces()) {
        std::vector<int> expected;
        for (auto v : mesh.fv_range(face)) {
            expected.push_back(match.GetVertices(depth)[v.idx()]);
        }
        int const f = match.GetFaces(depth)[face.idx()];
        ASSERT_EQ(rotated(toVector(level.GetFaceVertices(f))), rotated(expected)) << "face " << f;
    }
}

// Counts that fit are found without larger sums: in constants, where such sums would be errors.  All edges are
// boundaries, or nearly all are B edges.
static_assert(FarExt::HexIndexing(0, 0, 1600000000)
                  .GetEdgeChildFirstCorner(130000000, 0, 130000000) == 2120000000);
static_assert(FarExt::HexIndexing(0, 2000000000, 0).GetEdgeChildFace(1000000000, 900000000) ==
              2100000000);

} // namespace

class Topology : public testing::Test {
protected:
    /// Runs check(shape) for every shape until one fails.
    template <typename Check>
    void forEachShape(Check const &check) {
        for (Shape const &shape : GetManifoldShapes()) {
            SCOPED_TRACE(shape.name);
            check(shape);
            if (HasFailure()) {
                return;
            }
        }
    }
};

TEST_F(Topology, EqualsReference) {
    forEachShape([](Shape const &shape) {
        int const numLevels = GetTestLevel(shape, 3, 80000);
        ReferenceMatch const match(shape, numLevels);
        ASSERT_EQ(match.GetError(), "");
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, numLevels);
        ASSERT_EQ(refiner->GetMaxLevel(), numLevels);
        for (int level = 0; level <= numLevels; ++level) {
            SCOPED_TRACE("level " + std::to_string(level));
            ASSERT_NO_FATAL_FAILURE(expectSameFaces(refiner->GetLevel(level), match, level));
        }
    });
}

TEST_F(Topology, Relations) {
    forEachShape([](Shape const &shape) { expectRelations(shape, GetTestLevel(shape, 3)); });
}

TEST_F(Topology, WholeRelations) {
    forEachShape([](Shape const &shape) {
        int const numLevels = std::min(2, GetTestLevel(shape, 2));
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, numLevels);
        for (int level = 0; level <= numLevels; ++level) {
            SCOPED_TRACE("level " + std::to_string(level));
            ASSERT_NO_FATAL_FAILURE(expectWholeRelations(refiner->GetLevel(level)));
        }
    });
}

// Relations of many faces of one size in a row, with few and many of another before and behind.
TEST_F(Topology, RelationsOfRuns) {
    Shape const triangles = MakeDual("triangles", MakeTruncated("", MakeIcosahedron()));
    Shape const hexagons = MakeTruncated("hexagons, pentagons", triangles);
    for (Shape const &shape :
         {triangles, hexagons, MakePrism(70), MakeDual("triangles again", hexagons),
          MakeUnion("triangles, hexagons, pentagons", triangles, hexagons, 3)}) {
        expectRelations(shape, 2);
        for (int face : {0, shape.GetNumFaces() / 2}) {
            expectRelations(without(shape, face), 2);
        }
    }
}

TEST_F(Topology, NumberingAndParents) {
    forEachShape([](Shape const &shape) {
        int const numLevels = GetTestLevel(shape, 3);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, numLevels);
        TopologyLevel const &base = refiner->GetLevel(0);
        for (int f = 0; f < base.GetNumFaces(); ++f) {
            ASSERT_EQ(base.GetFaceKind(f), FaceKind::Base);
            ASSERT_EQ(base.GetFaceBaseFace(f), f);
            ASSERT_EQ(base.GetFaceParentFace(f), INDEX_INVALID);
            ASSERT_EQ(base.GetFaceParentEdge(f), INDEX_INVALID);
        }
        for (int level = 1; level <= numLevels; ++level) {
            SCOPED_TRACE("level " + std::to_string(level));
            TopologyLevel const &parent = refiner->GetLevel(level - 1);
            TopologyLevel const &child = refiner->GetLevel(level);
            ASSERT_NO_FATAL_FAILURE(expectNumbering(parent, child));
            ASSERT_NO_FATAL_FAILURE(expectParents(parent, child));
        }
        TopologyLevel const &last = refiner->GetLevel(numLevels);
        EXPECT_EQ(last.GetFaceChildFaces(0).size(), 0);
        EXPECT_EQ(last.GetFaceChildVertices(0).size(), 0);
        EXPECT_EQ(last.GetFaceChildEdges(0).size(), 0);
        EXPECT_EQ(last.GetEdgeChildEdges(0).size(), 0);
        EXPECT_EQ(last.GetEdgeChildFace(0), INDEX_INVALID);
        EXPECT_EQ(last.GetVertexChildVertex(0), INDEX_INVALID);
    });
}

TEST_F(Topology, BaseKeepsFarsNumberingWhereverItComesFrom) {
    for (Shape const &shape : GetShapes()) {
        for (auto boundary : kBoundaries) {
            SCOPED_TRACE(shape.name + ", boundary " + std::to_string(boundary));
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(boundary);
            auto const base = CreateFarRefiner(shape, options);
            auto const ofBase = FarExt::TopologyRefinerFactory::Create(*base);
            ShapeDescriptor const descriptor(shape);
            auto const ofDescriptor =
                FarExt::TopologyRefinerFactory::Create(descriptor.Get(), options);
            ASSERT_TRUE(ofBase && ofDescriptor);
            EXPECT_EQ(FindFarDifference(*ofDescriptor, base->GetLevel(0)), "");
            EXPECT_EQ(FindBaseDifference(*ofDescriptor, *ofBase), "");
        }
    }
}

TEST_F(Topology, ValidatesAtEveryLevel) {
    forEachShape([](Shape const &shape) {
        int const numLevels = GetTestLevel(shape, 4, 200000);
        for (bool fullTopologyInLastLevel : {false, true}) {
            auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0);
            TopologyRefiner::UniformOptions options(numLevels);
            options.fullTopologyInLastLevel = fullTopologyInLastLevel;
            ASSERT_TRUE(refiner->RefineUniform(options));
            for (int level = 0; level <= numLevels; ++level) {
                CallStatus status;
                EXPECT_TRUE(refiner->GetLevel(level).Validate(&status)) << status.GetErrorMessage();
                EXPECT_TRUE(status.IsOk());
            }
        }
    });
}

TEST_F(Topology, CubeCounts) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Average, 3);
    int const expected[4][4] = {
        {8, 12, 6, 24}, {32, 48, 18, 96}, {128, 192, 66, 384}, {512, 768, 258, 1536}};
    int totals[4] = {0, 0, 0, 0};
    for (int level = 0; level <= 3; ++level) {
        EXPECT_EQ(refiner->GetLevel(level).GetNumVertices(), expected[level][0]);
        EXPECT_EQ(refiner->GetLevel(level).GetNumEdges(), expected[level][1]);
        EXPECT_EQ(refiner->GetLevel(level).GetNumFaces(), expected[level][2]);
        EXPECT_EQ(refiner->GetLevel(level).GetNumFaceVertices(), expected[level][3]);
        for (int i = 0; i < 4; ++i) {
            totals[i] += expected[level][i];
        }
    }
    EXPECT_EQ(refiner->GetNumVerticesTotal(), totals[0]);
    EXPECT_EQ(refiner->GetNumEdgesTotal(), totals[1]);
    EXPECT_EQ(refiner->GetNumFacesTotal(), totals[2]);
    EXPECT_EQ(refiner->GetNumFaceVerticesTotal(), totals[3]);
    EXPECT_EQ(refiner->GetNumLevels(), 4);
    EXPECT_TRUE(refiner->IsUniform());
}

TEST_F(Topology, LastLevelWithFaceVerticesAlone) {
    forEachShape([](Shape const &shape) {
        int const numLevels = std::min(2, GetTestLevel(shape, 2));
        auto const full = CreateRefiner(shape, ReferenceMask::Average, numLevels);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0);
        ASSERT_TRUE(refiner->RefineUniform(numLevels));
        TopologyLevel const &expected = full->GetLevel(numLevels);
        TopologyLevel const &level = refiner->GetLevel(numLevels);
        ASSERT_EQ(level.HasFullTopology(), numLevels == 0);
        ASSERT_EQ(level.GetNumVertices(), expected.GetNumVertices());
        ASSERT_EQ(level.GetNumEdges(), expected.GetNumEdges());
        ASSERT_EQ(level.GetNumFaces(), expected.GetNumFaces());
        ASSERT_EQ(level.GetNumBoundaryEdges(), expected.GetNumBoundaryEdges());
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            ASSERT_EQ(toVector(level.GetFaceVertices(f)), toVector(expected.GetFaceVertices(f)));
            ASSERT_EQ(level.GetFaceKind(f), expected.GetFaceKind(f));
            ASSERT_EQ(level.GetFaceBaseFace(f), expected.GetFaceBaseFace(f));
            ASSERT_EQ(level.GetFaceParentEdge(f), expected.GetFaceParentEdge(f));
        }
        if (numLevels > 0) {
            EXPECT_EQ(level.GetFaceEdges(0).size(), 0);
            EXPECT_EQ(level.GetEdgeVertices(0).size(), 0);
            EXPECT_EQ(level.GetEdgeFaces(0).size(), 0);
            EXPECT_EQ(level.GetVertexFaces(0).size(), 0);
            EXPECT_EQ(level.GetVertexEdges(0).size(), 0);
            EXPECT_EQ(level.GetAllFaceVertices().size(), level.GetNumFaceVertices());
            EXPECT_EQ(level.GetAllFaceEdges().size(), 0);
            EXPECT_EQ(level.GetAllEdgeVertices().size(), 0);
            EXPECT_EQ(level.GetVertexFaceOffsets().size(), 0);
            EXPECT_EQ(level.GetAllVertexEdges().size(), 0);
        }
    });
}

TEST_F(Topology, RefiningAgainReplacesTheLevels) {
    Shape const &shape = GetShape("mixedPatch");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 3);
    for (int numLevels : {1, 3, 2, 0, 2}) {
        for (bool fullTopologyInLastLevel : {false, true}) {
            TopologyRefiner::UniformOptions options(numLevels);
            options.fullTopologyInLastLevel = fullTopologyInLastLevel;
            ASSERT_TRUE(refiner->RefineUniform(options));
            EXPECT_EQ(refiner->GetUniformOptions().refinementLevel, numLevels);
            EXPECT_EQ(refiner->GetUniformOptions().fullTopologyInLastLevel,
                      fullTopologyInLastLevel);
            auto const fresh = CreateRefiner(shape, ReferenceMask::Average, numLevels);
            ASSERT_EQ(refiner->GetNumLevels(), numLevels + 1);
            ASSERT_EQ(refiner->GetNumVerticesTotal(), fresh->GetNumVerticesTotal());
            for (int level = 0; level <= numLevels; ++level) {
                TopologyLevel const &actual = refiner->GetLevel(level);
                TopologyLevel const &expected = fresh->GetLevel(level);
                EXPECT_TRUE(actual.Validate());
                EXPECT_EQ(actual.HasFullTopology(),
                          level == 0 || level < numLevels || fullTopologyInLastLevel);
                ASSERT_EQ(actual.GetNumFaces(), expected.GetNumFaces());
                for (int f = 0; f < actual.GetNumFaces(); ++f) {
                    ASSERT_EQ(toVector(actual.GetFaceVertices(f)),
                              toVector(expected.GetFaceVertices(f)));
                    ASSERT_EQ(actual.GetFaceChildVertices(f).size(),
                              expected.GetFaceChildVertices(f).size());
                }
            }
        }
    }
    refiner->Unrefine();
    EXPECT_EQ(refiner->GetNumLevels(), 1);
    EXPECT_EQ(refiner->GetLevel(0).GetFaceChildFaces(0).size(), 0);
    EXPECT_TRUE(refiner->GetLevel(0).Validate());
}

TEST_F(Topology, FindEdgeOfNoEdge) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Average, 1);
    TopologyLevel const &level = refiner->GetLevel(0);
    std::set<std::pair<int, int>> edges;
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        edges.insert(std::minmax(level.GetEdgeVertices(e)[0], level.GetEdgeVertices(e)[1]));
    }
    for (int v = 0; v < 8; ++v) {
        for (int w = 0; w < 8; ++w) {
            EXPECT_EQ(level.FindEdge(v, w) != INDEX_INVALID, edges.count(std::minmax(v, w)) == 1)
                << v << " " << w;
        }
    }
}

TEST_F(Topology, LeftHandedFacesAreTurnedAsFarDoes) {
    Shape shape = GetShape("mixedPatch");
    shape.leftHanded = true;
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 2);
    for (int level = 0; level <= 2; ++level) {
        CallStatus status;
        EXPECT_TRUE(refiner->GetLevel(level).Validate(&status)) << status.GetErrorMessage();
    }
    int corner = 0;
    for (int f = 0; f < shape.GetNumFaces(); ++f) {
        std::vector<int> face(shape.faceVertices.begin() + corner,
                              shape.faceVertices.begin() + corner + shape.faceSizes[f]);
        std::reverse(face.begin(), face.end());
        EXPECT_EQ(rotated(toVector(refiner->GetLevel(0).GetFaceVertices(f))), rotated(face));
        corner += shape.faceSizes[f];
    }
}

TEST_F(Topology, RefinerOutlivesItsInput) {
    std::unique_ptr<TopologyRefiner> refiner;
    {
        Shape shape = GetShape("hexGrid");
        auto const base = CreateFarRefiner(shape);
        refiner = FarExt::TopologyRefinerFactory::Create(*base);
    }
    ASSERT_TRUE(refiner);
    ASSERT_TRUE(refiner->RefineUniform(2));
    EXPECT_TRUE(refiner->GetLevel(1).Validate());
}

} // namespace OpenSubdivHex::Regression::topologyTest

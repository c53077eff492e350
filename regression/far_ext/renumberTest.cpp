// SPDX-License-Identifier: Apache-2.0
#include "referenceMatch.h"

#include "far_ext/stencilTableFactory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::Regression::renumberTest {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

/// i -> (a i + b) mod n: a permutation without fixed pattern, the same on every run.
std::vector<int> makePermutation(int n) {
    int a = std::max(1, int(0.618 * n));
    while (std::gcd(a, n) != 1) {
        ++a;
    }
    std::vector<int> permutation(n);
    for (int i = 0; i < n; ++i) {
        permutation[i] = int((std::int64_t(a) * i + n / 3) % n);
    }
    return permutation;
}

/// A shape with its vertices and faces in another order and its faces begun elsewhere.
struct Renumbered {
    explicit Renumbered(Shape const &original)
        : vertices(makePermutation(original.GetNumVertices())),
          faces(makePermutation(original.GetNumFaces())) {
        shape.name = original.name;
        shape.positions.resize(original.positions.size());
        for (int v = 0; v < original.GetNumVertices(); ++v) {
            std::copy_n(&original.positions[3 * v], 3, &shape.positions[3 * vertices[v]]);
        }
        std::vector<std::vector<int>> newFaces(original.GetNumFaces());
        int first = 0;
        for (int f = 0; f < original.GetNumFaces(); ++f) {
            int const size = original.faceSizes[f];
            for (int i = 0; i < size; ++i) {
                int const place = (i + f) % size;
                newFaces[faces[f]].push_back(vertices[original.faceVertices[first + place]]);
            }
            first += size;
        }
        for (std::vector<int> const &face : newFaces) {
            shape.faceSizes.push_back(int(face.size()));
            shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
        }
    }

    Shape shape;
    std::vector<int> vertices; ///< new number of each vertex
    std::vector<int> faces;
};

/// New numbers of the vertices and faces of a level.
struct LevelMap {
    std::vector<int> vertices;
    std::vector<int> faces;
};

LevelMap mapChild(TopologyLevel const &a, TopologyLevel const &b, LevelMap const &parent) {
    LevelMap child;
    child.vertices = parent.vertices;
    child.faces = parent.faces;
    for (int f = 0; f < a.GetNumFaces(); ++f) {
        int const newFace = parent.faces[f];
        for (int v : a.GetFaceVertices(f)) {
            int const place = b.GetFaceVertices(newFace).FindIndex(parent.vertices[v]);
            child.vertices.push_back(b.GetNumVertices() + b.GetFaceFirstCorner(newFace) + place);
        }
    }
    for (int e = 0; e < a.GetNumEdges(); ++e) {
        Far::ConstIndexArray const verts = a.GetEdgeVertices(e);
        int const newEdge = b.FindEdge(parent.vertices[verts[0]], parent.vertices[verts[1]]);
        child.faces.push_back(b.GetNumFaces() + newEdge);
    }
    return child;
}

void expectSameFaces(TopologyLevel const &a, TopologyLevel const &b, LevelMap const &map) {
    ASSERT_EQ(a.GetNumVertices(), b.GetNumVertices());
    ASSERT_EQ(a.GetNumEdges(), b.GetNumEdges());
    ASSERT_EQ(a.GetNumFaces(), b.GetNumFaces());
    for (int f = 0; f < a.GetNumFaces(); ++f) {
        std::vector<int> expected;
        for (int v : a.GetFaceVertices(f)) {
            expected.push_back(map.vertices[v]);
        }
        Far::ConstIndexArray const face = b.GetFaceVertices(map.faces[f]);
        std::vector<int> const actual(face.begin(), face.end());
        auto const start = std::find(expected.begin(), expected.end(), actual[0]);
        std::rotate(expected.begin(), start, expected.end());
        ASSERT_EQ(actual, expected) << "face " << f;
    }
}

using Table = FarExt::StencilTableFactoryReal<double>::Table;

std::unique_ptr<Table const> lastLevelTable(TopologyRefiner const &refiner) {
    FarExt::StencilTableFactoryReal<double>::Options options;
    options.generateIntermediateLevels = false;
    return FarExt::StencilTableFactoryReal<double>::Create(refiner, options);
}

void expectSameStencils(Table const &a, Table const &b, std::vector<int> const &baseVertices,
                        std::vector<int> const &vertices) {
    ASSERT_EQ(a.GetNumStencils(), int(vertices.size()));
    ASSERT_EQ(b.GetNumStencils(), int(vertices.size()));
    for (int i = 0; i < a.GetNumStencils(); ++i) {
        auto const stencilA = a.GetStencil(i);
        auto const stencilB = b.GetStencil(vertices[i]);
        std::vector<std::pair<int, double>> rowA;
        std::vector<std::pair<int, double>> rowB;
        ASSERT_EQ(stencilA.GetSize(), stencilB.GetSize());
        for (int k = 0; k < stencilA.GetSize(); ++k) {
            rowA.emplace_back(baseVertices[stencilA.GetVertexIndices()[k]],
                              stencilA.GetWeights()[k]);
            rowB.emplace_back(stencilB.GetVertexIndices()[k], stencilB.GetWeights()[k]);
        }
        std::sort(rowA.begin(), rowA.end());
        std::sort(rowB.begin(), rowB.end());
        for (std::size_t k = 0; k < rowA.size(); ++k) {
            ASSERT_EQ(rowA[k].first, rowB[k].first);
            ASSERT_NEAR(rowA[k].second, rowB[k].second, 1e-14);
        }
    }
}

} // namespace

TEST(Renumber, PermutesTheOutputAndNothingElse) {
    for (Shape const &shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        Renumbered const renumbered(shape);
        int const numLevels = GetTestLevel(shape, 3, 10000);
        for (ReferenceMask mask : kMasks) {
            auto const a = CreateRefiner(shape, mask, numLevels);
            auto const b = CreateRefiner(renumbered.shape, mask, numLevels);
            LevelMap map{renumbered.vertices, renumbered.faces};
            ASSERT_NO_FATAL_FAILURE(expectSameFaces(a->GetLevel(0), b->GetLevel(0), map));
            for (int level = 1; level <= numLevels; ++level) {
                SCOPED_TRACE("level " + std::to_string(level));
                map = mapChild(a->GetLevel(level - 1), b->GetLevel(level - 1), map);
                ASSERT_NO_FATAL_FAILURE(
                    expectSameFaces(a->GetLevel(level), b->GetLevel(level), map));
            }
            if (numLevels > 0) {
                ASSERT_NO_FATAL_FAILURE(expectSameStencils(*lastLevelTable(*a), *lastLevelTable(*b),
                                                           renumbered.vertices, map.vertices));
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression::renumberTest

// SPDX-License-Identifier: Apache-2.0
//
// Two patches that share a border line, numbered and oriented differently: the same bits on it.
#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/refinementEvaluator.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <random>

namespace OpenSubdivHex::Regression::borderTest {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

constexpr int kLineEdges = 7;
constexpr int kNumLevels = 4;
constexpr int kLength = 3;
constexpr float kInfinite = 10;

/// A patch beside the line; vertex i of the line is vertex line[i] of the patch.
struct Patch {
    Shape shape;
    std::vector<float> values; ///< kLength per vertex
    std::vector<int> line;
};

float lineValue(int vertex, int k) {
    return float(std::sin(1.7 * vertex * vertex + 2.3 * k) + (k == 0 ? 0.37 * vertex : 0));
}

/// Faces, corners and vertices in an order that \p seed gives; reversed: turned over.
Patch makePatch(Tiling tiling, int numRows, unsigned seed, bool isReversed) {
    Patch patch;
    patch.shape = MakeTiling(tiling, kLineEdges, numRows);
    std::mt19937 random(seed);
    int const numVertices = patch.shape.GetNumVertices();
    std::vector<int> numbers(numVertices);
    std::iota(numbers.begin(), numbers.end(), 0);
    auto const shuffle = [&](auto &items) {
        for (std::size_t i = items.size() - 1; i > 0; --i) {
            std::swap(items[i], items[random() % (i + 1)]);
        }
    };
    std::vector<std::vector<int>> faces;
    auto first = patch.shape.faceVertices.begin();
    for (int size : patch.shape.faceSizes) {
        faces.emplace_back(first, first + size);
        first += size;
    }
    if (seed > 0) {
        shuffle(numbers);
        shuffle(faces);
    }
    patch.shape.faceSizes.clear();
    patch.shape.faceVertices.clear();
    for (std::vector<int> &face : faces) {
        std::rotate(face.begin(), face.begin() + int(random() % face.size()), face.end());
        if (isReversed) {
            std::reverse(face.begin(), face.end());
        }
        patch.shape.faceSizes.push_back(int(face.size()));
        for (int vertex : face) {
            patch.shape.faceVertices.push_back(numbers[vertex]);
        }
    }
    patch.values.resize(std::size_t(numVertices * kLength));
    for (int v = 0; v < numVertices; ++v) {
        for (int k = 0; k < kLength; ++k) {
            patch.values[std::size_t(numbers[v] * kLength + k)] =
                v <= kLineEdges ? lineValue(v, k) : float(random() % 1000) / 300 - 1;
        }
    }
    patch.line.assign(numbers.begin(), numbers.begin() + kLineEdges + 1);
    // The ends stay, and some vertices between do so for a while.
    patch.shape.cornerVertices = {patch.line[0], patch.line[kLineEdges], patch.line[2],
                                  patch.line[5]};
    patch.shape.cornerSharpness = {kInfinite, kInfinite, 0.3f, 1.6f};
    return patch;
}

std::unique_ptr<TopologyRefiner> refine(Patch const &patch, FarExt::HexSchemeOptions scheme) {
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions = scheme;
    ShapeDescriptor const descriptor(patch.shape);
    auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options);
    TopologyRefiner::UniformOptions uniform(kNumLevels);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

/// The vertices of a level along the line.
std::vector<int> walkLine(TopologyRefiner const &refiner, int depth, Patch const &patch) {
    auto const find = [&](int vertex) {
        for (int parent = 0; parent < depth; ++parent) {
            vertex = refiner.GetLevel(parent).GetVertexChildVertex(vertex);
        }
        return vertex;
    };
    TopologyLevel const &level = refiner.GetLevel(depth);
    // The ends stay, and so does a sharp vertex, behind any first step.
    int const start = find(patch.line[0]);
    int const middle = find(patch.line[2]);
    int const end = find(patch.line[kLineEdges]);
    for (bool const isForward : {true, false}) {
        std::vector<int> walk{start};
        while (walk.back() != end) {
            auto const edges = level.GetVertexEdges(walk.back());
            auto const verts = level.GetEdgeVertices(edges[isForward ? 0 : edges.size() - 1]);
            walk.push_back(verts[0] == walk.back() ? verts[1] : verts[0]);
        }
        if (std::count(walk.begin(), walk.end(), middle) > 0) {
            return walk;
        }
    }
    return {};
}

struct Element {
    void Clear() { std::fill_n(values, kLength, 0.0f); }
    void AddWithWeight(Element const &other, float weight) {
        for (int k = 0; k < kLength; ++k) {
            values[k] += weight * other.values[k];
        }
    }
    float values[kLength];
};

/// The values along the line at all levels, by PrimvarRefiner.
std::vector<float> refinePrimvar(Patch const &patch, TopologyRefiner const &refiner,
                                 bool isVarying) {
    std::vector<float> result;
    std::vector<Element> src(patch.values.size() / kLength);
    std::memcpy(src.data(), patch.values.data(), patch.values.size() * sizeof(float));
    FarExt::PrimvarRefiner const primvarRefiner(refiner);
    for (int level = 1; level <= kNumLevels; ++level) {
        std::vector<Element> dst(std::size_t(refiner.GetLevel(level).GetNumVertices()));
        if (isVarying) {
            primvarRefiner.InterpolateVarying(level, src, dst);
        } else {
            primvarRefiner.Interpolate(level, src, dst);
        }
        for (int v : walkLine(refiner, level, patch)) {
            result.insert(result.end(), dst[std::size_t(v)].values,
                          dst[std::size_t(v)].values + kLength);
        }
        src = std::move(dst);
    }
    return result;
}

/// Evaluates by RefinementEvaluator.
std::vector<float> evaluate(Patch const &patch, TopologyRefiner const &refiner, bool isVarying) {
    OsdExt::RefinementEvaluator::Options options;
    options.interpolationMode =
        isVarying ? FarExt::INTERPOLATE_VARYING : FarExt::INTERPOLATE_VERTEX;
    auto const evaluator = OsdExt::RefinementEvaluator::Create(refiner, options);
    OpenSubdiv::Osd::BufferDescriptor const packed(0, kLength, kLength);
    std::vector<float> result;
    for (int level = 1; level <= kNumLevels; ++level) {
        std::vector<float> dst(std::size_t(evaluator->GetNumElements(level) * kLength));
        evaluator->Evaluate(patch.values.data(), packed, dst.data(), packed, level);
        for (int v : walkLine(refiner, level, patch)) {
            float const *const value = dst.data() + std::size_t(v * kLength);
            result.insert(result.end(), value, value + kLength);
        }
    }
    return result;
}

/// The weights of the line's vertices for each vertex along it.
template <typename REAL>
std::vector<std::map<int, REAL>> findWeights(Patch const &patch, TopologyRefiner const &refiner) {
    std::map<int, int> lineVertex;
    for (int i = 0; i <= kLineEdges; ++i) {
        lineVertex[patch.line[i]] = i;
    }
    using Factory = FarExt::StencilTableFactoryReal<REAL>;
    typename Factory::Options options;
    options.generateIntermediateLevels = false;
    auto const table = Factory::Create(refiner, options);
    std::vector<std::map<int, REAL>> result;
    for (int v : walkLine(refiner, kNumLevels, patch)) {
        auto const stencil = table->GetStencil(v);
        result.emplace_back();
        for (int i = 0; i < stencil.GetSize(); ++i) {
            if (stencil.GetWeights()[i] != 0) {
                result.back()[lineVertex.at(stencil.GetVertexIndices()[i])] =
                    stencil.GetWeights()[i];
            }
        }
    }
    return result;
}

void expectSameBits(std::vector<float> const &actual, std::vector<float> const &expected) {
    ASSERT_EQ(actual.size(), expected.size());
    EXPECT_EQ(std::memcmp(actual.data(), expected.data(), actual.size() * sizeof(float)), 0);
}

/// Makes the two faces at a vertex of the line one.
void joinFacesAt(Patch &patch, int lineVertex) {
    int const vertex = patch.line[std::size_t(lineVertex)];
    std::vector<int> sizes;
    std::vector<int> vertices;
    std::vector<int> joined[2]; // each from the vertex on
    auto first = patch.shape.faceVertices.begin();
    for (int const size : patch.shape.faceSizes) {
        std::vector<int> face(first, first + size);
        first += size;
        auto const found = std::find(face.begin(), face.end(), vertex);
        if (found == face.end()) {
            sizes.push_back(size);
            vertices.insert(vertices.end(), face.begin(), face.end());
        } else {
            std::rotate(face.begin(), found, face.end());
            ASSERT_TRUE(joined[1].empty());
            joined[joined[0].empty() ? 0 : 1] = face;
        }
    }
    if (joined[0][1] != joined[1].back()) {
        std::swap(joined[0], joined[1]);
    }
    ASSERT_EQ(joined[0][1], joined[1].back());
    joined[1].pop_back(); // the other end of the edge between the two
    sizes.push_back(int(joined[0].size() + joined[1].size()) - 1);
    vertices.insert(vertices.end(), joined[1].begin(), joined[1].end());
    vertices.insert(vertices.end(), joined[0].begin() + 1, joined[0].end());
    patch.shape.faceSizes = sizes;
    patch.shape.faceVertices = vertices;
}

/// Compares patches of quads and of triangles, with two and three faces at the vertices of the line.
void expectSameLine(FarExt::HexSchemeOptions scheme, std::size_t leastNumSegments) {
    Patch const patch = makePatch(Tiling::Quads, 3, 0, false);
    auto const refiner = refine(patch, scheme);
    for (unsigned seed = 1; seed <= 6; ++seed) {
        Tiling const tiling = seed % 3 == 0 ? Tiling::Triangles : Tiling::Quads;
        Patch const other = makePatch(tiling, 1 + int(seed % 4), seed, seed % 2 != 0);
        auto const otherRefiner = refine(other, scheme);
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        bool const isPassed = scheme.firstStep == FarExt::FirstStep::Truncate;
        ASSERT_EQ(otherRefiner->GetLevel(0).GetVertexChildVertex(other.line[1]) < 0, isPassed);
        for (bool const isVarying : {false, true}) {
            auto const primvars = refinePrimvar(patch, *refiner, isVarying);
            ASSERT_GT(primvars.size(), kLength * leastNumSegments);
            expectSameBits(refinePrimvar(other, *otherRefiner, isVarying), primvars);
            auto const evaluated = evaluate(patch, *refiner, isVarying);
            expectSameBits(evaluate(other, *otherRefiner, isVarying), evaluated);
        }
        EXPECT_EQ(findWeights<float>(other, *otherRefiner), findWeights<float>(patch, *refiner));
        EXPECT_EQ(findWeights<double>(other, *otherRefiner), findWeights<double>(patch, *refiner));
    }
}

} // namespace

TEST(Border, PatchesHaveTheSameBitsOnTheLineTheyShare) {
    for (FarExt::FaceMask mask :
         {FarExt::FaceMask::Average, FarExt::FaceMask::Cosine, FarExt::FaceMask::Smooth}) {
        SCOPED_TRACE(testing::Message() << "mask " << int(mask));
        expectSameLine({mask}, 19U * kLineEdges);
    }
}

// Where a border passes a vertex, its line does not depend on the number of faces, from two on.
TEST(Border, TruncatedPatchesHaveTheSameBitsOnTheLineTheyShare) {
    FarExt::HexSchemeOptions scheme;
    scheme.firstStep = FarExt::FirstStep::Truncate;
    for (FarExt::FaceMask mask : {FarExt::FaceMask::Average, FarExt::FaceMask::Smooth}) {
        SCOPED_TRACE(testing::Message() << "mask " << int(mask));
        scheme.faceMask = mask;
        expectSameLine(scheme, 19U * kLineEdges);
    }
}

// A vertex with one face in one of the patches stays there alone.  At level 1 the line has it between the points that the
// other line has, too; behind that its points are others.
TEST(Border, TruncatedPatchesHaveOtherLinesWhereAVertexStaysInOne) {
    constexpr int kJoined = 3;
    FarExt::HexSchemeOptions scheme;
    scheme.firstStep = FarExt::FirstStep::Truncate;
    for (FarExt::FaceMask mask : {FarExt::FaceMask::Average, FarExt::FaceMask::Smooth}) {
        SCOPED_TRACE(testing::Message() << "mask " << int(mask));
        scheme.faceMask = mask;
        Patch const patch = makePatch(Tiling::Quads, 3, 0, false);
        Patch other = makePatch(Tiling::Quads, 3, 0, false);
        ASSERT_NO_FATAL_FAILURE(joinFacesAt(other, kJoined));
        auto const refiner = refine(patch, scheme);
        auto const otherRefiner = refine(other, scheme);
        ASSERT_LT(refiner->GetLevel(0).GetVertexChildVertex(patch.line[kJoined]), 0);
        int const stays = otherRefiner->GetLevel(0).GetVertexChildVertex(other.line[kJoined]);
        ASSERT_GE(stays, 0);
        std::vector<int> const otherWalk = walkLine(*otherRefiner, 1, other);
        auto const found = std::find(otherWalk.begin(), otherWalk.end(), stays);
        ASSERT_NE(found, otherWalk.end());
        std::size_t const place = std::size_t(found - otherWalk.begin());
        std::size_t const numPoints = walkLine(*refiner, 1, patch).size();
        ASSERT_EQ(otherWalk.size(), numPoints + 1);
        for (auto const &find : {&refinePrimvar, &evaluate}) {
            std::vector<float> const expected = find(patch, *refiner, false);
            std::vector<float> actual = find(other, *otherRefiner, false);
            auto const kept = actual.begin() + std::ptrdiff_t(kLength * place);
            actual.erase(kept, kept + kLength);
            EXPECT_TRUE(std::equal(actual.begin(),
                                   actual.begin() + std::ptrdiff_t(kLength * numPoints),
                                   expected.begin()));
            EXPECT_NE(actual.size(), expected.size());
        }
    }
}

} // namespace OpenSubdivHex::Regression::borderTest

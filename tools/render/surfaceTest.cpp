// SPDX-License-Identifier: Apache-2.0
#include "surface.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/refinementEvaluator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace OpenSubdivHex::Tools::surfaceTest {

namespace {

constexpr float kPositions[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                                -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};
constexpr int kFaceVertices[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                                 1, 3, 7, 5, 3, 2, 6, 7, 2, 0, 4, 6};
constexpr int kFaceSizes[] = {4, 4, 4, 4, 4, 4};

/// A cube with infinitely sharp edges, which stays a cube; its last face may be a hole.
std::unique_ptr<FarExt::TopologyRefiner> makeSharpCube(int level, bool hasHole) {
    std::set<std::pair<int, int>> edges;
    for (int corner = 0; corner < 24; ++corner) {
        int const next = corner % 4 == 3 ? corner - 3 : corner + 1;
        edges.insert(std::minmax({kFaceVertices[corner], kFaceVertices[next]}));
    }
    std::vector<int> ends;
    for (auto const &[first, second] : edges) {
        ends.insert(ends.end(), {first, second});
    }
    std::vector<float> const sharpness(edges.size(), 10.0f);
    int const hole = 5;
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = 8;
    descriptor.numFaces = 6;
    descriptor.numVertsPerFace = kFaceSizes;
    descriptor.vertIndicesPerFace = kFaceVertices;
    descriptor.numCreases = int(edges.size());
    descriptor.creaseVertexIndexPairs = ends.data();
    descriptor.creaseWeights = sharpness.data();
    descriptor.numHoles = hasHole ? 1 : 0;
    descriptor.holeIndices = &hole;
    auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor);
    FarExt::TopologyRefiner::UniformOptions options(level);
    options.fullTopologyInLastLevel = true;
    EXPECT_TRUE(refiner && refiner->RefineUniform(options));
    return refiner;
}

} // namespace

// Creases cross hexagons: no normal is a mean of those on the two sides of one.
TEST(Surface, PolygonNormalsKeepToTheirSideOfACrease) {
    for (int level : {0, 1, 2, 3}) {
        for (bool const cutsBaseFaces : {false, true}) {
            for (bool const hasHole : {false, true}) {
                SCOPED_TRACE(testing::Message() << "level " << level << ", cut " << cutsBaseFaces
                                                << ", hole " << hasHole);
                auto const refiner = makeSharpCube(level, hasHole);
                FarExt::TopologyLevel const &topology = refiner->GetLevel(level);
                std::vector<float> positions(3 * std::size_t(topology.GetNumVertices()));
                Osd::BufferDescriptor const desc(0, 3, 3);
                auto const evaluator = OsdExt::RefinementEvaluator::Create(*refiner);
                ASSERT_TRUE(evaluator &&
                            evaluator->Evaluate(kPositions, desc, positions.data(), desc, level));
                Surface surface(topology, cutsBaseFaces);
                surface.SetPositions(positions.data());
                ASSERT_GT(surface.GetTriangles().GetNumTriangles(), 0);
                for (int i = 0; i < surface.GetTriangles().GetNumTriangles(); ++i) {
                    // Outward along the axis of the base face.
                    int const *const base = kFaceVertices + 4 * surface.GetBaseFace(i);
                    Vec3 expected;
                    for (int corner = 0; corner < 4; ++corner) {
                        expected = expected + 0.25f * GetVec3(kPositions, base[corner]);
                    }
                    Vec3 const found[] = {
                        surface.GetFlatNormal(i), surface.GetSmoothNormal(i, 0, 0),
                        surface.GetSmoothNormal(i, 1, 0), surface.GetSmoothNormal(i, 0, 1)};
                    for (Vec3 const normal : found) {
                        ASSERT_NEAR(Dot(normal, expected), 1, 1e-4) << "triangle " << i;
                    }
                }
            }
        }
    }
}

} // namespace OpenSubdivHex::Tools::surfaceTest

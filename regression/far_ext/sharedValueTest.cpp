// SPDX-License-Identifier: Apache-2.0
//
// A face-varying value that several vertices share follows the rule of each of them.
#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace OpenSubdivHex::Regression::sharedValueTest {

namespace {

struct Value {
    void Clear() { x = 0; }
    void AddWithWeight(Value const &other, float weight) { x += weight * other.x; }

    float x = 0;
};

constexpr int kSize = 4; // quads along each side of a grid

int vertex(int i, int j) { return j * (kSize + 1) + i; }

/// The value of an inner vertex at level 1, with linear boundaries, in a grid whose values are
/// those of its vertices but for the border vertex 1, 0, which has the value \p borderValue.
float refineInnerValue(int innerVert, int borderValue) {
    std::vector<int> const sizes(kSize * kSize, 4);
    std::vector<int> verts;
    for (int j = 0; j < kSize; ++j) {
        for (int i = 0; i < kSize; ++i) {
            verts.insert(verts.end(),
                         {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    std::vector<int> valueIndices = verts;
    std::replace(valueIndices.begin(), valueIndices.end(), vertex(1, 0), borderValue);

    Far::TopologyDescriptor::FVarChannel channel;
    channel.numValues = vertex(kSize, kSize) + 1;
    channel.valueIndices = valueIndices.data();
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = channel.numValues;
    descriptor.numFaces = int(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = verts.data();
    descriptor.numFVarChannels = 1;
    descriptor.fvarChannels = &channel;
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_BOUNDARIES);
    auto const refiner = FarExt::TopologyRefinerFactory::Create(descriptor, options);
    FarExt::TopologyRefiner::UniformOptions uniform(1);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);

    float const columns[kSize + 1] = {0, 1, 5, 7, 20};
    std::vector<Value> values(channel.numValues);
    for (int v = 0; v < channel.numValues; ++v) {
        values[v].x = columns[v % (kSize + 1)];
    }
    FarExt::TopologyLevel const &level = refiner->GetLevel(1);
    std::vector<Value> refined(level.GetNumFVarValues());
    FarExt::PrimvarRefiner(*refiner).InterpolateFaceVarying(1, values, refined);
    int const face = level.GetVertexFaces(innerVert)[0];
    int const corner = level.GetVertexFaceLocalIndices(innerVert)[0];
    return refined[level.GetFaceFVarValues(face)[corner]].x;
}

} // namespace

// The two vertices lie in one column, so that sharing changes no value.
TEST(SharedValue, InnerVertexIsNotPinnedByTheBorder) {
    int const inner = vertex(1, 2);
    float const expected = refineInnerValue(inner, vertex(1, 0));
    EXPECT_NE(expected, 1); // the inner value moves
    EXPECT_FLOAT_EQ(refineInnerValue(inner, inner), expected);
}

} // namespace OpenSubdivHex::Regression::sharedValueTest

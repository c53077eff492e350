// SPDX-License-Identifier: Apache-2.0
//
// Properties of face-varying channels, orientation and tables, whatever the rules are in detail.
#include "properties.h"

#include "far_ext/stencilTableFactory.h"

#include <algorithm>
#include <set>

namespace OpenSubdivHex::Regression::channelPropertyTest {

using FarExt::TopologyLevel;
using IndexArray = Far::ConstIndexArray;

namespace {

void expectChartsApart(Shape const &shape, int channel, int numLevels, Sdc::Options options) {
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, numLevels, options);
    TopologyLevel const &base = refiner->GetLevel(0);
    // Charts: faces joined across edges whose ends have the same values on both sides.
    FVarChannel const &values = shape.fvarChannels[channel];
    int const numValues = int(values.values.size()) / values.width;
    std::vector<int> chart(base.GetNumFaces(), -1);
    auto const valueAt = [&](int face, int vert) {
        int const place = base.GetFaceVertices(face).FindIndex(vert);
        return base.GetFaceFVarValues(face, channel)[place];
    };
    for (int seed = 0; seed < base.GetNumFaces(); ++seed) {
        std::vector<int> faces;
        if (chart[seed] < 0) {
            chart[seed] = seed;
            faces.push_back(seed);
        }
        while (!faces.empty()) {
            int const face = faces.back();
            faces.pop_back();
            for (int edge : base.GetFaceEdges(face)) {
                IndexArray const verts = base.GetEdgeVertices(edge);
                for (int other : base.GetEdgeFaces(edge)) {
                    if (chart[other] < 0 && valueAt(face, verts[0]) == valueAt(other, verts[0]) &&
                        valueAt(face, verts[1]) == valueAt(other, verts[1])) {
                        chart[other] = seed;
                        faces.push_back(other);
                    }
                }
            }
        }
    }
    std::vector<std::set<int>> chartsOfValue(numValues);
    for (int f = 0; f < base.GetNumFaces(); ++f) {
        for (int value : base.GetFaceFVarValues(f, channel)) {
            chartsOfValue[value].insert(chart[f]);
        }
    }
    FarExt::StencilTableFactory::Options tableOptions;
    tableOptions.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
    tableOptions.fvarChannel = channel;
    tableOptions.generateIntermediateLevels = false;
    auto const table = FarExt::StencilTableFactory::Create(*refiner, tableOptions);
    ASSERT_TRUE(table);
    TopologyLevel const &last = refiner->GetLevel(numLevels);
    ASSERT_EQ(table->GetNumStencils(), last.GetNumFVarValues(channel));
    // There is a chart that all control values of all values of a face, or half of one, are in.
    auto const expectOneChart = [&](IndexArray faceValues) {
        std::set<int> common =
            chartsOfValue[table->GetStencil(faceValues[0]).GetVertexIndices()[0]];
        for (int value : faceValues) {
            auto const stencil = table->GetStencil(value);
            for (int k = 0; k < stencil.GetSize(); ++k) {
                std::set<int> const &charts = chartsOfValue[stencil.GetVertexIndices()[k]];
                for (auto it = common.begin(); it != common.end();) {
                    it = charts.count(*it) != 0 ? std::next(it) : common.erase(it);
                }
            }
        }
        ASSERT_FALSE(common.empty());
    };
    for (int f = 0; f < last.GetNumFaces(); ++f) {
        if (!last.IsFaceFVarSplit(f, channel)) {
            ASSERT_NO_FATAL_FAILURE(expectOneChart(last.GetFaceFVarValues(f, channel)));
            continue;
        }
        std::set<int> halves[2];
        for (int half : {0, 1}) {
            IndexArray const halfValues = last.GetFaceFVarValues(f, channel, half);
            ASSERT_EQ(halfValues.size(), 4);
            ASSERT_NO_FATAL_FAILURE(expectOneChart(halfValues));
            halves[half].insert(halfValues.begin(), halfValues.end());
        }
        for (int value : halves[0]) {
            ASSERT_EQ(halves[1].count(value), 0u);
        }
    }
}

} // namespace

TEST(Property, ChartsStayApart) {
    for (Shape const &shape : GetFeatureShapes()) {
        for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
            for (auto linear :
                 {Sdc::Options::FVAR_LINEAR_NONE, Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
                  Sdc::Options::FVAR_LINEAR_BOUNDARIES, Sdc::Options::FVAR_LINEAR_ALL}) {
                SCOPED_TRACE(shape.name);
                Sdc::Options options = MakeBoundaryOptions(kEdgeAndCorner);
                options.SetFVarLinearInterpolation(linear);
                ASSERT_NO_FATAL_FAILURE(expectChartsApart(
                    shape, channel, std::max(1, GetTestLevel(shape, 2, 120000)), options));
            }
        }
    }
}

TEST(Property, LeftHandedIsReversed) {
    Shape const &leftHanded = GetFeatureShape("leftHanded");
    ASSERT_TRUE(leftHanded.leftHanded);
    Shape reversed = leftHanded;
    reversed.leftHanded = false;
    int first = 0;
    for (int size : reversed.faceSizes) {
        // Far keeps the first vertex.
        std::reverse(reversed.faceVertices.begin() + first + 1,
                     reversed.faceVertices.begin() + first + size);
        auto &values = reversed.fvarChannels[0].valueIndices;
        std::reverse(values.begin() + first + 1, values.begin() + first + size);
        first += size;
    }
    for (auto rule : {kNone, kEdgeOnly, kEdgeAndCorner}) {
        auto const a =
            CreateRefiner(leftHanded, ReferenceMask::Average, 3, MakeBoundaryOptions(rule));
        auto const b =
            CreateRefiner(reversed, ReferenceMask::Average, 3, MakeBoundaryOptions(rule));
        EXPECT_EQ(InterpolateLevels(*a, GetPositions(leftHanded)),
                  InterpolateLevels(*b, GetPositions(leftHanded)));
        ReferenceValues const values = GetValues(leftHanded.fvarChannels[0]);
        EXPECT_EQ(InterpolateLevels(*a, values, ValueKind::FaceVarying),
                  InterpolateLevels(*b, values, ValueKind::FaceVarying));
        for (int depth = 0; depth <= 3; ++depth) {
            ASSERT_EQ(a->GetLevel(depth).GetNumFaces(), b->GetLevel(depth).GetNumFaces());
            for (int f = 0; f < a->GetLevel(depth).GetNumFaces(); ++f) {
                IndexArray const aVerts = a->GetLevel(depth).GetFaceVertices(f);
                IndexArray const bVerts = b->GetLevel(depth).GetFaceVertices(f);
                ASSERT_TRUE(std::equal(aVerts.begin(), aVerts.end(), bVerts.begin(), bVerts.end()));
            }
        }
    }
}

TEST(Property, ChannelWithoutSeamsIsAsVertices) {
    ForEachFeature([](Shape const &original, Sdc::Options options) {
        if (!original.manifold || original.name.rfind("degenerate", 0) == 0) {
            return; // come apart at their flaws
        }
        Shape shape = original;
        shape.fvarChannels = {MakeVertexChannel(shape)};
        shape.fvarChannels[0].width = 3;
        shape.fvarChannels[0].values = shape.positions;
        int const numLevels = GetTestLevel(shape, 3, 6000);
        options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
        auto refiner = CreateRefiner(shape, ReferenceMask::Cosine, numLevels, options);
        auto const vertexLevels = InterpolateLevels(*refiner, GetPositions(shape));
        auto const valueLevels =
            InterpolateLevels(*refiner, GetPositions(shape), ValueKind::FaceVarying);
        options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
        refiner = CreateRefiner(shape, ReferenceMask::Cosine, numLevels, options);
        auto const varyingLevels =
            InterpolateLevels(*refiner, GetPositions(shape), ValueKind::Varying);
        auto const linearLevels =
            InterpolateLevels(*refiner, GetPositions(shape), ValueKind::FaceVarying);
        for (int depth = 0; depth <= numLevels; ++depth) {
            TopologyLevel const &level = refiner->GetLevel(depth);
            for (int f = 0; f < level.GetNumFaces(); ++f) {
                IndexArray const verts = level.GetFaceVertices(f);
                IndexArray const values = level.GetFaceFVarValues(f);
                ASSERT_FALSE(level.IsFaceFVarSplit(f));
                ASSERT_TRUE(level.DoesFaceFVarTopologyMatch(f));
                for (int i = 0; i < verts.size(); ++i) {
                    ASSERT_LT(
                        (vertexLevels[depth].row(verts[i]) - valueLevels[depth].row(values[i]))
                            .norm(),
                        1e-13 * (1 + GetSize(vertexLevels[0])));
                    ASSERT_LT(
                        (varyingLevels[depth].row(verts[i]) - linearLevels[depth].row(values[i]))
                            .norm(),
                        1e-13 * (1 + GetSize(vertexLevels[0])));
                }
            }
        }
    });
}

TEST(Property, StencilsAreNonNegativeAndSumToOne) {
    ForEachFeature([](Shape const &shape, Sdc::Options options) {
        for (ReferenceMask mask : kMasks) {
            auto const refiner = CreateRefiner(shape, mask, GetTestLevel(shape, 3, 3000), options);
            for (int mode = 0; mode < 2 + int(shape.fvarChannels.size()); ++mode) {
                FarExt::StencilTableFactoryReal<double>::Options tableOptions;
                tableOptions.interpolationMode = mode == 0   ? FarExt::INTERPOLATE_VERTEX
                                                 : mode == 1 ? FarExt::INTERPOLATE_VARYING
                                                             : FarExt::INTERPOLATE_FACE_VARYING;
                tableOptions.fvarChannel = std::max(0, mode - 2);
                FarExt::CallStatus status;
                auto const table = FarExt::StencilTableFactoryReal<double>::Create(
                    *refiner, tableOptions, &status);
                ASSERT_TRUE(table) << status.GetErrorMessage();
                for (int i = 0; i < table->GetNumStencils(); ++i) {
                    auto const stencil = table->GetStencil(i);
                    double sum = 0;
                    for (int k = 0; k < stencil.GetSize(); ++k) {
                        ASSERT_GE(stencil.GetWeights()[k], 0);
                        sum += stencil.GetWeights()[k];
                    }
                    ASSERT_NEAR(sum, 1, 1e-12);
                }
            }
        }
    });
}

TEST(Property, StencilTablesRefuseAChannelOutOfRange) {
    Shape const &shape = GetFeatureShape("cubeOfCharts");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 1);
    for (int channel : {-1, 2}) {
        FarExt::StencilTableFactory::Options options;
        options.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
        options.fvarChannel = channel;
        FarExt::CallStatus status;
        EXPECT_FALSE(FarExt::StencilTableFactory::Create(*refiner, options, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_NE(status.GetErrorMessage().find(std::to_string(channel)), std::string::npos);
        // It does not matter to other modes.
        options.interpolationMode = FarExt::INTERPOLATE_VERTEX;
        EXPECT_TRUE(FarExt::StencilTableFactory::Create(*refiner, options, &status));
    }
}

} // namespace OpenSubdivHex::Regression::channelPropertyTest

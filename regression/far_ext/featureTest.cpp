// SPDX-License-Identifier: Apache-2.0
//
// Boundaries, tags, flaws and face-varying channels: every feature shape against the reference.
#include "referenceMatch.h"
#include "taggedMatch.h"
#include "valueLevels.h"

#include "far_ext/stencilTableFactory.h"
#include "regression/shapes/featureShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

using FarExt::TopologyRefiner;

namespace {

constexpr Sdc::Options::VtxBoundaryInterpolation kBoundaries[] = {
    Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
    Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER};
constexpr Sdc::Options::CreasingMethod kCreasingMethods[] = {Sdc::Options::CREASE_UNIFORM,
                                                             Sdc::Options::CREASE_CHAIKIN};
constexpr Sdc::Options::FVarLinearInterpolation kLinearInterpolations[] = {
    Sdc::Options::FVAR_LINEAR_NONE,          Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
    Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
    Sdc::Options::FVAR_LINEAR_BOUNDARIES,    Sdc::Options::FVAR_LINEAR_ALL};

/// What is the same up to the arithmetic of one row of weights.
template <typename REAL>
constexpr double kTolerance = sizeof(REAL) == 8 ? 1e-12 : 2e-6;

/// Rows that the reference does not know (values that no corner has) are skipped.
void expectEqual(std::vector<ReferenceValues> const &actual,
                 std::vector<ReferenceValues> const &expected, double tolerance) {
    ASSERT_EQ(actual.size(), expected.size());
    double const allowed = tolerance * std::max(1.0, GetSize(expected[0]));
    for (std::size_t level = 0; level < expected.size(); ++level) {
        ASSERT_EQ(actual[level].rows(), expected[level].rows());
        for (Eigen::Index i = 0; i < expected[level].rows(); ++i) {
            if (!std::isnan(expected[level](i, 0))) {
                ASSERT_LE((actual[level].row(i) - expected[level].row(i)).cwiseAbs().maxCoeff(),
                          allowed)
                    << "level " << level << ", row " << i;
            }
        }
    }
}

/// Checks a stencil table of one mode for some of its flags: by combination number.
template <typename REAL>
void expectTable(TopologyRefiner const &refiner, std::vector<ReferenceValues> const &levels,
                 FarExt::StencilMode mode, int channel, int flags) {
    using Factory = FarExt::StencilTableFactoryReal<REAL>;
    typename Factory::Options options;
    options.interpolationMode = mode;
    options.fvarChannel = channel;
    options.generateControlVerts = (flags & 1) != 0;
    options.generateIntermediateLevels = (flags & 2) != 0;
    options.factorizeIntermediateLevels = (flags & 4) != 0;
    SCOPED_TRACE(testing::Message() << "mode " << mode << ", flags " << flags);
    FarExt::Status status;
    auto const table = Factory::Create(refiner, options, &status);
    ASSERT_TRUE(table) << status.GetMessage();
    double const allowed = kTolerance<REAL> * std::max(1.0, GetSize(levels[0]));
    int stencil = 0;
    int const last = int(levels.size()) - 1;
    for (int level = options.generateControlVerts ? 0 : 1; level <= last; ++level) {
        if (level > 0 && level < last && !options.generateIntermediateLevels) {
            continue;
        }
        bool const fromBase = level == 0 || options.factorizeIntermediateLevels;
        ReferenceValues const &sources = levels[fromBase ? 0 : level - 1];
        for (Eigen::Index row = 0; row < levels[level].rows(); ++row, ++stencil) {
            ASSERT_LT(stencil, table->GetNumStencils());
            Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(sources.cols());
            int const offset = table->GetOffsets()[stencil];
            for (int k = 0; k < table->GetSizes()[stencil]; ++k) {
                int const index = table->GetControlIndices()[offset + k];
                ASSERT_LT(index, sources.rows());
                sum += double(table->GetWeights()[offset + k]) * sources.row(index);
            }
            if (!std::isnan(levels[level](row, 0))) {
                ASSERT_LE((sum - levels[level].row(row)).cwiseAbs().maxCoeff(), allowed)
                    << "level " << level << ", row " << row;
            }
        }
    }
    ASSERT_EQ(stencil, table->GetNumStencils());
}

/// All tables of a mode when the mesh is small, else one in float and one in double.
void expectTables(TopologyRefiner const &refiner, std::vector<ReferenceValues> const &levels,
                  FarExt::StencilMode mode, int channel, int seed) {
    for (int flags = 0; flags < 8; ++flags) {
        if (levels[0].rows() < 60 ? flags % 2 == seed % 2 : flags == 6) {
            ASSERT_NO_FATAL_FAILURE(expectTable<double>(refiner, levels, mode, channel, flags));
            ASSERT_NO_FATAL_FAILURE(expectTable<float>(refiner, levels, mode, channel, flags));
        }
    }
}

void expectMeshEqual(Shape const &shape, Sdc::Options options, int numLevels) {
    auto const topology = CreateRefiner(shape, ReferenceMask::Average, numLevels, options);
    TaggedMatch const match(shape, *topology);
    ASSERT_EQ(match.GetError(), "");
    for (int level = 0; level <= numLevels; ++level) {
        FarExt::Status status;
        ASSERT_TRUE(topology->GetLevel(level).Validate(&status)) << status.GetMessage();
    }
    ReferenceValues const positions = GetPositions(shape);
    for (ReferenceMask mask : kMasks) {
        SCOPED_TRACE(ToString(mask));
        auto const refiner = CreateRefiner(shape, mask, numLevels, options);
        auto const expected = match.InterpolateAll(mask, positions);
        ASSERT_NO_FATAL_FAILURE(
            expectEqual(InterpolateLevels(*refiner, positions), expected, kTolerance<double>));
        ASSERT_NO_FATAL_FAILURE(expectEqual(InterpolateLevels<float>(*refiner, positions), expected,
                                            kTolerance<float>));
        ASSERT_NO_FATAL_FAILURE(
            expectTables(*refiner, expected, FarExt::INTERPOLATE_VERTEX, 0, int(mask)));
    }
    auto const varying = match.InterpolateVaryingAll(positions);
    ASSERT_NO_FATAL_FAILURE(expectEqual(InterpolateLevels(*topology, positions, ValueKind::Varying),
                                        varying, kTolerance<double>));
    ASSERT_NO_FATAL_FAILURE(expectTables(*topology, varying, FarExt::INTERPOLATE_VARYING, 0, 1));
}

void expectChannelEqual(Shape const &shape, Sdc::Options options, int channel, int numLevels) {
    SCOPED_TRACE(testing::Message()
                 << "channel " << channel << ", linear " << options.GetFVarLinearInterpolation());
    bool const isLinear = options.GetFVarLinearInterpolation() == Sdc::Options::FVAR_LINEAR_ALL;
    auto const topology = CreateRefiner(shape, ReferenceMask::Average, numLevels, options);
    ASSERT_EQ(topology->GetFVarLinearInterpolation(channel), options.GetFVarLinearInterpolation());
    TaggedMatch const match(shape, *topology, channel);
    ASSERT_EQ(match.GetError(), "");
    ReferenceValues const values = GetValues(shape.fvarChannels[channel]);
    for (ReferenceMask mask : kMasks) {
        SCOPED_TRACE(ToString(mask));
        auto const refiner = CreateRefiner(shape, mask, numLevels, options);
        auto const expected =
            isLinear ? match.InterpolateVaryingAll(values) : match.InterpolateAll(mask, values);
        ASSERT_NO_FATAL_FAILURE(
            expectEqual(InterpolateLevels(*refiner, values, ValueKind::FaceVarying, channel),
                        expected, kTolerance<double>));
        ASSERT_NO_FATAL_FAILURE(expectTable<double>(
            *refiner, expected, FarExt::INTERPOLATE_FACE_VARYING, channel, 6 + channel % 2));
        ASSERT_NO_FATAL_FAILURE(
            expectTable<float>(*refiner, expected, FarExt::INTERPOLATE_FACE_VARYING, channel, 4));
    }
}

} // namespace

class Feature : public testing::Test {
protected:
    /// Runs check(shape, options) for every shape, boundary rule and creasing method; a failure
    /// ends the shape's checks, not those of others.
    template <typename CHECK>
    void forEach(std::vector<Shape> const &shapes, CHECK const &check) {
        for (Shape const &shape : shapes) {
            for (auto boundary : kBoundaries) {
                for (auto method : kCreasingMethods) {
                    if (shape.creaseSharpness.empty() && method != kCreasingMethods[0]) {
                        continue;
                    }
                    SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary
                                                    << ", creases " << method);
                    Sdc::Options options;
                    options.SetVtxBoundaryInterpolation(boundary);
                    options.SetCreasingMethod(method);
                    check(shape, options);
                }
            }
        }
    }
};

TEST_F(Feature, MeshEqualsReference) {
    forEach(GetFeatureShapes(), [](Shape const &shape, Sdc::Options options) {
        expectMeshEqual(shape, options, GetTestLevel(shape, 4, 40000));
    });
}

TEST_F(Feature, PlainShapesEqualReference) {
    forEach(GetShapes(), [](Shape const &shape, Sdc::Options options) {
        expectMeshEqual(shape, options, GetTestLevel(shape, 4, 16000));
    });
}

TEST_F(Feature, FaceVaryingEqualsReference) {
    forEach(GetFeatureShapes(), [](Shape const &shape, Sdc::Options options) {
        for (auto linear : kLinearInterpolations) {
            options.SetFVarLinearInterpolation(linear);
            for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
                expectChannelEqual(shape, options, channel, GetTestLevel(shape, 4, 10000));
            }
        }
    });
}

} // namespace OpenSubdivHex::Regression

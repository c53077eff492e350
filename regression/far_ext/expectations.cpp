// SPDX-License-Identifier: Apache-2.0
#include "expectations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

using FarExt::TopologyRefiner;

namespace {

/// All tables of a mode when the mesh is small, else one in float and one in double.
void expectTables(TopologyRefiner const &refiner, std::vector<ReferenceValues> const &levels,
                  FarExt::StencilMode mode, int seed) {
    for (int flags = 0; flags < 8; ++flags) {
        if (levels[0].rows() < 60 ? flags % 2 == seed % 2 : flags == 6) {
            ASSERT_NO_FATAL_FAILURE(ExpectTable<double>(refiner, levels, mode, 0, flags));
            ASSERT_NO_FATAL_FAILURE(ExpectTable<float>(refiner, levels, mode, 0, flags));
        }
    }
}

} // namespace

void ExpectValid(TopologyRefiner const &refiner) {
    for (int level = 0; level <= refiner.GetMaxLevel(); ++level) {
        FarExt::Status status;
        ASSERT_TRUE(refiner.GetLevel(level).Validate(&status))
            << "level " << level << ": " << status.GetMessage();
    }
}

void ExpectLevelsEqual(std::vector<ReferenceValues> const &actual,
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

template <typename REAL>
void ExpectTable(TopologyRefiner const &refiner, std::vector<ReferenceValues> const &levels,
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
    double const allowed = kRowTolerance<REAL> * std::max(1.0, GetSize(levels[0]));
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

template void ExpectTable<float>(TopologyRefiner const &, std::vector<ReferenceValues> const &,
                                 FarExt::StencilMode, int, int);
template void ExpectTable<double>(TopologyRefiner const &, std::vector<ReferenceValues> const &,
                                  FarExt::StencilMode, int, int);

void ExpectVertexValuesEqual(TopologyRefiner const &refiner, TaggedMatch const &match,
                             ReferenceMask mask, ReferenceValues const &base) {
    auto const expected = match.InterpolateAll(mask, base);
    ASSERT_NO_FATAL_FAILURE(
        ExpectLevelsEqual(InterpolateLevels(refiner, base), expected, kRowTolerance<double>));
    ASSERT_NO_FATAL_FAILURE(
        ExpectLevelsEqual(InterpolateLevels<float>(refiner, base), expected, kRowTolerance<float>));
    expectTables(refiner, expected, FarExt::INTERPOLATE_VERTEX, int(mask));
}

void ExpectVaryingValuesEqual(TopologyRefiner const &refiner, TaggedMatch const &match,
                              ReferenceValues const &base) {
    auto const expected = match.InterpolateVaryingAll(base);
    ASSERT_NO_FATAL_FAILURE(ExpectLevelsEqual(InterpolateLevels(refiner, base, ValueKind::Varying),
                                              expected, kRowTolerance<double>));
    expectTables(refiner, expected, FarExt::INTERPOLATE_VARYING, 1);
}

void ExpectChannelValuesEqual(TopologyRefiner const &refiner, TaggedMatch const &match,
                              ReferenceMask mask, ReferenceValues const &base, int channel) {
    bool const isLinear =
        refiner.GetFVarLinearInterpolation(channel) == Sdc::Options::FVAR_LINEAR_ALL;
    auto const expected =
        isLinear ? match.InterpolateVaryingAll(base) : match.InterpolateAll(mask, base);
    ASSERT_NO_FATAL_FAILURE(
        ExpectLevelsEqual(InterpolateLevels(refiner, base, ValueKind::FaceVarying, channel),
                          expected, kRowTolerance<double>));
    ASSERT_NO_FATAL_FAILURE(ExpectTable<double>(refiner, expected, FarExt::INTERPOLATE_FACE_VARYING,
                                                channel, 6 + channel % 2));
    ExpectTable<float>(refiner, expected, FarExt::INTERPOLATE_FACE_VARYING, channel, 4);
}

} // namespace OpenSubdivHex::Regression

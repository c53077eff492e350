// SPDX-License-Identifier: Apache-2.0
#include "referenceMatch.h"

#include "far_ext/stencilTableFactory.h"
#include "regression/reference/largestValue.h"

#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>
#ifdef OPENSUBDIV_HAS_OPENMP
#include <opensubdiv/osd/ompEvaluator.h>
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::Regression::stencilTest {

using FarExt::StencilTableFactory;
using FarExt::StencilTableFactoryReal;
using FarExt::TopologyRefiner;

namespace Osd = OpenSubdiv::Osd;

namespace {

template <typename REAL>
using Factory = StencilTableFactoryReal<REAL>;

template <typename REAL>
using Options = typename Factory<REAL>::Options;

/// Relative to the size of the values.
template <typename REAL>
constexpr double kTolerance = sizeof(REAL) == 8 ? 1e-12 : 1e-6;

/// The content that a table must have: the values of its rows, and the values that the rows' indices refer to.
struct ExpectedRows {
    struct Block {
        ReferenceValues values;  ///< one row per stencil
        ReferenceValues sources; ///< what the indices of these stencils refer to
    };
    std::vector<Block> blocks;
    int numStencils = 0;

    void Add(ReferenceValues const &values, ReferenceValues const &sources) {
        blocks.push_back({values, sources});
        numStencils += int(values.rows());
    }
};

/// The layout that StencilTableFactoryReal::Options documents; \p levels are values by level.
template <typename OPTIONS>
ExpectedRows makeExpectedRows(std::vector<ReferenceValues> const &levels, OPTIONS const &options) {
    ExpectedRows rows;
    if (options.generateControlVerts) {
        rows.Add(levels[0], levels[0]);
    }
    int const lastLevel = std::min(options.maxLevel, int(levels.size()) - 1);
    for (int level = 1; level <= lastLevel; ++level) {
        if (options.generateIntermediateLevels || level == lastLevel) {
            rows.Add(levels[level], levels[options.factorizeIntermediateLevels ? 0 : level - 1]);
        }
    }
    return rows;
}

/// Sizes, offsets and the properties of each stencil.
template <typename TABLE>
void expectWellFormed(TABLE const &table, ExpectedRows const &expected, double sumTolerance) {
    ASSERT_EQ(table.GetNumStencils(), expected.numStencils);
    ASSERT_EQ(int(table.GetSizes().size()), expected.numStencils);
    ASSERT_EQ(int(table.GetOffsets().size()), expected.numStencils);
    ASSERT_EQ(table.GetWeights().size(), table.GetControlIndices().size());
    EXPECT_EQ(table.GetSizes().capacity(), table.GetSizes().size());
    EXPECT_EQ(table.GetOffsets().capacity(), table.GetOffsets().size());
    EXPECT_EQ(table.GetControlIndices().capacity(), table.GetControlIndices().size());
    EXPECT_EQ(table.GetWeights().capacity(), table.GetWeights().size());
    int stencil = 0;
    std::size_t offset = 0;
    for (ExpectedRows::Block const &block : expected.blocks) {
        for (Eigen::Index row = 0; row < block.values.rows(); ++row, ++stencil) {
            int const size = table.GetSizes()[stencil];
            ASSERT_GT(size, 0);
            ASSERT_EQ(std::size_t(table.GetOffsets()[stencil]), offset);
            double sum = 0;
            int previousIndex = -1;
            for (int k = 0; k < size; ++k) {
                int const index = table.GetControlIndices().at(offset + k);
                ASSERT_GT(index, previousIndex) << "stencil " << stencil;
                ASSERT_LT(index, block.sources.rows()) << "stencil " << stencil;
                ASSERT_GE(table.GetWeights()[offset + k], 0) << "stencil " << stencil;
                sum += table.GetWeights()[offset + k];
                previousIndex = index;
            }
            ASSERT_NEAR(sum, 1, sumTolerance) << "stencil " << stencil;
            offset += size;
        }
    }
    ASSERT_EQ(offset, table.GetWeights().size());
}

/// Each row applied to its sources gives the reference's value.
template <typename TABLE>
void expectValues(TABLE const &table, ExpectedRows const &expected, double tolerance) {
    int stencil = 0;
    for (ExpectedRows::Block const &block : expected.blocks) {
        double const allowed = tolerance * GetSize(block.sources);
        for (Eigen::Index row = 0; row < block.values.rows(); ++row, ++stencil) {
            Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(block.values.cols());
            int const offset = table.GetOffsets()[stencil];
            for (int k = 0; k < table.GetSizes()[stencil]; ++k) {
                sum += double(table.GetWeights()[offset + k]) *
                       block.sources.row(table.GetControlIndices()[offset + k]);
            }
            ASSERT_LE(GetLargestValue(sum - block.values.row(row)), allowed)
                << "stencil " << stencil;
        }
    }
}

template <typename REAL>
void expectTable(TopologyRefiner const &refiner, std::vector<ReferenceValues> const &levels,
                 Options<REAL> const &options) {
    FarExt::CallStatus status;
    auto const table = Factory<REAL>::Create(refiner, options, &status);
    ASSERT_TRUE(table) << status.GetErrorMessage();
    EXPECT_TRUE(status.IsOk());
    EXPECT_EQ(table->GetNumControlVertices(), refiner.GetLevel(0).GetNumVertices());
    ExpectedRows const expected = makeExpectedRows(levels, options);
    ASSERT_NO_FATAL_FAILURE(expectWellFormed(*table, expected, kTolerance<REAL>));
    ASSERT_NO_FATAL_FAILURE(expectValues(*table, expected, kTolerance<REAL>));
}

/// Calls check(options) for each combination of the three flags and the mode.
template <typename REAL, typename CHECK>
void forEachFlags(CHECK const &check) {
    for (int bits = 0; bits < 16; ++bits) {
        Options<REAL> options;
        options.interpolationMode =
            bits & 1 ? FarExt::INTERPOLATE_VARYING : FarExt::INTERPOLATE_VERTEX;
        options.generateControlVerts = (bits & 2) != 0;
        options.generateIntermediateLevels = (bits & 4) != 0;
        options.factorizeIntermediateLevels = (bits & 8) != 0;
        check(options);
    }
}

template <typename REAL>
void expectEveryCombination() {
    for (Shape const &shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        ReferenceMatch const match(shape, GetTestLevel(shape, 2, 3000));
        ASSERT_EQ(match.GetError(), "");
        int const numLevels = match.GetMaxLevel();
        std::vector<ReferenceValues> const varying =
            match.InterpolateVaryingAll(GetPositions(shape));
        for (ReferenceMask mask : kMasks) {
            SCOPED_TRACE(ToString(mask));
            auto const refiner = CreateRefiner(shape, mask, numLevels);
            std::vector<ReferenceValues> const vertex =
                match.InterpolateAll(mask, GetPositions(shape));
            forEachFlags<REAL>([&](Options<REAL> options) {
                bool const isVarying = options.interpolationMode == FarExt::INTERPOLATE_VARYING;
                for (int maxLevel : {0, 1, 2, 3, 17, std::numeric_limits<int>::max()}) {
                    SCOPED_TRACE(testing::Message()
                                 << "maxLevel " << maxLevel << " varying " << isVarying
                                 << " control " << options.generateControlVerts << " intermediate "
                                 << options.generateIntermediateLevels << " factorize "
                                 << options.factorizeIntermediateLevels);
                    options.maxLevel = maxLevel;
                    ASSERT_NO_FATAL_FAILURE(
                        expectTable<REAL>(*refiner, isVarying ? varying : vertex, options));
                }
            });
            if (testing::Test::HasFatalFailure()) {
                return;
            }
        }
    }
}

/// The default options to the full level of every shape: all levels in terms of the base.
template <typename REAL>
void expectEveryLevel() {
    for (Shape const &shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        ReferenceMatch const match(shape, GetTestLevel(shape, 3, 80000));
        ASSERT_EQ(match.GetError(), "");
        for (ReferenceMask mask : kMasks) {
            SCOPED_TRACE(ToString(mask));
            auto const refiner = CreateRefiner(shape, mask, match.GetMaxLevel());
            ASSERT_NO_FATAL_FAILURE(expectTable<REAL>(
                *refiner, match.InterpolateAll(mask, GetPositions(shape)), Options<REAL>()));
        }
    }
}

std::vector<float> toFloats(ReferenceValues const &values) {
    return std::vector<float>(values.data(), values.data() + values.size());
}

/// Levels 1 and up in one array, as the rows of a table come.
ReferenceValues joinLevels(std::vector<ReferenceValues> const &levels) {
    Eigen::Index numRows = 0;
    for (std::size_t level = 1; level < levels.size(); ++level) {
        numRows += levels[level].rows();
    }
    ReferenceValues joined(numRows, levels[0].cols());
    Eigen::Index first = 0;
    for (std::size_t level = 1; level < levels.size(); ++level) {
        joined.middleRows(first, levels[level].rows()) = levels[level];
        first += levels[level].rows();
    }
    return joined;
}

/// The evaluators add in float: n terms may be off by n roundings, each 2^-24 of the values' size.
void expectNear(float const *actual, Far::StencilTable const &table,
                ReferenceValues const &expected, double size) {
    for (int row = 0; row < table.GetNumStencils(); ++row) {
        double const tolerance = size * std::max(1e-6, std::ldexp(table.GetSizes()[row], -24));
        for (int k = 0; k < 3; ++k) {
            ASSERT_NEAR(actual[3 * row + k], expected(row, k), tolerance) << "stencil " << row;
        }
    }
}

template <typename EVALUATOR>
void expectSeparateBuffers(Far::StencilTable const &table, std::vector<float> const &control,
                           ReferenceValues const &expected, double size) {
    std::unique_ptr<Osd::CpuVertexBuffer> const src(
        Osd::CpuVertexBuffer::Create(3, table.GetNumControlVertices()));
    std::unique_ptr<Osd::CpuVertexBuffer> const dst(
        Osd::CpuVertexBuffer::Create(3, table.GetNumStencils()));
    src->UpdateData(control.data(), 0, table.GetNumControlVertices());
    Osd::BufferDescriptor const desc(0, 3, 3);
    ASSERT_TRUE(EVALUATOR::EvalStencils(src.get(), desc, dst.get(), desc, &table));
    expectNear(dst->BindCpuBuffer(), table, expected, size);
}

template <typename EVALUATOR>
void expectOneBuffer(Far::StencilTable const &table, std::vector<float> const &control,
                     ReferenceValues const &expected, double size) {
    int const numControl = table.GetNumControlVertices();
    std::unique_ptr<Osd::CpuVertexBuffer> const buffer(
        Osd::CpuVertexBuffer::Create(3, numControl + table.GetNumStencils()));
    buffer->UpdateData(control.data(), 0, numControl);
    Osd::BufferDescriptor const srcDesc(0, 3, 3);
    Osd::BufferDescriptor const dstDesc(3 * numControl, 3, 3);
    ASSERT_TRUE(EVALUATOR::EvalStencils(buffer.get(), srcDesc, buffer.get(), dstDesc, &table));
    float const *values = buffer->BindCpuBuffer();
    EXPECT_TRUE(std::equal(control.begin(), control.end(), values));
    expectNear(values + 3 * numControl, table, expected, size);
}

template <typename EVALUATOR>
void expectEvaluatorEqual() {
    for (Shape const &shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        ReferenceMatch const match(shape, std::max(1, GetTestLevel(shape, 3, 40000)));
        ASSERT_EQ(match.GetError(), "");
        ReferenceValues const positions = GetPositions(shape);
        std::vector<float> const control = toFloats(positions);
        double const size = GetSize(positions);
        for (ReferenceMask mask : kMasks) {
            SCOPED_TRACE(ToString(mask));
            auto const refiner = CreateRefiner(shape, mask, match.GetMaxLevel());
            std::unique_ptr<Far::StencilTable const> const table =
                StencilTableFactory::Create(*refiner);
            ASSERT_TRUE(table);
            ReferenceValues const expected = joinLevels(match.InterpolateAll(mask, positions));
            ASSERT_NO_FATAL_FAILURE(
                expectSeparateBuffers<EVALUATOR>(*table, control, expected, size));
            ASSERT_NO_FATAL_FAILURE(expectOneBuffer<EVALUATOR>(*table, control, expected, size));
        }
    }
}

} // namespace

TEST(Stencil, DefaultOptionsAreFars) {
    StencilTableFactory::Options const options;
    Far::StencilTableFactory::Options const farOptions;
    EXPECT_EQ(options.interpolationMode, FarExt::INTERPOLATE_VERTEX);
    EXPECT_EQ(farOptions.interpolationMode, unsigned(Far::StencilTableFactory::INTERPOLATE_VERTEX));
    EXPECT_EQ(options.generateControlVerts, bool(farOptions.generateControlVerts));
    EXPECT_EQ(options.generateIntermediateLevels, bool(farOptions.generateIntermediateLevels));
    EXPECT_EQ(options.factorizeIntermediateLevels, bool(farOptions.factorizeIntermediateLevels));
}

TEST(Stencil, DoubleEveryCombination) { expectEveryCombination<double>(); }

TEST(Stencil, FloatEveryCombination) { expectEveryCombination<float>(); }

TEST(Stencil, DoubleEveryLevel) { expectEveryLevel<double>(); }

TEST(Stencil, FloatEveryLevel) { expectEveryLevel<float>(); }

TEST(Stencil, CpuEvaluator) { expectEvaluatorEqual<Osd::CpuEvaluator>(); }

#ifdef OPENSUBDIV_HAS_OPENMP
TEST(Stencil, OmpEvaluator) { expectEvaluatorEqual<Osd::OmpEvaluator>(); }
#endif

TEST(Stencil, LastLevelNeedsFaceVerticesOnly) {
    Shape const &shape = GetShape("closedAndOpen");
    ReferenceMatch const match(shape, 3);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    ASSERT_TRUE(refiner->RefineUniform(3));
    std::vector<ReferenceValues> const levels =
        match.InterpolateAll(ReferenceMask::Smooth, GetPositions(shape));
    forEachFlags<double>([&](Options<double> const &options) {
        if (options.interpolationMode == FarExt::INTERPOLATE_VERTEX) {
            expectTable<double>(*refiner, levels, options);
        }
    });
}

TEST(Stencil, UnrefinedGivesControlVerticesAlone) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Average, 0);
    Options<float> options;
    EXPECT_EQ(Factory<float>::Create(*refiner, options)->GetNumStencils(), 0);
    options.generateControlVerts = true;
    auto const table = Factory<float>::Create(*refiner, options);
    EXPECT_EQ(table->GetControlIndices(), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(table->GetWeights(), std::vector<float>(8, 1.0f));
}

TEST(Stencil, CubeByHand) {
    // Level 1: an F-vertex is (9 3 1 3)/16 of its face; a V-vertex the average of its own vertex
    // and three of those, so 1/4 + 3 * 9/64 = 43/64, 2 * 3/64 at an edge, 1/64 across a face.
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Average, 1);
    auto const table = Factory<double>::Create(*refiner);
    ASSERT_EQ(table->GetNumStencils(), 32);
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);
    for (int v = 0; v < 8; ++v) {
        auto const stencil = table->GetStencil(v);
        ASSERT_EQ(stencil.GetSize(), 7);
        for (int k = 0; k < 7; ++k) {
            int const index = stencil.GetVertexIndices()[k];
            double const expected = index == v ? 43 : base.FindEdge(v, index) >= 0 ? 6 : 1;
            EXPECT_EQ(stencil.GetWeights()[k], expected / 64);
        }
    }
    for (int f = 0; f < 6; ++f) {
        for (int i = 0; i < 4; ++i) {
            auto const stencil = table->GetStencil(8 + 4 * f + i);
            ASSERT_EQ(stencil.GetSize(), 4);
            for (int k = 0; k < 4; ++k) {
                int const place = base.GetFaceVertices(f).FindIndex(stencil.GetVertexIndices()[k]);
                ASSERT_GE(place, 0);
                double const expected[] = {9, 3, 1, 3};
                EXPECT_EQ(stencil.GetWeights()[k], expected[(place - i + 4) % 4] / 16);
            }
        }
    }
}

TEST(Stencil, FarEvaluatesTheDoubleTable) {
    struct Value {
        double x = 0;
        void Clear() { x = 0; }
        void AddWithWeight(Value const &other, double weight) { x += weight * other.x; }
    };
    Shape const &shape = GetShape("prism5");
    ReferenceMatch const match(shape, 2);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Cosine, 2);
    auto const table = Factory<double>::Create(*refiner);
    ReferenceValues const expected =
        joinLevels(match.InterpolateAll(ReferenceMask::Cosine, GetPositions(shape).leftCols(1)));
    std::vector<Value> src(shape.GetNumVertices());
    for (int v = 0; v < shape.GetNumVertices(); ++v) {
        src[v].x = shape.positions[3 * v];
    }
    std::vector<Value> dst(table->GetNumStencils());
    table->UpdateValues(src, dst);
    for (int i = 0; i < table->GetNumStencils(); ++i) {
        EXPECT_NEAR(dst[i].x, expected(i, 0), 1e-14);
    }
}

TEST(Stencil, RefusesNegativeMaxLevel) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Average, 1);
    Options<float> options;
    options.maxLevel = -1;
    FarExt::CallStatus status;
    EXPECT_FALSE(Factory<float>::Create(*refiner, options, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    EXPECT_NE(status.GetErrorMessage().find("-1"), std::string::npos) << status.GetErrorMessage();
    EXPECT_FALSE(Factory<float>::Create(*refiner, options));
}

} // namespace OpenSubdivHex::Regression::stencilTest

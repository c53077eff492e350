// SPDX-License-Identifier: Apache-2.0
#include "evaluators.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/stencil/stencilKernel.h"
#include "osd_ext/stencilEvaluator.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/stencilTableFactory.h>

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>

namespace OpenSubdivHex::Regression::compactStencilTableTest {

using OsdExt::CompactStencilTable;

namespace {

// The functions of a buffer that an evaluator calls.
struct Buffer {
    float *BindCpuBuffer() { return values.data(); }
    std::vector<float> values;
};

// Stencils in runs that share a list of indices, more of them than a block takes, and empty ones.
class RunTable : public Far::StencilTable {
public:
    RunTable() {
        std::mt19937 random(7);
        auto const below = [&](int n) { return int(random() % unsigned(n)); };
        _numControlVertices = 40;
        for (int run = 0; run < 400; ++run) {
            std::vector<int> list(std::size_t(below(30)));
            for (int &index : list) {
                index = below(_numControlVertices);
            }
            for (int i = below(15); i >= 0; --i) {
                _offsets.push_back(int(_indices.size()));
                _sizes.push_back(int(list.size()));
                _indices.insert(_indices.end(), list.begin(), list.end());
                for (std::size_t j = 0; j < list.size(); ++j) {
                    _weights.push_back(float(below(1000)) / 1000);
                }
            }
        }
    }
};

using Table = std::unique_ptr<Far::StencilTable const>;

Table makeTable(std::string const &shape, int level, bool withControlVertices) {
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(GetShape(shape)));
    EXPECT_TRUE(refiner->RefineUniform(level));
    FarExt::StencilTableFactory::Options options;
    options.generateControlVerts = withControlVertices;
    return FarExt::StencilTableFactory::Create(*refiner, options);
}

// A table of OpenSubdiv's own, without offsets.
Table makeCatmarkTable() {
    auto const refiner = CreateFarRefiner(GetShape("prism5"));
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(3));
    Far::StencilTableFactory::Options options;
    options.generateOffsets = false;
    return Table(Far::StencilTableFactory::Create(*refiner, options));
}

std::vector<Table> makeTables() {
    std::vector<Table> tables;
    tables.push_back(std::make_unique<RunTable>());
    tables.push_back(makeTable("prism5", 3, false));
    tables.push_back(makeTable("mixedPatch", 2, true));
    tables.push_back(makeCatmarkTable());
    return tables;
}

template <class EVALUATOR>
void expectTheSameBits(Far::StencilTable const &table, int length, int gap) {
    auto const compact = CompactStencilTable::Create(table);
    ASSERT_EQ(compact->GetNumStencils(), table.GetNumStencils());
    ASSERT_EQ(compact->GetNumControlVertices(), table.GetNumControlVertices());
    int const stride = length + gap;
    Buffer src;
    src.values.resize(std::size_t(table.GetNumControlVertices()) * std::size_t(stride) + 3);
    for (std::size_t i = 0; i < src.values.size(); ++i) {
        src.values[i] = float(i * 7919 % 1009) / 500 - 0.8f;
    }
    Buffer expected;
    expected.values.assign(std::size_t(table.GetNumStencils()) * std::size_t(stride) + 1, -99.5f);
    Buffer actual = expected;
    Descriptor const srcDesc(3, length, stride);
    Descriptor const dstDesc(1, length, stride);
    ASSERT_TRUE(EVALUATOR::EvalStencils(&src, srcDesc, &expected, dstDesc, &table));
    ASSERT_TRUE(EVALUATOR::EvalStencils(&src, srcDesc, &actual, dstDesc, compact.get()));
    EXPECT_EQ(std::memcmp(expected.values.data(), actual.values.data(),
                          expected.values.size() * sizeof(float)),
              0);
}

} // namespace

TEST(CompactStencilTable, HasTheSameResultsBitForBit) {
    std::vector<Table> const tables = makeTables();
    for (OsdExt::SimdLevel const simdLevel : GetSimdLevels()) {
        for (int const numThreads : {1, 2, 3, 8}) {
            EvaluatorScope const scope(simdLevel, numThreads);
            for (std::size_t i = 0; i < tables.size(); ++i) {
                for (int const length : {1, 2, 3, 4, 5, 6, 8, 11}) {
                    SCOPED_TRACE("table " + std::to_string(i) + " length " +
                                 std::to_string(length));
                    expectTheSameBits<OsdExt::CpuEvaluator>(*tables[i], length, 0);
                    expectTheSameBits<OsdExt::ParallelEvaluator>(*tables[i], length, 2);
                }
            }
        }
    }
}

TEST(CompactStencilTable, SharesTheIndicesOfAFace) {
    // The lists of a cube: six faces of four F-vertices with one list of four indices each, then eight
    // V-vertices, which come first in the table, of seven.
    Table const table = makeTable("cube", 1, false);
    auto const compact = CompactStencilTable::Create(*table);
    EXPECT_EQ(compact->GetNumBlocks(), 8 + 6);
    EXPECT_EQ(compact->GetNumBytes(), 14 * sizeof(OsdExt::internal::StencilBlock) +
                                          (8 * 7 + 6 * 4) * sizeof(int) +
                                          table->GetWeights().size() * sizeof(float));
}

TEST(CompactStencilTable, MayBeEmpty) {
    class EmptyTable : public Far::StencilTable {
    } const table;
    auto const compact = CompactStencilTable::Create(table);
    EXPECT_EQ(compact->GetNumBlocks(), 0);
    Buffer src{{1}};
    Buffer dst{{2}};
    EXPECT_TRUE(OsdExt::CpuEvaluator::EvalStencils(&src, Descriptor(0, 1, 1), &dst,
                                                   Descriptor(0, 1, 1), compact.get()));
    EXPECT_EQ(dst.values[0], 2);
}

TEST(CompactStencilTable, RefusesWhatCannotBeEvaluated) {
    Table const table = makeTable("cube", 1, false);
    auto const compact = CompactStencilTable::Create(*table);
    Buffer src{std::vector<float>(24, 1.0f)};
    Buffer dst{std::vector<float>(96, 0.0f)};
    Descriptor const three(0, 3, 3);
    Buffer *const noBuffer = nullptr;
    CompactStencilTable const *const noTable = nullptr;
    EXPECT_FALSE(
        OsdExt::CpuEvaluator::EvalStencils(&src, three, &dst, Descriptor(0, 2, 3), compact.get()));
    EXPECT_FALSE(OsdExt::CpuEvaluator::EvalStencils(noBuffer, three, &dst, three, compact.get()));
    EXPECT_FALSE(OsdExt::CpuEvaluator::EvalStencils(&src, three, noBuffer, three, compact.get()));
    EXPECT_FALSE(OsdExt::CpuEvaluator::EvalStencils(&src, three, &dst, three, noTable));
    EXPECT_EQ(dst.values, std::vector<float>(96, 0.0f));
}

} // namespace OpenSubdivHex::Regression::compactStencilTableTest

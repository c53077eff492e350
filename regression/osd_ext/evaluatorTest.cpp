// SPDX-License-Identifier: Apache-2.0
//
// What StencilEvaluator promises, of every evaluator here, and where Osd's differ from it.
#include "evaluators.h"
#include "guardedArray.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/ompEvaluator.h"
#include "osd_ext/stencilEvaluation.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>
#include <opensubdiv/osd/mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

namespace OpenSubdivHex::Regression {

using OsdExt::SimdLevel;

namespace {

constexpr int kNumOutputs = 6; ///< value, du, dv, duu, duv, dvv
constexpr float kGuard = -12345.678f;
int const kLengths[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 16};

/// A stencil table as plain arrays, each against memory that may not be touched.
struct TestTable {
    TestTable(std::string tableName, int numControls, std::vector<int> const &stencilSizes,
              std::vector<int> const &controlIndices, std::vector<float> const &valueWeights)
        : name(std::move(tableName)), numSources(numControls), sizes(stencilSizes),
          offsets(makeOffsets(stencilSizes)), indices(controlIndices) {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> any(-1, 1);
        weights.push_back(std::make_unique<GuardedArray<float>>(valueWeights));
        while (weights.size() < kNumOutputs) {
            std::vector<float> derivative(valueWeights.size());
            std::generate(derivative.begin(), derivative.end(), [&] { return any(random); });
            weights.push_back(std::make_unique<GuardedArray<float>>(derivative));
        }
    }

    TestTable(std::string tableName, Far::StencilTable const &table)
        : TestTable(std::move(tableName), table.GetNumControlVertices(), table.GetSizes(),
                    table.GetControlIndices(), table.GetWeights()) {}

    int GetNumStencils() const { return int(sizes.size()); }

    std::string name;
    int numSources;
    GuardedArray<int> sizes;
    GuardedArray<int> offsets;
    GuardedArray<int> indices;
    std::vector<std::unique_ptr<GuardedArray<float>>> weights; ///< by output

private:
    static std::vector<int> makeOffsets(std::vector<int> const &sizes) {
        std::vector<int> offsets;
        int offset = 0;
        for (int const size : sizes) {
            offsets.push_back(offset);
            offset += size;
        }
        return offsets;
    }
};

std::unique_ptr<Far::StencilTable const> makeHexTable(std::string const &shape, int level) {
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(GetShape(shape)));
    EXPECT_TRUE(refiner->RefineUniform(level));
    return FarExt::StencilTableFactory::Create(*refiner);
}

std::unique_ptr<Far::StencilTable const> makeCatmarkTable(std::string const &shape, int level) {
    auto const refiner = CreateFarRefiner(GetShape(shape));
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(level));
    return std::unique_ptr<Far::StencilTable const>(Far::StencilTableFactory::Create(*refiner));
}

/// Stencils of 0 to 40 indices in any order, also of the same one; runs of 1 to 9 stencils share a
/// list of indices, or all of it but the last.
TestTable makeRandomTable(int numStencils) {
    int const numSources = 50;
    std::mt19937 random(3);
    auto const below = [&](int n) { return int(random() % unsigned(n)); };
    std::vector<int> sizes;
    std::vector<int> indices;
    while (int(sizes.size()) < numStencils) {
        std::vector<int> list(std::size_t(below(41)));
        std::generate(list.begin(), list.end(), [&] { return below(numSources); });
        int const numRows = std::min(1 + below(9), numStencils - int(sizes.size()));
        for (int row = 0; row < numRows; ++row) {
            if (!list.empty() && below(8) == 0) {
                list[std::size_t(below(int(list.size())))] = below(numSources);
            }
            sizes.push_back(int(list.size()));
            indices.insert(indices.end(), list.begin(), list.end());
        }
    }
    std::uniform_real_distribution<float> any(-1, 1);
    std::vector<float> weights(indices.size());
    std::generate(weights.begin(), weights.end(), [&] { return any(random); });
    return TestTable("random", numSources, sizes, indices, weights);
}

std::vector<TestTable const *> const &getTables() {
    static TestTable const random = makeRandomTable(600);
    static TestTable const hex("hex", *makeHexTable("prism5", 2));
    static TestTable const hexOpen("hexOpen", *makeHexTable("mixedPatch", 1));
    static TestTable const catmark("catmark", *makeCatmarkTable("prism5", 3));
    static std::vector<TestTable const *> const tables = {&random, &hex, &hexOpen, &catmark};
    return tables;
}

/// Where the elements of a source and a destination lie.
struct Layout {
    Descriptor src;
    Descriptor dst;
    bool isOneBuffer;
    GuardedEnd guardedEnd;
};

std::vector<Layout> makeLayouts(int length, int numSources) {
    int const wide = length + 2;
    return {
        {{0, length, length}, {0, length, length}, false, GuardedEnd::Last},
        {{0, length, length}, {0, length, length}, false, GuardedEnd::First},
        {{5, length, length + 3}, {2, length, length + 1}, false, GuardedEnd::Last},
        {{0, length, length}, {numSources * length, length, length}, true, GuardedEnd::Last},
        {{1, length, wide}, {numSources * wide + 2, length, wide}, true, GuardedEnd::First},
    };
}

/// Floats up to the end of the last element, and no more.
std::size_t getNumFloats(Descriptor const &desc, int numElements) {
    return numElements == 0
               ? std::size_t(desc.offset)
               : std::size_t(desc.offset + (numElements - 1) * desc.stride + desc.length);
}

float sourceValue(int element, int k) {
    return float((element * 7919 + k * 3571) % 1009) / 500 - 0.8f;
}

void fillSources(float *buffer, Descriptor const &desc, int numSources) {
    for (int i = 0; i < numSources; ++i) {
        for (int k = 0; k < desc.length; ++k) {
            buffer[desc.offset + i * desc.stride + k] = sourceValue(i, k);
        }
    }
}

/// In double precision, and by how much a sum of floats may differ.
struct Expected {
    double value = 0;
    double tolerance = 0;
};

Expected getExpected(TestTable const &table, int output, int stencil, int k) {
    Expected result;
    std::size_t const first = std::size_t(table.offsets[std::size_t(stencil)]);
    std::size_t const size = std::size_t(table.sizes[std::size_t(stencil)]);
    for (std::size_t j = first; j < first + size; ++j) {
        double const term =
            double((*table.weights[std::size_t(output)])[j]) * sourceValue(table.indices[j], k);
        result.value += term;
        result.tolerance += std::abs(term) * 3e-6;
    }
    return result;
}

/// Buffers for one evaluation: all outputs lie one behind the other.
class Workspace {
public:
    Workspace(TestTable const &table, Layout const &layout, int numOutputs)
        : _table(table), _layout(layout) {
        int const numStencils = table.GetNumStencils();
        std::size_t const numSrc = getNumFloats(layout.src, table.numSources);
        std::size_t const numDst = getNumFloats(layout.dst, numStencils);
        _numDst = layout.isOneBuffer ? numDst - std::size_t(layout.dst.offset) : numDst;
        std::vector<float> src(numSrc, kGuard);
        fillSources(src.data(), layout.src, table.numSources);
        if (layout.isOneBuffer) {
            src.resize(std::size_t(layout.dst.offset) + std::size_t(numOutputs) * _numDst, kGuard);
        } else {
            _dst = std::make_unique<GuardedArray<float>>(
                std::vector<float>(std::size_t(numOutputs) * numDst, kGuard), layout.guardedEnd);
        }
        _src = std::make_unique<GuardedArray<float>>(src, layout.guardedEnd);
        _before.assign(GetDst(), GetDst() + getDstBuffer().size());
    }

    float *GetSrc() const { return _src->data(); }
    float *GetDst() const { return getDstBuffer().data(); }

    Descriptor GetDstDesc(int output) const {
        Descriptor desc = _layout.dst;
        desc.offset += output * int(_numDst);
        return desc;
    }

    bool Run(EvaluatorFunctions const &functions, int numOutputs, int start, int end,
             bool withOffsets = true) const {
        auto const d = [&](int output) { return GetDstDesc(output); };
        auto const w = [&](std::size_t output) { return _table.weights[output]->data(); };
        float *const dst = GetDst();
        int const *const sizes = _table.sizes.data();
        int const *const offsets = withOffsets ? _table.offsets.data() : nullptr;
        int const *const indices = _table.indices.data();
        switch (numOutputs) {
        case 1:
            return functions.value(GetSrc(), _layout.src, dst, d(0), sizes, offsets, indices, w(0),
                                   start, end);
        case 3:
            return functions.first(GetSrc(), _layout.src, dst, d(0), dst, d(1), dst, d(2), sizes,
                                   offsets, indices, w(0), w(1), w(2), start, end);
        default:
            return functions.second(GetSrc(), _layout.src, dst, d(0), dst, d(1), dst, d(2), dst,
                                    d(3), dst, d(4), dst, d(5), sizes, offsets, indices, w(0), w(1),
                                    w(2), w(3), w(4), w(5), start, end);
        }
    }

    /// Stencils [start, end) are in the elements from \p firstElement on, and nothing else changed.
    void ExpectWritten(int numOutputs, int start, int end, int firstElement) {
        for (int output = 0; output < numOutputs; ++output) {
            Descriptor const desc = GetDstDesc(output);
            for (int i = start; i < end; ++i) {
                for (int k = 0; k < desc.length; ++k) {
                    std::size_t const place =
                        std::size_t(desc.offset + (firstElement + i - start) * desc.stride + k);
                    Expected const expected = getExpected(_table, output, i, k);
                    ASSERT_NEAR(GetDst()[place], expected.value, expected.tolerance)
                        << "output " << output << " stencil " << i << " float " << k;
                    _before[place] = GetDst()[place];
                }
            }
        }
        ASSERT_EQ(std::memcmp(_before.data(), GetDst(), _before.size() * sizeof(float)), 0)
            << "floats beside the elements were written";
    }

private:
    GuardedArray<float> &getDstBuffer() const { return _dst ? *_dst : *_src; }

    TestTable const &_table;
    Layout _layout;
    std::size_t _numDst; ///< floats per output
    std::unique_ptr<GuardedArray<float>> _src;
    std::unique_ptr<GuardedArray<float>> _dst; ///< null: it is _src
    std::vector<float> _before;
};

struct Range {
    int start;
    int end;
};

std::vector<Range> makeRanges(int numStencils) {
    int const third = numStencils / 3;
    return {{0, numStencils},
            {0, 0},
            {third, third},
            {numStencils, numStencils},
            {0, 1},
            {third, third + 1},
            {third, 2 * third},
            {numStencils - 1, numStencils}};
}

/// Calls check(layout, range) for each combination, with its description as scope.
template <class CHECK>
void forEachLayoutAndRange(TestTable const &table, CHECK const &check) {
    for (int const length : kLengths) {
        std::vector<Layout> const layouts = makeLayouts(length, table.numSources);
        for (std::size_t i = 0; i < layouts.size(); ++i) {
            for (Range const range : makeRanges(table.GetNumStencils())) {
                SCOPED_TRACE(table.name + " length " + std::to_string(length) + " layout " +
                             std::to_string(i) + " range " + std::to_string(range.start) + " " +
                             std::to_string(range.end));
                ASSERT_NO_FATAL_FAILURE(check(layouts[i], range));
            }
        }
    }
}

TEST(Evaluator, WritesEachStencilToItsElement) {
    for (TestTable const *table : getTables()) {
        for (Evaluator const &evaluator : GetOwnEvaluators()) {
            SCOPED_TRACE(evaluator.name);
            EvaluatorScope const scope(evaluator);
            ASSERT_NO_FATAL_FAILURE(
                forEachLayoutAndRange(*table, [&](Layout const &layout, Range range) {
                    Workspace workspace(*table, layout, 1);
                    ASSERT_TRUE(workspace.Run(evaluator.functions, 1, range.start, range.end));
                    workspace.ExpectWritten(1, range.start, range.end, range.start);
                }));
        }
    }
}

TEST(Evaluator, WritesDerivatives) {
    TestTable const &table = *getTables()[0];
    for (Evaluator const &evaluator : GetOwnEvaluators()) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        for (int const numOutputs : {3, 6}) {
            ASSERT_NO_FATAL_FAILURE(forEachLayoutAndRange(table, [&](Layout const &layout,
                                                                     Range range) {
                Workspace workspace(table, layout, numOutputs);
                ASSERT_TRUE(workspace.Run(evaluator.functions, numOutputs, range.start, range.end));
                workspace.ExpectWritten(numOutputs, range.start, range.end, range.start);
            }));
        }
    }
}

TEST(Evaluator, NeedsNoOffsets) {
    TestTable const &table = *getTables()[0];
    for (Evaluator const &evaluator : GetOwnEvaluators()) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        ASSERT_NO_FATAL_FAILURE(
            forEachLayoutAndRange(table, [&](Layout const &layout, Range range) {
                Workspace workspace(table, layout, 1);
                ASSERT_TRUE(workspace.Run(evaluator.functions, 1, range.start, range.end, false));
                workspace.ExpectWritten(1, range.start, range.end, range.start);
            }));
    }
}

/// The lists of the stencils lie from last to first, with an unused entry after each.
TEST(Evaluator, FollowsOffsets) {
    int const numStencils = 20;
    std::vector<int> sizes;
    std::vector<int> offsets(std::size_t(numStencils), 0);
    std::vector<int> indices;
    for (int i = 0; i < numStencils; ++i) {
        sizes.push_back(1 + i % 7);
    }
    for (int i = numStencils - 1; i >= 0; --i) {
        offsets[std::size_t(i)] = int(indices.size());
        indices.insert(indices.end(), std::size_t(sizes[std::size_t(i)]), i);
        indices.push_back(0);
    }
    std::vector<float> const weights(indices.size(), 1);
    for (Evaluator const &evaluator : GetOwnEvaluators()) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        for (int const length : kLengths) {
            Descriptor const desc(0, length, length);
            std::vector<float> src(std::size_t(numStencils * length));
            for (int i = 0; i < numStencils; ++i) {
                std::fill_n(src.begin() + i * length, length, float(100 + i));
            }
            std::vector<float> dst(src.size(), kGuard);
            ASSERT_TRUE(evaluator.functions.value(src.data(), desc, dst.data(), desc, sizes.data(),
                                                  offsets.data(), indices.data(), weights.data(), 0,
                                                  numStencils));
            for (int i = 0; i < numStencils; ++i) {
                for (int k = 0; k < length; ++k) {
                    ASSERT_EQ(dst[std::size_t(i * length + k)],
                              float(sizes[std::size_t(i)] * (100 + i)))
                        << "length " << length << " stencil " << i;
                }
            }
        }
    }
}

/// The same bits as CpuEvaluator's of all stencils at once.
void expectSameBits(TestTable const &table, EvaluatorFunctions const &functions, int numOutputs,
                    int stencilsPerCall, Layout const &layout, bool withOffsets) {
    int const numStencils = table.GetNumStencils();
    int const length = layout.src.length;
    Layout const packed = makeLayouts(length, table.numSources)[0];
    Workspace const expected(table, packed, 1);
    ASSERT_TRUE(expected.Run(EvaluatorFunctions::Of<OsdExt::CpuEvaluator>(), 1, 0, numStencils));
    Workspace const actual(table, layout, numOutputs);
    for (int start = 0; start < numStencils; start += stencilsPerCall) {
        int const end = std::min(start + stencilsPerCall, numStencils);
        ASSERT_TRUE(actual.Run(functions, numOutputs, start, end, withOffsets));
    }
    for (int i = 0; i < numStencils; ++i) {
        ASSERT_EQ(std::memcmp(expected.GetDst() + i * length,
                              actual.GetDst() + layout.dst.offset + i * layout.dst.stride,
                              std::size_t(length) * sizeof(float)),
                  0)
            << "stencil " << i;
    }
}

TEST(Evaluator, BitsDependOnSimdLevelAlone) {
    TestTable const random = makeRandomTable(1500);
    TestTable const hex("hex", *makeHexTable("torus", 3));
    for (TestTable const *table : {&random, &hex}) {
        int const numStencils = table->GetNumStencils();
        ASSERT_GT(numStencils, 1000);
        for (SimdLevel const level : GetSimdLevels()) {
            for (int const length : kLengths) {
                SCOPED_TRACE(table->name + " level " + std::to_string(int(level)) + " length " +
                             std::to_string(length));
                std::vector<Layout> const layouts = makeLayouts(length, table->numSources);
                for (int const numThreads : {1, 2, 3, 8}) {
                    EvaluatorScope const scope(level, numThreads);
                    for (int const stencilsPerCall : {numStencils, numStencils * 2 / 3}) {
                        for (bool const withOffsets : {true, false}) {
                            ASSERT_NO_FATAL_FAILURE(expectSameBits(
                                *table, EvaluatorFunctions::Of<OsdExt::OmpEvaluator>(), 1,
                                stencilsPerCall, layouts[0], withOffsets));
                        }
                    }
                }
                EvaluatorScope const scope(level, 1);
                EvaluatorFunctions const cpu = EvaluatorFunctions::Of<OsdExt::CpuEvaluator>();
                for (Layout const &layout : layouts) {
                    ASSERT_NO_FATAL_FAILURE(
                        expectSameBits(*table, cpu, 1, numStencils, layout, true));
                }
                for (int const stencilsPerCall : {1, 4, 5}) {
                    ASSERT_NO_FATAL_FAILURE(
                        expectSameBits(*table, cpu, 1, stencilsPerCall, layouts[0], true));
                }
                ASSERT_NO_FATAL_FAILURE(
                    expectSameBits(*table, cpu, 3, numStencils, layouts[0], true));
                ASSERT_NO_FATAL_FAILURE(
                    expectSameBits(*table, cpu, 6, numStencils, layouts[0], true));
            }
        }
    }
}

/// Stencils of each size that add element \c place, which is infinite, once: not 0 times infinity
/// anywhere, and not beside them.
TEST(Evaluator, InfinityStaysWhereItIsUsed) {
    int const maxSize = 13;
    std::vector<int> sizes;
    std::vector<int> indices;
    std::vector<bool> isInfinite;
    for (int size = 1; size <= maxSize; ++size) {
        for (int place = 0; place <= size; ++place) {
            sizes.push_back(size);
            isInfinite.push_back(place < size);
            for (int i = 0; i < size; ++i) {
                indices.push_back(i == place ? 1 : 0);
            }
        }
    }
    std::vector<float> const weights(indices.size(), 1);
    int const numStencils = int(sizes.size());
    for (SimdLevel const level : GetSimdLevels()) {
        EvaluatorScope const scope(level, 1);
        for (int const length : kLengths) {
            std::vector<float> src(std::size_t(2 * length), 1);
            std::fill_n(src.begin() + length, length, std::numeric_limits<float>::infinity());
            std::vector<float> dst(std::size_t(numStencils * length), kGuard);
            Descriptor const desc(0, length, length);
            ASSERT_TRUE(OsdExt::CpuEvaluator::EvalStencils(src.data(), desc, dst.data(), desc,
                                                           sizes.data(), nullptr, indices.data(),
                                                           weights.data(), 0, numStencils));
            for (int i = 0; i < numStencils; ++i) {
                float const expected =
                    isInfinite[std::size_t(i)] ? src.back() : float(sizes[std::size_t(i)]);
                for (int k = 0; k < length; ++k) {
                    ASSERT_EQ(dst[std::size_t(i * length + k)], expected)
                        << "level " << int(level) << " length " << length << " stencil " << i;
                }
            }
        }
    }
}

/// Stencil i reads the results of stencils i - 1 and i - 2: Fibonacci's numbers.
TEST(Evaluator, CpuStencilsMayReadThoseBeforeThem) {
    int const numStencils = 30;
    std::vector<int> const sizes(std::size_t(numStencils), 2);
    std::vector<int> indices;
    for (int i = 0; i < numStencils; ++i) {
        indices.push_back(i);
        indices.push_back(i + 1);
    }
    std::vector<float> const weights(indices.size(), 1);
    for (SimdLevel const level : GetSimdLevels()) {
        EvaluatorScope const scope(level, 1);
        for (int const length : kLengths) {
            std::vector<float> buffer(std::size_t((2 + numStencils) * length));
            std::fill_n(buffer.begin(), 2 * length, 1.0f);
            Descriptor const src(0, length, length);
            Descriptor const dst(2 * length, length, length);
            ASSERT_TRUE(OsdExt::CpuEvaluator::EvalStencils(buffer.data(), src, buffer.data(), dst,
                                                           sizes.data(), nullptr, indices.data(),
                                                           weights.data(), 0, numStencils));
            for (int k = 0; k < length; ++k) {
                ASSERT_EQ(buffer[std::size_t(31 * length + k)], 2178309) << length;
            }
        }
    }
}

TEST(Evaluator, RefusesWithoutWriting) {
    TestTable const &table = *getTables()[1];
    int const n = table.GetNumStencils();
    Layout const layout = makeLayouts(3, table.numSources)[0];
    Descriptor const good = layout.src;
    struct Case {
        char const *name;
        Descriptor src;
        Descriptor dst;
        int start;
        int end;
        bool result;
    };
    Case const cases[] = {
        {"lengths differ", good, {0, 2, 3}, 0, n, false},
        {"lengths differ in an empty range", good, {0, 2, 3}, 0, 0, false},
        {"length 0", {0, 0, 3}, {0, 0, 3}, 0, n, false},
        {"negative length", {0, -1, 3}, {0, -1, 3}, 0, n, false},
        {"source stride", {0, 3, 2}, good, 0, n, false},
        {"destination stride", good, {0, 3, 2}, 0, n, false},
        {"negative source offset", {-1, 3, 3}, good, 0, n, false},
        {"negative destination offset", good, {-1, 3, 3}, 0, n, false},
        {"negative start", good, good, -1, n, false},
        {"empty", good, good, 7, 7, true},
        {"end before start", good, good, 7, 5, true},
        {"empty before 0", good, good, -5, -5, true},
    };
    for (Evaluator const &evaluator : GetOwnEvaluators()) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        EvaluatorFunctions const &functions = evaluator.functions;
        Workspace workspace(table, layout, 6);
        float *const src = workspace.GetSrc();
        float *const dst = workspace.GetDst();
        int const *const sizes = table.sizes.data();
        int const *const offsets = table.offsets.data();
        int const *const indices = table.indices.data();
        float const *const w = table.weights[0]->data();
        for (Case const &c : cases) {
            SCOPED_TRACE(c.name);
            EXPECT_EQ(
                functions.value(src, c.src, dst, c.dst, sizes, offsets, indices, w, c.start, c.end),
                c.result);
            // Of several outputs the last counts as well as the first.
            EXPECT_EQ(functions.first(src, c.src, dst, c.src, dst, c.src, dst, c.dst, sizes,
                                      offsets, indices, w, w, w, c.start, c.end),
                      c.result);
            EXPECT_EQ(functions.second(src, c.src, dst, c.src, dst, c.src, dst, c.src, dst, c.src,
                                       dst, c.src, dst, c.dst, sizes, offsets, indices, w, w, w, w,
                                       w, w, c.start, c.end),
                      c.result);
        }
        EXPECT_FALSE(functions.value(nullptr, good, dst, good, sizes, offsets, indices, w, 0, n));
        EXPECT_FALSE(functions.value(src, good, nullptr, good, sizes, offsets, indices, w, 0, n));
        EXPECT_FALSE(functions.value(src, good, dst, good, nullptr, offsets, indices, w, 0, n));
        EXPECT_FALSE(functions.value(src, good, dst, good, sizes, offsets, indices, nullptr, 0, n));
        EXPECT_FALSE(functions.first(src, good, dst, good, dst, good, dst, good, sizes, offsets,
                                     indices, w, w, nullptr, 0, n));
        EXPECT_TRUE(functions.value(nullptr, good, nullptr, good, nullptr, nullptr, nullptr,
                                    nullptr, 0, 0));
        workspace.ExpectWritten(6, 0, 0, 0);
    }
}

TEST(Evaluator, EmptyStencilsAreZero) {
    int const sizes[] = {0, 0, 0};
    for (Evaluator const &evaluator : GetOwnEvaluators()) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        for (int const length : kLengths) {
            Descriptor const desc(0, length, length);
            std::vector<float> const src(std::size_t(length), 1);
            std::vector<float> dst(std::size_t(3 * length), kGuard);
            ASSERT_TRUE(evaluator.functions.value(src.data(), desc, dst.data(), desc, sizes,
                                                  nullptr, nullptr, nullptr, 0, 3));
            ASSERT_EQ(dst, std::vector<float>(dst.size(), 0)) << length;
        }
    }
}

#if defined(__linux__)
/// Element 3 is 12 GiB behind element 0 of source and destination; only touched pages are taken.
TEST(Evaluator, AddressesIn64Bits) {
    int const stride = 1 << 30;
    std::size_t const numBytes = (std::size_t(3) * stride + 8) * sizeof(float);
    void *const memory = mmap(nullptr, 2 * numBytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) {
        GTEST_SKIP() << "no address space";
    }
    float *const src = static_cast<float *>(memory);
    float *const dst = src + numBytes / sizeof(float);
    int const sizes[] = {1, 1, 1, 2};
    int const offsets[] = {0, 1, 2, 3};
    int const indices[] = {0, 1, 2, 3, 0};
    float const weights[] = {1, 1, 1, 1, 1};
    for (Evaluator const &evaluator : GetOwnEvaluators()) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        for (int const length : {1, 3, 4, 8}) {
            for (int k = 0; k < length; ++k) {
                src[k] = float(k);
                src[std::size_t(3) * stride + std::size_t(k)] = float(10 * k);
                dst[std::size_t(3) * stride + std::size_t(k)] = kGuard;
            }
            Descriptor const desc(0, length, stride);
            ASSERT_TRUE(evaluator.functions.value(src, desc, dst, desc, sizes, offsets, indices,
                                                  weights, 0, 4));
            for (int k = 0; k < length; ++k) {
                ASSERT_EQ(dst[std::size_t(3) * stride + std::size_t(k)], float(11 * k));
            }
        }
    }
    munmap(memory, 2 * numBytes);
}
#endif

TEST(SimdLevel, NumbersThatAreNoLevelAreRefused) {
    using OsdExt::SimdLevel;
    SimdLevel const before = OsdExt::GetSimdLevel();
    for (int number : {-1, 77, int(OsdExt::GetMaxSimdLevel()) + 1}) {
        EXPECT_FALSE(OsdExt::SetSimdLevel(SimdLevel(number))) << number;
        EXPECT_EQ(OsdExt::GetSimdLevel(), before);
        OsdExt::SetSimdLevel(before);
    }
}

TEST(SimdLevel, CanBeForced) {
    SimdLevel const before = OsdExt::GetSimdLevel();
    EXPECT_EQ(before, OsdExt::GetMaxSimdLevel());
    for (SimdLevel const level : GetSimdLevels()) {
        EXPECT_TRUE(OsdExt::SetSimdLevel(level));
        EXPECT_EQ(OsdExt::GetSimdLevel(), level);
    }
    if (OsdExt::GetMaxSimdLevel() != SimdLevel::Avx512) {
        EXPECT_FALSE(OsdExt::SetSimdLevel(SimdLevel::Avx512));
        EXPECT_EQ(OsdExt::GetSimdLevel(), OsdExt::GetMaxSimdLevel());
    }
    EXPECT_TRUE(OsdExt::SetSimdLevel(before));
}

// --- The functions that take buffers and tables ---

using Buffer = std::unique_ptr<Osd::CpuVertexBuffer>;

Buffer makeBuffer(int numElements, int numVertices) {
    Buffer buffer(Osd::CpuVertexBuffer::Create(numElements, numVertices));
    std::fill_n(buffer->BindCpuBuffer(), numElements * numVertices, kGuard);
    return buffer;
}

Buffer makeSource(int numVertices) {
    Buffer buffer = makeBuffer(3, numVertices);
    fillSources(buffer->BindCpuBuffer(), Descriptor(0, 3, 3), numVertices);
    return buffer;
}

void expectSameValues(Buffer const &actual, Buffer const &expected) {
    ASSERT_EQ(actual->GetNumVertices(), expected->GetNumVertices());
    for (int i = 0; i < 3 * actual->GetNumVertices(); ++i) {
        float const value = expected->BindCpuBuffer()[i];
        ASSERT_NEAR(actual->BindCpuBuffer()[i], value, 1e-5 * (1 + std::abs(value))) << i;
    }
}

struct TableWithoutOffsets : Far::StencilTable {
    explicit TableWithoutOffsets(Far::StencilTable const &table)
        : Far::StencilTable(table.GetNumControlVertices()) {
        _sizes = table.GetSizes();
        _indices = table.GetControlIndices();
        _weights = table.GetWeights();
    }
};

template <class EVALUATOR>
class EvaluatorOfTables : public testing::Test {};
using EvaluatorTypes = testing::Types<OsdExt::CpuEvaluator, OsdExt::OmpEvaluator>;
TYPED_TEST_SUITE(EvaluatorOfTables, EvaluatorTypes, );

TYPED_TEST(EvaluatorOfTables, TakesTablesOfEitherLibrary) {
    auto const hex = makeHexTable("prism5", 3);
    auto const catmark = makeCatmarkTable("prism5", 4);
    TableWithoutOffsets const withoutOffsets(*catmark);
    struct Case {
        Far::StencilTable const *table;
        Far::StencilTable const *equalTable; ///< that Osd takes
    };
    for (auto const &[table, equalTable] :
         {Case{hex.get(), hex.get()}, Case{catmark.get(), catmark.get()},
          Case{&withoutOffsets, catmark.get()}}) {
        Buffer const src = makeSource(table->GetNumControlVertices());
        Buffer const expected = makeBuffer(3, table->GetNumStencils());
        Buffer const actual = makeBuffer(3, table->GetNumStencils());
        ASSERT_TRUE(
            OsdExt::EvalStencils<Osd::CpuEvaluator>(*equalTable, src.get(), expected.get()));
        ASSERT_TRUE(OsdExt::EvalStencils<TypeParam>(*table, src.get(), actual.get()));
        ASSERT_NO_FATAL_FAILURE(expectSameValues(actual, expected));

        auto const inPlace = OsdExt::CreateInPlaceBuffer<Osd::CpuVertexBuffer>(*table, 3);
        inPlace->UpdateData(src->BindCpuBuffer(), 0, table->GetNumControlVertices());
        ASSERT_TRUE(OsdExt::EvalStencilsInPlace<TypeParam>(*table, inPlace.get()));
        EXPECT_TRUE(std::equal(actual->BindCpuBuffer(),
                               actual->BindCpuBuffer() + 3 * table->GetNumStencils(),
                               inPlace->BindCpuBuffer() + 3 * table->GetNumControlVertices()));
    }
}

TYPED_TEST(EvaluatorOfTables, TakesInstanceAndContext) {
    auto const table = makeHexTable("cube", 1);
    Buffer const src = makeSource(8);
    Buffer const dst = makeBuffer(3, table->GetNumStencils());
    Descriptor const desc(0, 3, 3);
    TypeParam const instance;
    int context = 0;
    EXPECT_TRUE(TypeParam::EvalStencils(src.get(), desc, dst.get(), desc, table.get(), &instance,
                                        &context));
    TypeParam::Synchronize(&context);
    EXPECT_NE(dst->BindCpuBuffer()[0], kGuard);
}

TYPED_TEST(EvaluatorOfTables, TakesEmptyAndRefusesNull) {
    struct EmptyTable : Far::StencilTable {
        EmptyTable() : Far::StencilTable(0) {}
    } const empty;
    Buffer const src = makeSource(1);
    Buffer const dst = makeBuffer(3, 1);
    Descriptor const desc(0, 3, 3);
    EXPECT_TRUE(TypeParam::EvalStencils(src.get(), desc, dst.get(), desc, &empty));
    EXPECT_FALSE(TypeParam::EvalStencils(src.get(), desc, dst.get(), Descriptor(0, 2, 3), &empty));
    EXPECT_EQ(dst->BindCpuBuffer()[0], kGuard);
    // As Osd does not.
    EXPECT_FALSE(Osd::CpuEvaluator::EvalStencils(src.get(), desc, dst.get(), desc, &empty));

    auto const table = makeHexTable("cube", 1);
    Osd::CpuVertexBuffer *const noBuffer = nullptr;
    EXPECT_FALSE(TypeParam::EvalStencils(noBuffer, desc, dst.get(), desc, table.get()));
    EXPECT_FALSE(TypeParam::EvalStencils(src.get(), desc, noBuffer, desc, table.get()));
    Far::StencilTable const *const noTable = nullptr;
    EXPECT_FALSE(TypeParam::EvalStencils(src.get(), desc, dst.get(), desc, noTable));
}

std::unique_ptr<Far::LimitStencilTable const> makeLimitTable(bool first, bool second) {
    auto const refiner = CreateFarRefiner(GetShape("torus"));
    refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(3));
    std::vector<float> const s = {0.0f, 0.25f, 0.5f, 0.8f, 1.0f};
    std::vector<float> const t = {0.1f, 0.9f, 0.5f, 0.0f, 0.3f};
    Far::LimitStencilTableFactory::LocationArrayVec locations;
    int const numFaces = Far::PtexIndices(*refiner).GetNumFaces();
    for (int face = 0; face < numFaces; ++face) {
        Far::LimitStencilTableFactory::LocationArray array;
        array.ptexIdx = face;
        array.numLocations = int(s.size());
        array.s = s.data();
        array.t = t.data();
        locations.push_back(array);
    }
    Far::LimitStencilTableFactory::Options options;
    options.generate1stDerivatives = first;
    options.generate2ndDerivatives = second;
    return std::unique_ptr<Far::LimitStencilTable const>(
        Far::LimitStencilTableFactory::Create(*refiner, locations, nullptr, nullptr, options));
}

TYPED_TEST(EvaluatorOfTables, TakesLimitStencilTables) {
    auto const table = makeLimitTable(true, true);
    ASSERT_TRUE(table);
    Buffer const src = makeSource(table->GetNumControlVertices());
    std::vector<Buffer> expected;
    std::vector<Buffer> first;
    std::vector<Buffer> second;
    for (int i = 0; i < kNumOutputs; ++i) {
        expected.push_back(makeBuffer(3, table->GetNumStencils()));
        first.push_back(makeBuffer(3, table->GetNumStencils()));
        second.push_back(makeBuffer(3, table->GetNumStencils()));
    }
    Descriptor const d(0, 3, 3);
    ASSERT_TRUE(Osd::CpuEvaluator::EvalStencils(
        src.get(), d, expected[0].get(), d, expected[1].get(), d, expected[2].get(), d,
        expected[3].get(), d, expected[4].get(), d, expected[5].get(), d, table.get()));
    ASSERT_TRUE(TypeParam::EvalStencils(src.get(), d, first[0].get(), d, first[1].get(), d,
                                        first[2].get(), d, table.get()));
    ASSERT_TRUE(TypeParam::EvalStencils(src.get(), d, second[0].get(), d, second[1].get(), d,
                                        second[2].get(), d, second[3].get(), d, second[4].get(), d,
                                        second[5].get(), d, table.get()));
    for (std::size_t i = 0; i < kNumOutputs; ++i) {
        SCOPED_TRACE(i);
        ASSERT_NO_FATAL_FAILURE(expectSameValues(second[i], expected[i]));
        if (i < 3) {
            ASSERT_NO_FATAL_FAILURE(expectSameValues(first[i], expected[i]));
        }
    }
}

TYPED_TEST(EvaluatorOfTables, RefusesDerivativesThatTheTableHasNot) {
    Descriptor const d(0, 3, 3);
    for (bool const hasFirst : {false, true}) {
        auto const table = makeLimitTable(hasFirst, false);
        Buffer const src = makeSource(table->GetNumControlVertices());
        Buffer const dst = makeBuffer(3, table->GetNumStencils());
        if (!hasFirst) {
            EXPECT_FALSE(TypeParam::EvalStencils(src.get(), d, dst.get(), d, dst.get(), d,
                                                 dst.get(), d, table.get()));
        }
        EXPECT_FALSE(TypeParam::EvalStencils(src.get(), d, dst.get(), d, dst.get(), d, dst.get(), d,
                                             dst.get(), d, dst.get(), d, dst.get(), d,
                                             table.get()));
        EXPECT_EQ(dst->BindCpuBuffer()[0], kGuard);
        EXPECT_TRUE(TypeParam::EvalStencils(src.get(), d, dst.get(), d, table.get()));
    }
}

/// What Osd::Mesh wants of a vertex buffer, beside Osd::CpuVertexBuffer's.
struct MeshBuffer : Osd::CpuVertexBuffer {
    static MeshBuffer *Create(int numElements, int numVertices, void * /*context*/ = nullptr) {
        auto buffer = std::make_unique<MeshBuffer>(numElements, numVertices);
        buffer->values.resize(std::size_t(numElements) * std::size_t(numVertices));
        return buffer.release();
    }
    MeshBuffer(int numElements, int numVertices)
        : Osd::CpuVertexBuffer(numElements, numVertices), width(numElements) {}
    void UpdateData(float const *src, int start, int count, void * /*context*/) {
        std::copy_n(src, count * width, values.begin() + start * width);
    }
    float *BindCpuBuffer() { return values.data(); }
    float *BindVBO(void * /*context*/) { return BindCpuBuffer(); }

    int width;
    std::vector<float> values;
};

struct MeshPatchTable {
    using VertexBufferBinding = float *;
    static MeshPatchTable *Create(Far::PatchTable const * /*table*/, void * /*context*/) {
        return new MeshPatchTable;
    }
};

template <class EVALUATOR>
std::vector<float> refineMesh() {
    Shape const &shape = GetShape("torus");
    using Mesh = Osd::Mesh<MeshBuffer, Far::StencilTable, EVALUATOR, MeshPatchTable>;
    Osd::MeshBitset bits;
    bits.set(Osd::MeshInterleaveVarying);
    Mesh mesh(CreateFarRefiner(shape).release(), 3, 2, 2, bits);
    std::vector<float> controls(std::size_t(5 * shape.GetNumVertices()));
    fillSources(controls.data(), Descriptor(0, 5, 5), shape.GetNumVertices());
    mesh.UpdateVertexBuffer(controls.data(), 0, shape.GetNumVertices());
    mesh.Refine();
    mesh.Synchronize();
    return mesh.GetVertexBuffer()->values;
}

TYPED_TEST(EvaluatorOfTables, ServesOsdMesh) {
    std::vector<float> const expected = refineMesh<Osd::CpuEvaluator>();
    std::vector<float> const actual = refineMesh<TypeParam>();
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
        ASSERT_NEAR(actual[i], expected[i], 1e-5) << i;
    }
}

// --- Osd's evaluators: these tests say what OpenSubdiv does, right or wrong, so that a version
// that does otherwise is noticed ---

bool isOsdCpuFastPath(Evaluator const &evaluator, Layout const &layout) {
    int const length = layout.src.length;
    return evaluator.name == "Osd::CpuEvaluator" && (length == 4 || length == 8) &&
           layout.src.stride == length && layout.dst.stride == length;
}

TEST(OsdEvaluator, WritesRangesToTheFirstElements) {
    for (TestTable const *table : getTables()) {
        for (Evaluator const &evaluator : GetOsdEvaluators()) {
            SCOPED_TRACE(evaluator.name);
            EvaluatorScope const scope(evaluator);
            ASSERT_NO_FATAL_FAILURE(
                forEachLayoutAndRange(*table, [&](Layout const &layout, Range range) {
                    if (range.start > 0 && isOsdCpuFastPath(evaluator, layout)) {
                        return; // see WritesRangesOfFourWithOtherSizes
                    }
                    Workspace workspace(*table, layout, 1);
                    ASSERT_TRUE(workspace.Run(evaluator.functions, 1, range.start, range.end));
                    workspace.ExpectWritten(1, range.start, range.end, 0);
                }));
        }
    }
}

/// Stencil i goes to element i, as it should, but with the size of stencil start + i.
TEST(OsdEvaluator, WritesRangesOfFourWithOtherSizes) {
    std::vector<int> const sizes = {1, 1, 3, 1, 2, 1};
    std::vector<int> const offsets = {0, 1, 2, 5, 6, 8};
    std::vector<int> const indices = {0, 0, 0, 1, 2, 0, 0, 1, 0};
    std::vector<float> const weights(indices.size(), 1);
    for (int const length : {4, 8}) {
        Descriptor const desc(0, length, length);
        std::vector<float> src;
        for (int i = 0; i < 3; ++i) {
            src.insert(src.end(), std::size_t(length), std::pow(10.0f, float(i)));
        }
        std::vector<float> dst(std::size_t(6 * length), kGuard);
        std::vector<float> ownDst = dst;
        auto const at = [&](std::vector<float> const &values, int i) {
            return values[std::size_t(i * length)];
        };
        ASSERT_TRUE(Osd::CpuEvaluator::EvalStencils(src.data(), desc, dst.data(), desc,
                                                    sizes.data(), offsets.data(), indices.data(),
                                                    weights.data(), 2, 4));
        EXPECT_EQ(at(dst, 2), 11) << "two terms in place of three";
        EXPECT_EQ(at(dst, 3), 100) << "its one term is the third of stencil 2";
        ASSERT_TRUE(OsdExt::CpuEvaluator::EvalStencils(src.data(), desc, ownDst.data(), desc,
                                                       sizes.data(), offsets.data(), indices.data(),
                                                       weights.data(), 2, 4));
        EXPECT_EQ(at(ownDst, 2), 111);
        EXPECT_EQ(at(ownDst, 3), 1);
    }
}

TEST(OsdEvaluator, WritesDerivatives) {
    TestTable const &table = *getTables()[0];
    for (Evaluator const &evaluator : GetOsdEvaluators()) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        for (int const numOutputs : {3, 6}) {
            ASSERT_NO_FATAL_FAILURE(forEachLayoutAndRange(table, [&](Layout const &layout,
                                                                     Range range) {
                Workspace workspace(table, layout, numOutputs);
                ASSERT_TRUE(workspace.Run(evaluator.functions, numOutputs, range.start, range.end));
                workspace.ExpectWritten(numOutputs, range.start, range.end, 0);
            }));
        }
    }
}

} // namespace
} // namespace OpenSubdivHex::Regression

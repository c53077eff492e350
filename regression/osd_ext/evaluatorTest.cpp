// SPDX-License-Identifier: Apache-2.0
//
// Promises of StencilEvaluator, tested on every evaluator here.
#include "evaluatorWorkspace.h"

#include "osd_ext/cpuEvaluator.h"

#include <limits>

namespace OpenSubdivHex::Regression::evaluatorTest {

using OsdExt::SimdLevel;

namespace {

TEST(Evaluator, WritesEachStencilToItsElement) {
    for (TestTable const *table : GetTestTables()) {
        for (Evaluator const &evaluator : GetOwnEvaluators()) {
            SCOPED_TRACE(evaluator.name);
            EvaluatorScope const scope(evaluator);
            ASSERT_NO_FATAL_FAILURE(
                ForEachLayoutAndRange(*table, [&](Layout const &layout, Range range) {
                    Workspace workspace(*table, layout, 1);
                    ASSERT_TRUE(workspace.Run(evaluator.functions, 1, range.start, range.end));
                    workspace.ExpectWritten(1, range.start, range.end, range.start);
                }));
        }
    }
}

TEST(Evaluator, WritesDerivatives) {
    ASSERT_NO_FATAL_FAILURE(ExpectDerivativesWritten(GetOwnEvaluators(), false));
}

TEST(Evaluator, NeedsNoOffsets) {
    TestTable const &table = *GetTestTables()[0];
    for (Evaluator const &evaluator : GetOwnEvaluators()) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        ASSERT_NO_FATAL_FAILURE(
            ForEachLayoutAndRange(table, [&](Layout const &layout, Range range) {
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

/// Expects the bits of CpuEvaluator, which evaluates all stencils at once.
void expectSameBits(TestTable const &table, EvaluatorFunctions const &functions, int numOutputs,
                    int stencilsPerCall, Layout const &layout, bool withOffsets) {
    int const numStencils = table.GetNumStencils();
    int const length = layout.src.length;
    Layout const packed = MakeLayouts(length, table.numSources)[0];
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
    TestTable const random = MakeRandomTable(1500);
    TestTable const hex("hex", *MakeHexTable("torus", 3));
    for (TestTable const *table : {&random, &hex}) {
        int const numStencils = table->GetNumStencils();
        ASSERT_GT(numStencils, 1000);
        for (SimdLevel const level : GetSimdLevels()) {
            for (int const length : kLengths) {
                SCOPED_TRACE(table->name + " level " + std::to_string(int(level)) + " length " +
                             std::to_string(length));
                std::vector<Layout> const layouts = MakeLayouts(length, table->numSources);
                for (int const numThreads : {1, 2, 3, 8}) {
                    EvaluatorScope const scope(level, numThreads);
                    for (int const stencilsPerCall : {numStencils, numStencils * 2 / 3}) {
                        for (bool const withOffsets : {true, false}) {
                            ASSERT_NO_FATAL_FAILURE(expectSameBits(
                                *table, EvaluatorFunctions::Of<OsdExt::ParallelEvaluator>(), 1,
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
    TestTable const &table = *GetTestTables()[1];
    int const n = table.GetNumStencils();
    Layout const layout = MakeLayouts(3, table.numSources)[0];
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
            // The last output counts as well as the first.
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

} // namespace
} // namespace OpenSubdivHex::Regression::evaluatorTest

// SPDX-License-Identifier: Apache-2.0
//
// Where Osd's own evaluators differ from the evaluators here, right or wrong, so that a version
// that does otherwise is noticed.
#include "evaluatorWorkspace.h"

#include "osd_ext/cpuEvaluator.h"

#include <opensubdiv/osd/cpuEvaluator.h>

namespace OpenSubdivHex::Regression::osdEvaluatorTest {
namespace {

bool isOsdCpuFastPath(Evaluator const &evaluator, Layout const &layout) {
    int const length = layout.src.length;
    return evaluator.name == "Osd::CpuEvaluator" && (length == 4 || length == 8) &&
           layout.src.stride == length && layout.dst.stride == length;
}

TEST(OsdEvaluator, WritesRangesToTheFirstElements) {
    for (TestTable const *table : GetTestTables()) {
        for (Evaluator const &evaluator : GetOsdEvaluators()) {
            SCOPED_TRACE(evaluator.name);
            EvaluatorScope const scope(evaluator);
            ASSERT_NO_FATAL_FAILURE(
                ForEachLayoutAndRange(*table, [&](Layout const &layout, Range range) {
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
    ASSERT_NO_FATAL_FAILURE(ExpectDerivativesWritten(GetOsdEvaluators(), true));
}

} // namespace
} // namespace OpenSubdivHex::Regression::osdEvaluatorTest

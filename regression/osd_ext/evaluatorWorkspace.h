// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_OSD_EXT_EVALUATOR_WORKSPACE_H
#define OPENSUBDIVHEX_REGRESSION_OSD_EXT_EVALUATOR_WORKSPACE_H

#include "evaluators.h"
#include "guardedArray.h"

#include <opensubdiv/far/stencilTable.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>

namespace OpenSubdivHex::Regression {

namespace Far = OpenSubdiv::Far;

inline constexpr int kNumOutputs = 6; ///< value, du, dv, duu, duv, dvv
inline constexpr float kGuard = -12345.678f;
inline constexpr int kLengths[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 16};

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

std::unique_ptr<Far::StencilTable const> MakeHexTable(std::string const &shape, int level);

std::unique_ptr<Far::StencilTable const> MakeCatmarkTable(std::string const &shape, int level);

/// Stencils of 0 to 40 indices in any order, also of the same one; runs of 1 to 9 stencils share a
/// list of indices, or all of it but the last.
TestTable MakeRandomTable(int numStencils);

std::vector<TestTable const *> const &GetTestTables();

/// Where the elements of a source and a destination lie.
struct Layout {
    Descriptor src;
    Descriptor dst;
    bool isOneBuffer;
    GuardedEnd guardedEnd;
};

std::vector<Layout> MakeLayouts(int length, int numSources);

/// Floats up to the end of the last element, and no more.
std::size_t GetNumFloats(Descriptor const &desc, int numElements);

float GetSourceValue(int element, int k);

void FillSources(float *buffer, Descriptor const &desc, int numSources);

/// In double precision, and by how much a sum of floats may differ.
struct Expected {
    double value = 0;
    double tolerance = 0;
};

Expected GetExpected(TestTable const &table, int output, int stencil, int k);

/// Buffers for one evaluation: all outputs lie one behind the other.
class Workspace {
public:
    Workspace(TestTable const &table, Layout const &layout, int numOutputs)
        : _table(table), _layout(layout) {
        int const numStencils = table.GetNumStencils();
        std::size_t const numSrc = GetNumFloats(layout.src, table.numSources);
        std::size_t const numDst = GetNumFloats(layout.dst, numStencils);
        _numDst = layout.isOneBuffer ? numDst - std::size_t(layout.dst.offset) : numDst;
        std::vector<float> src(numSrc, kGuard);
        FillSources(src.data(), layout.src, table.numSources);
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
                    Expected const expected = GetExpected(_table, output, i, k);
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

std::vector<Range> MakeRanges(int numStencils);

/// Calls check(layout, range) for each combination, with its description as scope.
template <class CHECK>
void ForEachLayoutAndRange(TestTable const &table, CHECK const &check) {
    for (int const length : kLengths) {
        std::vector<Layout> const layouts = MakeLayouts(length, table.numSources);
        for (std::size_t i = 0; i < layouts.size(); ++i) {
            for (Range const range : MakeRanges(table.GetNumStencils())) {
                SCOPED_TRACE(table.name + " length " + std::to_string(length) + " layout " +
                             std::to_string(i) + " range " + std::to_string(range.start) + " " +
                             std::to_string(range.end));
                ASSERT_NO_FATAL_FAILURE(check(layouts[i], range));
            }
        }
    }
}

/// \brief Expects that evaluators write the first derivatives, and the second ones, of all ranges.
///
/// \param isFromStart  whether to the first elements, wherever the range begins
inline void ExpectDerivativesWritten(std::vector<Evaluator> const &evaluators, bool isFromStart) {
    TestTable const &table = *GetTestTables()[0];
    for (Evaluator const &evaluator : evaluators) {
        SCOPED_TRACE(evaluator.name);
        EvaluatorScope const scope(evaluator);
        for (int const numOutputs : {3, 6}) {
            ASSERT_NO_FATAL_FAILURE(ForEachLayoutAndRange(table, [&](Layout const &layout,
                                                                     Range range) {
                Workspace workspace(table, layout, numOutputs);
                ASSERT_TRUE(workspace.Run(evaluator.functions, numOutputs, range.start, range.end));
                workspace.ExpectWritten(numOutputs, range.start, range.end,
                                        isFromStart ? 0 : range.start);
            }));
        }
    }
}

} // namespace OpenSubdivHex::Regression

#endif

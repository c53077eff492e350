// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_EVALUATION_H
#define OPENSUBDIVHEX_REGRESSION_PERF_EVALUATION_H

#include "makers.h"

#include "osd_ext/cpuEvaluator.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

using Buffer = std::unique_ptr<Osd::CpuVertexBuffer>;

/// \brief Sources of an evaluation, and what its results should be.
struct Values {
    /// Without expectations.
    Values(int numSources, int length);

    /// The results that Osd::CpuEvaluator gives for \p table.
    Values(Far::StencilTable const &table, int length);

    Osd::BufferDescriptor GetDesc() const { return {0, length, length}; }
    /// Throws std::runtime_error unless the \p numResults results are those expected.
    void Compare(float const *results, std::size_t numResults, std::string const &name) const;

    int length;
    Buffer src;
    std::vector<float> expected;
};

/// The bytes of a table, of its sources and of its results.
/// @{
double GetMovedBytes(Far::StencilTable const &table, int length);
double GetMovedBytes(OsdExt::CompactStencilTable const &table, int length);
/// @}

/// \brief Evaluates \p table, as many stencils as it has, with the evaluator EVALUATOR of Osd or
/// OsdExt.
template <class EVALUATOR, class TABLE>
Contestant MakeEvaluation(std::string const &name, int numThreads,
                          std::shared_ptr<TABLE const> const &table,
                          std::shared_ptr<Values const> const &values) {
    std::shared_ptr<Osd::CpuVertexBuffer> const dst(
        Osd::CpuVertexBuffer::Create(values->length, table->GetNumStencils()));
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    contestant.movedBytes = GetMovedBytes(*table, values->length);
    contestant.work = [=] {
        Require(EVALUATOR::EvalStencils(values->src.get(), values->GetDesc(), dst.get(),
                                        values->GetDesc(), table.get()),
                name + ": not evaluated");
    };
    contestant.validate = [=] {
        int const numStencils = table->GetNumStencils();
        values->Compare(dst->BindCpuBuffer(),
                        std::size_t(numStencils) * std::size_t(values->length), name);
        return double(numStencils);
    };
    return contestant;
}

/// \brief Runs the work with the threads of OpenMP.  They are awake when it begins, and asleep
/// before another contestant begins: otherwise they keep their processors for milliseconds.
Contestant OnOpenMp(Contestant contestant);

/// Evaluates all levels of \p refiner without a table.  Results are compared if \p values says
/// what they should be.
Contestant MakeTableFreeContestant(std::shared_ptr<FarExt::TopologyRefiner const> const &refiner,
                                   int numThreads, std::shared_ptr<Values const> const &values);

} // namespace OpenSubdivHex::Regression

#endif

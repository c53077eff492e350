// SPDX-License-Identifier: Apache-2.0
#include "evaluation.h"

#include "osd_ext/refinementEvaluator.h"

#include <chrono>
#include <cmath>
#include <thread>

namespace OpenSubdivHex::Regression {

Values::Values(int numSources, int valueLength)
    : length(valueLength), src(Osd::CpuVertexBuffer::Create(valueLength, numSources)) {
    std::size_t const numFloats = std::size_t(length) * std::size_t(numSources);
    float *const values = src->BindCpuBuffer();
    for (std::size_t i = 0; i < numFloats; ++i) {
        values[i] = float(i % 1000) / 1000;
    }
}

Values::Values(Far::StencilTable const &table, int valueLength)
    : Values(table.GetNumControlVertices(), valueLength) {
    Buffer const dst(Osd::CpuVertexBuffer::Create(length, table.GetNumStencils()));
    Require(Osd::CpuEvaluator::EvalStencils(src.get(), GetDesc(), dst.get(), GetDesc(), &table),
            "no values to compare with");
    float const *const results = dst->BindCpuBuffer();
    expected.assign(results, results + std::size_t(length) * std::size_t(table.GetNumStencils()));
}

void Values::Compare(float const *results, std::size_t numResults, std::string const &name) const {
    Require(numResults == expected.size(), name + ": wrong number of results");
    for (std::size_t i = 0; i < numResults; ++i) {
        Require(std::abs(results[i] - expected[i]) < 1e-5, name + ": wrong results");
    }
}

double GetMovedBytes(Far::StencilTable const &table, int length) {
    double const numElements = double(table.GetNumControlVertices()) + table.GetNumStencils();
    return GetNumBytes(table) + numElements * length * sizeof(float);
}

double GetMovedBytes(OsdExt::CompactStencilTable const &table, int length) {
    double const numElements = double(table.GetNumControlVertices()) + table.GetNumStencils();
    return double(table.GetNumBytes()) + numElements * length * sizeof(float);
}

Contestant OnOpenMp(Contestant contestant) {
    contestant.prepare = [prepare = contestant.prepare] {
        if (prepare) {
            prepare();
        }
#ifdef _OPENMP
#pragma omp parallel
        {}
#endif
    };
    contestant.release = [release = contestant.release] {
        constexpr std::chrono::milliseconds kUntilAsleep(30);
        std::this_thread::sleep_for(kUntilAsleep);
        if (release) {
            release();
        }
    };
    return contestant;
}

Contestant MakeTableFreeContestant(std::shared_ptr<FarExt::TopologyRefiner const> const &refiner,
                                   int numThreads, std::shared_ptr<Values const> const &values) {
    // The evaluator refers to the refiner.
    struct State {
        std::shared_ptr<FarExt::TopologyRefiner const> refiner;
        std::unique_ptr<OsdExt::RefinementEvaluator> evaluator;
        Buffer dst;
    };
    auto const state = std::make_shared<State>();
    state->refiner = refiner;
    state->evaluator = OsdExt::RefinementEvaluator::Create(*refiner);
    auto const numElements = std::size_t(state->evaluator->GetNumElementsAllLevels());
    state->dst.reset(Osd::CpuVertexBuffer::Create(values->length, int(numElements)));

    std::string const name = "OsdExt::RefinementEvaluator";
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    // Each element is written, and all but those of the last level are read again.
    int const numLast = state->evaluator->GetNumElements(refiner->GetMaxLevel());
    contestant.movedBytes =
        (2 * double(numElements) - numLast) * double(values->length * sizeof(float));
    contestant.work = [=] {
        Require(state->evaluator->EvaluateAllLevels(values->src.get(), values->GetDesc(),
                                                    state->dst.get(), values->GetDesc()),
                name + ": not evaluated");
    };
    contestant.validate = [=] {
        if (!values->expected.empty()) {
            values->Compare(state->dst->BindCpuBuffer(), numElements * std::size_t(values->length),
                            name);
        }
        return double(numElements);
    };
    return contestant;
}

} // namespace OpenSubdivHex::Regression

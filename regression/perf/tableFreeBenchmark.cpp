// SPDX-License-Identifier: Apache-2.0
//
// All levels without a table, against the fastest of this library's tables for all levels:
// nanoseconds per vertex of all levels.
#include "evaluation.h"

#include "far_ext/stencilTableFactory.h"

namespace OpenSubdivHex::Regression {
namespace {

Table makeTable(FarExt::TopologyRefiner const &refiner, bool isFactorized) {
    FarExt::StencilTableFactory::Options options;
    options.factorizeIntermediateLevels = isFactorized;
    return FarExt::StencilTableFactory::Create(refiner, options);
}

/// Each level from the one before it, by a table that is not factorized.
template <class EVALUATOR>
Contestant makeLevelByLevel(FarExt::TopologyRefiner const &refiner, int numThreads,
                            std::shared_ptr<Values const> const &values) {
    std::shared_ptr<Far::StencilTable const> const table = makeTable(refiner, false);
    std::string const name = "table, level by level";
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    contestant.movedBytes = GetMovedBytes(*table, values->length);
    std::vector<int> numElements;
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        numElements.push_back(refiner.GetLevel(level).GetNumVertices());
    }
    std::shared_ptr<Osd::CpuVertexBuffer> const dst(
        Osd::CpuVertexBuffer::Create(values->length, table->GetNumStencils()));
    contestant.work = [=] {
        Osd::BufferDescriptor const desc = values->GetDesc();
        float const *src = values->src->BindCpuBuffer();
        int first = 0;
        for (int count : numElements) {
            Require(EVALUATOR::EvalStencils(src, desc, dst->BindCpuBuffer(), desc,
                                            table->GetSizes().data(), table->GetOffsets().data(),
                                            table->GetControlIndices().data(),
                                            table->GetWeights().data(), first, first + count),
                    "not evaluated");
            src = dst->BindCpuBuffer() + std::size_t(first) * std::size_t(values->length);
            first += count;
        }
    };
    contestant.validate = [=] {
        std::size_t const numStencils = std::size_t(table->GetNumStencils());
        values->Compare(dst->BindCpuBuffer(), numStencils * std::size_t(values->length), name);
        return double(numStencils);
    };
    return contestant;
}

Contest makeContest(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner const> const refiner = MakeRefined(mesh);
    std::shared_ptr<Far::StencilTable const> const table = makeTable(*refiner, true);
    std::shared_ptr<OsdExt::CompactStencilTable const> const compact =
        OsdExt::CompactStencilTable::Create(*table);
    auto const values = std::make_shared<Values>(*table, 3);
    Contest contest;
    contest.contestants = {
        MakeTableFreeContestant(refiner, 1, values),
        MakeEvaluation<OsdExt::CpuEvaluator>("table, factorized", 1, table, values),
        makeLevelByLevel<OsdExt::CpuEvaluator>(*refiner, 1, values),
        MakeEvaluation<OsdExt::CpuEvaluator>("table, compact", 1, compact, values),
        MakeTableFreeContestant(refiner, 2, values),
        MakeEvaluation<OsdExt::ParallelEvaluator>("table, factorized", 2, table, values),
        makeLevelByLevel<OsdExt::ParallelEvaluator>(*refiner, 2, values),
        MakeEvaluation<OsdExt::ParallelEvaluator>("table, compact", 2, compact, values)};
    contest.pairings = {{"table-free-1", 0, {1, 2, 3}}, {"table-free-2", 4, {5, 6, 7}}};
    return contest;
}

} // namespace

void AddTableFreeBenchmarks(Suite &suite) {
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        suite.AddContest({"all levels, length 3", "vertex", mesh, Memory::Resident},
                         [=] { return makeContest(mesh); });
    }
}

} // namespace OpenSubdivHex::Regression

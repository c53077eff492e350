// SPDX-License-Identifier: Apache-2.0
//
// How the costs of this library grow with the level, on 1 and 2 threads.
#include "evaluation.h"

namespace OpenSubdivHex::Regression {
namespace {

/// One work on each number of threads.
template <typename MAKE>
Contest makeContest(MAKE make) {
    Contest contest;
    for (int numThreads : {1, 2}) {
        contest.contestants.push_back(make(numThreads));
    }
    return contest;
}

Contest makeTable(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner> const refiner = MakeRefined(mesh);
    return makeContest([&](int numThreads) { return MakeTableContestant(refiner, numThreads); });
}

Contest makeEvaluation(BenchMesh const &mesh) {
    std::shared_ptr<Far::StencilTable const> const table = MakeTable(*MakeRefined(mesh));
    auto const values = std::make_shared<Values>(*table, 3);
    return makeContest([&](int numThreads) {
        return MakeEvaluation<OsdExt::ParallelEvaluator>("OsdExt::ParallelEvaluator", numThreads,
                                                         table, values);
    });
}

Contest makeTableFree(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner const> const refiner = MakeRefined(mesh);
    auto const values = std::make_shared<Values>(refiner->GetLevel(0).GetNumVertices(), 3);
    return makeContest(
        [&](int numThreads) { return MakeTableFreeContestant(refiner, numThreads, values); });
}

} // namespace

void AddGrowthBenchmarks(Suite &suite) {
    for (BenchMesh const &mesh : suite.GetGrowthMeshes()) {
        auto const add = [&](char const *work, char const *item, Memory memory, auto make) {
            suite.AddContest({work, item, mesh, memory}, [=] { return make(mesh); });
        };
        add("topology-full", "vertex", Memory::Default, [](BenchMesh const &m) {
            return makeContest(
                [&](int numThreads) { return MakeTopologyContestant(m, true, numThreads); });
        });
        add("table", "weight", Memory::Default, makeTable);
        add("evaluation, length 3", "stencil", Memory::Resident, makeEvaluation);
        add("all levels, length 3", "vertex", Memory::Resident, makeTableFree);
    }
}

} // namespace OpenSubdivHex::Regression

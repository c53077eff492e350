// SPDX-License-Identifier: Apache-2.0
//
// Beside as many busy threads as there are processors: all processors' threads against one thread
// of the same library, and against the threads of OpenMP.
#include "evaluation.h"

#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace OpenSubdivHex::Regression {
namespace {

/// \brief Threads that keep their processors busy while it lives.
class BusyThreads {
public:
    explicit BusyThreads(int count) {
        for (int i = 0; i < count; ++i) {
            _threads.emplace_back([this] {
                while (!_isOver) {
                }
            });
        }
    }
    ~BusyThreads() {
        _isOver = true;
        for (std::thread &thread : _threads) {
            thread.join();
        }
    }

    BusyThreads(BusyThreads const &) = delete;
    BusyThreads &operator=(BusyThreads const &) = delete;

private:
    std::atomic<bool> _isOver{false};
    std::vector<std::thread> _threads;
};

constexpr int kNumRounds = 4; // of large meshes

int getNumProcessors() { return std::max(2, int(std::thread::hardware_concurrency())); }

#ifdef _OPENMP
Contestant withOpenMp(Contestant contestant) {
    contestant.name += ", OmpExecutor";
    contestant.work = [work = contestant.work, numThreads = contestant.numThreads] {
        FarExt::OmpExecutor executor;
        FarExt::ExecutorScope const scope(&executor, numThreads);
        work();
    };
    return OnOpenMp(contestant);
}
#endif

/// The work again and again, so that it takes longer than a thread has a processor at a time: else it
/// is chance who loses it.
Contestant repeat(Contestant contestant, int numRounds) {
    contestant.work = [work = contestant.work, numRounds] {
        for (int round = 0; round < numRounds; ++round) {
            work();
        }
    };
    contestant.validate = [validate = contestant.validate, numRounds] {
        return numRounds * validate();
    };
    contestant.movedBytes *= numRounds;
    return contestant;
}

/// \param make  makes the contestant of a number of threads
template <typename MAKE>
Contest makeContest(std::string const &row, int numRounds, MAKE make) {
    int const numThreads = getNumProcessors();
    Contest contest{{repeat(make(1), numRounds), repeat(make(numThreads), numRounds)},
                    {{row, 1, {0}}}};
#ifdef _OPENMP
    contest.contestants.push_back(withOpenMp(make(numThreads)));
#endif
    auto const busyThreads = std::make_shared<BusyThreads>(numThreads);
    for (Contestant &contestant : contest.contestants) {
        contestant.work = [work = contestant.work, busyThreads] { work(); };
    }
    return contest;
}

/// The base level, from a descriptor.
Contest makeBaseLevel(BenchMesh const &mesh, int numRounds) {
    return makeContest("busy-base", numRounds, [&](int numThreads) {
        auto const refiner = std::make_shared<std::unique_ptr<FarExt::TopologyRefiner>>();
        Contestant contestant;
        contestant.name = "FarExt";
        contestant.numThreads = numThreads;
        contestant.work = [=] {
            ShapeDescriptor const descriptor(*mesh.shape);
            *refiner = FarExt::TopologyRefinerFactory::Create(descriptor.Get());
        };
        contestant.validate = [=] {
            Require(*refiner != nullptr, "no base level");
            return double((*refiner)->GetLevel(0).GetNumVertices());
        };
        contestant.release = [=] { refiner->reset(); };
        return contestant;
    });
}

/// Refines the same refiner, whose memory stays.
Contest makeTopology(BenchMesh const &mesh, int numRounds) {
    return makeContest("busy-topology", numRounds, [&](int numThreads) {
        std::shared_ptr<FarExt::TopologyRefiner> const refiner = MakeBase(mesh);
        FarExt::TopologyRefiner::UniformOptions options(mesh.level);
        options.fullTopologyInLastLevel = true;
        Contestant contestant;
        contestant.name = "FarExt";
        contestant.numThreads = numThreads;
        contestant.work = [=] { Require(refiner->RefineUniform(options), "not refined"); };
        contestant.validate = [=] {
            Require(refiner->GetMaxLevel() == mesh.level, "wrong level");
            return double(refiner->GetLevel(mesh.level).GetNumVertices());
        };
        return contestant;
    });
}

Contest makeTable(BenchMesh const &mesh, int /*numRounds*/) {
    std::shared_ptr<FarExt::TopologyRefiner> const refiner = MakeRefined(mesh);
    return makeContest("busy-table", 1,
                       [&](int numThreads) { return MakeTableContestant(refiner, numThreads); });
}

Contest makeEvaluation(BenchMesh const &mesh, int numRounds) {
    std::shared_ptr<Far::StencilTable const> const table = MakeTable(*MakeRefined(mesh));
    auto const values = std::make_shared<Values>(*table, 3);
    return makeContest("busy-evaluation", numRounds, [&](int numThreads) {
        return MakeEvaluation<OsdExt::ParallelEvaluator>("OsdExt::ParallelEvaluator", numThreads,
                                                         table, values);
    });
}

Contest makeTableFree(BenchMesh const &mesh, int numRounds) {
    std::shared_ptr<FarExt::TopologyRefiner const> const refiner = MakeRefined(mesh);
    auto const values = std::make_shared<Values>(refiner->GetLevel(0).GetNumVertices(), 3);
    return makeContest("busy-table-free", numRounds, [&](int numThreads) {
        return MakeTableFreeContestant(refiner, numThreads, values);
    });
}

} // namespace

void AddBusyBenchmarks(Suite &suite) {
    for (BenchMesh const &mesh : suite.GetBaseMeshes()) {
        int const numRounds = mesh.size == "small" ? 64 * kNumRounds : kNumRounds;
        for (Memory memory : {Memory::Default, Memory::Warm}) {
            suite.AddContest({"busy, base level", "vertex", mesh, memory},
                             [=] { return makeBaseLevel(mesh, numRounds); });
        }
    }
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        int const numRounds = mesh.size == "small" ? 16 * kNumRounds : kNumRounds;
        auto const add = [&](char const *work, char const *item, Memory memory, auto make) {
            suite.AddContest({std::string("busy, ") + work, item, mesh, memory},
                             [=] { return make(mesh, numRounds); });
        };
        add("topology-full", "vertex", Memory::Resident, makeTopology);
        for (Memory memory : {Memory::Default, Memory::Warm}) {
            add("table", "weight", memory, makeTable);
        }
        add("evaluation, length 3", "stencil", Memory::Resident, makeEvaluation);
        add("all levels, length 3", "vertex", Memory::Resident, makeTableFree);
    }
}

} // namespace OpenSubdivHex::Regression

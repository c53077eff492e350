// SPDX-License-Identifier: Apache-2.0
//
// Stencil tables of the last level against those that Far makes of Catmull-Clark on the same mesh:
// nanoseconds per weight, and the peak memory of a build over the size of its table.
#include "makers.h"
#include "memory.h"
#include "suite.h"

#include <algorithm>

namespace OpenSubdivHex::Regression {
namespace {

template <typename MAKE>
double measurePeak(MAKE make) {
    Table table;
    double const peak = MeasurePeakBytes([&] { table = make(); });
    Require(table != nullptr, "no table");
    return peak / GetNumBytes(*table);
}

} // namespace

// Before all other benchmarks, small tables first: a figure of a small table depends on what larger
// work has left of the heap, by up to a fifth.
void AddTablePeakBenchmarks(Suite &suite) {
    std::vector<BenchMesh> meshes = suite.GetMeshes();
    std::stable_sort(meshes.begin(), meshes.end(),
                     [](BenchMesh const &a, BenchMesh const &b) { return a.level < b.level; });
    for (BenchMesh const &mesh : meshes) {
        suite.AddMeasurement({"table-peak", "", mesh, Memory::Default}, "table-peak", [=] {
            auto const refiner = MakeRefined(mesh);
            auto const farRefiner = MakeFarRefined(mesh);
            SetNumThreads(1);
            return std::pair(measurePeak([&] { return MakeTable(*refiner); }),
                             measurePeak([&] { return MakeFarTable(*farRefiner); }));
        });
    }
}

void AddStencilTableBenchmarks(Suite &suite) {
    for (Memory memory : {Memory::Default, Memory::Warm}) {
        for (BenchMesh const &mesh : suite.GetMeshes()) {
            suite.AddContest({"table", "weight", mesh, memory}, [=] {
                std::shared_ptr<FarExt::TopologyRefiner> const refiner = MakeRefined(mesh);
                std::shared_ptr<Far::TopologyRefiner> const farRefiner = MakeFarRefined(mesh);
                return Contest{{MakeTableContestant(refiner, 1), MakeFarTableContestant(farRefiner),
                                MakeTableContestant(refiner, 2)},
                               {{"table-1", 0, {1}}, {"table-2", 2, {1}}}};
            });
        }
    }
}

} // namespace OpenSubdivHex::Regression

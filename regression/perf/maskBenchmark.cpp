// SPDX-License-Identifier: Apache-2.0
//
// The cost of FaceMask::Smooth's masks around irregular vertices and in quads: frames and tables
// against those of FaceMask::Average, which has no such masks.  Meshes of hexagons alone have no
// irregular vertices; in the other meshes all vertices are irregular.
#include "evaluation.h"

namespace OpenSubdivHex::Regression {
namespace {

using FarExt::FaceMask;

Contest makeContest(Contestant smooth, Contestant average, std::string const &row) {
    smooth.name += ", Smooth";
    average.name += ", Average";
    return {{std::move(smooth), std::move(average)}, {{row, 0, {1}}}};
}

Contest makeFrames(BenchMesh const &mesh) {
    auto const make = [&](FaceMask faceMask) {
        std::shared_ptr<FarExt::TopologyRefiner const> const refiner = MakeRefined(mesh, faceMask);
        return MakeTableFreeContestant(
            refiner, 1, std::make_shared<Values>(refiner->GetLevel(0).GetNumVertices(), 3));
    };
    return makeContest(make(FaceMask::Smooth), make(FaceMask::Average), "smooth-table-free");
}

Contest makeTables(BenchMesh const &mesh) {
    auto const make = [&](FaceMask faceMask) {
        return MakeTableContestant(MakeRefined(mesh, faceMask), 1);
    };
    return makeContest(make(FaceMask::Smooth), make(FaceMask::Average), "smooth-table");
}

} // namespace

void AddMaskBenchmarks(Suite &suite) {
    for (auto const *meshes : {&suite.GetMeshes(), &suite.GetIrregularMeshes()}) {
        for (BenchMesh const &mesh : *meshes) {
            suite.AddContest({"all levels, Smooth", "vertex", mesh, Memory::Resident},
                             [=] { return makeFrames(mesh); });
            for (Memory memory : {Memory::Default, Memory::Warm}) {
                suite.AddContest({"table, Smooth", "weight", mesh, memory},
                                 [=] { return makeTables(mesh); });
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression

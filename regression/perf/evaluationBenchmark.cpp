// SPDX-License-Identifier: Apache-2.0
//
// The evaluators of OsdExt against those of Osd, on the same table: nanoseconds per stencil.
#include "evaluation.h"

#ifdef OPENSUBDIV_HAS_OPENMP
#include <opensubdiv/osd/ompEvaluator.h>
#endif

namespace OpenSubdivHex::Regression {
namespace {

Contest makeEvaluation(BenchMesh const &mesh, int length) {
    std::shared_ptr<Far::StencilTable const> const table = MakeTable(*MakeRefined(mesh));
    auto const values = std::make_shared<Values>(*table, length);
    std::shared_ptr<OsdExt::CompactStencilTable const> const compact =
        OsdExt::CompactStencilTable::Create(*table);
    std::string const suffix = "length" + std::to_string(length);
    Contest contest;
    contest.contestants = {
        MakeEvaluation<OsdExt::CpuEvaluator>("OsdExt::CpuEvaluator", 1, table, values),
        MakeEvaluation<Osd::CpuEvaluator>("Osd::CpuEvaluator", 1, table, values),
        MakeEvaluation<OsdExt::CpuEvaluator>("OsdExt, compact table", 1, compact, values),
        MakeEvaluation<OsdExt::ParallelEvaluator>("OsdExt::ParallelEvaluator", 2, table, values)};
    contest.pairings = {{"evaluation-1-" + suffix, 0, {1}},
                        {"evaluation-compact-" + suffix, 2, {0}},
                        {"evaluation-2-cpu-" + suffix, 3, {1}},
                        {"evaluation-2-own-" + suffix, 3, {0}}};
#if defined(OPENSUBDIV_HAS_OPENMP) && defined(_OPENMP)
    contest.contestants.push_back(
        OnOpenMp(MakeEvaluation<Osd::OmpEvaluator>("Osd::OmpEvaluator", 2, table, values)));
    contest.pairings.push_back({"evaluation-2-" + suffix, 3, {4}});
#endif
    return contest;
}

Contest makeCatmarkEvaluation(BenchMesh const &mesh) {
    std::shared_ptr<Far::StencilTable const> const table = MakeFarTable(*MakeFarRefined(mesh));
    auto const values = std::make_shared<Values>(*table, 3);
    return {{MakeEvaluation<OsdExt::CpuEvaluator>("OsdExt::CpuEvaluator", 1, table, values),
             MakeEvaluation<Osd::CpuEvaluator>("Osd::CpuEvaluator", 1, table, values)},
            {{"evaluation-catmark", 0, {1}}}};
}

} // namespace

void AddEvaluationBenchmarks(Suite &suite) {
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        for (int length : {3, 4, 8}) {
            suite.AddContest(
                {"evaluation, length " + std::to_string(length), "stencil", mesh, Memory::Resident},
                [=] { return makeEvaluation(mesh, length); });
        }
        suite.AddContest({"evaluation of Catmull-Clark", "stencil", mesh, Memory::Resident},
                         [=] { return makeCatmarkEvaluation(mesh); });
    }
}

} // namespace OpenSubdivHex::Regression

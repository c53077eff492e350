// SPDX-License-Identifier: Apache-2.0
//
// The limit surface: tables of points and both derivatives against the stencil table of their level
// and Far's of Catmull-Clark, nanoseconds per weight; and a frame of all three without a table,
// nanoseconds per vertex, against one of the level's vertices alone.
#include "evaluation.h"

#include "far_ext/stencilTableFactory.h"
#include "osd_ext/refinementEvaluator.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include <cmath>

namespace OpenSubdivHex::Regression {
namespace {

using LimitTable = std::unique_ptr<Far::LimitStencilTable const>;

LimitTable makeLimitTable(FarExt::TopologyRefiner const &refiner) {
    FarExt::LimitStencilTableFactory::Options options;
    options.level = refiner.GetMaxLevel();
    return FarExt::LimitStencilTableFactory::Create(refiner, options);
}

/// As many points of Far's Catmull-Clark surface as vertices of a level, on each of its ptex faces
/// alike, but for rounding.
LimitTable makeFarLimitTable(Far::TopologyRefiner const &refiner, int numPoints) {
    int const numFaces = Far::PtexIndices(refiner).GetNumFaces();
    int const numSteps = std::max(1, int(std::lround(std::sqrt(double(numPoints) / numFaces))));
    std::vector<float> parameters;
    for (int i = 0; i < numSteps; ++i) {
        parameters.push_back((float(i) + 0.5f) / float(numSteps));
    }
    std::vector<float> s;
    std::vector<float> t;
    for (float u : parameters) {
        for (float v : parameters) {
            s.push_back(u);
            t.push_back(v);
        }
    }
    Far::LimitStencilTableFactory::LocationArrayVec locations;
    for (int face = 0; face < numFaces; ++face) {
        Far::LimitStencilTableFactory::LocationArray location;
        location.ptexIdx = face;
        location.numLocations = int(s.size());
        location.s = s.data();
        location.t = t.data();
        locations.push_back(location);
    }
    return LimitTable(Far::LimitStencilTableFactory::Create(refiner, locations));
}

/// A table for each turn.
template <typename MAKE>
Contestant makeLimitContestant(std::string const &name, int numThreads, MAKE make) {
    auto const table = std::make_shared<LimitTable>();
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    contestant.work = [=] { *table = make(); };
    contestant.validate = [=] {
        Require(*table != nullptr &&
                    (*table)->GetDvWeights().size() == (*table)->GetWeights().size(),
                name + ": no derivatives");
        return 3 * double((*table)->GetWeights().size());
    };
    contestant.release = [=] { table->reset(); };
    return contestant;
}

Contest makeTableContest(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner> const refiner = MakeFullyRefined(mesh);
    std::shared_ptr<Far::TopologyRefiner> const farRefiner = MakeFarBase(mesh);
    farRefiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(mesh.level));
    int const numPoints = refiner->GetLevel(mesh.level).GetNumVertices();
    auto const make = [=] { return makeLimitTable(*refiner); };
    Contest contest;
    contest.contestants = {makeLimitContestant("FarExt, limit", 1, make),
                           MakeTableContestant(refiner, 1),
                           makeLimitContestant("Far, limit", 1, [=] {
                               return makeFarLimitTable(*farRefiner, numPoints);
                           })};
    contest.contestants[1].name = "FarExt, level";
    contest.contestants.push_back(makeLimitContestant("FarExt, limit", 2, make));
    contest.pairings = {
        {"limit-table-own", 0, {1}}, {"limit-table-1", 0, {2}}, {"limit-table-2", 3, {2}}};
    return contest;
}

/// Points, and the two derivatives behind them.
struct LimitFrame {
    std::shared_ptr<FarExt::TopologyRefiner const> refiner; ///< the evaluator refers to it
    std::unique_ptr<OsdExt::RefinementEvaluator> evaluator;
    std::shared_ptr<LimitTable const> table;
    Buffer buffers[3];
};

std::shared_ptr<LimitFrame> makeFrame(std::shared_ptr<FarExt::TopologyRefiner const> const &refiner,
                                      std::shared_ptr<LimitTable const> const &table, int length) {
    auto frame = std::make_shared<LimitFrame>();
    frame->refiner = refiner;
    frame->evaluator = OsdExt::RefinementEvaluator::Create(*refiner);
    frame->table = table;
    for (Buffer &buffer : frame->buffers) {
        buffer.reset(Osd::CpuVertexBuffer::Create(
            length, frame->evaluator->GetNumElements(refiner->GetMaxLevel())));
    }
    return frame;
}

/// \param work  of a frame: what is evaluated to its buffers
template <typename WORK>
Contestant makeFrameContestant(std::string const &name, int numThreads,
                               std::shared_ptr<LimitFrame> const &frame,
                               std::shared_ptr<Values const> const &values, bool isLimit,
                               WORK work) {
    int const numVertices = frame->evaluator->GetNumElements(frame->refiner->GetMaxLevel());
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    contestant.movedBytes = (isLimit ? 4.0 : 1.0) * numVertices * values->length * sizeof(float);
    contestant.work = [=] { Require(work(*frame), name + ": not evaluated"); };
    contestant.validate = [=] {
        if (isLimit) {
            values->Compare(frame->buffers[0]->BindCpuBuffer(),
                            std::size_t(numVertices) * std::size_t(values->length), name);
        }
        return double(numVertices);
    };
    return contestant;
}

Contest makeFrameContest(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner const> const refiner = MakeFullyRefined(mesh);
    auto const table = std::make_shared<LimitTable const>(makeLimitTable(*refiner));
    auto const values = std::make_shared<Values>((*table)->GetNumControlVertices(), 3);
    auto const frame = makeFrame(refiner, table, values->length);
    Osd::BufferDescriptor const desc = values->GetDesc();
    values->expected.resize(std::size_t(values->length) * std::size_t((*table)->GetNumStencils()));
    Require(OsdExt::CpuEvaluator::EvalStencils(
                values->src->BindCpuBuffer(), desc, values->expected.data(), desc,
                (*table)->GetSizes().data(), (*table)->GetOffsets().data(),
                (*table)->GetControlIndices().data(), (*table)->GetWeights().data(), 0,
                (*table)->GetNumStencils()),
            "no values to compare with");
    int const level = mesh.level;
    auto const evaluateLimit = [=](LimitFrame &of) {
        return of.evaluator->EvaluateLimit(values->src.get(), desc, of.buffers[0].get(), desc,
                                           of.buffers[1].get(), desc, of.buffers[2].get(), desc,
                                           level);
    };
    auto const evaluate = [=](LimitFrame &of) {
        return of.evaluator->Evaluate(values->src.get(), desc, of.buffers[0].get(), desc, level);
    };
    auto const evaluateTable = [=](LimitFrame &of) {
        return OsdExt::CpuEvaluator::EvalStencils(values->src.get(), desc, of.buffers[0].get(),
                                                  desc, of.buffers[1].get(), desc,
                                                  of.buffers[2].get(), desc, of.table->get());
    };
    std::string const name = "OsdExt::RefinementEvaluator";
    Contest contest;
    contest.contestants = {
        makeFrameContestant(name + ", limit", 1, frame, values, true, evaluateLimit),
        makeFrameContestant(name, 1, frame, values, false, evaluate),
        makeFrameContestant("limit table", 1, frame, values, true, evaluateTable)};
    contest.pairings = {{"limit-evaluation-own", 0, {1}}, {"limit-evaluation-table", 0, {2}}};
    return contest;
}

} // namespace

void AddLimitBenchmarks(Suite &suite) {
    for (Memory memory : {Memory::Default, Memory::Warm}) {
        for (BenchMesh const &mesh : suite.GetMeshes()) {
            suite.AddContest({"limit table", "weight", mesh, memory},
                             [=] { return makeTableContest(mesh); });
        }
    }
    for (auto const *meshes : {&suite.GetMeshes(), &suite.GetIrregularMeshes()}) {
        for (BenchMesh const &mesh : *meshes) {
            suite.AddContest({"limit, length 3", "vertex", mesh, Memory::Resident},
                             [=] { return makeFrameContest(mesh); });
        }
    }
}

} // namespace OpenSubdivHex::Regression

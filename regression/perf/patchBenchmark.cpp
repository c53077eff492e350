// SPDX-License-Identifier: Apache-2.0
//
// Patches: places with both first derivatives, by Osd's evaluator and by this one on the same table, nanoseconds per
// place, with the places of a patch together and in random order; and tables, against Far's adaptive ones of
// Catmull-Clark with the stencils of their points, nanoseconds per patch.
#include "evaluation.h"

#include "far_ext/patchTableFactory.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuPatchTable.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace OpenSubdivHex::Regression {
namespace {

/// Places in patches, and what is evaluated there.
struct PatchFrame {
    Osd::PatchCoord *BindCpuBuffer() { return coords.data(); }

    std::unique_ptr<Osd::CpuPatchTable> table;
    std::vector<Osd::PatchCoord> coords;
    Buffer points;
    Buffer results[3];
    std::vector<float> expected;
};

std::shared_ptr<PatchFrame> makeFrame(BenchMesh const &mesh, bool isRandom) {
    constexpr int kPlacesOfPatch = 8;
    auto const refiner = MakeFullyRefined(mesh);
    auto const table = FarExt::PatchTableFactory::Create(*refiner, mesh.level - 1);
    Require(table != nullptr, "no patches");
    auto frame = std::make_shared<PatchFrame>();
    frame->table.reset(Osd::CpuPatchTable::Create(table.get()));
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(0, 1);
    for (int patch = 0; patch < table->GetNumPatchesTotal(); ++patch) {
        Far::PatchTable::PatchHandle handle;
        handle.arrayIndex = 0;
        handle.patchIndex = patch;
        handle.vertIndex = patch * table->GetPatchArrayDescriptor(0).GetNumControlVertices();
        for (int i = 0; i < kPlacesOfPatch; ++i) {
            float const s = number(random);
            frame->coords.emplace_back(handle, s, number(random));
        }
    }
    if (isRandom) {
        std::shuffle(frame->coords.begin(), frame->coords.end(), random);
    }
    int const numPoints = refiner->GetLevel(0).GetNumVertices() + table->GetNumLocalPoints();
    frame->points.reset(Osd::CpuVertexBuffer::Create(3, numPoints));
    for (int i = 0; i < 3 * numPoints; ++i) {
        frame->points->BindCpuBuffer()[i] = number(random);
    }
    for (Buffer &buffer : frame->results) {
        buffer.reset(Osd::CpuVertexBuffer::Create(3, int(frame->coords.size())));
    }
    return frame;
}

template <class EVALUATOR>
Contestant makeContestant(std::string const &name, std::shared_ptr<PatchFrame> const &frame) {
    Osd::BufferDescriptor const desc(0, 3, 3);
    auto const numPlaces = int(frame->coords.size());
    Contestant contestant;
    contestant.name = name;
    contestant.movedBytes = double(numPlaces) * (sizeof(Osd::PatchCoord) + 9 * sizeof(float));
    contestant.work = [=] {
        Require(EVALUATOR::EvalPatches(frame->points.get(), desc, frame->results[0].get(), desc,
                                       frame->results[1].get(), desc, frame->results[2].get(), desc,
                                       numPlaces, frame.get(), frame->table.get()),
                name + ": not evaluated");
    };
    contestant.validate = [=] {
        float const *const results = frame->results[2]->BindCpuBuffer();
        if (frame->expected.empty()) {
            frame->expected.assign(results, results + 3 * std::size_t(numPlaces));
        }
        constexpr float kTolerance = 1e-4f;
        for (std::size_t i = 0; i < frame->expected.size(); ++i) {
            Require(std::abs(results[i] - frame->expected[i]) < kTolerance,
                    name + ": other results");
        }
        return double(numPlaces);
    };
    return contestant;
}

Contest makeEvaluationContest(BenchMesh const &mesh, bool isRandom) {
    auto const frame = makeFrame(mesh, isRandom);
    Contest contest;
    contest.contestants = {makeContestant<OsdExt::CpuEvaluator>("OsdExt::CpuEvaluator", frame),
                           makeContestant<Osd::CpuEvaluator>("Osd::CpuEvaluator", frame)};
    contest.pairings = {{isRandom ? "patches-random" : "patches-in-order", 0, {1}}};
    return contest;
}

/// A table of patches, and with Far's the stencils of their points in terms of control vertices.
struct MadePatches {
    std::unique_ptr<Far::PatchTable const> table;
    std::unique_ptr<Far::StencilTable const> points;
};

MadePatches makeFarPatches(Far::TopologyRefiner const &refiner,
                           Far::PatchTableFactory::Options const &options) {
    MadePatches made;
    made.table.reset(Far::PatchTableFactory::Create(refiner, options));
    std::unique_ptr<Far::StencilTable const> const levels(
        Far::StencilTableFactory::Create(refiner));
    made.points.reset(Far::StencilTableFactory::AppendLocalPointStencilTable(
        refiner, levels.get(), made.table->GetLocalPointStencilTable()));
    return made;
}

/// A table for each turn.
template <typename MAKE>
Contestant makeTableContestant(std::string const &name, MAKE make) {
    auto const made = std::make_shared<MadePatches>();
    Contestant contestant;
    contestant.name = name;
    contestant.work = [=] { *made = make(); };
    contestant.validate = [=] {
        Require(made->table != nullptr, name + ": no patches");
        return double(made->table->GetNumPatchesTotal());
    };
    contestant.release = [=] { *made = MadePatches(); };
    return contestant;
}

/// Far's patches are fewer and, where the mesh is regular, need no points: no row promises a ratio.
Contest makeTableContest(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner> const refiner = MakeFullyRefined(mesh);
    std::shared_ptr<Far::TopologyRefiner> const farRefiner = MakeFarBase(mesh);
    // Catmull-Clark's patches are quads, which other faces have from level 1 on.
    Far::PatchTableFactory::Options options(unsigned(std::max(mesh.level - 1, 1)));
    options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
    farRefiner->RefineAdaptive(options.GetRefineAdaptiveOptions());
    Contest contest;
    contest.contestants = {
        makeTableContestant(
            "FarExt::PatchTableFactory",
            [=]() -> MadePatches {
                return {FarExt::PatchTableFactory::Create(*refiner, mesh.level - 1), nullptr};
            }),
        makeTableContestant("Far::PatchTableFactory",
                            [=] { return makeFarPatches(*farRefiner, options); })};
    return contest;
}

} // namespace

void AddPatchBenchmarks(Suite &suite) {
    for (BenchMesh mesh : suite.GetMeshes()) {
        // Refined by a level more than the patches are of, whose points take kilobytes each.
        mesh.level = std::min(mesh.level, mesh.size == "small" ? 3 : 2);
        suite.AddContest({"patches, in order", "place", mesh, Memory::Resident},
                         [=] { return makeEvaluationContest(mesh, false); });
        suite.AddContest({"patches, in random order", "place", mesh, Memory::Resident},
                         [=] { return makeEvaluationContest(mesh, true); });
        suite.AddContest({"patches, made", "patch", mesh, Memory::Default},
                         [=] { return makeTableContest(mesh); });
    }
}

} // namespace OpenSubdivHex::Regression

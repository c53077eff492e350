// SPDX-License-Identifier: Apache-2.0
//
// Topology with all incidences and positions of the last level, against the meshes of OpenMesh and
// CGAL: nanoseconds per vertex of the last level.  All begin with a base mesh of their own, for the
// peers a copy, since they subdivide in place.
#include "makers.h"
#include "meshes.h"
#include "subdivisionPeer.h"

#include "osd_ext/refinementEvaluator.h"

#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <cmath>

namespace OpenSubdivHex::Regression {
namespace {

Contestant makeOwn(BenchMesh const &mesh) {
    struct State {
        std::vector<float> controlPositions;
        std::unique_ptr<FarExt::TopologyRefiner> refiner;
        std::unique_ptr<Osd::CpuVertexBuffer> positions;
    };
    auto const state = std::make_shared<State>();
    state->controlPositions.assign(mesh.shape->positions.begin(), mesh.shape->positions.end());

    Contestant contestant;
    contestant.name = "FarExt, OsdExt";
    contestant.prepare = [=] { state->refiner = MakeBase(mesh); };
    contestant.work = [=] {
        FarExt::TopologyRefiner::UniformOptions options(mesh.level);
        options.fullTopologyInLastLevel = true;
        Require(state->refiner->RefineUniform(options), "not refined");
        auto const evaluator = OsdExt::RefinementEvaluator::Create(*state->refiner);
        Osd::BufferDescriptor const desc(0, 3, 3);
        state->positions.reset(
            Osd::CpuVertexBuffer::Create(3, evaluator->GetNumElements(mesh.level)));
        Require(evaluator->Evaluate(state->controlPositions.data(), desc,
                                    state->positions->BindCpuBuffer(), desc, mesh.level),
                "not evaluated");
    };
    contestant.validate = [=] {
        int const numVertices = state->refiner->GetLevel(mesh.level).GetNumVertices();
        float const *const positions = state->positions->BindCpuBuffer();
        for (std::size_t i = 0; i < 3 * std::size_t(numVertices); ++i) {
            Require(std::abs(positions[i]) < 2, "a position outside of its control mesh");
        }
        return double(numVertices);
    };
    contestant.release = [=] {
        state->refiner.reset();
        state->positions.reset();
    };
    return contestant;
}

Contestant makePeer(std::string const &name, std::shared_ptr<SubdivisionPeer> const &peer,
                    int level, double numVertices) {
    Contestant contestant;
    contestant.name = name;
    contestant.prepare = [=] { peer->Prepare(); };
    contestant.work = [=] { peer->Subdivide(level); };
    contestant.validate = [=] {
        Require(peer->GetNumVertices() == numVertices, name + ": wrong number of vertices");
        return numVertices;
    };
    contestant.release = [=] { peer->Release(); };
    return contestant;
}

} // namespace

void AddPositionBenchmarks(Suite &suite) {
    for (Memory memory : {Memory::Default, Memory::Warm}) {
        for (BenchMesh const &mesh : suite.GetMeshes()) {
            suite.AddContest({"positions", "vertex", mesh, memory}, [=] {
                Shape const &shape = *mesh.shape;
                Contest contest{
                    {makeOwn(mesh), makePeer("OpenMesh", MakeOpenMeshPeer(shape), mesh.level,
                                             CountCatmarkVertices(shape, mesh.level))},
                    {{"positions-openmesh", 0, {1}}}};
                if (auto cgal = MakeCgalPeer(shape)) {
                    contest.contestants.push_back(
                        makePeer("CGAL", std::move(cgal), mesh.level,
                                 CountDooSabinVertices(shape, mesh.level)));
                    contest.pairings.push_back({"positions-cgal", 0, {2}});
                }
                return contest;
            });
        }
    }
}

} // namespace OpenSubdivHex::Regression

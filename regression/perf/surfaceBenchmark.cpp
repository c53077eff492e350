// SPDX-License-Identifier: Apache-2.0
//
// Surfaces of faces against Bfr's of Catmull-Clark or, of triangles, Loop: nanoseconds per point of a
// tessellation of every face, of a level and of a rate, without and with first derivatives; per surface that is made,
// with a cache that is empty or full; per point of surfaces that are made and evaluated for the first time; per place
// at random, and per face whose patch points are prepared for that.
#include "makers.h"
#include "suite.h"

#include "bfr_ext/patchStream.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <random>

namespace OpenSubdivHex::Regression {
namespace {

namespace Bfr = OpenSubdiv::Bfr;

constexpr int kLevel = 4;
constexpr int kColdLevel = 3;
constexpr int kRate = 8;

using OwnSurface = BfrExt::Surface<float>;
using PeerSurface = Bfr::Surface<float>;

/// The factory of surfaces, and the buffers that they are evaluated from and to.
struct Workspace {
    explicit Workspace(BenchMesh const &mesh)
        : shape(mesh.shape), refiner(MakeBase(mesh)),
          positions(shape->positions.begin(), shape->positions.end()) {
        using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
        bool const isLoop = shape->faceSizes[0] == 3;
        ShapeDescriptor const descriptor(*shape);
        peerRefiner.reset(Factory::Create(
            descriptor.Get(),
            Factory::Options(isLoop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, Sdc::Options())));
        Require(refiner && peerRefiner, "no refiners");
    }

    int GetNumFaces() const { return shape->GetNumFaces(); }

    std::shared_ptr<Shape const> shape;
    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<Far::TopologyRefiner> peerRefiner;
    std::vector<float> positions;
    std::vector<float> gathered;
    std::vector<float> results[3];
    std::vector<int> numPoints; ///< by face, of a stream
};

/// A factory, and the surfaces of all faces.
template <class FACTORY, class SURFACE>
struct Surfaces {
    void Init(int numFaces) {
        surfaces.resize(std::size_t(numFaces));
        for (int face = 0; face < numFaces; ++face) {
            Require(factory->InitVertexSurface(face, &surfaces[std::size_t(face)]), "no surface");
        }
    }

    std::unique_ptr<FACTORY> factory;
    std::vector<SURFACE> surfaces;
};
using OwnSurfaces = Surfaces<BfrExt::SurfaceFactory, OwnSurface>;
using PeerSurfaces = Surfaces<Bfr::RefinerSurfaceFactory<>, PeerSurface>;

/// Makes the surfaces of all faces, of both.
void makeSurfaces(Workspace const &workspace, OwnSurfaces *own, PeerSurfaces *peer) {
    own->factory = BfrExt::SurfaceFactory::Create(*workspace.refiner);
    peer->factory = std::make_unique<Bfr::RefinerSurfaceFactory<>>(*workspace.peerRefiner);
    own->Init(workspace.GetNumFaces());
    peer->Init(workspace.GetNumFaces());
}

/// Evaluates a tessellation of each face, of levels or of rates.
template <class TESSELLATION>
double evaluateOwn(OwnSurfaces const &own, TESSELLATION const &tessellation, bool hasDerivatives,
                   Workspace &workspace) {
    for (OwnSurface const &surface : own.surfaces) {
        float *const gathered = workspace.gathered.data();
        surface.GatherControlPoints(workspace.positions.data(), 3, gathered, 3);
        if (hasDerivatives) {
            surface.Evaluate(tessellation, gathered, 3, workspace.results[0].data(),
                             workspace.results[1].data(), workspace.results[2].data(), 3);
        } else {
            surface.Evaluate(tessellation, gathered, 3, workspace.results[0].data(), 3);
        }
    }
    return double(own.surfaces.size()) * tessellation.GetNumCoords();
}

/// Evaluates the places of each face at some (u, v).
double evaluatePlaces(PeerSurfaces const &peer, std::vector<float> const &coords,
                      bool hasDerivatives, Workspace &workspace) {
    for (PeerSurface const &surface : peer.surfaces) {
        float *const gathered = workspace.gathered.data();
        surface.PreparePatchPoints(workspace.positions.data(), 3, gathered, 3);
        float *results[3];
        for (std::size_t i = 0; i < 3; ++i) {
            results[i] = workspace.results[i].data();
        }
        for (std::size_t i = 0; i < coords.size(); i += 2) {
            if (hasDerivatives) {
                surface.Evaluate(&coords[i], gathered, 3, results[0], results[1], results[2]);
            } else {
                surface.Evaluate(&coords[i], gathered, 3, results[0]);
            }
            for (float *&result : results) {
                result += 3;
            }
        }
    }
    return double(peer.surfaces.size() * coords.size() / 2);
}

/// About so many places inside of a face.
std::vector<float> makeCoords(PeerSurface const &surface, int numPlaces) {
    // In a square in the corner of a triangle, or of the first sub-face of a larger face.
    float const width = surface.GetFaceSize() == 4 ? 1.0F : 0.5F;
    int const numSteps = int(std::lround(std::sqrt(double(numPlaces))));
    std::vector<float> coords;
    for (int i = 0; i < numSteps * numSteps; ++i) {
        coords.push_back(width * (float(i % numSteps) + 0.5F) / float(numSteps));
        coords.push_back(width * (float(i / numSteps) + 0.5F) / float(numSteps));
    }
    return coords;
}

/// Evaluates with the stencils of one face, which all faces share where the mesh is regular.
double evaluateStencils(PeerSurfaces const &peer, std::vector<float> const &stencils,
                        Workspace &workspace) {
    auto const numPoints = std::size_t(peer.surfaces[0].GetNumControlPoints());
    for (PeerSurface const &surface : peer.surfaces) {
        float *const gathered = workspace.gathered.data();
        surface.GatherControlPoints(workspace.positions.data(), 3, gathered, 3);
        float *p = workspace.results[0].data();
        for (std::size_t first = 0; first < stencils.size(); first += numPoints, p += 3) {
            surface.ApplyStencil(&stencils[first], gathered, 3, p);
        }
    }
    return double(peer.surfaces.size()) * double(stencils.size()) / double(numPoints);
}

/// Makes the stencils of some places.
std::vector<float> makeStencils(PeerSurfaces const &peer, std::vector<float> const &coords) {
    PeerSurface const &surface = peer.surfaces[0];
    auto const numPoints = std::size_t(surface.GetNumControlPoints());
    std::vector<float> stencils(numPoints * (coords.size() / 2));
    for (std::size_t i = 0; i < coords.size(); i += 2) {
        surface.EvaluateStencil(&coords[i], &stencils[numPoints * (i / 2)]);
    }
    for (PeerSurface const &other : peer.surfaces) {
        Require(other.GetNumControlPoints() == surface.GetNumControlPoints(), "irregular faces");
    }
    return stencils;
}

/// Streams all faces to a sink that looks at one number of each.  Threads share nothing that one of them writes.
double evaluateStream(BfrExt::PatchStream<float> const &stream, Workspace &workspace) {
    std::vector<int> &numPoints = workspace.numPoints;
    numPoints.assign(std::size_t(workspace.GetNumFaces()), 0);
    bool const isDone = stream.Run(workspace.positions.data(), 3, [&](auto const &patch) {
        numPoints[std::size_t(patch.face)] += patch.tessellation.GetNumCoords();
        return std::isfinite(patch.points[0]);
    });
    Require(isDone, "no stream");
    return std::accumulate(numPoints.begin(), numPoints.end(), 0.0);
}

/// The room that all faces have enough of.
void takeRoom(OwnSurfaces const &own, PeerSurfaces const &peer, int numPlaces,
              Workspace &workspace) {
    std::size_t numPoints = 0;
    for (OwnSurface const &surface : own.surfaces) {
        numPoints = std::max(numPoints, std::size_t(surface.GetNumControlPoints()));
    }
    for (PeerSurface const &surface : peer.surfaces) {
        numPoints = std::max(numPoints, std::size_t(surface.GetNumPatchPoints()));
    }
    workspace.gathered.resize(3 * numPoints);
    for (std::vector<float> &result : workspace.results) {
        result.resize(3 * 2 * std::size_t(numPlaces));
    }
}

/// \param evaluate  gives the number of points that it makes
template <typename EVALUATE>
Contestant makePointContestant(std::string const &name, std::shared_ptr<Workspace> const &workspace,
                               EVALUATE evaluate, int numThreads = 1) {
    auto const count = std::make_shared<double>(0);
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    contestant.work = [=] { *count = evaluate(); };
    contestant.validate = [=] {
        for (std::size_t i = 0; i < 3; ++i) {
            Require(std::isfinite(workspace->results[0][i]), name + ": no point");
        }
        return *count;
    };
    return contestant;
}

/// \param isRegular  whether all faces have the same stencils
Contest makePointContest(BenchMesh const &mesh, bool isRegular) {
    auto const workspace = std::make_shared<Workspace>(mesh);
    auto const own = std::make_shared<OwnSurfaces>();
    auto const peer = std::make_shared<PeerSurfaces>();
    makeSurfaces(*workspace, own.get(), peer.get());
    auto const tessellation =
        std::make_shared<BfrExt::LevelTessellation>(own->surfaces[0].GetParameterization(), kLevel);
    int const numPlaces = tessellation->GetNumCoords();
    for (OwnSurface const &surface : own->surfaces) {
        Require(surface.GetFaceSize() == tessellation->GetFaceSize(), "faces of several sizes");
    }
    takeRoom(*own, *peer, numPlaces, *workspace);
    auto const coords =
        std::make_shared<std::vector<float>>(makeCoords(peer->surfaces[0], numPlaces));
    Contest contest;
    for (bool const hasDerivatives : {false, true}) {
        std::string const suffix = hasDerivatives ? ", derivatives" : "";
        contest.contestants.push_back(
            makePointContestant("BfrExt::Surface" + suffix, workspace, [=] {
                return evaluateOwn(*own, *tessellation, hasDerivatives, *workspace);
            }));
        contest.contestants.push_back(makePointContestant("Bfr::Surface" + suffix, workspace, [=] {
            return evaluatePlaces(*peer, *coords, hasDerivatives, *workspace);
        }));
    }
    auto const stream =
        std::make_shared<BfrExt::PatchStream<float>>(*own->factory, BfrExt::PatchLevels(kLevel));
    for (int const numThreads : {1, 2}) {
        contest.contestants.push_back(makePointContestant(
            "BfrExt::PatchStream", workspace,
            [=] {
                static_cast<void>(own); // whose factory the stream has
                return evaluateStream(*stream, *workspace);
            },
            numThreads));
    }
    contest.pairings = {{"surface-points", 0, {1}},
                        {"surface-derivatives", 2, {3}},
                        {"stream-1", 4, {1}},
                        {"stream-2", 5, {4}}};
    if (isRegular) {
        auto const stencils = std::make_shared<std::vector<float>>(makeStencils(*peer, *coords));
        contest.contestants.push_back(
            makePointContestant("Bfr::Surface, stencils kept", workspace,
                                [=] { return evaluateStencils(*peer, *stencils, *workspace); }));
        contest.pairings.push_back({"surface-stencils", 0, {6}});
        contest.pairings.push_back({"stream-stencils", 4, {6}});
    }
    return contest;
}

/// Both evaluate one tessellation, by a rate.
Contest makeRateContest(BenchMesh const &mesh, bool isRegular) {
    auto const workspace = std::make_shared<Workspace>(mesh);
    auto const own = std::make_shared<OwnSurfaces>();
    auto const peer = std::make_shared<PeerSurfaces>();
    makeSurfaces(*workspace, own.get(), peer.get());
    auto const tessellation =
        std::make_shared<Bfr::Tessellation>(own->surfaces[0].GetParameterization(), kRate);
    takeRoom(*own, *peer, tessellation->GetNumCoords(), *workspace);
    auto const coords =
        std::make_shared<std::vector<float>>(2 * std::size_t(tessellation->GetNumCoords()));
    tessellation->GetCoords(coords->data());
    Contest contest;
    for (bool const hasDerivatives : {false, true}) {
        std::string const suffix = hasDerivatives ? ", derivatives" : "";
        contest.contestants.push_back(
            makePointContestant("BfrExt::Surface" + suffix, workspace, [=] {
                return evaluateOwn(*own, *tessellation, hasDerivatives, *workspace);
            }));
        contest.contestants.push_back(makePointContestant("Bfr::Surface" + suffix, workspace, [=] {
            return evaluatePlaces(*peer, *coords, hasDerivatives, *workspace);
        }));
    }
    contest.pairings = {{"surface-rate", 0, {1}}, {"surface-rate-derivatives", 2, {3}}};
    if (isRegular) {
        contest.pairings.push_back({"surface-rate-regular", 0, {1}});
    }
    return contest;
}

/// Factories that have found nothing, the surfaces of all faces, and the points of a tessellation of each.
Contest makeColdContest(BenchMesh const &mesh) {
    auto const workspace = std::make_shared<Workspace>(mesh);
    auto const own = std::make_shared<OwnSurfaces>();
    auto const peer = std::make_shared<PeerSurfaces>();
    auto const initOwn = [=] {
        own->factory = BfrExt::SurfaceFactory::Create(*workspace->refiner);
        own->Init(workspace->GetNumFaces());
    };
    auto const initPeer = [=] {
        peer->factory = std::make_unique<Bfr::RefinerSurfaceFactory<>>(*workspace->peerRefiner);
        peer->Init(workspace->GetNumFaces());
    };
    initOwn();
    initPeer();
    auto const tessellation = std::make_shared<BfrExt::LevelTessellation>(
        own->surfaces[0].GetParameterization(), kColdLevel);
    int const numPlaces = tessellation->GetNumCoords();
    takeRoom(*own, *peer, numPlaces, *workspace);
    auto const coords =
        std::make_shared<std::vector<float>>(makeCoords(peer->surfaces[0], numPlaces));
    Contest contest;
    contest.contestants.push_back(makePointContestant("BfrExt::Surface, cold", workspace, [=] {
        initOwn();
        return evaluateOwn(*own, *tessellation, false, *workspace);
    }));
    contest.contestants.push_back(makePointContestant("Bfr::Surface, cold", workspace, [=] {
        initPeer();
        return evaluatePlaces(*peer, *coords, false, *workspace);
    }));
    contest.pairings = {{"surface-evaluation-cold", 0, {1}}};
    return contest;
}

/// \param isCold  whether each turn makes a factory, which has found nothing
template <class SURFACES, typename MAKE>
Contestant makeInitContestant(std::string const &name, std::shared_ptr<Workspace> const &workspace,
                              MAKE makeFactory, bool isCold) {
    auto const surfaces = std::make_shared<SURFACES>();
    int const numFaces = workspace->GetNumFaces();
    surfaces->factory = makeFactory();
    surfaces->Init(numFaces);
    Contestant contestant;
    contestant.name = name;
    contestant.work = [=] {
        if (isCold) {
            surfaces->factory = makeFactory();
        }
        surfaces->Init(numFaces);
    };
    contestant.validate = [=] {
        Require(surfaces->surfaces.back().IsValid(), name + ": no surface");
        return double(numFaces);
    };
    return contestant;
}

Contest makeInitContest(BenchMesh const &mesh) {
    auto const workspace = std::make_shared<Workspace>(mesh);
    auto const makeOwn = [=] { return BfrExt::SurfaceFactory::Create(*workspace->refiner); };
    auto const makePeer = [=] {
        return std::make_unique<Bfr::RefinerSurfaceFactory<>>(*workspace->peerRefiner);
    };
    Contest contest;
    for (bool const isCold : {true, false}) {
        std::string const suffix = isCold ? ", cold" : ", warm";
        contest.contestants.push_back(makeInitContestant<OwnSurfaces>(
            "BfrExt::SurfaceFactory" + suffix, workspace, makeOwn, isCold));
        contest.contestants.push_back(makeInitContestant<PeerSurfaces>(
            "Bfr::SurfaceFactory" + suffix, workspace, makePeer, isCold));
    }
    contest.pairings = {{"surface-cold", 0, {1}}, {"surface-warm", 2, {3}}};
    return contest;
}

/// The patch points of all faces, and places of them in random order.
struct Places {
    static constexpr std::size_t kNumPerFace = 16;

    /// \param width  of the square that places lie in
    template <class SURFACES>
    void Init(SURFACES const &own, float width) {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> coordinate(0, width);
        for (std::size_t face = 0; face < own.surfaces.size(); ++face) {
            faces.insert(faces.end(), kNumPerFace, int(face));
            firstPoints.push_back(numPoints);
            numPoints += std::size_t(own.surfaces[face].GetNumPatchPoints());
        }
        std::shuffle(faces.begin(), faces.end(), random);
        std::generate_n(std::back_inserter(uvs), 2 * faces.size(),
                        [&] { return coordinate(random); });
        patchPoints.resize(3 * numPoints);
    }

    template <class SURFACES>
    double Prepare(SURFACES const &own, std::vector<float> const &positions) {
        for (std::size_t face = 0; face < own.surfaces.size(); ++face) {
            own.surfaces[face].PreparePatchPoints(positions.data(), 3,
                                                  &patchPoints[3 * firstPoints[face]], 3);
        }
        return double(own.surfaces.size());
    }

    template <class SURFACES>
    double Evaluate(SURFACES const &own, std::vector<float> (&results)[3]) const {
        for (std::size_t i = 0; i < faces.size(); ++i) {
            auto const face = std::size_t(faces[i]);
            own.surfaces[face].Evaluate(&uvs[2 * i], &patchPoints[3 * firstPoints[face]], 3,
                                        &results[0][3 * i], &results[1][3 * i], &results[2][3 * i]);
        }
        return double(faces.size());
    }

    std::vector<int> faces;
    std::vector<float> uvs;
    std::vector<std::size_t> firstPoints; ///< by face
    std::size_t numPoints = 0;
    std::vector<float> patchPoints;
};

Contest makePlacesContest(BenchMesh const &mesh) {
    auto const workspace = std::make_shared<Workspace>(mesh);
    auto const own = std::make_shared<OwnSurfaces>();
    auto const peer = std::make_shared<PeerSurfaces>();
    makeSurfaces(*workspace, own.get(), peer.get());
    // The corner of a triangle, or of the first sub-face of a larger face, and of its neighbours.
    float const width = own->surfaces[0].GetFaceSize() == 4 ? 1.0F : 0.5F;
    Contest contest;
    auto const add = [&](std::string const &name, auto const &surfaces) {
        auto const places = std::make_shared<Places>();
        places->Init(*surfaces, width);
        places->Prepare(*surfaces, workspace->positions);
        for (std::vector<float> &result : workspace->results) {
            result.resize(3 * places->faces.size());
        }
        contest.contestants.push_back(makePointContestant(
            name, workspace, [=] { return places->Evaluate(*surfaces, workspace->results); }));
        contest.contestants.push_back(makePointContestant(name + ", patch points", workspace, [=] {
            return places->Prepare(*surfaces, workspace->positions);
        }));
    };
    add("BfrExt::Surface", own);
    add("Bfr::Surface", peer);
    contest.pairings = {{"surface-places", 0, {2}}, {"surface-patch-points", 1, {3}}};
    return contest;
}

} // namespace

void AddSurfaceBenchmarks(Suite &suite) {
    auto const add = [&](BenchMesh const &mesh, bool isRegular) {
        suite.AddContest({"surfaces, level 4", "point", mesh, Memory::Resident},
                         [=] { return makePointContest(mesh, isRegular); });
        suite.AddContest({"places of surfaces", "place", mesh, Memory::Resident},
                         [=] { return makePlacesContest(mesh); });
        suite.AddContest({"surfaces, rate 8", "point", mesh, Memory::Resident},
                         [=] { return makeRateContest(mesh, isRegular); });
        for (Memory memory : {Memory::Default, Memory::Warm}) {
            suite.AddContest({"making surfaces", "surface", mesh, memory},
                             [=] { return makeInitContest(mesh); });
            // Types of irregular meshes take seconds to make, wherever memory comes from.
            if (isRegular || memory == Memory::Default) {
                suite.AddContest({"surfaces, level 3, empty cache", "point", mesh, memory},
                                 [=] { return makeColdContest(mesh); });
            }
        }
    };
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        add(mesh, true);
    }
    for (BenchMesh const &mesh : suite.GetIrregularMeshes()) {
        add(mesh, false);
    }
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
//
// The drawing of a level, and the base faces of what is drawn.
#include "makers.h"

#include "far_ext/baseFaceMap.h"
#include "osd_ext/polygonIndices.h"

namespace OpenSubdivHex::Regression {
namespace {

/// The polygons of the last level, with hexagons cut where base faces meet.
Contestant makePolygons(std::shared_ptr<FarExt::TopologyRefiner const> const &refiner,
                        int numThreads) {
    auto const polygons = std::make_shared<OsdExt::PolygonIndices>();
    Contestant contestant;
    contestant.name = "OsdExt";
    contestant.numThreads = numThreads;
    contestant.work = [=] {
        *polygons = OsdExt::CreatePolygonIndices(refiner->GetLevel(refiner->GetMaxLevel()));
    };
    contestant.validate = [=] {
        FarExt::TopologyLevel const &level = refiner->GetLevel(refiner->GetMaxLevel());
        Require(polygons->GetNumPolygons() > level.GetNumFaces() &&
                    polygons->vertices.size() > std::size_t(level.GetNumFaceVertices()),
                "no hexagon was cut");
        return double(polygons->vertices.size());
    };
    contestant.release = [=] { *polygons = OsdExt::PolygonIndices(); };
    return contestant;
}

/// Code as users of Far write it: index buffers filled face by face, with the base face of each.
Contestant makeFarPolygons(std::shared_ptr<Far::TopologyRefiner const> const &refiner) {
    auto const polygons = std::make_shared<OsdExt::PolygonIndices>();
    Contestant contestant;
    contestant.name = "Far";
    contestant.work = [=] {
        int const maxLevel = refiner->GetMaxLevel();
        Far::TopologyLevel const &level = refiner->GetLevel(maxLevel);
        auto const numFaces = std::size_t(level.GetNumFaces());
        polygons->sizes.reserve(numFaces);
        polygons->faces.reserve(numFaces);
        polygons->baseFaces.reserve(numFaces);
        polygons->vertices.reserve(std::size_t(level.GetNumFaceVertices()));
        for (Far::Index face = 0; face < level.GetNumFaces(); ++face) {
            Far::ConstIndexArray const vertices = level.GetFaceVertices(face);
            polygons->sizes.push_back(vertices.size());
            polygons->vertices.insert(polygons->vertices.end(), vertices.begin(), vertices.end());
            polygons->faces.push_back(face);
            Far::Index baseFace = face;
            for (int depth = maxLevel; depth > 0; --depth) {
                baseFace = refiner->GetLevel(depth).GetFaceParentFace(baseFace);
            }
            polygons->baseFaces.push_back(baseFace);
        }
    };
    contestant.validate = [=] {
        Far::TopologyLevel const &level = refiner->GetLevel(refiner->GetMaxLevel());
        Require(polygons->vertices.size() == std::size_t(level.GetNumFaceVertices()),
                "not all faces");
        return double(polygons->vertices.size());
    };
    contestant.release = [=] { *polygons = OsdExt::PolygonIndices(); };
    return contestant;
}

Contest makePolygonContest(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner const> const refiner = MakeRefined(mesh);
    std::shared_ptr<Far::TopologyRefiner const> const farRefiner = MakeFarRefined(mesh);
    return {{makePolygons(refiner, 1), makePolygons(refiner, 2), makeFarPolygons(farRefiner)},
            {{"polygons-1", 0, {2}}, {"polygons-2", 1, {2}}}};
}

Contestant makeMap(std::shared_ptr<FarExt::TopologyRefiner const> const &refiner) {
    auto const map = std::make_shared<std::unique_ptr<FarExt::BaseFaceMap>>();
    Contestant contestant;
    contestant.name = "FarExt::BaseFaceMap";
    contestant.work = [=] { *map = std::make_unique<FarExt::BaseFaceMap>(*refiner); };
    contestant.validate = [=] {
        Require(!(*map)->GetSplitFaces().empty(), "no face is split");
        return double((*map)->GetNumFaces());
    };
    contestant.release = [=] { map->reset(); };
    return contestant;
}

/// The map beside the refinement of the levels that it is of, for each face of the last.
Contest makeMapContest(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner const> const refiner = MakeRefined(mesh);
    Contestant refinement = MakeTopologyContestant(mesh, false, 1);
    refinement.validate = [validate = refinement.validate, refiner] {
        validate();
        return double(refiner->GetLevel(refiner->GetMaxLevel()).GetNumFaces());
    };
    return {{makeMap(refiner), refinement}, {{"base-face-map", 0, {1}}}};
}

} // namespace

void AddDrawingBenchmarks(Suite &suite) {
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        for (Memory memory : {Memory::Default, Memory::Warm}) {
            suite.AddContest({"polygons", "corner", mesh, memory},
                             [=] { return makePolygonContest(mesh); });
            suite.AddContest({"base faces", "face", mesh, memory},
                             [=] { return makeMapContest(mesh); });
        }
    }
}

} // namespace OpenSubdivHex::Regression

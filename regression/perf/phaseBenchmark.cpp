// SPDX-License-Identifier: Apache-2.0
//
// The phases around refinement: base levels, which are validated on the way, from descriptors, mesh
// classes and refiners; and, for which nothing is promised, positions by the primvar refiners.
#include "makers.h"
#include "meshes.h"

#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/far_ext/shapeFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/primvarRefiner.h>

#include <vector>

namespace OpenSubdivHex::Regression {
namespace {

/// A base level for each turn, made by \p make.
template <typename MAKE>
Contestant makeBaseLevel(std::string const &name, int numThreads, MAKE make) {
    auto const refiner = std::make_shared<decltype(make())>();
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    contestant.work = [=] { *refiner = make(); };
    contestant.validate = [=] {
        Require(*refiner != nullptr, name + ": no base level");
        return double((*refiner)->GetLevel(0).GetNumVertices());
    };
    contestant.release = [=] { refiner->reset(); };
    return contestant;
}

Contest makeBaseLevels(BenchMesh const &mesh) {
    auto const fromDescriptor = [=] {
        ShapeDescriptor const descriptor(*mesh.shape);
        return FarExt::TopologyRefinerFactory::Create(descriptor.Get());
    };
    std::shared_ptr<Far::TopologyRefiner const> const base = MakeFarBase(mesh);
    Contest contest;
    contest.contestants = {
        makeBaseLevel("Far", 1, [=] { return MakeFarBase(mesh); }),
        makeBaseLevel("FarExt, descriptor", 1, fromDescriptor),
        makeBaseLevel("FarExt, mesh class", 1,
                      [=] { return FarExt::MeshRefinerFactory<Shape>::Create(*mesh.shape); }),
        makeBaseLevel("FarExt, refiner", 1,
                      [=] { return FarExt::TopologyRefinerFactory::Create(*base); }),
        makeBaseLevel("FarExt, descriptor", 2, fromDescriptor)};
    contest.pairings = {{"base-descriptor-1", 1, {0}},
                        {"base-mesh-1", 2, {0}},
                        {"base-refiner-1", 3, {0}},
                        {"base-descriptor-2", 4, {0}}};
    return contest;
}

/// Returns the mesh with texture coordinates: two charts of half the faces each.
BenchMesh addCharts(BenchMesh const &mesh) {
    auto const shape = std::make_shared<Shape>(*mesh.shape);
    int const numVertices = shape->GetNumVertices();
    FVarChannel channel;
    channel.values.resize(2 * 2 * std::size_t(numVertices));
    channel.valueIndices = shape->faceVertices;
    for (std::size_t i = channel.valueIndices.size() / 2; i < channel.valueIndices.size(); ++i) {
        channel.valueIndices[i] += numVertices;
    }
    shape->fvarChannels = {channel};
    BenchMesh result = mesh;
    result.shape = shape;
    return result;
}

Contest makeBaseLevelsWithCharts(BenchMesh const &plainMesh) {
    BenchMesh const mesh = addCharts(plainMesh);
    auto const fromDescriptor = [=] {
        ShapeDescriptor const descriptor(*mesh.shape);
        return FarExt::TopologyRefinerFactory::Create(descriptor.Get());
    };
    return {{makeBaseLevel("Far", 1, [=] { return MakeFarBase(mesh); }),
             makeBaseLevel("FarExt, descriptor", 1, fromDescriptor),
             makeBaseLevel("FarExt, descriptor", 2, fromDescriptor)},
            {{"base-channel-1", 1, {0}}, {"base-channel-2", 2, {0}}}};
}

struct Point {
    void Clear() { x = y = z = 0; }
    void AddWithWeight(Point const &point, float weight) {
        x += weight * point.x;
        y += weight * point.y;
        z += weight * point.z;
    }
    float x, y, z;
};

/// All levels, in arrays that stay.
template <class PRIMVAR_REFINER, class REFINER>
Contestant makePrimvars(std::string const &name, std::shared_ptr<REFINER const> const &refiner) {
    auto const levels = std::make_shared<std::vector<std::vector<Point>>>();
    double numPoints = 0;
    for (int level = 0; level < refiner->GetNumLevels(); ++level) {
        levels->emplace_back(refiner->GetLevel(level).GetNumVertices(), Point{1, 1, 1});
        numPoints += level > 0 ? double(levels->back().size()) : 0;
    }
    Contestant contestant;
    contestant.name = name;
    contestant.movedBytes = (2 * numPoints - double(levels->back().size())) * double(sizeof(Point));
    contestant.work = [=] {
        PRIMVAR_REFINER const primvarRefiner(*refiner);
        for (std::size_t level = 1; level < levels->size(); ++level) {
            primvarRefiner.Interpolate(int(level), (*levels)[level - 1], (*levels)[level]);
        }
    };
    contestant.validate = [=] {
        for (Point const &point : levels->back()) {
            Require(point.x > 0.999f && point.x < 1.001f, name + ": weights do not sum to 1");
        }
        return numPoints;
    };
    return contestant;
}

Contest makePrimvarContest(BenchMesh const &mesh) {
    std::shared_ptr<FarExt::TopologyRefiner const> const refiner = MakeRefined(mesh);
    std::shared_ptr<Far::TopologyRefiner const> const farRefiner = MakeFarRefined(mesh);
    return {{makePrimvars<FarExt::PrimvarRefiner>("FarExt::PrimvarRefiner", refiner),
             makePrimvars<Far::PrimvarRefiner>("Far::PrimvarRefiner", farRefiner)},
            {}};
}

} // namespace

void AddPhaseBenchmarks(Suite &suite) {
    for (BenchMesh const &mesh : suite.GetBaseMeshes()) {
        for (Memory memory : {Memory::Default, Memory::Warm}) {
            suite.AddContest({"base level", "vertex", mesh, memory},
                             [=] { return makeBaseLevels(mesh); });
            suite.AddContest({"base level with charts", "vertex", mesh, memory},
                             [=] { return makeBaseLevelsWithCharts(mesh); });
        }
    }
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        suite.AddContest({"primvars, length 3", "vertex", mesh, Memory::Resident},
                         [=] { return makePrimvarContest(mesh); });
    }
}

} // namespace OpenSubdivHex::Regression

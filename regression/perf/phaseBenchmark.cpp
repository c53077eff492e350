// SPDX-License-Identifier: Apache-2.0
//
// The phases for which nothing is promised: base levels, which are validated on the way, from a
// Far::TopologyDescriptor, and positions by the primvar refiners.
#include "makers.h"
#include "meshes.h"

#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/primvarRefiner.h>

#include <vector>

namespace OpenSubdivHex::Regression {
namespace {

/// A base level for each turn, made by \p make.
template <typename MAKE>
Contestant makeBaseLevel(std::string const &name, MAKE make) {
    auto const refiner = std::make_shared<decltype(make())>();
    Contestant contestant;
    contestant.name = name;
    contestant.work = [=] { *refiner = make(); };
    contestant.validate = [=] {
        Require(*refiner != nullptr, name + ": no base level");
        return double((*refiner)->GetLevel(0).GetNumVertices());
    };
    contestant.release = [=] { refiner->reset(); };
    return contestant;
}

Contest makeBaseLevels(BenchMesh const &mesh) {
    return {{makeBaseLevel("FarExt",
                           [=] {
                               ShapeDescriptor const descriptor(*mesh.shape);
                               return FarExt::TopologyRefinerFactory::Create(descriptor.Get());
                           }),
             makeBaseLevel("Far", [=] { return MakeFarBase(mesh); })},
            {}};
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
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        suite.AddContest({"base level", "vertex", mesh, Memory::Default},
                         [=] { return makeBaseLevels(mesh); });
        suite.AddContest({"primvars, length 3", "vertex", mesh, Memory::Resident},
                         [=] { return makePrimvarContest(mesh); });
    }
}

} // namespace OpenSubdivHex::Regression

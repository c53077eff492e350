// SPDX-License-Identifier: Apache-2.0
#include "makers.h"

#include "meshes.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/stencilTableFactory.h>

#include <stdexcept>

namespace OpenSubdivHex::Regression {

void Require(bool condition, std::string const &what) {
    if (!condition) {
        throw std::runtime_error(what);
    }
}

std::unique_ptr<FarExt::TopologyRefiner> MakeBase(BenchMesh const &mesh,
                                                  FarExt::FaceMask faceMask) {
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask = faceMask;
    auto refiner = FarExt::TopologyRefinerFactory::Create(*MakeFarBase(mesh), options);
    Require(refiner != nullptr, "no base level");
    return refiner;
}

std::unique_ptr<Far::TopologyRefiner> MakeFarBase(BenchMesh const &mesh) {
    auto refiner = CreateFarRefiner(*mesh.shape);
    Require(refiner != nullptr, "no base level of Far");
    return refiner;
}

std::unique_ptr<FarExt::TopologyRefiner> MakeRefined(BenchMesh const &mesh,
                                                     FarExt::FaceMask faceMask) {
    auto refiner = MakeBase(mesh, faceMask);
    Require(refiner->RefineUniform(mesh.level), "not refined");
    return refiner;
}

std::unique_ptr<FarExt::TopologyRefiner> MakeFullyRefined(BenchMesh const &mesh) {
    auto refiner = MakeBase(mesh);
    FarExt::TopologyRefiner::UniformOptions options(mesh.level);
    options.fullTopologyInLastLevel = true;
    Require(refiner->RefineUniform(options), "not refined");
    return refiner;
}

std::unique_ptr<Far::TopologyRefiner> MakeFarRefined(BenchMesh const &mesh) {
    auto refiner = MakeFarBase(mesh);
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(mesh.level));
    return refiner;
}

Table MakeTable(FarExt::TopologyRefiner const &refiner) {
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    return FarExt::StencilTableFactory::Create(refiner, options);
}

Table MakeFarTable(Far::TopologyRefiner const &refiner) {
    Far::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    options.generateOffsets = true;
    return Table(Far::StencilTableFactory::Create(refiner, options));
}

double GetNumBytes(Far::StencilTable const &table) {
    auto const numBytes = [](auto const &array) { return double(array.size()) * sizeof(array[0]); };
    return numBytes(table.GetSizes()) + numBytes(table.GetOffsets()) +
           numBytes(table.GetControlIndices()) + numBytes(table.GetWeights());
}

namespace {

/// The vertices of a closed mesh at its level: E' = 4E, V' = V + 2E.
double countVertices(BenchMesh const &mesh) {
    double numVertices = mesh.shape->GetNumVertices();
    double numEdges = CountEdges(*mesh.shape);
    for (int i = 0; i < mesh.level; ++i) {
        numVertices += 2 * numEdges;
        numEdges *= 4;
    }
    return numVertices;
}

/// A refiner with the base level for each turn.
template <typename REFINER, typename MAKE_BASE, typename REFINE>
Contestant makeRefinement(std::string const &name, int numThreads, BenchMesh const &mesh,
                          double numVertices, MAKE_BASE makeBase, REFINE refine) {
    auto const refiner = std::make_shared<std::unique_ptr<REFINER>>();
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    contestant.prepare = [=] { *refiner = makeBase(mesh); };
    contestant.work = [=] { refine(**refiner); };
    contestant.validate = [=] {
        Require((*refiner)->GetLevel(mesh.level).GetNumVertices() == numVertices,
                name + ": wrong number of vertices");
        return numVertices;
    };
    contestant.release = [=] { refiner->reset(); };
    return contestant;
}

/// A table for each turn, made from a refiner that stays.
template <typename REFINER, typename MAKE>
Contestant makeTableContestant(std::string const &name, int numThreads,
                               std::shared_ptr<REFINER> const &refiner, MAKE make) {
    auto const table = std::make_shared<Table>();
    Contestant contestant;
    contestant.name = name;
    contestant.numThreads = numThreads;
    contestant.work = [=] { *table = make(*refiner); };
    contestant.validate = [=] {
        Require(*table && (*table)->GetNumStencils() ==
                              refiner->GetLevel(refiner->GetMaxLevel()).GetNumVertices(),
                name + ": wrong number of stencils");
        return double((*table)->GetWeights().size());
    };
    contestant.release = [=] { table->reset(); };
    return contestant;
}

} // namespace

Contestant MakeTopologyContestant(BenchMesh const &mesh, bool isFull, int numThreads) {
    return makeRefinement<FarExt::TopologyRefiner>(
        "FarExt", numThreads, mesh, countVertices(mesh),
        [](BenchMesh const &base) { return MakeBase(base); },
        [=](FarExt::TopologyRefiner &refiner) {
            FarExt::TopologyRefiner::UniformOptions options(mesh.level);
            options.fullTopologyInLastLevel = isFull;
            Require(refiner.RefineUniform(options), "not refined");
        });
}

Contestant MakeFarTopologyContestant(BenchMesh const &mesh, bool isFull) {
    return makeRefinement<Far::TopologyRefiner>(
        "Far", 1, mesh, CountCatmarkVertices(*mesh.shape, mesh.level), MakeFarBase,
        [=](Far::TopologyRefiner &refiner) {
            Far::TopologyRefiner::UniformOptions options(mesh.level);
            options.fullTopologyInLastLevel = isFull;
            refiner.RefineUniform(options);
        });
}

Contestant MakeTableContestant(std::shared_ptr<FarExt::TopologyRefiner> const &refiner,
                               int numThreads) {
    return makeTableContestant("FarExt", numThreads, refiner, MakeTable);
}

Contestant MakeFarTableContestant(std::shared_ptr<Far::TopologyRefiner> const &refiner) {
    return makeTableContestant("Far", 1, refiner, MakeFarTable);
}

} // namespace OpenSubdivHex::Regression

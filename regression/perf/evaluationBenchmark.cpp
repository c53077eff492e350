// SPDX-License-Identifier: Apache-2.0
//
// The evaluators of OsdExt against those of Osd, on the same table: nanoseconds per stencil.
#include "interleaved.h"
#include "meshes.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/ompEvaluator.h"
#include "osd_ext/stencilEvaluation.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>
#ifdef OPENSUBDIV_HAS_OPENMP
#include <opensubdiv/osd/ompEvaluator.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {
namespace {

using Table = std::unique_ptr<Far::StencilTable const>;
using Buffer = std::unique_ptr<Osd::CpuVertexBuffer>;

Table makeHexTable(Shape const &shape, int level) {
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape));
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    Table table;
    if (refiner && refiner->RefineUniform(level)) {
        table = FarExt::StencilTableFactory::Create(*refiner, options);
    }
    if (!table) {
        throw std::runtime_error("no table for " + shape.name);
    }
    return table;
}

Table makeCatmarkTable(Shape const &shape, int level) {
    auto const refiner = CreateFarRefiner(shape);
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(level));
    Far::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    options.generateOffsets = true;
    return Table(Far::StencilTableFactory::Create(*refiner, options));
}

/// The tables, each made when it is first asked for and kept until another one is.
class TableCache {
public:
    Far::StencilTable const &Get(std::string const &name) {
        if (name != _name) {
            _table.reset();
            _table = make(name);
            _name = name;
        }
        return *_table;
    }

private:
    static Table make(std::string const &name) {
        if (name == "quad5") {
            return makeHexTable(MakeQuadMesh(), 5);
        }
        if (name == "hex4") {
            return makeHexTable(MakeHexMesh(), 4);
        }
        if (name == "quad2") {
            return makeHexTable(MakeQuadMesh(), 2);
        }
        return makeCatmarkTable(MakeQuadMesh(), 5);
    }

    std::string _name;
    Table _table;
};

TableCache &tableCache() {
    static TableCache cache;
    return cache;
}

void setNumThreads([[maybe_unused]] int numThreads) {
#ifdef _OPENMP
    omp_set_num_threads(numThreads);
#endif
}

template <class OWN, class PEER>
void benchmarkEvaluation(benchmark::State &state, std::string const &tableName, int length,
                         int numThreads) {
    Far::StencilTable const &table = tableCache().Get(tableName);
    int const numSources = table.GetNumControlVertices();
    Buffer const src(Osd::CpuVertexBuffer::Create(length, numSources));
    Buffer const ownDst(Osd::CpuVertexBuffer::Create(length, table.GetNumStencils()));
    Buffer const peerDst(Osd::CpuVertexBuffer::Create(length, table.GetNumStencils()));
    std::vector<float> values(std::size_t(length) * std::size_t(numSources));
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = float(i % 1000) / 1000;
    }
    src->UpdateData(values.data(), 0, numSources);

    setNumThreads(numThreads);
    bool isEvaluated = true;
    RunInterleaved(
        state, table.GetNumStencils(),
        [&] {
            isEvaluated = OsdExt::EvalStencils<OWN>(table, src.get(), ownDst.get()) && isEvaluated;
        },
        [&] {
            isEvaluated =
                OsdExt::EvalStencils<PEER>(table, src.get(), peerDst.get()) && isEvaluated;
        });
    if (!isEvaluated) {
        state.SkipWithError("not evaluated");
    }
    state.counters["weights"] = double(table.GetWeights().size()) / table.GetNumStencils();
}

template <class OWN, class PEER>
void registerEvaluation(std::string const &name, std::string const &table, int length,
                        int numThreads) {
    std::string const fullName = "evaluation/" + table + "/length" + std::to_string(length) + "/" +
                                 name + "/threads" + std::to_string(numThreads);
    benchmark::RegisterBenchmark(fullName.c_str(),
                                 [=](benchmark::State &state) {
                                     benchmarkEvaluation<OWN, PEER>(state, table, length,
                                                                    numThreads);
                                 })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] bool const isRegistered = [] {
    for (std::string const table : {"quad5", "hex4", "quad2", "catmark5"}) {
        for (int length : {3, 4, 8}) {
            using OsdExt::CpuEvaluator;
            using OsdExt::OmpEvaluator;
            registerEvaluation<CpuEvaluator, Osd::CpuEvaluator>("CpuVsOsdCpu", table, length, 1);
            if (OmpEvaluator::IsParallel()) {
#ifdef OPENSUBDIV_HAS_OPENMP
                registerEvaluation<OmpEvaluator, Osd::OmpEvaluator>("OmpVsOsdOmp", table, length,
                                                                    2);
#endif
                registerEvaluation<OmpEvaluator, Osd::CpuEvaluator>("OmpVsOsdCpu", table, length,
                                                                    2);
                registerEvaluation<OmpEvaluator, CpuEvaluator>("OmpVsCpu", table, length, 2);
            }
        }
    }
    return true;
}();

} // namespace
} // namespace OpenSubdivHex::Regression

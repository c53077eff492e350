// SPDX-License-Identifier: Apache-2.0
//
// Evaluation without a table against tables of the last level: nanoseconds per vertex of the last
// level, both from the control values.  Own and peer have the same number of threads.
#include "interleaved.h"
#include "meshes.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/ompEvaluator.h"
#include "osd_ext/refinementEvaluator.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {
namespace {

using Buffer = std::unique_ptr<Osd::CpuVertexBuffer>;

/// A refined mesh and its table.
struct Refined {
    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<Far::StencilTable const> table;
};

Refined makeRefined(Shape const &shape, int level, FarExt::FaceMask faceMask) {
    FarExt::TopologyRefinerFactory::Options scheme;
    scheme.schemeOptions.faceMask = faceMask;
    Refined result;
    result.refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape), scheme);
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    if (result.refiner && result.refiner->RefineUniform(level)) {
        result.table = FarExt::StencilTableFactory::Create(*result.refiner, options);
    }
    if (!result.table) {
        throw std::runtime_error("no table for " + shape.name);
    }
    return result;
}

/// Made when first asked for, kept until another one is.
Refined const &getRefined(std::string const &name) {
    static std::string currentName;
    static Refined current;
    if (name != currentName) {
        current = Refined();
        current = name == "quad5"  ? makeRefined(MakeQuadMesh(), 5, FarExt::FaceMask::Average)
                  : name == "hex4" ? makeRefined(MakeHexMesh(), 4, FarExt::FaceMask::Smooth)
                  : name == "tri3" ? makeRefined(MakeTriangleMesh(), 3, FarExt::FaceMask::Cosine)
                                   : makeRefined(MakeQuadMesh(), 3, FarExt::FaceMask::Average);
        currentName = name;
    }
    return current;
}

template <class PEER>
void benchmarkRefinement(benchmark::State &state, std::string const &mesh, int length,
                         int numThreads) {
    Refined const &refined = getRefined(mesh);
    auto const evaluator = OsdExt::RefinementEvaluator::Create(*refined.refiner);
    int const level = evaluator->GetMaxLevel();
    int const numSources = evaluator->GetNumElements(0);
    int const numElements = evaluator->GetNumElements(level);
    Buffer const src(Osd::CpuVertexBuffer::Create(length, numSources));
    Buffer const ownDst(Osd::CpuVertexBuffer::Create(length, numElements));
    Buffer const peerDst(Osd::CpuVertexBuffer::Create(length, numElements));
    std::vector<float> values(std::size_t(length) * std::size_t(numSources));
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = float(i % 1000) / 1000;
    }
    src->UpdateData(values.data(), 0, numSources);
    Osd::BufferDescriptor const desc(0, length, length);

#ifdef _OPENMP
    omp_set_num_threads(numThreads);
#else
    static_cast<void>(numThreads);
#endif
    bool isEvaluated = true;
    RunInterleaved(
        state, numElements,
        [&] {
            isEvaluated =
                evaluator->Evaluate(src.get(), desc, ownDst.get(), desc, level) && isEvaluated;
        },
        [&] {
            isEvaluated =
                PEER::EvalStencils(src.get(), desc, peerDst.get(), desc, refined.table.get()) &&
                isEvaluated;
        });
    if (!isEvaluated) {
        state.SkipWithError("not evaluated");
    }
}

template <class PEER>
void registerRefinement(std::string const &peerName, std::string const &mesh, int length,
                        int numThreads) {
    std::string const fullName = "refinementEvaluation/" + mesh + "/length" +
                                 std::to_string(length) + "/Vs" + peerName + "/threads" +
                                 std::to_string(numThreads);
    benchmark::RegisterBenchmark(fullName.c_str(),
                                 [=](benchmark::State &state) {
                                     benchmarkRefinement<PEER>(state, mesh, length, numThreads);
                                 })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] bool const isRegistered = [] {
    for (std::string const mesh : {"quad5", "hex4", "tri3", "quad3"}) {
        for (int length : {1, 2, 3, 4, 8}) {
            registerRefinement<OsdExt::CpuEvaluator>("Cpu", mesh, length, 1);
            if (OsdExt::OmpEvaluator::IsParallel()) {
                registerRefinement<OsdExt::OmpEvaluator>("Omp", mesh, length, 2);
            }
        }
        registerRefinement<Osd::CpuEvaluator>("OsdCpu", mesh, 3, 1);
    }
    return true;
}();

} // namespace
} // namespace OpenSubdivHex::Regression

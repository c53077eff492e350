// SPDX-License-Identifier: Apache-2.0
//
// The work of pythonBenchmark.py by C++ alone: a library that Python loads, so that both
// take turns in one process.
#include "far_ext/executor.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/refinementEvaluator.h"

#include <memory>

namespace {

namespace Far = OpenSubdiv::Far;
namespace FarExt = OpenSubdivHex::FarExt;
namespace OsdExt = OpenSubdivHex::OsdExt;

struct NativePeer {
    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<Far::StencilTable const> table;
    std::unique_ptr<OsdExt::RefinementEvaluator> evaluator;
};

OpenSubdiv::Osd::BufferDescriptor const kPoints(0, 3, 3);

} // namespace

#ifdef _WIN32
#define PERF_API extern "C" __declspec(dllexport)
#else
#define PERF_API extern "C" __attribute__((visibility("default")))
#endif

PERF_API void nativeSetNumThreads(int numThreads) {
    FarExt::SetNumThreads(numThreads);
    FarExt::ParallelFor(numThreads, [](int) {}); // starts them
}

/// Null on failure.
PERF_API NativePeer *nativeCreate(int numVertices, int numFaces, int const *faceSizes,
                                  int const *faceVertices) {
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = numVertices;
    descriptor.numFaces = numFaces;
    descriptor.numVertsPerFace = faceSizes;
    descriptor.vertIndicesPerFace = faceVertices;
    auto peer = std::make_unique<NativePeer>();
    peer->refiner = FarExt::TopologyRefinerFactory::Create(descriptor);
    return peer->refiner ? peer.release() : nullptr;
}

PERF_API void nativeDestroy(NativePeer *peer) { delete peer; }

/// The vertices of the last level; 0 on failure.
PERF_API int nativeRefine(NativePeer *peer, int level) {
    return peer->refiner->RefineUniform(level) ? peer->refiner->GetLevel(level).GetNumVertices()
                                               : 0;
}

/// The weights of a table of the last level; 0 on failure.
PERF_API int nativeMakeTable(NativePeer *peer) {
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    peer->table = FarExt::StencilTableFactory::Create(*peer->refiner, options);
    return peer->table ? int(peer->table->GetWeights().size()) : 0;
}

PERF_API void nativeReleaseTable(NativePeer *peer) { peer->table.reset(); }

PERF_API bool nativeMakeEvaluator(NativePeer *peer) {
    peer->evaluator = OsdExt::RefinementEvaluator::Create(*peer->refiner);
    return peer->evaluator != nullptr;
}

PERF_API bool nativeEvaluateTable(NativePeer *peer, float const *src, float *dst) {
    Far::StencilTable const &table = *peer->table;
    return OsdExt::CpuEvaluator::EvalStencils(
        src, kPoints, dst, kPoints, table.GetSizes().data(), table.GetOffsets().data(),
        table.GetControlIndices().data(), table.GetWeights().data(), 0, table.GetNumStencils());
}

PERF_API bool nativeEvaluate(NativePeer *peer, float const *src, float *dst) {
    return peer->evaluator->Evaluate(src, kPoints, dst, kPoints, peer->refiner->GetMaxLevel());
}

// SPDX-License-Identifier: Apache-2.0
//
// CUDA: all levels without a table, against tables and against copying on the device; the limit; and
// what lies before the first frame: nanoseconds per vertex.
#include "makers.h"
#include "meshes.h"

#include "far_ext/stencilTableFactory.h"
#include "osd_ext/cudaEvaluator.h"
#include "osd_ext/cudaRefinementEvaluator.h"
#include "osd_ext/refinementEvaluator.h"
#include "regression/cuda/stencilsByThread.h"

#include <cuda_runtime_api.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

namespace OpenSubdivHex::Regression {
namespace {

using OsdExt::CudaEvaluator;
using OsdExt::CudaRefinementEvaluator;
using OsdExt::CudaStencilTable;
using OsdExt::CudaVertexBuffer;

constexpr int kLength = 3;
Osd::BufferDescriptor const kPacked(0, kLength, kLength);

using RefinerPointer = std::shared_ptr<FarExt::TopologyRefiner const>;
using BufferPointer = std::shared_ptr<CudaVertexBuffer>;

void finish() { CudaEvaluator::Synchronize(); }

BufferPointer makeBuffer(int numVertices) {
    return BufferPointer(CudaVertexBuffer::Create(kLength, numVertices));
}

std::shared_ptr<CudaRefinementEvaluator> makeEvaluator(FarExt::TopologyRefiner const &refiner) {
    FarExt::CallStatus status;
    std::shared_ptr<CudaRefinementEvaluator> result =
        CudaRefinementEvaluator::Create(refiner, &status);
    Require(result != nullptr, status.GetErrorMessage());
    return result;
}

std::shared_ptr<CudaStencilTable> makeCudaTable(Far::StencilTable const &table) {
    return std::shared_ptr<CudaStencilTable>(CudaStencilTable::Create(&table));
}

/// Control values on the device, with those on the processor.
struct ControlValues {
    explicit ControlValues(FarExt::TopologyRefiner const &refiner) {
        int const numControl = refiner.GetLevel(0).GetNumVertices();
        for (int i = 0; i < numControl * kLength; ++i) {
            values.push_back(float(i % 1000) / 1000);
        }
        buffer = makeBuffer(numControl);
        buffer->UpdateData(values.data(), 0, numControl);
    }

    std::vector<float> values;
    BufferPointer buffer;
};

Contestant makeFrame(std::string const &name, double movedBytes,
                     std::function<bool()> const &evaluate, std::function<double()> validate) {
    Contestant contestant;
    contestant.name = name;
    contestant.movedBytes = movedBytes;
    contestant.work = [=] {
        Require(evaluate(), name + ": not evaluated");
        finish();
    };
    contestant.validate = std::move(validate);
    return contestant;
}

/// All levels, with tables where they are asked for, or else huge.
Contest makeFrames(BenchMesh const &mesh, bool hasTables) {
    RefinerPointer const refiner = MakeRefined(mesh);
    auto const own = makeEvaluator(*refiner);
    auto const control = std::make_shared<ControlValues>(*refiner);
    auto const numVertices = int(own->GetNumElementsAllLevels());
    BufferPointer const dst = makeBuffer(numVertices);
    double const bytes = double(numVertices) * kLength * sizeof(float);
    double const ownBytes = 1.25 * bytes + double(own->GetNumDeviceBytes());
    // Half of the bytes are read, the others written.
    auto const numCopied = std::size_t(ownBytes / 2);
    BufferPointer const copied[] = {makeBuffer(int(numCopied / sizeof(float) / kLength) + 1),
                                    makeBuffer(int(numCopied / sizeof(float) / kLength) + 1)};

    auto const validate = [=] {
        auto const evaluator = OsdExt::RefinementEvaluator::Create(*refiner);
        std::vector<float> expected(std::size_t(numVertices) * kLength);
        evaluator->EvaluateAllLevels(control->values.data(), kPacked, expected.data(), kPacked);
        std::vector<float> found(expected.size());
        dst->GetData(found.data());
        for (std::size_t i = 0; i < found.size(); ++i) {
            Require(std::abs(found[i] - expected[i]) < 1e-5f, "CUDA: wrong results");
        }
        return double(numVertices);
    };
    Contest contest;
    contest.contestants = {
        makeFrame(
            "OsdExt::CudaRefinementEvaluator", ownBytes,
            [=] {
                return own->EvaluateAllLevels(control->buffer.get(), kPacked, dst.get(), kPacked);
            },
            validate),
        makeFrame(
            "cudaMemcpy on the device", ownBytes,
            [src = copied[0], to = copied[1], numCopied] {
                return cudaMemcpyAsync(to->BindCudaBuffer(), src->BindCudaBuffer(), numCopied,
                                       cudaMemcpyDeviceToDevice, nullptr) == cudaSuccess;
            },
            [=] { return double(numVertices); })};
    contest.pairings = {{hasTables ? "cuda-copy" : "cuda-huge", 0, {1}}};
    if (!hasTables) {
        return contest;
    }
    Table const onHost = FarExt::StencilTableFactory::Create(*refiner, {});
    auto const table = makeCudaTable(*onHost);
    double const tableBytes = bytes + GetNumBytes(*onHost);
    contest.contestants.push_back(makeFrame(
        "OsdExt::CudaEvaluator", tableBytes,
        [=] {
            return CudaEvaluator::EvalStencils(control->buffer.get(), kPacked, dst.get(), kPacked,
                                               table.get());
        },
        validate));
    contest.contestants.push_back(makeFrame(
        "one thread for each stencil", tableBytes,
        [=] {
            return EvalStencilsByThread(control->buffer->BindCudaBuffer(), dst->BindCudaBuffer(),
                                        kLength, *table);
        },
        validate));
    contest.pairings.push_back({"cuda-table", 0, {2, 3}});
    contest.pairings.push_back({"cuda-levels-thread", 0, {3}});
    contest.pairings.push_back({"cuda-thread", 2, {3}});
    return contest;
}

// The last level, and its limit with derivatives; frames keep the refiner, which the first one needs.
Contest makeLimits(BenchMesh const &mesh) {
    RefinerPointer const refiner = MakeFullyRefined(mesh);
    auto const own = makeEvaluator(*refiner);
    auto const control = std::make_shared<ControlValues>(*refiner);
    int const numVertices = own->GetNumElements(refiner->GetMaxLevel());
    BufferPointer const dst = makeBuffer(numVertices);
    BufferPointer const du = makeBuffer(numVertices);
    BufferPointer const dv = makeBuffer(numVertices);
    auto const validate = [=] { return double(numVertices); };
    Contest contest;
    contest.contestants = {makeFrame(
                               "EvaluateLimit", 0,
                               [=] {
                                   return own->EvaluateLimit(
                                       control->buffer.get(), kPacked, dst.get(), kPacked, du.get(),
                                       kPacked, dv.get(), kPacked, refiner->GetMaxLevel());
                               },
                               validate),
                           makeFrame(
                               "Evaluate", 0,
                               [=] {
                                   return own->Evaluate(control->buffer.get(), kPacked, dst.get(),
                                                        kPacked, refiner->GetMaxLevel());
                               },
                               validate)};
    contest.pairings = {{"cuda-limit", 0, {1}}};
    return contest;
}

Contest makePreparations(BenchMesh const &mesh) {
    RefinerPointer const refiner = MakeRefined(mesh);
    auto const add = [&](std::string const &name, auto make) {
        auto const made = std::make_shared<decltype(make())>();
        Contestant contestant = makeFrame(
            name, 0,
            [=] {
                *made = make();
                return *made != nullptr;
            },
            [=] {
                return double(refiner->GetNumVerticesTotal() -
                              refiner->GetLevel(0).GetNumVertices());
            });
        contestant.release = [=] { made->reset(); };
        return contestant;
    };
    Contest contest;
    contest.contestants = {
        add("OsdExt::CudaRefinementEvaluator", [=] { return makeEvaluator(*refiner); }),
        add("stencil table",
            [=] { return makeCudaTable(*FarExt::StencilTableFactory::Create(*refiner, {})); })};
    contest.pairings = {{"cuda-preparation", 0, {1}}};
    return contest;
}

// New control values, and the last level of them.
std::function<void()> makeFrameOf(BenchMesh const &mesh) {
    RefinerPointer const refiner = MakeRefined(mesh);
    auto const own = makeEvaluator(*refiner);
    auto const control = std::make_shared<ControlValues>(*refiner);
    int const level = refiner->GetMaxLevel();
    int const numControl = refiner->GetLevel(0).GetNumVertices();
    BufferPointer const dst = makeBuffer(own->GetNumElements(level));
    return [=] {
        FarExt::CallStatus status;
        control->buffer->UpdateData(control->values.data(), 0, numControl);
        Require(own->Evaluate(control->buffer.get(), kPacked, dst.get(), kPacked, level, &status),
                status.GetErrorMessage());
        finish();
    };
}

/// Whether the device has room for all levels of a mesh, indices, and as many bytes to copy.
bool hasRoom(BenchMesh const &mesh) {
    std::size_t numFree = 0;
    std::size_t numBytes = 0;
    double levelBytes = 0;
    for (int level = 1; level <= mesh.level; ++level) {
        levelBytes += CountHexVertices(*mesh.shape, level) * kLength * sizeof(float);
    }
    return cudaMemGetInfo(&numFree, &numBytes) == cudaSuccess && double(numFree) > 4 * levelBytes;
}

} // namespace

std::string GetCudaDevice(std::string &reason) {
    int numDevices = 0;
    cudaDeviceProp properties;
    cudaError_t error = cudaGetDeviceCount(&numDevices);
    if (error == cudaSuccess && numDevices > 0) {
        error = cudaGetDeviceProperties(&properties, 0);
    }
    if (error != cudaSuccess || numDevices == 0) {
        reason = std::string("no device") +
                 (error != cudaSuccess ? std::string(", ") + cudaGetErrorString(error) : "");
        return {};
    }
    return properties.name;
}

void AddCudaBenchmarks(Suite &suite) {
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        suite.AddContest({"CUDA, all levels, length 3", "vertex", mesh, Memory::Resident},
                         [=] { return makeFrames(mesh, true); });
        suite.AddContest(
            {"CUDA, limit with derivatives, length 3", "vertex", mesh, Memory::Resident},
            [=] { return makeLimits(mesh); });
        suite.AddContest({"CUDA, preparation", "vertex", mesh, Memory::Default},
                         [=] { return makePreparations(mesh); });
    }
    AddFrameBenchmark(suite, "cuda-frame", makeFrameOf);
    BenchMesh const huge = suite.GetHugeMesh();
    if (hasRoom(huge)) {
        suite.AddContest({GetRow("cuda-huge").work, "vertex", huge, Memory::Resident},
                         [=] { return makeFrames(huge, false); });
    }
}

} // namespace OpenSubdivHex::Regression

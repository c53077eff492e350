// SPDX-License-Identifier: Apache-2.0
//
// The evaluators of CUDA against those of the processor, where there is a device.
#include "far_ext/stencilTableFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/cudaEvaluator.h"
#include "osd_ext/cudaRefinementEvaluator.h"
#include "regression/device/deviceEvaluatorTest.h"
#include "stencilsByThread.h"

#include <cuda_runtime_api.h>

#include <cstdlib>

namespace OpenSubdivHex::Regression::cudaTest {

using OsdExt::CudaEvaluator;
using OsdExt::CudaRefinementEvaluator;
using OsdExt::CudaStencilTable;
using OsdExt::CudaVertexBuffer;

namespace {

struct Cuda {
    static constexpr char const *kName = "Cuda";
    using Evaluator = CudaRefinementEvaluator;
    using Buffer = CudaVertexBuffer;

    /// Why nothing can be evaluated.
    static std::string GetMissing() {
        auto const refiner = MakeRefiner(GetShape("cube"), 0, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        FarExt::CallStatus status;
        Evaluator::Create(*refiner, &status);
        return status.GetErrorMessage();
    }
    // ./dev test cuda sets this where it finds a device.
    static bool IsNeeded() { return std::getenv("OPENSUBDIVHEX_NEEDS_CUDA") != nullptr; }
    static std::unique_ptr<Buffer> MakeBuffer(std::vector<float> const &values, int stride) {
        int const numVertices = int(values.size()) / stride;
        std::unique_ptr<Buffer> buffer(Buffer::Create(stride, numVertices));
        buffer->UpdateData(values.data(), 0, numVertices);
        return buffer;
    }
    static std::vector<float> Read(Buffer &buffer, std::size_t numFloats) {
        std::vector<float> values(std::size_t(buffer.GetNumElements()) *
                                  std::size_t(buffer.GetNumVertices()));
        buffer.GetData(values.data());
        values.resize(numFloats);
        return values;
    }
    static unsigned *GetIntegers(Buffer &buffer) {
        return reinterpret_cast<unsigned *>(buffer.BindCudaBuffer());
    }
};

class CudaTable : public DeviceEvaluator<Cuda> {};

} // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Cuda, DeviceEvaluator, Cuda, KindName);

// The message of a machine without a device.
TEST(CudaWithoutDevice, IsUnsupported) {
    std::string const missing = Cuda::GetMissing();
    if (missing.empty()) {
        GTEST_SKIP() << "there is a device of CUDA";
    }
    EXPECT_EQ(missing.rfind("there is no device of CUDA", 0), 0u) << missing;
    auto const refiner = MakeRefiner(GetShape("cube"), 1, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    FarExt::CallStatus status;
    EXPECT_FALSE(CudaRefinementEvaluator::Create(*refiner, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
    Osd::BufferDescriptor const desc(0, 3, 3);
    EXPECT_FALSE(CudaEvaluator::EvalStencils(nullptr, desc, nullptr, desc, nullptr, nullptr,
                                             nullptr, nullptr, 0, 1));
}

TEST_F(CudaTable, GivesTheValuesOfTheCpu) {
    auto const refiner =
        MakeRefiner(GetFeatureShape("cubeOfCharts"), 3, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    auto const table = FarExt::StencilTableFactory::Create(*refiner);
    std::unique_ptr<CudaStencilTable> const onDevice(CudaStencilTable::Create(table.get()));
    ASSERT_EQ(onDevice->GetNumStencils(), table->GetNumStencils());
    for (int length : {1, 2, 3, 4, 7}) {
        SCOPED_TRACE(length);
        Descriptor const desc(0, length, length);
        std::vector<float> const src = MakeValues(table->GetNumControlVertices(), length);
        std::vector<float> dst(std::size_t(table->GetNumStencils() * length));
        OsdExt::CpuEvaluator::EvalStencils(src.data(), desc, dst.data(), desc,
                                           table->GetSizes().data(), table->GetOffsets().data(),
                                           table->GetControlIndices().data(),
                                           table->GetWeights().data(), 0, table->GetNumStencils());
        Buffer const srcBuffer = kind.MakeBuffer(src, length);
        Buffer dstBuffer = makeBlank(dst.size(), length);
        ASSERT_TRUE(CudaEvaluator::EvalStencils(srcBuffer.get(), desc, dstBuffer.get(), desc,
                                                onDevice.get()));
        ASSERT_NO_FATAL_FAILURE(expectFloats(dstBuffer, dst, kNumUnits));
        dstBuffer = makeBlank(dst.size(), length);
        ASSERT_TRUE(EvalStencilsByThread(srcBuffer->BindCudaBuffer(), dstBuffer->BindCudaBuffer(),
                                         length, *onDevice));
        ASSERT_NO_FATAL_FAILURE(expectFloats(dstBuffer, dst, kNumUnits));
    }
}

TEST_F(CudaTable, GivesPointsAndDerivativesOfLimits) {
    auto const refiner = MakeRefiner(GetFeatureShape("cubeOfCharts"), 2,
                                     Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, {}, true);
    auto const table = FarExt::LimitStencilTableFactory::Create(*refiner, {});
    std::unique_ptr<CudaStencilTable> const onDevice(CudaStencilTable::Create(table.get()));
    constexpr int kLength = 3;
    Descriptor const desc(0, kLength, kLength);
    std::vector<float> const src = MakeValues(table->GetNumControlVertices(), kLength);
    auto const size = std::size_t(table->GetNumStencils() * kLength);
    std::vector<float> outputs[3];
    Buffer buffers[3];
    for (int i = 0; i < 3; ++i) {
        outputs[i].resize(size);
        buffers[i] = makeBlank(size, kLength);
    }
    OsdExt::CpuEvaluator::EvalStencils(
        src.data(), desc, outputs[0].data(), desc, outputs[1].data(), desc, outputs[2].data(), desc,
        table->GetSizes().data(), table->GetOffsets().data(), table->GetControlIndices().data(),
        table->GetWeights().data(), table->GetDuWeights().data(), table->GetDvWeights().data(), 0,
        table->GetNumStencils());
    Buffer const srcBuffer = kind.MakeBuffer(src, kLength);
    ASSERT_TRUE(CudaEvaluator::EvalStencils(srcBuffer.get(), desc, buffers[0].get(), desc,
                                            buffers[1].get(), desc, buffers[2].get(), desc,
                                            onDevice.get()));
    for (int i = 0; i < 3; ++i) {
        ASSERT_NO_FATAL_FAILURE(expectFloats(buffers[i], outputs[i], 4 * kNumUnits));
    }
}

// Elements far apart: beyond 2^31 bytes, and beyond as many floats.
TEST_F(CudaTable, WritesBeyondTwoGigabytesAndBeyondAsManyFloats) {
    auto const refiner =
        MakeRefiner(GetShape("cube"), 2, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, {}, true);
    auto const evaluator = CudaRefinementEvaluator::Create(*refiner);
    constexpr int kLength = 3;
    auto const numElements = std::size_t(evaluator->GetNumElements(2));
    Descriptor const desc(0, kLength, kLength);
    Buffer const src = kind.MakeBuffer(MakeValues(evaluator->GetNumElements(0), kLength), kLength);
    Buffer const dense = makeBlank(numElements * kLength, kLength);
    for (std::size_t const unit : {sizeof(float), std::size_t(1)}) {
        std::size_t const stride = (std::size_t(1) << 31) / unit / (numElements - 1) + 1;
        ASSERT_GE((numElements - 1) * stride * unit, std::size_t(1) << 31);
        std::size_t const numFloats = numElements * stride;
        float *far = nullptr;
        if (cudaMalloc(reinterpret_cast<void **>(&far), numFloats * sizeof(float)) != cudaSuccess) {
            cudaGetLastError();
            GTEST_SKIP() << "the device has no buffer of " << numFloats * sizeof(float) << " bytes";
        }
        std::unique_ptr<float, void (*)(float *)> const owner(far, [](float *p) { cudaFree(p); });
        Descriptor const farDesc(0, kLength, int(stride));
        auto const expectSame = [&] {
            std::vector<float> found(numElements * kLength);
            ASSERT_EQ(cudaMemcpy2D(found.data(), kLength * sizeof(float), far,
                                   stride * sizeof(float), kLength * sizeof(float), numElements,
                                   cudaMemcpyDeviceToHost),
                      cudaSuccess);
            EXPECT_EQ(found, kind.Read(*dense, found.size()));
        };
        ASSERT_TRUE(evaluator->Evaluate(src.get(), desc, dense.get(), desc, 2));
        ASSERT_TRUE(evaluator->Evaluate(src->BindCudaBuffer(), desc, far, farDesc, 2));
        ASSERT_NO_FATAL_FAILURE(expectSame());
        ASSERT_TRUE(evaluator->EvaluateLimit(src.get(), desc, dense.get(), desc, 2));
        ASSERT_TRUE(evaluator->EvaluateLimit(src->BindCudaBuffer(), desc, far, farDesc, 2));
        ASSERT_NO_FATAL_FAILURE(expectSame());
    }
}

TEST_F(CudaTable, RefusesWhatItCannotEvaluate) {
    auto const refiner = MakeRefiner(GetShape("cube"), 2, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const evaluator = CudaRefinementEvaluator::Create(*refiner);
    Descriptor const desc(0, 3, 3);
    std::vector<float> onProcessor(3000);
    Buffer const buffer = makeBlank(3000, 3);
    FarExt::CallStatus status;
    EXPECT_FALSE(
        evaluator->Evaluate(onProcessor.data(), desc, buffer->BindCudaBuffer(), desc, 1, &status));
    EXPECT_EQ(status.GetErrorMessage(), "the source is not on the device");
    EXPECT_FALSE(evaluator->Evaluate(buffer->BindCudaBuffer(), desc, nullptr, desc, 1, &status));
    EXPECT_EQ(status.GetErrorMessage(), "the destination is null");
    EXPECT_EQ(kind.Read(*buffer, 3000), std::vector<float>(3000, kBlank));
}

} // namespace OpenSubdivHex::Regression::cudaTest

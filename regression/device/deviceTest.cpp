// SPDX-License-Identifier: Apache-2.0
//
// The kernels of devices as C++ compiles them.
#include "deviceEvaluatorTest.h"
#include "hostEvaluator.h"

#include "far_ext/stencilTableFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/cuda/stencilSum.h"

#include <new>

namespace OpenSubdivHex::Regression::deviceTest {

namespace {

/// Floats as a buffer of a processor.
class HostBuffer {
public:
    explicit HostBuffer(std::vector<float> values) : _values(std::move(values)) {}
    float *BindCpuBuffer() { return _values.data(); }
    std::vector<float> const &Get() const { return _values; }

private:
    std::vector<float> _values;
};

struct Host {
    static constexpr char const *kName = "Kernels";
    using Evaluator = HostEvaluator;
    using Buffer = HostBuffer;

    static std::string GetMissing() { return {}; }
    static bool IsNeeded() { return true; }
    static std::unique_ptr<Buffer> MakeBuffer(std::vector<float> const &values, int) {
        return std::make_unique<Buffer>(values);
    }
    static std::vector<float> Read(Buffer &buffer, std::size_t) { return buffer.Get(); }
    static unsigned *GetIntegers(Buffer &buffer) {
        return reinterpret_cast<unsigned *>(buffer.BindCpuBuffer());
    }
};

} // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Host, DeviceEvaluator, Host, KindName);

// Places in arrays have 64 bits, as in CUDA: elements far apart, in 2.3 GB few pages of which are touched.
TEST(LargeBuffers, AreWrittenBeyondTwoGigabytes) {
    auto const refiner =
        MakeRefiner(GetShape("cube"), 2, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, {}, true);
    auto const evaluator = HostEvaluator::Create(*refiner);
    constexpr int kLength = 3;
    constexpr int kStride = 4500000;
    int const numElements = evaluator->GetNumElements(2);
    std::size_t const numFloats = std::size_t(numElements) * kStride;
    ASSERT_GT(numFloats * sizeof(float), std::size_t(1) << 31);
    std::unique_ptr<float[]> const far(new (std::nothrow) float[numFloats]);
    if (!far) {
        GTEST_SKIP() << "there is no memory";
    }
    Osd::BufferDescriptor const desc(0, kLength, kLength);
    Osd::BufferDescriptor const farDesc(0, kLength, kStride);
    std::vector<float> const src = MakeValues(evaluator->GetNumElements(0), kLength);
    std::vector<float> near(std::size_t(numElements) * kLength);
    auto const expectSame = [&] {
        for (int i = 0; i < numElements; ++i) {
            for (int k = 0; k < kLength; ++k) {
                ASSERT_EQ(far[std::size_t(i) * kStride + std::size_t(k)],
                          near[std::size_t(i * kLength + k)])
                    << "element " << i;
            }
        }
    };
    ASSERT_TRUE(evaluator->Evaluate(src.data(), desc, near.data(), desc, 2));
    ASSERT_TRUE(evaluator->Evaluate(src.data(), desc, far.get(), farDesc, 2));
    ASSERT_NO_FATAL_FAILURE(expectSame());
    ASSERT_TRUE(evaluator->EvaluateLimit(src.data(), desc, near.data(), desc, 2));
    ASSERT_TRUE(evaluator->EvaluateLimit(src.data(), desc, far.get(), farDesc, 2));
    expectSame();
}

// Too small a buffer is refused with its size, and nothing is written.
TEST(SmallBuffers, AreRefusedByTheirSize) {
    auto const refiner =
        MakeRefiner(GetShape("cube"), 3, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, {}, true);
    std::int64_t const numBytes = HostEvaluator::Create(*refiner)->GetNumDeviceBytes();
    FarExt::CallStatus status;
    EXPECT_FALSE(HostEvaluator::CreateWithin(1000, *refiner, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::TooLarge);
    EXPECT_EQ(status.GetErrorMessage().rfind("the indices of the refinements would take ", 0), 0u);
    EXPECT_NE(status.GetErrorMessage().find(" bytes, and the device reaches 1000"),
              std::string::npos);
    auto const evaluator = HostEvaluator::CreateWithin(numBytes, *refiner, &status);
    ASSERT_TRUE(evaluator) << status.GetErrorMessage();
    std::vector<float> const src = MakeValues(evaluator->GetNumElements(0), 3);
    std::vector<float> dst(std::size_t(evaluator->GetNumElements(3)) * 3, kBlank);
    Osd::BufferDescriptor const desc(0, 3, 3);
    EXPECT_FALSE(evaluator->EvaluateLimit(src.data(), desc, dst.data(), desc, 3, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::TooLarge);
    EXPECT_EQ(status.GetErrorMessage().rfind("the indices of the limit would take ", 0), 0u)
        << status.GetErrorMessage();
    EXPECT_EQ(dst, std::vector<float>(dst.size(), kBlank));
}

// The sums of CudaEvaluator's threads, one after the other.
TEST(StencilLanes, SumUpStencils) {
    constexpr int kLength = 3;
    constexpr int kLanes = OsdExt::internal::kStencilLanes;
    auto const refiner =
        MakeRefiner(GetFeatureShape("cubeOfCharts"), 3, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    auto const table = FarExt::StencilTableFactory::Create(*refiner);
    std::vector<float> const src = MakeValues(table->GetNumControlVertices(), kLength);
    std::vector<float> expected(std::size_t(table->GetNumStencils() * kLength));
    std::vector<float> dst(expected.size());
    Osd::BufferDescriptor const desc(0, kLength, kLength);
    OsdExt::CpuEvaluator::EvalStencils(src.data(), desc, expected.data(), desc,
                                       table->GetSizes().data(), table->GetOffsets().data(),
                                       table->GetControlIndices().data(),
                                       table->GetWeights().data(), 0, table->GetNumStencils());
    OsdExt::internal::StencilArguments const arguments = {src.data(),
                                                          kLength,
                                                          dst.data(),
                                                          kLength,
                                                          table->GetSizes().data(),
                                                          table->GetOffsets().data(),
                                                          table->GetControlIndices().data(),
                                                          table->GetWeights().data(),
                                                          0,
                                                          table->GetNumStencils(),
                                                          kLength};
    for (int stencil = 0; stencil < table->GetNumStencils(); ++stencil) {
        OsdExt::internal::StencilSum<kLength> sums[kLanes];
        for (int lane = 0; lane < kLanes; ++lane) {
            sums[lane] = OsdExt::internal::SumLane<kLength, kLanes>(arguments, stencil, lane);
        }
        for (int apart = kLanes / 2; apart > 0; apart /= 2) {
            for (int lane = 0; lane < apart; ++lane) {
                sums[lane].Add(sums[lane + apart]);
            }
        }
        OsdExt::internal::StoreSum(arguments, stencil, sums[0]);
    }
    for (std::size_t i = 0; i < dst.size(); ++i) {
        ASSERT_NEAR(dst[i], expected[i], 4 * kUnit) << "float " << i;
    }
}

} // namespace OpenSubdivHex::Regression::deviceTest

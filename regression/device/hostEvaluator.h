// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_DEVICE_HOST_EVALUATOR_H
#define OPENSUBDIVHEX_REGRESSION_DEVICE_HOST_EVALUATOR_H

#include "osd_ext/device/deviceEvaluator.h"

#include <cstdint>
#include <memory>

namespace OpenSubdivHex::Regression {

/// \brief A processor as a device: the evaluator of devices with the kernels that C++ compiles.
///
/// What may run in any order on a device, kernels that nothing waits between and the invocations of each,
/// runs from the last to the first here: a missing Device::Wait() shows.
class HostEvaluator : public OsdExt::BufferEvaluator<HostEvaluator, OsdExt::CpuBinding> {
public:
    using Options = OsdExt::RefinementEvaluator::Options;

    static std::unique_ptr<HostEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                 Options options = Options(),
                                                 FarExt::CallStatus *status = nullptr);
    /// On a device whose buffers have so many bytes at most.
    static std::unique_ptr<HostEvaluator> CreateWithin(std::int64_t maxBytes,
                                                       FarExt::TopologyRefiner const &refiner,
                                                       FarExt::CallStatus *status);

    int GetMaxLevel() const { return _evaluator.GetMaxLevel(); }
    int GetNumElements(int level) const { return _evaluator.GetNumElements(level); }
    std::int64_t GetNumElementsAllLevels() const { return _evaluator.GetNumElementsAllLevels(); }
    std::int64_t GetNumDeviceBytes() const { return _evaluator.GetNumDeviceBytes(); }

    using BufferEvaluator::Evaluate;
    using BufferEvaluator::EvaluateAllLevels;
    using BufferEvaluator::EvaluateLimit;

    bool Evaluate(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                  Osd::BufferDescriptor const &dstDesc, int level,
                  FarExt::CallStatus *status = nullptr);
    bool EvaluateAllLevels(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                           Osd::BufferDescriptor const &dstDesc,
                           FarExt::CallStatus *status = nullptr);
    bool EvaluateLimit(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                       Osd::BufferDescriptor const &dstDesc, int level,
                       FarExt::CallStatus *status = nullptr);
    bool EvaluateLimit(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                       Osd::BufferDescriptor const &dstDesc, float *du,
                       Osd::BufferDescriptor const &duDesc, float *dv,
                       Osd::BufferDescriptor const &dvDesc, int level,
                       FarExt::CallStatus *status = nullptr);

    std::int64_t GetNumTriangles(int level) const { return _evaluator.GetNumTriangles(level); }
    bool MakeTriangleIndices(unsigned *dst, int level, int vertexOffset = 0,
                             FarExt::CallStatus *status = nullptr);

private:
    HostEvaluator(std::int64_t maxBytes, FarExt::TopologyRefiner const &refiner);

    OsdExt::internal::DeviceEvaluator _evaluator;
};

} // namespace OpenSubdivHex::Regression

#endif

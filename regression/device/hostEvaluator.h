// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_DEVICE_HOST_EVALUATOR_H
#define OPENSUBDIVHEX_REGRESSION_DEVICE_HOST_EVALUATOR_H

#include "osd_ext/device/deviceEvaluator.h"

#include <cstdint>
#include <memory>

namespace OpenSubdivHex::Regression {

/// \brief A processor as a device: the evaluator of devices with the kernels that C++ compiles.
///
/// Work that a device may run in any order (invocations of a kernel, and kernels without a wait between them) runs
/// from the last to the first here: a missing Device::Wait() shows.
class HostEvaluator : public OsdExt::DeviceRefinementEvaluator,
                      public OsdExt::BufferEvaluator<HostEvaluator, OsdExt::CpuBinding> {
public:
    static std::unique_ptr<HostEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                 Options options = Options(),
                                                 FarExt::CallStatus *status = nullptr);
    /// On a device whose buffers have so many bytes at most.
    static std::unique_ptr<HostEvaluator> CreateWithin(std::int64_t maxBytes,
                                                       FarExt::TopologyRefiner const &refiner,
                                                       FarExt::CallStatus *status);

    bool MakeTriangleIndices(unsigned *dst, int level, int vertexOffset = 0,
                             FarExt::CallStatus *status = nullptr);

private:
    friend BufferEvaluator;
    HostEvaluator(std::int64_t maxBytes, FarExt::TopologyRefiner const &refiner);
};

} // namespace OpenSubdivHex::Regression

#endif

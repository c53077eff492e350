// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CUDA_CUDA_DEVICE_H
#define OPENSUBDIVHEX_OSD_EXT_CUDA_CUDA_DEVICE_H

#include "osd_ext/cudaEvaluator.h"
#include "osd_ext/device/device.h"

#include <limits>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The current device of CUDA.  Buffers are addresses on it.
class CudaDevice : public Device {
public:
    /// Where all is done from now on.
    void SetStream(CudaStream stream) { _stream = stream; }

    FarExt::CallStatus CheckContext() const override;
    std::int64_t GetMaxBytes() const override { return std::numeric_limits<std::int64_t>::max(); }
    DeviceBufferName Allocate(std::int64_t numBytes) override;
    void Free(DeviceBufferName buffer) override;
    void Write(DeviceBufferName buffer, std::int64_t firstByte, void const *data,
               std::int64_t numBytes) override;
    FarExt::CallStatus CheckBuffer(DeviceBufferName buffer, std::int64_t numFloats,
                                   std::string const &what) const override;
    FarExt::CallStatus Prepare(DeviceKernel kernel, int length, int faceSize) override;
    void Run(DeviceTask const &task) override;
    void Wait() override;
    FarExt::CallStatus EndFrame() override;

private:
    CudaStream _stream = nullptr;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

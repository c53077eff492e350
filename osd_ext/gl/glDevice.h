// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_GL_GL_DEVICE_H
#define OPENSUBDIVHEX_OSD_EXT_GL_GL_DEVICE_H

#include "glObjects.h"

#include "osd_ext/device/device.h"

#include <functional>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The current context of OpenGL 4.3 or later.
class GlDevice : public Device {
public:
    FarExt::CallStatus CheckContext() const override;
    std::int64_t GetMaxBytes() const override;
    DeviceBufferName Allocate(std::int64_t numBytes) override;
    void Free(DeviceBufferName buffer) override;
    void Write(DeviceBufferName buffer, std::int64_t firstByte, void const *data,
               std::int64_t numBytes) override;
    void Fill(DeviceBufferName buffer, std::int64_t numBytes,
              std::function<void(void *)> const &write) override;
    FarExt::CallStatus CheckBuffer(DeviceBufferName buffer, std::int64_t numFloats,
                                   std::string const &what) const override;
    FarExt::CallStatus Prepare(DeviceKernel kernel, int length, int faceSize) override;
    void Run(DeviceTask const &task) override;
    void Wait() override;
    FarExt::CallStatus EndFrame() override;

private:
    // With length and face size.
    using Key = std::tuple<DeviceKernel, int, int>;
    struct Kernel {
        std::unique_ptr<GlProgram> program;
        std::vector<GLint> uniforms; // in the order of kernelParameters.inl
    };

    std::map<Key, Kernel> _kernels;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

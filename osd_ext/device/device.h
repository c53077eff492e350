// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_H
#define OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_H

#include "deviceKernels.h"

#include "osd_ext/refinementEvaluator.h"

#include <cstdint>
#include <functional>
#include <string>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief A kernel to be run on \c count things.
struct OPENSUBDIVHEX_API DeviceTask {
    DeviceKernel kernel = DeviceKernel::Copy;
    int length = 0;   ///< floats of an element; 1 where an invocation makes one
    int faceSize = 0; ///< for DeviceKernel::FaceRun and LatticeLimit
    DeviceBufferName sources = 0;
    DeviceBufferName results = 0;
    DeviceBufferName indices = 0;
    DeviceBufferName weights = 0;
    DeviceBufferName duResults = 0;
    DeviceBufferName dvResults = 0;
    DeviceBufferName listedVertices = 0;
    DeviceBufferName triangles = 0;
    std::uint32_t count = 0;
    DeviceParameters parameters{}; ///< but for the count of invocations

    /// All that a kernel is told, where names of buffers are addresses.
    DeviceArguments GetArguments() const;
};

/// \brief Interface of DeviceEvaluator to OpenGL, CUDA, or anything else that runs kernels.
///
/// Memory that is not there throws std::bad_alloc.
class OPENSUBDIVHEX_API Device {
public:
    Device() = default;
    Device(Device const &) = delete;
    Device &operator=(Device const &) = delete;
    virtual ~Device();

    /// Whether anything can be run at all.
    virtual FarExt::CallStatus CheckContext() const = 0;

    /// \brief How many bytes of a buffer kernels reach.
    virtual std::int64_t GetMaxBytes() const = 0;
    /// \brief TooLarge for a buffer of more bytes than GetMaxBytes().
    ///
    /// \param what  names it in the message
    FarExt::CallStatus CheckSize(std::int64_t numBytes, std::string const &what) const;

    /// Gives a buffer of \p numBytes, 1 or more, whose content is not known.
    virtual DeviceBufferName Allocate(std::int64_t numBytes) = 0;
    virtual void Free(DeviceBufferName buffer) = 0;
    /// Copies \p numBytes of \p data to a buffer, from \p firstByte on.
    virtual void Write(DeviceBufferName buffer, std::int64_t firstByte, void const *data,
                       std::int64_t numBytes) = 0;

    /// \brief Has write(memory) write the first \p numBytes of a buffer: to the buffer, or to memory that
    /// is then copied.  It may be called again if the buffer has lost them.
    virtual void Fill(DeviceBufferName buffer, std::int64_t numBytes,
                      std::function<void(void *)> const &write);

    /// \brief Whether a user's buffer is one, and has \p numFloats or more.
    ///
    /// \param what  names it in the message
    virtual FarExt::CallStatus CheckBuffer(DeviceBufferName buffer, std::int64_t numFloats,
                                           std::string const &what) const = 0;

    /// Makes a kernel ready to be run.
    virtual FarExt::CallStatus Prepare(DeviceKernel kernel, int length, int faceSize) = 0;
    /// Runs a kernel that is ready, behind all before it that wrote what Wait() stood behind.
    virtual void Run(DeviceTask const &task) = 0;
    /// Barrier: later kernels see earlier writes.
    virtual void Wait() = 0;
    /// Ends a frame: leaves the device as others expect it.
    virtual FarExt::CallStatus EndFrame() = 0;
};

/// \brief A buffer of a device, freed with this.
class OPENSUBDIVHEX_API DeviceBuffer {
public:
    explicit DeviceBuffer(Device &device) : _device(device) {}
    DeviceBuffer(DeviceBuffer const &) = delete;
    DeviceBuffer &operator=(DeviceBuffer const &) = delete;
    ~DeviceBuffer() {
        if (_name != 0) {
            _device.Free(_name);
        }
    }

    DeviceBufferName GetName() const { return _name; }
    std::int64_t GetNumBytes() const { return _numBytes; }

    /// Has that size, or a larger one; the content is lost where it grows.
    void Resize(std::int64_t numBytes);

    template <typename ARRAY>
    void Write(std::int64_t firstByte, ARRAY const &array) {
        if (array.size() > 0) {
            _device.Write(_name, firstByte, array.data(),
                          std::int64_t(array.size()) * std::int64_t(sizeof(*array.data())));
        }
    }

private:
    Device &_device;
    DeviceBufferName _name = 0;
    std::int64_t _numBytes = 0;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#include "device.h"

#include "far_ext/vtr/buffer.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace OpenSubdivHex::OsdExt::internal {

namespace {

template <typename T>
T *getAddress(DeviceBufferName buffer) {
    return reinterpret_cast<T *>(std::uintptr_t(buffer));
}

} // namespace

DeviceArguments DeviceTask::GetArguments() const {
    DeviceArguments arguments;
    static_cast<DeviceParameters &>(arguments) = parameters;
    arguments.sources = getAddress<float const>(sources);
    arguments.results = getAddress<float>(results);
    arguments.indices = getAddress<std::uint32_t const>(indices);
    arguments.weights = getAddress<float const>(weights);
    arguments.duResults = getAddress<float>(duResults);
    arguments.dvResults = getAddress<float>(dvResults);
    arguments.listedVertices = getAddress<std::uint32_t const>(listedVertices);
    arguments.triangles = getAddress<std::uint32_t>(triangles);
    return arguments;
}

Device::~Device() = default;

FarExt::CallStatus Device::CheckSize(std::int64_t numBytes, std::string const &what) const {
    std::int64_t const maxBytes = GetMaxBytes();
    return numBytes <= maxBytes
               ? FarExt::CallStatus()
               : FarExt::internal::Failure(FarExt::StatusCode::TooLarge,
                                           what + " would take " + std::to_string(numBytes) +
                                               " bytes, and the device reaches " +
                                               std::to_string(maxBytes));
}

void Device::Fill(DeviceBufferName buffer, std::int64_t numBytes,
                  std::function<void(void *)> const &write) {
    FarExt::internal::Buffer<char> memory;
    memory.Resize(std::size_t(numBytes));
    write(memory.data());
    Write(buffer, 0, memory.data(), numBytes);
}

void DeviceBuffer::Resize(std::int64_t numBytes) {
    // A buffer without a byte would be none.
    numBytes = std::max(numBytes, std::int64_t(sizeof(float)));
    if (numBytes <= _numBytes) {
        return;
    }
    if (_name != 0) {
        _device.Free(_name);
        _name = 0;
        _numBytes = 0;
    }
    _name = _device.Allocate(numBytes);
    _numBytes = numBytes;
}

} // namespace OpenSubdivHex::OsdExt::internal

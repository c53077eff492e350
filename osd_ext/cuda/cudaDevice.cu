// SPDX-License-Identifier: Apache-2.0
#include "cudaDevice.h"
#include "cudaErrors.h"

#include "far_ext/vtr/report.h"

namespace OpenSubdivHex::OsdExt::internal {

using FarExt::CallStatus;
using FarExt::StatusCode;

namespace {

constexpr unsigned kGroup = 128; // threads of a block

template <class COMPILED>
__global__ void __launch_bounds__(kGroup) runKernel(typename COMPILED::Kernels kernels) {
    std::uint64_t const i = std::uint64_t(blockIdx.x) * kGroup + threadIdx.x;
    if (i < kernels.count) {
        RunKernel<COMPILED::kKernel>(kernels, std::uint32_t(i));
    }
}

void *getAddress(DeviceBufferName buffer) {
    return reinterpret_cast<void *>(std::uintptr_t(buffer));
}

} // namespace

CallStatus CudaDevice::CheckContext() const {
    int numDevices = 0;
    cudaError_t const error = cudaGetDeviceCount(&numDevices);
    if (error != cudaSuccess || numDevices == 0) {
        cudaGetLastError();
        return FarExt::internal::Failure(
            StatusCode::Unsupported,
            std::string("there is no device of CUDA") +
                (error != cudaSuccess ? std::string(": ") + cudaGetErrorString(error) : ""));
    }
    return CallStatus();
}

DeviceBufferName CudaDevice::Allocate(std::int64_t numBytes) {
    void *address = nullptr;
    ThrowCudaError(cudaMalloc(&address, std::size_t(numBytes)));
    return DeviceBufferName(reinterpret_cast<std::uintptr_t>(address));
}

// Waits for kernels that may still read it.
void CudaDevice::Free(DeviceBufferName buffer) { cudaFree(getAddress(buffer)); }

void CudaDevice::Write(DeviceBufferName buffer, std::int64_t firstByte, void const *data,
                       std::int64_t numBytes) {
    ThrowCudaError(cudaMemcpyAsync(static_cast<char *>(getAddress(buffer)) + firstByte, data,
                                   std::size_t(numBytes), cudaMemcpyHostToDevice, _stream));
    // The data need not outlive this call.
    ThrowCudaError(cudaStreamSynchronize(_stream));
}

CallStatus CudaDevice::CheckBuffer(DeviceBufferName buffer, std::int64_t /*numFloats*/,
                                   std::string const &what) const {
    cudaPointerAttributes attributes;
    bool const isKnown =
        buffer != 0 && cudaPointerGetAttributes(&attributes, getAddress(buffer)) == cudaSuccess;
    if (isKnown && attributes.devicePointer != nullptr) {
        return CallStatus();
    }
    cudaGetLastError();
    return FarExt::internal::Failure(StatusCode::InvalidArgument,
                                     "the " + what +
                                         (buffer == 0 ? " is null" : " is not on the device"));
}

// All have been compiled with the library.
CallStatus CudaDevice::Prepare(DeviceKernel /*kernel*/, int /*length*/, int /*faceSize*/) {
    return CallStatus();
}

void CudaDevice::Run(DeviceTask const &task) {
    RunInParts(task.kernel, task.length, task.faceSize, task.GetArguments(),
               [&](auto compiled, DeviceArguments const &arguments) {
                   using Compiled = decltype(compiled);
                   typename Compiled::Kernels kernels;
                   static_cast<DeviceArguments &>(kernels) = arguments;
                   kernels.count = task.count;
                   unsigned const numGroups = task.count / kGroup + (task.count % kGroup != 0);
                   runKernel<Compiled><<<numGroups, kGroup, 0, _stream>>>(kernels);
               });
}

// Kernels of a stream run one behind the other.
void CudaDevice::Wait() {}

CallStatus CudaDevice::EndFrame() { return GetCudaStatus(cudaGetLastError()); }

} // namespace OpenSubdivHex::OsdExt::internal

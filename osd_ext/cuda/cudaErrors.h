// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CUDA_CUDA_ERRORS_H
#define OPENSUBDIVHEX_OSD_EXT_CUDA_CUDA_ERRORS_H

#include "far_ext/status.h"
#include "far_ext/vtr/report.h"

#include <cuda_runtime_api.h>

#include <new>
#include <stdexcept>
#include <string>

namespace OpenSubdivHex::OsdExt::internal {

/// The status of a CUDA error.
inline FarExt::CallStatus GetCudaStatus(cudaError_t error) {
    if (error == cudaSuccess) {
        return FarExt::CallStatus();
    }
    return FarExt::internal::Failure(FarExt::StatusCode::Unsupported,
                                     std::string("CUDA: ") + cudaGetErrorString(error));
}

/// Throws std::bad_alloc where there is no memory, and std::runtime_error at any other error, which
/// CUDA then forgets, so that later calls do not find it.
inline void ThrowCudaError(cudaError_t error) {
    if (error == cudaSuccess) {
        return;
    }
    cudaGetLastError();
    if (error == cudaErrorMemoryAllocation) {
        throw std::bad_alloc();
    }
    throw std::runtime_error(GetCudaStatus(error).GetErrorMessage());
}

} // namespace OpenSubdivHex::OsdExt::internal

#endif

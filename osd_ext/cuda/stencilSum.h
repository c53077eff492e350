// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CUDA_STENCIL_SUM_H
#define OPENSUBDIVHEX_OSD_EXT_CUDA_STENCIL_SUM_H

#include "osd_ext/device/deviceKernels.h"

#include <cstdint>

namespace OpenSubdivHex::OsdExt::internal {

/// Threads that sum up one stencil.
constexpr int kStencilLanes = 4;

/// \brief Arguments of stencils on the device.
struct StencilArguments {
    float const *src; ///< at the first float of element 0
    std::int64_t srcStride;
    float *dst; ///< of the same
    std::int64_t dstStride;
    int const *sizes;
    int const *offsets;
    int const *indices;
    float const *weights;
    int start;
    int end;
    int length;
};

/// A part of an element, in registers.
template <int LENGTH>
struct StencilSum {
    float x[LENGTH];

    OPENSUBDIVHEX_KERNEL_FUNCTION void Add(StencilSum const &other) {
        for (int k = 0; k < LENGTH; ++k) {
            x[k] += other.x[k];
        }
    }
};

/// \brief Sums up the part of a stencil that one of \c LANES threads has: every LANES'th weight from \p lane on, so
/// that neighbouring threads read neighbouring indices and weights.
///
/// The sums of the lanes are added in pairs: those LANES / 2 apart first.
template <int LENGTH, int LANES>
OPENSUBDIVHEX_KERNEL_FUNCTION StencilSum<LENGTH> SumLane(StencilArguments const &arguments,
                                                         int stencil, int lane) {
    StencilSum<LENGTH> sum = {};
    int const first = arguments.offsets[stencil];
    int const end = first + arguments.sizes[stencil];
    for (int i = first + lane; i < end; i += LANES) {
        float const weight = arguments.weights[i];
        float const *const element =
            arguments.src + std::int64_t(arguments.indices[i]) * arguments.srcStride;
        for (int k = 0; k < LENGTH; ++k) {
            sum.x[k] += weight * element[k];
        }
    }
    return sum;
}

template <int LENGTH>
OPENSUBDIVHEX_KERNEL_FUNCTION void StoreSum(StencilArguments const &arguments, int stencil,
                                            StencilSum<LENGTH> const &sum) {
    float *const element = arguments.dst + std::int64_t(stencil) * arguments.dstStride;
    for (int k = 0; k < LENGTH; ++k) {
        element[k] = sum.x[k];
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

#endif

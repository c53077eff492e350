// SPDX-License-Identifier: Apache-2.0
#include "stencilsByThread.h"

#include <cstdint>

namespace OpenSubdivHex::Regression {

namespace {

constexpr int kGroup = 128; // threads of a block

struct Stencils {
    int const *sizes;
    int const *offsets;
    int const *indices;
    float const *weights;
    int number;
};

__global__ void __launch_bounds__(kGroup)
    evalStencils(float const *src, float *dst, int length, Stencils stencils) {
    std::int64_t const stencil = std::int64_t(blockIdx.x) * kGroup + threadIdx.x;
    if (stencil >= stencils.number) {
        return;
    }
    float *const element = dst + stencil * length;
    for (int k = 0; k < length; ++k) {
        element[k] = 0;
    }
    int const first = stencils.offsets[stencil];
    for (int i = first; i < first + stencils.sizes[stencil]; ++i) {
        float const *const source = src + std::int64_t(stencils.indices[i]) * length;
        for (int k = 0; k < length; ++k) {
            element[k] += stencils.weights[i] * source[k];
        }
    }
}

} // namespace

bool EvalStencilsByThread(float const *src, float *dst, int length,
                          OsdExt::CudaStencilTable const &table) {
    Stencils const stencils = {static_cast<int const *>(table.GetSizesBuffer()),
                               static_cast<int const *>(table.GetOffsetsBuffer()),
                               static_cast<int const *>(table.GetIndicesBuffer()),
                               static_cast<float const *>(table.GetWeightsBuffer()),
                               table.GetNumStencils()};
    int const numGroups = stencils.number / kGroup + 1;
    evalStencils<<<unsigned(numGroups), kGroup>>>(src, dst, length, stencils);
    return cudaGetLastError() == cudaSuccess;
}

} // namespace OpenSubdivHex::Regression

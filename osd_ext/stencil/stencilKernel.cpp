// SPDX-License-Identifier: Apache-2.0
#include "stencilKernel.h"

#include "osd_ext/simdLevel.h"

namespace OpenSubdivHex::OsdExt::internal {

namespace {

bool isUsable(Osd::BufferDescriptor const &desc, int length) {
    return desc.length == length && length > 0 && desc.stride >= length && desc.offset >= 0;
}

} // namespace

bool MakeStencilTask(float const *src, Osd::BufferDescriptor const &srcDesc,
                     StencilOutput const *outputs, int numOutputs, StencilRows const &rows,
                     int start, int end, StencilTask *task) {
    bool isValid = isUsable(srcDesc, srcDesc.length);
    for (int i = 0; i < numOutputs; ++i) {
        isValid = isValid && isUsable(outputs[i].desc, srcDesc.length);
    }
    if (!isValid || start >= end) {
        return isValid;
    }
    isValid = start >= 0 && src && (rows.sizes || rows.blocks);
    for (int i = 0; i < numOutputs; ++i) {
        // Without indices all stencils are empty.
        isValid = isValid && outputs[i].dst && (outputs[i].weights || !rows.indices);
    }
    if (!isValid) {
        return false;
    }
    task->src = src + srcDesc.offset;
    task->srcStride = srcDesc.stride;
    task->length = srcDesc.length;
    task->rows = rows;
    task->numOutputs = numOutputs;
    for (int i = 0; i < numOutputs; ++i) {
        task->outputs[i] = {outputs[i].dst + outputs[i].desc.offset, outputs[i].desc.stride,
                            outputs[i].weights};
    }
    return true;
}

std::size_t FindFirstWeight(StencilRows const &rows, int stencil) {
    if (rows.HasPlaces()) {
        return 0;
    }
    std::size_t result = 0;
    for (int i = 0; i < stencil; ++i) {
        result += std::size_t(rows.sizes[i]);
    }
    return result;
}

StencilKernel GetStencilKernel() {
    switch (GetSimdLevel()) {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    case SimdLevel::Avx512:
        return EvalStencilsAvx512;
    case SimdLevel::Avx2:
        return EvalStencilsAvx2;
#endif
    default:
        return EvalStencilsPortable;
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

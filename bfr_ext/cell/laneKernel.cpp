// SPDX-License-Identifier: Apache-2.0
#include "laneKernel.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace {

template <typename REAL>
using Kernel = void (*)(LaneProduct<REAL> const &);

template <typename REAL>
Kernel<REAL> chooseKernel() {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f")) {
        return MultiplyAvx512;
    }
    if (__builtin_cpu_supports("avx2")) {
        return MultiplyAvx2;
    }
#endif
    return MultiplyPortable;
}

template <typename REAL>
void multiplyWidest(LaneProduct<REAL> const &product) {
    static Kernel<REAL> const kKernel = chooseKernel<REAL>();
    kKernel(product);
}

} // namespace

void Multiply(LaneProduct<float> const &product) { multiplyWidest(product); }

void Multiply(LaneProduct<double> const &product) { multiplyWidest(product); }

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "placeKernel.h"

#include "patchSums.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace {

template <typename REAL>
using Kernel = void (*)(PlaceMatrix<REAL> const &, PlaceSums<REAL> const &);

template <typename REAL>
using PatchKernel = void (*)(PatchSums<REAL> const &);

#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
bool hasAvx2() {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

bool hasAvx512() {
    return hasAvx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl");
}
#endif

template <typename REAL>
Kernel<REAL> chooseKernel() {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    if (hasAvx512()) {
        return SumUpPlacesAvx512;
    }
    if (hasAvx2()) {
        return SumUpPlacesAvx2;
    }
#endif
    return SumUpPlacesPortable;
}

template <typename REAL>
PatchKernel<REAL> choosePatchKernel() {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    if (hasAvx512()) {
        return SumUpPatchAvx512;
    }
    if (hasAvx2()) {
        return SumUpPatchAvx2;
    }
#endif
    return SumUpPatchPortable;
}

} // namespace

void SumUpPlaces(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums) {
    static Kernel<float> const kKernel = chooseKernel<float>();
    kKernel(matrix, sums);
}

void SumUpPlaces(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums) {
    static Kernel<double> const kKernel = chooseKernel<double>();
    kKernel(matrix, sums);
}

void SumUpPatch(PatchSums<float> const &sums) {
    static PatchKernel<float> const kKernel = choosePatchKernel<float>();
    kKernel(sums);
}

void SumUpPatch(PatchSums<double> const &sums) {
    static PatchKernel<double> const kKernel = choosePatchKernel<double>();
    kKernel(sums);
}

} // namespace OpenSubdivHex::BfrExt::internal

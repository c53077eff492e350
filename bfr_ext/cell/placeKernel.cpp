// SPDX-License-Identifier: Apache-2.0
#include "placeKernel.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace {

template <typename REAL>
using Kernel = void (*)(PlaceMatrix<REAL> const &, PlaceSums<REAL> const &);

template <typename REAL>
Kernel<REAL> chooseKernel() {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f")) {
        return SumUpPlacesAvx512;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        return SumUpPlacesAvx2;
    }
#endif
    return SumUpPlacesPortable;
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

} // namespace OpenSubdivHex::BfrExt::internal

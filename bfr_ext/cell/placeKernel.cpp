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
    if (__builtin_cpu_supports("avx2")) {
        return SumUpPlacesAvx2;
    }
#endif
    return SumUpPlacesPortable;
}

template <typename REAL>
void sumUpWidest(PlaceMatrix<REAL> const &matrix, PlaceSums<REAL> const &sums) {
    static Kernel<REAL> const kKernel = chooseKernel<REAL>();
    kKernel(matrix, sums);
}

} // namespace

void SumUpPlaces(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums) {
    sumUpWidest(matrix, sums);
}

void SumUpPlaces(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums) {
    sumUpWidest(matrix, sums);
}

} // namespace OpenSubdivHex::BfrExt::internal

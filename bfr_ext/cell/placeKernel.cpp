// SPDX-License-Identifier: Apache-2.0
#include "placeKernel.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace {

template <typename MATRIX, typename SUMS>
using Kernel = void (*)(MATRIX const &, SUMS const &);

template <typename MATRIX, typename SUMS>
Kernel<MATRIX, SUMS> chooseKernel() {
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

template <typename MATRIX, typename SUMS>
void sumUpWidest(MATRIX const &matrix, SUMS const &sums) {
    static Kernel<MATRIX, SUMS> const kKernel = chooseKernel<MATRIX, SUMS>();
    kKernel(matrix, sums);
}

} // namespace

void SumUpPlaces(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums) {
    sumUpWidest(matrix, sums);
}

void SumUpPlaces(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums) {
    sumUpWidest(matrix, sums);
}

void SumUpPlaces(std::array<PlaceMatrix<float>, 2> const &matrices,
                 DerivativeSums<float> const &sums) {
    sumUpWidest(matrices, sums);
}

void SumUpPlaces(std::array<PlaceMatrix<double>, 2> const &matrices,
                 DerivativeSums<double> const &sums) {
    sumUpWidest(matrices, sums);
}

void SumUpPlaces(PlaceMatrix<float> const &matrix, ItemSums<float> const &sums) {
    sumUpWidest(matrix, sums);
}

void SumUpPlaces(PlaceMatrix<double> const &matrix, ItemSums<double> const &sums) {
    sumUpWidest(matrix, sums);
}

} // namespace OpenSubdivHex::BfrExt::internal

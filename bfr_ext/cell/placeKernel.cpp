// SPDX-License-Identifier: Apache-2.0
#include "placeKernel.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace {

template <typename REAL>
SumKernels<REAL> const &getWidestKernels() {
    static SumKernels<REAL> const kKernels = FindKernels<REAL>().back();
    return kKernels;
}

} // namespace

template <typename REAL>
std::vector<SumKernels<REAL>> FindKernels() {
    std::vector<SumKernels<REAL>> kernels = {GetPortableKernels<REAL>()};
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        kernels.push_back(GetAvx2Kernels<REAL>());
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) {
            kernels.push_back(GetAvx512Kernels<REAL>());
        }
    }
#endif
    return kernels;
}

template std::vector<SumKernels<float>> FindKernels();
template std::vector<SumKernels<double>> FindKernels();

void SumUpPlaces(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums) {
    getWidestKernels<float>().sumUpPlaces(matrix, sums);
}

void SumUpPlaces(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums) {
    getWidestKernels<double>().sumUpPlaces(matrix, sums);
}

void SumUpPatch(PatchSums<float> const &sums) { getWidestKernels<float>().sumUpPatch(sums); }

void SumUpPatch(PatchSums<double> const &sums) { getWidestKernels<double>().sumUpPatch(sums); }

} // namespace OpenSubdivHex::BfrExt::internal

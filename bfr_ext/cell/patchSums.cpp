// SPDX-License-Identifier: Apache-2.0
#include "patchSums.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace {

template <int NUM_DERIVATIVES, typename REAL>
auto choosePatchKernel() {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        return SumUpPatchAvx2<NUM_DERIVATIVES, REAL>;
    }
#endif
    return SumUpPatchPortable<NUM_DERIVATIVES, REAL>;
}

} // namespace

template <int NUM_DERIVATIVES, typename REAL>
void SumUpPatch(PatchWeights<NUM_DERIVATIVES, REAL> const &weights, PatchBlock<REAL> const &block,
                REAL const *points, int size, std::ptrdiff_t stride, REAL *const *results) {
    static auto *const kKernel = choosePatchKernel<NUM_DERIVATIVES, REAL>();
    kKernel(weights, block, points, size, stride, results);
}

template void SumUpPatch(PatchWeights<0, float> const &, PatchBlock<float> const &, float const *,
                         int, std::ptrdiff_t, float *const *);
template void SumUpPatch(PatchWeights<0, double> const &, PatchBlock<double> const &,
                         double const *, int, std::ptrdiff_t, double *const *);
template void SumUpPatch(PatchWeights<1, float> const &, PatchBlock<float> const &, float const *,
                         int, std::ptrdiff_t, float *const *);
template void SumUpPatch(PatchWeights<1, double> const &, PatchBlock<double> const &,
                         double const *, int, std::ptrdiff_t, double *const *);
template void SumUpPatch(PatchWeights<2, float> const &, PatchBlock<float> const &, float const *,
                         int, std::ptrdiff_t, float *const *);
template void SumUpPatch(PatchWeights<2, double> const &, PatchBlock<double> const &,
                         double const *, int, std::ptrdiff_t, double *const *);

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "patchSumsTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

template <int NUM_DERIVATIVES, typename REAL>
void SumUpPatchAvx2(PatchWeights<NUM_DERIVATIVES, REAL> const &weights,
                    PatchBlock<REAL> const &block, REAL const *points, int size,
                    std::ptrdiff_t stride, REAL *const *results) {
    sumUpBlock(weights, block, points, size, stride, results);
}

template void SumUpPatchAvx2(PatchWeights<0, float> const &, PatchBlock<float> const &,
                             float const *, int, std::ptrdiff_t, float *const *);
template void SumUpPatchAvx2(PatchWeights<0, double> const &, PatchBlock<double> const &,
                             double const *, int, std::ptrdiff_t, double *const *);
template void SumUpPatchAvx2(PatchWeights<1, float> const &, PatchBlock<float> const &,
                             float const *, int, std::ptrdiff_t, float *const *);
template void SumUpPatchAvx2(PatchWeights<1, double> const &, PatchBlock<double> const &,
                             double const *, int, std::ptrdiff_t, double *const *);
template void SumUpPatchAvx2(PatchWeights<2, float> const &, PatchBlock<float> const &,
                             float const *, int, std::ptrdiff_t, float *const *);
template void SumUpPatchAvx2(PatchWeights<2, double> const &, PatchBlock<double> const &,
                             double const *, int, std::ptrdiff_t, double *const *);

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "patchSumsTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

template <int NUM_DERIVATIVES, typename REAL>
void SumUpPatchAvx2(PatchWeights<NUM_DERIVATIVES, REAL> const &weights, REAL const *points,
                    int size, std::ptrdiff_t stride, REAL *const *results) {
    sumUpPatch(weights, points, size, stride, results);
}

template void SumUpPatchAvx2(PatchWeights<0, float> const &, float const *, int, std::ptrdiff_t,
                             float *const *);
template void SumUpPatchAvx2(PatchWeights<0, double> const &, double const *, int, std::ptrdiff_t,
                             double *const *);
template void SumUpPatchAvx2(PatchWeights<1, float> const &, float const *, int, std::ptrdiff_t,
                             float *const *);
template void SumUpPatchAvx2(PatchWeights<1, double> const &, double const *, int, std::ptrdiff_t,
                             double *const *);
template void SumUpPatchAvx2(PatchWeights<2, float> const &, float const *, int, std::ptrdiff_t,
                             float *const *);
template void SumUpPatchAvx2(PatchWeights<2, double> const &, double const *, int, std::ptrdiff_t,
                             double *const *);

} // namespace OpenSubdivHex::BfrExt::internal

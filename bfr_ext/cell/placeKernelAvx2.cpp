// SPDX-License-Identifier: Apache-2.0
#include "patchSumsTemplate.h"
#include "placeKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

template <typename REAL>
SumKernels<REAL> GetAvx2Kernels() {
    return {sumUpPlaces<32, REAL>, sumUpPatch<REAL>};
}

template SumKernels<float> GetAvx2Kernels();
template SumKernels<double> GetAvx2Kernels();

} // namespace OpenSubdivHex::BfrExt::internal

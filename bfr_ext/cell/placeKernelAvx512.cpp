// SPDX-License-Identifier: Apache-2.0
#include "patchSumsTemplate.h"
#include "placeKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

template <typename REAL>
SumKernels<REAL> GetAvx512Kernels() {
    return {sumUpPlaces<64, REAL>, sumUpPatch<REAL>};
}

template SumKernels<float> GetAvx512Kernels();
template SumKernels<double> GetAvx512Kernels();

} // namespace OpenSubdivHex::BfrExt::internal

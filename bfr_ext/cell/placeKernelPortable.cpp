// SPDX-License-Identifier: Apache-2.0
#include "patchSumsTemplate.h"
#include "placeKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

template <typename REAL>
SumKernels<REAL> GetPortableKernels() {
    return {sumUpPlaces<16, REAL>, sumUpPatch<REAL>};
}

template SumKernels<float> GetPortableKernels();
template SumKernels<double> GetPortableKernels();

} // namespace OpenSubdivHex::BfrExt::internal

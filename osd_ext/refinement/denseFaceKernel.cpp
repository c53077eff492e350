// SPDX-License-Identifier: Apache-2.0
#include "denseFaceKernel.h"

#include "osd_ext/simdLevel.h"

namespace OpenSubdivHex::OsdExt::internal {

DenseFaceKernels const &GetDenseFaceKernels() {
    switch (GetSimdLevel()) {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    case SimdLevel::Avx512:
        return kDenseFaceKernelsAvx512;
    case SimdLevel::Avx2:
        return kDenseFaceKernelsAvx2;
#endif
    default:
        return kDenseFaceKernelsPortable;
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "irregularFaceKernel.h"

#include "osd_ext/simdLevel.h"

namespace OpenSubdivHex::OsdExt::internal {

IrregularFaceKernels const &GetIrregularFaceKernels() {
    switch (GetSimdLevel()) {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    case SimdLevel::Avx512:
        return kIrregularFaceKernelsAvx512;
    case SimdLevel::Avx2:
        return kIrregularFaceKernelsAvx2;
#endif
    default:
        return kIrregularFaceKernelsPortable;
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

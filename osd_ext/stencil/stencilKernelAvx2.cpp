// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX2 and FMA; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "octetPackets.h"

namespace OpenSubdivHex::OsdExt::internal {

void EvalStencilsAvx2(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    evalStencilsAs<OctetSimd<Avx2Octet, 2>>(task, begin, end, firstWeight);
}

} // namespace OpenSubdivHex::OsdExt::internal

#endif

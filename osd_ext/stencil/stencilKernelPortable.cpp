// SPDX-License-Identifier: Apache-2.0
#include "octetPackets.h"

namespace OpenSubdivHex::OsdExt::internal {

void EvalStencilsPortable(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    evalStencilsAs<OctetSimd<PortableOctet, 1>>(task, begin, end, firstWeight);
}

} // namespace OpenSubdivHex::OsdExt::internal

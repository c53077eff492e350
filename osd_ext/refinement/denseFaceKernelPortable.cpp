// SPDX-License-Identifier: Apache-2.0
#include "denseFaceKernelTemplate.h"

namespace OpenSubdivHex::OsdExt::internal {

DenseFaceKernels const kDenseFaceKernelsPortable = kKernelsOfRows<OneRow>;

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "limitKernelTemplate.h"

namespace OpenSubdivHex::OsdExt::internal {

LimitKernel const kLimitKernelPortable = LimitKernels<OneFace>::kKernel;

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "irregularFaceKernelTemplate.h"

namespace OpenSubdivHex::OsdExt::internal {

IrregularFaceKernels const kIrregularFaceKernelsPortable = kKernelsOfRows<OneRow>;

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_EVALUATION_CHECKS_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_EVALUATION_CHECKS_H

#include "osd_ext/refinementEvaluator.h"

namespace OpenSubdivHex::OsdExt::internal {

/// Whether \p level is one of 0 ... \p maxLevel.
OPENSUBDIVHEX_API FarExt::CallStatus CheckLevel(int level, int maxLevel);

/// Whether the descriptors of a source and a destination fit one another.
OPENSUBDIVHEX_API FarExt::CallStatus CheckDescriptors(Osd::BufferDescriptor const &srcDesc,
                                                      Osd::BufferDescriptor const &dstDesc);

} // namespace OpenSubdivHex::OsdExt::internal

#endif

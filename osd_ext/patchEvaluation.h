// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_PATCH_EVALUATION_H
#define OPENSUBDIVHEX_OSD_EXT_PATCH_EVALUATION_H

#include "far_ext/export.h"

#include <opensubdiv/osd/bufferDescriptor.h>
#include <opensubdiv/osd/types.h>

namespace OpenSubdivHex {

namespace Osd = OpenSubdiv::Osd;

namespace OsdExt::internal {

/// Where values at places of patches go, or one of their derivatives; null: nowhere.
struct PatchOutput {
    float *dst;
    Osd::BufferDescriptor desc;
};

/// \brief Places of patches to be evaluated, as Osd's evaluators have them.
struct PatchTask {
    float const *src;
    Osd::BufferDescriptor srcDesc;
    PatchOutput outputs[6]; ///< values; by s and t; by s twice, by s and t, by t twice
    Osd::PatchCoord const *coords;
    Osd::PatchArray const *arrays;
    int const *indices;
    Osd::PatchParam const *params;
};

/// Whether the descriptors are ones that can be evaluated, and all is there.
OPENSUBDIVHEX_API bool CheckPatchTask(PatchTask const &task, int numCoords);
/// Evaluates places [begin, end), with the same bits whatever the range.
OPENSUBDIVHEX_API void EvaluatePatches(PatchTask const &task, int begin, int end);

} // namespace OsdExt::internal
} // namespace OpenSubdivHex

#endif

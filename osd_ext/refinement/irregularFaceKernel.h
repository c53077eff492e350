// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_IRREGULAR_FACE_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_IRREGULAR_FACE_KERNEL_H

#include "elementAccess.h"

namespace OpenSubdivHex::OsdExt::internal {

/// \brief Hexagons that follow one another, of which some are irregular and the others plain.
struct IrregularFaceTask {
    PlainFaceMask const *plainMask;
    IrregularFaceMask const *masks; ///< by type
    int const *types;               ///< of irregular faces
    IrregularRun const *irregular;  ///< the first that end behind begin
    Far::Index begin;               ///< their first corner
    Far::Index end;
    Far::Index const *verts; ///< by corner
    Elements<float const> src;
    Elements<float> dst; ///< F-vertices, by corner
};

/// \brief The kernels of one SimdLevel, by the number of floats less 1, as those of Access; all are
/// instances of irregularFaceKernelTemplate.h.
struct IrregularFaceKernels {
    using Kernel = void (*)(IrregularFaceTask const &task);

    Kernel packed[kQuad];
    Kernel strided[kQuadPair];
};

extern IrregularFaceKernels const kIrregularFaceKernelsPortable;
extern IrregularFaceKernels const kIrregularFaceKernelsAvx2;
extern IrregularFaceKernels const kIrregularFaceKernelsAvx512;

/// Those of the SimdLevel in use.
IrregularFaceKernels const &GetIrregularFaceKernels();

} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_DENSE_FACE_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_DENSE_FACE_KERNEL_H

#include "elementAccess.h"

namespace OpenSubdivHex::OsdExt::internal {

/// \brief Hexagons that follow one another, of which some have dense rules and the others the plain mask.
struct DenseFaceTask {
    PlainFaceMask const *plainMask;
    DenseFaceMask const *masks;                             ///< by rule
    FarExt::internal::RefinementRules::FaceRun const *runs; ///< from that of the first face on
    Far::Index begin;                                       ///< the first face
    Far::Index end;
    Far::Index firstCorner;  ///< its first corner
    Far::Index const *verts; ///< by corner
    Elements<float const> src;
    Elements<float> dst; ///< F-vertices, by corner
};

/// \brief The kernels of one SimdLevel, by the number of floats less 1, as those of Access; all are
/// instances of denseFaceKernelTemplate.h.
struct DenseFaceKernels {
    using Kernel = void (*)(DenseFaceTask const &task);

    Kernel packed[kQuad];
    Kernel strided[kQuadPair];
};

extern DenseFaceKernels const kDenseFaceKernelsPortable;
extern DenseFaceKernels const kDenseFaceKernelsAvx2;
extern DenseFaceKernels const kDenseFaceKernelsAvx512;

/// The kernels of the SimdLevel in use.
DenseFaceKernels const &GetDenseFaceKernels();

} // namespace OpenSubdivHex::OsdExt::internal

#endif

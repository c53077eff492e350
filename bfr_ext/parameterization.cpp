// SPDX-License-Identifier: Apache-2.0
#include "parameterization.h"

#include "far_ext/vtr/faceCoords.h"

namespace OpenSubdivHex::BfrExt {

Parameterization::Parameterization(int faceSize)
    : OpenSubdiv::Bfr::Parameterization(FarExt::internal::MakeFaceParameterization(faceSize)) {}

} // namespace OpenSubdivHex::BfrExt

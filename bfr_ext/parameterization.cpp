// SPDX-License-Identifier: Apache-2.0
#include "parameterization.h"

#include "far_ext/vtr/basePolygon.h"

namespace OpenSubdivHex::BfrExt {

void Parameterization::findCoords(int edge, double start, double end, double uv[2]) const {
    FarExt::internal::BasePolygon(_faceSize).Write(edge, {start, end}, uv);
}

} // namespace OpenSubdivHex::BfrExt

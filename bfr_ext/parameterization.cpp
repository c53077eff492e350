// SPDX-License-Identifier: Apache-2.0
#include "parameterization.h"

#include "bfr_ext/cell/cellStencil.h"
#include "far_ext/vtr/faceCoords.h"

namespace OpenSubdivHex::BfrExt {

Parameterization::Parameterization(FarExt::FaceShape shape)
    : OpenSubdiv::Bfr::Parameterization(FarExt::internal::MakeFaceParameterization(shape.size)),
      _isHalf(shape.isHalf) {}

template <typename REAL>
void Parameterization::ConvertToPlane(REAL const uv[2], REAL xy[2]) const {
    auto const coords = FarExt::internal::FindInPlane(*this, {uv[0], uv[1]}).coords;
    xy[0] = REAL(coords[0]);
    xy[1] = REAL(coords[1]);
}

template <typename REAL>
void Parameterization::ConvertFromPlane(REAL const xy[2], REAL uv[2]) const {
    FarExt::internal::BasePolygon::Pair coords = {xy[0], xy[1]};
    if (HasSubFaces()) {
        internal::BasePoint const point =
            internal::FindBasePoint(GetFaceSize(), coords[0], coords[1], 0);
        coords =
            FarExt::internal::FindFaceCoords(*this, FarExt::internal::BasePolygon(GetFaceSize()),
                                             point.sector, {point.coords[0], point.coords[1]});
    }
    uv[0] = REAL(coords[0]);
    uv[1] = REAL(coords[1]);
}

template void Parameterization::ConvertToPlane(float const[2], float[2]) const;
template void Parameterization::ConvertToPlane(double const[2], double[2]) const;
template void Parameterization::ConvertFromPlane(float const[2], float[2]) const;
template void Parameterization::ConvertFromPlane(double const[2], double[2]) const;

} // namespace OpenSubdivHex::BfrExt

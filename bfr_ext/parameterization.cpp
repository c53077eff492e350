// SPDX-License-Identifier: Apache-2.0
#include "parameterization.h"

#include "cell/bfrPlace.h"

#include "far_ext/vtr/basePolygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::BfrExt {

void Parameterization::findCoords(int edge, double start, double end, double uv[2]) const {
    FarExt::internal::BasePolygon(_faceSize).Write(edge, {start, end}, uv);
}

OpenSubdiv::Bfr::Parameterization Parameterization::GetBfr() const {
    return {_faceSize == 3 ? OpenSubdiv::Sdc::SCHEME_LOOP : OpenSubdiv::Sdc::SCHEME_CATMARK,
            _faceSize};
}

void Parameterization::convertFromBfr(OpenSubdiv::Bfr::Parameterization const &bfr,
                                      double const bfrUv[2], double result[6]) {
    if (!bfr.IsValid() || !std::isfinite(bfrUv[0]) || !std::isfinite(bfrUv[1])) {
        std::fill_n(result, 6, std::numeric_limits<double>::quiet_NaN());
        return;
    }
    auto const [uv, byU, byV] = internal::FindInPlane(bfr, {bfrUv[0], bfrUv[1]});
    for (std::size_t i = 0; i < 2; ++i) {
        result[i] = uv[i];
        result[2 + i] = byU[i];
        result[4 + i] = byV[i];
    }
}

} // namespace OpenSubdivHex::BfrExt

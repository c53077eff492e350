// SPDX-License-Identifier: Apache-2.0
#include "placeSource.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

// The derivatives are by Bfr's u and v.
template <typename REAL>
typename PlaceSource<REAL>::Matrices
PlaceSource<REAL>::MakeMatrices(std::vector<BfrPlace> const &places, bool hasDerivatives) const {
    CellStencil stencil(*type, GetSources());
    if (!hasDerivatives) {
        return {{MakeMatrix(places.size(),
                            [&](std::size_t row) -> std::vector<double> const & {
                                stencil.Find(places[row].point, false);
                                return stencil.GetWeights(0);
                            })},
                1};
    }
    std::vector<std::array<std::vector<double>, 2>> rows;
    for (BfrPlace const &place : places) {
        stencil.Find(place.point, true);
        std::array<std::vector<double>, 2> &row =
            rows.emplace_back(std::array{stencil.GetWeights(1), stencil.GetWeights(2)});
        // Vertices of the face have the derivatives of the face.
        if (ringCell && !type->IsWhole() && place.point.coords == HalfCell::kCorners[0]) {
            CellType::Derivatives const &ofFace = type->GetDerivatives(0, GetSources(), true);
            row = {ofFace.rows[0], ofFace.rows[1]};
        }
        double *const first[2] = {row[0].data(), row[1].data()};
        ToUv<double>(place, row[0].size(), first, nullptr);
    }
    auto const make = [&](std::size_t k) {
        return MakeMatrix(places.size(), [&](std::size_t row) -> std::vector<double> const & {
            return rows[row][k];
        });
    };
    return {{make(0), make(1)}, 2};
}

template struct PlaceSource<float>;
template struct PlaceSource<double>;

} // namespace OpenSubdivHex::BfrExt::internal

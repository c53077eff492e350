// SPDX-License-Identifier: Apache-2.0
#include "cellPattern.h"

namespace OpenSubdivHex::BfrExt::internal {

template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, std::vector<BasePoint> const &places,
                               std::size_t numBorderPlaces) {
    CellStencil stencil(root);
    std::vector<std::vector<double>> stencils;
    for (std::size_t place = numBorderPlaces; place < places.size(); ++place) {
        stencil.Find(places[place], false);
        stencils.push_back(stencil.GetWeights());
    }
    constexpr std::size_t kEven = 0;
    matrices.emplace_back(Symmetries(root, Symmetries::Kind::Reflections), places, numBorderPlaces,
                          stencils, kEven);
}

// Derivatives are from the side of a cell, so that they are not reflected.
template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, std::vector<BasePoint> const &places) {
    CellStencil stencil(root);
    std::vector<std::vector<double>> duStencils;
    std::vector<std::vector<double>> dvStencils;
    for (BasePoint const &place : places) {
        stencil.Find(place, true);
        duStencils.push_back(stencil.GetDuWeights());
        dvStencils.push_back(stencil.GetDvWeights());
    }
    Symmetries const symmetries(root, Symmetries::Kind::HalfTurn);
    std::size_t const odd = symmetries.GetNumImages() - 1;
    for (auto const *stencils : {&duStencils, &dvStencils}) {
        matrices.emplace_back(symmetries, places, 0, *stencils, odd);
    }
}

template struct CellPattern<float>;
template struct CellPattern<double>;

} // namespace OpenSubdivHex::BfrExt::internal

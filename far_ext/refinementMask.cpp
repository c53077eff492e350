// SPDX-License-Identifier: Apache-2.0
#include "refinementMask.h"

#include <algorithm>
#include <set>

namespace OpenSubdivHex::FarExt::internal {

template <typename REAL>
RefinementMask<REAL>::RefinementMask(TopologyRefiner const &refiner, Interpolation interpolation)
    : _interpolation(interpolation) {
    // F-faces keep the size of their parent, so all sizes are those of the base and of E-faces.
    std::set<int> sizes = {HexIndexing::kNumEFaceCorners, HexIndexing::kNumBoundaryEFaceCorners};
    TopologyLevel const &base = refiner.GetLevel(0);
    for (Index face = 0; face < base.GetNumFaces(); ++face) {
        sizes.insert(base.GetFaceVertices(face).size());
    }
    FaceMask const faceMask = refiner.GetHexSchemeOptions().faceMask;
    for (int size : sizes) {
        std::vector<REAL> &mask = _faceMasks[size];
        mask.resize(2 * std::size_t(size));
        ComputeFaceVertexMask(faceMask, interpolation, size, mask.data());
        std::copy_n(mask.begin(), size, mask.begin() + size);
    }
}

template class RefinementMask<float>;
template class RefinementMask<double>;

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "patchSumsTemplate.h"
#include "placeKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

void SumUpPlacesPortable(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums) {
    sumUpPlaces<16>(matrix, sums);
}

void SumUpPlacesPortable(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums) {
    sumUpPlaces<16>(matrix, sums);
}

void SumUpPatchPortable(PatchSums<float> const &sums) { sumUpPatch(sums); }

void SumUpPatchPortable(PatchSums<double> const &sums) { sumUpPatch(sums); }

} // namespace OpenSubdivHex::BfrExt::internal

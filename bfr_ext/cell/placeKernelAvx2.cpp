// SPDX-License-Identifier: Apache-2.0
#include "patchSumsTemplate.h"
#include "placeKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

void SumUpPlacesAvx2(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums) {
    sumUpPlaces<32>(matrix, sums);
}

void SumUpPlacesAvx2(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums) {
    sumUpPlaces<32>(matrix, sums);
}

void SumUpPatchAvx2(PatchSums<float> const &sums) { sumUpPatch(sums); }

void SumUpPatchAvx2(PatchSums<double> const &sums) { sumUpPatch(sums); }

} // namespace OpenSubdivHex::BfrExt::internal

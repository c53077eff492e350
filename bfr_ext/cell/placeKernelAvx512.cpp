// SPDX-License-Identifier: Apache-2.0
#include "patchSumsTemplate.h"
#include "placeKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

void SumUpPlacesAvx512(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums) {
    sumUpPlaces<64>(matrix, sums);
}

void SumUpPlacesAvx512(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums) {
    sumUpPlaces<64>(matrix, sums);
}

void SumUpPatchAvx512(PatchSums<float> const &sums) { sumUpPatch(sums); }

void SumUpPatchAvx512(PatchSums<double> const &sums) { sumUpPatch(sums); }

} // namespace OpenSubdivHex::BfrExt::internal

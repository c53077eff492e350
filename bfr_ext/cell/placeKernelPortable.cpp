// SPDX-License-Identifier: Apache-2.0
#include "placeKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

void SumUpPlacesPortable(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums) {
    sumUpPlaces<16>(matrix, sums);
}

void SumUpPlacesPortable(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums) {
    sumUpPlaces<16>(matrix, sums);
}

void SumUpPlacesPortable(std::array<PlaceMatrix<float>, 2> const &matrices,
                         DerivativeSums<float> const &sums) {
    sumUpPlaces<16>(matrices, sums);
}

void SumUpPlacesPortable(std::array<PlaceMatrix<double>, 2> const &matrices,
                         DerivativeSums<double> const &sums) {
    sumUpPlaces<16>(matrices, sums);
}

void SumUpPlacesPortable(PlaceMatrix<float> const &matrix, ItemSums<float> const &sums) {
    sumUpPlaces<16>(matrix, sums);
}

void SumUpPlacesPortable(PlaceMatrix<double> const &matrix, ItemSums<double> const &sums) {
    sumUpPlaces<16>(matrix, sums);
}

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "laneKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

void MultiplyAvx512(LaneProduct<float> const &product) { multiply<64>(product); }

void MultiplyAvx512(LaneProduct<double> const &product) { multiply<64>(product); }

} // namespace OpenSubdivHex::BfrExt::internal

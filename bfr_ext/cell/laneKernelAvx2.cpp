// SPDX-License-Identifier: Apache-2.0
#include "laneKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

void MultiplyAvx2(LaneProduct<float> const &product) { multiply<32>(product); }

void MultiplyAvx2(LaneProduct<double> const &product) { multiply<32>(product); }

} // namespace OpenSubdivHex::BfrExt::internal

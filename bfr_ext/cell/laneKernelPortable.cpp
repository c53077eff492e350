// SPDX-License-Identifier: Apache-2.0
#include "laneKernelTemplate.h"

namespace OpenSubdivHex::BfrExt::internal {

void MultiplyPortable(LaneProduct<float> const &product) { multiply<16>(product); }

void MultiplyPortable(LaneProduct<double> const &product) { multiply<16>(product); }

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_BASE_DIFFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_BASE_DIFFERENCE_H

#include "far_ext/topologyRefiner.h"

#include <opensubdiv/far/topologyLevel.h>

#include <string>

namespace OpenSubdivHex::Regression {

/// \brief Describes a difference between the levels 0 of two refiners, in any relation, tag, mask or channel, bit
/// by bit; empty if there is none.
std::string FindBaseDifference(FarExt::TopologyRefiner const &a, FarExt::TopologyRefiner const &b);

/// \brief Describes a difference between level 0 and the base level of Far: the numbers of edges and of
/// the components of faces, and tags.
std::string FindFarDifference(FarExt::TopologyRefiner const &refiner,
                              Far::TopologyLevel const &farLevel);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_REGION_MATCH_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_REGION_MATCH_H

#include "far_ext/topologyRefiner.h"
#include "regression/shapes/shapes.h"

#include <string>

namespace OpenSubdivHex::Regression {

/// \brief Compares the base faces of all faces and halves, and the holes, with the regions that the
/// reference finds between the lines of the base edges.
///
/// The reference refines the mesh with all of its edges infinitely sharp, which does not change what
/// is numbered how, and so has the halves as faces of their own.
///
/// \param refiner  of \p shape, refined uniformly by hexagonal steps
/// \return         empty when all are the same
std::string FindRegionError(Shape const &shape, FarExt::TopologyRefiner const &refiner);

} // namespace OpenSubdivHex::Regression

#endif

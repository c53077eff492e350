// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_ROW_STEPS_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_ROW_STEPS_H

#include "limitRows.h"

#include "far_ext/vtr/refinementMask.h"

#include <array>
#include <map>

namespace OpenSubdivHex::FarExt::internal {

/// The weights of a vertex for the point, du and dv.
using LimitWeights = std::array<double, 3>;

/// A LimitRow by vertex, in which a vertex comes once.
using SteppedRow = std::map<Far::Index, LimitWeights>;

/// \brief The row of a vertex of level \p cLevel in terms of the vertices of \p level, one before it.
OPENSUBDIVHEX_API SteppedRow StepRowBack(MeshLevels const &mesh,
                                         HexSchemeOptions const &schemeOptions,
                                         LimitRow const &ofVertex, int cLevel, int level);

} // namespace OpenSubdivHex::FarExt::internal

#endif

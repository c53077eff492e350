// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_UNIT_SIZE_H
#define OPENSUBDIVHEX_TOOLS_UNIT_SIZE_H

#include "tools/mesh/shownVertices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Multiplies \p positions by the power of two that makes the largest coordinate of \p vertices
/// 1/2 to 1.  A picture of them stays the same, and squares of lengths stay in the range of floats.
///
/// \tparam REAL      float or double
/// \param vertices   of FindShownVertices()
/// \param positions  x y z of all vertices.  Coordinates of others become the largest numbers that
///                   there are where the products are larger
template <typename REAL>
void ScaleToUnitSize(std::vector<int> const &vertices, std::vector<REAL> *positions) {
    REAL largest = 0;
    for (REAL const position : GatherPositions(vertices, *positions)) {
        largest = std::max(largest, std::fabs(position));
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    using Limits = std::numeric_limits<REAL>;
    for (REAL &position : *positions) {
        position = std::clamp(std::ldexp(position, -exponent), Limits::lowest(), Limits::max());
    }
}

} // namespace OpenSubdivHex::Tools

#endif

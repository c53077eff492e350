// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_UNIT_SIZE_H
#define OPENSUBDIVHEX_TOOLS_UNIT_SIZE_H

#include <algorithm>
#include <cmath>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Multiplies \p positions by the power of two that makes the largest coordinate 1/2 to 1.
/// A picture of them stays the same, and squares of lengths stay in the range of floats.
///
/// \tparam REAL  float or double
template <typename REAL>
void ScaleToUnitSize(std::vector<REAL> *positions) {
    REAL largest = 0;
    for (REAL position : *positions) {
        largest = std::max(largest, std::fabs(position));
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (REAL &position : *positions) {
        position = std::ldexp(position, -exponent);
    }
}

} // namespace OpenSubdivHex::Tools

#endif

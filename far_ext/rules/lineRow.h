// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_LINE_ROW_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_LINE_ROW_H

#include "quadLine.h"

#include <cstdint>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Where a face lies beside a line whose edges are A and B in turn.  Where it is regular, there are two rows of
/// hexagons.
///
/// A place of such a face is one of its corners, counted counter-clockwise from the one where the edge next to the
/// line begins.
enum class LineFace : std::uint16_t {
    OnLine,     ///< a hexagon on an A edge, which begins at place 0, between two half hexagons
    Half,       ///< half a polygon V, W ... with the B edge V-W, whose two ends are both place 0
    Behind,     ///< a hexagon across the edge from Q to P of half a hexagon V, W, Q, P
    Beyond,     ///< a hexagon across the far edge, from place 3 to 4, of one on an A edge
    OnOtherLine ///< any other face on an A edge: it has no masks, but faces that it makes have
};

/// Finds the masks of a corner beside a regular line, at a level that \p numSteps hexagonal steps made behind a truncation.
/// Of half a hexagon there are four weights.
MaskRow FindLineRow(int numSteps, LineFace face, int place);

} // namespace OpenSubdivHex::FarExt::internal

#endif

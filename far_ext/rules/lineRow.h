// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_LINE_ROW_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_LINE_ROW_H

#include <cstdint>

namespace OpenSubdivHex::FarExt::internal {

/// The hexagonal steps behind a truncation that have masks of their own beside lines.
inline constexpr int kNumLineSteps = 3;

/// \brief Where a face lies beside a regular line, whose edges are A and B in turn: two rows of hexagons.
///
/// A place of such a face is one of its corners, counted counter-clockwise from the one where the edge next to the
/// line begins.
enum class LineFace : std::uint16_t {
    OnLine, ///< on an A edge, which begins at place 0
    Half, ///< half a polygon, V, W ..., whose long edge is the B edge; the two ends of that are both place 0
    Behind, ///< across the edge from Q to P of half a hexagon V, W, Q, P
    Beyond  ///< across the far edge, from place 3 to 4, of a hexagon OnLine
};

/// \brief The masks of a corner beside a regular line.
struct LineRow {
    /// In a hexagon, or, of four weights, in half of one, from the corner on forward around the face, or backward; null
    /// where there is none.
    double const *mask;
    bool isBackwards;
    /// The weight of the corner's F-vertex in V' of its vertex; negative where there is none.
    double vertexWeight;
};

/// Finds the masks of a corner at a level that \p numSteps hexagonal steps made behind a truncation.
LineRow FindLineRow(int numSteps, LineFace face, int place);

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_LINE_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_LINE_H

#include "maskTable.h"

#include "far_ext/export.h"

#include <algorithm>
#include <cstdint>

namespace OpenSubdivHex::FarExt::internal {

/// The hexagonal steps that have masks of their own beside lines.
inline constexpr int kNumLineSteps = 3;

/// \brief What a line is to a flag.
enum class LineRole {
    Away, ///< the line is at the other end of an edge of the corner
    At    ///< it passes the corner
};
/// In the order in which their masks are mixed in: where a line at the corner is as sharp, no other one matters.
inline constexpr LineRole kLineRoles[] = {LineRole::Away, LineRole::At};

/// \brief A flag of a quad beside a smooth line, before the first step.
///
/// The line has kMinQuads to kMaxQuads quads on this side of one of its vertices, L.
struct LineFlag {
    static constexpr int kMinQuads = 2;
    static constexpr int kMaxQuads = 4;
    enum Kind : std::int8_t {
        /// At L; counted from the line: kAtLine along it, kAtLine + 1 with the other edge of that quad ...
        kAtLine,
        /// At another end of an edge of L, with that edge, in a quad that has an edge of the line at L.
        kDown = 4,
        kTop,        ///< at that corner, with the other edge
        kDownBehind, ///< as kDown, in a quad that has no edge of the line at L
        kTopBehind   ///< as kTop, there
    };
    static constexpr int kNumKinds = 8;

    int numQuads; ///< at L
    Kind kind;

    LineRole GetRole() const { return kind < kDown ? LineRole::At : LineRole::Away; }
};

/// \brief The share of the masks beside a line.
struct LineSharpness {
    float line; ///< sharpness of the line, less one for each step
    float
        cross; ///< likewise, of the sharpest of what else is there: masks beside the line end where it is as sharp

    float GetShare() const { return std::max(0.0f, std::min(1.0f, line) - std::min(1.0f, cross)); }
};

/// \brief A flag, as QuadFlag, of a quad beside smooth lines, with the path by which it came from there: one of a line that
/// it is at, and one of another that it is at the other end of an edge from; 0 for any other.
using QuadLineFlag = std::uint16_t;

/// Makes a flag before the first step one beside a line, too.
QuadLineFlag AddLineFlag(QuadLineFlag flag, LineFlag ofLine);

/// \brief The two flags of a corner beside lines, one with each of its edges.
struct QuadLineFlags {
    QuadLineFlag out; ///< with the edge that begins at the corner
    QuadLineFlag in;  ///< with the edge that ends there
    /// By LineRole, of each flag.
    LineSharpness outLines[2];
    LineSharpness inLines[2];

    bool HasAny() const { return out != 0 || in != 0; }
    /// The corner with the flag of one edge for both.
    QuadLineFlags GetOut() const {
        return {out, out, {outLines[0], outLines[1]}, {outLines[0], outLines[1]}};
    }
    QuadLineFlags GetIn() const {
        return {in, in, {inLines[0], inLines[1]}, {inLines[0], inLines[1]}};
    }
};

/// Makes the flags that a step appends these digits to (see QuadFlag); \p numSteps hexagonal steps made the level that has
/// \p flags.
QuadLineFlags AppendToQuadLineFlags(QuadLineFlags const &flags, int numSteps, int outDigit,
                                    int inDigit);

/// \brief The masks of a corner beside a line, and their share.
struct QuadLineRow {
    MaskRow row;
    bool isOfHalf; ///< of half a hexagon on the line: four weights
    double share;  ///< 0 where there is no row
};
/// Finds those, of flags that both have the role; the share is the lesser of theirs.
OPENSUBDIVHEX_API QuadLineRow FindQuadLineRow(int numSteps, QuadLineFlags const &flags,
                                              LineRole role);

} // namespace OpenSubdivHex::FarExt::internal

#endif

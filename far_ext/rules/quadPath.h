// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_PATH_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_PATH_H

#include "maskTable.h"

#include "far_ext/hexSchemeOptions.h"

#include <algorithm>
#include <cstdint>

namespace OpenSubdivHex::FarExt::internal {

/// The hexagonal steps that have masks of their own beside lines.
inline constexpr int kNumLineSteps = 3;

/// \brief A flag, a corner of a face and one of its two edges there, as what hexagonal steps made of a flag of a quad;
/// 0 for any other.
///
/// A *path* tells it: one digit for each step, in which the flag became one of
///
/// | digit | where                                                                             |
/// |-------|-----------------------------------------------------------------------------------|
/// | 0     | in the F-face                                                                     |
/// | 1     | in the E-face of its edge, at the F-vertex, with the edge along the F-face        |
/// | 2     | there, with the spoke                                                             |
/// | 3     | in that E-face, at the V-vertex, with the spoke                                   |
///
/// From kNumStepsToConstantMasks steps on there are the flags alone that lie near a vertex of the quads, whose path
/// begins with 3 3 ... 3, or near a quad, 0 0 ... 0; of the path the last two digits matter.
///
/// Beside smooth lines a flag has the LineFlags that it came from, too, for kNumLineSteps levels: one of a line that it
/// is at, and one of another that it is at the other end of an edge from.
using QuadFlag = std::uint16_t;

/// \brief What a line is to a flag.
enum class LineRole {
    Away, ///< the line is at the other end of an edge of the corner
    At    ///< it passes the corner
};
/// In the order in which their masks are mixed in: where a line at the corner is as sharp, no other one matters.
inline constexpr LineRole kLineRoles[] = {LineRole::Away, LineRole::At};

/// \brief A flag of a quad beside a smooth line, before the first step.
///
/// The line has 1 to kMaxQuads quads on this side of one of its vertices, L.
struct LineFlag {
    static constexpr int kMaxQuads = 4;
    enum Kind : std::int8_t {
        /// At L; counted from the line: kAtLine along it, kAtLine + 1 with the other edge of that quad ...
        kAtLine,
        /// At another end of an edge of L, with that edge, in a quad that has an edge of the line at L.  If L has one quad,
        /// at the next vertex of the line, which has two.
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

/// The flag at a vertex that has \p numFaces faces, all of them quads, before the first step.
OPENSUBDIVHEX_API QuadFlag MakeQuadFlag(int numFaces);
/// The flag at any vertex inside a mesh; 0 where a face is no quad.  getFaceSize(i) is the size of face i around it.
template <typename GETFACESIZE>
QuadFlag FindQuadFlag(int numFaces, GETFACESIZE const &getFaceSize) {
    for (int i = 0; i < numFaces; ++i) {
        if (getFaceSize(i) != 4) {
            return 0;
        }
    }
    return MakeQuadFlag(numFaces);
}
/// A flag before the first step, which may be 0, as one beside a line, too, or as one beside another.
QuadFlag AddLineFlag(QuadFlag flag, LineFlag ofLine);

/// \brief The share of the masks beside a line.
struct LineSharpness {
    float line; ///< sharpness of the line, less one for each step
    float
        cross; ///< likewise, of the sharpest of what else is there: masks beside the line end where it is as sharp

    float GetShare() const { return std::max(0.0f, std::min(1.0f, line) - std::min(1.0f, cross)); }
};

/// \brief The two flags of a corner, one with each of its edges: both came from one vertex of quads.
struct QuadFlags {
    QuadFlag out; ///< with the edge that begins at the corner
    QuadFlag in;  ///< with the edge that ends there
    /// The sharpness of the sharpest edge there, or of the vertex itself, before the first step, less one for each step.
    float sharpness;
    /// By LineRole, of flags beside lines.
    LineSharpness outLines[2];
    LineSharpness inLines[2];

    bool HasAny() const { return out != 0 || in != 0; }
    /// Whether a flag is beside a line.
    OPENSUBDIVHEX_API bool HasLine() const;
    /// The share of the masks that the paths tell; other masks have the rest.
    float GetShare() const { return sharpness < 1 ? 1 - sharpness : 0; }
};

/// Makes the flags that a step appends these digits to; \p numSteps hexagonal steps made the level that has \p flags.
QuadFlags AppendToQuadFlags(QuadFlags flags, int numSteps, int outDigit, int inDigit);

/// \brief Finds the masks of a corner by the paths of its flags, at a level that \p numSteps hexagonal steps made: those
/// of quads inside a mesh, whose mask is of hexagons.
OPENSUBDIVHEX_API MaskRow FindQuadRow(int numSteps, QuadFlags flags);

/// \brief The masks of a corner beside a line, and their share.
struct QuadLineRow {
    MaskRow row;
    bool isOfHalf; ///< of half a hexagon on the line: four weights
    double share;  ///< 0 where there is no row
};
/// Finds those, of flags that both have the role; the share is the lesser of theirs.
OPENSUBDIVHEX_API QuadLineRow FindQuadLineRow(int numSteps, QuadFlags flags, LineRole role);

} // namespace OpenSubdivHex::FarExt::internal

#endif

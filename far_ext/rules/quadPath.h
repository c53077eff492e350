// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_PATH_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_PATH_H

#include "far_ext/hexSchemeOptions.h"

#include <cstdint>

namespace OpenSubdivHex::FarExt::internal {

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
/// For kNumStepsOfLineMasks steps, the path of a quad in the first row beside a sharp line has the flag's place there, too.
using QuadFlag = std::uint16_t;

/// The hexagonal steps that have masks of their own in the first row of quads beside a sharp line.
inline constexpr int kNumStepsOfLineMasks = 3;

/// The edge of a flag in a quad that a sharp line runs along, seen from the corner.
enum class LineFlag { Along = 1, Up, Down, Top };

/// The flag at a vertex that has \p numFaces faces, all of them quads, before the first step.
OPENSUBDIVHEX_API QuadFlag MakeQuadFlag(int numFaces);
/// The flag in the first row beside a line, before the first step.
QuadFlag MakeLineQuadFlag(LineFlag flag);
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

/// A flag, and the sharpness of the sharpest edge at its vertex, or of the vertex itself, before the first step, less one for
/// each step; in the first row beside a line, that of the line.
struct SharpQuadFlag {
    QuadFlag flag;
    float sharpness;
};

/// \brief The two flags of a corner, one with each of its edges: both came from one vertex of quads.
struct QuadFlags {
    QuadFlag out;    ///< with the edge that begins at the corner
    QuadFlag in;     ///< with the edge that ends there
    float sharpness; ///< the larger one, as of SharpQuadFlag

    bool HasAny() const { return out != 0 || in != 0; }
    /// @name Flags alone
    /// @{
    SharpQuadFlag GetOut() const;
    SharpQuadFlag GetIn() const;
    /// @}
};

/// The flags of a corner.
QuadFlags JoinQuadFlags(SharpQuadFlag out, SharpQuadFlag in);

/// Makes the flags that a step appends these digits to; \p numSteps hexagonal steps made the level that has \p flags.
QuadFlags AppendToQuadFlags(QuadFlags flags, int numSteps, int outDigit, int inDigit);

/// \brief What the paths of its flags tell of a corner's F-vertex.
struct QuadRow {
    /// In a face of \c size vertices, or half a hexagon, from the corner on forward around it, or backward; null where
    /// they tell none.
    double const (*mask)[6] = nullptr;
    int size = 0;
    bool isBackwards = false;
    /// The weight of the F-vertex in V' of the corner's vertex; negative where they tell none.
    double vertexWeight = -1;
    /// The weight of each neighbor in V' of a vertex on the line; behind a B edge beside an A edge, half of it.
    /// Negative where they tell none.
    double neighborWeight = -1;
    /// What the row has beside other masks.
    float share = 0;
    /// Of the row in quadRows.inl, or, plus the number of these, in quadLineRows.inl; negative where they tell none.
    int position = -1;

    bool HasMask() const { return mask && share > 0; }
};

/// Finds the row of a corner at a level that \p numSteps hexagonal steps made, regardless of lines that quads lie beside.
OPENSUBDIVHEX_API QuadRow FindQuadRow(int numSteps, QuadFlags flags);
/// \brief Finds the row of a corner in the first row of quads beside a line: where it and that of FindQuadRow() have
/// shares, they have all, and the latter what the former leaves.
OPENSUBDIVHEX_API QuadRow FindLineQuadRow(int numSteps, QuadFlags flags);
/// Whether a corner at a vertex on the line is in the first row of quads beside it, along both of its edges.
bool IsOnQuadLine(QuadFlags flags);

} // namespace OpenSubdivHex::FarExt::internal

#endif

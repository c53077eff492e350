// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_PATH_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_PATH_H

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
using QuadFlag = std::uint16_t;

/// \brief The vertex of quads that a flag was at, before the first step.  All faces there were quads.
enum class QuadVertex {
    Four, ///< inside of the mesh, with that many faces, and no edge there infinitely sharp
    Three,
    Five,
    Six,
    Other
};

QuadFlag MakeQuadFlag(QuadVertex vertex);

/// \brief Those of a corner, with its two edges: both came from one vertex of quads.
struct QuadFlags {
    QuadFlag out; ///< with the edge that begins at the corner
    QuadFlag in;  ///< with the edge that ends there
    /// Of the sharpest there was at the vertex of the quads, less one for each step since.
    float sharpness;

    bool HasAny() const { return out != 0 || in != 0; }
    /// Of the masks that the paths tell; others have what is left.
    float GetShare() const { return sharpness < 1 ? 1 - sharpness : 0; }
};

/// What a step makes of flags with these digits, at a level that \p numSteps hexagonal steps made.
QuadFlags AppendToQuadFlags(QuadFlags flags, int numSteps, int outDigit, int inDigit);

/// \brief What the paths of its flags tell of a corner's F-vertex.
struct QuadRow {
    /// In a hexagon, from the corner on forward around the face, or backward; null where they tell none.
    double const (*mask)[6];
    bool isBackwards;
    /// Its weight in V' of its vertex; negative where they tell none.
    double vertexWeight;
};

/// Of a corner at a level that \p numSteps hexagonal steps made.
QuadRow FindQuadRow(int numSteps, QuadFlags flags);

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_PATH_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_QUAD_PATH_H

#include "maskTable.h"

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
using QuadFlag = std::uint16_t;

/// The digits of a path are those of a number to this base.
inline constexpr int kQuadPathBase = 4;
/// The number of a path that is written as its digits.
int ReadQuadPath(char const *path);

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

/// \brief The two flags of a corner, one with each of its edges: both came from one vertex of quads.
struct QuadFlags {
    QuadFlag out; ///< with the edge that begins at the corner
    QuadFlag in;  ///< with the edge that ends there
    /// The sharpness of the sharpest edge there, or of the vertex itself, before the first step, less one for each step.
    float sharpness;

    bool HasAny() const { return out != 0 || in != 0; }
    /// The share of the masks that the paths tell; other masks have the rest.
    float GetShare() const { return sharpness < 1 ? 1 - sharpness : 0; }
};

/// Makes the flags that a step appends these digits to; \p numSteps hexagonal steps made the level that has \p flags.
QuadFlags AppendToQuadFlags(QuadFlags flags, int numSteps, int outDigit, int inDigit);

/// \brief Finds the masks of a corner by the paths of its flags, at a level that \p numSteps hexagonal steps made: those
/// of quads inside a mesh, whose mask is of hexagons.
OPENSUBDIVHEX_API MaskRow FindQuadRow(int numSteps, QuadFlags flags);

} // namespace OpenSubdivHex::FarExt::internal

#endif

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
using QuadFlag = std::uint16_t;

/// One at a vertex that has \p numFaces faces, all of them quads, before the first step.
OPENSUBDIVHEX_API QuadFlag MakeQuadFlag(int numFaces);
/// The same of any vertex inside of a mesh; 0 where a face, from getFaceSize(0) on, is no quad.
template <typename GETFACESIZE>
QuadFlag FindQuadFlag(int numFaces, GETFACESIZE const &getFaceSize) {
    for (int i = 0; i < numFaces; ++i) {
        if (getFaceSize(i) != 4) {
            return 0;
        }
    }
    return MakeQuadFlag(numFaces);
}

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

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_PATCH_CYCLE_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_PATCH_CYCLE_H

#include "limitPatch.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Steps that lead from a patch back to one that looks the same, as one linear map, up to a
/// factor that is a power of two.
///
/// The factor is there for long cycles, such as those of sides that come back after once round the
/// vertex: what shrinks in each of hundreds of steps would be too small for a double.
class PatchCycle {
public:
    using Index = Far::Index;
    using Vector = std::vector<double>;

    /// Adds a step behind those before; it is referred to.
    void Add(PatchRefinement const &step) { _steps.push_back(&step); }

    /// \brief Confines the map to \p verts of the patch and those that what left vectors have there
    /// comes to.  Vectors have these alone from here on.  Called once at most, behind Add().
    ///
    /// \param verts     ascending
    /// \param isCorner  vertex 0 of the patch stays where it is.  Of what left vectors come to it then
    ///                  has that of the first step alone: it is all that they would have left after
    ///                  dozens of steps, when the rest is no longer seen beside it.
    /// \return          the vertices that vectors have, ascending
    std::vector<Index> Confine(std::vector<Index> verts, bool isCorner);

    /// Of left vectors: what the vertices after all steps weigh, in terms of those before.
    void ApplyLeft(Vector &left);
    /// Of values before all steps: those after.
    void ApplyRight(Vector &right);

private:
    std::vector<PatchRefinement const *> _steps;
    std::vector<PatchRefinement> _confined; // empty unless there are vertices left out
    bool _isCorner = false;
    Vector _scratch;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

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

    PatchCycle() = default;
    PatchCycle(PatchCycle const &) = delete;
    PatchCycle &operator=(PatchCycle const &) = delete;

    /// Adds a step after those before.  It is referred to, and not copied.
    void Add(PatchRefinement const &step) { _steps.push_back(&step); }

    /// \brief Keeps the entries of \p verts in vectors, and of all vertices that weights of these come
    /// to.  Called once at most, after all steps are added.
    ///
    /// \param verts     vertices of the patch, ascending
    /// \param isCorner  whether vertex 0 of the patch stays where it is.  Weight that comes to it is then
    ///                  dropped after every step but the first of the cycle: it shrinks no more, and
    ///                  after dozens of steps nothing else would be seen beside it.
    /// \return          the vertices that vectors have, ascending
    std::vector<Index> Confine(std::vector<Index> verts, bool isCorner);

    /// Turns a left vector by vertices after all steps into one by vertices before them.
    void ApplyLeft(Vector &left);
    /// Turns values before all steps into values after them.
    void ApplyRight(Vector &right);

private:
    std::vector<PatchRefinement const *> _steps;
    std::vector<PatchRefinement> _confined; // empty unless there are vertices left out
    bool _isCorner = false;
    Vector _scratch;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

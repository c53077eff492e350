// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_LEVEL_STENCILS_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_LEVEL_STENCILS_H

#include "stencilMultiplier.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief The stencils of vertices of some levels of a mesh, in double: what further tables are made of.
/// Unlike those of a table, stencils share lists of indices.
class LevelStencils {
public:
    using Index = Far::Index;

    struct Stencil {
        Support support; ///< control vertices
        double const *weights;
    };

    /// \param hierarchy  is referred to
    /// \param wanted     the vertices of levels 0, 1 ... that are needed, ascending; of two levels at
    ///                   least
    /// \param channel    a smooth face-varying channel, whose values are the vertices, or -1
    LevelStencils(Hierarchy const &hierarchy, HexSchemeOptions const &schemeOptions,
                  std::vector<std::vector<Index>> wanted, int channel = -1);

    /// Makes the stencils of all that is needed, or says what is too large.
    CallStatus Form();

    /// The number of a level's first stencil: those of all vertices are in turn, from the control
    /// vertices on.
    Index GetFirst(int level) const { return _firsts[std::size_t(level)]; }
    /// The stencil of a vertex that is needed.
    Stencil const &Get(Index number) const { return _stencils[std::size_t(number)]; }

private:
    void addLevel(int level);

    StencilPlan const _plan;
    StencilSelection const _selection;
    SymbolicTable _symbolic;
    std::vector<SpareStencils<double>> _levels;
    std::vector<Index> _firsts;
    Buffer<Stencil> _stencils;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_PATCH_ROWS_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_PATCH_ROWS_H

#include "rowSteps.h"

#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// The rows of a vertex by source of a patch.
using PatchWeights = std::vector<LimitWeights>;

/// \brief The rows of vertices of later levels in terms of some vertices of a level, each found once from
/// those of the level before.
class PatchRows {
public:
    using Index = Far::Index;

    /// \param mesh     is referred to
    /// \param level    of the sources
    /// \param last     of the rows
    /// \param sources  all different
    PatchRows(MeshLevels const &mesh, HexSchemeOptions const &schemeOptions, int level, int last,
              Index const *sources, int numSources);

    /// That of a limit row of level \c last; nothing where it depends on other vertices.
    PatchWeights Find(LimitRow const &ofLimit);

private:
    using Row = std::vector<double>;

    Row const &findRow(std::size_t level, Index vert);

    MeshLevels const &_mesh;
    std::size_t const _level;
    std::vector<std::shared_ptr<RefinementRules const>> _rules; // of steps, by level before
    std::vector<std::unordered_map<Index, Row>> _rows;          // by level and vertex
    std::size_t const _numSources;
    bool _isComplete = true;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

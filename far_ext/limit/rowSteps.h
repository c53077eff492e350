// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_ROW_STEPS_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_ROW_STEPS_H

#include "limitRows.h"

#include "far_ext/vtr/refinementRows.h"

#include <array>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// The weights of a vertex for the point, du and dv.
using LimitWeights = std::array<double, 3>;

/// Smaller differences of limit weights are rounding: the largest weights are about 1.
constexpr double kWeightTolerance = 1e-9;

/// A LimitRow by vertex, in which a vertex comes once.
using SteppedRow = std::map<Far::Index, LimitWeights>;

/// \brief The row of a vertex of level \p cLevel in terms of the vertices of \p level, one before it.
OPENSUBDIVHEX_API SteppedRow StepRowBack(MeshLevels const &mesh,
                                         HexSchemeOptions const &schemeOptions,
                                         LimitRow const &ofVertex, int cLevel, int level);

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

    /// The row in terms of an earlier level; nothing if it depends on other vertices.
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

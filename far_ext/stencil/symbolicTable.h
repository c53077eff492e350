// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_SYMBOLIC_TABLE_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_SYMBOLIC_TABLE_H

#include "stencilSelection.h"
#include "stencilSupports.h"

#include <deque>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The supports of all stencils of a table, and the sizes of those to be stored.
class SymbolicTable {
public:
    using Index = Far::Index;

    explicit SymbolicTable(StencilPlan const &plan);
    /// Overload for a part, for a plan that is factorized.
    SymbolicTable(StencilPlan const &plan, StencilSelection const &selection);

    /// Forms all supports, or says what is too large.
    CallStatus Form();

    StencilPlan const &GetPlan() const { return _plan; }
    RefinementRows const &GetRows(int level) const { return _rows[level - _plan.firstBuilt]; }
    RowSupports const &GetSupports(int level) const { return _supports[level - _plan.firstBuilt]; }
    /// The supports of the level before, or of the sources.
    RowSupports const &GetParentSupports(int level) const {
        return _plan.HasParentStencils(level) ? GetSupports(level - 1)
                                              : _sourceSupports[getSourceNumber(level)];
    }
    Index GetNumSources(int level) const { return _sources[getSourceNumber(level)].number; }
    std::int64_t GetNumWeights() const { return _numWeights; }
    /// The sizes of the stencils of a level that is stored.
    int const *GetSizes(int level) const;
    /// The sizes of all stored stencils behind the control stencils.
    std::vector<int> TakeSizes() { return std::move(_sizes); }

private:
    struct SourceNumbers {
        std::vector<Index> ofVertices;
        Index number = 0;
    };
    int getSourceNumber(int level) const { return _plan.factorize ? 0 : level - _plan.firstBuilt; }

    StencilPlan const &_plan;
    std::deque<RefinementRows> _rows;    // plan.firstBuilt ... plan.lastLevel
    std::vector<SourceNumbers> _sources; // one, or as many as refinements
    std::deque<RowSupports> _sourceSupports;
    std::deque<RowSupports> _supports; // as many as refinements
    std::vector<int> _sizes;
    std::int64_t _numWeights = 0;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#include "symbolicTable.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

CallStatus checkCount(int level, std::int64_t count, char const *name) {
    if (count <= RowSupports::kMaxNumWeights) {
        return CallStatus();
    }
    return CallStatus(StatusCode::TooLarge, ComponentType::Level, level,
                      "the stencil table would have at least " + std::to_string(count) + " " +
                          name + " up to level " + std::to_string(level) + ", more than the " +
                          std::to_string(RowSupports::kMaxNumWeights) +
                          " that Far's 32-bit offsets reach");
}

} // namespace

SymbolicTable::SymbolicTable(StencilPlan const &plan) : _plan(plan) {
    _sources.resize(plan.factorize ? 1 : plan.lastLevel - plan.firstBuilt + 1);
    for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
        _rows.emplace_back(plan.GetRefinement(level), plan.hexSchemeOptions, plan.interpolation);
        if (!plan.HasParentStencils(level)) {
            _sources[level - plan.firstBuilt] = {plan.GetSources(level - 1),
                                                 plan.GetNumSources(level)};
        }
    }
}

SymbolicTable::SymbolicTable(StencilPlan const &plan, StencilSelection const &selection)
    : _plan(plan) {
    _sources.push_back({selection.sources, Index(selection.indices.size())});
    for (int level = 1; level <= plan.lastLevel; ++level) {
        if (level <= selection.wholeLevel) {
            _rows.emplace_back(plan.GetRefinement(level), plan.hexSchemeOptions,
                               plan.interpolation);
        } else {
            _rows.emplace_back(plan.GetRefinement(level), plan.hexSchemeOptions, plan.interpolation,
                               selection.parts[level - 1]);
        }
    }
}

int const *SymbolicTable::GetSizes(int level) const {
    int const *sizes = _sizes.data() + _plan.numControlStencils;
    for (int before = _plan.firstStored; before < level; ++before) {
        sizes += GetRows(before).GetNumRows();
    }
    return sizes;
}

CallStatus SymbolicTable::Form() {
    std::int64_t numStencils = _plan.numControlStencils;
    for (int level = _plan.firstStored; level <= _plan.lastLevel; ++level) {
        numStencils += GetRows(level).GetNumRows();
        if (CallStatus status = checkCount(level, numStencils, "stencils"); !status.IsOk()) {
            return status;
        }
    }
    ResizeLarge(_sizes, std::size_t(numStencils));
    std::fill_n(_sizes.begin(), _plan.numControlStencils, 1);
    _numWeights = _plan.numControlStencils;
    int *nextSize = _sizes.data() + _plan.numControlStencils;
    for (int level = _plan.firstBuilt; level <= _plan.lastLevel; ++level) {
        bool const isStored = level >= _plan.firstStored;
        bool const hasParents = _plan.HasParentStencils(level);
        if (!hasParents) {
            _sourceSupports.push_back(
                RowSupports::MakeSources(_sources[getSourceNumber(level)].ofVertices));
        }
        _supports.emplace_back(GetRows(level), hasParents ? &GetRows(level - 1) : nullptr,
                               GetParentSupports(level), GetNumSources(level),
                               _plan.factorize && (level < _plan.lastLevel || !isStored),
                               isStored ? nextSize : nullptr);
        std::int64_t const numLevelWeights = _supports.back().GetNumWeights();
        if (isStored) {
            nextSize += GetRows(level).GetNumRows();
            _numWeights += numLevelWeights;
        }
        CallStatus status = checkCount(level, std::max(_numWeights, numLevelWeights), "weights");
        if (!status.IsOk()) {
            return status;
        }
    }
    return CallStatus();
}

} // namespace OpenSubdivHex::FarExt::internal

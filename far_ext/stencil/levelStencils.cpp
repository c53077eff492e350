// SPDX-License-Identifier: Apache-2.0
#include "levelStencils.h"

#include "far_ext/vtr/parallel.h"

#include <string>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

constexpr double kOne = 1;

// The plan of a table that stores no level.
StencilPlan makePlan(Hierarchy const &hierarchy, HexSchemeOptions const &schemeOptions,
                     int lastLevel, int channel) {
    StencilPlan plan = {hierarchy, schemeOptions};
    plan.channel = channel;
    plan.lastLevel = lastLevel;
    plan.firstStored = lastLevel + 1;
    return plan;
}

} // namespace

LevelStencils::LevelStencils(Hierarchy const &hierarchy, HexSchemeOptions const &schemeOptions,
                             std::vector<std::vector<Index>> wanted, int channel)
    : _plan(makePlan(hierarchy, schemeOptions, int(wanted.size()) - 1, channel)),
      _selection(_plan, std::move(wanted), true), _symbolic(_plan, _selection),
      _levels(std::size_t(_plan.lastLevel)) {}

CallStatus LevelStencils::Form() {
    CallStatus status = _symbolic.Form();
    if (!status.IsOk()) {
        return status;
    }
    std::int64_t numStencils = 0;
    for (int level = 0; level <= _plan.lastLevel; ++level) {
        _firsts.push_back(Index(numStencils));
        numStencils += _plan.GetNumVertices(level);
        if (numStencils > std::numeric_limits<Index>::max()) {
            return CallStatus(StatusCode::TooLarge, ComponentType::Level, level,
                              "levels 0 to " + std::to_string(level) + " have " +
                                  std::to_string(numStencils) +
                                  " vertices, more than 32-bit indices reach");
        }
    }
    _stencils.Resize(std::size_t(numStencils));
    FillStencils<double>(_symbolic, [&](int level) {
        return _levels[std::size_t(level) - 1].Place(_symbolic.GetSupports(level).OfVertices());
    });
    for (int level = 0; level <= _plan.lastLevel; ++level) {
        addLevel(level);
    }
    return CallStatus();
}

// Stencils of control vertices are stored nowhere else.
void LevelStencils::addLevel(int level) {
    RowSupports const &supports =
        level == 0 ? _symbolic.GetParentSupports(1) : _symbolic.GetSupports(level);
    Stencil *const stencils = _stencils.data() + GetFirst(level);
    auto const add = [&](Index vert, Index row) {
        stencils[vert] = {supports.OfVertices()[std::size_t(row)],
                          level == 0 ? &kOne : _levels[std::size_t(level) - 1].GetWeights(row)};
    };
    if (level <= _selection.wholeLevel) {
        ParallelFor(_plan.GetNumVertices(level), [&](Index vert) { add(vert, vert); });
        return;
    }
    std::vector<Index> const made =
        GetMadeVertices(_plan.GetRefinement(level), _selection.parts[std::size_t(level) - 1]);
    ParallelFor(Index(made.size()), [&](Index row) { add(made[std::size_t(row)], row); });
}

} // namespace OpenSubdivHex::FarExt::internal

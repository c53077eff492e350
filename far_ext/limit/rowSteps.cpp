// SPDX-License-Identifier: Apache-2.0
#include "rowSteps.h"

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

void addToRow(SteppedRow &row, Index vert, LimitWeights const &weights, double factor) {
    LimitWeights &sum = row[vert];
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum[i] += factor * weights[i];
    }
}

// The row in terms of the vertices of the parent.
SteppedRow stepRow(SteppedRow const &cRow, Refinement const &refinement,
                   RefinementRules const &rules) {
    SteppedRow row;
    for (auto const &ofVertex : cRow) {
        ForEachParentWeight(refinement, rules, ofVertex.first, [&](Index pVert, double weight) {
            addToRow(row, pVert, ofVertex.second, weight);
        });
    }
    return row;
}

} // namespace

SteppedRow StepRowBack(MeshLevels const &mesh, HexSchemeOptions const &schemeOptions,
                       LimitRow const &ofVertex, int cLevel, int level) {
    SteppedRow row;
    for (int k = 0; k < ofVertex.size; ++k) {
        addToRow(row, ofVertex.sources[k], {ofVertex.weights[k], ofVertex.du[k], ofVertex.dv[k]},
                 1);
    }
    for (int child = cLevel; child > level; --child) {
        std::shared_ptr<RefinementRules const> const rules =
            GetRules(mesh.levels[std::size_t(child) - 1], schemeOptions, Interpolation::Vertex);
        row = stepRow(row, mesh.refinements[std::size_t(child) - 1], *rules);
    }
    return row;
}

PatchRows::PatchRows(MeshLevels const &mesh, HexSchemeOptions const &schemeOptions, int level,
                     int last, Index const *sources, int numSources)
    : _mesh(mesh), _level(std::size_t(level)), _rules(std::size_t(last)),
      _rows(std::size_t(last) + 1), _numSources(std::size_t(numSources)) {
    for (std::size_t step = _level; step < _rules.size(); ++step) {
        _rules[step] = GetRules(mesh.levels[step], schemeOptions, Interpolation::Vertex);
    }
    for (std::size_t source = 0; source < _numSources; ++source) {
        Row row(_numSources, 0);
        row[source] = 1;
        _rows[_level].emplace(sources[source], std::move(row));
    }
}

PatchWeights PatchRows::Find(LimitRow const &ofLimit) {
    PatchWeights weights(_numSources, LimitWeights());
    for (int i = 0; i < ofLimit.size; ++i) {
        Row const &row = findRow(_rows.size() - 1, ofLimit.sources[i]);
        for (std::size_t source = 0; source < _numSources; ++source) {
            weights[source][0] += ofLimit.weights[i] * row[source];
            weights[source][1] += ofLimit.du[i] * row[source];
            weights[source][2] += ofLimit.dv[i] * row[source];
        }
    }
    return _isComplete ? weights : PatchWeights();
}

PatchRows::Row const &PatchRows::findRow(std::size_t level, Index vert) {
    auto const found = _rows[level].find(vert);
    if (found != _rows[level].end()) {
        return found->second;
    }
    Row row(_numSources, 0);
    if (level == _level) {
        _isComplete = false;
    } else {
        ForEachParentWeight(_mesh.refinements[level - 1], *_rules[level - 1], vert,
                            [&](Index pVert, double weight) {
                                Row const &pRow = findRow(level - 1, pVert);
                                for (std::size_t source = 0; source < _numSources; ++source) {
                                    row[source] += weight * pRow[source];
                                }
                            });
    }
    return _rows[level].emplace(vert, std::move(row)).first->second;
}

} // namespace OpenSubdivHex::FarExt::internal

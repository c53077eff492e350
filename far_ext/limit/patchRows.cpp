// SPDX-License-Identifier: Apache-2.0
#include "patchRows.h"

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

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

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

} // namespace OpenSubdivHex::FarExt::internal

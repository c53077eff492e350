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
SteppedRow stepBack(SteppedRow const &cRow, Refinement const &refinement,
                    RefinementMask const &mask) {
    Level const &parent = *refinement.parent;
    SteppedRow row;
    std::vector<double> scratch;
    auto const addFVertex = [&](Index corner, LimitWeights const &weights, double factor) {
        Index const face = parent.FindFaceOfCorner(corner);
        Index const first = parent.faceFirstCorner[face];
        double const *const ofFace = mask.GetFaceVertexWeights(face, corner - first, scratch);
        for (int i = 0; i < parent.GetFaceSize(face); ++i) {
            addToRow(row, parent.faceVerts[first + i], weights, factor * ofFace[i]);
        }
    };
    for (auto const &[vert, weights] : cRow) {
        if (vert >= refinement.child->numVVertices) {
            addFVertex(refinement.GetChildVertexCorner(vert), weights, 1);
            continue;
        }
        Index const pVert = refinement.GetVVertexParent(vert);
        RefinementMask::VertexMask const ofVertex = mask.GetVertexMask(pVert);
        for (int i = 0; i < ofVertex.numSources; ++i) {
            addToRow(row, ofVertex.sources[i], weights, ofVertex.weights[i]);
        }
        for (Index k = parent.vertFirstFace[pVert]; k < parent.vertFirstFace[pVert + 1]; ++k) {
            addFVertex(parent.GetVertexCorner(k), weights, ofVertex.faceWeight);
        }
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
        RefinementMask const ofStep(mesh.levels[std::size_t(child) - 1], schemeOptions,
                                    Interpolation::Vertex);
        row = stepBack(row, mesh.refinements[std::size_t(child) - 1], ofStep);
    }
    return row;
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_MASKED_STEP_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_MASKED_STEP_H

#include "far_ext/vtr/refinement.h"
#include "far_ext/vtr/refinementRules.h"

#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief One hexagonal step, literally, with weights of F-vertices that the caller may choose.
///
/// \param mask        of the vertices
/// \param getWeights  called with a face and the number of one of its corners: the weights of the
///                    face's vertices, in their order
/// \param src         by vertex of the parent, with the interface that primvar refiners ask for
/// \param dst         by vertex of the child
template <typename GET_WEIGHTS, typename VALUE>
void InterpolateMasked(FarExt::internal::Refinement const &refinement,
                       FarExt::internal::RefinementRules const &mask, GET_WEIGHTS const &getWeights,
                       std::vector<VALUE> const &src, std::vector<VALUE> &dst) {
    auto const &parent = *refinement.parent;
    for (int face = 0; face < parent.numFaces; ++face) {
        auto const verts = parent.GetFaceVertices(face);
        int const first = parent.faceFirstCorner[std::size_t(face)];
        for (int i = 0; i < verts.size(); ++i) {
            double const *const weights = getWeights(face, i);
            VALUE &value = dst[refinement.GetCornerChildVertex(first + i)];
            value.Clear();
            for (int j = 0; j < verts.size(); ++j) {
                value.AddWithWeight(src[verts[j]], weights[j]);
            }
        }
    }
    for (int vert = 0; vert < parent.numVertices; ++vert) {
        auto const weights = mask.GetVertexRule(vert);
        VALUE &value = dst[refinement.GetVertexChildVertex(vert)];
        value.Clear();
        for (int i = 0; i < weights.numSources; ++i) {
            value.AddWithWeight(src[weights.sources[i]], weights.weights[i]);
        }
        int const firstFace = parent.vertFirstFace[vert];
        for (int k = firstFace; k < parent.vertFirstFace[vert + 1]; ++k) {
            value.AddWithWeight(dst[refinement.GetCornerChildVertex(parent.GetVertexCorner(k))],
                                weights.GetFaceWeight(k - firstFace));
        }
    }
}

} // namespace OpenSubdivHex::Regression

#endif

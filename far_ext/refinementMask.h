// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_REFINEMENT_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_REFINEMENT_MASK_H

#include "topologyRefiner.h"

#include <map>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Joins the masks to the components of a parent level: which vertices make an F-vertex or
/// a V-vertex, and with which weights.  PrimvarRefiner and the stencil factory both read it.
template <typename REAL>
class RefinementMask {
public:
    using Index = Far::Index;

    RefinementMask(TopologyRefiner const &refiner, Interpolation interpolation);

    /// Weights of the \p faceSize vertices of a face, in their order, for the F-vertex of the
    /// face's corner number \p corner.
    REAL const *GetFaceVertexWeights(int faceSize, int corner) const {
        // The mask stands twice in a row, so that every rotation of it is contiguous.
        return _faceMasks.find(faceSize)->second.data() + faceSize - corner;
    }

    /// The mask of a vertex with \p numFaces faces.
    VertexVertexMask<REAL> GetVertexMask(int numFaces) const {
        return ComputeVertexVertexMask<REAL>(_interpolation, numFaces);
    }

private:
    Interpolation _interpolation;
    std::map<int, std::vector<REAL>> _faceMasks; ///< by face size
};

extern template class RefinementMask<float>;
extern template class RefinementMask<double>;

} // namespace OpenSubdivHex::FarExt::internal

#endif

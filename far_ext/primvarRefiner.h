// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PRIMVAR_REFINER_H
#define OPENSUBDIVHEX_FAR_EXT_PRIMVAR_REFINER_H

#include "refinementMask.h"

namespace OpenSubdivHex::FarExt {

/// \brief Computes primvar data of one level from that of the level before, without tables.
///
/// The element types follow Far's protocol: \p src and \p dst are indexed by vertex (or face) and
/// their elements have `void Clear()` and `void AddWithWeight(Element const &, REAL)`.  An element
/// of \p dst must also take an element of \p dst, since V-vertices average new points.
/// \p REAL is the type of the weights.
///
/// \code
///     PrimvarRefiner primvarRefiner(refiner);
///     for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
///         primvarRefiner.Interpolate(level, values[level - 1], values[level]);
///     }
/// \endcode
template <typename REAL>
class PrimvarRefinerReal {
public:
    explicit PrimvarRefinerReal(TopologyRefiner const &refiner)
        : _refiner(refiner), _vertexMask(refiner, Interpolation::Vertex),
          _varyingMask(refiner, Interpolation::Varying) {}

    TopologyRefiner const &GetTopologyRefiner() const { return _refiner; }

    /// \brief Vertex data: dst[v] for all vertices of \p level from src of level - 1 with the masks
    /// of the scheme.  1 <= level <= GetMaxLevel().
    template <class T, class U>
    void Interpolate(int level, T const &src, U &dst) const {
        interpolate(level, _vertexMask, src, dst);
    }

    /// \brief Varying data: linear, V' = V and P = (V + centroid)/2.
    template <class T, class U>
    void InterpolateVarying(int level, T const &src, U &dst) const {
        interpolate(level, _varyingMask, src, dst);
    }

    /// \brief Face-uniform data: dst[f] is a copy of src[GetFaceParentFace(f)], for an E-face the
    /// value of the first face of its edge.  Elements need operator= only.
    template <class T, class U>
    void InterpolateFaceUniform(int level, T const &src, U &dst) const {
        TopologyLevel const &cLevel = _refiner.GetLevel(level);
        for (Far::Index cFace = 0; cFace < cLevel.GetNumFaces(); ++cFace) {
            dst[cFace] = src[cLevel.GetFaceParentFace(cFace)];
        }
    }

private:
    template <class T, class U>
    void interpolate(int level, internal::RefinementMask<REAL> const &mask, T const &src,
                     U &dst) const;

    TopologyRefiner const &_refiner;
    internal::RefinementMask<REAL> _vertexMask;
    internal::RefinementMask<REAL> _varyingMask;
};

template <typename REAL>
template <class T, class U>
void PrimvarRefinerReal<REAL>::interpolate(int level, internal::RefinementMask<REAL> const &mask,
                                           T const &src, U &dst) const {
    TopologyLevel const &pLevel = _refiner.GetLevel(level - 1);
    HexIndexing const indexing = pLevel.GetChildIndexing();

    for (Far::Index pFace = 0; pFace < pLevel.GetNumFaces(); ++pFace) {
        Far::ConstIndexArray const pVerts = pLevel.GetFaceVertices(pFace);
        for (int i = 0; i < pVerts.size(); ++i) {
            Far::Index const corner = pLevel.GetFaceFirstCorner(pFace) + i;
            REAL const *weights = mask.GetFaceVertexWeights(pVerts.size(), i);
            auto &&point = dst[indexing.GetCornerChildVertex(corner)];
            point.Clear();
            for (int j = 0; j < pVerts.size(); ++j) {
                point.AddWithWeight(src[pVerts[j]], weights[j]);
            }
        }
    }
    for (Far::Index pVert = 0; pVert < pLevel.GetNumVertices(); ++pVert) {
        int const numFaces = pLevel.GetVertexFaces(pVert).size();
        VertexVertexMask<REAL> const weights = mask.GetVertexMask(numFaces);
        auto &&point = dst[indexing.GetVertexChildVertex(pVert)];
        point.Clear();
        point.AddWithWeight(src[pVert], weights.vertexWeight);
        if (weights.faceWeight > 0) {
            for (int i = 0; i < numFaces; ++i) {
                Far::Index const corner = pLevel.GetVertexCorner(pVert, i);
                point.AddWithWeight(dst[indexing.GetCornerChildVertex(corner)],
                                    weights.faceWeight);
            }
        }
    }
}

using PrimvarRefiner = PrimvarRefinerReal<float>;

} // namespace OpenSubdivHex::FarExt

#endif

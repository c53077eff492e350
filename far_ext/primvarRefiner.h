// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PRIMVAR_REFINER_H
#define OPENSUBDIVHEX_FAR_EXT_PRIMVAR_REFINER_H

#include "fvarLevel.h"
#include "refinementMask.h"
#include "topologyRefiner.h"

namespace OpenSubdivHex::FarExt {

/// \brief Computes primvar data of one level from that of the level before, without tables.
///
/// The element types follow Far's protocol: \p src and \p dst are indexed by vertex (or face) and
/// their elements have `void Clear()` and `void AddWithWeight(Element const &, REAL)`.  An element
/// of \p dst must also take an element of \p dst, since V-vertices average new points.
/// \p REAL is the type of the weights.  Arguments are not checked.
///
/// Two meshes that share a sharp border line, with the same sharpness at its vertices, get the same
/// values on it, bit for bit, however either numbers and orients it, as long as AddWithWeight()
/// rounds the product before it adds (no fused multiply-add).
///
/// Works on the calling thread.  Several threads may use one primvar refiner at once, for elements
/// of their own.  What the elements throw passes through, and std::bad_alloc.
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
    /// Keeps a reference to \p refiner.
    explicit PrimvarRefinerReal(TopologyRefiner const &refiner) : _refiner(refiner) {}

    TopologyRefiner const &GetTopologyRefiner() const { return _refiner; }

    /// \brief Vertex data: dst[v] for all vertices of \p level from src of level - 1 with the masks
    /// of the scheme.  1 <= level <= GetMaxLevel().
    template <class T, class U>
    void Interpolate(int level, T const &src, U &dst) const {
        interpolate(_refiner.GetLevel(level - 1), Interpolation::Vertex, src, dst);
    }

    /// \brief Varying data: linear, V' = V and P = (V + centroid)/2, for half faces the centroid of
    /// the whole hexagon; on a sharp boundary P = (3 V + W)/4.
    template <class T, class U>
    void InterpolateVarying(int level, T const &src, U &dst) const {
        interpolate(_refiner.GetLevel(level - 1), Interpolation::Varying, src, dst);
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

    /// \brief Face-varying data: dst[i] for all GetNumFVarValues(channel) values of \p level from
    /// those of level - 1, by the channel's FVarLinearInterpolation.
    template <class T, class U>
    void InterpolateFaceVarying(int level, T const &src, U &dst, int channel = 0) const {
        internal::FVarLevel const &pChannel =
            *_refiner.GetLevel(level - 1).GetTopology().fvarLevels[channel];
        Interpolation const interpolation =
            pChannel.linearInterpolation == Sdc::Options::FVAR_LINEAR_ALL ? Interpolation::Varying
                                                                          : Interpolation::Vertex;
        TopologyLevel const pValues(&pChannel.topology);
        if (level == 1) {
            ValuesOfVertices<T> const values{src, pChannel.valuesOfVertices.data()};
            interpolate(pValues, interpolation, values, dst);
        } else {
            interpolate(pValues, interpolation, src, dst);
        }
    }

private:
    // The values of level 0 as seen from the vertices of its value mesh.
    template <class T>
    struct ValuesOfVertices {
        decltype(auto) operator[](Far::Index vert) const { return src[values[vert]]; }
        T const &src;
        Far::Index const *values;
    };

    template <class T, class U>
    void interpolate(TopologyLevel const &pLevel, Interpolation interpolation, T const &src,
                     U &dst) const;

    TopologyRefiner const &_refiner;
};

template <typename REAL>
template <class T, class U>
void PrimvarRefinerReal<REAL>::interpolate(TopologyLevel const &pLevel, Interpolation interpolation,
                                           T const &src, U &dst) const {
    internal::LevelTopology const &topology = pLevel.GetTopology();
    internal::RefinementMask const mask(pLevel, _refiner.GetHexSchemeOptions(), interpolation);
    std::vector<double> scratch;

    for (Far::Index pFace = 0; pFace < pLevel.GetNumFaces(); ++pFace) {
        Far::ConstIndexArray const pVerts = pLevel.GetFaceVertices(pFace);
        for (int i = 0; i < pVerts.size(); ++i) {
            Far::Index const corner = pLevel.GetFaceFirstCorner(pFace) + i;
            double const *weights = mask.GetFaceVertexWeights(pFace, i, scratch);
            auto &&point = dst[topology.GetCornerChildVertex(corner)];
            point.Clear();
            for (int j = 0; j < pVerts.size(); ++j) {
                if (weights[j] > 0) {
                    point.AddWithWeight(src[pVerts[j]], REAL(weights[j]));
                }
            }
        }
    }
    for (Far::Index cVert = 0; cVert < topology.numVVertices; ++cVert) {
        Far::Index const pVert = topology.GetVVertexParent(cVert);
        auto const weights = mask.GetVertexMask(pVert);
        auto &&point = dst[cVert];
        point.Clear();
        // The neighbors first, so that it does not matter which of them is left and right.
        for (int i = 0; i < weights.numNeighbors; ++i) {
            point.AddWithWeight(src[weights.neighbors[i]], REAL(weights.neighborWeights[i]));
        }
        point.AddWithWeight(src[pVert], REAL(weights.vertexWeight));
        if (weights.faceWeight > 0) {
            for (int i = 0; i < pLevel.GetVertexFaces(pVert).size(); ++i) {
                Far::Index const corner = pLevel.GetVertexCorner(pVert, i);
                point.AddWithWeight(dst[topology.GetCornerChildVertex(corner)],
                                    REAL(weights.faceWeight));
            }
        }
    }
}

using PrimvarRefiner = PrimvarRefinerReal<float>;

} // namespace OpenSubdivHex::FarExt

#endif

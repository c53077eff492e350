// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FACE_EVALUATOR_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FACE_EVALUATOR_H

#include "baseType.h"
#include "borderEvaluator.h"
#include "tessellationData.h"

#include "bfr_ext/surface.h"

namespace OpenSubdivHex::BfrExt::internal {

/// Writes a weighted sum of points, in double precision: of all, or of those that \p indices name.
template <typename REAL, typename WEIGHT>
void SumUp(WEIGHT const *weights, int numPoints, REAL const *points, Far::Index const *indices,
           typename Surface<REAL>::PointDescriptor const &desc, REAL *result) {
    for (int k = 0; k < desc.size; ++k) {
        double sum = 0;
        for (int i = 0; i < numPoints; ++i) {
            std::ptrdiff_t const point = indices ? indices[i] : i;
            sum += double(weights[i]) * double(points[point * desc.stride + k]);
        }
        result[k] = REAL(sum);
    }
}

/// \brief Evaluates a base face with its control points at all places of tessellations.
///
/// Leaves of types make the points inside (PatchEvaluator, RateEvaluator), RefinedCells those of large trees, and
/// BorderEvaluator those on the border.
template <typename REAL>
class FaceEvaluator {
public:
    using PointDescriptor = typename Surface<REAL>::PointDescriptor;

    /// \param face           must live as long, and so must its control points
    /// \param controlPoints  from one to the next by the stride of \p pointDesc
    FaceEvaluator(BaseFace const &face, REAL const *controlPoints, PointDescriptor const &pointDesc)
        : _face(face), _controlPoints(controlPoints), _pointDesc(pointDesc) {}

    /// \brief Evaluates a tessellation of a face of this size.
    ///
    /// \param results  the points; by u, by v; by u twice, by u and v, by v twice; null from some kind on
    void Evaluate(TessellationData const &tessellation, REAL *const results[6],
                  PointDescriptor const &resultDesc) const;
    /// Writes the point of a vertex, as it is in all tessellations.
    void EvaluateVertex(int vert, REAL *result) const;
    /// \brief Evaluates a tessellation of Bfr of a face of this size.
    ///
    /// \param results  the points; by u, by v; both null where only points are wanted
    void Evaluate(OpenSubdiv::Bfr::Tessellation const &tessellation, REAL *const results[3],
                  PointDescriptor const &resultDesc) const;

private:
    void evaluateLeaves(TessellationData const &tessellation, REAL *const *results,
                        PointDescriptor const &resultDesc) const;
    void evaluateTree(TessellationData const &tessellation, REAL *const *results,
                      PointDescriptor const &resultDesc) const;
    void evaluateSecond(TessellationData const &tessellation, REAL *const *results,
                        PointDescriptor const &resultDesc) const;
    void turnDerivatives(TessellationData const &tessellation, REAL *const *results,
                         PointDescriptor const &resultDesc) const;
    template <typename FUNCTION>
    void useBorder(FUNCTION const &function) const;
    void evaluateBorder(TessellationData const &tessellation, BorderEvaluator<REAL> &evaluator,
                        REAL *p, PointDescriptor const &resultDesc) const;
    void evaluateSectionBorder(TessellationData const &tessellation,
                               BorderEvaluator<REAL> &evaluator, REAL *p,
                               PointDescriptor const &resultDesc) const;
    void sumUp(std::vector<double> const &weights, REAL *result) const {
        SumUp(weights.data(), _face.numPoints, _controlPoints, nullptr, _pointDesc, result);
    }

    BaseFace const &_face;
    REAL const *const _controlPoints;
    PointDescriptor const _pointDesc;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

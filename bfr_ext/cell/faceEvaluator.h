// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FACE_EVALUATOR_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FACE_EVALUATOR_H

#include "borderEvaluator.h"
#include "tessellationData.h"

#include "bfr_ext/surface.h"

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Evaluates a base face with its control points at all places of tessellations.
///
/// Leaves of types make the points inside (PatchEvaluator, RateEvaluator), and BorderEvaluator those on the border.
template <typename REAL>
class FaceEvaluator {
public:
    using PointDescriptor = typename Surface<REAL>::PointDescriptor;

    /// \param face       must live as long, and so must the points
    /// \param points     the control points or, with \p shared, the points of the mesh
    /// \param shared     the rings that faces of the mesh share, or null
    FaceEvaluator(BaseFace const &face, REAL const *points, PointDescriptor const &pointDesc,
                  SharedRings<REAL> *shared = nullptr)
        : _face(face), _size(pointDesc.size),
          _points(face, points, pointDesc.stride, std::size_t(pointDesc.size), shared) {}

    /// \brief Evaluates a tessellation of a face of this size.
    ///
    /// \param results  the points; by u, by v; by u twice, by u and v, by v twice; null from some kind on
    void Evaluate(TessellationData const &tessellation, REAL *const results[6],
                  PointDescriptor const &resultDesc);
    /// \brief Evaluates a tessellation of Bfr of a face of this size.
    ///
    /// \param results  the points; by u, by v; both null where only points are wanted
    void Evaluate(OpenSubdiv::Bfr::Tessellation const &tessellation, REAL *const results[3],
                  PointDescriptor const &resultDesc);

private:
    void evaluateLeaves(TessellationData const &tessellation, REAL *const *results,
                        PointDescriptor const &resultDesc);
    void evaluateSecond(TessellationData const &tessellation, REAL *const *results,
                        PointDescriptor const &resultDesc);
    void turnDerivatives(TessellationData const &tessellation, REAL *const *results,
                         PointDescriptor const &resultDesc) const;
    BorderEvaluator<REAL> &setBorder();
    void evaluateBorder(TessellationData const &tessellation, BorderEvaluator<REAL> &evaluator,
                        REAL *p, PointDescriptor const &resultDesc) const;

    BaseFace const &_face;
    int const _size; // of a point
    GatheredPoints<REAL> _points;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#include "surface.h"

#include "cell/cellStencil.h"

#include <algorithm>
#include <limits>

namespace OpenSubdivHex::BfrExt {

namespace {

using internal::CellStencil;

template <typename REAL>
void findStencil(int faceSize, REAL const uv[2], bool hasDerivatives, CellStencil &stencil) {
    constexpr double kTolerance = 8 * double(std::numeric_limits<REAL>::epsilon());
    stencil.Find(internal::FindBasePoint(faceSize, double(uv[0]), double(uv[1]), kTolerance),
                 hasDerivatives);
}

// A weighted sum of points, in double precision.
template <typename REAL, typename WEIGHT>
void sumUp(WEIGHT const *weights, int numPoints, REAL const *points, Far::Index const *indices,
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

template <typename REAL>
void bound(int numPoints, REAL const *points, Far::Index const *indices,
           typename Surface<REAL>::PointDescriptor const &desc, REAL *minExtent, REAL *maxExtent) {
    for (int i = 0; i < numPoints; ++i) {
        REAL const *const point = points + std::ptrdiff_t(indices ? indices[i] : i) * desc.stride;
        for (int k = 0; k < desc.size; ++k) {
            minExtent[k] = i == 0 ? point[k] : std::min(minExtent[k], point[k]);
            maxExtent[k] = i == 0 ? point[k] : std::max(maxExtent[k], point[k]);
        }
    }
}

template <typename REAL>
void copyWeights(std::vector<double> const &from, REAL *to) {
    std::transform(from.begin(), from.end(), to, [](double weight) { return REAL(weight); });
}

} // namespace

template <typename REAL>
Surface<REAL>::Surface() = default;
template <typename REAL>
Surface<REAL>::~Surface() = default;
template <typename REAL>
Surface<REAL>::Surface(Surface const &other) = default;
template <typename REAL>
Surface<REAL> &Surface<REAL>::operator=(Surface const &other) = default;

template <typename REAL>
void Surface<REAL>::Clear() {
    *this = Surface();
}

template <typename REAL>
int Surface<REAL>::GetControlPointIndices(Index meshPointIndices[]) const {
    std::copy(_controlPoints.begin(), _controlPoints.end(), meshPointIndices);
    return GetNumControlPoints();
}

template <typename REAL>
void Surface<REAL>::BoundControlPoints(REAL const controlPoints[],
                                       PointDescriptor const &controlPointDesc, REAL minExtent[],
                                       REAL maxExtent[]) const {
    bound(GetNumControlPoints(), controlPoints, nullptr, controlPointDesc, minExtent, maxExtent);
}

template <typename REAL>
void Surface<REAL>::BoundControlPointsFromMesh(REAL const meshPoints[],
                                               PointDescriptor const &meshPointDesc,
                                               REAL minExtent[], REAL maxExtent[]) const {
    bound(GetNumControlPoints(), meshPoints, _controlPoints.data(), meshPointDesc, minExtent,
          maxExtent);
}

template <typename REAL>
void Surface<REAL>::Evaluate(REAL const uv[2], REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL P[]) const {
    CellStencil stencil(*_type);
    findStencil(GetFaceSize(), uv, false, stencil);
    sumUp(stencil.GetWeights().data(), GetNumControlPoints(), controlPoints, nullptr, pointDesc, P);
}

template <typename REAL>
void Surface<REAL>::Evaluate(REAL const uv[2], REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL P[], REAL Du[],
                             REAL Dv[]) const {
    CellStencil stencil(*_type);
    findStencil(GetFaceSize(), uv, true, stencil);
    int const size = GetNumControlPoints();
    sumUp(stencil.GetWeights().data(), size, controlPoints, nullptr, pointDesc, P);
    sumUp(stencil.GetDuWeights().data(), size, controlPoints, nullptr, pointDesc, Du);
    sumUp(stencil.GetDvWeights().data(), size, controlPoints, nullptr, pointDesc, Dv);
}

template <typename REAL>
int Surface<REAL>::EvaluateStencil(REAL const uv[2], REAL sP[]) const {
    CellStencil stencil(*_type);
    findStencil(GetFaceSize(), uv, false, stencil);
    copyWeights(stencil.GetWeights(), sP);
    return GetNumControlPoints();
}

template <typename REAL>
int Surface<REAL>::EvaluateStencil(REAL const uv[2], REAL sP[], REAL sDu[], REAL sDv[]) const {
    CellStencil stencil(*_type);
    findStencil(GetFaceSize(), uv, true, stencil);
    copyWeights(stencil.GetWeights(), sP);
    copyWeights(stencil.GetDuWeights(), sDu);
    copyWeights(stencil.GetDvWeights(), sDv);
    return GetNumControlPoints();
}

template <typename REAL>
void Surface<REAL>::ApplyStencil(REAL const stencil[], REAL const controlPoints[],
                                 PointDescriptor const &controlPointDesc, REAL result[]) const {
    sumUp(stencil, GetNumControlPoints(), controlPoints, nullptr, controlPointDesc, result);
}

template <typename REAL>
void Surface<REAL>::ApplyStencilFromMesh(REAL const stencil[], REAL const meshPoints[],
                                         PointDescriptor const &meshPointDesc,
                                         REAL result[]) const {
    sumUp(stencil, GetNumControlPoints(), meshPoints, _controlPoints.data(), meshPointDesc, result);
}

template class Surface<float>;
template class Surface<double>;

} // namespace OpenSubdivHex::BfrExt

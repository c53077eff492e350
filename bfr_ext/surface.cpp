// SPDX-License-Identifier: Apache-2.0
#include "surface.h"

#include "cell/cellStencil.h"
#include "cell/faceEvaluator.h"
#include "cell/facePatches.h"

#include <algorithm>
#include <limits>

namespace OpenSubdivHex::BfrExt {

namespace {

using internal::BaseFace;
using internal::CellStencil;

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

} // namespace

template <typename REAL>
BaseFace const &Surface<REAL>::GetFace() const {
    return _keptFace ? *_keptFace : *reinterpret_cast<BaseFace const *>(_ownFace.data());
}

template <typename REAL>
Far::Index const *Surface<REAL>::getPoints() const {
    return IsValid() ? GetFace().GetPoints() : nullptr;
}

template <typename REAL>
void Surface<REAL>::Clear() {
    *this = Surface();
}

template <typename REAL>
int Surface<REAL>::GetControlPointIndices(Index meshPointIndices[]) const {
    if (IsValid()) {
        std::copy_n(GetFace().GetPoints(), GetNumControlPoints(), meshPointIndices);
    }
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
    if (IsValid()) {
        bound(GetNumControlPoints(), meshPoints, GetFace().GetPoints(), meshPointDesc, minExtent,
              maxExtent);
    }
}

template <typename REAL>
internal::FacePatches<REAL> const &Surface<REAL>::findPatches() const {
    auto const *patches = _patches.Get();
    if (!patches) {
        patches = &internal::FacePatches<REAL>::Get(GetFace().type, _patchLevel);
        _patches.Set(patches);
    }
    return *patches;
}

template <typename REAL>
int Surface<REAL>::GetNumPatchPoints() const {
    return IsValid() ? _numControlPoints + findPatches().GetNumPoints() : 0;
}

template <typename REAL>
void Surface<REAL>::ComputePatchPoints(REAL patchPoints[],
                                       PointDescriptor const &patchPointDesc) const {
    if (IsValid() && !GetFace().type.IsInLattice()) {
        findPatches().MakePoints(
            GetFace().type, patchPoints, patchPointDesc.size, patchPointDesc.stride,
            patchPoints + std::ptrdiff_t(_numControlPoints) * patchPointDesc.stride);
    }
}

template <typename REAL>
void Surface<REAL>::evaluate(REAL const uv[2], int numDerivatives, REAL const patchPoints[],
                             PointDescriptor const &pointDesc, REAL *const results[6]) const {
    if (IsValid()) {
        internal::FacePatches<REAL> const &patches = findPatches();
        if (patches.GetNumPoints() > 0) {
            patchPoints += std::ptrdiff_t(_numControlPoints) * pointDesc.stride;
        }
        patches.Evaluate(_parameterization, GetFaceShape(), _patchLevel,
                         {double(uv[0]), double(uv[1])}, numDerivatives, patchPoints,
                         pointDesc.size, pointDesc.stride, results);
    }
}

template <typename REAL>
void Surface<REAL>::Evaluate(REAL const uv[2], REAL const patchPoints[],
                             PointDescriptor const &pointDesc, REAL p[]) const {
    REAL *const results[6] = {p};
    evaluate(uv, 0, patchPoints, pointDesc, results);
}

template <typename REAL>
void Surface<REAL>::Evaluate(REAL const uv[2], REAL const patchPoints[],
                             PointDescriptor const &pointDesc, REAL p[], REAL du[],
                             REAL dv[]) const {
    REAL *const results[6] = {p, du, dv};
    evaluate(uv, 1, patchPoints, pointDesc, results);
}

template <typename REAL>
void Surface<REAL>::Evaluate(REAL const uv[2], REAL const patchPoints[],
                             PointDescriptor const &pointDesc, REAL p[], REAL du[], REAL dv[],
                             REAL duu[], REAL duv[], REAL dvv[]) const {
    REAL *const results[6] = {p, du, dv, duu, duv, dvv};
    evaluate(uv, 2, patchPoints, pointDesc, results);
}

template <typename REAL>
void Surface<REAL>::evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL *const results[6],
                             PointDescriptor const &resultDesc) const {
    if (IsValid() && tessellation.IsValid() && tessellation.GetFaceShape() == GetFaceShape()) {
        internal::FaceEvaluator<REAL>(GetFace(), controlPoints, pointDesc)
            .Evaluate(tessellation.GetData(), results, resultDesc);
    }
}

template <typename REAL>
void Surface<REAL>::Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL p[],
                             PointDescriptor const &resultDesc) const {
    REAL *const results[6] = {p};
    evaluate(tessellation, controlPoints, pointDesc, results, resultDesc);
}

template <typename REAL>
void Surface<REAL>::Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL p[], REAL du[], REAL dv[],
                             PointDescriptor const &resultDesc) const {
    REAL *const results[6] = {p, du, dv};
    evaluate(tessellation, controlPoints, pointDesc, results, resultDesc);
}

template <typename REAL>
void Surface<REAL>::Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL p[], REAL du[], REAL dv[],
                             REAL duu[], REAL duv[], REAL dvv[],
                             PointDescriptor const &resultDesc) const {
    REAL *const results[6] = {p, du, dv, duu, duv, dvv};
    evaluate(tessellation, controlPoints, pointDesc, results, resultDesc);
}

template <typename REAL>
void Surface<REAL>::Evaluate(OpenSubdiv::Bfr::Tessellation const &tessellation,
                             REAL const controlPoints[], PointDescriptor const &pointDesc, REAL p[],
                             PointDescriptor const &resultDesc) const {
    Evaluate(tessellation, controlPoints, pointDesc, p, nullptr, nullptr, resultDesc);
}

template <typename REAL>
void Surface<REAL>::Evaluate(OpenSubdiv::Bfr::Tessellation const &tessellation,
                             REAL const controlPoints[], PointDescriptor const &pointDesc, REAL p[],
                             REAL du[], REAL dv[], PointDescriptor const &resultDesc) const {
    if (IsValid() && tessellation.IsValid() && tessellation.GetFaceSize() == GetFaceSize()) {
        REAL *const results[3] = {p, du, dv};
        internal::FaceEvaluator<REAL>(GetFace(), controlPoints, pointDesc)
            .Evaluate(tessellation, results, resultDesc);
    }
}

// Writes the weights of the point, and of derivatives as far as \p numDerivatives asks.
template <typename REAL>
int Surface<REAL>::evaluateStencil(REAL const uv[2], int numDerivatives,
                                   REAL *const weights[6]) const {
    if (!IsValid()) {
        return 0;
    }
    // Rounding of u and v matters more in larger polygons.
    double const tolerance = 2 * GetFaceSize() * double(std::numeric_limits<REAL>::epsilon());
    internal::BfrPlace const place = internal::FindBfrPlace(
        _parameterization, GetFaceShape(), {double(uv[0]), double(uv[1])}, tolerance);
    CellStencil stencil(*GetFace().type);
    stencil.Find(place.point, numDerivatives > 0);
    bool const hasSecond = numDerivatives > 1;
    if (hasSecond) {
        stencil.FindSecond(place.point);
    }
    std::size_t const numRows = numDerivatives == 0 ? 1 : hasSecond ? 6 : 3;
    std::vector<double> rows[6];
    for (std::size_t kind = 0; kind < numRows; ++kind) {
        rows[kind] = stencil.GetWeights(kind);
    }
    if (numDerivatives > 0 && _parameterization.HasSubFaces()) {
        double *const first[2] = {rows[1].data(), rows[2].data()};
        double *const second[3] = {rows[3].data(), rows[4].data(), rows[5].data()};
        internal::ToUv(place, rows[1].size(), first, hasSecond ? second : nullptr);
    }
    for (std::size_t kind = 0; kind < numRows; ++kind) {
        std::transform(rows[kind].begin(), rows[kind].end(), weights[kind],
                       [](double weight) { return REAL(weight); });
    }
    return GetNumControlPoints();
}

template <typename REAL>
int Surface<REAL>::EvaluateStencil(REAL const uv[2], REAL weights[]) const {
    REAL *const all[6] = {weights};
    return evaluateStencil(uv, 0, all);
}

template <typename REAL>
int Surface<REAL>::EvaluateStencil(REAL const uv[2], REAL weights[], REAL duWeights[],
                                   REAL dvWeights[]) const {
    REAL *const all[6] = {weights, duWeights, dvWeights};
    return evaluateStencil(uv, 1, all);
}

template <typename REAL>
int Surface<REAL>::EvaluateStencil(REAL const uv[2], REAL weights[], REAL duWeights[],
                                   REAL dvWeights[], REAL duuWeights[], REAL duvWeights[],
                                   REAL dvvWeights[]) const {
    REAL *const all[6] = {weights, duWeights, dvWeights, duuWeights, duvWeights, dvvWeights};
    return evaluateStencil(uv, 2, all);
}

template <typename REAL>
void Surface<REAL>::ApplyStencil(REAL const stencil[], REAL const controlPoints[],
                                 PointDescriptor const &controlPointDesc, REAL result[]) const {
    if (!IsValid()) {
        return;
    }
    internal::SumUp(stencil, std::size_t(_numControlPoints), controlPoints, nullptr,
                    std::size_t(controlPointDesc.size), controlPointDesc.stride, result);
}

template <typename REAL>
void Surface<REAL>::ApplyStencilFromMesh(REAL const stencil[], REAL const meshPoints[],
                                         PointDescriptor const &meshPointDesc,
                                         REAL result[]) const {
    if (!IsValid()) {
        return;
    }
    internal::SumUp(stencil, std::size_t(_numControlPoints), meshPoints, GetFace().GetPoints(),
                    std::size_t(meshPointDesc.size), meshPointDesc.stride, result);
}

template class Surface<float>;
template class Surface<double>;

} // namespace OpenSubdivHex::BfrExt

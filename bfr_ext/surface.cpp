// SPDX-License-Identifier: Apache-2.0
#include "surface.h"

#include "cell/borderEvaluator.h"
#include "cell/facePatches.h"
#include "cell/patchEvaluator.h"
#include "cell/plainFace.h"
#include "cell/rateEvaluator.h"
#include "cell/refinedCells.h"

#include <algorithm>
#include <limits>

namespace OpenSubdivHex::BfrExt {

internal::CellType const &internal::BaseType::operator*() const {
    return _type ? *_type : _plain->Get();
}

bool internal::BaseType::IsInLattice() const {
    return _type ? _type->IsInLattice() : _plain->IsInLattice();
}

bool internal::BaseType::IsSharp() const { return _type && _type->IsSharp(); }

internal::PlainFaceType const *internal::BaseType::GetPlain() const {
    return _plain && !_plain->IsInLattice() ? _plain : nullptr;
}

namespace {

using internal::CellPlan;
using internal::CellStencil;

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
void Surface<REAL>::prefetch() const {
    if (internal::PlainFaceType const *const plain = _type.GetPlain()) {
        plain->PrefetchRings();
    }
}

template <typename REAL>
int Surface<REAL>::GetControlPointIndices(Index meshPointIndices[]) const {
    std::copy_n(getPoints(), GetNumControlPoints(), meshPointIndices);
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
    bound(GetNumControlPoints(), meshPoints, getPoints(), meshPointDesc, minExtent, maxExtent);
}

template <typename REAL>
int Surface<REAL>::GetNumPatchPoints() const {
    return IsValid()
               ? GetNumControlPoints() + internal::kNumPatchPoints *
                                             internal::GetNumFacePatches(GetFaceSize(), _patchLevel)
               : 0;
}

template <typename REAL>
void Surface<REAL>::ComputePatchPoints(REAL patchPoints[],
                                       PointDescriptor const &patchPointDesc) const {
    if (!IsValid()) {
        return;
    }
    REAL *const points =
        patchPoints + std::ptrdiff_t(GetNumControlPoints()) * patchPointDesc.stride;
    internal::MakeFacePatchPoints(_type, GetFaceSize(), _patchLevel, patchPoints,
                                  patchPointDesc.size, patchPointDesc.stride, points);
}

template <typename REAL>
void Surface<REAL>::evaluate(REAL const uv[2], int numDerivatives, REAL const patchPoints[],
                             PointDescriptor const &pointDesc, REAL *const results[6]) const {
    if (IsValid()) {
        internal::EvaluatePatch(
            internal::FindPatchPlace(
                internal::FindBfrPlace(_parameterization, {double(uv[0]), double(uv[1])}, 0),
                GetFaceSize(), _patchLevel, numDerivatives),
            numDerivatives, patchPoints + std::ptrdiff_t(GetNumControlPoints()) * pointDesc.stride,
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
void Surface<REAL>::Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL p[],
                             PointDescriptor const &resultDesc) const {
    REAL *const results[3] = {p, nullptr, nullptr};
    if (canEvaluate(tessellation)) {
        evaluate(tessellation, controlPoints, pointDesc, results, resultDesc);
    }
}

template <typename REAL>
void Surface<REAL>::Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL p[], REAL du[], REAL dv[],
                             PointDescriptor const &resultDesc) const {
    REAL *const results[3] = {p, du, dv};
    REAL *const derivatives[5] = {du, dv};
    if (canEvaluate(tessellation)) {
        evaluate(tessellation, controlPoints, pointDesc, results, resultDesc);
        turnDerivatives(tessellation, std::size_t(pointDesc.size), derivatives, resultDesc);
    }
}

template <typename REAL>
void Surface<REAL>::Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL p[], REAL du[], REAL dv[],
                             REAL duu[], REAL duv[], REAL dvv[],
                             PointDescriptor const &resultDesc) const {
    if (!canEvaluate(tessellation)) {
        return;
    }
    REAL *const results[3] = {p, du, dv};
    evaluate(tessellation, controlPoints, pointDesc, results, resultDesc);
    CellStencil stencil(*_type);
    std::ptrdiff_t result = 0;
    for (LevelTessellation::SectorCoords const &place : tessellation._places) {
        internal::BasePoint const point =
            internal::MakeBasePoint(GetFaceSize(), place.sector, {place.start, place.end});
        stencil.Find(point, false);
        stencil.FindSecond(point);
        auto const sum = [&](std::vector<double> const &weights, REAL *to) {
            sumUp(weights.data(), GetNumControlPoints(), controlPoints, nullptr, pointDesc,
                  to + result);
        };
        sum(stencil.GetDuuWeights(), duu);
        sum(stencil.GetDuvWeights(), duv);
        sum(stencil.GetDvvWeights(), dvv);
        result += resultDesc.stride;
    }
    REAL *const derivatives[5] = {du, dv, duu, duv, dvv};
    turnDerivatives(tessellation, std::size_t(pointDesc.size), derivatives, resultDesc);
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
    if (!IsValid() || !tessellation.IsValid() || tessellation.GetFaceSize() != GetFaceSize()) {
        return;
    }
    REAL *const results[3] = {p, du, dv};
    useBorder(controlPoints, pointDesc, [&](internal::BorderEvaluator<REAL> &border) {
        internal::RateEvaluator<REAL> evaluator(tessellation, border, results, resultDesc.stride);
        if (internal::PlainFaceType const *const plain = _type.GetPlain()) {
            evaluator.Evaluate(*plain);
        } else {
            evaluator.Evaluate(*_type, controlPoints, pointDesc.stride);
        }
    });
}

template <typename REAL>
bool Surface<REAL>::canEvaluate(LevelTessellation const &tessellation) const {
    return IsValid() && tessellation.IsValid() && tessellation.GetFaceSize() == GetFaceSize();
}

template <typename REAL>
internal::BfrPlace Surface<REAL>::findPlace(REAL const uv[2]) const {
    // Rounding of u and v matters more in larger polygons.
    double const tolerance = 2 * GetFaceSize() * double(std::numeric_limits<REAL>::epsilon());
    return internal::FindBfrPlace(_parameterization, {double(uv[0]), double(uv[1])}, tolerance);
}

// Turns derivatives by the coordinates of the plane of the face into those by u and v, at all places of a tessellation.
template <typename REAL>
void Surface<REAL>::turnDerivatives(LevelTessellation const &tessellation, std::size_t size,
                                    REAL *const derivatives[5],
                                    PointDescriptor const &resultDesc) const {
    if (!_parameterization.HasSubFaces()) {
        return;
    }
    std::ptrdiff_t result = 0;
    for (internal::BfrPlace const &place : tessellation.getBfrPlaces()) {
        auto const at = [&](std::size_t kind) { return derivatives[kind] + result; };
        REAL *const first[2] = {at(0), at(1)};
        if (derivatives[2]) {
            REAL *const second[3] = {at(2), at(3), at(4)};
            internal::ToUv(place, size, first, second);
        } else {
            internal::ToUv<REAL>(place, size, first, nullptr);
        }
        result += resultDesc.stride;
    }
}

// Calls function(evaluator) for the border of the face.
template <typename REAL>
template <typename FUNCTION>
void Surface<REAL>::useBorder(REAL const controlPoints[], PointDescriptor const &pointDesc,
                              FUNCTION const &function) const {
    // Its memory is kept for the next face, as below.
    static thread_local internal::BorderEvaluator<REAL> border;
    auto const size = std::size_t(pointDesc.size);
    if (internal::PlainFaceType const *const plain = _type.GetPlain()) {
        border.SetFace(*plain, getTurns(), std::size_t(_numControlPoints), controlPoints,
                       pointDesc.stride, size);
    } else {
        border.SetFace(*_type, getTurns(), controlPoints, pointDesc.stride, size);
    }
    function(border);
}

template <typename REAL>
void Surface<REAL>::evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                             PointDescriptor const &pointDesc, REAL *const results[3],
                             PointDescriptor const &resultDesc) const {
    if (!tessellation._cellPlans) {
        evaluateTree(tessellation, controlPoints, pointDesc, results, resultDesc);
        return;
    }
    // Its memory is kept for the next face.
    static thread_local internal::PatchEvaluator<REAL> evaluator;
    internal::PlainFaceType const *const plain = _type.GetPlain();
    bool const isInLattice = _type.IsInLattice();
    CellPlan const &plan = tessellation.getCellPlan(isInLattice);
    CellPlan const *const ofDerivatives =
        results[1] ? &tessellation.getCellPlan(isInLattice, true) : nullptr;
    if (!plain) {
        if (!isInLattice) {
            // Mostly no other face has the same, so that it would be waited for.
            _type->GetStep().Prefetch();
        }
        evaluator.Evaluate(*_type, plan, pointDesc.size, controlPoints, pointDesc.stride,
                           results[0], resultDesc.stride);
        if (ofDerivatives) {
            evaluator.EvaluateDerivatives(*_type, *ofDerivatives, pointDesc.size, controlPoints,
                                          pointDesc.stride, results[1], results[2],
                                          resultDesc.stride);
        }
    }
    useBorder(controlPoints, pointDesc, [&](internal::BorderEvaluator<REAL> &border) {
        if (plain) {
            internal::RingValues<REAL> &values = border.GetRingValues();
            evaluator.Evaluate(*plain, values, plan, results[0], resultDesc.stride);
            if (ofDerivatives) {
                evaluator.EvaluateDerivatives(*plain, values, *ofDerivatives, results[1],
                                              results[2], resultDesc.stride);
            }
        }
        evaluateBorder(tessellation, border, results[0], resultDesc);
    });
}

// The control points are refined along the tree, as far as cells have corners that are asked for.
template <typename REAL>
void Surface<REAL>::evaluateTree(LevelTessellation const &tessellation, REAL const controlPoints[],
                                 PointDescriptor const &pointDesc, REAL *const results[3],
                                 PointDescriptor const &resultDesc) const {
    auto const length = std::size_t(pointDesc.size);
    std::vector<double> control;
    for (int i = 0; i < GetNumControlPoints(); ++i) {
        REAL const *const point = controlPoints + std::ptrdiff_t(i) * pointDesc.stride;
        control.insert(control.end(), point, point + pointDesc.size);
    }
    CellTree const &tree = tessellation._tree->cells;
    std::vector<double> point(2 * length);
    std::vector<bool> isDone(tessellation._places.size());
    auto const write = [&](int place, int kind, double const *from) {
        std::copy(from, from + length, results[kind] + std::ptrdiff_t(place) * resultDesc.stride);
    };
    // Their memory is kept for the next face.
    static thread_local internal::RefinedCells cells;
    using Corners = std::vector<LevelTessellation::CellCorner>;
    auto const forEachCornerOf = [](int treeCell, Corners const &ofAll, auto const &function) {
        auto corner = std::lower_bound(
            ofAll.begin(), ofAll.end(), treeCell,
            [](LevelTessellation::CellCorner const &a, int number) { return a.cell < number; });
        for (; corner != ofAll.end() && corner->cell == treeCell; ++corner) {
            function(*corner);
        }
    };
    Corners const withDerivatives =
        results[1] ? tessellation.findCornersOfDerivatives() : Corners();
    auto const evaluateCorners = [&](int treeCell, std::size_t cell) {
        if (treeCell > 0) { // points on the border are made below
            forEachCornerOf(treeCell, tessellation._tree->corners, [&](auto const &corner) {
                cells.EvaluateCorner(cell, corner.corner, point.data());
                write(corner.place, 0, point.data());
            });
        }
        forEachCornerOf(treeCell, withDerivatives, [&](auto const &corner) {
            cells[cell].EvaluateCorner(corner.corner, point.data(), point.data() + length);
            write(corner.place, 1, point.data());
            write(corner.place, 2, point.data() + length);
            isDone[std::size_t(corner.place)] = true;
        });
    };
    auto const visit = [&](auto const &self, int treeCell, std::size_t cell) -> void {
        evaluateCorners(treeCell, cell);
        if (!tree.IsRefined(treeCell)) {
            return;
        }
        int const firstInTree = tree.GetFirstChild(treeCell);
        std::size_t const first = cells.GetFirstChild(cell);
        std::size_t const numCells = cells.GetSize();
        for (int i = 0; i < tree.GetNumChildren(treeCell); ++i) {
            // Only the first child has corners that the cell has not.
            if (i == 0 || tree.IsRefined(firstInTree + i)) {
                self(self, firstInTree + i, first + std::size_t(i));
                cells.Drop(numCells);
            }
        }
    };
    if (internal::PlainFaceType const *const plain = _type.GetPlain()) {
        cells.SetBase(*plain, control.data(), pointDesc.size);
    } else {
        cells.SetBase(*_type, control.data(), pointDesc.size);
    }
    visit(visit, 0, internal::RefinedCells::kBase);
    // Derivatives where the tree has not the cell that they are from.
    for (std::size_t i = 0; results[1] && i < isDone.size(); ++i) {
        if (!isDone[i]) {
            LevelTessellation::SectorCoords const &place = tessellation._places[i];
            CellStencil stencil(*_type);
            stencil.Find(
                internal::MakeBasePoint(GetFaceSize(), place.sector, {place.start, place.end}),
                true);
            auto const sumTo = [&](std::vector<double> const &weights, int kind) {
                sumUp(weights.data(), GetNumControlPoints(), controlPoints, nullptr, pointDesc,
                      results[kind] + std::ptrdiff_t(i) * resultDesc.stride);
            };
            sumTo(stencil.GetDuWeights(), 1);
            sumTo(stencil.GetDvWeights(), 2);
        }
    }
    useBorder(controlPoints, pointDesc, [&](internal::BorderEvaluator<REAL> &border) {
        evaluateBorder(tessellation, border, results[0], resultDesc);
    });
}

// Makes the points on the border.
template <typename REAL>
void Surface<REAL>::evaluateBorder(LevelTessellation const &tessellation,
                                   internal::BorderEvaluator<REAL> &evaluator, REAL p[],
                                   PointDescriptor const &resultDesc) const {
    if (tessellation._section) {
        evaluateSectionBorder(tessellation, evaluator, p, resultDesc);
        return;
    }
    auto const getResult = [&](int place) { return p + std::ptrdiff_t(place) * resultDesc.stride; };
    for (std::size_t edge = 0; edge < std::size_t(GetFaceSize()); ++edge) {
        int const first = tessellation._firstEdgeCoords[edge];
        evaluator.EvaluateVertex(edge, getResult(first));
        int const numPlaces = tessellation.GetNumEdgeCoords(int(edge));
        int const level = tessellation.getEdgeLevel(edge);
        if (level < 0) {
            for (int place = first + 1; place <= first + numPlaces; ++place) {
                LevelTessellation::SectorCoords const &coords =
                    tessellation._places[std::size_t(place)];
                evaluator.EvaluateKeptPoint(edge, {coords.start, coords.end}, getResult(place));
            }
        } else if (numPlaces > 0) {
            evaluator.EvaluateEdge(edge, level, getResult(first + 1), resultDesc.stride);
        }
    }
}

// Points on the border of the face, with the bits that all points of the face have.
template <typename REAL>
void Surface<REAL>::evaluateSectionBorder(LevelTessellation const &tessellation,
                                          internal::BorderEvaluator<REAL> &evaluator, REAL p[],
                                          PointDescriptor const &resultDesc) const {
    std::size_t const size = evaluator.GetSize();
    int evaluatedEdge = -1;
    std::vector<REAL> edgePoints;
    for (LevelTessellation::BorderRun const &run : tessellation._section->border) {
        auto const edge = std::size_t(run.edge);
        for (int i = 0; i < run.count; ++i) {
            int const place = run.place + i;
            REAL *const result = p + std::ptrdiff_t(place) * resultDesc.stride;
            if (run.index + i < 0) {
                evaluator.EvaluateVertex(edge, result);
                continue;
            }
            int const level = tessellation.getEdgeLevel(edge);
            if (level < 0) {
                LevelTessellation::SectorCoords const &coords =
                    tessellation._places[std::size_t(place)];
                evaluator.EvaluateKeptPoint(edge, {coords.start, coords.end}, result);
                continue;
            }
            if (run.edge != evaluatedEdge) {
                int const numPoints = Polyline(level).GetNumPoints();
                edgePoints.resize(std::size_t(numPoints) * size);
                evaluator.EvaluateEdge(edge, level, edgePoints.data(), std::ptrdiff_t(size));
                evaluatedEdge = run.edge;
            }
            std::copy_n(&edgePoints[std::size_t(run.index + i) * size], size, result);
        }
    }
}

// Writes the weights of the point, and of derivatives as far as \p numDerivatives asks.
template <typename REAL>
int Surface<REAL>::evaluateStencil(REAL const uv[2], int numDerivatives,
                                   REAL *const weights[6]) const {
    if (!IsValid()) {
        return 0;
    }
    internal::BfrPlace const place = findPlace(uv);
    CellStencil stencil(*_type);
    stencil.Find(place.point, numDerivatives > 0);
    copyWeights(stencil.GetWeights(), weights[0]);
    if (numDerivatives == 0) {
        return GetNumControlPoints();
    }
    std::vector<double> rows[5] = {stencil.GetDuWeights(), stencil.GetDvWeights()};
    if (numDerivatives > 1) {
        stencil.FindSecond(place.point);
        rows[2] = stencil.GetDuuWeights();
        rows[3] = stencil.GetDuvWeights();
        rows[4] = stencil.GetDvvWeights();
    }
    if (_parameterization.HasSubFaces()) {
        double *const first[2] = {rows[0].data(), rows[1].data()};
        double *const second[3] = {rows[2].data(), rows[3].data(), rows[4].data()};
        internal::ToUv(place, rows[0].size(), first, numDerivatives > 1 ? second : nullptr);
    }
    for (std::size_t i = 0; i < (numDerivatives > 1 ? 5 : 2); ++i) {
        copyWeights(rows[i], weights[1 + i]);
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
    sumUp(stencil, GetNumControlPoints(), controlPoints, nullptr, controlPointDesc, result);
}

template <typename REAL>
void Surface<REAL>::ApplyStencilFromMesh(REAL const stencil[], REAL const meshPoints[],
                                         PointDescriptor const &meshPointDesc,
                                         REAL result[]) const {
    if (!IsValid()) {
        return;
    }
    sumUp(stencil, GetNumControlPoints(), meshPoints, getPoints(), meshPointDesc, result);
}

template class Surface<float>;
template class Surface<double>;

} // namespace OpenSubdivHex::BfrExt

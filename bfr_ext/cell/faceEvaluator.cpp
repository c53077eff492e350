// SPDX-License-Identifier: Apache-2.0
#include "faceEvaluator.h"

#include "cellStencil.h"
#include "patchEvaluator.h"
#include "rateEvaluator.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

template <typename REAL>
void FaceEvaluator<REAL>::Evaluate(TessellationData const &tessellation, REAL *const results[6],
                                   PointDescriptor const &resultDesc) {
    evaluateLeaves(tessellation, results, resultDesc);
    if (results[3]) {
        evaluateSecond(tessellation, results, resultDesc);
    }
    if (results[1] && tessellation.parameterization.HasSubFaces()) {
        turnDerivatives(tessellation, results, resultDesc);
    }
}

template <typename REAL>
void FaceEvaluator<REAL>::Evaluate(OpenSubdiv::Bfr::Tessellation const &tessellation,
                                   REAL *const results[3], PointDescriptor const &resultDesc) {
    useBorder([&](BorderEvaluator<REAL> &border) {
        RateEvaluator<REAL> evaluator(tessellation, border, results, resultDesc.stride);
        if (PlainFaceType const *const plain = _face.type.GetPlain()) {
            evaluator.Evaluate(*plain);
        } else {
            evaluator.Evaluate(*_face.type, _points.Get(), _points.GetStride());
        }
    });
}

template <typename REAL>
void FaceEvaluator<REAL>::evaluateSecond(TessellationData const &tessellation, REAL *const *results,
                                         PointDescriptor const &resultDesc) {
    CellStencil stencil(*_face.type);
    std::ptrdiff_t result = 0;
    for (auto const &[sector, coords] : tessellation.places) {
        BasePoint const point = MakeBasePoint(_face.type.GetShape(_face.size), sector, coords);
        stencil.Find(point, false);
        stencil.FindSecond(point);
        sumUp(stencil.GetDuuWeights(), results[3] + result);
        sumUp(stencil.GetDuvWeights(), results[4] + result);
        sumUp(stencil.GetDvvWeights(), results[5] + result);
        result += resultDesc.stride;
    }
}

// Turns derivatives by the coordinates of the plane of the face into those by u and v.
template <typename REAL>
void FaceEvaluator<REAL>::turnDerivatives(TessellationData const &tessellation,
                                          REAL *const *results,
                                          PointDescriptor const &resultDesc) const {
    auto const size = std::size_t(_size);
    std::ptrdiff_t result = 0;
    for (BfrPlace const &place : tessellation.GetBfrPlaces()) {
        auto const at = [&](std::size_t kind) { return results[kind] + result; };
        REAL *const first[2] = {at(1), at(2)};
        if (results[3]) {
            REAL *const second[3] = {at(3), at(4), at(5)};
            ToUv(place, size, first, second);
        } else {
            ToUv<REAL>(place, size, first, nullptr);
        }
        result += resultDesc.stride;
    }
}

// Calls function(evaluator) for the border of the face.
template <typename REAL>
template <typename FUNCTION>
void FaceEvaluator<REAL>::useBorder(FUNCTION const &function) {
    // Its memory is kept for the next face, as below.
    static thread_local BorderEvaluator<REAL> border;
    border.SetFace(_points);
    function(border);
}

template <typename REAL>
void FaceEvaluator<REAL>::evaluateLeaves(TessellationData const &tessellation, REAL *const *results,
                                         PointDescriptor const &resultDesc) {
    // Its memory is kept for the next face.
    static thread_local PatchEvaluator<REAL> evaluator;
    PlainFaceType const *const plain = _face.type.GetPlain();
    bool const isInLattice = _face.type.IsInLattice();
    CellPlan const &plan = tessellation.GetCellPlan(isInLattice);
    CellPlan const *const ofDerivatives =
        results[1] ? &tessellation.GetCellPlan(isInLattice, true) : nullptr;
    if (!plain) {
        REAL const *const points = _points.Get();
        evaluator.Evaluate(*_face.type, plan, _size, points, _points.GetStride(), results,
                           resultDesc.stride);
        if (ofDerivatives) {
            evaluator.Evaluate(*_face.type, *ofDerivatives, _size, points, _points.GetStride(),
                               results + 1, resultDesc.stride);
        }
    }
    useBorder([&](BorderEvaluator<REAL> &border) {
        // Where there are no places, no ring is needed.
        if (plain && !plan.IsEmpty()) {
            evaluator.Evaluate(*plain, border.GetRingValues(), plan, results, resultDesc.stride);
        }
        if (plain && ofDerivatives && !ofDerivatives->IsEmpty()) {
            evaluator.Evaluate(*plain, border.GetRingValues(), *ofDerivatives, results + 1,
                               resultDesc.stride);
        }
        evaluateBorder(tessellation, border, results[0], resultDesc);
    });
}

// Makes the points on the border.
template <typename REAL>
void FaceEvaluator<REAL>::evaluateBorder(TessellationData const &tessellation,
                                         BorderEvaluator<REAL> &evaluator, REAL *p,
                                         PointDescriptor const &resultDesc) const {
    if (tessellation.section) {
        evaluateSectionBorder(tessellation, evaluator, p, resultDesc);
        return;
    }
    auto const getResult = [&](int place) { return p + std::ptrdiff_t(place) * resultDesc.stride; };
    for (std::size_t edge = 0; edge < std::size_t(_face.size); ++edge) {
        int const first = tessellation.firstEdgeCoords[edge];
        int const numPlaces = tessellation.firstEdgeCoords[edge + 1] - first - 1;
        int const level = tessellation.placeLevels.ofEdges[edge];
        if (level < 0) {
            for (int place = first + 1; place <= first + numPlaces; ++place) {
                evaluator.EvaluateKeptPoint(edge, tessellation.GetWeightsOnEdge(edge, place),
                                            getResult(place));
            }
        } else if (numPlaces > 0) {
            evaluator.EvaluateEdge(edge, level, getResult(first + 1), resultDesc.stride);
        }
        // The edge has made the points of all rings, and the vertex finds those of its own among them.
        evaluator.EvaluateVertex(edge, getResult(first));
    }
}

// Evaluates the places on the border of the face, to the bit as with all points of the face.
template <typename REAL>
void FaceEvaluator<REAL>::evaluateSectionBorder(TessellationData const &tessellation,
                                                BorderEvaluator<REAL> &evaluator, REAL *p,
                                                PointDescriptor const &resultDesc) const {
    std::size_t const size = evaluator.GetSize();
    int evaluatedEdge = -1;
    std::vector<REAL> edgePoints;
    for (TessellationData::BorderRun const &run : tessellation.section->border) {
        auto const edge = std::size_t(run.edge);
        for (int i = 0; i < run.count; ++i) {
            int const place = run.place + i;
            REAL *const result = p + std::ptrdiff_t(place) * resultDesc.stride;
            if (run.index + i < 0) {
                evaluator.EvaluateVertex(edge, result);
                continue;
            }
            int const level = tessellation.placeLevels.ofEdges[edge];
            if (level < 0) {
                evaluator.EvaluateKeptPoint(edge, tessellation.GetWeightsOnEdge(edge, place),
                                            result);
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

template class FaceEvaluator<float>;
template class FaceEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

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
    RateEvaluator<REAL> evaluator(tessellation, setBorder(), results, resultDesc.stride);
    if (PlainFaceType const *const plain = _face.type.GetPlain()) {
        evaluator.Evaluate(*plain);
    } else {
        evaluator.Evaluate(*_face.type, _points.Get(), _points.GetStride());
    }
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
        for (std::size_t kind = 3; kind < 6; ++kind) {
            std::vector<double> const &weights = stencil.GetWeights(kind);
            SumUp(weights.data(), weights.size(), _points.Get(), nullptr, std::size_t(_size),
                  _points.GetStride(), results[kind] + result);
        }
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

// The evaluator of the border of the face.
template <typename REAL>
BorderEvaluator<REAL> &FaceEvaluator<REAL>::setBorder() {
    // Its memory is kept for the next face, as below.
    static thread_local BorderEvaluator<REAL> border;
    border.SetFace(_points);
    return border;
}

template <typename REAL>
void FaceEvaluator<REAL>::evaluateLeaves(TessellationData const &tessellation, REAL *const *results,
                                         PointDescriptor const &resultDesc) {
    static thread_local PatchEvaluator<REAL> evaluator;
    BorderEvaluator<REAL> &border = setBorder();
    PlainFaceType const *const plain = _face.type.GetPlain();
    auto const evaluate = [&](bool areDerivatives) {
        CellPlan const &plan = tessellation.GetCellPlan(_face.type.IsInLattice(), areDerivatives);
        REAL *const *const ofPlan = results + (areDerivatives ? 1 : 0);
        if (!plain) {
            evaluator.Evaluate(*_face.type, plan, _size, _points.Get(), _points.GetStride(), ofPlan,
                               resultDesc.stride);
        } else if (!plan.IsEmpty()) { // else no ring is needed
            evaluator.Evaluate(*plain, border.GetRingValues(), plan, ofPlan, resultDesc.stride);
        }
    };
    evaluate(false);
    if (results[1]) {
        evaluate(true);
    }
    evaluateBorder(tessellation, border, results[0], resultDesc);
}

// Makes the points on the border: those of a section to the bit as with all points of the face.
template <typename REAL>
void FaceEvaluator<REAL>::evaluateBorder(TessellationData const &tessellation,
                                         BorderEvaluator<REAL> &evaluator, REAL *p,
                                         PointDescriptor const &resultDesc) const {
    std::size_t const size = evaluator.GetSize();
    int evaluatedEdge = -1; // the edge whose points are there; -1: none
    std::vector<REAL> edgePoints;
    auto const getResult = [&](int place) { return p + std::ptrdiff_t(place) * resultDesc.stride; };
    for (TessellationData::BorderRun const &run : tessellation.border) {
        auto const edge = std::size_t(run.edge);
        int const level = tessellation.placeLevels.ofEdges[edge];
        int const begin = run.place + (run.index < 0 ? 1 : 0);
        int const end = run.place + run.count;
        if (level < 0) {
            for (int place = begin; place < end; ++place) {
                evaluator.EvaluateKeptPoint(edge, tessellation.GetWeightsOnEdge(edge, place),
                                            getResult(place));
            }
        } else if (run.hasWholeEdge && begin < end) {
            evaluator.EvaluateEdge(edge, level, getResult(begin), resultDesc.stride);
        } else if (begin < end) {
            if (run.edge != evaluatedEdge) {
                edgePoints.resize(std::size_t(Polyline(level).GetNumPoints()) * size);
                evaluator.EvaluateEdge(edge, level, edgePoints.data(), std::ptrdiff_t(size));
                evaluatedEdge = run.edge;
            }
            REAL const *point = &edgePoints[std::size_t(std::max(run.index, 0)) * size];
            for (int place = begin; place < end; ++place, point += size) {
                std::copy_n(point, size, getResult(place));
            }
        }
        // The edge has made the points of all rings, and the vertex finds those of its own among them.
        if (run.index < 0) {
            evaluator.EvaluateVertex(edge, getResult(run.place));
        }
    }
}

template class FaceEvaluator<float>;
template class FaceEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

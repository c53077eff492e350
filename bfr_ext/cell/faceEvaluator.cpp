// SPDX-License-Identifier: Apache-2.0
#include "faceEvaluator.h"

#include "cellStencil.h"
#include "patchEvaluator.h"
#include "rateEvaluator.h"
#include "refinedCells.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

template <typename REAL>
void FaceEvaluator<REAL>::Evaluate(TessellationData const &tessellation, REAL *const results[6],
                                   PointDescriptor const &resultDesc) {
    if (tessellation.HasCellPlans()) {
        evaluateLeaves(tessellation, results, resultDesc);
    } else {
        evaluateTree(tessellation, results, resultDesc);
    }
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
    for (TessellationData::SectorCoords const &place : tessellation.places) {
        BasePoint const point =
            MakeBasePoint(_face.type.GetShape(_face.size), place.sector, {place.start, place.end});
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

// The control points are refined along the tree, as far as cells have corners that are asked for.
template <typename REAL>
void FaceEvaluator<REAL>::evaluateTree(TessellationData const &tessellation, REAL *const *results,
                                       PointDescriptor const &resultDesc) {
    auto const length = std::size_t(_size);
    std::vector<double> control;
    REAL const *const points = _points.Get();
    for (int i = 0; i < _face.numPoints; ++i) {
        REAL const *const p = points + std::ptrdiff_t(i) * _points.GetStride();
        control.insert(control.end(), p, p + _size);
    }
    CellTree const &tree = tessellation.tree->cells;
    std::vector<double> point(2 * length);
    std::vector<bool> isDone(tessellation.places.size());
    auto const write = [&](int place, int kind, double const *from) {
        std::copy(from, from + length, results[kind] + std::ptrdiff_t(place) * resultDesc.stride);
    };
    // Their memory is kept for the next face.
    static thread_local RefinedCells cells;
    using Corners = std::vector<TessellationData::CellCorner>;
    auto const forEachCornerOf = [](int treeCell, Corners const &ofAll, auto const &function) {
        auto corner = std::lower_bound(
            ofAll.begin(), ofAll.end(), treeCell,
            [](TessellationData::CellCorner const &a, int number) { return a.cell < number; });
        for (; corner != ofAll.end() && corner->cell == treeCell; ++corner) {
            function(*corner);
        }
    };
    Corners const withDerivatives =
        results[1] ? tessellation.FindCornersOfDerivatives() : Corners();
    auto const evaluateCorners = [&](int treeCell, std::size_t cell) {
        if (treeCell > 0) { // points on the border are made below
            forEachCornerOf(treeCell, tessellation.tree->corners, [&](auto const &corner) {
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
    cells.SetBase(_face.type, control.data(), _size);
    visit(visit, 0, RefinedCells::kBase);
    // Derivatives where the tree has not the cell that they are from.
    for (std::size_t i = 0; results[1] && i < isDone.size(); ++i) {
        if (!isDone[i]) {
            TessellationData::SectorCoords const &place = tessellation.places[i];
            CellStencil stencil(*_face.type);
            stencil.Find(MakeBasePoint(_face.type.GetShape(_face.size), place.sector,
                                       {place.start, place.end}),
                         true);
            std::ptrdiff_t const result = std::ptrdiff_t(i) * resultDesc.stride;
            sumUp(stencil.GetDuWeights(), results[1] + result);
            sumUp(stencil.GetDvWeights(), results[2] + result);
        }
    }
    useBorder([&](BorderEvaluator<REAL> &border) {
        evaluateBorder(tessellation, border, results[0], resultDesc);
    });
}

// Makes the points on the border: of a section, to the bit as with all points of the face.
template <typename REAL>
void FaceEvaluator<REAL>::evaluateBorder(TessellationData const &tessellation,
                                         BorderEvaluator<REAL> &evaluator, REAL *p,
                                         PointDescriptor const &resultDesc) const {
    auto const getResult = [&](int place) { return p + std::ptrdiff_t(place) * resultDesc.stride; };
    std::size_t const size = evaluator.GetSize();
    int evaluatedEdge = -1;
    std::vector<REAL> edgePoints;
    auto const evaluateInside = [&](int edge, int firstIndex, int firstPlace, int count) {
        int const level = tessellation.GetEdgeLevel(std::size_t(edge));
        if (level < 0) {
            for (int place = firstPlace; place < firstPlace + count; ++place) {
                evaluator.EvaluateKeptPoint(std::size_t(edge),
                                            tessellation.GetWeightsOnEdge(std::size_t(edge), place),
                                            getResult(place));
            }
            return;
        }
        if (!tessellation.section) {
            evaluator.EvaluateEdge(std::size_t(edge), level, getResult(firstPlace),
                                   resultDesc.stride);
            return;
        }
        if (edge != evaluatedEdge) {
            edgePoints.resize(std::size_t(Polyline(level).GetNumPoints()) * size);
            evaluator.EvaluateEdge(std::size_t(edge), level, edgePoints.data(),
                                   std::ptrdiff_t(size));
            evaluatedEdge = edge;
        }
        for (int i = 0; i < count; ++i) {
            std::copy_n(&edgePoints[std::size_t(firstIndex + i) * size], size,
                        getResult(firstPlace + i));
        }
    };
    auto const evaluateRun = [&](TessellationData::BorderRun const &run) {
        int const numVertices = run.index < 0 ? 1 : 0;
        if (run.count > numVertices) {
            evaluateInside(run.edge, run.index + numVertices, run.place + numVertices,
                           run.count - numVertices);
        }
        // The edge has made the points of all rings, and the vertex finds those of its own among them.
        if (numVertices > 0) {
            evaluator.EvaluateVertex(std::size_t(run.edge), getResult(run.place));
        }
    };
    if (tessellation.section) {
        std::for_each(tessellation.section->border.begin(), tessellation.section->border.end(),
                      evaluateRun);
        return;
    }
    for (int edge = 0; edge < _face.size; ++edge) {
        int const first = tessellation.firstEdgeCoords[std::size_t(edge)];
        int const end = tessellation.firstEdgeCoords[std::size_t(edge) + 1];
        evaluateRun({edge, -1, end - first, first});
    }
}

template class FaceEvaluator<float>;
template class FaceEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "patchEvaluator.h"

#include <algorithm>
#include <array>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Makes matrices of a leaf, which set(stencil, row, place) fills.
template <typename REAL, std::size_t COUNT, typename SET>
std::array<PlaceMatrix<REAL>, COUNT> makeMatrices(CellType const &type, LeafPlaces const &places,
                                                  SET const &set) {
    std::array<PlaceMatrix<REAL>, COUNT> matrices;
    matrices.fill(PlaceMatrix<REAL>(places.GetSize(), std::size_t(type.GetNumPoints())));
    CellStencil stencil(type);
    for (std::size_t row = 0; row < places.GetSize(); ++row) {
        set(stencil, row, places[row], matrices);
    }
    return matrices;
}

// What a leaf is evaluated with, made when it is first asked for: its points, or derivatives.
template <typename REAL, std::size_t COUNT, typename SET>
std::array<PlaceMatrix<REAL>, COUNT> const &getMatrices(PatternOf of, CellType const &type,
                                                        LeafPlaces const &places, SET const &set) {
    int const numSteps = places.GetNumSteps();
    return type.GetPatterns().Get<std::array<PlaceMatrix<REAL>, COUNT>>(
        PatternTable::GetKind<REAL>(of), &numSteps, &numSteps + 1,
        [&] { return makeMatrices<REAL, COUNT>(type, places, set); });
}

} // namespace

template <typename REAL>
void PatchEvaluator<REAL>::Evaluate(CellType const &type, CellPlan const &plan, int size,
                                    REAL const *controlPoints, std::ptrdiff_t stride, REAL *results,
                                    std::ptrdiff_t resultStride) {
    _results = results;
    _resultStride = resultStride;
    evaluate(type, plan, size, controlPoints, stride);
}

template <typename REAL>
void PatchEvaluator<REAL>::EvaluateDerivatives(CellType const &type, CellPlan const &plan, int size,
                                               REAL const *controlPoints, std::ptrdiff_t stride,
                                               REAL *du, REAL *dv, std::ptrdiff_t resultStride) {
    _results = nullptr;
    _derivatives[0] = du;
    _derivatives[1] = dv;
    _resultStride = resultStride;
    evaluate(type, plan, size, controlPoints, stride);
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluate(CellType const &type, CellPlan const &plan, int size,
                                    REAL const *controlPoints, std::ptrdiff_t stride) {
    _size = std::size_t(size);
    _paddedSize = StepMatrix::GetPaddedSize(_size);
    auto const numPoints = std::size_t(type.GetNumPoints());
    std::vector<REAL> &points = getPoints(0, numPoints);
    for (std::size_t i = 0; i < numPoints; ++i) {
        StepMatrix::Pad(controlPoints + std::ptrdiff_t(i) * stride, _size,
                        &points[i * _paddedSize]);
    }
    descend(type, plan, 0, 0);
}

// Makes the points of all children of a cell, whose own are at twice the depth; those of one child at a
// time are behind these.
template <typename REAL>
void PatchEvaluator<REAL>::descend(CellType const &type, CellPlan const &plan, std::size_t node,
                                   std::size_t depth) {
    std::vector<REAL> const &ownPoints = getPoints(2 * depth, 0);
    if (!plan[node].corners.empty()) {
        evaluateCorners(type, plan[node], ownPoints.data());
    }
    StepMatrix const &step = type.GetStep();
    std::vector<REAL> &points = getPoints(2 * depth + 1, step.GetNumRows());
    step.Apply(ownPoints.data(), _paddedSize, points.data());
    for (std::size_t const next : plan[node].children) {
        CellPlan::Node const &child = plan[next];
        CellType::Child const &link = type.GetChildren()[child.child];
        std::vector<REAL> &childPoints = getPoints(2 * depth + 2, link.step.GetNumRows());
        link.step.CopyPoints(points.data(), _paddedSize, childPoints.data());
        if (child.leaf) {
            evaluateLeaf(*link.type, child, childPoints.data());
        } else {
            descend(*link.type, plan, next, depth + 1);
        }
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluateLeaf(CellType const &type, CellPlan::Node const &leaf,
                                        REAL const *points) {
    auto const sumUp = [&](PlaceMatrix<REAL> const &matrix, REAL *results) {
        SumUpPlaces(matrix, {points, std::ptrdiff_t(_paddedSize), _size, nullptr, results,
                             _resultStride, leaf.rows.data(), leaf.rows.size()});
    };
    if (_results) {
        sumUp(getMatrices<REAL, 1>(PatternOf::Leaf, type, *leaf.leaf,
                                   [](CellStencil &stencil, std::size_t row,
                                      LeafPlaces::Place const &place, auto &matrices) {
                                       stencil.Find({place.sector, place.coords, {}}, false);
                                       matrices[0].Set(row, stencil.GetWeights());
                                   })[0],
              _results);
        return;
    }
    auto const &matrices = getMatrices<REAL, 2>(
        PatternOf::LeafDerivatives, type, *leaf.leaf,
        [&](CellStencil &stencil, std::size_t row, LeafPlaces::Place const &place, auto &results) {
            stencil.Find(type.IsWhole()
                             ? MakeBasePoint(type.GetNumCorners(), place.sector, place.coords)
                             : BasePoint{place.sector, place.coords, {{1, 0}, {0, 1}}},
                         true);
            results[0].Set(row, stencil.GetDuWeights());
            results[1].Set(row, stencil.GetDvWeights());
        });
    sumUp(matrices[0], _derivatives[0]);
    sumUp(matrices[1], _derivatives[1]);
    REAL factors[2][2];
    for (std::size_t i = 0; i < 2; ++i) {
        std::copy_n(leaf.toCoords[i].begin(), 2, factors[i]);
    }
    for (PlaceOfRow const &row : leaf.rows) {
        REAL *const du = _derivatives[0] + std::ptrdiff_t(row.place) * _resultStride;
        REAL *const dv = _derivatives[1] + std::ptrdiff_t(row.place) * _resultStride;
        for (std::size_t k = 0; k < _size; ++k) {
            REAL const along[2] = {du[k], dv[k]};
            du[k] = factors[0][0] * along[0] + factors[1][0] * along[1];
            dv[k] = factors[0][1] * along[0] + factors[1][1] * along[1];
        }
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluateCorners(CellType const &type, CellPlan::Node const &cell,
                                           REAL const *points) {
    for (CellPlan::CornerPlace const &corner : cell.corners) {
        CellType::Corner const &ofType = type.GetCorners()[corner.corner];
        std::ptrdiff_t const first = std::ptrdiff_t(corner.place) * _resultStride;
        for (std::size_t k = 0; k < _size; ++k) {
            double along[2] = {};
            for (std::size_t i = 0; i < 2; ++i) {
                REAL const *point = points + k;
                for (double const weight : ofType.derivatives[i]) {
                    along[i] += weight * double(*point);
                    point += _paddedSize;
                }
            }
            for (std::size_t i = 0; i < 2; ++i) {
                _derivatives[i][first + std::ptrdiff_t(k)] =
                    REAL(corner.toCoords[0][i] * along[0] + corner.toCoords[1][i] * along[1]);
            }
        }
    }
}

// With room for some points at least.
template <typename REAL>
std::vector<REAL> &PatchEvaluator<REAL>::getPoints(std::size_t place, std::size_t numPoints) {
    while (_points.size() <= place) {
        _points.emplace_back();
    }
    std::vector<REAL> &points = _points[place];
    points.resize(std::max(points.size(), numPoints * _paddedSize));
    return points;
}

template class PatchEvaluator<float>;
template class PatchEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

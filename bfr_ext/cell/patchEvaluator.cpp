// SPDX-License-Identifier: Apache-2.0
#include "patchEvaluator.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// The matrix of a leaf, made when it is first asked for.
template <typename REAL>
PlaceMatrix<REAL> const &getMatrix(CellType const &type, LeafPlaces const &places) {
    int const numSteps = places.GetNumSteps();
    return type.GetPatterns().Get<PlaceMatrix<REAL>>(
        PatternTable::GetKind<REAL>(PatternOf::Leaf), &numSteps, &numSteps + 1, [&] {
            PlaceMatrix<REAL> matrix(places.GetSize(), std::size_t(type.GetNumPoints()));
            CellStencil stencil(type);
            for (std::size_t row = 0; row < places.GetSize(); ++row) {
                stencil.Find({places[row].sector, places[row].coords, {}}, false);
                matrix.Set(row, stencil.GetWeights());
            }
            return matrix;
        });
}

} // namespace

template <typename REAL>
void PatchEvaluator<REAL>::Evaluate(CellType const &type, CellPlan const &plan, int size,
                                    REAL const *controlPoints, std::ptrdiff_t stride, REAL *results,
                                    std::ptrdiff_t resultStride) {
    _size = std::size_t(size);
    _paddedSize = StepMatrix::GetPaddedSize(_size);
    _results = results;
    _resultStride = resultStride;
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
    StepMatrix const &step = type.GetStep();
    std::vector<REAL> &points = getPoints(2 * depth + 1, step.GetNumRows());
    step.Apply(getPoints(2 * depth, 0).data(), _paddedSize, points.data());
    for (std::size_t const next : plan[node].children) {
        CellPlan::Node const &child = plan[next];
        CellType::Child const &link = type.GetChildren()[child.child];
        std::vector<REAL> &childPoints = getPoints(2 * depth + 2, link.step.GetNumRows());
        link.step.CopyPoints(points.data(), _paddedSize, childPoints.data());
        if (child.leaf) {
            SumUpPlaces(getMatrix<REAL>(*link.type, *child.leaf),
                        {childPoints.data(), std::ptrdiff_t(_paddedSize), _size, nullptr, _results,
                         _resultStride, child.rows.data(), child.rows.size()});
        } else {
            descend(*link.type, plan, next, depth + 1);
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

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
void PatchEvaluator<REAL>::Evaluate(CellType const &type, CellPlan const &plan,
                                    REAL const *controlPoints, std::ptrdiff_t stride, REAL *results,
                                    std::ptrdiff_t resultStride) {
    _results = results;
    _resultStride = resultStride;
    if (_points.empty()) {
        _points.emplace_back();
    }
    auto const numPoints = std::size_t(type.GetNumPoints());
    _points[0].resize(std::max(_points[0].size(), numPoints * _paddedSize));
    for (std::size_t i = 0; i < numPoints; ++i) {
        std::copy_n(controlPoints + std::ptrdiff_t(i) * stride, _size,
                    &_points[0][i * _paddedSize]);
    }
    descend(type, plan, 0, 0);
}

template <typename REAL>
void PatchEvaluator<REAL>::descend(CellType const &type, CellPlan const &plan, std::size_t node,
                                   std::size_t depth) {
    if (_points.size() <= depth + 1) {
        _points.emplace_back();
    }
    for (std::size_t const next : plan[node].children) {
        CellPlan::Node const &child = plan[next];
        CellType::Child const &link = type.GetChildren()[child.child];
        std::vector<REAL> &points = _points[depth + 1];
        points.resize(
            std::max(points.size(), std::size_t(link.type->GetNumPoints()) * _paddedSize));
        link.step.Apply(_points[depth].data(), _paddedSize, points.data());
        if (child.leaf) {
            SumUpPlaces(getMatrix<REAL>(*link.type, *child.leaf),
                        {points.data(), std::ptrdiff_t(_paddedSize), _size, nullptr, _results,
                         _resultStride, child.rows.data(), child.rows.size()});
        } else {
            descend(*link.type, plan, next, depth + 1);
        }
    }
}

template class PatchEvaluator<float>;
template class PatchEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

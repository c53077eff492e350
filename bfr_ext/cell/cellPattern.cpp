// SPDX-License-Identifier: Apache-2.0
#include "cellPattern.h"

namespace OpenSubdivHex::BfrExt::internal {

template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, std::vector<BasePoint> const &places,
                               std::size_t numBorderPlaces) {
    CellStencil stencil(root);
    std::vector<std::vector<double>> stencils;
    for (std::size_t place = numBorderPlaces; place < places.size(); ++place) {
        stencil.Find(places[place], false);
        stencils.push_back(stencil.GetWeights());
    }
    constexpr std::size_t kEven = 0;
    matrices.emplace_back(Symmetries(root, Symmetries::Kind::Reflections), places, numBorderPlaces,
                          stencils, kEven);
}

// Derivatives are from the side of a cell, so that they are not reflected.
template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, std::vector<BasePoint> const &places) {
    CellStencil stencil(root);
    std::vector<std::vector<double>> duStencils;
    std::vector<std::vector<double>> dvStencils;
    for (BasePoint const &place : places) {
        stencil.Find(place, true);
        duStencils.push_back(stencil.GetDuWeights());
        dvStencils.push_back(stencil.GetDvWeights());
    }
    Symmetries const symmetries(root, Symmetries::Kind::HalfTurn);
    std::size_t const odd = symmetries.GetNumImages() - 1;
    for (auto const *stencils : {&duStencils, &dvStencils}) {
        matrices.emplace_back(symmetries, places, 0, *stencils, odd);
    }
}

template struct CellPattern<float>;
template struct CellPattern<double>;

BorderPlace FindBorderPlace(CellType const &root, int const *turns, BasePoint const &point) {
    auto const numEdges = std::size_t(root.GetNumCorners());
    auto const sector = std::size_t(point.sector);
    if (point.coords[1] == 0) {
        return {&root.GetBorderItem(turns, numEdges + sector), 0};
    }
    if (point.coords[0] == 0) {
        return {&root.GetBorderItem(turns, numEdges + (sector + 1) % numEdges), 0};
    }
    CellType::BorderItem const &edge = root.GetBorderItem(turns, sector);
    return {&edge, point.coords[edge.isReversed ? 0 : 1]};
}

template <typename REAL>
PlaceMatrix<REAL> BorderEvaluator<REAL>::MakeMatrix(CellType const &type,
                                                    std::vector<double> const &points) {
    PlaceMatrix<REAL> matrix(points.size(), std::size_t(type.GetNumPoints()));
    BorderStencil stencil;
    for (std::size_t place = 0; place < points.size(); ++place) {
        stencil.Find(type, points[place]);
        matrix.Set(place, stencil.GetWeights());
    }
    return matrix;
}

template <typename REAL>
void BorderEvaluator<REAL>::SetPoints(REAL const *points, std::ptrdiff_t stride, int size) {
    _points = points;
    _stride = stride;
    _size = std::size_t(size);
    _paddedSize = StepMatrix::GetPaddedSize(_size);
}

template <typename REAL>
void BorderEvaluator<REAL>::Evaluate(CellType::BorderItem const &item,
                                     PlaceMatrix<REAL> const &matrix, REAL *results,
                                     std::ptrdiff_t resultStride) {
    if (&GetType(item) == item.type) {
        SumUpPlaces(matrix, {_points, _stride, _size, item.points.data(), results, resultStride});
        return;
    }
    StepMatrix const &step = item.type->GetStep();
    ChildStep const &longEdge = item.type->GetChildren()[0].step;
    padPoints(item.points.data(), item.points.size());
    _sums.resize(step.GetNumRows() * _paddedSize);
    step.Apply(_paddedPoints.data(), _paddedSize, _sums.data());
    _longEdgePoints.resize(longEdge.GetNumRows() * _paddedSize);
    longEdge.CopyPoints(_sums.data(), _paddedSize, _longEdgePoints.data());
    SumUpPlaces(matrix, {_longEdgePoints.data(), std::ptrdiff_t(_paddedSize), _size, nullptr,
                         results, resultStride});
}

template <typename REAL>
void BorderEvaluator<REAL>::FormSums(CellType::Border const &border) {
    padPoints(nullptr, border.sums.GetNumParentPoints());
    _sums.resize(border.sums.GetNumRows() * _paddedSize);
    border.sums.Apply(_paddedPoints.data(), _paddedSize, _sums.data());
}

template <typename REAL>
void BorderEvaluator<REAL>::EvaluateVertex(std::size_t vert, REAL *result) const {
    std::copy_n(&_sums[vert * _paddedSize], _size, result);
}

template <typename REAL>
void BorderEvaluator<REAL>::EvaluateEdge(CellType::Border::Edge const &edge,
                                         PlaceMatrix<REAL> const &matrix, REAL *results,
                                         std::ptrdiff_t resultStride) const {
    if (edge.points) {
        SumUpPlaces(matrix, {_points, _stride, _size, edge.points, results, resultStride});
    } else {
        SumUpPlaces(matrix, {&_sums[edge.firstSum * _paddedSize], std::ptrdiff_t(_paddedSize),
                             _size, nullptr, results, resultStride});
    }
}

// Copies points, those that indices say or all in turn.
template <typename REAL>
void BorderEvaluator<REAL>::padPoints(int const *indices, std::size_t numPoints) {
    _paddedPoints.resize(numPoints * _paddedSize);
    for (std::size_t i = 0; i < numPoints; ++i) {
        std::size_t const point = indices ? std::size_t(indices[i]) : i;
        StepMatrix::Pad(_points + std::ptrdiff_t(point) * _stride, _size,
                        &_paddedPoints[i * _paddedSize]);
    }
}

template class BorderEvaluator<float>;
template class BorderEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

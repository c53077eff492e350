// SPDX-License-Identifier: Apache-2.0
#include "cellPattern.h"

namespace OpenSubdivHex::BfrExt::internal {

template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, std::vector<BasePoint> const &places,
                               std::size_t numBorderPlaces)
    : points(places.size() - numBorderPlaces, std::size_t(root.GetNumPoints())) {
    CellStencil stencil(root);
    for (std::size_t place = numBorderPlaces; place < places.size(); ++place) {
        stencil.Find(places[place], false);
        points.Set(place - numBorderPlaces, stencil.GetWeights());
    }
}

template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, std::vector<BasePoint> const &places)
    : derivatives{{places.size(), std::size_t(root.GetNumPoints())},
                  {places.size(), std::size_t(root.GetNumPoints())}} {
    CellStencil stencil(root);
    for (std::size_t place = 0; place < places.size(); ++place) {
        stencil.Find(places[place], true);
        derivatives[0].Set(place, stencil.GetDuWeights());
        derivatives[1].Set(place, stencil.GetDvWeights());
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
void BorderEvaluator<REAL>::Evaluate(CellType::BorderItem const &item,
                                     PlaceMatrix<REAL> const &matrix, REAL *results,
                                     std::ptrdiff_t resultStride) {
    if (&GetType(item) == item.type) {
        SumUpPlaces(matrix, {_points, _stride, _size, item.points.data(), results, resultStride});
        return;
    }
    StepMatrix const &step = item.type->GetChildren()[0].step;
    std::size_t const paddedSize = StepMatrix::GetPaddedSize(_size);
    _edgePoints.resize(item.points.size() * paddedSize);
    _longEdgePoints.resize(step.GetNumRows() * paddedSize);
    REAL *to = _edgePoints.data();
    for (int const point : item.points) {
        std::copy_n(_points + point * _stride, _size, to);
        to += paddedSize;
    }
    step.Apply(_edgePoints.data(), paddedSize, _longEdgePoints.data());
    SumUpPlaces(matrix, {_longEdgePoints.data(), std::ptrdiff_t(paddedSize), _size, nullptr,
                         results, resultStride});
}

template class BorderEvaluator<float>;
template class BorderEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

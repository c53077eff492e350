// SPDX-License-Identifier: Apache-2.0
#include "cellPattern.h"

namespace OpenSubdivHex::BfrExt::internal {

BorderPlace FindBorderPlace(BasePoint const &point, CellType::Border const &border) {
    std::size_t const numEdges = border.size() / 2;
    auto const sector = std::size_t(point.sector);
    if (point.coords[1] == 0) {
        return {numEdges + sector, 0};
    }
    if (point.coords[0] == 0) {
        return {numEdges + (sector + 1) % numEdges, 0};
    }
    return {sector, point.coords[border[sector].isReversed ? 0 : 1]};
}

BorderPattern::BorderPattern(CellType const &type, std::vector<double> const &points)
    : numPlaces(points.size()), weights(points.size() * std::size_t(type.GetNumPoints())) {
    BorderStencil stencil;
    for (std::size_t place = 0; place < numPlaces; ++place) {
        stencil.Find(type, points[place]);
        double *weight = weights.data() + place;
        for (double const value : stencil.GetWeights()) {
            *weight = value;
            weight += numPlaces;
        }
    }
}

namespace {

// Applies a step to LENGTH numbers of each point: writes them number by number.
template <int LENGTH, typename REAL>
void applyStep(StepMatrix const &step, std::vector<int> const &points, REAL const *values,
               std::ptrdiff_t stride, double *result) {
    std::size_t const numRows = step.GetNumRows();
    for (std::size_t row = 0; row < numRows; ++row) {
        double sums[LENGTH] = {};
        step.ForEachEntry(row, [&](std::size_t parentPoint, double weight) {
            REAL const *const point = values + points[parentPoint] * stride;
            for (int i = 0; i < LENGTH; ++i) {
                sums[i] += weight * double(point[i]);
            }
        });
        for (int i = 0; i < LENGTH; ++i) {
            result[std::size_t(i) * numRows + row] = sums[i];
        }
    }
}

} // namespace

template <typename REAL>
BorderValues::BorderValues(CellType::BorderItem const &item, REAL const *points,
                           std::ptrdiff_t stride, int size)
    : _type(item.type), _size(std::size_t(size)) {
    if (item.type->IsVertex()) {
        _values.resize(_size * item.points.size());
        double *value = _values.data();
        for (int k = 0; k < size; ++k) {
            for (int const point : item.points) {
                *value++ = double(points[point * stride + k]);
            }
        }
        return;
    }
    CellType::Child const &child = item.type->GetChildren()[0];
    _type = child.type;
    auto const numPoints = std::size_t(_type->GetNumPoints());
    _values.resize(_size * numPoints);
    int k = 0;
    for (; k + 3 <= size; k += 3) {
        applyStep<3>(child.step, item.points, points + k, stride,
                     &_values[std::size_t(k) * numPoints]);
    }
    for (; k < size; ++k) {
        applyStep<1>(child.step, item.points, points + k, stride,
                     &_values[std::size_t(k) * numPoints]);
    }
}

template BorderValues::BorderValues(CellType::BorderItem const &, float const *, std::ptrdiff_t,
                                    int);
template BorderValues::BorderValues(CellType::BorderItem const &, double const *, std::ptrdiff_t,
                                    int);

template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, std::vector<BasePoint> const &places,
                               bool hasDerivatives)
    : _numPlaces(places.size()), _numPoints(std::size_t(root.GetNumPoints())) {
    std::size_t const numBlocks = (_numPlaces + kBlock - 1) / kBlock;
    std::size_t const numKinds = hasDerivatives ? 3 : 1;
    for (std::size_t kind = 0; kind < numKinds; ++kind) {
        _rows[kind].resize(numBlocks * kBlock * _numPoints);
    }
    CellStencil stencil(root);
    for (std::size_t place = 0; place < _numPlaces; ++place) {
        std::size_t const firstKind = places[place].IsOnBorder() ? 1 : 0;
        if (firstKind == numKinds) {
            continue;
        }
        stencil.Find(places[place], hasDerivatives);
        std::vector<double> const *const weights[3] = {
            &stencil.GetWeights(), &stencil.GetDuWeights(), &stencil.GetDvWeights()};
        for (std::size_t kind = firstKind; kind < numKinds; ++kind) {
            REAL *const block = _rows[kind].data() + place / kBlock * kBlock * _numPoints;
            for (std::size_t i = 0; i < _numPoints; ++i) {
                block[i * kBlock + place % kBlock] = REAL((*weights[kind])[i]);
            }
        }
    }
}

template <typename REAL>
void CellPattern<REAL>::Evaluate(int kind, Points const &points, REAL *results,
                                 std::ptrdiff_t resultStride) const {
    // The points are the matrix, number by number, and the places stand side by side.
    auto const size = std::size_t(points.size);
    std::vector<REAL> matrix(size * _numPoints);
    for (std::size_t i = 0; i < _numPoints; ++i) {
        REAL const *const point = points.points + std::ptrdiff_t(i) * points.stride;
        for (std::size_t k = 0; k < size; ++k) {
            matrix[k * _numPoints + i] = point[k];
        }
    }
    std::vector<REAL> sums(size * kBlock);
    LaneProduct<REAL> product = {matrix.data(), size,   _numPoints,  nullptr,
                                 kBlock,        kBlock, sums.data(), kBlock};
    for (std::size_t begin = 0; begin < _numPlaces; begin += kBlock) {
        product.block = _rows[kind].data() + begin * _numPoints;
        Multiply(product);
        std::size_t const numRows = std::min(kBlock, _numPlaces - begin);
        REAL *result = results + std::ptrdiff_t(begin) * resultStride;
        for (std::size_t row = 0; row < numRows; ++row, result += resultStride) {
            for (std::size_t k = 0; k < size; ++k) {
                result[k] = sums[k * kBlock + row];
            }
        }
    }
}

template class CellPattern<float>;
template class CellPattern<double>;

} // namespace OpenSubdivHex::BfrExt::internal

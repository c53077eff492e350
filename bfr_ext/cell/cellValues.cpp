// SPDX-License-Identifier: Apache-2.0
#include "cellValues.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Calls function(first, count) for some components of values at a time, count being known when this is
// compiled.
template <typename FUNCTION>
void forComponents(int length, FUNCTION const &function) {
    int k = 0;
    for (; k + 3 <= length; k += 3) {
        function(k, std::integral_constant<int, 3>());
    }
    for (; k < length; ++k) {
        function(k, std::integral_constant<int, 1>());
    }
}

} // namespace

void CellValues::SetBase(CellType const &root, double const *controlPoints, int length) {
    _type = &root;
    _level = 0;
    _length = length;
    _values.assign(controlPoints,
                   controlPoints + std::ptrdiff_t(root.GetNumPoints()) * std::ptrdiff_t(length));
}

void CellValues::SetChild(CellValues const &parent, int child) {
    CellType::Child const &link = parent._type->GetChildren()[std::size_t(child)];
    if (!link.type->IsWhole()) {
        bool const isOfWhole = parent._type->IsWhole();
        CellMap const &map =
            isOfWhole ? HalfCell::kFromSector : HalfCell::kChildren[std::size_t(child)];
        BasePoint const sector =
            isOfWhole ? MakeBasePoint(parent._type->GetNumCorners(), child - 1, {}) : BasePoint();
        Pair const *const rows = isOfWhole ? sector.toCoords : parent._toCoords;
        int const exponent = isOfWhole ? parent._level : 0;
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t k = 0; k < 2; ++k) {
                _toCoords[i][k] =
                    std::ldexp(map.rows[i][0] * rows[0][k] + map.rows[i][1] * rows[1][k], exponent);
            }
        }
    }
    _type = link.type;
    _level = parent._level + 1;
    _length = parent._length;
    ChildStep const &step = link.step;
    std::size_t const numVerts = step.GetNumRows();
    auto const length = std::size_t(_length);
    _values.resize(numVerts * length);
    forComponents(_length, [&](int first, auto count) {
        constexpr int kCount = decltype(count)::value;
        double const *const from = parent._values.data() + first;
        double *to = _values.data() + first;
        for (std::size_t vert = 0; vert < numVerts; ++vert, to += length) {
            double sums[kCount] = {};
            step.ForEachEntry(vert, [&](std::size_t parentPoint, double weight) {
                double const *const point = from + parentPoint * length;
                for (int k = 0; k < kCount; ++k) {
                    sums[k] += weight * point[k];
                }
            });
            std::copy(sums, sums + kCount, to);
        }
    });
}

void CellValues::sum(std::vector<double> const &weights, double *result) const {
    auto const length = std::size_t(_length);
    forComponents(_length, [&](int first, auto count) {
        constexpr int kCount = decltype(count)::value;
        double const *point = _values.data() + first;
        double sums[kCount] = {};
        for (double const weight : weights) {
            for (int k = 0; k < kCount; ++k) {
                sums[k] += weight * point[k];
            }
            point += length;
        }
        std::copy(sums, sums + kCount, result + first);
    });
}

void CellValues::EvaluateCorner(int corner, double *p) const {
    sum(_type->GetCornerPoints()[std::size_t(corner)], p);
}

void CellValues::EvaluateCorner(int corner, double *du, double *dv) const {
    Pair const *toCoords = _toCoords;
    BasePoint sector;
    if (_type->IsWhole()) {
        // The corner has the coordinates of its own sector, larger by what the steps have made them.
        sector = MakeBasePoint(_type->GetNumCorners(), corner, {});
        for (Pair &row : sector.toCoords) {
            row = {std::ldexp(row[0], _level), std::ldexp(row[1], _level)};
        }
        toCoords = sector.toCoords;
    }
    CellType::Corner const &values = _type->GetCorners()[std::size_t(corner)];
    auto const length = std::size_t(_length);
    _scratch.resize(2 * length);
    sum(values.derivatives[0], _scratch.data());
    sum(values.derivatives[1], _scratch.data() + length);
    for (std::size_t k = 0; k < length; ++k) {
        du[k] = toCoords[0][0] * _scratch[k] + toCoords[1][0] * _scratch[length + k];
        dv[k] = toCoords[0][1] * _scratch[k] + toCoords[1][1] * _scratch[length + k];
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

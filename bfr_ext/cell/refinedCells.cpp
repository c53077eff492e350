// SPDX-License-Identifier: Apache-2.0
#include "refinedCells.h"

namespace OpenSubdivHex::BfrExt::internal {

std::size_t RefinedCells::add(std::size_t number) {
    std::size_t const first = _size;
    _size += number;
    while (_cells.size() < _size) {
        _cells.emplace_back();
    }
    for (std::size_t cell = first; cell < _size; ++cell) {
        _cells[cell].firstChild = 0;
    }
    return first;
}

std::size_t RefinedCells::makeChildren(std::size_t cell) {
    int const numChildren = GetNumChildren(cell);
    std::size_t const first = add(std::size_t(numChildren));
    _cells[cell].firstChild = first;
    for (int i = 0; i < numChildren; ++i) {
        _cells[first + std::size_t(i)].values.SetChild(_cells[cell].values, i);
    }
    return first;
}

CellValues const &RefinedCells::findCorner(std::size_t cell, int &corner) {
    while (!hasCommonType(cell)) {
        CellValues const &values = _cells[cell].values;
        CornerChild const next = FindCornerChild(values.GetShape(), corner);
        corner = next.corner;
        cell = GetFirstChild(cell) + next.child;
    }
    return _cells[cell].values;
}

} // namespace OpenSubdivHex::BfrExt::internal

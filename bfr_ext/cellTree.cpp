// SPDX-License-Identifier: Apache-2.0
#include "cellTree.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace OpenSubdivHex::BfrExt {

CellTree::CellTree(int faceSize) : _faceSize(faceSize), _cells{{0, -1, 0, -1}} {}

CellTree::CellTree(int faceSize, int level)
    : CellTree(faceSize, std::vector<int>(std::size_t(faceSize), level).data(), level) {}

CellTree::CellTree(int faceSize, int const edgeLevels[], int level) : CellTree(faceSize) {
    for (int cell = 0; cell < GetNumCells(); ++cell) {
        if (isToRefine(cell, edgeLevels, level)) {
            Refine(cell);
        }
    }
}

// A step divides the long edges of half cells, and no others.
bool CellTree::isToRefine(int cell, int const edgeLevels[], int level) const {
    bool const isOnEdge = GetBorderSide(cell) == 0;
    return GetLevel(cell) < (isOnEdge ? std::min(level, edgeLevels[GetEdge(cell)]) : level);
}

int CellTree::GetMaxLevel() const {
    return std::max_element(_cells.begin(), _cells.end(),
                            [](Cell const &a, Cell const &b) { return a.level < b.level; })
        ->level;
}

int CellTree::Refine(int cell) {
    if (cell < 0 || cell >= GetNumCells()) {
        return 0;
    }
    Cell const parent = getCell(cell);
    int const first = GetNumCells();
    bool const hasNumbers =
        std::int64_t(first) + GetNumChildren(cell) <= std::numeric_limits<int>::max();
    if (parent.firstChild > 0 || parent.level == kLastLevel || !hasNumbers) {
        return parent.firstChild;
    }
    auto const level = short(parent.level + 1);
    _cells[std::size_t(cell)].firstChild = first;
    _numLeaves += GetNumChildren(cell) - 1;
    _cells.resize(_cells.size() + std::size_t(GetNumChildren(cell)));
    Cell *const children = &_cells[std::size_t(first)];
    if (parent.sector < 0) {
        children[0] = {0, -1, level, -1};
        for (int edge = 0; edge < _faceSize; ++edge) {
            children[1 + edge] = {0, edge, level, short(parent.level == 0 ? 0 : -1)};
        }
        return first;
    }
    // The long edge comes apart in the side before the end of child 3, the long edge of child 0 and
    // the side before the start of child 1; another side becomes the long edge of the child there.
    for (int child = 0; child < 4; ++child) {
        static constexpr short kSidesOnLongEdge[4] = {0, 3, -1, 1};
        bool const isSide = child > 0 && parent.borderSide == child;
        short const side =
            parent.borderSide == 0 ? kSidesOnLongEdge[child] : short(isSide ? 0 : -1);
        children[child] = {0, parent.sector, level, side};
    }
    return first;
}

// Adds what lies inside of the side of a cell that lies on the edge, from start to end.
void CellTree::addPoints(int cell, int start, int end, std::vector<Polyline::Place> &places) const {
    int const child = GetFirstChild(cell);
    if (child == 0) {
        return;
    }
    int const side = GetBorderSide(cell);
    if (side > 0) {
        addPoints(child + side, start, end, places);
        return;
    }
    int const first = start + (end - start) / 4;
    int const second = end - (end - start) / 4;
    addPoints(child + 3, start, first, places);
    places.push_back(Polyline::Place(first));
    addPoints(child, first, second, places);
    places.push_back(Polyline::Place(second));
    addPoints(child + 1, second, end, places);
}

Polyline CellTree::GetEdgePolyline(int edge) const {
    Polyline result;
    if (IsRefined(0)) {
        addPoints(GetFirstChild(0) + 1 + edge, 0, Polyline::kLength, result._places);
    }
    return result;
}

} // namespace OpenSubdivHex::BfrExt

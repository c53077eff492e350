// SPDX-License-Identifier: Apache-2.0
#include "cellTree.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace OpenSubdivHex::BfrExt {

using FarExt::FaceShape;

CellTree::CellTree(FaceShape shape) : _shape(shape) {}

CellTree::CellTree(FaceShape shape, int level)
    : CellTree(shape, std::vector<int>(std::size_t(shape.size), level).data(), level) {}

CellTree::CellTree(FaceShape shape, int const edgeLevels[], int level) : CellTree(shape) {
    for (int cell = 0; cell < GetNumCells(); ++cell) {
        if (isToRefine(cell, edgeLevels, level)) {
            Refine(cell);
        }
    }
}

// A step divides the long edges of half cells, and no others.
bool CellTree::isToRefine(int cell, int const edgeLevels[], int level) const {
    if (GetBorderSide(cell) == 0) {
        level = std::min(level, edgeLevels[GetEdge(cell)]);
    }
    if (GetLongEdgeSide(cell) == 0) {
        level = std::min(level, edgeLevels[0]);
    }
    return GetLevel(cell) < level;
}

int CellTree::GetMaxLevel() const {
    int level = 0;
    for (Cell const &cell : _cells) {
        level = std::max(level, int(cell.level));
    }
    return level;
}

int CellTree::Refine(int cell) {
    if (cell < 0 || cell >= GetNumCells()) {
        return 0;
    }
    Cell const parent = getCell(cell);
    int const borderSides[2] = {GetBorderSide(cell), GetLongEdgeSide(cell)};
    int const first = GetNumCells();
    bool const hasNumbers =
        std::int64_t(first) + GetNumChildren(cell) <= std::numeric_limits<int>::max();
    if (parent.firstChild > 0 || parent.level == kLastLevel || !hasNumbers) {
        return parent.firstChild;
    }
    auto const level = short(parent.level + 1);
    if (_cells.empty()) {
        _cells.reserve(1 + std::size_t(GetNumChildren(cell)));
        _cells.push_back(parent);
    }
    _cells[std::size_t(cell)].firstChild = first;
    _numLeaves += GetNumChildren(cell) - 1;
    _cells.resize(_cells.size() + std::size_t(GetNumChildren(cell)));
    Cell *const children = &_cells[std::size_t(first)];
    if (parent.sector < 0) {
        children[0] = {0, -1, level, {-1, parent.borderSides[1]}};
        int const firstSector = _shape.GetFirstSector();
        signed char const side = parent.level == 0 ? 0 : -1;
        for (int sector = firstSector; sector < _shape.size; ++sector) {
            signed char sideOnLongEdge = -1;
            if (_shape.isHalf && (sector == firstSector || sector + 1 == _shape.size)) {
                sideOnLongEdge = sector == firstSector ? 3 : 1;
            }
            children[1 + sector - firstSector] = {0, sector, level, {side, sideOnLongEdge}};
        }
        return first;
    }
    // The long edge comes apart in the side before the end of child 3, the long edge of child 0 and
    // the side before the start of child 1; another side becomes the long edge of the child there.
    for (int child = 0; child < 4; ++child) {
        static constexpr signed char kSidesOnLongEdge[4] = {0, 3, -1, 1};
        children[child] = {0, parent.sector, level, {}};
        for (std::size_t edge = 0; edge < 2; ++edge) {
            int const side = borderSides[edge];
            bool const isSide = child > 0 && side == child;
            children[child].borderSides[edge] =
                side == 0 ? kSidesOnLongEdge[child] : static_cast<signed char>(isSide ? 0 : -1);
        }
    }
    return first;
}

// Adds what lies inside of the side of a cell that lies on the edge of its sector, 0, or the long one, 1, from start to end.
void CellTree::addPoints(int cell, std::size_t edge, int start, int end,
                         std::vector<Polyline::Place> &places) const {
    int const child = GetFirstChild(cell);
    if (child == 0) {
        return;
    }
    int const side = edge == 0 ? GetBorderSide(cell) : GetLongEdgeSide(cell);
    if (side > 0) {
        addPoints(child + side, edge, start, end, places);
        return;
    }
    constexpr std::size_t kUsual = 12; // of edges of four levels, in the smallest block of a heap
    places.reserve(kUsual);
    int const first = start + (end - start) / 4;
    int const second = end - (end - start) / 4;
    addPoints(child + GetNumChildren(cell) - 1, edge, start, first, places);
    places.push_back(Polyline::Place(first));
    addPoints(child, edge, first, second, places);
    places.push_back(Polyline::Place(second));
    addPoints(child + 1, edge, second, end, places);
}

Polyline CellTree::GetEdgePolyline(int edge) const {
    Polyline result;
    int const child = edge - _shape.GetFirstSector();
    if (child < 0) {
        addPoints(0, 1, 0, Polyline::kLength, result._places);
    } else if (IsRefined(0)) {
        addPoints(GetFirstChild(0) + 1 + child, 0, 0, Polyline::kLength, result._places);
    }
    return result;
}

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#include "cellMesh.h"

#include <algorithm>
#include <map>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

constexpr std::int64_t kOne = std::int64_t(1) << CellMesh::kBits;

} // namespace

std::size_t CellMesh::Hash::operator()(std::array<std::int64_t, 3> const &key) const {
    std::uint64_t hash = std::uint64_t(key[0]);
    for (std::size_t i = 1; i < 3; ++i) {
        hash = (hash ^ std::uint64_t(key[i])) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 31;
    }
    return std::size_t(hash);
}

std::array<std::int64_t, 3> CellMesh::getKey(int faceSize, int sector, Place const &place) {
    if (place[0] == 0) {
        return {(sector + 1) % faceSize, place[1], 0};
    }
    return {sector, place[0], place[1]};
}

int CellMesh::find(int sector, Place const &place) const {
    auto const found = _numbers.find(getKey(_faceSize, sector, place));
    return found == _numbers.end() ? -1 : found->second;
}

void CellMesh::add(int sector, Place const &place, int cell, int corner) {
    std::array<std::int64_t, 3> const key = getKey(_faceSize, sector, place);
    if (_numbers.emplace(key, int(_verts.size())).second) {
        _verts.push_back({int(key[0]), key[1], key[2], cell, corner});
    }
}

CellMesh::CellMesh(CellTree const &tree, Polyline const edges[]) : _faceSize(tree.GetFaceSize()) {
    for (int sector = 0; sector < _faceSize; ++sector) {
        add(sector, {kOne, 0}, 0, sector);
    }
    // Level by level, so that vertices of coarser ones come first.
    std::vector<Cell> cells = {{0, 0, true, 0, kOne, {}}};
    while (!cells.empty()) {
        std::vector<Cell> children;
        for (Cell const &cell : cells) {
            if (tree.IsRefined(cell.number)) {
                refine(cell, tree.GetFirstChild(cell.number), children);
            } else {
                _leaves.push_back(cell);
            }
        }
        cells = std::move(children);
    }
    for (int edge = 0; edge < _faceSize; ++edge) {
        for (Polyline::Place const place : edges[edge].GetPlaces()) {
            std::int64_t const end = kOne / Polyline::kLength * place;
            add(edge, {kOne - end, end}, -1, 0);
        }
    }
}

void CellMesh::refine(Cell const &cell, int firstChild, std::vector<Cell> &children) {
    auto const getMiddle = [](Place const &p, Place const &q) {
        return Place{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
    };
    if (cell.isWhole) {
        std::int64_t const half = cell.scale / 2;
        for (int sector = 0; sector < _faceSize; ++sector) {
            add(sector, {half, 0}, firstChild, sector);
        }
        children.push_back({firstChild, cell.level + 1, true, 0, half, {}});
        for (int sector = 0; sector < _faceSize; ++sector) {
            children.push_back({firstChild + 1 + sector,
                                cell.level + 1,
                                false,
                                sector,
                                0,
                                {{{cell.scale, 0}, {0, cell.scale}, {0, half}, {half, 0}}}});
        }
        return;
    }
    Place const middle = getMiddle(cell.corners[0], cell.corners[1]);
    std::array<Place, 4> inner;
    for (std::size_t i = 0; i < 4; ++i) {
        inner[i] = getMiddle(cell.corners[i], middle);
        add(cell.sector, inner[i], firstChild, int(i));
    }
    children.push_back({firstChild, cell.level + 1, false, cell.sector, 0, inner});
    for (std::size_t i = 1; i < 4; ++i) {
        std::size_t const next = (i + 1) % 4;
        children.push_back({firstChild + int(i),
                            cell.level + 1,
                            false,
                            cell.sector,
                            0,
                            {{cell.corners[i], cell.corners[next], inner[next], inner[i]}}});
    }
}

// Appends what lies inside of a side, from its start to its end.
void CellMesh::appendSide(int sector, Place const &start, Place const &end, bool isLong,
                          std::vector<int> &verts) const {
    if (!isLong) {
        appendSide(sector, start, end, true, verts);
        return;
    }
    Place const quarter = {(end[0] - start[0]) / 4, (end[1] - start[1]) / 4};
    Place const first = {start[0] + quarter[0], start[1] + quarter[1]};
    Place const second = {end[0] - quarter[0], end[1] - quarter[1]};
    int const firstVert = find(sector, first);
    if (firstVert < 0) {
        return;
    }
    appendSide(sector, start, first, false, verts);
    verts.push_back(firstVert);
    appendSide(sector, first, second, true, verts);
    verts.push_back(find(sector, second));
    appendSide(sector, second, end, false, verts);
}

// Appends the starts of some sides of a cell, each with what lies inside of the side.
void CellMesh::appendSides(Cell const &cell, int first, int count,
                           std::vector<int> &polygon) const {
    for (int i = first; i < first + count; ++i) {
        int const sector = cell.isWhole ? i : cell.sector;
        Place const start = cell.isWhole ? Place{cell.scale, 0} : cell.corners[std::size_t(i)];
        Place const end =
            cell.isWhole ? Place{0, cell.scale} : cell.corners[(std::size_t(i) + 1) % 4];
        polygon.push_back(find(sector, start));
        appendSide(sector, start, end, !cell.isWhole && i == 0, polygon);
    }
}

std::vector<int> CellMesh::GetEdgeVertices(int edge) const {
    std::vector<int> result = {find(edge, {kOne, 0})};
    appendSide(edge, {kOne, 0}, {0, kOne}, false, result);
    result.push_back(find(edge, {0, kOne}));
    return result;
}

std::vector<CellMesh::Polygon> CellMesh::GetPolygons(bool isMerged) const {
    std::vector<Polygon> polygons;
    // By the ends of its long edge, the half cell of which the other half has not come yet.
    std::map<std::array<int, 2>, std::size_t> halves;
    for (Cell const &cell : _leaves) {
        std::vector<int> polygon;
        if (cell.isWhole) {
            appendSides(cell, 0, _faceSize, polygon);
            polygons.push_back({std::move(polygon), cell.level});
            continue;
        }
        appendSides(cell, 0, 4, polygon);
        int const start = polygon[0];
        int const end = find(cell.sector, cell.corners[1]);
        if (isMerged && polygon[1] == end) {
            auto const other = halves.find({end, start});
            if (other != halves.end()) {
                // The other runs from end to start, where now all of this one comes between.
                std::vector<int> &hexagon = polygons[other->second].verts;
                hexagon.insert(hexagon.begin() + 1, polygon.begin() + 2, polygon.end());
                continue;
            }
            halves[{start, end}] = polygons.size();
        }
        polygons.push_back({std::move(polygon), cell.level});
    }
    return polygons;
}

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "cellMesh.h"

#include <algorithm>
#include <map>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

constexpr std::int32_t kOne = std::int32_t(1) << CellMesh::kBits;

} // namespace

std::size_t CellMesh::Hash::operator()(std::array<std::int32_t, 3> const &key) const {
    std::uint64_t hash = std::uint64_t(key[0]);
    for (std::size_t i = 1; i < 3; ++i) {
        hash = (hash ^ std::uint64_t(key[i])) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 31;
    }
    return std::size_t(hash);
}

std::array<std::int32_t, 3> CellMesh::getKey(int faceSize, int sector, Place const &place) {
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
    std::array<std::int32_t, 3> const key = getKey(_faceSize, sector, place);
    if (_numbers.emplace(key, int(_verts.size())).second) {
        _verts.push_back({int(key[0]), key[1], key[2], cell, corner});
    }
}

CellMesh::CellMesh(CellTree const &tree, Polyline const edges[])
    : _tree(tree), _faceSize(tree.GetFaceSize()), _maxLevel(tree.GetMaxLevel()) {
    auto numVerts = std::size_t(tree.GetNumCells()) + std::size_t(_faceSize);
    for (int edge = 0; edge < _faceSize; ++edge) {
        numVerts += std::size_t(edges[edge].GetNumPoints());
    }
    _verts.reserve(numVerts);
    for (int sector = 0; sector < _faceSize; ++sector) {
        add(sector, {kOne, 0}, 0, sector);
    }
    forEachCellByLevel([&](Cell const &cell) {
        if (_tree.IsRefined(cell.number)) {
            addInside(cell);
        }
    });
    for (int edge = 0; edge < _faceSize; ++edge) {
        for (Polyline::Place const place : edges[edge].GetPlaces()) {
            std::int32_t const end = kOne / Polyline::kLength * place;
            add(edge, {kOne - end, end}, -1, 0);
        }
    }
}

// Adds what the child inside of a cell has of vertices.
void CellMesh::addInside(Cell const &cell) {
    Cell const child = getChild(cell, 0);
    if (child.isWhole) {
        for (int sector = 0; sector < _faceSize; ++sector) {
            add(sector, {child.scale, 0}, child.number, sector);
        }
        return;
    }
    for (std::size_t i = 0; i < 4; ++i) {
        add(cell.sector, child.corners[i], child.number, int(i));
    }
}

CellMesh::Cell CellMesh::getChild(Cell const &parent, int child) const {
    int const number = _tree.GetFirstChild(parent.number) + child;
    int const level = parent.level + 1;
    if (parent.isWhole) {
        std::int32_t const half = parent.scale / 2;
        if (child == 0) {
            return {number, level, true, 0, half, {}};
        }
        return {number,    level, false,
                child - 1, 0,     {{{parent.scale, 0}, {0, parent.scale}, {0, half}, {half, 0}}}};
    }
    auto const getMiddle = [](Place const &p, Place const &q) {
        return Place{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
    };
    std::array<Place, 4> const &corners = parent.corners;
    Place const middle = getMiddle(corners[0], corners[1]);
    auto const getInner = [&](std::size_t i) { return getMiddle(corners[i], middle); };
    if (child == 0) {
        return {number,        level, false,
                parent.sector, 0,     {{getInner(0), getInner(1), getInner(2), getInner(3)}}};
    }
    auto const i = std::size_t(child);
    std::size_t const next = (i + 1) % 4;
    return {number,        level, false,
            parent.sector, 0,     {{corners[i], corners[next], getInner(next), getInner(i)}}};
}

// Calls function(cell) for all cells in a cell that have a level.
template <typename FUNCTION>
void CellMesh::visit(Cell const &cell, int level, FUNCTION const &function) const {
    if (cell.level == level) {
        function(cell);
        return;
    }
    if (_tree.IsRefined(cell.number)) {
        int const numChildren = _tree.GetNumChildren(cell.number);
        for (int child = 0; child < numChildren; ++child) {
            visit(getChild(cell, child), level, function);
        }
    }
}

// Level by level, so that vertices of coarser ones come first; they are found anew for each level, since
// to keep them would take more memory than the vertices do.
template <typename FUNCTION>
void CellMesh::forEachCellByLevel(FUNCTION const &function) const {
    for (int level = 0; level <= _maxLevel; ++level) {
        visit({0, 0, true, 0, kOne, {}}, level, function);
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

void CellMesh::setPolygon(Cell const &cell, Polygon &polygon) const {
    polygon.verts.clear();
    polygon.level = cell.level;
    appendSides(cell, 0, cell.isWhole ? _faceSize : 4, polygon.verts);
}

void CellMesh::ForEachCell(std::function<void(Polygon &)> const &function) const {
    Polygon polygon;
    forEachCellByLevel([&](Cell const &cell) {
        if (!_tree.IsRefined(cell.number)) {
            setPolygon(cell, polygon);
            function(polygon);
        }
    });
}

std::vector<CellMesh::Polygon> CellMesh::GetMergedPolygons() const {
    std::vector<Polygon> polygons;
    // By the ends of its long edge, the half cell of which the other half has not come yet.
    std::map<std::array<int, 2>, std::size_t> halves;
    Polygon polygon;
    forEachCellByLevel([&](Cell const &cell) {
        if (_tree.IsRefined(cell.number)) {
            return;
        }
        setPolygon(cell, polygon);
        if (!cell.isWhole) {
            int const start = polygon.verts[0];
            int const end = find(cell.sector, cell.corners[1]);
            if (polygon.verts[1] == end) {
                auto const other = halves.find({end, start});
                if (other != halves.end()) {
                    // The other runs from end to start, where now all of this one comes between.
                    std::vector<int> &hexagon = polygons[other->second].verts;
                    hexagon.insert(hexagon.begin() + 1, polygon.verts.begin() + 2,
                                   polygon.verts.end());
                    halves.erase(other);
                    return;
                }
                halves[{start, end}] = polygons.size();
            }
        }
        polygons.push_back(polygon);
    });
    return polygons;
}

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "cellMesh.h"

#include <algorithm>
#include <map>

namespace OpenSubdivHex::BfrExt::internal {

// Coordinates of names are not below zero.
std::uint64_t CellMesh::getKey(Vertex const &name) {
    static_assert(CellShape::kBits < 20);
    return std::uint64_t(name.sector) << 40 | std::uint64_t(name.coords[0]) << 20 |
           std::uint64_t(name.coords[1]);
}

int CellMesh::Find(int sector, Place const &place) const {
    auto const found = _numbers.find(getKey(NameOf(_shape, Vertex{sector, place})));
    return found == _numbers.end() ? -1 : found->second;
}

void CellMesh::add(Vertex const &place) {
    Vertex const name = NameOf(_shape, place);
    if (_numbers.emplace(getKey(name), int(_verts.size())).second) {
        _verts.push_back(name);
    }
}

CellMesh::CellMesh(CellTree const &tree, Polyline const edges[], CellShape const &section)
    : _tree(tree), _shape(tree.GetFaceShape()), _maxLevel(tree.GetMaxLevel()), _section(section) {
    auto numVerts = std::size_t(tree.GetNumCells()) + std::size_t(_shape.size);
    for (int edge = 0; edge < _shape.size; ++edge) {
        numVerts += std::size_t(edges[edge].GetNumPoints());
    }
    _verts.reserve(numVerts);
    for (int corner = 0; corner < _shape.size; ++corner) {
        add(PlaceOnEdge<Place>(_shape, corner, CellShape::kOne, 0));
    }
    forEachCellByLevel(CellShape::MakeFace(), [&](CellShape const &cell) {
        if (_tree.IsRefined(cell.number)) {
            CellShape const child = cell.GetChild(_tree, 0);
            for (int corner = 0; corner < child.GetNumCorners(_shape); ++corner) {
                add(child.GetCorner(_shape, corner));
            }
        }
    });
    for (int edge = 0; edge < _shape.size; ++edge) {
        for (Polyline::Place const place : edges[edge].GetPlaces()) {
            std::int32_t const end = CellShape::kOne / Polyline::kLength * place;
            add(PlaceOnEdge<Place>(_shape, edge, CellShape::kOne - end, end));
        }
    }
}

// Calls function(cell) for all cells in a cell that have a level.
template <typename FUNCTION>
void CellMesh::visit(CellShape const &cell, int level, FUNCTION const &function) const {
    if (cell.level == level) {
        function(cell);
        return;
    }
    if (_tree.IsRefined(cell.number)) {
        int const numChildren = _tree.GetNumChildren(cell.number);
        for (int child = 0; child < numChildren; ++child) {
            visit(cell.GetChild(_tree, child), level, function);
        }
    }
}

// Level by level, so that vertices of coarser ones come first; they are found anew for each level, since
// to keep them would take more memory than the vertices do.
template <typename FUNCTION>
void CellMesh::forEachCellByLevel(CellShape const &root, FUNCTION const &function) const {
    for (int level = root.level; level <= _maxLevel; ++level) {
        visit(root, level, function);
    }
}

void CellMesh::AppendBetween(int sector, Place const &start, Place const &end,
                             std::vector<int> &verts) const {
    Place const quarter = {(end[0] - start[0]) / 4, (end[1] - start[1]) / 4};
    Place const first = {start[0] + quarter[0], start[1] + quarter[1]};
    Place const second = {end[0] - quarter[0], end[1] - quarter[1]};
    int const firstVert = Find(sector, first);
    if (firstVert < 0) {
        return;
    }
    AppendBetween(sector, start, first, verts);
    verts.push_back(firstVert);
    AppendBetween(sector, first, second, verts);
    verts.push_back(Find(sector, second));
    AppendBetween(sector, second, end, verts);
}

std::vector<int> CellMesh::GetPolygon(CellShape const &cell) const {
    Polygon polygon;
    setPolygon(cell, polygon);
    return polygon.verts;
}

void CellMesh::setPolygon(CellShape const &cell, Polygon &polygon) const {
    polygon.verts.clear();
    polygon.level = cell.level;
    for (int i = 0; i < cell.GetNumCorners(_shape); ++i) {
        auto const [sector, start] = cell.GetCorner(_shape, i);
        Place const end = cell.isWhole ? PlaceOnEdge<Place>(_shape, i, 0, cell.scale).coords
                                       : cell.corners[(std::size_t(i) + 1) % 4];
        polygon.verts.push_back(Find(sector, start));
        AppendBetween(sector, start, end, polygon.verts);
    }
}

void CellMesh::ForEachCell(std::function<void(Polygon &)> const &function) const {
    Polygon polygon;
    forEachCellByLevel(_section, [&](CellShape const &cell) {
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
    forEachCellByLevel(_section, [&](CellShape const &cell) {
        if (_tree.IsRefined(cell.number)) {
            return;
        }
        setPolygon(cell, polygon);
        if (!cell.isWhole) {
            int const start = polygon.verts[0];
            int const end = Find(cell.sector, cell.corners[1]);
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

// SPDX-License-Identifier: Apache-2.0
#include "faceSections.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

using FarExt::internal::BasePolygon;

// The corners of a cell in the plane of its face.
std::vector<Pair> findOutline(BasePolygon const &polygon, CellShape const &cell) {
    std::vector<Pair> corners(std::size_t(cell.GetNumCorners(polygon.GetShape())));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        auto const [sector, place] = cell.GetCorner(polygon.GetShape(), int(i));
        polygon.Write(sector,
                      {std::ldexp(double(place[0]), -CellShape::kBits),
                       std::ldexp(double(place[1]), -CellShape::kBits)},
                      corners[i].data());
    }
    return corners;
}

// Whether a side of a convex polygon has all of another polygon on its outer side.
bool hasSideBetween(std::vector<Pair> const &polygon, std::vector<Pair> const &other) {
    constexpr double kTolerance = 1e-12; // of areas, which are 1e-8 at least
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        Pair const &start = polygon[i];
        Pair const &end = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        if (std::all_of(other.begin(), other.end(), [&](Pair const &p) {
                return (end[0] - start[0]) * (p[1] - start[1]) -
                           (end[1] - start[1]) * (p[0] - start[0]) <
                       -kTolerance;
            })) {
            return true;
        }
    }
    return false;
}

} // namespace

PlaceLevels::PlaceLevels(FaceLevels const &levels)
    : ofEdges(levels.levels.begin(), levels.levels.end() - 1), ofInside(levels.levels.back()),
      ofAll(*std::max_element(levels.levels.begin(), levels.levels.end())) {
    for (int edge = 0; edge < levels.shape.GetFirstSector(); ++edge) {
        ++ofEdges[std::size_t(edge)]; // divided once more
    }
}

PlaceLevels::PlaceLevels(CellTree const &tree, std::vector<Polyline> const &edges)
    : ofInside(tree.GetMaxLevel()), ofAll(ofInside) {
    constexpr int kLastOfLongEdge = Polyline::kLastLevel + 1;
    for (Polyline const &edge : edges) {
        // Levels 0 and 1 give an edge the same.
        int level = 0;
        while (level <= kLastOfLongEdge && Polyline(level).GetNumPoints() < edge.GetNumPoints()) {
            ++level;
        }
        ofEdges.push_back(level <= kLastOfLongEdge && Polyline(level) == edge ? level : -1);
        // Places of a level are multiples of that of its first one.
        for (int const place : edge.GetPlaces()) {
            while (place % (Polyline::kLength >> ofAll) != 0) {
                ++ofAll;
            }
        }
    }
}

FaceSections::FaceSections(FaceLevels const &faceLevels, int maxLeaves)
    : _levels(faceLevels.levels), _tree(nullptr), _placeLevels(faceLevels),
      _edges(_placeLevels.ofEdges.begin(), _placeLevels.ofEdges.end()), _cells(faceLevels.shape) {
    cut(maxLeaves, [&](int cell, int) {
        int const numSteps = _levels.back() - _cells.GetLevel(cell);
        return _cells.IsWhole(cell) ? CountLeaves(GetFaceShape(), numSteps)
                                    : std::ldexp(1.0, 2 * numSteps);
    });
}

FaceSections::FaceSections(CellTree const &tree, std::vector<Polyline> edges, int maxLeaves)
    : _tree(&tree), _placeLevels(tree, edges), _edges(std::move(edges)),
      _cells(tree.GetFaceShape()) {
    // No further than it has to be known.
    auto const count = [&](auto const &self, int cell, int most) -> int {
        int const first = tree.GetFirstChild(cell);
        if (first == 0) {
            return 1;
        }
        int result = 0;
        for (int i = 0; i < tree.GetNumChildren(cell) && result <= most; ++i) {
            result += self(self, first + i, most - result);
        }
        return result;
    };
    cut(maxLeaves, [&](int, int wholeCell) { return double(count(count, wholeCell, maxLeaves)); });
}

// Refines the coarse tree where count(cell, cell of the whole tree) is too much.
template <typename COUNT>
void FaceSections::cut(int maxLeaves, COUNT const &count) {
    struct Cell {
        CellShape shape;
        int wholeCell;
    };
    std::vector<Cell> cells = {{CellShape::MakeFace(), 0}};
    _parents = {-1};
    while (!cells.empty()) {
        std::vector<Cell> children;
        for (Cell const &cell : cells) {
            int const number = cell.shape.number;
            if (!isRefined(_cells, number, cell.wholeCell) ||
                count(number, cell.wholeCell) <= double(maxLeaves)) {
                _sections.push_back(cell.shape);
                continue;
            }
            _cells.Refine(number);
            for (int i = 0; i < _cells.GetNumChildren(number); ++i) {
                children.push_back(
                    {cell.shape.GetChild(_cells, i), getWholeChild(cell.wholeCell, i)});
                _parents.push_back(number);
            }
        }
        cells = std::move(children);
    }
    std::vector<Polyline> edges(static_cast<std::size_t>(GetFaceShape().size));
    for (std::size_t edge = 0; edge < edges.size(); ++edge) {
        edges[edge] = _cells.GetEdgePolyline(int(edge));
    }
    _mesh = std::make_unique<CellMesh const>(_cells, edges.data());
}

bool FaceSections::isRefined(CellTree const &tree, int cell, int wholeCell) const {
    return _tree ? _tree->IsRefined(wholeCell)
                 : tree.isToRefine(cell, _levels.data(), _levels.back());
}

int FaceSections::getWholeChild(int wholeCell, int child) const {
    return _tree ? _tree->GetFirstChild(wholeCell) + child : 0;
}

CellTree FaceSections::MakeTree(int section, CellShape *shape) const {
    // The cells that have it, from the face on: which child of the one before each is.
    std::vector<int> path;
    CellShape const &own = _sections[std::size_t(section)];
    for (int cell = own.number; cell > 0; cell = _parents[std::size_t(cell)]) {
        path.push_back(cell - _cells.GetFirstChild(_parents[std::size_t(cell)]));
    }
    std::reverse(path.begin(), path.end());
    CellTree tree(GetFaceShape());
    BasePolygon const polygon(GetFaceShape());
    std::vector<Pair> const outline = findOutline(polygon, own);
    auto const touchesSection = [&](CellShape const &cell) {
        std::vector<Pair> const ofCell = findOutline(polygon, cell);
        return !hasSideBetween(outline, ofCell) && !hasSideBetween(ofCell, outline);
    };
    auto const visit = [&](auto const &self, CellShape const &cell, int wholeCell, bool hasSection,
                           bool isInside) -> void {
        bool const isSection = hasSection && std::size_t(cell.level) == path.size();
        if (isSection) {
            *shape = cell;
        }
        bool const isOther = !hasSection && !isInside;
        if (!isRefined(tree, cell.number, wholeCell) || (isOther && !touchesSection(cell))) {
            return;
        }
        tree.Refine(cell.number);
        for (int i = 0; i < tree.GetNumChildren(cell.number); ++i) {
            bool const isOnPath = hasSection && !isSection && path[std::size_t(cell.level)] == i;
            self(self, cell.GetChild(tree, i), getWholeChild(wholeCell, i), isOnPath,
                 isInside || isSection);
        }
    };
    visit(visit, CellShape::MakeFace(), 0, true, false);
    return tree;
}

bool FaceSections::AreOnEdge(CellMesh::Vertex const &start, CellMesh::Vertex const &end) const {
    EdgePlace<int> const from = FindEdge(start);
    EdgePlace<int> const to = FindEdge(end);
    return from.edge >= 0 && to.edge >= 0 &&
           (to.edge == from.edge ||
            (to.edge == (from.edge + 1) % GetFaceShape().size && to.end == 0));
}

int FaceSections::CountPointsBefore(EdgePlace<int> const &place) const {
    std::vector<Polyline::Place> const &places = GetEdge(place.edge).GetPlaces();
    return int(std::lower_bound(places.begin(), places.end(), Polyline::Place(place.end)) -
               places.begin());
}

} // namespace OpenSubdivHex::BfrExt::internal

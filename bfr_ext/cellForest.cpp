// SPDX-License-Identifier: Apache-2.0
#include "cellForest.h"

#include "far_ext/vtr/level.h"
#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>

namespace OpenSubdivHex::BfrExt {

using FarExt::internal::Level;

CellForest::CellForest(FarExt::TopologyRefiner const &refiner)
    : _faces(refiner.GetLevel(refiner.GetHexSchemeOptions().GetSurfaceLevel()).GetLevel()) {
    _trees.reserve(std::size_t(_faces.GetNumFaces()));
    _isMatched.resize(std::size_t(_faces.GetNumFaces()));
    for (Index face = 0; face < _faces.GetNumFaces(); ++face) {
        _trees.emplace_back(_faces.GetShape(face));
    }
    _edges.resize(std::size_t(_faces.GetNumEdges()));
    _polylines = _edges;
    _firstPoints.assign(_polylines.size() + 1, _faces.GetLevel().numVertices);
}

void CellForest::MatchEdges() {
    auto const hasTree = [&](Index face) {
        return GetTree(face).GetFaceShape() == _faces.GetShape(face);
    };
    FarExt::internal::ParallelFor(
        GetNumFaces(), [&](Index face) { _isMatched[std::size_t(face)] = hasTree(face); });
    // The second face of an edge runs it backwards.
    FarExt::internal::ParallelFor(Index(_edges.size()), [&](Index edge) {
        Polyline &polyline = _polylines[std::size_t(edge)];
        polyline = _edges[std::size_t(edge)];
        for (int side = 0; side < 2; ++side) {
            auto const [face, local] = _faces.GetSide(edge, side);
            if (face != Far::INDEX_INVALID && hasTree(face)) {
                Polyline const own = GetTree(face).GetEdgePolyline(local);
                polyline.Merge(side == 0 ? own : own.GetReversed());
            }
        }
    });
    // The edges of a line run along one curve, from either end.
    struct Line {
        Index start;
        Polyline polyline;
    };
    Level const &level = _faces.GetLevel();
    std::map<Index, Line> lines;
    auto const forEachLineEdge = [&](auto const &function) {
        for (FarExt::internal::LineEdge const &lineEdge : level.lineEdges) {
            Index const start = level.edgeVerts[lineEdge.edge][0];
            Line &line = lines.emplace(lineEdge.line, Line{start, {}}).first->second;
            function(_polylines[std::size_t(lineEdge.edge)], line.polyline, line.start != start);
        }
    };
    forEachLineEdge([](Polyline const &edge, Polyline &line, bool isReversed) {
        line.Merge(isReversed ? edge.GetReversed() : edge);
    });
    forEachLineEdge([](Polyline &edge, Polyline const &line, bool isReversed) {
        edge = isReversed ? line.GetReversed() : line;
    });
    for (std::size_t edge = 0; edge < _polylines.size(); ++edge) {
        _firstPoints[edge + 1] = _firstPoints[edge] + _polylines[edge].GetNumPoints();
    }
}

bool CellForest::IsMatched(Index face) const {
    if (_isMatched[std::size_t(face)]) {
        return true;
    }
    CellTree const &tree = GetTree(face);
    if (tree.GetFaceShape() != _faces.GetShape(face)) {
        return false;
    }
    for (int local = 0; local < tree.GetFaceSize(); ++local) {
        Polyline const own = tree.GetEdgePolyline(local);
        auto const [edge, isReversed] = _faces.GetEdge(face, local);
        if (!GetPolyline(edge).Contains(isReversed ? own.GetReversed() : own)) {
            return false;
        }
    }
    return true;
}

std::vector<Polyline> CellForest::GetFacePolylines(Index face) const {
    std::vector<Polyline> edges;
    for (int local = 0; local < _faces.GetShape(face).size; ++local) {
        auto const [edge, isReversed] = _faces.GetEdge(face, local);
        Polyline const &polyline = GetPolyline(edge);
        edges.push_back(isReversed ? polyline.GetReversed() : polyline);
    }
    return edges;
}

LevelTessellation CellForest::GetTessellation(Index face,
                                              LevelTessellation::Options options) const {
    if (GetTree(face).GetFaceShape() != _faces.GetShape(face)) {
        return LevelTessellation(Parameterization(), 0);
    }
    return LevelTessellation(GetTree(face), GetFacePolylines(face).data(), options);
}

// Writes what tells the tessellation of a face.
void CellForest::getKey(Index face, std::vector<int> &key) const {
    CellTree const &tree = GetTree(face);
    key = {tree.GetFaceSize(), tree.GetFaceShape().isHalf ? 1 : 0};
    for (int cell = 0; cell < tree.GetNumCells(); ++cell) {
        key.push_back(tree.GetFirstChild(cell));
    }
    for (int local = 0; local < tree.GetFaceSize(); ++local) {
        auto const [edge, isReversed] = _faces.GetEdge(face, local);
        std::vector<Polyline::Place> const &places = GetPolyline(edge).GetPlaces();
        key.push_back(-1 - int(places.size()));
        if (isReversed) {
            std::transform(places.rbegin(), places.rend(), std::back_inserter(key),
                           [](Polyline::Place place) { return Polyline::kLength - place; });
        } else {
            key.insert(key.end(), places.begin(), places.end());
        }
    }
}

int CellForest::GetBoundaryPoints(Index face, int points[]) const {
    if (GetNumBoundaryPoints() > std::numeric_limits<int>::max()) {
        return 0;
    }
    int numPoints = 0;
    for (int local = 0; local < _faces.GetShape(face).size; ++local) {
        auto const [edge, isReversed] = _faces.GetEdge(face, local);
        points[numPoints++] = _faces.GetVertex(face, local);
        int const numInner = GetPolyline(edge).GetNumPoints();
        for (int i = 0; i < numInner; ++i) {
            points[numPoints++] =
                int(GetFirstEdgePoint(edge)) + (isReversed ? numInner - 1 - i : i);
        }
    }
    return numPoints;
}

} // namespace OpenSubdivHex::BfrExt

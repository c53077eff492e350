// SPDX-License-Identifier: Apache-2.0
#include "cellForest.h"

#include "far_ext/vtr/baseCoords.h"
#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>

namespace OpenSubdivHex::BfrExt {

using FarExt::internal::Level;

CellForest::CellForest(FarExt::TopologyRefiner const &refiner)
    : _level(refiner.GetLevel(refiner.GetHexSchemeOptions().GetSurfaceLevel())) {
    _trees.reserve(std::size_t(_level.GetNumFaces()));
    _isMatched.resize(std::size_t(_level.GetNumFaces()));
    for (Index face = 0; face < _level.GetNumFaces(); ++face) {
        _trees.emplace_back(FarExt::internal::GetFaceShape(_level.GetLevel(), face));
    }
    _edges.resize(std::size_t(_level.GetNumEdges()));
    _polylines = _edges;
    _firstPoints.assign(_polylines.size() + 1, _level.GetNumVertices());
}

// Whether the edge runs against the face.
bool CellForest::isReversed(Index face, int local) const {
    Level const &level = _level.GetLevel();
    Index const edge = level.faceEdges[level.faceFirstCorner[face] + local];
    return level.edgeFaces[edge][0] != face || level.edgeFaceLocals[edge][0] != local;
}

void CellForest::MatchEdges() {
    Level const &level = _level.GetLevel();
    auto const hasTree = [&](Index face) {
        return GetTree(face).GetFaceShape() == FarExt::internal::GetFaceShape(level, face);
    };
    FarExt::internal::ParallelFor(
        GetNumFaces(), [&](Index face) { _isMatched[std::size_t(face)] = hasTree(face); });
    // The second face of an edge runs it backwards.
    FarExt::internal::ParallelFor(Index(_edges.size()), [&](Index edge) {
        Polyline &polyline = _polylines[std::size_t(edge)];
        polyline = _edges[std::size_t(edge)];
        for (int side = 0; side < 2; ++side) {
            Index const face = level.edgeFaces[edge][side];
            if (face >= 0 && hasTree(face)) {
                Polyline const own =
                    GetTree(face).GetEdgePolyline(level.edgeFaceLocals[edge][side]);
                polyline.Merge(side == 0 ? own : own.GetReversed());
            }
        }
    });
    // The edges of a line run along one curve, from either end.
    struct Line {
        Index start;
        Polyline polyline;
    };
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
    Level const &level = _level.GetLevel();
    CellTree const &tree = GetTree(face);
    if (tree.GetFaceShape() != FarExt::internal::GetFaceShape(level, face)) {
        return false;
    }
    for (int local = 0; local < tree.GetFaceSize(); ++local) {
        Polyline const own = tree.GetEdgePolyline(local);
        Polyline const &polyline =
            GetPolyline(level.faceEdges[level.faceFirstCorner[face] + local]);
        if (!polyline.Contains(isReversed(face, local) ? own.GetReversed() : own)) {
            return false;
        }
    }
    return true;
}

std::vector<Polyline> CellForest::GetFacePolylines(Index face) const {
    Level const &level = _level.GetLevel();
    std::vector<Polyline> edges;
    for (int local = 0; local < level.GetFaceSize(face); ++local) {
        Polyline const &polyline =
            GetPolyline(level.faceEdges[level.faceFirstCorner[face] + local]);
        edges.push_back(isReversed(face, local) ? polyline.GetReversed() : polyline);
    }
    return edges;
}

LevelTessellation CellForest::GetTessellation(Index face,
                                              LevelTessellation::Options options) const {
    if (GetTree(face).GetFaceShape() != FarExt::internal::GetFaceShape(_level.GetLevel(), face)) {
        return LevelTessellation(Parameterization(), 0);
    }
    return LevelTessellation(GetTree(face), GetFacePolylines(face).data(), options);
}

// Writes what tells the tessellation of a face.
void CellForest::getKey(Index face, std::vector<int> &key) const {
    Level const &level = _level.GetLevel();
    CellTree const &tree = GetTree(face);
    key = {tree.GetFaceSize(), tree.GetFaceShape().isHalf ? 1 : 0};
    for (int cell = 0; cell < tree.GetNumCells(); ++cell) {
        key.push_back(tree.GetFirstChild(cell));
    }
    for (int local = 0; local < tree.GetFaceSize(); ++local) {
        std::vector<Polyline::Place> const &places =
            GetPolyline(level.faceEdges[level.faceFirstCorner[face] + local]).GetPlaces();
        key.push_back(-1 - int(places.size()));
        if (isReversed(face, local)) {
            std::transform(places.rbegin(), places.rend(), std::back_inserter(key),
                           [](Polyline::Place place) { return Polyline::kLength - place; });
        } else {
            key.insert(key.end(), places.begin(), places.end());
        }
    }
}

int CellForest::GetBoundaryPoints(Index face, int points[]) const {
    Level const &level = _level.GetLevel();
    if (GetNumBoundaryPoints() > std::numeric_limits<int>::max()) {
        return 0;
    }
    int numPoints = 0;
    for (int local = 0; local < level.GetFaceSize(face); ++local) {
        Index const corner = level.faceFirstCorner[face] + local;
        Index const edge = level.faceEdges[corner];
        points[numPoints++] = level.faceVerts[corner];
        int const numInner = GetPolyline(edge).GetNumPoints();
        bool const isBackwards = isReversed(face, local);
        for (int i = 0; i < numInner; ++i) {
            points[numPoints++] =
                int(GetFirstEdgePoint(edge)) + (isBackwards ? numInner - 1 - i : i);
        }
    }
    return numPoints;
}

} // namespace OpenSubdivHex::BfrExt

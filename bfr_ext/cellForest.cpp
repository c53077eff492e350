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

struct CellForest::Data {
    // No face is refined.
    explicit Data(FarExt::SurfaceFaces const &ofMesh)
        : faces(ofMesh), isMatched(std::size_t(ofMesh.GetNumFaces()), 1),
          edges(std::size_t(ofMesh.GetNumEdges())), polylines(edges),
          firstPoints(edges.size() + 1, ofMesh.GetLevel().numVertices) {
        trees.reserve(isMatched.size());
        for (Index face = 0; face < faces.GetNumFaces(); ++face) {
            trees.emplace_back(faces.GetShape(face));
        }
    }

    FarExt::SurfaceFaces faces;
    std::vector<CellTree> trees;
    std::vector<char> isMatched;     // by face
    std::vector<Polyline> edges;     // what was set
    std::vector<Polyline> polylines; // the same with the points of faces
    std::vector<Number> firstPoints; // by edge; then their end
};

CellForest::CellForest(FarExt::TopologyRefiner const &refiner)
    : _data(std::make_unique<Data>(FarExt::SurfaceFaces(
          refiner.GetLevel(refiner.GetHexSchemeOptions().GetSurfaceLevel()).GetLevel()))) {}

CellForest::CellForest(CellForest const &other) : _data(std::make_unique<Data>(*other._data)) {}

CellForest &CellForest::operator=(CellForest const &other) {
    _data = std::make_unique<Data>(*other._data);
    return *this;
}

CellForest::CellForest(CellForest &&other) noexcept = default;
CellForest &CellForest::operator=(CellForest &&other) noexcept = default;
CellForest::~CellForest() = default;

FarExt::SurfaceFaces const &CellForest::GetFaces() const { return _data->faces; }

void CellForest::SetTree(Index face, CellTree tree) {
    _data->trees[std::size_t(face)] = std::move(tree);
    _data->isMatched[std::size_t(face)] = false;
}

CellTree const &CellForest::GetTree(Index face) const { return _data->trees[std::size_t(face)]; }

void CellForest::SetEdge(Index edge, Polyline polyline) {
    _data->edges[std::size_t(edge)] = std::move(polyline);
}

Polyline const &CellForest::GetEdge(Index edge) const { return _data->edges[std::size_t(edge)]; }

Polyline const &CellForest::GetPolyline(Index edge) const {
    return _data->polylines[std::size_t(edge)];
}

CellForest::Number CellForest::GetNumBoundaryPoints() const { return _data->firstPoints.back(); }

CellForest::Number CellForest::GetFirstEdgePoint(Index edge) const {
    return _data->firstPoints[std::size_t(edge)];
}

void CellForest::MatchEdges() {
    Data &data = *_data;
    FarExt::internal::ParallelFor(GetNumFaces(), [&](Index face) {
        data.isMatched[std::size_t(face)] =
            data.trees[std::size_t(face)].GetFaceShape() == data.faces.GetShape(face);
    });
    // The second face of an edge runs it backwards.
    FarExt::internal::ParallelFor(Index(data.edges.size()), [&](Index edge) {
        Polyline &polyline = data.polylines[std::size_t(edge)];
        polyline = data.edges[std::size_t(edge)];
        for (int side = 0; side < 2; ++side) {
            auto const [face, local] = data.faces.GetSide(edge, side);
            if (face == Far::INDEX_INVALID || !data.isMatched[std::size_t(face)]) {
                continue;
            }
            Polyline own = data.trees[std::size_t(face)].GetEdgePolyline(local);
            if (side == 1 && own.GetNumPoints() > 0) {
                own = own.GetReversed();
            }
            if (polyline.GetNumPoints() == 0) {
                polyline = std::move(own);
            } else {
                polyline.Merge(own);
            }
        }
    });
    // The edges of a line run along one curve, from either end.
    struct Line {
        Index start;
        Polyline polyline;
    };
    Level const &level = data.faces.GetLevel();
    std::map<Index, Line> lines;
    auto const forEachLineEdge = [&](auto const &function) {
        for (FarExt::internal::LineEdge const &lineEdge : level.lineEdges) {
            Index const start = level.edgeVerts[lineEdge.edge][0];
            Line &line = lines.emplace(lineEdge.line, Line{start, {}}).first->second;
            function(data.polylines[std::size_t(lineEdge.edge)], line.polyline,
                     line.start != start);
        }
    };
    forEachLineEdge([](Polyline const &edge, Polyline &line, bool isReversed) {
        line.Merge(isReversed ? edge.GetReversed() : edge);
    });
    forEachLineEdge([](Polyline &edge, Polyline const &line, bool isReversed) {
        edge = isReversed ? line.GetReversed() : line;
    });
    for (std::size_t edge = 0; edge < data.polylines.size(); ++edge) {
        data.firstPoints[edge + 1] = data.firstPoints[edge] + data.polylines[edge].GetNumPoints();
    }
}

bool CellForest::IsMatched(Index face) const { return _data->isMatched[std::size_t(face)] != 0; }

std::vector<Polyline> CellForest::GetFacePolylines(Index face) const {
    std::vector<Polyline> edges;
    for (int local = 0; local < _data->faces.GetShape(face).size; ++local) {
        auto const [edge, isReversed] = _data->faces.GetEdge(face, local);
        Polyline const &polyline = GetPolyline(edge);
        edges.push_back(isReversed ? polyline.GetReversed() : polyline);
    }
    return edges;
}

LevelTessellation CellForest::GetTessellation(Index face,
                                              LevelTessellation::Options options) const {
    if (GetTree(face).GetFaceShape() != _data->faces.GetShape(face)) {
        return LevelTessellation(Parameterization(), 0);
    }
    return LevelTessellation(GetTree(face), GetFacePolylines(face).data(), options);
}

std::vector<CellForest::Index> CellForest::FindChangedFaces(CellForest const &previous) const {
    bool const isAlike = previous.GetNumFaces() == GetNumFaces() &&
                         previous._data->polylines.size() == _data->polylines.size();
    std::vector<char> isChanged(std::size_t(GetNumFaces()), 1);
    struct Keys {
        std::vector<int> own;
        std::vector<int> previous;
    };
    FarExt::internal::ParallelForRange(
        isAlike ? GetNumFaces() : 0, [] { return Keys(); },
        [&](Keys &keys, Index begin, Index end) {
            for (Index face = begin; face < end; ++face) {
                GetTessellationKey(face, keys.own);
                previous.GetTessellationKey(face, keys.previous);
                isChanged[std::size_t(face)] = keys.own != keys.previous ? 1 : 0;
            }
        },
        FarExt::internal::kShortParallelRange);
    std::vector<Index> faces;
    for (Index face = 0; face < GetNumFaces(); ++face) {
        if (isChanged[std::size_t(face)]) {
            faces.push_back(face);
        }
    }
    return faces;
}

void CellForest::GetTessellationKey(Index face, std::vector<int> &key) const {
    CellTree const &tree = GetTree(face);
    key = {tree.GetFaceSize(), tree.GetFaceShape().isHalf ? 1 : 0};
    for (int cell = 0; cell < tree.GetNumCells(); ++cell) {
        key.push_back(tree.GetFirstChild(cell));
    }
    for (int local = 0; local < tree.GetFaceSize(); ++local) {
        auto const [edge, isReversed] = _data->faces.GetEdge(face, local);
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
    for (int local = 0; local < _data->faces.GetShape(face).size; ++local) {
        auto const [edge, isReversed] = _data->faces.GetEdge(face, local);
        points[numPoints++] = _data->faces.GetVertex(face, local);
        int const numInner = GetPolyline(edge).GetNumPoints();
        for (int i = 0; i < numInner; ++i) {
            points[numPoints++] =
                int(GetFirstEdgePoint(edge)) + (isReversed ? numInner - 1 - i : i);
        }
    }
    return numPoints;
}

} // namespace OpenSubdivHex::BfrExt

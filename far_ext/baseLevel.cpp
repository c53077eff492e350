// SPDX-License-Identifier: Apache-2.0
#include "baseLevel.h"

#include "parallel.h"

#include <algorithm>
#include <set>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;
using EdgeSidesArray = OpenSubdiv::Vtr::ConstArray<EdgeSides>;

class BaseLevelBuilder {
public:
    BaseLevelBuilder(EdgeSidesArray edges, LevelTopology &level) : _edges(edges), _level(level) {}

    void Build() {
        buildFacesOfCorners();
        buildEdges();
        buildVertices();
    }

private:
    void buildFacesOfCorners();
    void buildEdges();
    void buildVertices();
    void fillVertex(Index vert, Index const *corners, Index numCorners);

    LocalIndex local(Index corner) const {
        return LocalIndex(corner - _level.faceFirstCorner[_faceOfCorner[corner]]);
    }
    // The corner at which the other side of a corner's edge starts; negative at a boundary.
    Index otherSide(Index corner) const {
        EdgeSides const &edge = _edges[_level.faceEdges[corner]];
        return edge.corners[0] == corner ? edge.corners[1] : edge.corners[0];
    }
    // The corners of the same vertex in the next face around it, counter-clockwise and clockwise;
    // negative across a boundary.
    Index nextAround(Index corner) const {
        return otherSide(_level.GetPrevCorner(_faceOfCorner[corner], corner));
    }
    Index prevAround(Index corner) const {
        Index const other = otherSide(corner);
        if (other < 0) {
            return other;
        }
        return _level.GetNextCorner(_faceOfCorner[other], other);
    }

    EdgeSidesArray _edges;
    LevelTopology &_level;
    Buffer<Index> _faceOfCorner;
};

void BaseLevelBuilder::buildFacesOfCorners() {
    _faceOfCorner.Resize(_level.numCorners);
    ParallelFor(_level.numFaces, [this](Index face) {
        std::fill(_faceOfCorner.data() + _level.faceFirstCorner[face],
                  _faceOfCorner.data() + _level.faceFirstCorner[face + 1], face);
    });
}

void BaseLevelBuilder::buildEdges() {
    _level.numEdges = _edges.size();
    _level.faceEdges.Resize(_level.numCorners);
    _level.edgeVerts.Resize(2 * std::size_t(_edges.size()));
    _level.edgeFaces.Resize(2 * std::size_t(_edges.size()));
    _level.edgeFaceLocals.Resize(2 * std::size_t(_edges.size()));
    ParallelFor(_level.numEdges, [this](Index edge) {
        std::size_t const k = 2 * std::size_t(edge);
        Index const corner = _edges[edge].corners[0];
        Index const other = _edges[edge].corners[1];
        Index const face = _faceOfCorner[corner];
        Index const next = _level.GetNextCorner(face, corner);
        _level.edgeVerts[k] = _level.faceVerts[corner];
        _level.edgeVerts[k + 1] = _level.faceVerts[next];
        _level.edgeFaces[k] = face;
        _level.edgeFaceLocals[k] = local(corner);
        _level.faceEdges[corner] = edge;
        if (other < 0) {
            _level.edgeFaces[k + 1] = other;
            _level.edgeFaceLocals[k + 1] = 0;
        } else {
            _level.edgeFaces[k + 1] = _faceOfCorner[other];
            _level.edgeFaceLocals[k + 1] = local(other);
            _level.faceEdges[other] = edge;
        }
    });
    std::vector<Index> const boundaryEdges =
        ParallelSelect(_level.numEdges, [this](Index edge) { return _level.IsBoundary(edge); });
    auto const count = [&](BoundaryKind kind) {
        return Index(std::count_if(boundaryEdges.begin(), boundaryEdges.end(),
                                   [&](Index edge) { return _edges[edge].corners[1] == kind; }));
    };
    _level.numFreeBoundaries = count(kFreeBoundary);
    _level.numSharpBoundariesA = count(kSharpBoundaryA);
    _level.numSharpBoundariesB = count(kSharpBoundaryB);
    _level.boundaryEdges.Resize(boundaryEdges.size());
    std::copy(boundaryEdges.begin(), boundaryEdges.end(), _level.boundaryEdges.data());
    std::vector<Index> halfFaces;
    for (Index edge : boundaryEdges) {
        if (_level.IsSharpBoundaryB(edge)) {
            halfFaces.push_back(_level.edgeFaces[2 * std::size_t(edge)]);
        }
    }
    std::sort(halfFaces.begin(), halfFaces.end());
    _level.halfFaces.Resize(halfFaces.size());
    std::copy(halfFaces.begin(), halfFaces.end(), _level.halfFaces.data());
}

void BaseLevelBuilder::buildVertices() {
    _level.vertFirstFace.Resize(std::size_t(_level.numVertices) + 1);
    _level.vertFirstEdge.Resize(std::size_t(_level.numVertices) + 1);
    _level.vertFaces.Resize(_level.numCorners);
    _level.vertFaceLocals.Resize(_level.numCorners);
    _level.vertEdges.Resize(2 * std::size_t(_level.numEdges));
    _level.vertEdgeLocals.Resize(2 * std::size_t(_level.numEdges));

    // A vertex has as many faces as corners, and an edge more than faces for each fan that begins
    // with a boundary edge.
    Index *const firstFace = _level.vertFirstFace.data();
    Index *const firstEdge = _level.vertFirstEdge.data();
    std::fill_n(firstFace, _level.vertFirstFace.size(), 0);
    std::fill_n(firstEdge, _level.vertFirstEdge.size(), 0);
    for (Index vert : _level.faceVerts) {
        ++firstFace[vert + 1];
    }
    for (Index edge : _level.boundaryEdges) {
        ++firstEdge[_level.edgeVerts[2 * std::size_t(edge)] + 1];
    }
    for (Index vert = 0; vert < _level.numVertices; ++vert) {
        firstEdge[vert + 1] += firstEdge[vert] + firstFace[vert + 1];
        firstFace[vert + 1] += firstFace[vert];
    }

    // The corners of each vertex, ascending.
    Buffer<Index> cornersOfVerts;
    cornersOfVerts.Resize(_level.numCorners);
    std::vector<Index> next(firstFace, firstFace + _level.numVertices);
    for (Index corner = 0; corner < _level.numCorners; ++corner) {
        cornersOfVerts[next[_level.faceVerts[corner]]++] = corner;
    }
    ParallelFor(_level.numVertices, [&](Index vert) {
        fillVertex(vert, cornersOfVerts.data() + firstFace[vert],
                   firstFace[vert + 1] - firstFace[vert]);
    });
}

// The fans of a vertex, by their lowest corners.
void BaseLevelBuilder::fillVertex(Index vert, Index const *corners, Index numCorners) {
    Index nextFace = _level.vertFirstFace[vert];
    Index nextEdge = _level.vertFirstEdge[vert];
    // An interior edge may have the vertex as its first or second; in a fan it is seen from the
    // side that starts at the vertex.
    auto addEdge = [&](Index edge, bool isStartOfSide, Index sideCorner) {
        bool const isSideA = _edges[edge].corners[0] == sideCorner;
        _level.vertEdges[nextEdge] = edge;
        _level.vertEdgeLocals[nextEdge++] = LocalIndex(isStartOfSide == isSideA ? 0 : 1);
    };
    // Whether the fan is closed; else only the faces from the corner on were added.
    auto addFan = [&](Index startCorner) {
        Index corner = startCorner;
        for (;;) {
            _level.vertFaces[nextFace] = _faceOfCorner[corner];
            _level.vertFaceLocals[nextFace++] = local(corner);
            addEdge(_level.faceEdges[corner], true, corner);
            Index const next = nextAround(corner);
            if (next == startCorner) {
                return true;
            }
            if (next < 0) {
                Index const prev = _level.GetPrevCorner(_faceOfCorner[corner], corner);
                addEdge(_level.faceEdges[prev], false, prev);
                return false;
            }
            corner = next;
        }
    };
    auto isPlaced = [&](Index corner) {
        for (Index i = _level.vertFirstFace[vert]; i < nextFace; ++i) {
            if (_level.GetVertexCorner(i) == corner) {
                return true;
            }
        }
        return false;
    };
    for (Index k = 0; nextFace < _level.vertFirstFace[vert] + numCorners; ++k) {
        Index start = corners[k];
        if (isPlaced(start)) {
            continue;
        }
        // A closed fan starts at the corner, an open one at its first face.
        Index const firstFace = nextFace;
        Index const firstEdge = nextEdge;
        if (addFan(start)) {
            continue;
        }
        if (Index prev = prevAround(start); prev >= 0) {
            for (; prev >= 0; prev = prevAround(start)) {
                start = prev;
            }
            nextFace = firstFace;
            nextEdge = firstEdge;
            addFan(start);
        }
    }
}

} // namespace

void BuildBaseLevel(OpenSubdiv::Vtr::ConstArray<EdgeSides> edges, LevelTopology &level) {
    level.hasFullTopology = true;
    level.isHexagonal = false;
    FindFaceSizes(level);
    BaseLevelBuilder(edges, level).Build();
}

void FindFaceSizes(LevelTopology &level) {
    auto const getSize = [&](Index face) {
        return level.faceFirstCorner[face + 1] - level.faceFirstCorner[face];
    };
    std::vector<Index> const changes = ParallelSelect(level.numFaces, [&](Index face) {
        return face == 0 || getSize(face) != getSize(face - 1);
    });
    std::set<Index> sizes;
    for (Index face : changes) {
        sizes.insert(getSize(face));
    }
    level.faceSizes.assign(sizes.begin(), sizes.end());
}

} // namespace OpenSubdivHex::FarExt::internal

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
    BaseLevelBuilder(EdgeSidesArray edges, Level &level) : _edges(edges), _level(level) {}

    void Build() {
        countBoundaries();
        Level::ForEachRelation(_level, [](auto &array, std::size_t size) {
            if (array.size() != size) { // else it is filled, or large enough
                array.Resize(size);
            }
        });
        buildFacesOfCorners();
        buildEdges();
        buildVertices();
    }

private:
    void countBoundaries();
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
    Level &_level;
    std::vector<Index> _boundaryEdges;
    Buffer<Index> _faceOfCorner;
};

void BaseLevelBuilder::countBoundaries() {
    _level.numEdges = _edges.size();
    _boundaryEdges =
        ParallelSelect(_level.numEdges, [this](Index edge) { return _edges[edge].corners[1] < 0; });
    auto const count = [&](BoundaryKind kind) {
        return Index(std::count_if(_boundaryEdges.begin(), _boundaryEdges.end(),
                                   [&](Index edge) { return _edges[edge].corners[1] == kind; }));
    };
    _level.numFreeBoundaries = count(kFreeBoundary);
    _level.numSharpBoundariesA = count(kSharpBoundaryA);
    _level.numSharpBoundariesB = count(kSharpBoundaryB);
}

void BaseLevelBuilder::buildFacesOfCorners() {
    _faceOfCorner.Resize(_level.numCorners);
    ParallelFor(_level.numFaces, [this](Index face) {
        std::fill(_faceOfCorner.data() + _level.faceFirstCorner[face],
                  _faceOfCorner.data() + _level.faceFirstCorner[face + 1], face);
    });
}

void BaseLevelBuilder::buildEdges() {
    ParallelFor(_level.numEdges, [this](Index edge) {
        Index const corner = _edges[edge].corners[0];
        Index const other = _edges[edge].corners[1];
        Index const face = _faceOfCorner[corner];
        Index const next = _level.GetNextCorner(face, corner);
        _level.edgeVerts[edge] = {_level.faceVerts[corner], _level.faceVerts[next]};
        _level.faceEdges[corner] = edge;
        if (other < 0) {
            _level.edgeFaces[edge] = {face, other};
            _level.edgeFaceLocals[edge] = {local(corner), 0};
        } else {
            _level.edgeFaces[edge] = {face, _faceOfCorner[other]};
            _level.edgeFaceLocals[edge] = {local(corner), local(other)};
            _level.faceEdges[other] = edge;
        }
    });
    std::copy(_boundaryEdges.begin(), _boundaryEdges.end(), _level.boundaryEdges.data());
    Index *halfFace = _level.halfFaces.data();
    for (Index edge : _boundaryEdges) {
        if (_level.IsSharpBoundaryB(edge)) {
            *halfFace++ = _level.edgeFaces[edge][0];
        }
    }
    std::sort(_level.halfFaces.data(), halfFace);
}

void BaseLevelBuilder::buildVertices() {
    // A vertex has as many faces as corners, and an edge more than faces for each fan that begins
    // with a boundary edge.
    Index *const firstFace = _level.vertFirstFace.data();
    Index *const firstEdge = _level.vertFirstEdge.data();
    std::fill_n(firstFace, _level.vertFirstFace.size(), 0);
    std::fill_n(firstEdge, _level.vertFirstEdge.size(), 0);
    for (Index vert : _level.faceVerts) {
        ++firstFace[vert + 1];
    }
    for (Index edge : _boundaryEdges) {
        ++firstEdge[_level.edgeVerts[edge][0] + 1];
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

void BuildBaseLevel(OpenSubdiv::Vtr::ConstArray<EdgeSides> edges, Level &level) {
    level.hasFullTopology = true;
    level.isHexagonal = false;
    level.numVertsOfAnyValence = level.numVertices;
    FindFaceSizes(level);
    BaseLevelBuilder(edges, level).Build();
}

void FindFaceSizes(Level &level) {
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

// SPDX-License-Identifier: Apache-2.0
#include "plainCell.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

// Keys are made of bytes.
constexpr Index kEndOfBytes = 256;
constexpr int kLeastFaces = 3;

// The vertex behind the one at position k of vertFaces, in the face there: the end of the edge before
// the face, counter-clockwise.
Index getNextVertex(Level const &level, Index k) {
    return level.faceVerts[level.GetNextCorner(level.vertFaces[k], level.GetVertexCorner(k))];
}

} // namespace

bool PlainCellGatherer::addVertex(Index vert, PlainCell &result) {
    auto const next = Index(result.sources.size());
    Index const number = _numbers.FindOrSet(vert, next);
    if (number == next) {
        result.sources.push_back(vert);
    }
    result.key.push_back(char(number));
    return number < kEndOfBytes;
}

// The corners of a face begin at the vertex that it is at position k of vertFaces for.
bool PlainCellGatherer::addFace(Level const &level, Index k, PlainCell &result) {
    Index const face = level.vertFaces[k];
    Index const number = _faces.FindOrSet(face, _numFaces);
    if (number != _numFaces) {
        result.key.push_back(char(number));
        return true;
    }
    ++_numFaces;
    int const size = level.GetFaceSize(face);
    if (_numFaces >= kEndOfBytes || size >= kEndOfBytes) {
        return false;
    }
    result.key.push_back(char(number));
    result.key.push_back(char(size));
    Index const first = level.faceFirstCorner[face];
    Index const begin = level.vertFaceLocals[k];
    for (int i = 0; i < size; ++i) {
        Index const local = begin + i;
        if (!addVertex(level.faceVerts[first + (local < size ? local : local - size)], result)) {
            return false;
        }
    }
    return true;
}

// The faces around a vertex, from one of them on.
bool PlainCellGatherer::addFan(Level const &level, Index vert, Index first, PlainCell &result) {
    Index const begin = level.vertFirstFace[vert];
    int const numFaces = level.GetNumVertexFaces(vert);
    result.key.push_back(char(numFaces));
    for (int i = 0; i < numFaces; ++i) {
        Index const local = first + i;
        if (!addFace(level, begin + (local < numFaces ? local : local - numFaces), result)) {
            return false;
        }
    }
    return true;
}

// As LimitPatchGatherer::GatherCell() does.
bool PlainCellGatherer::Gather(Level const &level, std::vector<VertexMark> const &marks, Index face,
                               PlainCell &result) {
    _numbers.Clear();
    _faces.Clear();
    _numFaces = 0;
    result.sources.clear();
    result.key.clear();
    Far::ConstIndexArray const centers = level.GetFaceVertices(face);
    int const numCenters = centers.size();
    if (numCenters >= kEndOfBytes) {
        return false;
    }
    result.key.push_back(char(numCenters));
    for (Index const vert : centers) {
        if (!addVertex(vert, result)) {
            return false;
        }
    }
    if (int(result.sources.size()) != numCenters) {
        return false;
    }
    // Where the fans of the centres begin: with the face.
    auto const findFace = [&](Index vert) {
        Index const *const faces = level.vertFaces.data() + level.vertFirstFace[vert];
        return Index(std::find(faces, faces + level.GetNumVertexFaces(vert), face) - faces);
    };
    for (Index const vert : centers) {
        Index const begin = level.vertFirstFace[vert];
        int const numFaces = level.GetNumVertexFaces(vert);
        Index const first = findFace(vert);
        result.key.push_back(char(numFaces));
        for (int i = 0; i < numFaces; ++i) {
            if (!addVertex(getNextVertex(level, begin + (first + i) % numFaces), result)) {
                return false;
            }
        }
    }
    auto const numComplete = result.sources.size();
    for (std::size_t i = 0; i < numComplete; ++i) {
        Index const vert = result.sources[i];
        Index const begin = level.vertFirstFace[vert];
        int const numFaces = level.GetNumVertexFaces(vert);
        bool const isFeature = !marks.empty() && marks[std::size_t(vert)] == VertexMark::Feature;
        if (isFeature || numFaces < kLeastFaces || numFaces >= kEndOfBytes) {
            return false;
        }
        _neighbors.clear();
        for (int a = 0; a < numFaces; ++a) {
            Index const neighbor = getNextVertex(level, begin + a);
            // Two edges that join the same vertices are told apart by nothing in the key.
            if (std::find(_neighbors.begin(), _neighbors.end(), neighbor) != _neighbors.end()) {
                return false;
            }
            _neighbors.push_back(neighbor);
        }
        // Those of neighbours begin behind the edge to the first centre.
        Index first = 0;
        if (i < std::size_t(numCenters)) {
            first = findFace(vert);
        } else {
            Index least = numCenters;
            for (int a = 0; a < numFaces; ++a) {
                Index const number = _numbers.Find(_neighbors[std::size_t(a)]);
                if (number != Far::INDEX_INVALID && number < least) {
                    least = number;
                    first = a;
                }
            }
        }
        if (!addFan(level, vert, first, result)) {
            return false;
        }
    }
    return true;
}

} // namespace OpenSubdivHex::FarExt::internal

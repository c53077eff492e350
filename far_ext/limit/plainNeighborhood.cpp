// SPDX-License-Identifier: Apache-2.0
#include "plainNeighborhood.h"

#include <bitset>
#include <cstring>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

// Keys are made of bytes.
constexpr int kEndOfBytes = 256;

constexpr int kRegularValence = 3;
constexpr int kRegularSize = HexIndexing::kNumEFaceCorners;

// The vertices of a face, from one of them on.
struct TurnedFace {
    Index const *verts;
    int size;
    int local;

    Index GetVertex(int i) const {
        int const place = local + i;
        return verts[place < size ? place : place - size];
    }
};

TurnedFace getTurnedFace(Level const &level, Index k) {
    Index const face = level.vertFaces[k];
    return {level.faceVerts.data() + level.faceFirstCorner[face], level.GetFaceSize(face),
            level.vertFaceLocals[k]};
}

// Gathers the vertices of three hexagons around a vertex, and those of the hexagons around its
// neighbours.  isHexagon(corner, neighbor) is asked for each face, the three first, with the next
// vertex around it or, of the others, the neighbour.
template <typename IS_HEXAGON>
bool gatherHexagons(Level const &level, Index vert, Index *sources, IS_HEXAGON isHexagon) {
    Index const begin = level.vertFirstFace[vert];
    Index *next = sources + 1 + kRegularValence;
    sources[0] = vert;
    auto const addFace = [&](TurnedFace const &corner, Index neighbor) {
        if (!isHexagon(corner, neighbor)) {
            return false;
        }
        for (int j = 2; j < kRegularSize - 1; ++j) {
            *next++ = corner.GetVertex(j);
        }
        return true;
    };
    for (int i = 0; i < kRegularValence; ++i) {
        TurnedFace const corner = getTurnedFace(level, begin + i);
        sources[1 + i] = corner.GetVertex(1);
        if (!addFace(corner, sources[1 + i])) {
            return false;
        }
    }
    Index const *const faces = level.vertFaces.data() + begin;
    for (int i = 0; i < kRegularValence; ++i) {
        Index k = level.vertFirstFace[sources[1 + i]];
        Index const last = k + kRegularValence - 1;
        auto const isAround = [&](Index face) {
            return face == faces[0] || face == faces[1] || face == faces[2];
        };
        while (k < last && isAround(level.vertFaces[k])) {
            ++k;
        }
        if (!addFace(getTurnedFace(level, k), sources[1 + i])) {
            return false;
        }
    }
    return true;
}

std::vector<VertexMark> markFeatures(Level const &level) {
    std::vector<VertexMark> result;
    if (level.GetNumBoundaries() == 0 && level.edgeSharpness.empty() &&
        level.vertSharpness.empty() && level.nonManifoldVerts.empty() && level.sharpVerts.empty() &&
        !level.HasFeatures()) {
        return result;
    }
    result.resize(std::size_t(level.numVertices), VertexMark::Plain);
    CornerTags::ForEachKind(
        [&](auto const &tags) {
            for (auto const &tag : tags) {
                for (Index vert : level.GetFaceVertices(level.FindFaceOfCorner(tag.corner))) {
                    result[std::size_t(vert)] = VertexMark::Irregular;
                }
            }
        },
        level);
    auto const mark = [&](Index vert) { result[std::size_t(vert)] = VertexMark::Feature; };
    auto const markEdge = [&](Index edge) {
        mark(level.edgeVerts[edge][0]);
        mark(level.edgeVerts[edge][1]);
    };
    auto const markFace = [&](Index face) {
        for (Index vert : level.GetFaceVertices(face)) {
            mark(vert);
        }
    };
    std::for_each(level.boundaryEdges.begin(), level.boundaryEdges.end(), markEdge);
    std::for_each(level.halfFaces.begin(), level.halfFaces.end(), markFace);
    std::for_each(level.nonManifoldVerts.begin(), level.nonManifoldVerts.end(), mark);
    for (SharpVertex const &sharp : level.sharpVerts) {
        mark(sharp.vert);
    }
    for (SectorCorner const &sector : level.sectorCorners) {
        markFace(level.FindFaceOfCorner(sector.corner));
    }
    for (LineRowCorner const &besideLine : level.lineRowCorners) {
        markFace(level.FindFaceOfCorner(besideLine.corner));
    }
    for (QuadLineCorner const &besideLine : level.quadLineCorners) {
        markFace(level.FindFaceOfCorner(besideLine.corner));
    }
    auto const forEachSharp = [](Buffer<float> const &tags, auto function) {
        for (std::size_t i = 0; i < tags.size(); ++i) {
            if (Crease::IsSharp(tags[i])) {
                function(Index(i));
            }
        }
    };
    forEachSharp(level.edgeSharpness, markEdge);
    forEachSharp(level.diagonalSharpness, markFace);
    forEachSharp(level.vertSharpness, mark);
    return result;
}

} // namespace

// As LimitPatchGatherer does: from the face on with which the sequence of sizes is the least.
int PlainNeighborhoodGatherer::findFirstFace(Index vert) {
    Index const *const faces = _level.vertFaces.data() + _level.vertFirstFace[vert];
    int const numFaces = _level.GetNumVertexFaces(vert);
    auto const isLess = [&](int first, int second) {
        for (int i = 0; i < numFaces; ++i) {
            int const a = _level.GetFaceSize(faces[(first + i) % numFaces]);
            int const b = _level.GetFaceSize(faces[(second + i) % numFaces]);
            if (a != b) {
                return a < b;
            }
        }
        return false;
    };
    int best = 0;
    bool const isUniform = std::all_of(faces, faces + numFaces, [&](Index face) {
        return _level.GetFaceSize(face) == _level.GetFaceSize(faces[0]);
    });
    for (int i = 1; i < numFaces && !isUniform; ++i) {
        if (isLess(i, best)) {
            best = i;
        }
    }
    return best;
}

bool PlainNeighborhoodGatherer::addFace(Index face, int local, PlainNeighborhood &result) {
    Index const first = _level.faceFirstCorner[face];
    int const size = _level.GetFaceSize(face);
    _faces.push_back(face);
    std::size_t const keySize = result.key.size();
    result.key.resize(keySize + 1 + std::size_t(size));
    char *key = result.key.data() + keySize;
    *key++ = char(size);
    TurnedFace const corners = {_level.faceVerts.data() + first, size, local};
    for (int i = 0; i < size; ++i) {
        Index const vert = corners.GetVertex(i);
        auto const next = Index(result.sources.size());
        Index const number = _numbers.FindOrSet(vert, next);
        if (number == next) {
            result.sources.push_back(vert);
        }
        *key++ = char(number);
    }
    // In the neighborhood of a face, all faces count as faces of the ring.
    addCornerTags(face, local, _neighbors.empty() || _faces.size() <= _neighbors.size(), result);
    return size < kEndOfBytes && result.sources.size() < kEndOfBytes;
}

// Only corners at the neighbours of the vertex matter of the faces further out.
void PlainNeighborhoodGatherer::addCornerTags(Index face, int local, bool isRing,
                                              PlainNeighborhood &result) const {
    if (!_level.HasCornerTags()) {
        return;
    }
    auto const numComplete = Index(1 + _neighbors.size());
    Index const first = _level.faceFirstCorner[face];
    int const size = _level.GetFaceSize(face);
    CornerTags::ForEachKind(
        [&](auto const &tags) {
            std::size_t const position = result.key.size();
            result.key.push_back(0);
            for (auto const &tag : FindCornerTags(tags, first, first + size)) {
                if (isRing || _numbers.Find(_level.faceVerts[tag.corner]) < numComplete) {
                    char bytes[sizeof tag];
                    std::memcpy(bytes, &tag, sizeof tag);
                    result.key.push_back(char((tag.corner - first - local + size) % size));
                    result.key.append(bytes + sizeof tag.corner, sizeof tag - sizeof tag.corner);
                    ++result.key[position];
                }
            }
        },
        _level);
}

// The faces around a neighbour, from its edge to the vertex on, but for the first and the last.
bool PlainNeighborhoodGatherer::addOuterFaces(int neighbor, PlainNeighborhood &result) {
    int const numNeighbors = int(_neighbors.size());
    Index const vert = _neighbors[neighbor];
    Far::ConstIndexArray const faces = _level.GetVertexFaces(vert);
    Index const before = _faces[(neighbor + numNeighbors - 1) % numNeighbors];
    return addFacesFrom(vert, faces.FindIndex(before), false, result);
}

// The faces around a vertex in turn, from one of them on, as far as they are not there already.
bool PlainNeighborhoodGatherer::addFacesFrom(Index vert, int first, bool isKeyOfAll,
                                             PlainNeighborhood &result) {
    constexpr char kIsThere = 0; // in place of a size
    Index const firstFace = _level.vertFirstFace[vert];
    int const numFaces = _level.GetNumVertexFaces(vert);
    if (numFaces < kRegularValence || numFaces >= kEndOfBytes) {
        return false;
    }
    result.key.push_back(char(numFaces));
    // Two edges that join the same vertices are told apart by nothing in the key.
    std::bitset<kEndOfBytes> isNeighbor;
    for (int i = 0; i < numFaces; ++i) {
        Index const k = firstFace + (first + i) % numFaces;
        Index const face = _level.vertFaces[k];
        TurnedFace const corner = getTurnedFace(_level, k);
        if (std::find(_faces.begin(), _faces.end(), face) == _faces.end()) {
            if (!addFace(face, corner.local, result)) {
                return false;
            }
        } else if (isKeyOfAll) {
            result.key.push_back(kIsThere);
        }
        auto const number = std::size_t(_numbers.Find(corner.GetVertex(1)));
        if (isNeighbor[number]) {
            return false;
        }
        isNeighbor[number] = true;
    }
    return true;
}

bool PlainNeighborhoodGatherer::Gather(Index vert, PlainNeighborhood &result) {
    int const numFaces = _level.GetNumVertexFaces(vert);
    if (hasFeature(vert) || numFaces < kRegularValence || numFaces >= kEndOfBytes) {
        return false;
    }
    _numbers.Clear();
    _faces.clear();
    _neighbors.clear();
    result.key.clear();
    result.key.push_back(char(numFaces));
    result.sources.assign(1, vert);
    _numbers.FindOrSet(vert, 0);

    Index const begin = _level.vertFirstFace[vert];
    int const first = findFirstFace(vert);
    auto const getRingFace = [&](int i) { return begin + (first + i) % numFaces; };
    for (int i = 0; i < numFaces; ++i) {
        Index const neighbor = getTurnedFace(_level, getRingFace(i)).GetVertex(1);
        auto const next = Index(result.sources.size());
        if (hasFeature(neighbor) || _numbers.FindOrSet(neighbor, next) != next) {
            return false;
        }
        _neighbors.push_back(neighbor);
        result.sources.push_back(neighbor);
    }
    for (int i = 0; i < numFaces; ++i) {
        Index const k = getRingFace(i);
        if (!addFace(_level.vertFaces[k], _level.vertFaceLocals[k], result)) {
            return false;
        }
    }
    for (int i = 0; i < numFaces; ++i) {
        if (!addOuterFaces(i, result)) {
            return false;
        }
    }
    return true;
}

// All faces around a vertex in turn, from that on which was added first.
bool PlainNeighborhoodGatherer::addFacesAround(Index vert, PlainNeighborhood &result) {
    Far::ConstIndexArray const faces = _level.GetVertexFaces(vert);
    auto const find = [this](Index face) { return std::find(_faces.begin(), _faces.end(), face); };
    auto const first = std::min_element(faces.begin(), faces.end(),
                                        [&](Index a, Index b) { return find(a) < find(b); });
    return addFacesFrom(vert, int(first - faces.begin()), true, result);
}

bool PlainNeighborhoodGatherer::GatherFace(Index face, PlainNeighborhood &result) {
    _numbers.Clear();
    _faces.clear();
    _neighbors.clear();
    result.key.clear();
    result.sources.clear();
    Far::ConstIndexArray const verts = _level.GetFaceVertices(face);
    if (std::any_of(verts.begin(), verts.end(), [this](Index vert) { return hasFeature(vert); }) ||
        !addFace(face, 0, result) || result.sources.size() != std::size_t(verts.size())) {
        return false;
    }
    for (Index const vert : verts) {
        result.key.push_back(char(_level.vertFaces[_level.vertFirstFace[vert]] == face));
    }
    for (Index const vert : verts) {
        if (!addFacesAround(vert, result)) {
            return false;
        }
    }
    auto const numRing = _faces.size();
    std::bitset<kEndOfBytes> isDone;
    for (std::size_t i = 0; i < numRing; ++i) {
        TurnedFace const corners = {_level.faceVerts.data() + _level.faceFirstCorner[_faces[i]],
                                    _level.GetFaceSize(_faces[i]), 0};
        for (int k = 0; k < corners.size; ++k) {
            // Beside a vertex of the face, but none itself.
            auto const isOfFace = [&](int place) {
                return _numbers.Find(corners.GetVertex(place)) < Index(verts.size());
            };
            Index const vert = corners.GetVertex(k);
            auto const number = std::size_t(_numbers.Find(vert));
            if (isDone[number] || isOfFace(k) ||
                !(isOfFace((k + 1) % corners.size) ||
                  isOfFace((k + corners.size - 1) % corners.size))) {
                continue;
            }
            isDone[number] = true;
            if (hasFeature(vert) || !addFacesAround(vert, result)) {
                return false;
            }
        }
    }
    return true;
}

void PlainNeighborhoodGatherer::GatherRegular(Level const &level, Index vert,
                                              Index sources[kNumRegular]) {
    gatherHexagons(level, vert, sources, [](TurnedFace const &, Index) { return true; });
}

bool PlainNeighborhoodGatherer::IsRegular(Index vert) const {
    auto const isPlain = [&](Index index) {
        return (_marks.empty() || _marks[std::size_t(index)] == VertexMark::Plain) &&
               _level.GetNumVertexFaces(index) == kRegularValence;
    };
    // The neighbours are plain before the faces around them are looked for.
    Index sources[kNumRegular];
    if (!isPlain(vert) ||
        !gatherHexagons(_level, vert, sources, [&](TurnedFace const &corner, Index neighbor) {
            return corner.size == kRegularSize && isPlain(neighbor);
        })) {
        return false;
    }
    int numEqual = 0;
    for (Index a : sources) {
        for (Index b : sources) {
            numEqual += a == b;
        }
    }
    return numEqual == kNumRegular;
}

std::vector<VertexMark> const &GetVertexMarks(Level const &level) {
    return *level.vertexMarks.Get(
        [&] { return std::make_shared<std::vector<VertexMark> const>(markFeatures(level)); });
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "plainFace.h"

#include "patchCorners.h"

#include <algorithm>
#include <functional>
#include <new>
#include <numeric>
#include <utility>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::CellKind;
using FarExt::internal::CellPatch;
using FarExt::internal::Level;

namespace {

constexpr int kTriangle = 3;
// In the first byte of a key: that the sizes of faces come behind the rest.
constexpr int kHasSizes = 0x80;

int getFaceSize(Level const &level, Far::Index place) {
    return level.GetFaceSize(level.vertFaces[place]);
}

// The most bytes that a key has.
constexpr std::size_t kMaxKeySize = 192;

std::uint8_t const *getBytes(PlainFaceKey const &key) {
    return reinterpret_cast<std::uint8_t const *>(key.data());
}

// Whether the faces of a key are a piece of a regular lattice.
bool isInLattice(PlainFaceKey const &key, int numVerts) {
    std::uint8_t const *const numFaces = getBytes(key) + 1;
    int const valence = CellType::GetLatticeValence(getBytes(key)[0]); // 0 where sizes differ
    return std::all_of(numFaces, numFaces + numVerts,
                       [&](int number) { return number == valence; });
}

// Adds all faces of a key to a patch that has begun; false where no disc has them.
bool grow(PlainFaceKey const &key, int numVerts, GrowingPatch &patch) {
    std::uint8_t const *const numFaces = getBytes(key) + 1;
    std::uint8_t const *sizes = (key[0] & kHasSizes) != 0 ? numFaces + numVerts : nullptr;
    for (int vert = 0; vert < numVerts; ++vert) {
        if (!patch.Add(vert, numFaces[vert], sizes)) {
            return false;
        }
        if (sizes) {
            sizes += numFaces[vert];
        }
    }
    return patch.GetNumInner() == numVerts;
}

} // namespace

PlainFaceType::PlainFaceType(PlainFaceTypes &types, PlainFaceKey const &key, int numVerts,
                             Run const *runs, Run const *end)
    : hash(std::hash<PlainFaceKey>()(key)), _types(types), _key(key, &types._memory),
      _numVerts(numVerts), _runs(runs, end, &types._memory),
      _numPoints(std::accumulate(runs, end, numVerts,
                                 [](int count, Run const &run) { return count + run.numPoints; })),
      _isInLattice(isInLattice(key, numVerts)) {}

PlainFaceType::~PlainFaceType() { delete _rings.load(); }

// A vertex has its neighbours in the patch.
static_assert(GrowingPatch::kMaxInner <= InnerRings::kMaxFaces);

// If several threads do so at once, the first one makes it for all.
FaceRings const &PlainFaceType::makeRings() const {
    // Its memory is kept for the next face.
    static thread_local CellPatch cell;
    makeCell(cell);
    auto rings = std::make_unique<FaceRings const>(cell, _types._ringCells);
    FaceRings const *expected = nullptr;
    if (_rings.compare_exchange_strong(expected, rings.get(), std::memory_order_acq_rel)) {
        _types._types.GetMemory().Add(internal::GetHeapSize(rings));
        return *rings.release();
    }
    return *expected;
}

// Threads that do so at once find the same.
CellType const &PlainFaceType::make() const {
    CellPatch cell;
    makeCell(cell);
    CellType const &type = _types._types.Find(cell, _types._ringCells.GetRules());
    if (!_type.exchange(&type, std::memory_order_acq_rel)) {
        --_types._numUnmade;
    }
    return type;
}

void PlainFaceType::makeCell(CellPatch &cell) const {
    static thread_local GrowingPatch patch;
    PlainFaceKey const key(_key);
    patch.Start(std::uint8_t(key[0]) & ~kHasSizes, true);
    grow(key, _numVerts, patch);
    patch.GetFaces(cell.patch.faceSizes, cell.patch.faceVerts, cell.patch.otherCorners);
    FarExt::internal::FinishPlainBaseCell(GetNumPoints(), cell);
}

namespace {

// Finds the vertices of a patch in another one, from a corner of both on; false where one of the patches has
// vertices that are the same, and the other has not.
bool findInPatch(CellPatch const &part, int firstCorner, PatchCorners const &ofAll, int firstOfAll,
                 std::vector<int> &verts) {
    constexpr int kNone = -1;
    FarExt::internal::LimitPatch const &patch = part.patch;
    PatchCorners const corners(patch);
    std::vector<int> found(patch.faceVerts.size(), kNone); // by corner
    std::vector<int> ofVerts(ofAll.GetPatch().sources.size(), kNone);
    verts.assign(patch.sources.size(), kNone);
    // Adds the vertices of a face, from one of its corners on.
    auto const add = [&](int corner, int cornerOfAll) {
        int const size = corners.GetFaceSize(corner);
        for (int i = 0; i < size; ++i) {
            int const vert = corners.GetVertex(corners.GetNext(corner, i));
            int const other = ofAll.GetNext(cornerOfAll, i);
            int &number = verts[std::size_t(vert)];
            int &back = ofVerts[std::size_t(ofAll.GetVertex(other))];
            if (number == kNone && back == kNone) {
                number = ofAll.GetVertex(other);
                back = vert;
            }
            if (number != ofAll.GetVertex(other) || back != vert) {
                return false;
            }
            found[std::size_t(corners.GetNext(corner, i))] = other;
        }
        return true;
    };
    if (!add(firstCorner, firstOfAll)) {
        return false;
    }
    // Faces are joined to some before.
    for (std::size_t corner = 0; corner < found.size(); ++corner) {
        int const next = patch.otherCorners[corner];
        if (next >= 0 && found[std::size_t(next)] == kNone) {
            int const other = ofAll.GetPatch().otherCorners[std::size_t(found[corner])];
            if (other < 0 || !add(next, other)) {
                return false;
            }
        }
    }
    return true;
}

} // namespace

CellType::BorderItem PlainFaceType::makeLatticeItem(CellPatch const &cell,
                                                    PatchCorners const &corners, int const *turns,
                                                    std::size_t item) const {
    auto const numEdges = std::size_t(cell.GetNumCorners());
    bool const isEdge = item < numEdges;
    CellRules const &rules = _types._ringCells.GetRules();
    CellType const &type = _types._ringCells.FindLatticeItem(
        isEdge ? CellKind::Edge : CellKind::Vertex, cell.GetNumCorners(), [&] {
            return &_types._types.Find(GatherBorder(cell, turns, rules.sdcOptions, int(item))[item],
                                       rules);
        });
    // The corner of the face, or of another one, that is the first of the item.
    auto corner = int(isEdge ? item : item - numEdges);
    for (int i = 0; i < turns[item]; ++i) {
        corner = isEdge ? cell.patch.otherCorners[std::size_t(corner)]
                        : corners.GetNext(cell.patch.otherCorners[std::size_t(corner)], 1);
    }
    CellType::BorderItem result = {&type, {}, isEdge && turns[item] == 1, nullptr};
    CellPatch const lattice = type.MakeCell();
    return findInPatch(lattice, lattice.locals[0], corners, corner, result.points)
               ? result
               : Get().GetBorderItem(turns, item);
}

CellType::BorderItem const &PlainFaceType::GetLatticeItem(int const *turns,
                                                          std::size_t item) const {
    FaceRings const &rings = GetRings();
    return CellType::FindBorderItem(rings.GetPatterns(), turns, item, [&] {
        CellPatch cell;
        makeCell(cell);
        PatchCorners const corners(cell.patch);
        int const numEdges = cell.GetNumCorners();
        std::vector<CellType::BorderItem> items(2 * std::size_t(numEdges));
        for (int i = 0; i < 2 * numEdges; ++i) {
            if (i < numEdges ? rings.IsEdgeInLattice(i) : rings.IsVertexInLattice(i - numEdges)) {
                items[std::size_t(i)] = makeLatticeItem(cell, corners, turns, std::size_t(i));
            }
        }
        return items;
    });
}

PlainFaceType const &PlainFaceTypes::Add(PlainFaceKey const &key, int numVerts,
                                         GrowingPatch const &patch) {
    PlainFaceType::Run runs[GrowingPatch::kMaxVerts];
    PlainFaceType::Run const *const end = patch.GetRuns(runs);
    decltype(_entries)::Pointer made;
    {
        std::lock_guard<std::mutex> const lock(_mutex);
        void *const memory = _memory.allocate(sizeof(PlainFaceType), alignof(PlainFaceType));
        made.reset(new (memory) PlainFaceType(*this, key, numVerts, runs, end));
    }
    auto const [type, isNew] = _entries.Add(
        std::move(made), [&](PlainFaceType const &other) { return other.HasKey(key); });
    if (isNew) {
        ++_numUnmade;
        _types.GetMemory().Add(decltype(_entries)::kEntrySize + type->GetHeapSize());
    }
    return *type;
}

// The vertices of the face and then, around one after the other, their neighbours: where the face across
// an edge is a triangle, the ends of the edge have a neighbour in common.
bool PlainFaceGatherer::findVertices(Level const &level, Index face) {
    FaceWalk::Next const *const nexts = _arrays->nexts.data();
    FaceWalk::Fan const *const fans = _arrays->fans.data();
    int const size = level.GetFaceSize(face);
    Vertex *end = _verts;
    // The faces of a vertex begin with the one at a place.
    auto const addVertex = [&](Index vert, Index place) {
        FaceWalk::Fan const fan = fans[vert];
        if (fan.first == fan.end || end == _verts + GrowingPatch::kMaxInner) {
            return false;
        }
        *end++ = {vert, place < fan.end ? place : fan.first, fan};
        return true;
    };
    Index const first = level.faceFirstCorner[face];
    for (Index corner = first; corner < first + size; ++corner) {
        if (!addVertex(level.faceVerts[corner], _arrays->places[std::size_t(corner)])) {
            return false;
        }
    }
    bool const mayBeTriangles = level.faceSizes.front() == kTriangle;
    auto const isTriangle = [&](Index place) {
        return mayBeTriangles && getFaceSize(level, place) == kTriangle;
    };
    for (int i = 0; i < size; ++i) {
        Vertex const at = _verts[i];
        // The first two are neighbours in the face.
        bool const isFirstCommon = i > 0 && isTriangle(at.GetPlace(1));
        int const numFaces = at.fan.GetNumFaces();
        bool const isLastCommon = i + 1 == size && isTriangle(at.GetPlace(numFaces - 1));
        for (int k = isFirstCommon ? 3 : 2; k < numFaces - (isLastCommon ? 1 : 0); ++k) {
            FaceWalk::Next const &next = nexts[at.GetPlace(k)];
            if (!addVertex(next.vert, next.place + 1)) {
                return false;
            }
        }
    }
    _faceSize = size;
    _numVerts = int(end - _verts);
    _key.assign(1, char(size));
    std::for_each(_verts, end,
                  [&](Vertex const &vert) { _key.push_back(char(vert.fan.GetNumFaces())); });
    return true;
}

// Adds the sizes of faces to the key, where they differ; false where they are too many or too large.
bool PlainFaceGatherer::addSizes(Level const &level) {
    std::size_t const size = _key.size();
    bool hasSizes = false;
    for (int i = 0; i < _numVerts; ++i) {
        Vertex const &vert = _verts[i];
        int const numFaces = vert.fan.GetNumFaces();
        if (_key.size() + std::size_t(numFaces) > kMaxKeySize) {
            return false;
        }
        for (int k = 0; k < numFaces; ++k) {
            int const faceSize = getFaceSize(level, vert.GetPlace(k));
            if (faceSize >= kHasSizes) {
                return false;
            }
            hasSizes = hasSizes || faceSize != _faceSize;
            _key.push_back(char(faceSize));
        }
    }
    if (hasSizes) {
        _key[0] = char(_faceSize | kHasSizes);
    } else {
        _key.resize(size);
    }
    return true;
}

// Writes the points of a patch whose vertices differ as the key says; false where points are the same.
bool PlainFaceGatherer::writePoints(PlainFaceType const &type, Index *points) {
    if (++_search == 0) {
        std::fill_n(_stamps, kNumStamps, std::uint16_t(0));
        ++_search;
    }
    FaceWalk::Next const *const nexts = _arrays->nexts.data();
    std::uint16_t const search = _search;
    bool mayBeSame = false;
    Index *end = points;
    auto const add = [&](Index point) {
        std::uint16_t &stamp = _stamps[std::uint32_t(point) % kNumStamps];
        mayBeSame = mayBeSame | (stamp == search);
        stamp = search;
        *end++ = point;
    };
    std::for_each_n(_verts, _numVerts, [&](Vertex const &vert) { add(vert.vert); });
    for (PlainFaceType::Run const &run : type.GetRuns()) {
        Index place = _verts[run.first.vert].GetPlace(run.first.place);
        for (int corner = 1; corner < run.first.corner; ++corner) {
            place = nexts[place].place;
        }
        for (int i = 0; i < run.numPoints; ++i) {
            FaceWalk::Next const next = nexts[place];
            place = next.place;
            add(next.vert);
        }
    }
    if (!mayBeSame) {
        return true;
    }
    // Others may end with the same digits.
    Index sorted[GrowingPatch::kMaxVerts];
    Index *const endOfSorted = std::copy(points, end, sorted);
    std::sort(sorted, endOfSorted);
    return std::adjacent_find(sorted, endOfSorted) == endOfSorted;
}

void PlainFaceGatherer::writeTurns(Level const &level, Index face, Index *turns) const {
    Index const *const edges = level.faceEdges.data() + level.faceFirstCorner[face];
    for (int i = 0; i < _faceSize; ++i) {
        bool const isFirst =
            level.edgeFaces[edges[i]][0] == face && level.edgeFaceLocals[edges[i]][0] == i;
        turns[i] = isFirst ? 0 : 1;
        turns[_faceSize + i] = _verts[i].begin - _verts[i].fan.first;
    }
}

PlainFaceType const *PlainFaceGatherer::findType(PlainFaceTypes &types, FaceWalk const &walk,
                                                 Index face) {
    Level const &level = walk.GetLevel();
    _arrays = &walk.GetArrays();
    if (!findVertices(level, face) || (level.faceSizes.size() > 1 && !addSizes(level))) {
        return nullptr;
    }
    if (PlainFaceType const *const type = types.Find(_key)) {
        return type;
    }
    _patch.Start(_faceSize, false);
    return grow(_key, _numVerts, _patch) ? &types.Add(_key, _numVerts, _patch) : nullptr;
}

// False where points are the same.
bool PlainFaceGatherer::writeFace(Level const &level, Index face, PlainFaceType const &type,
                                  Index *points) {
    if (!writePoints(type, points)) {
        return false;
    }
    writeTurns(level, face, points + type.GetNumPoints());
    return true;
}

} // namespace OpenSubdivHex::BfrExt::internal

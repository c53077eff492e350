// SPDX-License-Identifier: Apache-2.0
#include "plainFace.h"

#include "patchCorners.h"

#include "far_ext/vtr/indexSet.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::CellKind;
using FarExt::internal::CellPatch;
using FarExt::internal::IndexMap;
using FarExt::internal::Level;
using FarExt::internal::VertexMark;

namespace {

constexpr int kTriangle = 3;
constexpr int kLeastFaces = 3;
constexpr int kEndOfBytes = 256;
// That patches have, but for those at vertices of many faces.
constexpr std::size_t kMaxFacesOfMost = 48;
// In the first byte of a key: that the sizes of faces come behind the rest.
constexpr int kHasSizes = 0x80;

int getFaceSize(Level const &level, Far::Index place) {
    return level.GetFaceSize(level.vertFaces[place]);
}

// The vertex that a face at a place of vertFaces has behind that vertex.
Far::Index getNextVertex(Level const &level, Far::Index place) {
    Far::Index const face = level.vertFaces[place];
    Far::Index const first = level.faceFirstCorner[face];
    Far::Index const next = first + level.vertFaceLocals[place] + 1;
    return level.faceVerts[next < level.faceFirstCorner[face + 1] ? next : first];
}

// Whether the faces of a key are a piece of a regular lattice.
bool isInLattice(PlainFaceKey const &key, int numVerts) {
    std::uint8_t const *const numFaces = key.GetBytes() + 1;
    int const valence = CellType::GetLatticeValence(key.GetBytes()[0]); // 0 where sizes differ
    return std::all_of(numFaces, numFaces + numVerts,
                       [&](int number) { return number == valence; });
}

// A patch that grows from a face, the faces of one vertex at a time, no vertices being the same but where
// that follows from their numbers of faces: all that its boundary has, counter-clockwise.
class GrowingPatch {
public:
    explicit GrowingPatch(int size) : _size(size), _numLeft(size) {
        for (int vert = 0; vert < size; ++vert) {
            _verts[vert] = {(vert + size - 1) % size, (vert + 1) % size, 1, 1, true};
            _inner[vert] = vert;
        }
        _numInner = _numMade = size;
    }

    int GetNumInner() const { return _numInner; }
    int GetNumPoints() const { return _numLeft; }
    // How many faces vertex inner has so far, and where among its faces those that it has not begin.
    int GetNumFaces(int inner) const { return _verts[_inner[inner]].numFaces; }
    int GetFirstNewFace(int inner) const { return _verts[_inner[inner]].numFacesBefore; }

    // Adds the faces that vertex inner has not yet, of which getSize(face) tells the size.
    template <typename SIZE>
    bool Add(int inner, int numFaces, SIZE const &getSize) {
        if (inner >= _numInner) {
            return false;
        }
        int const vert = _inner[inner];
        int const numNew = numFaces - _verts[vert].numFaces;
        int const before = _verts[vert].before;
        int const behind = _verts[vert].behind;
        bool const isCenter = inner < _size;
        if (numNew < 0 || before == behind || (isCenter && !addInner(before))) {
            return false;
        }
        if (numNew == 0) {
            return join(before, behind);
        }
        int last = before;
        for (int i = 0; i < numNew; ++i) {
            ++_verts[last].numFaces;
            int const size = getSize(_verts[vert].numFacesBefore + i);
            bool const isLast = i + 1 == numNew;
            for (int k = isLast ? kTriangle : kTriangle - 1; k < size; ++k) {
                if (_numMade == kEndOfBytes) {
                    return false;
                }
                link(last, _numMade);
                last = _numMade++;
                _verts[last].numFaces = 1;
                ++_numLeft;
            }
            if (!isLast && isCenter && !addInner(last)) {
                return false;
            }
        }
        link(last, behind);
        ++_verts[behind].numFaces;
        if (isCenter && !_verts[behind].isInner) {
            return addInner(behind, 1);
        }
        ++_verts[behind].numFacesBefore;
        return true;
    }

private:
    struct Vertex {
        int before; // along the boundary
        int behind;
        int numFaces;
        int numFacesBefore; // from where its faces begin to the boundary before
        bool isInner;       // or will be
    };

    void link(int before, int behind) {
        _verts[before].behind = behind;
        _verts[behind].before = before;
    }

    // A neighbour of a vertex of the face.
    bool addInner(int vert) { return addInner(vert, _verts[vert].numFaces); }
    bool addInner(int vert, int numFacesBefore) {
        if (_verts[vert].isInner) {
            return true;
        }
        if (_numInner == PlainFaceKey::kMaxVerts) {
            return false;
        }
        _verts[vert].isInner = true;
        _verts[vert].numFacesBefore = numFacesBefore;
        _inner[_numInner++] = vert;
        return true;
    }

    // The vertex between them has all of its faces, so that they are the same.
    bool join(int before, int behind) {
        bool const isInner = _verts[behind].isInner;
        if (isInner && _verts[before].isInner) {
            return false;
        }
        if (isInner) {
            _verts[behind].numFaces += _verts[before].numFaces;
            _verts[behind].numFacesBefore += _verts[before].numFaces;
            link(_verts[before].before, behind);
        } else {
            _verts[before].numFaces += _verts[behind].numFaces;
            link(before, _verts[behind].behind);
        }
        --_numLeft;
        return true;
    }

    int const _size;
    int _numLeft;
    int _numInner;
    int _numMade;
    int _inner[PlainFaceKey::kMaxVerts] = {};
    Vertex _verts[kEndOfBytes] = {};
};

} // namespace

std::size_t PlainFaceKey::GetHash() const {
    constexpr std::size_t kWord = sizeof(std::uint64_t);
    static_assert(kMaxSize % kWord == 0);
    std::uint64_t hash = _size;
    for (std::size_t i = 0; i < _size; i += kWord) {
        std::uint64_t word = 0;
        std::memcpy(&word, _bytes + i, std::min(kWord, _size - i));
        hash = (hash ^ word) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 29;
    }
    return hash;
}

PlainFaceType::PlainFaceType(PlainFaceTypes &types, PlainFaceKey const &key, Patch patch)
    : hash(key.GetHash()), _types(types), _key(key.GetBytes(), key.GetBytes() + key.GetSize()),
      _patch(std::move(patch)), _isInLattice(isInLattice(key, _patch.numVerts)) {}

PlainFaceType::~PlainFaceType() { delete _rings.load(); }

bool PlainFaceType::HasKey(PlainFaceKey const &key) const {
    return key.GetSize() == _key.size() &&
           std::memcmp(key.GetBytes(), _key.data(), _key.size()) == 0;
}

// A vertex has its neighbours in the patch.
static_assert(PlainFaceKey::kMaxVerts <= InnerRings::kMaxFaces);

// Of threads that do so at once the first one makes it for all.
FaceRings const &PlainFaceType::makeRings() const {
    auto rings = std::make_unique<FaceRings const>(makeCell(false),
                                                   _types._types.GetRingCells(_types._rules));
    FaceRings const *expected = nullptr;
    if (_rings.compare_exchange_strong(expected, rings.get(), std::memory_order_acq_rel)) {
        return *rings.release();
    }
    return *expected;
}

// Threads that do so at once find the same.
CellType const &PlainFaceType::make() const {
    CellType const &type = _types._types.Find(makeCell(true), _types._rules);
    if (!_type.exchange(&type, std::memory_order_acq_rel)) {
        --_types._numUnmade;
    }
    return type;
}

CellPatch PlainFaceType::makeCell(bool hasSignature) const {
    std::vector<int> faceSizes;
    std::vector<Far::Index> faceVerts;
    faceSizes.reserve(_patch.faces.size());
    faceVerts.reserve(_patch.faces.size());
    for (std::size_t i = 0; i < _patch.faces.size(); i += 1 + _patch.faces[i]) {
        faceSizes.push_back(_patch.faces[i]);
        auto const first = _patch.faces.begin() + std::ptrdiff_t(i) + 1;
        faceVerts.insert(faceVerts.end(), first, first + _patch.faces[i]);
    }
    return FarExt::internal::MakePlainBaseCell(std::move(faceSizes), std::move(faceVerts),
                                               _patch.numVerts, GetNumPoints(), hasSignature);
}

namespace {

// Finds the vertices of a patch in another one, from a corner of both on; false where one of the patches has
// vertices that are the same, and the other has not.
bool findInPatch(CellPatch const &part, int firstCorner, CellPatch const &all, int firstOfAll,
                 std::vector<int> &verts) {
    constexpr int kNone = -1;
    FarExt::internal::LimitPatch const &patch = part.patch;
    PatchCorners const corners(patch);
    PatchCorners const ofAll(all.patch);
    std::vector<int> found(patch.faceVerts.size(), kNone); // by corner
    std::vector<int> ofVerts(all.patch.sources.size(), kNone);
    verts.assign(patch.sources.size(), kNone);
    // Of a face, from one of its corners on.
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
            int const other = all.patch.otherCorners[std::size_t(found[corner])];
            if (other < 0 || !add(next, other)) {
                return false;
            }
        }
    }
    return true;
}

} // namespace

CellType::BorderItem PlainFaceType::makeLatticeItem(CellPatch const &cell, int const *turns,
                                                    std::size_t item) const {
    auto const numEdges = std::size_t(cell.GetNumCorners());
    bool const isEdge = item < numEdges;
    LatticeItem const &lattice =
        _types._types.GetRingCells(_types._rules)
            .FindLatticeItem(isEdge ? CellKind::Edge : CellKind::Vertex, cell.GetNumCorners(), [&] {
                CellPatch patch = std::move(GatherBorder(cell, turns)[item]);
                CellType const &type = _types._types.Find(CellPatch(patch), _types._rules);
                return LatticeItem{std::move(patch), &type};
            });
    // The corner of the face, or of another one, that is the first of the item.
    PatchCorners const corners(cell.patch);
    auto corner = int(isEdge ? item : item - numEdges);
    for (int i = 0; i < turns[item]; ++i) {
        corner = isEdge ? cell.patch.otherCorners[std::size_t(corner)]
                        : corners.GetNext(cell.patch.otherCorners[std::size_t(corner)], 1);
    }
    CellType::BorderItem result = {lattice.type, {}, isEdge && turns[item] == 1, nullptr};
    return findInPatch(lattice.cell, lattice.cell.locals[0], cell, corner, result.points)
               ? result
               : Get().GetBorderItem(turns, item);
}

CellType::BorderItem const &PlainFaceType::GetLatticeItem(int const *turns,
                                                          std::size_t item) const {
    auto const get = [&](std::size_t i, auto const &make) -> CellType::BorderItem const & {
        return _latticeItems.Get<CellType::BorderItem>(int(i), turns + i, turns + i + 1, make);
    };
    return get(item, [&] {
        CellPatch const cell = makeCell(false);
        // The others are asked for, too.
        FaceRings const &rings = GetRings();
        int const numEdges = cell.GetNumCorners();
        for (int i = 0; i < 2 * numEdges; ++i) {
            bool const isInLattice =
                i < numEdges ? rings.IsEdgeInLattice(i) : rings.IsVertexInLattice(i - numEdges);
            if (isInLattice && std::size_t(i) != item) {
                get(std::size_t(i), [&] { return makeLatticeItem(cell, turns, std::size_t(i)); });
            }
        }
        return makeLatticeItem(cell, turns, item);
    });
}

PlainFaceType const &PlainFaceTypes::Add(PlainFaceKey const &key, PlainFaceType::Patch patch) {
    auto const [type, isNew] =
        _entries.Add(std::make_unique<PlainFaceType const>(*this, key, std::move(patch)),
                     [&](PlainFaceType const &other) { return other.HasKey(key); });
    if (isNew) {
        ++_numUnmade;
    }
    return *type;
}

// The faces of a vertex begin with one of them, or so many behind it.
bool PlainFaceGatherer::addVertex(Level const &level, std::vector<VertexMark> const &marks,
                                  Index vert, Index face, int turn) {
    Index const first = level.vertFirstFace[vert];
    int const numFaces = level.vertFirstFace[vert + 1] - first;
    if (_numVerts == PlainFaceKey::kMaxVerts || numFaces < kLeastFaces || numFaces >= kEndOfBytes ||
        (!marks.empty() && marks[std::size_t(vert)] == VertexMark::Feature)) {
        return false;
    }
    Index const *const faces = level.vertFaces.data() + first;
    int begin = 0;
    while (faces[begin] != face) {
        ++begin;
    }
    begin += turn;
    _verts[_numVerts++] = {vert, first, begin < numFaces ? begin : begin - numFaces, numFaces};
    return true;
}

// The vertices of the face and then, around one after the other, their neighbours: where the face across
// an edge is a triangle, the ends of the edge have a neighbour in common.
bool PlainFaceGatherer::findVertices(Level const &level, std::vector<VertexMark> const &marks,
                                     Index face) {
    Far::ConstIndexArray const centers = level.GetFaceVertices(face);
    _faceSize = centers.size();
    _numVerts = 0;
    for (Index const vert : centers) {
        if (!addVertex(level, marks, vert, face, 0)) {
            return false;
        }
    }
    for (int i = 0; i < _faceSize; ++i) {
        Vertex const &center = _verts[i];
        // The first two are neighbours in the face.
        int begin = 2;
        int end = center.numFaces;
        if (i > 0 && getFaceSize(level, center.GetPlace(1)) == kTriangle) {
            ++begin;
        }
        if (i + 1 == _faceSize && getFaceSize(level, center.GetPlace(end - 1)) == kTriangle) {
            --end;
        }
        for (int k = begin; k < end; ++k) {
            Index const place = center.GetPlace(k);
            if (!addVertex(level, marks, getNextVertex(level, place), level.vertFaces[place], 1)) {
                return false;
            }
        }
    }
    return true;
}

bool PlainFaceGatherer::findKey(Level const &level) {
    _key.Clear();
    _key.Add(_faceSize);
    int numSizes = 0;
    for (int i = 0; i < _numVerts; ++i) {
        _key.Add(_verts[i].numFaces);
        numSizes += _verts[i].numFaces;
    }
    _hasSizes = false;
    if (level.faceSizes.size() == 1) {
        return true;
    }
    if (_key.IsFull(numSizes)) {
        return false;
    }
    PlainFaceKey key;
    key.Add(_faceSize | kHasSizes);
    for (int i = 0; i < _numVerts; ++i) {
        key.Add(_verts[i].numFaces);
    }
    for (int i = 0; i < _numVerts; ++i) {
        for (int k = 0; k < _verts[i].numFaces; ++k) {
            int const size = getFaceSize(level, _verts[i].GetPlace(k));
            if (size >= kHasSizes) {
                return false;
            }
            _hasSizes = _hasSizes || size != _faceSize;
            key.Add(size);
        }
    }
    if (_hasSizes) {
        _key = key;
    }
    return true;
}

// Of a face at one of the vertices.
int PlainFaceGatherer::getSize(int vert, int face) const {
    if (!_hasSizes) {
        return _faceSize;
    }
    std::uint8_t const *size = _key.GetBytes() + 1 + _numVerts;
    for (int i = 0; i < vert; ++i) {
        size += _verts[i].numFaces;
    }
    return size[face];
}

// The points of a patch of this key, where no vertices are the same; -1 where there is none such.  The faces of
// a vertex that those before it have not are new.
int PlainFaceGatherer::countPoints(NewFaces *newFaces) const {
    GrowingPatch patch(_faceSize);
    for (int i = 0; i < _numVerts; ++i) {
        if (i >= patch.GetNumInner()) {
            return -1;
        }
        newFaces[i] = {patch.GetFirstNewFace(i), _verts[i].numFaces - patch.GetNumFaces(i)};
        if (!patch.Add(i, _verts[i].numFaces, [&](int face) { return getSize(i, face); })) {
            return -1;
        }
    }
    return patch.GetNumInner() == _numVerts ? patch.GetNumPoints() : -1;
}

// As LimitPatchGatherer::GatherCell() does.
PlainFaceType const *PlainFaceGatherer::addType(PlainFaceTypes &types, Level const &level) const {
    NewFaces newFaces[PlainFaceKey::kMaxVerts];
    int const numExpected = countPoints(newFaces);
    if (numExpected < 0) {
        return nullptr;
    }
    // The first vertex has the face itself.
    newFaces[0] = {0, newFaces[0].count + 1};
    // What it has taken of memory is kept for the next type.
    static thread_local IndexMap numbers;
    numbers.Clear();
    PlainFaceType::Patch patch = {_numVerts, {}, {}};
    patch.points.reserve(std::size_t(numExpected - _numVerts));
    patch.faces.reserve(kMaxFacesOfMost * (1 + std::size_t(_faceSize)));
    for (int i = 0; i < _numVerts; ++i) {
        numbers.FindOrSet(_verts[i].vert, i);
    }
    Index numPoints = _numVerts;
    for (int i = 0; i < _numVerts; ++i) {
        for (int k = newFaces[i].first; k < newFaces[i].first + newFaces[i].count; ++k) {
            Index const place = _verts[i].GetPlace(k);
            Index const face = level.vertFaces[place];
            Far::ConstIndexArray const verts = level.GetFaceVertices(face);
            int const size = verts.size();
            patch.faces.push_back(std::uint8_t(size));
            for (int corner = 0; corner < size; ++corner) {
                Index const local = level.vertFaceLocals[place] + corner;
                Index const number =
                    numbers.FindOrSet(verts[local < size ? local : local - size], numPoints);
                patch.faces.push_back(std::uint8_t(number));
                if (number == numPoints) {
                    if (++numPoints > numExpected) {
                        return nullptr;
                    }
                    patch.points.push_back(
                        {std::uint8_t(i), std::uint8_t(k), std::uint8_t(corner)});
                }
            }
        }
    }
    return numPoints == numExpected ? &types.Add(_key, std::move(patch)) : nullptr;
}

bool PlainFaceGatherer::areDistinct(Index const *points, int numPoints) {
    if (++_search == 0) {
        std::fill_n(_stamps, kNumStamps, std::uint16_t(0));
        ++_search;
    }
    std::uint16_t const search = _search;
    int numSame = 0;
    for (int i = 0; i < numPoints; ++i) {
        std::uint16_t &stamp = _stamps[std::size_t(points[i]) % kNumStamps];
        numSame += stamp == search ? 1 : 0;
        stamp = search;
    }
    if (numSame == 0) {
        return true;
    }
    // Others may end with the same digits.
    Index sorted[kEndOfBytes];
    std::copy_n(points, numPoints, sorted);
    std::sort(sorted, sorted + numPoints);
    return std::adjacent_find(sorted, sorted + numPoints) == sorted + numPoints;
}

PlainFaceType const *PlainFaceGatherer::Find(PlainFaceTypes &types, Level const &level,
                                             std::vector<VertexMark> const &marks, Index face,
                                             std::vector<Index> &points) {
    if (!findVertices(level, marks, face) || !findKey(level)) {
        return nullptr;
    }
    PlainFaceType const *type = types.Find(_key, _key.GetHash());
    if (!type) {
        type = addType(types, level);
        if (!type) {
            return nullptr;
        }
    }
    int const numPoints = type->GetNumPoints();
    points.resize(std::size_t(numPoints) + 2 * std::size_t(_faceSize));
    Index *to = points.data();
    for (int i = 0; i < _numVerts; ++i) {
        *to++ = _verts[i].vert;
    }
    // What is written might change the level for all that the compiler knows.
    Index const *const faces = level.vertFaces.data();
    auto const *const locals = level.vertFaceLocals.data();
    Index const *const firstCorners = level.faceFirstCorner.data();
    Index const *const faceVerts = level.faceVerts.data();
    for (PlainFaceType::Point const &point : type->GetPoints()) {
        Index const place = _verts[point.vert].GetPlace(point.place);
        Index const first = firstCorners[faces[place]];
        Index const end = firstCorners[faces[place] + 1];
        Index const corner = first + locals[place] + point.corner;
        *to++ = faceVerts[corner < end ? corner : corner - (end - first)];
    }
    if (!areDistinct(points.data(), numPoints)) {
        return nullptr;
    }
    Index const *const edges = level.faceEdges.data() + level.faceFirstCorner[face];
    for (int i = 0; i < _faceSize; ++i) {
        bool const isFirst =
            level.edgeFaces[edges[i]][0] == face && level.edgeFaceLocals[edges[i]][0] == i;
        to[i] = isFirst ? 0 : 1;
        to[_faceSize + i] = _verts[i].begin;
    }
    return type;
}

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "latticeWalk.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::Level;
using FarExt::internal::LimitPatch;
using FarExt::internal::VertexMark;

namespace {

// Control points of a face in a lattice; 0 where faces of the size make none.
int getNumLatticePoints(int faceSize) {
    return faceSize == 3 ? 27 : faceSize == 4 ? 32 : faceSize == 6 ? LatticeWalk::kMaxPoints : 0;
}

// Whether no two indices are the same.
bool areDistinct(Far::Index const *indices, int size) {
    constexpr unsigned kNumBits = 7;
    constexpr std::size_t kMask = (std::size_t(1) << kNumBits) - 1;
    Far::Index places[kMask + 1];
    std::fill_n(places, kMask + 1, Far::INDEX_INVALID);
    for (int i = 0; i < size; ++i) {
        auto place = std::size_t(std::uint32_t(indices[i]) * 0x9e3779b9U >> (32 - kNumBits));
        for (; places[place] != Far::INDEX_INVALID; place = (place + 1) & kMask) {
            if (places[place] == indices[i]) {
                return false;
            }
        }
        places[place] = indices[i];
    }
    return true;
}

} // namespace

bool LatticeWalk::HasWalk(CellType const &type) {
    return type.IsWhole() && type.IsInLattice() &&
           type.GetNumPoints() == getNumLatticePoints(type.GetNumCorners());
}

LatticeWalk::LatticeWalk(CellType const &type)
    : _faceSize(type.GetNumCorners()), _valence(CellType::GetLatticeValence(_faceSize)),
      _points(std::size_t(type.GetNumPoints())) {
    LimitPatch const &patch = type.GetCell().patch;
    auto const size = std::size_t(_faceSize);
    std::size_t const numFaces = patch.faceSizes.size();
    std::vector<std::uint8_t> order = {0};
    std::vector<int> places(numFaces, -1); // in that order
    places[0] = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t corner = 0; corner < size; ++corner) {
            Index const other = patch.otherCorners[order[i] * size + corner];
            auto const next = std::size_t(other) / size;
            if (other >= 0 && places[next] < 0) {
                places[next] = int(order.size());
                order.push_back(std::uint8_t(next));
                _steps.push_back({std::uint8_t(i), std::uint8_t(corner),
                                  std::uint8_t(std::size_t(other) % size)});
            }
        }
    }
    std::vector<int> numFacesAt(_points.size());
    for (std::size_t i = order.size(); i-- > 0;) {
        for (std::size_t corner = 0; corner < size; ++corner) {
            auto const point = std::size_t(patch.faceVerts[order[i] * size + corner]);
            _points[point] = {std::uint8_t(i), std::uint8_t(corner)};
            ++numFacesAt[point];
        }
    }
    for (std::size_t point = 0; point < _points.size(); ++point) {
        if (numFacesAt[point] == _valence) {
            _inner.push_back(std::uint8_t(point));
        }
    }
}

bool LatticeWalk::Gather(Level const &level, std::vector<VertexMark> const &marks, Index face,
                         Index *points, int *turns) const {
    // Of the faces: their first corners, and where in them the corners of the patch begin.
    struct Face {
        Index index;
        Index first;
        int begin;
    };
    Face faces[kMaxFaces];
    Face *next = faces;
    auto const addFace = [&](Index index, int begin) {
        *next++ = {index, level.faceFirstCorner[index], begin};
        return level.GetFaceSize(index) == _faceSize;
    };
    if (!addFace(face, 0)) {
        return false;
    }
    for (Step const &step : _steps) {
        Face const &from = faces[step.face];
        int const local = addCorners(from.begin, step.corner);
        Index const edge = level.faceEdges[from.first + local];
        FarExt::internal::IndexPair const &edgeFaces = level.edgeFaces[edge];
        FarExt::internal::LocalIndexPair const &locals = level.edgeFaceLocals[edge];
        std::size_t const side = edgeFaces[0] == from.index && locals[0] == local ? 1 : 0;
        if (edgeFaces[side] < 0 ||
            !addFace(edgeFaces[side], addCorners(locals[side], _faceSize - step.nextCorner))) {
            return false;
        }
    }
    Index *to = points;
    for (Point const &point : _points) {
        Face const &from = faces[point.face];
        *to++ = level.faceVerts[from.first + addCorners(from.begin, point.corner)];
    }
    if (!isOfType(level, marks, points)) {
        return false;
    }
    for (int i = 0; i < _faceSize; ++i) {
        Index const edge = level.faceEdges[faces[0].first + i];
        bool const isFirst = level.edgeFaces[edge][0] == face && level.edgeFaceLocals[edge][0] == i;
        turns[i] = isFirst ? 0 : 1;
        Index const *const vertFaces = level.vertFaces.data() + level.vertFirstFace[points[i]];
        turns[_faceSize + i] = int(std::find(vertFaces, vertFaces + _valence, face) - vertFaces);
    }
    return true;
}

// Where all inner vertices have as many faces as in the lattice, the way to a face is of no matter: the
// faces are those of the lattice, which is simply connected, but for vertices that are the same.
bool LatticeWalk::isOfType(Level const &level, std::vector<VertexMark> const &marks,
                           Index const *points) const {
    return std::all_of(_inner.begin(), _inner.end(),
                       [&](std::uint8_t inner) {
                           Index const vert = points[inner];
                           return level.GetNumVertexFaces(vert) == _valence &&
                                  (marks.empty() ||
                                   marks[std::size_t(vert)] != VertexMark::Feature);
                       }) &&
           areDistinct(points, GetNumPoints());
}

void LatticeWalks::Add(CellType const &type, FarExt::Interpolation interpolation) {
    if (!LatticeWalk::HasWalk(type)) {
        return;
    }
    auto entry = std::make_unique<Entry const>(Entry{&type, LatticeWalk(type)});
    std::lock_guard<std::mutex> const lock(_mutex);
    std::atomic<Entry const *> &found = _found[type.GetNumCorners()][std::size_t(interpolation)];
    if (!found.load(std::memory_order_relaxed)) {
        _entries.push_back(std::move(entry));
        found.store(_entries.back().get(), std::memory_order_release);
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

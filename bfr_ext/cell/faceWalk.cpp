// SPDX-License-Identifier: Apache-2.0
#include "faceWalk.h"

#include "far_ext/limit/limitRows.h"

#include <algorithm>
#include <utility>

namespace OpenSubdivHex::BfrExt::internal {

using namespace FarExt::internal;
using Sdc::Crease;

namespace {

// Faces at a vertex up to which surfaces are made where all are of one type: some seconds and 100 megabytes for all of
// them.
constexpr int kMaxFaces = 512;
// Vertices of a face: surfaces behind a first step have twice those of level 0.
constexpr int kMaxFaceSize = kMaxFacesAtLimit;
// Where each face is of a type of its own.  At a single sharp edge steps do not converge with some more.
constexpr int kMaxDifferentFaces = 128;
// Where semi-sharp edges make types of each level besides.
constexpr int kMaxSemiSharpFaces = 64;

// Adds fans that a patch has together.
class FanCounter {
public:
    void Add(FanItems const &fan) {
        for (FanItem const &item : fan.items) {
            if (item.isFace) {
                _numFaces += item.half <= 0 ? 1 : 0;
                continue;
            }
            _isUniform = _isUniform && (_numEdges == 0 || item.sharpness == _sharpness);
            _hasSemiSharp = _hasSemiSharp || (Crease::IsSharp(item.sharpness) &&
                                              !Crease::IsInfinite(item.sharpness));
            _sharpness = item.sharpness;
            ++_numEdges;
            _numSharp += Crease::IsSharp(item.sharpness) ? 1 : 0;
        }
        _isUniform = _isUniform && (fan.isClosed || _numSharp == _numEdges);
    }

    int GetNumFaces() const { return _numFaces; }
    int GetMaxFaces() const {
        return _isUniform ? kMaxFaces : _hasSemiSharp ? kMaxSemiSharpFaces : kMaxDifferentFaces;
    }

private:
    int _numFaces = 0;
    int _numEdges = 0;
    int _numSharp = 0;
    float _sharpness = 0;
    bool _isUniform = true;
    bool _hasSemiSharp = false;
};

} // namespace

void FaceWalk::findCrowds() {
    for (Index vert = 0; vert < _level.numVertices; ++vert) {
        if (_level.GetNumVertexFaces(vert) <= kMaxSemiSharpFaces) {
            continue;
        }
        int const size = _level.GetNumVertexFaces(vert);
        if (size > kMaxFacesApart) {
            _crowds.push_back({vert, Far::INDEX_INVALID, size, kMaxFaces});
            continue;
        }
        Crowd crowd = {vert, Far::INDEX_INVALID, 0, 0};
        auto const add = [&](FanCounter const &counter) {
            if (crowd.size == 0 && counter.GetNumFaces() > counter.GetMaxFaces()) {
                crowd.size = counter.GetNumFaces();
                crowd.maxSize = counter.GetMaxFaces();
            }
        };
        bool const isApart = ComesApart(_level, vert);
        FanCounter all;
        ForEachFanItems(_level, vert, [&](FanItems const &fan) {
            FanCounter one;
            one.Add(fan);
            all.Add(fan);
            add(isApart ? one : FanCounter());
        });
        add(isApart ? FanCounter() : all);
        if (crowd.size > 0) {
            _crowds.push_back(crowd);
        }
    }
    if (!_level.faceSizes.empty() && _level.faceSizes.back() <= kMaxFaceSize) {
        return;
    }
    for (Index face = 0; face < _level.numFaces; ++face) {
        if (_level.GetFaceSize(face) > kMaxFaceSize) {
            for (Index const vert : _level.GetFaceVertices(face)) {
                _crowds.push_back({vert, face, _level.GetFaceSize(face), kMaxFaceSize});
            }
        }
    }
    std::stable_sort(_crowds.begin(), _crowds.end(),
                     [](Crowd const &a, Crowd const &b) { return a.vert < b.vert; });
}

FaceWalk::Crowd const *FaceWalk::findCrowdAt(Index vert) const {
    auto const found =
        std::lower_bound(_crowds.begin(), _crowds.end(), vert,
                         [](Crowd const &crowd, Index index) { return crowd.vert < index; });
    return found != _crowds.end() && found->vert == vert ? &*found : nullptr;
}

FaceWalk::Crowd const *FaceWalk::FindCrowd(Index face) const {
    if (_crowds.empty()) {
        return nullptr;
    }
    Far::ConstIndexArray const verts = _level.GetFaceVertices(face);
    for (Index const vert : verts) {
        if (Crowd const *const crowd = findCrowdAt(vert)) {
            return crowd;
        }
    }
    for (Index const vert : verts) {
        for (Index const edge : _level.GetVertexEdges(vert)) {
            for (Index const end : _level.edgeVerts[edge]) {
                if (Crowd const *const crowd = findCrowdAt(end)) {
                    return crowd;
                }
            }
        }
    }
    return nullptr;
}

// A loop of several threads might take up work of its callers, which wait for this.
void FaceWalk::makeArrays() const {
    constexpr int kMinFaces = 3;
    Arrays arrays;
    Buffer<Index> &places = arrays.places;
    places.Resize(_level.faceVerts.size());
    for (std::size_t place = 0; place < places.size(); ++place) {
        places[std::size_t(_level.GetVertexCorner(Index(place)))] = Index(place);
    }
    arrays.nexts.Resize(places.size());
    for (Index face = 0; face < _level.numFaces; ++face) {
        Index const end = _level.faceFirstCorner[face + 1];
        Index before = end - 1;
        for (Index corner = _level.faceFirstCorner[face]; corner < end; before = corner++) {
            arrays.nexts[std::size_t(places[std::size_t(before)])] = {_level.faceVerts[corner],
                                                                      places[std::size_t(corner)]};
        }
    }
    arrays.fans.Resize(std::size_t(_level.numVertices));
    for (Index vert = 0; vert < _level.numVertices; ++vert) {
        int const numFaces = _level.GetNumVertexFaces(vert);
        bool const isPlain = kMinFaces <= numFaces && numFaces <= kMaxFaces && !IsAtFeature(vert);
        Index const first = _level.vertFirstFace[vert];
        arrays.fans[std::size_t(vert)] = {first, isPlain ? first + numFaces : first};
    }
    _arrays = std::move(arrays);
}

} // namespace OpenSubdivHex::BfrExt::internal

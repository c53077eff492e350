// SPDX-License-Identifier: Apache-2.0
#include "growingPatch.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::BfrExt::internal {

void GrowingPatch::Start(int size, bool keepsFaces) {
    for (int vert = 0; vert < size; ++vert) {
        _verts[vert] = {(vert + size - 1) % size, (vert + 1) % size, 1, 1, vert, kNone};
        _inner[vert] = vert;
    }
    _size = _numInner = _numMade = size;
    _keepsFaces = keepsFaces;
    _faces[0] = std::uint8_t(_size);
    std::iota(_faces + 1, _faces + 1 + _size, std::uint8_t(0));
    _numFaceBytes = 1 + _size;
    std::iota(_corners, _corners + _size, std::int16_t(0));
    std::fill_n(_others, _size, std::int16_t(kNone));
    _numCorners = _size;
}

bool GrowingPatch::Add(int inner, int numFaces, std::uint8_t const *sizes) {
    if (inner >= _numInner) {
        return false;
    }
    int const vert = _inner[inner];
    Vertex const &center = _verts[vert];
    int const numNew = numFaces - center.numFaces;
    int const before = center.before;
    int const behind = center.behind;
    // The neighbours of the first face's vertices are inner.
    bool const hasInnerNeighbors = inner < _size;
    if (numNew < 0 || before == behind ||
        (hasInnerNeighbors && !addInner(before, _verts[before].numFaces))) {
        return false;
    }
    if (numNew == 0) {
        if (_keepsFaces) {
            joinEdges(_corners[before], _corners[vert]);
        }
        return join(before, behind);
    }
    int last = before;
    for (int i = 0; i < numNew; ++i) {
        ++_verts[last].numFaces;
        int const place = center.numFacesBefore + i;
        int const size = sizes ? sizes[place] : _size;
        bool const isLast = i + 1 == numNew;
        int const first = last;
        int const firstMade = _numMade;
        for (int corner = 2; corner < (isLast ? size - 1 : size); ++corner) {
            if (!addVertex(last,
                           {std::uint8_t(inner), std::uint8_t(place), std::uint8_t(corner)})) {
                return false;
            }
            last = _numMade - 1;
        }
        if (_keepsFaces) {
            keepFace(vert, first, firstMade, isLast ? behind : kNone);
        }
        if (!isLast && hasInnerNeighbors && !addInner(last, _verts[last].numFaces)) {
            return false;
        }
    }
    link(last, behind);
    ++_verts[behind].numFaces;
    if (hasInnerNeighbors && !isInner(behind)) {
        return addInner(behind, 1);
    }
    ++_verts[behind].numFacesBefore;
    return true;
}

bool GrowingPatch::addInner(int vert, int numFacesBefore) {
    if (isInner(vert)) {
        return true;
    }
    if (_numInner == kMaxInner) {
        return false;
    }
    _verts[vert].inner = _numInner;
    _verts[vert].numFacesBefore = numFacesBefore;
    _inner[_numInner++] = vert;
    return true;
}

// On the boundary, behind the last one.
bool GrowingPatch::addVertex(int last, Point const &point) {
    if (_numMade == kMaxVerts) {
        return false;
    }
    _verts[_numMade] = {kNone, kNone, 1, 0, kNone, kNone};
    _points[_numMade] = point;
    link(last, _numMade++);
    return true;
}

// The vertex between them has all of its faces, so that they are the same.
bool GrowingPatch::join(int before, int behind) {
    if (isInner(before) && isInner(behind)) {
        return false;
    }
    // One that is inner stays, else the first that was met.
    bool const behindStays = isInner(behind) || (!isInner(before) && behind < before);
    int const kept = behindStays ? behind : before;
    int const gone = behindStays ? before : behind;
    if (behindStays) {
        _verts[kept].numFacesBefore += _verts[gone].numFaces;
        link(_verts[gone].before, kept);
    } else {
        link(kept, _verts[gone].behind);
        _corners[kept] = _corners[gone];
    }
    _verts[kept].numFaces += _verts[gone].numFaces;
    _verts[gone].same = kept;
    return true;
}

// A face at a vertex: that, the one before on the boundary, those made for it, and the one behind, if it is the last face
// there.
void GrowingPatch::keepFace(int vert, int last, int firstMade, int behind) {
    std::uint8_t *const face = _faces + _numFaceBytes;
    std::uint8_t *to = face + 1;
    int const first = _numCorners;
    auto const add = [&](int ofFace) {
        *to++ = std::uint8_t(ofFace);
        _others[_numCorners++] = std::int16_t(kNone);
    };
    add(vert);
    joinEdges(first, _corners[last]);
    // The other edges, and that to the vertex where another face follows, are on the boundary.
    auto const addOnBoundary = [&](int ofFace) {
        _corners[ofFace] = std::int16_t(_numCorners);
        add(ofFace);
    };
    addOnBoundary(last);
    for (int made = firstMade; made < _numMade; ++made) {
        addOnBoundary(made);
    }
    if (behind != kNone) {
        add(behind);
        joinEdges(_numCorners - 1, _corners[vert]);
    }
    face[0] = std::uint8_t(_numCorners - first);
    _numFaceBytes = int(to - _faces);
}

GrowingPatch::Run *GrowingPatch::GetRuns(Run *runs) const {
    Run *end = runs;
    for (int vert = _size; vert < _numMade; ++vert) {
        if (!isPoint(vert)) {
            continue;
        }
        Point const &point = _points[vert];
        Run *const last = end - 1;
        if (end != runs && point.vert == last->first.vert && point.place == last->first.place &&
            point.corner == last->first.corner + last->numPoints) {
            ++last->numPoints;
        } else {
            *end++ = {point, 1};
        }
    }
    return end;
}

void GrowingPatch::GetFaces(std::vector<int> &sizes, std::vector<int> &verts,
                            std::vector<int> &others) const {
    others.assign(_others, _others + _numCorners);
    int numbers[kMaxVerts] = {};
    int numPoints = 0;
    for (int vert = 0; vert < _numMade; ++vert) {
        numbers[vert] = isInner(vert)   ? _verts[vert].inner
                        : isPoint(vert) ? _numInner + numPoints++
                                        : kNone;
    }
    verts.resize(std::size_t(_numCorners));
    sizes.resize(std::size_t(_numFaceBytes - _numCorners));
    int *toSize = sizes.data();
    int *toVert = verts.data();
    for (std::uint8_t const *face = _faces; face != _faces + _numFaceBytes; face += 1 + face[0]) {
        *toSize++ = face[0];
        for (int i = 1; i <= face[0]; ++i) {
            int vert = face[i];
            while (numbers[vert] == kNone) {
                vert = _verts[vert].same;
            }
            *toVert++ = numbers[vert];
        }
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

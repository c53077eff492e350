// SPDX-License-Identifier: Apache-2.0
#include "regularFaces.h"

#include "plainNeighborhood.h"
#include "rowSteps.h"

#include "far_ext/vtr/parallel.h"

#include <bitset>
#include <cmath>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

constexpr int kSize = kRegularFaceSize;
constexpr unsigned kAllCorners = (1u << kSize) - 1;

// Least number of own vertices for which a face gives the limit: fewer are made as fast one by one.
constexpr int kMinOwnVertices = 3;

// Marks of vertices, which several threads set.
using Marks = std::vector<unsigned char>;

// Which vertices of a level are regular.  V-vertices of regular vertices are, and F-vertices of
// regular faces: only the others are looked at.
Marks markRegular(Level const &level, Level const *parent, Marks const &pMarks,
                  std::vector<RegularFace> const &pFaces) {
    Marks marks(std::size_t(level.numVertices), 0);
    if (parent) {
        std::copy(pMarks.begin(), pMarks.end(), marks.begin());
        for (RegularFace const &face : pFaces) {
            std::fill_n(marks.begin() + parent->numVertices + face.firstCorner, kSize, 1);
        }
    }
    PlainNeighborhoodGatherer const gatherer(level);
    ParallelFor(level.numVertices, [&](Index vert) {
        unsigned char &mark = marks[std::size_t(vert)];
        if (!mark) {
            mark = gatherer.IsRegular(vert);
        }
    });
    return marks;
}

// The corner some places further around a hexagon.
Index getCornerBehind(Level const &level, FaceCorner const &at, int places) {
    Index const first = level.faceFirstCorner[at.face];
    return first + (at.corner - first + places) % kSize;
}

RegularFace gather(Level const &level, Index face, unsigned corners) {
    RegularFace result;
    result.firstCorner = level.faceFirstCorner[face];
    result.corners = corners;
    for (int i = 0; i < kSize; ++i) {
        // It runs the edge back: from vertex i + 1 of the face to vertex i, to the neighbour of that.
        FaceCorner const across = level.GetCornerAcross(result.firstCorner + i);
        int const next = (i + 1) % kSize;
        result.neighbors[i] = level.faceVerts[getCornerBehind(level, across, 2)];
        result.next[i] = level.faceVerts[getCornerBehind(level, across, 3)];
        result.previous[next] = level.faceVerts[getCornerBehind(level, across, 4)];
        result.beyond[i] = result.HasCorner(i)
                               ? level.GetCornerAcross(getCornerBehind(level, across, 2)).face
                               : face;
    }
    return result;
}

// The faces for which findCorners(face) finds any corners, where the face gives a limit.
template <typename FIND_CORNERS>
std::vector<RegularFace> findFaces(Level const &level, Index numFaces, FIND_CORNERS findCorners) {
    std::vector<Index> const faces =
        ParallelSelect(numFaces, [&](Index face) { return findCorners(face) != 0; });
    std::vector<RegularFace> result(faces.size());
    ParallelFor(Index(faces.size()), [&](Index i) {
        Index const face = faces[std::size_t(i)];
        result[std::size_t(i)] = gather(level, face, findCorners(face));
    });
    return result;
}

// A bit for each vertex of a hexagon that is regular.
unsigned findRegularCorners(Level const &level, Marks const &marks, Index face) {
    Far::ConstIndexArray const verts = level.GetFaceVertices(face);
    unsigned corners = 0;
    for (int i = 0; i < kSize && verts.size() == kSize; ++i) {
        corners |= unsigned(marks[std::size_t(verts[i])] != 0) << i;
    }
    return corners;
}

bool isAmongHexagons(Level const &level, Index face) {
    for (Index const edge : Far::ConstIndexArray(
             level.faceEdges.data() + level.faceFirstCorner[face], level.GetFaceSize(face))) {
        if (level.IsBoundary(edge) || level.GetFaceSize(level.edgeFaces[edge][0]) != kSize ||
            level.GetFaceSize(level.edgeFaces[edge][1]) != kSize) {
            return false;
        }
    }
    return true;
}

std::vector<RegularFace> findRegularFaces(Level const &level, Marks const &marks) {
    return findFaces(level, level.numFaces, [&](Index face) {
        return findRegularCorners(level, marks, face) == kAllCorners ? kAllCorners : 0u;
    });
}

// F-faces that give the limit of vertices of their own, but for those of regular faces.
std::vector<RegularFace> findOwnFaces(Level const &level, Marks const &marks,
                                      std::vector<RegularFace> const &pFaces) {
    Marks isOfRegular(std::size_t(level.numFFaceCorners), 0);
    for (RegularFace const &face : pFaces) {
        isOfRegular[std::size_t(face.firstCorner)] = 1;
    }
    return findFaces(level, level.numFFaces, [&](Index face) {
        unsigned const corners = findRegularCorners(level, marks, face);
        bool const isFound = std::bitset<kSize>(corners).count() >= kMinOwnVertices &&
                             isOfRegular[std::size_t(level.faceFirstCorner[face])] == 0 &&
                             isAmongHexagons(level, face);
        return isFound ? corners : 0u;
    });
}

// Whether a face's sources are all different, so that a row of their weights tells each one's: not
// so on small tori, which have no other end.
bool hasDifferentSources(Level const &level, RegularFace const &face, int corner) {
    std::vector<Index> sources = {face.GetOther(level, corner, 1)};
    for (int i = 0; i < kSize; ++i) {
        sources.insert(sources.end(), {level.faceVerts[face.firstCorner + i], face.neighbors[i],
                                       face.next[i], face.previous[i]});
    }
    std::sort(sources.begin(), sources.end());
    return std::adjacent_find(sources.begin(), sources.end()) == sources.end();
}

// The mask that makes the row of a corner.
RegularFaceMask makeMask(Level const &level, RegularFace const &face, int corner,
                         SteppedRow const &row) {
    auto const find = [&](Index vert, int sum) {
        auto const found = row.find(vert);
        return found == row.end() ? 0 : found->second[std::size_t(sum)];
    };
    RegularFaceMask mask;
    for (int sum = 0; sum < RegularFaceMask::kNumSums; ++sum) {
        RegularFaceMask::Sum &result = mask.sums[sum];
        for (int i = 0; i < kSize; ++i) {
            int const at = (corner + i) % kSize;
            result.verts[i] = find(level.faceVerts[face.firstCorner + at], sum);
            result.neighbors[i] = find(face.neighbors[at], sum);
            result.pairs[i] = find(i == 0 ? face.previous[(at + 1) % kSize] : face.next[at], sum);
        }
        result.next = find(face.next[corner], sum) - result.pairs[0];
        result.previous = find(face.previous[corner], sum) - result.pairs[kSize - 1];
        result.others = find(face.GetOther(level, corner, 1), sum);
    }
    return mask;
}

// Whether the mask makes the row of a corner.
bool isRow(Level const &level, RegularFace const &face, RegularFaceMask const &mask, int corner,
           SteppedRow row) {
    auto const subtract = [&](Index vert, auto const &getWeight) {
        LimitWeights &left = row[vert];
        for (int sum = 0; sum < RegularFaceMask::kNumSums; ++sum) {
            left[std::size_t(sum)] -= getWeight(mask.sums[sum]);
        }
    };
    using Sum = RegularFaceMask::Sum;
    for (int i = 0; i < kSize; ++i) {
        int const at = (corner + i) % kSize;
        subtract(level.faceVerts[face.firstCorner + at], [i](Sum const &s) { return s.verts[i]; });
        subtract(face.neighbors[at], [i](Sum const &s) { return s.neighbors[i]; });
        subtract(face.next[at], [i](Sum const &s) { return s.pairs[i]; });
        subtract(face.previous[(at + 1) % kSize], [i](Sum const &s) { return s.pairs[i]; });
    }
    subtract(face.next[corner], [](Sum const &s) { return s.next; });
    subtract(face.previous[corner], [](Sum const &s) { return s.previous; });
    for (int i = 0; i < RegularFace::kNumOthers; ++i) {
        subtract(face.GetOther(level, corner, i), [](Sum const &s) { return s.others; });
    }
    return std::all_of(row.begin(), row.end(), [](SteppedRow::value_type const &left) {
        return std::all_of(left.second.begin(), left.second.end(),
                           [](double weight) { return std::abs(weight) < kWeightTolerance; });
    });
}

} // namespace

RegularFaces::RegularFaces(MeshLevels const &mesh, int level, std::vector<unsigned char> isMade)
    : _mesh(mesh), _level(level), _isMade(std::move(isMade)), _levels(std::size_t(level) + 1) {
    if (!_isMade.empty() &&
        std::all_of(_isMade.begin(), _isMade.end(), [](unsigned char mark) { return mark != 0; })) {
        return;
    }
    // Vertices keep their index in hexagonal steps.
    int first = level;
    while (first > 0 && mesh.levels[std::size_t(first)].isHexagonal) {
        --first;
    }
    Marks marks;
    std::vector<RegularFace> const none;
    for (int i = first; i <= level; ++i) {
        Level const &ofFaces = mesh.levels[std::size_t(i)];
        Level const *const parent = i == first ? nullptr : &mesh.levels[std::size_t(i) - 1];
        std::vector<RegularFace> const &pFaces =
            parent ? _levels[std::size_t(i) - 1].fVertices.faces : none;
        marks = markRegular(ofFaces, parent, marks, pFaces);
        OfLevel &ofLevel = _levels[std::size_t(i)];
        if (parent) {
            setFaces(i, findOwnFaces(ofFaces, marks, pFaces), parent->numVertices,
                     ofLevel.ownVertices);
        }
        if (i < level) {
            setFaces(i, findRegularFaces(ofFaces, marks), ofFaces.numVertices, ofLevel.fVertices);
        }
    }
    listOthers();
}

// Sets the faces of a level that give any limit, unless there is no sample of them.
void RegularFaces::setFaces(int level, std::vector<RegularFace> faces, Index firstVertex,
                            Set &set) const {
    set.firstVertex = firstVertex;
    if (!_isMade.empty()) {
        faces.erase(std::remove_if(
                        faces.begin(), faces.end(),
                        [&](RegularFace const &face) { return makesNothing(face, firstVertex); }),
                    faces.end());
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (int corner = 0; corner < kSize; ++corner) {
            if (faces[i].HasCorner(corner) &&
                hasDifferentSources(_mesh.levels[std::size_t(level)], faces[i], corner)) {
                set.sample = i;
                set.sampleCorner = corner;
                set.faces = std::move(faces);
                return;
            }
        }
    }
}

bool RegularFaces::makesNothing(RegularFace const &face, Index firstVertex) const {
    auto const isMade = _isMade.begin() + firstVertex + face.firstCorner;
    for (int corner = 0; corner < kSize; ++corner) {
        if (face.HasCorner(corner) && !isMade[corner]) {
            return false;
        }
    }
    return true;
}

void RegularFaces::listOthers() {
    Marks isMade(std::size_t(_mesh.levels[std::size_t(_level)].numVertices), 0);
    for (OfLevel const &level : _levels) {
        for (Set const *set : {&level.fVertices, &level.ownVertices}) {
            for (RegularFace const &face : set->faces) {
                auto const firstVertex = isMade.begin() + set->firstVertex + face.firstCorner;
                for (int corner = 0; corner < kSize; ++corner) {
                    firstVertex[corner] = face.HasCorner(corner);
                }
            }
        }
    }
    for (std::size_t vert = 0; vert < _isMade.size(); ++vert) {
        isMade[vert] |= _isMade[vert];
    }
    _others = ParallelSelect(Index(isMade.size()),
                             [&](Index vert) { return isMade[std::size_t(vert)] == 0; });
}

CallStatus RegularFaces::FindMasks(HexSchemeOptions const &schemeOptions, LimitRows &rows) {
    std::vector<Index> verts = _others;
    for (OfLevel const &level : _levels) {
        for (Set const *set : {&level.fVertices, &level.ownVertices}) {
            for (int corner = 0; corner < kSize && !set->faces.empty(); ++corner) {
                RegularFace const &face = set->faces[set->sample];
                if (face.HasCorner(corner)) {
                    verts.push_back(set->firstVertex + face.firstCorner + corner);
                }
            }
        }
    }
    std::sort(verts.begin(), verts.end());
    CallStatus status = rows.Find(verts);
    if (!status.IsOk()) {
        return status;
    }
    for (std::size_t i = 0; i < _levels.size(); ++i) {
        for (Set *set : {&_levels[i].fVertices, &_levels[i].ownVertices}) {
            if (set->faces.empty()) {
                continue;
            }
            if (auto const mask = findMask(int(i), *set, schemeOptions, rows)) {
                set->mask = *mask;
                continue;
            }
            for (OfLevel &level : _levels) {
                level = OfLevel();
            }
            listOthers();
            return rows.Find(_others);
        }
    }
    return CallStatus();
}

std::optional<RegularFaceMask> RegularFaces::findMask(int level, Set const &set,
                                                      HexSchemeOptions const &schemeOptions,
                                                      LimitRows const &rows) const {
    Level const &ofFace = _mesh.levels[std::size_t(level)];
    RegularFace const &face = set.faces[set.sample];
    std::optional<RegularFaceMask> mask;
    for (int i = 0; i < kSize; ++i) {
        int const corner = (set.sampleCorner + i) % kSize;
        if (!face.HasCorner(corner)) {
            continue;
        }
        Index sources[PlainNeighborhoodGatherer::kNumRegular];
        LimitRow const ofVertex =
            rows.GetRow(set.firstVertex + face.firstCorner + corner, 0, sources);
        SteppedRow const row = StepRowBack(_mesh, schemeOptions, ofVertex, _level, level);
        if (!mask) {
            mask = makeMask(ofFace, face, corner, row);
        }
        if (!isRow(ofFace, face, *mask, corner, row)) {
            return {};
        }
    }
    return mask;
}

} // namespace OpenSubdivHex::FarExt::internal

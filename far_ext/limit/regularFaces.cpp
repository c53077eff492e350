// SPDX-License-Identifier: Apache-2.0
#include "regularFaces.h"

#include "plainNeighborhood.h"

#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/refinementMask.h"

#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

constexpr int kSize = kRegularFaceSize;

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
    std::vector<VertexMark> const vertexMarks = MarkFeatures(level);
    PlainNeighborhoodGatherer const gatherer(level);
    ParallelFor(level.numVertices, [&](Index vert) {
        unsigned char &mark = marks[std::size_t(vert)];
        if (!mark) {
            mark = gatherer.IsRegular(vert, vertexMarks);
        }
    });
    return marks;
}

// An edge of a face as the face across has it.
struct OtherSide {
    OtherSide(Level const &level, Index ofFace, Index corner) {
        Index const edge = level.faceEdges[corner];
        int const side = level.edgeFaces[edge][0] == ofFace ? 1 : 0;
        face = level.edgeFaces[edge][side];
        first = level.faceFirstCorner[face];
        local = level.edgeFaceLocals[edge][side];
    }

    // The corner some places further around the face, a hexagon.
    Index GetCorner(int places) const { return first + (local + places) % kSize; }

    Index face;
    Index first;
    int local;
};

RegularFace gather(Level const &level, Index face) {
    RegularFace result;
    result.firstCorner = level.faceFirstCorner[face];
    for (int i = 0; i < kSize; ++i) {
        // It runs the edge back: from vertex i + 1 of the face to vertex i, to the neighbour of that.
        OtherSide const across(level, face, result.firstCorner + i);
        int const next = (i + 1) % kSize;
        result.neighbors[i] = level.faceVerts[across.GetCorner(2)];
        result.next[i] = level.faceVerts[across.GetCorner(3)];
        result.previous[next] = level.faceVerts[across.GetCorner(4)];
        result.beyond[i] = OtherSide(level, across.face, across.GetCorner(2)).face;
    }
    return result;
}

std::vector<RegularFace> findFaces(Level const &level, Marks const &marks) {
    std::vector<Index> const faces = ParallelSelect(level.numFaces, [&](Index face) {
        auto const isRegular = [&](Index vert) { return marks[std::size_t(vert)] != 0; };
        Far::ConstIndexArray const verts = level.GetFaceVertices(face);
        return verts.size() == kSize && std::all_of(verts.begin(), verts.end(), isRegular);
    });
    std::vector<RegularFace> result(faces.size());
    ParallelFor(Index(faces.size()),
                [&](Index i) { result[std::size_t(i)] = gather(level, faces[std::size_t(i)]); });
    return result;
}

// Of the hexagon beyond the neighbour of a corner, the vertex that is in no other face that matters.
Index findFarthest(Level const &level, RegularFace const &face, int corner) {
    Index const *const verts = level.faceVerts.data() + level.faceFirstCorner[face.beyond[corner]];
    auto const local = int(std::find(verts, verts + kSize, face.neighbors[corner]) - verts);
    return verts[(local + kSize / 2) % kSize];
}

// Whether a face's sources are all different, so that a row of their weights tells each one's: not
// so on small tori, which have no other end.
bool hasDifferentSources(Level const &level, RegularFace const &face) {
    std::vector<Index> sources = {findFarthest(level, face, 0)};
    for (int i = 0; i < kSize; ++i) {
        sources.insert(sources.end(), {level.faceVerts[face.firstCorner + i], face.neighbors[i],
                                       face.next[i], face.previous[i]});
    }
    std::sort(sources.begin(), sources.end());
    return std::adjacent_find(sources.begin(), sources.end()) == sources.end();
}

// Weights of vertices of a level for the three sums of a row.
using Weights = std::array<double, RegularFaceMask::kNumSums>;
using Row = std::map<Index, Weights>;

void addTo(Row &row, Index vert, Weights const &weights, double factor) {
    Weights &sum = row[vert];
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum[i] += factor * weights[i];
    }
}

// The row in terms of the vertices of the parent.
Row stepBack(Row const &cRow, Refinement const &refinement, RefinementMask const &mask) {
    Level const &parent = *refinement.parent;
    Row row;
    std::vector<double> scratch;
    auto const addFVertex = [&](Index corner, Weights const &weights, double factor) {
        Index const face = parent.FindFaceOfCorner(corner);
        Index const first = parent.faceFirstCorner[face];
        double const *const ofFace = mask.GetFaceVertexWeights(face, corner - first, scratch);
        for (int i = 0; i < parent.GetFaceSize(face); ++i) {
            addTo(row, parent.faceVerts[first + i], weights, factor * ofFace[i]);
        }
    };
    for (auto const &[vert, weights] : cRow) {
        if (vert >= refinement.child->numVVertices) {
            addFVertex(refinement.GetChildVertexCorner(vert), weights, 1);
            continue;
        }
        Index const pVert = refinement.GetVVertexParent(vert);
        RefinementMask::VertexMask const ofVertex = mask.GetVertexMask(pVert);
        for (int i = 0; i < ofVertex.numSources; ++i) {
            addTo(row, ofVertex.sources[i], weights, ofVertex.weights[i]);
        }
        for (Index k = parent.vertFirstFace[pVert]; k < parent.vertFirstFace[pVert + 1]; ++k) {
            addFVertex(parent.GetVertexCorner(k), weights, ofVertex.faceWeight);
        }
    }
    return row;
}

// Of the largest weights, which are about 1: those of the masks of limits are less exact than sums of
// them.
constexpr double kTolerance = 1e-9;

// The mask that makes a row of the F-vertex of corner 0.
RegularFaceMask makeMask(Level const &level, RegularFace const &face, Row const &row) {
    auto const find = [&](Index vert, int sum) {
        auto const found = row.find(vert);
        return found == row.end() ? 0 : found->second[std::size_t(sum)];
    };
    Index const farthest = findFarthest(level, face, 0);
    RegularFaceMask mask;
    mask.beyondOfTip = 0;
    for (int sum = 0; sum < RegularFaceMask::kNumSums; ++sum) {
        RegularFaceMask::Sum &result = mask.sums[sum];
        for (int i = 0; i < kSize; ++i) {
            result.verts[i] = find(level.faceVerts[face.firstCorner + i], sum);
            result.neighbors[i] = find(face.neighbors[i], sum);
            result.pairs[i] = i == 0 ? find(face.previous[1], sum) : find(face.next[i], sum);
        }
        double const ofBeyond = find(farthest, sum);
        result.neighbors[0] -= ofBeyond;
        result.tip = find(face.next[0], sum) - result.pairs[0] - ofBeyond;
        if (sum == 0) {
            mask.beyondOfTip = ofBeyond / result.tip;
        }
    }
    return mask;
}

// Whether the mask makes the row of the F-vertex of a corner.
bool isRow(Level const &level, RegularFace const &face, RegularFaceMask const &mask, int corner,
           Row row) {
    auto const subtract = [&](Index vert, auto const &getWeight) {
        Weights &left = row[vert];
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
    subtract(face.next[corner], [](Sum const &s) { return s.tip; });
    subtract(face.previous[corner], [](Sum const &s) { return s.tip; });
    for (Index vert : level.GetFaceVertices(face.beyond[corner])) {
        subtract(vert, [&](Sum const &s) { return s.tip * mask.beyondOfTip; });
    }
    return std::all_of(row.begin(), row.end(), [](Row::value_type const &left) {
        return std::all_of(left.second.begin(), left.second.end(),
                           [](double weight) { return std::abs(weight) < kTolerance; });
    });
}

// Where the sources of a row begin, behind the vertices of the face.
constexpr int kNeighbors = kSize;
constexpr int kNext = 2 * kSize;
constexpr int kPrevious = 3 * kSize;
constexpr int kBeyond = 4 * kSize;

} // namespace

RegularFaceRows::RegularFaceRows(RegularFaceMask const &mask) {
    for (int i = 0; i < RegularFaceMask::kNumSums; ++i) {
        RegularFaceMask::Sum const &sum = mask.sums[i];
        double *const weights = _weights[i];
        double const ofBeyond = mask.beyondOfTip * sum.tip;
        for (int k = 0; k < kSize; ++k) {
            weights[k] = sum.verts[k];
            weights[kNeighbors + k] = sum.neighbors[k];
            weights[kNext + k] = sum.pairs[k];
            weights[kPrevious + k] = sum.pairs[(k + kSize - 1) % kSize];
        }
        weights[kNeighbors] += ofBeyond;
        weights[kNext] += sum.tip + ofBeyond;
        weights[kPrevious] += sum.tip + ofBeyond;
        std::fill(weights + kBeyond, weights + kNumSources, ofBeyond);
    }
}

LimitRow RegularFaceRows::GetRow(Level const &level, RegularFace const &face, int corner,
                                 Index sources[kNumSources]) const {
    for (int k = 0; k < kSize; ++k) {
        int const at = (corner + k) % kSize;
        sources[k] = level.faceVerts[face.firstCorner + at];
        sources[kNeighbors + k] = face.neighbors[at];
        sources[kNext + k] = face.next[at];
        sources[kPrevious + k] = face.previous[at];
    }
    Index *rest = sources + kBeyond;
    for (Index const vert : level.GetFaceVertices(face.beyond[corner])) {
        if (vert != face.neighbors[corner] && vert != face.next[corner] &&
            vert != face.previous[corner]) {
            *rest++ = vert;
        }
    }
    return {kNumSources, sources, _weights[0], _weights[1], _weights[2]};
}

RegularFaces::RegularFaces(MeshLevels const &mesh, int level) : _mesh(mesh), _level(level) {
    // Vertices keep their index in hexagonal steps.
    int first = level;
    while (first > 0 && mesh.levels[std::size_t(first)].isHexagonal) {
        --first;
    }
    _levels.resize(std::size_t(level));
    Marks marks;
    for (int i = first; i < level; ++i) {
        Level const &ofFaces = mesh.levels[std::size_t(i)];
        bool const isFirst = i == first;
        marks =
            markRegular(ofFaces, isFirst ? nullptr : &mesh.levels[std::size_t(i) - 1], marks,
                        isFirst ? std::vector<RegularFace>() : _levels[std::size_t(i) - 1].faces);
        OfLevel &ofLevel = _levels[std::size_t(i)];
        ofLevel.faces = findFaces(ofFaces, marks);
        auto const sample =
            std::find_if(ofLevel.faces.begin(), ofLevel.faces.end(), [&](RegularFace const &face) {
                return hasDifferentSources(ofFaces, face);
            });
        ofLevel.sample = std::size_t(sample - ofLevel.faces.begin());
        if (sample == ofLevel.faces.end()) {
            ofLevel.faces.clear();
        }
    }
    listOthers();
}

void RegularFaces::listOthers() {
    Marks isMade(std::size_t(_mesh.levels[std::size_t(_level)].numVertices), 0);
    for (std::size_t i = 0; i < _levels.size(); ++i) {
        for (RegularFace const &face : _levels[i].faces) {
            std::fill_n(isMade.begin() + _mesh.levels[i].numVertices + face.firstCorner, kSize, 1);
        }
    }
    _others = ParallelSelect(Index(isMade.size()),
                             [&](Index vert) { return isMade[std::size_t(vert)] == 0; });
}

Status RegularFaces::FindMasks(HexSchemeOptions const &schemeOptions, LimitRows &rows) {
    std::vector<Index> verts = _others;
    for (std::size_t i = 0; i < _levels.size(); ++i) {
        if (!_levels[i].faces.empty()) {
            verts.resize(verts.size() + kSize);
            std::iota(verts.end() - kSize, verts.end(),
                      _mesh.levels[i].numVertices +
                          _levels[i].faces[_levels[i].sample].firstCorner);
        }
    }
    std::sort(verts.begin(), verts.end());
    Status status = rows.Find(verts);
    if (!status.IsOk()) {
        return status;
    }
    for (std::size_t i = 0; i < _levels.size(); ++i) {
        if (_levels[i].faces.empty()) {
            continue;
        }
        if (auto const mask = findMask(int(i), schemeOptions, rows)) {
            _levels[i].mask = *mask;
            continue;
        }
        for (OfLevel &level : _levels) {
            level.faces.clear();
        }
        listOthers();
        return rows.Find(_others);
    }
    return Status();
}

std::optional<RegularFaceMask> RegularFaces::findMask(int level,
                                                      HexSchemeOptions const &schemeOptions,
                                                      LimitRows const &rows) const {
    Level const &ofFace = _mesh.levels[std::size_t(level)];
    OfLevel const &ofLevel = _levels[std::size_t(level)];
    RegularFace const &face = ofLevel.faces[ofLevel.sample];
    std::optional<RegularFaceMask> mask;
    for (int corner = 0; corner < kSize; ++corner) {
        Index sources[PlainNeighborhoodGatherer::kNumRegular];
        LimitRow const ofVertex =
            rows.GetRow(ofFace.numVertices + face.firstCorner + corner, 0, sources);
        Row row;
        for (int i = 0; i < ofVertex.size; ++i) {
            addTo(row, ofVertex.sources[i], {ofVertex.weights[i], ofVertex.du[i], ofVertex.dv[i]},
                  1);
        }
        for (int child = _level; child > level; --child) {
            RefinementMask const ofStep(_mesh.levels[std::size_t(child) - 1], schemeOptions,
                                        Interpolation::Vertex);
            row = stepBack(row, _mesh.refinements[std::size_t(child) - 1], ofStep);
        }
        if (corner == 0) {
            mask = makeMask(ofFace, face, row);
        }
        if (!isRow(ofFace, face, *mask, corner, row)) {
            return {};
        }
    }
    return mask;
}

} // namespace OpenSubdivHex::FarExt::internal

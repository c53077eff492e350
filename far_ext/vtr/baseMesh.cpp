// SPDX-License-Identifier: Apache-2.0
#include "baseMesh.h"

#include "indexSet.h"
#include "inputChecks.h"
#include "parallel.h"
#include "quadFeatures.h"
#include "sharpFeatures.h"
#include "valueSharpness.h"
#include "vertexFan.h"

#include <algorithm>
#include <map>
#include <type_traits>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

constexpr int kMaxFaceSize = OpenSubdiv::Vtr::VALENCE_LIMIT;
constexpr int kMaxVertexFaces = OpenSubdiv::Vtr::VALENCE_LIMIT;

CallStatus invalid(ComponentType component, Index index, std::string message) {
    return CallStatus(StatusCode::InvalidTopology, component, index, std::move(message));
}

CallStatus tooLarge(ComponentType component, Index index, std::string message) {
    return CallStatus(StatusCode::TooLarge, component, index, std::move(message));
}

// Whether all edges are those of a base whose faces have the same vertices.
bool hasEdgesOf(Far::TopologyLevel const &base, Level const &level) {
    if (base.GetNumEdges() != level.numEdges) {
        return false;
    }
    auto const countWrong = [](Index count, auto const &countOfRange) {
        return ParallelSums<Index>(count, countOfRange).back();
    };
    // The edges of faces follow one another in Far's levels, too.
    Index const numWrongFaces = countWrong(level.numFaces, [&](Index begin, Index end) {
        Index const *const first = level.faceEdges.data() + level.faceFirstCorner[begin];
        Index const *const last = level.faceEdges.data() + level.faceFirstCorner[end];
        return Index(!std::equal(first, last, base.GetFaceEdges(begin).begin()));
    });
    Index const numWrongEdges = countWrong(level.numEdges, [&](Index begin, Index end) {
        Index numWrong = 0;
        for (Index edge = begin; edge < end; ++edge) {
            Index const *const verts = base.GetEdgeVertices(edge).begin();
            Far::ConstIndexArray const faces = base.GetEdgeFaces(edge);
            Far::LocalIndex const *const locals = base.GetEdgeFaceLocalIndices(edge).begin();
            IndexPair const levelVerts = level.edgeVerts[edge];
            IndexPair const levelFaces = level.edgeFaces[edge];
            LocalIndexPair const levelLocals = level.edgeFaceLocals[edge];
            int const last = levelFaces[1] < 0 ? 0 : 1;
            bool const isRight =
                faces.size() == last + 1 && levelFaces[0] == faces[0] &&
                levelLocals[0] == locals[0] &&
                (last == 0 || (levelFaces[1] == faces[1] && levelLocals[1] == locals[1]));
            numWrong += !isRight || verts[0] != levelVerts[0] || verts[1] != levelVerts[1];
        }
        return numWrong;
    });
    return numWrongFaces == 0 && numWrongEdges == 0;
}

// Whether an array is empty or has no entry that is sharp.
bool isSmooth(Buffer<float> const &sharpness) {
    return ParallelSelect(Index(sharpness.size()),
                          [&](Index i) { return Crease::IsSharp(sharpness[i]); })
        .empty();
}

// Makes room for tags, all of them \p value, unless there is.
template <typename T>
void makeTags(Buffer<T> &tags, std::size_t size, T value) {
    if (tags.empty()) {
        tags.Resize(size);
        std::fill_n(tags.data(), size, value);
    }
}

// Not 0 if an index may be below 0, or \p count or more.  Compilers look at several at a time.
unsigned findOutside(Index const *begin, Index const *end, Index count) {
    unsigned signs = 0;
    for (Index const *index = begin; index < end; ++index) {
        signs |= unsigned(*index) | (unsigned(count - 1) - unsigned(*index));
    }
    return signs >> 31;
}

// Not 0 if a face has a vertex twice: no branches.
template <int SIZE>
unsigned findRepeated(Index const *verts) {
    unsigned result = 0;
    for (int i = 0; i < SIZE; ++i) {
        for (int k = 0; k < i; ++k) {
            result |= unsigned(verts[k] == verts[i]);
        }
    }
    return result;
}

// Variant for consecutive quads: compilers look at the corners of one at a time.
unsigned findRepeatedInQuads(Index const *verts, Index numFaces) {
    constexpr int kSize = 4;
    unsigned results[kSize] = {};
    for (Index face = 0; face < numFaces; ++face, verts += kSize) {
        for (int i = 0; i < kSize; ++i) {
            results[i] |= unsigned(verts[i] == verts[(i + 1) % kSize]) |
                          unsigned(verts[i] == verts[(i + 2) % kSize]);
        }
    }
    return results[0] | results[1] | results[2] | results[3];
}

// Variant for any consecutive faces; not 0 for a face of many vertices, too.
unsigned findRepeated(Level const &level, Index begin, Index end) {
    Index const *verts = level.faceVerts.data() + level.faceFirstCorner[begin];
    unsigned result = 0;
    int const size = level.faceSizes.size() == 1 ? level.faceSizes[0] : 0;
    if (size == 3) {
        for (Index face = begin; face < end; ++face, verts += 3) {
            result |= findRepeated<3>(verts);
        }
        return result;
    }
    if (size == 4) {
        return findRepeatedInQuads(verts, end - begin);
    }
    for (Index face = begin; face < end; ++face) {
        int const faceSize = level.GetFaceSize(face);
        switch (faceSize) {
        case 3:
            result |= findRepeated<3>(verts);
            break;
        case 4:
            result |= findRepeated<4>(verts);
            break;
        case 5:
            result |= findRepeated<5>(verts);
            break;
        case 6:
            result |= findRepeated<6>(verts);
            break;
        default:
            return 1;
        }
        verts += faceSize;
    }
    return result;
}

} // namespace

void BaseMesh::SetNumFaces(Index count) {
    _level->numFaces = count;
    _level->faceFirstCorner.Resize(std::size_t(count) + 1);
}

CallStatus BaseMesh::CompleteSizes() {
    if (CallStatus status = CheckCounts(_level->numVertices, _level->numFaces); !status.IsOk()) {
        return status;
    }
    Index *const sizes = _level->faceFirstCorner.data() + 1;
    std::vector<Index> const wrong = ParallelSelect(_level->numFaces, [&](Index face) {
        return unsigned(sizes[face]) - 3 > unsigned(kMaxFaceSize - 3);
    });
    if (!wrong.empty()) {
        Index const face = wrong[0];
        std::string const has =
            "face " + std::to_string(face) + " has " + std::to_string(sizes[face]) + " vertices, ";
        if (sizes[face] < 3) {
            return invalid(ComponentType::Face, face, has + "but a face needs at least 3");
        }
        return tooLarge(ComponentType::Face, face,
                        has + "more than the " + std::to_string(kMaxFaceSize) +
                            " that OpenSubdiv's local indices reach");
    }
    std::vector<std::int64_t> const firstCorners =
        ParallelSums<std::int64_t>(_level->numFaces, [&](Index begin, Index end) {
            std::int64_t sum = 0;
            for (Index face = begin; face < end; ++face) {
                sum += sizes[face];
            }
            return sum;
        });
    if (CallStatus status = CheckCount(firstCorners.back(), "face-vertices"); !status.IsOk()) {
        return status;
    }
    _level->numCorners = Index(firstCorners.back());
    _level->faceFirstCorner[0] = 0;
    ParallelForRange(_level->numFaces, [&](Index begin, Index end) {
        auto corner = Index(firstCorners[begin / kParallelRange]);
        for (Index face = begin; face < end; ++face) {
            corner += sizes[face];
            sizes[face] = corner;
        }
    });
    FindFaceSizes(*_level);
    _level->faceVerts.Resize(std::size_t(_level->numCorners));
    return CallStatus();
}

CallStatus BaseMesh::CheckFaces() {
    Level const &level = *_level;
    // Pieces that are small, since all faces of one with something odd are looked at once more.
    constexpr Index kPiece = 64;
    Index const numPieces = GetNumParallelRanges(level.numFaces, kPiece);
    auto const getEnd = [&](Index piece) {
        return std::min(level.numFaces - kPiece * piece, kPiece) + kPiece * piece;
    };
    // Longer ranges than elsewhere: it takes 2 nanoseconds a face, and waking a worker some thousands.
    std::vector<Index> const suspects = ParallelSelect(
        numPieces,
        [&](Index piece) {
            Index const begin = kPiece * piece;
            Index const end = getEnd(piece);
            Index const *const verts = level.faceVerts.data();
            return (findOutside(verts + level.faceFirstCorner[begin],
                                verts + level.faceFirstCorner[end], level.numVertices) |
                    findRepeated(level, begin, end)) != 0;
        },
        kParallelRange / 2 / kPiece);
    std::vector<Index> sorted;
    auto const inspect = [&](Index face) {
        Far::ConstIndexArray const verts = level.GetFaceVertices(face);
        for (Index vert : verts) {
            if (vert < 0 || vert >= level.numVertices) {
                return invalid(ComponentType::Face, face,
                               "face " + std::to_string(face) + " refers to vertex " +
                                   std::to_string(vert) + ", but vertices go from 0 to " +
                                   std::to_string(level.numVertices - 1));
            }
        }
        sorted.assign(verts.begin(), verts.end());
        std::sort(sorted.begin(), sorted.end());
        for (std::size_t i = 1; i < sorted.size(); ++i) {
            if (sorted[i] == sorted[i - 1]) {
                _repeatedVerts.push_back(sorted[i]);
            }
        }
        return CallStatus();
    };
    for (Index piece : suspects) {
        for (Index face = kPiece * piece; face < getEnd(piece); ++face) {
            if (CallStatus status = inspect(face); !status.IsOk()) {
                return status;
            }
        }
    }
    SortUnique(_repeatedVerts);
    return CallStatus();
}

CallStatus BaseMesh::CompleteTopology() {
    CallStatus status = BuildLevelOfFaces(getBoundary(), _repeatedVerts, *_level, _fannedVerts);
    return checkValences(std::move(status));
}

bool BaseMesh::CompleteTopology(Far::TopologyLevel const &base) {
    if (!_repeatedVerts.empty()) {
        return false;
    }
    // Valences are those that Far takes.
    if (CompleteTopology().IsOk() && _level->lineEdges.empty() && hasEdgesOf(base, *_level)) {
        return true;
    }
    _level->lineEdges.clear();
    _level->nonManifoldEdges.clear();
    return false;
}

CallStatus BaseMesh::CompleteTopology(Buffer<EdgeSides> edges, std::vector<ApartSide> sides) {
    CallStatus status =
        BuildLevelOfEdges(std::move(edges), std::move(sides), *_level, _fannedVerts);
    return checkValences(std::move(status));
}

// The numbers of the faces of vertices.  V-vertices of the next level have as many edges as their
// parents have faces, and Far's arrays of local indices no more entries.
CallStatus BaseMesh::checkValences(CallStatus status) {
    Level const &level = *_level;
    if (!status.IsOk()) {
        return status;
    }
    std::int64_t const numOthers =
        std::count_if(level.lineEdges.begin(), level.lineEdges.end(),
                      [](LineEdge const &line) { return line.edge != line.line; });
    _numBaseEdges = level.numEdges - Index(numOthers);
    std::vector<Index> const odd = ParallelSelect(level.numVertices, [&](Index vert) {
        return unsigned(level.GetNumVertexFaces(vert)) - 1 >= unsigned(kMaxVertexFaces);
    });
    for (Index vert : odd) {
        if (int const count = level.GetNumVertexFaces(vert); count > 0) {
            return tooLarge(ComponentType::Vertex, vert,
                            "vertex " + std::to_string(vert) + " has " + std::to_string(count) +
                                " faces, more than the " + std::to_string(kMaxVertexFaces) +
                                " that OpenSubdiv's valences reach");
        }
        _isolatedVerts.push_back(vert);
    }
    return status;
}

Index BaseMesh::FindEdge(Index v0, Index v1) const {
    Level const &level = *_level;
    if (level.GetVertexEdges(v1).size() < level.GetVertexEdges(v0).size()) {
        std::swap(v0, v1);
    }
    for (Index edge : level.GetVertexEdges(v0)) {
        IndexPair const &verts = level.edgeVerts[edge];
        if ((verts[0] == v0 && verts[1] == v1) || (verts[0] == v1 && verts[1] == v0)) {
            Index const line = level.GetEdgeLine(edge);
            return line == Far::INDEX_INVALID ? edge : line;
        }
    }
    return Far::INDEX_INVALID;
}

// Edges that came apart are boundaries, so that the base's edges are all that can be creases.
void BaseMesh::SetEdgeSharpness(Index edge, float sharpness) {
    if (!_level->IsBoundary(edge)) {
        makeTags(_level->edgeSharpness, std::size_t(_level->numEdges), 0.0f);
        _level->edgeSharpness[edge] = sharpness;
    }
}

void BaseMesh::SetVertexSharpness(Index vert, float sharpness) {
    makeTags(_level->vertSharpness, std::size_t(_level->numVertices), 0.0f);
    _level->vertSharpness[vert] = sharpness;
}

void BaseMesh::SetHole(Index face, bool isHole) {
    constexpr unsigned char kNoHole = 0;
    makeTags(_level->faceHoles, std::size_t(_level->numFaces), kNoHole);
    _level->faceHoles[face] = isHole ? kHole : kNoHole;
}

void BaseMesh::CompleteTags() {
    Level &level = *_level;
    if (isSmooth(level.edgeSharpness)) {
        level.edgeSharpness.Resize(0);
    }
    if (std::find(level.faceHoles.begin(), level.faceHoles.end(), kHole) == level.faceHoles.end()) {
        level.faceHoles.Resize(0);
    }
    findNonManifoldVertices();
    if (_sdcOptions.GetVtxBoundaryInterpolation() == Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER) {
        for (Index edge : level.boundaryEdges) {
            Index const vert = level.edgeVerts[edge][0];
            if (level.GetNumVertexFaces(vert) == 1) {
                SetVertexSharpness(vert, Crease::SHARPNESS_INFINITE);
            }
        }
    }
    for (Index vert : level.nonManifoldVerts) {
        if (isPinned(vert)) {
            SetVertexSharpness(vert, Crease::SHARPNESS_INFINITE);
        }
    }
    if (level.nonManifoldVerts.empty() && isSmooth(level.vertSharpness)) {
        level.vertSharpness.Resize(0);
    } else {
        makeTags(level.vertSharpness, std::size_t(level.numVertices), 0.0f);
    }
    ComputeSharpMasks({_sdcOptions, FaceMask::Average}, level); // with others level 0 has the same
    FindBaseLineCorners(level);
}

// A vertex is non-manifold that has several fans, or none, or that a face has several times, or an
// edge that came apart.
void BaseMesh::findNonManifoldVertices() {
    std::vector<Index> &verts = _level->nonManifoldVerts;
    for (std::vector<Index> const *some : {&_fannedVerts, &_isolatedVerts, &_repeatedVerts}) {
        verts.insert(verts.end(), some->begin(), some->end());
    }
    for (LineEdge const &line : _level->lineEdges) {
        IndexPair const &ends = _level->edgeVerts[line.edge];
        verts.insert(verts.end(), ends.begin(), ends.end());
    }
    SortUnique(verts);
}

// As Far's rule for non-manifold vertices: they stay, unless two edges that came apart meet there,
// with no other boundary, and more faces than the base has edges there: the vertex then lies inside
// of a curve that three or more sheets share.  A vertex that a face has several times stays, too.
bool BaseMesh::isPinned(Index vert) const {
    std::map<Index, int> numFacesOfLines;
    Index numInterior = 0;
    for (Index edge : _level->GetVertexEdges(vert)) {
        IndexPair const &verts = _level->edgeVerts[edge];
        if (!_level->IsBoundary(edge)) {
            ++numInterior;
        } else if (Index const line = _level->GetEdgeLine(edge);
                   line == Far::INDEX_INVALID || verts[0] == verts[1]) {
            return true;
        } else {
            ++numFacesOfLines[line];
        }
    }
    // An edge of the base that has one face, and came apart since that has another like it.
    bool const hasBoundary =
        std::any_of(numFacesOfLines.begin(), numFacesOfLines.end(),
                    [](std::pair<Index const, int> const &line) { return line.second == 1; });
    return hasBoundary || numFacesOfLines.size() != 2 ||
           _level->GetNumVertexFaces(vert) <= numInterior + 2 ||
           std::binary_search(_repeatedVerts.begin(), _repeatedVerts.end(), vert);
}

// Makes a value without seams at a non-manifold vertex move as the vertex does: each fan of
// faces has a value of its own, which sees the sharp edges of its fan alone.
CallStatus BaseMesh::followVertex(Index vert, int channel, Index const *faceValues,
                                  std::vector<float> &sharpness) const {
    Level const &level = *_level;
    std::vector<Index> corners;
    for (Index k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1]; ++k) {
        corners.push_back(level.GetVertexCorner(k));
    }
    auto const isSeam = [&](Index corner) { return faceValues[corner] != faceValues[corners[0]]; };
    if (std::any_of(corners.begin(), corners.end(), isSeam)) {
        return CallStatus();
    }
    auto const refuse = [&](std::string const &what) {
        return CallStatus(StatusCode::Unsupported, ComponentType::Vertex, vert,
                          "face-varying channel " + std::to_string(channel) +
                              " has no seam at vertex " + std::to_string(vert) + ", where " + what);
    };
    int numCreasedFans = 0;
    ForEachFanItems(level, vert, [&](FanItems const &fan) {
        auto const isCrease = [](FanItem const &item) {
            return Sdc::Crease::IsSemiSharp(item.sharpness);
        };
        numCreasedFans += std::any_of(fan.items.begin(), fan.items.end(), isCrease) ? 1 : 0;
    });
    if (numCreasedFans > 1 && _sdcOptions.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN) {
        return refuse("CREASE_CHAIKIN averages semi-sharp creases that no faces there join");
    }
    float sharpest = 0;
    for (Index i = level.vertFirstEdge[vert]; i < level.vertFirstEdge[vert + 1]; ++i) {
        sharpest = std::max(sharpest, level.GetEdgeSharpness(level.vertEdges[i]));
    }
    if (Sdc::Crease::IsInfinite(std::max(sharpest, level.GetVertexSharpness(vert)))) {
        for (Index corner : corners) {
            sharpness[corner] = Sdc::Crease::SHARPNESS_INFINITE;
        }
        return CallStatus();
    }
    bool isSeenByAll = !Sdc::Crease::IsSharp(sharpest);
    ForEachFan(level, vert, [&](VertexFan const &fan) {
        Index const first = level.GetVertexCorner(fan.begin);
        Index const last =
            level.GetPrevCorner(level.vertFaces[fan.end - 1], level.GetVertexCorner(fan.end - 1));
        isSeenByAll =
            isSeenByAll && !fan.isClosed &&
            level.GetEdgeLine(level.faceEdges[first]) != level.GetEdgeLine(level.faceEdges[last]);
    });
    if (isSeenByAll) {
        return CallStatus();
    }
    return refuse("faces do not all meet both ends of a non-manifold curve, or a semi-sharp crease "
                  "meets it");
}

CallStatus BaseMesh::AddChannel(Index numValues, Buffer<Index> faceValues,
                                Sdc::Options::FVarLinearInterpolation interpolation) {
    int const channel = int(_hierarchy->channels.size());
    // Fans of faces around a value get values of their own, at most one for each corner.
    if (CallStatus status = CheckCount(std::int64_t(numValues) + _level->numCorners,
                                       "values and face-vertices in face-varying channel " +
                                           std::to_string(channel));
        !status.IsOk()) {
        return status;
    }
    std::vector<Index> const seams = FindSeams(*_level, faceValues.data());
    std::vector<float> sharpness =
        FindValueSharpness(*_level, faceValues.data(), seams, interpolation);
    for (Index vert : _level->nonManifoldVerts) {
        if (interpolation == Sdc::Options::FVAR_LINEAR_ALL) {
            break;
        }
        CallStatus status = followVertex(vert, channel, faceValues.data(), sharpness);
        if (!status.IsOk()) {
            return status;
        }
    }
    Sdc::Options options = _sdcOptions;
    options.SetFVarLinearInterpolation(interpolation);
    BuildFVarChannel(*_level, numValues, std::move(faceValues), seams, sharpness, options,
                     _hierarchy->channels.emplace_back());
    return CallStatus();
}

} // namespace OpenSubdivHex::FarExt::internal

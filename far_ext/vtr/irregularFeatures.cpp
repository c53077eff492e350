// SPDX-License-Identifier: Apache-2.0
#include "irregularFeatures.h"

#include "parallel.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

constexpr int kQuad = 4;

// The weight of a smooth mask where something is as sharp as this: the rest is as without it.
float smoothPart(float sharpness) { return std::max(0.0f, 1 - sharpness); }

bool isWholeEFace(Level const &level, Index face) {
    return face >= level.numFFaces && face < level.numFaces - level.numVFaces &&
           level.GetFaceSize(face) == kHexagon;
}

// Features of an E-face, as bits: an irregular vertex where a side of its edge starts, or a quad
// across the edge that such a side shares with its F-face.
using Mark = unsigned char;
constexpr Mark kVertexA = 1;
constexpr Mark kVertexB = 2;
constexpr Mark kQuadA = 4;
constexpr Mark kQuadB = 8;
struct Side {
    EFaceSide places;
    Mark vertex;
    Mark quad;
};
constexpr Side kSides[] = {{kEFaceSideA, kVertexA, kQuadA}, {kEFaceSideB, kVertexB, kQuadB}};

// Calls add(side, local, kind) for the irregular corners of a face, in any order.  There are numRows rows
// beside quads; the second is for the corners of V-vertices, which are an edge away from the quad, where
// these are not irregular and there is one quad.
template <typename ADD>
void forEachCorner(Mark mark, int numRows, ADD const &add) {
    auto const isIrregular = [mark](int local) {
        return (mark & (local == kEFaceSideA.startVertex ? kVertexA : kVertexB)) != 0;
    };
    for (Side const &side : kSides) {
        int const atQuad = side.places.fFaceEdge;
        if (mark & side.quad) {
            add(side, atQuad, IrregularCorner::kAlongQuad);
            add(side, atQuad + 1, IrregularCorner::kBehindQuad);
        }
        if ((mark & (kQuadA | kQuadB)) != side.quad || numRows < QuadMask::kNumRows) {
            continue;
        }
        if (int const local = (atQuad + 2) % kHexagon; !isIrregular(local)) {
            add(side, local, IrregularCorner::kOneBehindQuad);
        }
        if (int const local = (atQuad + 5) % kHexagon; !isIrregular(local)) {
            add(side, local, IrregularCorner::kOneBeforeQuad);
        }
    }
    for (Side const &side : kSides) {
        int const local = side.places.startVertex;
        if (mark & side.vertex) {
            add(side, local, IrregularCorner::kAtVertex);
            // Beside a quad, its masks are taken, and not those of a vertex.
            if (!(mark & (side.vertex == kVertexA ? kQuadB : kQuadA))) {
                add(side, local + 1, IrregularCorner::kBehindVertex);
            }
            if (!(mark & side.quad)) {
                add(side, local + kHexagon - 1, IrregularCorner::kBeforeVertex);
            }
        }
    }
}

// Finds the irregular vertices and corners of a level: first what the masks at each vertex weigh,
// then which faces are concerned, and last their corners, in the order of the faces.
class IrregularFinder {
public:
    IrregularFinder(Refinement const &refinement, Level &level)
        : _refinement(refinement), _level(level),
          _endVert(std::min(level.numVertsOfAnyValence, level.numVVertices)),
          _numRows(ComputeQuadMask(level.numHexagonalSteps).numRows) {}

    void Find() {
        findVertices();
        _marks.resize(std::size_t(_level.numFaces - _level.numVFaces - _level.numFFaces));
        markFacesOfVertices();
        if (_numRows > 0) {
            markFacesBesideQuads();
        }
        findCorners();
    }

private:
    // By vertex: the share of its masks, negative if the vertex is not irregular.
    struct Vertex {
        float weight;
        FacesAround facesAround;
    };
    void findVertices();
    Vertex findVertex(Index vert) const;
    FacesAround findFacesAround(Index vert) const;
    void markFacesOfVertices();
    void markFacesBesideQuads();
    Mark &markOf(Index face) { return _marks[std::size_t(face - _level.numFFaces)]; }
    template <typename FUNCTION>
    void forEachMarked(Index begin, Index end, FUNCTION const &function) const;
    void findCorners();
    IrregularCorner *writeCorners(Index face, Mark mark, IrregularCorner *next) const;
    // Returns the share of the masks beside the quad on a side of an E-face.
    float findShareBesideQuad(Index face, EFaceSide const &side) const {
        float sharpness = _level.GetDiagonalSharpness(face);
        if (!_level.crossedFaces.empty()) { // which a quad may be
            Index const corner = _level.faceFirstCorner[face] + side.fFaceEdge;
            Index const quad = _level.GetCornerAcross(corner).face;
            sharpness = std::max(sharpness, _level.GetDiagonalSharpness(quad));
        }
        return smoothPart(sharpness);
    }

    Refinement const &_refinement;
    Level &_level;
    Index const _endVert; // of those that may be irregular
    int const _numRows;   // beside quads
    Buffer<Vertex> _vertices;
    std::vector<Mark> _marks; // by E-face
};

// Irregular are vertices inside the mesh all of whose faces are E-faces of six sides.
auto IrregularFinder::findVertex(Index vert) const -> Vertex {
    constexpr Vertex kNone = {-1, FacesAround::Others};
    if (_level.GetNumVertexFaces(vert) < kMinIrregularFaces || _level.IsNonManifold(vert)) {
        return kNone;
    }
    float sharpness = _level.GetVertexSharpness(vert);
    for (Index k = _level.vertFirstFace[vert]; k < _level.vertFirstFace[vert + 1]; ++k) {
        Index const face = _level.vertFaces[k];
        Index const corner = _level.GetVertexCorner(k);
        Index const edge = _level.faceEdges[corner];
        Index const before = _level.faceEdges[_level.GetPrevCorner(face, corner)];
        if (!isWholeEFace(_level, face) || _level.IsBoundary(edge) || _level.IsBoundary(before)) {
            return kNone;
        }
        sharpness =
            std::max({sharpness, _level.GetDiagonalSharpness(face), _level.GetEdgeSharpness(edge)});
    }
    Vertex const result = {smoothPart(sharpness), findFacesAround(vert)};
    // The next level learns from this one what was around.
    bool const matters =
        result.weight > 0 || (result.facesAround != FacesAround::Others &&
                              _level.numHexagonalSteps < kNumStepsToConstantMasks - 1 &&
                              !Sdc::Crease::IsInfinite(sharpness));
    return matters ? result : kNone;
}

FacesAround IrregularFinder::findFacesAround(Index vert) const {
    if (_level.numHexagonalSteps >= kNumStepsToConstantMasks) {
        return FacesAround::Others; // makes no difference
    }
    Level const &parent = *_refinement.parent;
    Index const pVert = _refinement.GetVVertexParent(vert);
    if (parent.numHexagonalSteps > 0) {
        Index const corner = parent.GetVertexCorner(parent.vertFirstFace[pVert]);
        auto const irregular = FindCornerTags(parent.irregularCorners, corner, corner + 1);
        bool const isKnown = !irregular.empty() && irregular[0].kind == IrregularCorner::kAtVertex;
        return isKnown ? irregular[0].facesAround : FacesAround::Others;
    }
    Far::ConstIndexArray const faces = parent.GetVertexFaces(pVert);
    return FindFacesAround(faces.size(), [&](int i) { return parent.GetFaceSize(faces[i]); });
}

void IrregularFinder::findVertices() {
    _vertices.Resize(std::size_t(_endVert));
    ParallelFor(_endVert, [&](Index vert) { _vertices[std::size_t(vert)] = findVertex(vert); });
    for (Index vert = 0; vert < _endVert; ++vert) {
        if (float const weight = _vertices[std::size_t(vert)].weight; weight >= 0) {
            _level.irregularVerts.push_back({vert, weight});
        }
    }
}

// Marks of vertices stand in E-faces where their sides start.
void IrregularFinder::markFacesOfVertices() {
    for (IrregularVertex const &irregular : _level.irregularVerts) {
        Index const end = _level.vertFirstFace[irregular.vert + 1];
        for (Index k = _level.vertFirstFace[irregular.vert]; k < end; ++k) {
            bool const isSideA = _level.vertFaceLocals[k] == kEFaceSideA.startVertex;
            markOf(_level.vertFaces[k]) |= isSideA ? kVertexA : kVertexB;
        }
    }
}

void IrregularFinder::markFacesBesideQuads() {
    for (Index quad = 0; quad < _level.numFFaces; ++quad) {
        if (_level.GetFaceSize(quad) != kQuad || _level.IsHalfFace(quad) ||
            smoothPart(_level.GetDiagonalSharpness(quad)) == 0) {
            continue;
        }
        Index const first = _level.faceFirstCorner[quad];
        for (Index corner = first; corner < first + kQuad; ++corner) {
            Index const edge = _level.faceEdges[corner];
            int const other = _level.edgeFaces[edge][0] == quad ? 1 : 0;
            Index const face = _level.edgeFaces[edge][other];
            if (isWholeEFace(_level, face) && smoothPart(_level.GetDiagonalSharpness(face)) > 0) {
                bool const isSideA = _level.edgeFaceLocals[edge][other] == kEFaceSideA.fFaceEdge;
                markOf(face) |= isSideA ? kQuadA : kQuadB;
            }
        }
    }
}

// Calls function(face, mark) for the marked ones of E-faces [begin, end).
template <typename FUNCTION>
void IrregularFinder::forEachMarked(Index begin, Index end, FUNCTION const &function) const {
    // A word of marks at a time, most of which are 0.
    for (Index i = begin; i < end;) {
        std::uint64_t word = 0;
        auto const numMarks = std::min<Index>(end - i, sizeof word);
        std::memcpy(&word, _marks.data() + i, std::size_t(numMarks));
        for (Index k = i; word != 0 && k < i + numMarks; ++k) {
            if (Mark const mark = _marks[std::size_t(k)]) {
                function(_level.numFFaces + k, mark);
            }
        }
        i += numMarks;
    }
}

void IrregularFinder::findCorners() {
    auto const count = Index(_marks.size());
    std::vector<std::size_t> const firsts =
        ParallelSums<std::size_t>(count, [&](Index begin, Index end) {
            std::size_t size = 0;
            forEachMarked(begin, end, [&](Index, Mark mark) {
                forEachCorner(mark, _numRows,
                              [&size](Side const &, int, IrregularCorner::Kind) { ++size; });
            });
            return size;
        });
    _level.irregularCorners.resize(firsts.back());
    ParallelForRange(count, [&](Index begin, Index end) {
        IrregularCorner *next = _level.irregularCorners.data() + firsts[begin / kParallelRange];
        forEachMarked(begin, end,
                      [&](Index face, Mark mark) { next = writeCorners(face, mark, next); });
    });
}

// Ascending.  Returns the end of what it writes.
IrregularCorner *IrregularFinder::writeCorners(Index face, Mark mark, IrregularCorner *next) const {
    Index const first = _level.faceFirstCorner[face];
    IrregularCorner found[kHexagon];
    unsigned places = 0;
    forEachCorner(mark, _numRows, [&](Side const &side, int local, IrregularCorner::Kind kind) {
        local %= kHexagon;
        if (IrregularCorner::IsAtQuad(kind)) {
            float const besideQuad = findShareBesideQuad(face, side.places);
            found[local] = {first + local, 0, besideQuad, kind, FacesAround::Others};
        } else {
            Index const vert = _level.faceVerts[first + side.places.startVertex];
            auto const [weight, facesAround] = _vertices[std::size_t(vert)];
            found[local] = {first + local, _level.GetNumVertexFaces(vert), weight, kind,
                            facesAround};
        }
        places |= 1U << local;
    });
    for (int local = 0; local < kHexagon; ++local) {
        if (places >> local & 1) {
            *next++ = found[local];
        }
    }
    return next;
}

} // namespace

void FindIrregularFeatures(FaceMask faceMask, Refinement const &refinement, Level &level) {
    level.irregularVerts.clear();
    level.irregularCorners.clear();
    if (faceMask == FaceMask::Smooth && level.numHexagonalSteps > 0 && level.hasFullTopology) {
        IrregularFinder(refinement, level).Find();
    }
}

} // namespace OpenSubdivHex::FarExt::internal

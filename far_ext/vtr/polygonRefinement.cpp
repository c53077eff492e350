// SPDX-License-Identifier: Apache-2.0
#include "polygonRefinement.h"

#include "faceWriter.h"
#include "fvarLevel.h"

#include <algorithm>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

using Index = Far::Index;

PolygonRules GetRulesOfChannel(Level const &mesh, PolygonRules const &rules,
                               FVarLevel const &channel) {
    PolygonRules result = rules;
    result.flatEdges.assign(std::size_t(channel.values->numEdges), 0);
    for (std::size_t edge = 0; edge < rules.flatEdges.size(); ++edge) {
        Index const valueEdge =
            channel.GetFaceEdge(mesh.edgeFaces[edge][0], mesh.edgeFaceLocals[edge][0]);
        result.flatEdges[std::size_t(valueEdge)] = rules.flatEdges[edge];
    }
    return result;
}

namespace {

// The first of the two ends of an edge, as a position in _endEdges.
std::size_t getFirstEnd(Index pEdge) { return 2 * std::size_t(pEdge); }

// Entries of _endEdges before edges are numbered.
constexpr Index kNoEndEdge = Far::INDEX_INVALID;
constexpr Index kEndEdge = 0;
constexpr Index kJoinedEnd = -2; // stays; the edge is that of the digon's other end

} // namespace

PolygonRefiner::PolygonRefiner(Level const &parent, PolygonRules rules, TagOptions tagOptions)
    : _parent(parent), _rules(std::move(rules)), _tagOptions(tagOptions) {
    countVertices();
    findDigons();
    markEndEdges();
    countEdges();
    countSpokes();
    ChildCounts const &vertices = _vertexCounts.back();
    ChildCounts const &edges = _edgeCounts.back();
    _sizes.vertices = vertices.vertices + _parent.numCorners;
    _sizes.edges = _parent.numCorners + _spokeCounts.back().edges + edges.edges;
    _sizes.faces = _parent.numFaces + edges.faces + vertices.faces;
    _sizes.corners = _parent.numCorners + edges.corners + vertices.corners;
    countBoundaries();
}

bool PolygonRefiner::makesEFace(Index pEdge) const {
    return isQuad(pEdge) || (isHexagonal() && !_parent.IsSharpBoundaryB(pEdge));
}

// None where there are quads all around.
bool PolygonRefiner::makesVVertex(Index pVert) const {
    Index const *const begin = _parent.vertEdges.data() + _parent.vertFirstEdge[pVert];
    Index const *const end = _parent.vertEdges.data() + _parent.vertFirstEdge[pVert + 1];
    return isHexagonal() &&
           (begin == end || !std::all_of(begin, end, [this](Index e) { return isQuad(e); }));
}

// The end of an edge, as a position in _endEdges, at the vertex of the corner where one of its
// faces begins to run along it.
std::size_t PolygonRefiner::findEnd(Index startCorner) const {
    Index const pEdge = _parent.faceEdges[startCorner];
    return getFirstEnd(pEdge) + (_parent.GetSideCorner(pEdge, 0) == startCorner ? 0 : 1);
}

BoundaryKind PolygonRefiner::getBoundaryKind() const {
    bool const isFree = isHexagonal() || _tagOptions.sdcOptions.GetVtxBoundaryInterpolation() ==
                                             Sdc::Options::VTX_BOUNDARY_NONE;
    return isFree ? kFreeBoundary : kSharpBoundaryA;
}

// Calls addVFace(vFace) for the V-faces of a vertex and addDigon(fan) for the digons in place of
// them, in order.
template <typename ADD_VFACE, typename ADD_DIGON>
void PolygonRefiner::forEachVFace(Index pVert, bool hasVVertex, ADD_VFACE addVFace,
                                  ADD_DIGON addDigon) const {
    if (hasVVertex && (_rules.flatEdges.empty() || !_rules.closeGaps)) {
        return;
    }
    ForEachFan(_parent, pVert, [&](VertexFan const &fan) {
        Index const size = fan.GetSize();
        if (hasVVertex) {
            forEachRunOfQuads(fan, [&](Index begin, Index count) {
                addVFace(VFace{fan, begin, count, hasVVertex});
            });
        } else if (fan.isClosed && size == 2 && !isTriHex()) {
            addDigon(fan);
        } else if (fan.isClosed && _rules.closeGaps) {
            addVFace(VFace{fan, fan.begin, size, hasVVertex});
        }
    });
}

// Calls function(begin, count) for the maximal runs of count faces with quads between them.
template <typename FUNCTION>
void PolygonRefiner::forEachRunOfQuads(VertexFan const &fan, FUNCTION function) const {
    Index const size = fan.GetSize();
    auto const getInEdge = [this](Index k) {
        Index const corner = _parent.GetVertexCorner(k);
        return _parent.faceEdges[_parent.GetPrevCorner(_parent.vertFaces[k], corner)];
    };
    // A run begins with a face that has another edge than a quad's before it: in an open fan, the
    // first.
    Index start = fan.begin;
    while (fan.isClosed && isQuad(_parent.faceEdges[_parent.GetVertexCorner(start)])) {
        ++start;
    }
    Index count = 1;
    for (Index i = 0; i < size; ++i) {
        Index const k = fan.Advance(start, i);
        if (isQuad(getInEdge(k))) {
            ++count;
            continue;
        }
        if (count > 1) {
            function(fan.Advance(start, i - count + 1), count);
        }
        count = 1;
    }
}

// Calls function(corner) for the corners with a spoke.
template <typename FUNCTION>
void PolygonRefiner::forEachSpoke(Index beginFace, Index endFace, FUNCTION function) const {
    for (Index pFace = beginFace; pFace < endFace && isHexagonal(); ++pFace) {
        Index const end = _parent.faceFirstCorner[pFace + 1];
        for (Index corner = _parent.faceFirstCorner[pFace]; corner < end; ++corner) {
            Index const prev = _parent.GetPrevCorner(pFace, corner);
            if (!isQuad(_parent.faceEdges[corner]) || !isQuad(_parent.faceEdges[prev])) {
                function(corner);
            }
        }
    }
}

void PolygonRefiner::countVertices() {
    _vertexCounts = ParallelSums<ChildCounts>(_parent.numVertices, [this](Index begin, Index end) {
        ChildCounts counts;
        for (Index pVert = begin; pVert < end; ++pVert) {
            bool const hasVVertex = makesVVertex(pVert);
            counts.vertices += hasVVertex ? 1 : 0;
            forEachVFace(
                pVert, hasVVertex,
                [&](VFace const &vFace) {
                    ++counts.faces;
                    counts.corners +=
                        (isTriHex() ? 2 : 1) * vFace.count + (vFace.hasVVertex ? 1 : 0);
                },
                [&](VertexFan const &) { ++counts.digons; });
        }
        return counts;
    });
}

void PolygonRefiner::findDigons() {
    _digons.resize(std::size_t(_vertexCounts.back().digons));
    if (_digons.empty()) {
        return;
    }
    ParallelForRange(_parent.numVertices, [this](Index begin, Index end) {
        auto digon = _digons.begin() + _vertexCounts[std::size_t(begin / kParallelRange)].digons;
        for (Index pVert = begin; pVert < end; ++pVert) {
            forEachVFace(
                pVert, makesVVertex(pVert), [](VFace const &) {},
                [&](VertexFan const &fan) {
                    auto const [end0, end1] =
                        std::minmax({findEnd(_parent.GetVertexCorner(fan.begin)),
                                     findEnd(_parent.GetVertexCorner(fan.begin + 1))});
                    *digon++ = {end0, end1};
                });
        }
    });
    std::sort(_digons.begin(), _digons.end(),
              [](Digon const &a, Digon const &b) { return a.joinedEnd < b.joinedEnd; });
}

void PolygonRefiner::markEndEdges() {
    _endEdges.Resize(getFirstEnd(_parent.numEdges));
    ParallelFor(_parent.numEdges, [this](Index pEdge) {
        std::size_t const first = getFirstEnd(pEdge);
        bool const hasFirst = makesEFace(pEdge) && (_parent.IsBoundary(pEdge) || isQuad(pEdge));
        _endEdges[first] = hasFirst ? kEndEdge : kNoEndEdge;
        _endEdges[first + 1] = isQuad(pEdge) ? kEndEdge : kNoEndEdge;
    });
    for (Digon const &digon : _digons) {
        _endEdges[digon.joinedEnd] = kJoinedEnd;
    }
    if (isTriHex()) {
        // An edge between two V-faces, or one and a border.
        ParallelFor(_parent.numVertices, [this](Index pVert) {
            forEachVFace(
                pVert, false,
                [this](VFace const &vFace) {
                    for (Index k = vFace.fan.begin; k < vFace.fan.end; ++k) {
                        _endEdges[findEnd(_parent.GetVertexCorner(k))] = kEndEdge;
                    }
                },
                [](VertexFan const &) {});
        });
    }
}

void PolygonRefiner::countEdges() {
    _edgeCounts = ParallelSums<ChildCounts>(_parent.numEdges, [this](Index begin, Index end) {
        ChildCounts counts;
        for (Index pEdge = begin; pEdge < end; ++pEdge) {
            std::size_t const first = getFirstEnd(pEdge);
            int const numEnds =
                int(_endEdges[first] == kEndEdge) + int(_endEdges[first + 1] == kEndEdge);
            counts.edges += isTriHex() ? std::min(numEnds, 1) : numEnds;
            if (makesEFace(pEdge)) {
                ++counts.faces;
                bool const isHexagon = !_parent.IsBoundary(pEdge) && !isQuad(pEdge);
                counts.corners += isHexagon ? HexIndexing::kNumEFaceCorners
                                            : HexIndexing::kNumBoundaryEFaceCorners;
            }
        }
        return counts;
    });
}

void PolygonRefiner::countSpokes() {
    _spokeCounts = ParallelSums<ChildCounts>(_parent.numFaces, [this](Index begin, Index end) {
        ChildCounts counts;
        forEachSpoke(begin, end, [&](Index) { ++counts.edges; });
        return counts;
    });
}

// Every corner is a side of an edge, and a boundary edge lacks one of its two sides.  Of the other
// boundaries than those of the hexagonal step all are of one kind.
void PolygonRefiner::countBoundaries() {
    std::int64_t const numBoundaries = 2 * _sizes.edges - _sizes.corners;
    if (isHexagonal()) {
        LevelSizes const sizes = GetHexagonalSizes(internal::GetSizes(_parent));
        _sizes.sharpBoundariesA = sizes.sharpBoundariesA;
        _sizes.sharpBoundariesB = sizes.sharpBoundariesB;
    }
    (getBoundaryKind() == kFreeBoundary ? _sizes.freeBoundaries : _sizes.sharpBoundariesA) +=
        numBoundaries - _sizes.sharpBoundariesA - _sizes.sharpBoundariesB;
}

void PolygonRefiner::relate(Refinement &refinement) const {
    refinement.vertChildVerts.Resize(0);
    refinement.vVertexParents.Resize(0);
    if (_vertexCounts.back().vertices != _parent.numVertices) {
        NumberVVertices(
            _vertexCounts, [this](Index pVert) { return makesVVertex(pVert); }, refinement);
    }
    refinement.edgeChildFaces.Resize(std::size_t(_parent.numEdges));
    ParallelForRange(_parent.numEdges, [&](Index begin, Index end) {
        Index cFace =
            _parent.numFaces + Index(_edgeCounts[std::size_t(begin / kParallelRange)].faces);
        for (Index pEdge = begin; pEdge < end; ++pEdge) {
            refinement.edgeChildFaces[std::size_t(pEdge)] =
                makesEFace(pEdge) ? cFace++ : Far::INDEX_INVALID;
        }
    });
}

// Edges are numbered in this order: those of the F-faces, the spokes, those of the edges.
void PolygonRefiner::numberEdges() {
    _spokes.Resize(std::size_t(_parent.numCorners));
    ParallelForRange(_parent.numFaces, [this](Index begin, Index end) {
        std::fill(_spokes.data() + _parent.faceFirstCorner[begin],
                  _spokes.data() + _parent.faceFirstCorner[end], Far::INDEX_INVALID);
        Index cEdge =
            _parent.numCorners + Index(_spokeCounts[std::size_t(begin / kParallelRange)].edges);
        forEachSpoke(begin, end, [&](Index corner) { _spokes[std::size_t(corner)] = cEdge++; });
    });
    ParallelForRange(_parent.numEdges, [this](Index begin, Index end) {
        Index cEdge = _parent.numCorners + Index(_spokeCounts.back().edges) +
                      Index(_edgeCounts[std::size_t(begin / kParallelRange)].edges);
        for (Index pEdge = begin; pEdge < end; ++pEdge) {
            Index *const ends = _endEdges.data() + getFirstEnd(pEdge);
            if (isTriHex()) {
                if (ends[0] == kEndEdge || ends[1] == kEndEdge) {
                    ends[0] = ends[1] = cEdge++;
                }
                continue;
            }
            for (int i : {0, 1}) {
                if (ends[i] == kEndEdge) {
                    ends[i] = cEdge++;
                }
            }
        }
    });
}

// Fills the faces of a child and, for FULL, the sides of its edges.  All that a component of the
// parent makes is written for that component alone, to places of its own.
template <bool FULL>
class PolygonRefiner::Builder : public FaceWriter<FULL> {
public:
    Builder(PolygonRefiner const &refiner, Refinement const &refinement, Level &child)
        : FaceWriter<FULL>(refiner._parent, refinement, child), _refiner(refiner) {}

    void Build() {
        fillFFaces();
        fillEFaces();
        fillVFaces();
        if constexpr (FULL) {
            finishEdges();
        }
    }

private:
    using Writer = FaceWriter<FULL>;
    using typename Writer::EdgeSide;
    using typename Writer::NextFace;
    using typename Writer::Side;
    using Writer::_c;
    using Writer::_edges;
    using Writer::_p;
    using Writer::_refinement;
    using Writer::addCorner;
    using Writer::beginFace;
    using Writer::fVertex;
    using Writer::kFirst;
    using Writer::kSecond;

    Index vVertex(Index pVert) const { return _refinement.GetVertexChildVertex(pVert); }
    // The first side of a spoke runs from its V-vertex, as in the hexagonal step; that of another edge
    // is in the first of its two faces.
    static EdgeSide fFaceEdge(Index corner, Side side) { return {corner, side}; }
    EdgeSide spoke(Index corner, Side side) const {
        return {FULL ? _refiner._spokes[std::size_t(corner)] : Far::INDEX_INVALID, side};
    }
    // Seen from the E-face.
    EdgeSide endEdge(std::size_t end) const {
        if (!FULL || _refiner._endEdges[end] != kJoinedEnd) {
            return {_refiner._endEdges[end], kFirst};
        }
        auto const digon =
            std::lower_bound(_refiner._digons.begin(), _refiner._digons.end(), end,
                             [](Digon const &d, std::size_t e) { return d.joinedEnd < e; });
        return {_refiner._endEdges[digon->end], kSecond};
    }

    void fillFFaces();
    void fillEFaces();
    void fillEFace(Index pEdge, NextFace &place);
    void fillVFaces();
    void fillVFace(Index pVert, VFace const &vFace, NextFace &place);
    void finishEdges();

    PolygonRefiner const &_refiner;
};

template <bool FULL>
void PolygonRefiner::Builder<FULL>::fillFFaces() {
    ParallelForRange(_p.numFaces, [this](Index begin, Index end) {
        NextFace place = {begin, _p.faceFirstCorner[begin]};
        for (Index pFace = begin; pFace < end; ++pFace) {
            beginFace(place);
            while (place.corner < _p.faceFirstCorner[pFace + 1]) {
                addCorner(place, fVertex(place.corner), fFaceEdge(place.corner, kFirst));
            }
        }
    });
}

template <bool FULL>
void PolygonRefiner::Builder<FULL>::fillEFaces() {
    ParallelForRange(_p.numEdges, [this](Index begin, Index end) {
        ChildCounts const &before = _refiner._edgeCounts[std::size_t(begin / kParallelRange)];
        NextFace place = {_p.numFaces + Index(before.faces), _p.numCorners + Index(before.corners)};
        for (Index pEdge = begin; pEdge < end; ++pEdge) {
            if (_refiner.makesEFace(pEdge)) {
                fillEFace(pEdge, place);
            }
        }
    });
}

template <bool FULL>
void PolygonRefiner::Builder<FULL>::fillEFace(Index pEdge, NextFace &place) {
    std::size_t const end0 = getFirstEnd(pEdge);
    Index const vVertex0 = vVertex(_p.edgeVerts[pEdge][0]);
    Index const vVertex1 = vVertex(_p.edgeVerts[pEdge][1]);
    Index const startA = _p.GetSideCorner(pEdge, 0);
    Index const endA = _p.GetNextCorner(_p.edgeFaces[pEdge][0], startA);
    beginFace(place);
    if (_p.IsBoundary(pEdge)) {
        addCorner(place, vVertex0, endEdge(end0));
        addCorner(place, vVertex1, spoke(endA, kFirst));
        addCorner(place, fVertex(endA), fFaceEdge(startA, kSecond));
        addCorner(place, fVertex(startA), spoke(startA, kSecond));
        return;
    }
    Index const startB = _p.GetSideCorner(pEdge, 1);
    Index const endB = _p.GetNextCorner(_p.edgeFaces[pEdge][1], startB);
    if (_refiner.isQuad(pEdge)) {
        addCorner(place, fVertex(endB), fFaceEdge(startB, kSecond));
        addCorner(place, fVertex(startB), endEdge(end0 + 1));
        addCorner(place, fVertex(endA), fFaceEdge(startA, kSecond));
        addCorner(place, fVertex(startA), endEdge(end0));
        return;
    }
    addCorner(place, vVertex0, spoke(endB, kFirst));
    addCorner(place, fVertex(endB), fFaceEdge(startB, kSecond));
    addCorner(place, fVertex(startB), spoke(startB, kSecond));
    addCorner(place, vVertex1, spoke(endA, kFirst));
    addCorner(place, fVertex(endA), fFaceEdge(startA, kSecond));
    addCorner(place, fVertex(startA), spoke(startA, kSecond));
}

template <bool FULL>
void PolygonRefiner::Builder<FULL>::fillVFaces() {
    ParallelForRange(_p.numVertices, [this](Index begin, Index end) {
        ChildCounts const &before = _refiner._vertexCounts[std::size_t(begin / kParallelRange)];
        NextFace place = {_c.numFaces - _c.numVFaces + Index(before.faces),
                          _p.numCorners +
                              Index(_refiner._edgeCounts.back().corners + before.corners)};
        for (Index pVert = begin; pVert < end; ++pVert) {
            _refiner.forEachVFace(
                pVert, vVertex(pVert) != Far::INDEX_INVALID,
                [&](VFace const &vFace) { fillVFace(pVert, vFace, place); },
                [](VertexFan const &) {});
        }
    });
}

template <bool FULL>
void PolygonRefiner::Builder<FULL>::fillVFace(Index pVert, VFace const &vFace, NextFace &place) {
    auto const cornerAt = [&](Index i) { return _p.GetVertexCorner(vFace.GetPosition(i)); };
    // The edge across that between a face and the one before it.
    auto const edgeTo = [&](Index i) -> EdgeSide {
        if (!FULL) {
            return {Far::INDEX_INVALID, kSecond};
        }
        std::size_t const end = _refiner.findEnd(cornerAt(i));
        // In tri-hex it joins two V-faces, in the order of their vertices.
        bool const isFirst = _refiner.isTriHex() &&
                             _p.edgeVerts[end / 2][end % 2] <= _p.edgeVerts[end / 2][1 - end % 2];
        return {_refiner._endEdges[end], isFirst ? kFirst : kSecond};
    };
    beginFace(place);
    if (vFace.hasVVertex) {
        addCorner(place, vVertex(pVert), spoke(cornerAt(0), kFirst));
        for (Index i = 1; i < vFace.count; ++i) {
            addCorner(place, fVertex(cornerAt(i - 1)), edgeTo(i));
        }
        Index const last = cornerAt(vFace.count - 1);
        addCorner(place, fVertex(last), spoke(last, kSecond));
    } else if (_refiner.isTriHex()) {
        // For each face the F-vertices of two corners, and the edge of the F-face between them.
        auto const cornerBefore = [&](Index i) {
            return _p.GetPrevCorner(_p.vertFaces[vFace.GetPosition(i)], cornerAt(i));
        };
        for (Index i = 1; i <= vFace.count; ++i) {
            addCorner(place, fVertex(cornerBefore(i - 1)), edgeTo(i));
            addCorner(place, fVertex(cornerAt(i)), fFaceEdge(cornerBefore(i), kSecond));
        }
    } else {
        for (Index i = 1; i <= vFace.count; ++i) {
            addCorner(place, fVertex(cornerAt(i)), edgeTo(i + 1));
        }
    }
}

// An edge of one face alone is a boundary, and that face its first side.
template <bool FULL>
void PolygonRefiner::Builder<FULL>::finishEdges() {
    BoundaryKind const kind = _refiner.getBoundaryKind();
    ParallelFor(_c.numEdges, [&](Index cEdge) {
        auto &corners = _edges[std::size_t(cEdge)].corners;
        if (corners[kFirst] == kNoCorner) {
            corners[kFirst] = std::exchange(corners[kSecond], kind);
        } else if (corners[kSecond] == kNoCorner) {
            corners[kSecond] = kind;
        }
    });
    if (!_refiner.isHexagonal()) {
        return;
    }
    // The children of boundaries.
    auto const setKind = [this](Index cEdge, BoundaryKind childKind) {
        _edges[std::size_t(cEdge)].corners[kSecond] = childKind;
    };
    for (Index pEdge : _p.boundaryEdges) {
        if (_p.edgeFaces[pEdge][1] == kFreeBoundary) {
            continue;
        }
        if (!_p.IsSharpBoundaryB(pEdge)) {
            setKind(_refiner._endEdges[getFirstEnd(pEdge)], kSharpBoundaryB);
            continue;
        }
        Index const start = _p.GetSideCorner(pEdge, 0);
        Index const end = _p.GetNextCorner(_p.edgeFaces[pEdge][0], start);
        setKind(start, kSharpBoundaryB);
        setKind(_refiner._spokes[std::size_t(start)], kSharpBoundaryA);
        setKind(_refiner._spokes[std::size_t(end)], kSharpBoundaryA);
    }
}

namespace {

// The vertices whose faces the gaps of an open refinement part.
void findPartedVertices(Refinement const &refinement, Level &child) {
    Level const &parent = *refinement.parent;
    child.partedVerts = ParallelSelect(child.numVVertices, [&](Index cVert) {
        Index const pVert = refinement.GetVVertexParent(cVert);
        int numFans = 0;
        ForEachFan(child, cVert, [&](VertexFan const &) { ++numFans; });
        return numFans > 1 && !parent.IsNonManifold(pVert);
    });
}

} // namespace

void PolygonRefiner::Refine(bool fullTopology, Refinement &refinement, Level &child) {
    BeginRefinement(_parent, _sizes, fullTopology, refinement, child);
    child.isHexagonal = false;
    child.numHexagonalSteps = isHexagonal() ? _parent.numHexagonalSteps + 1 : 0;
    child.hasFirstLineMasks = isHexagonal() && _parent.hasFirstLineMasks;
    child.numVVertices = Index(_vertexCounts.back().vertices);
    child.numVFaces = Index(_vertexCounts.back().faces);
    relate(refinement);
    if (fullTopology) {
        numberEdges();
        Builder<true> builder(*this, refinement, child);
        builder.Build();
        BuildBaseLevel({builder.GetEdges().data(), child.numEdges}, child);
        if (isHexagonal() && !_rules.closeGaps) {
            findPartedVertices(refinement, child);
        }
    } else {
        Builder<false>(*this, refinement, child).Build();
        FinishFaces(child);
    }
    EndRefinement(_tagOptions, refinement, child);
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "truncationRefinement.h"

#include "faceWriter.h"
#include "far_ext/rules/sharpMask.h"
#include "truncationMask.h"

#include <algorithm>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;
using Sdc::Crease;

namespace {

// The corners of the faces of a level by their places around a vertex.
Index getInCorner(Level const &level, Index k) {
    return level.GetPrevCorner(level.vertFaces[k], level.GetVertexCorner(k));
}

// Finds where polygons are cut, at the ends of edges of one vertex at a time.
class EndCutter {
public:
    EndCutter(Hierarchy const &base, Far::ConstIndexArray labels, EndCuts &cuts)
        : _base(base), _mesh(base.mesh.levels[0]), _labels(labels), _cuts(cuts) {}

    void CutClosedFan(Index vert, VertexFan const &fan) {
        int numCuts = 0;
        bool isDart = true; // as long as there are creases alone
        for (Index k = fan.begin; k < fan.end; ++k) {
            Index const edge = _mesh.faceEdges[_mesh.GetVertexCorner(k)];
            numCuts += isCut(edge) ? 1 : 0;
            isDart = isDart && !partsFaces(edge);
        }
        bool const isSharp =
            _mesh.IsNonManifold(vert) || Crease::IsSharp(_mesh.GetVertexSharpness(vert));
        bool const isWhole = isDart && !isSharp && fan.GetSize() != 2;
        for (Index k = fan.begin; k < fan.end; ++k) {
            Index const corner = _mesh.GetVertexCorner(k);
            bool const isEndCut = numCuts < 2 ? !isWhole : isCut(_mesh.faceEdges[corner]);
            setCut(corner, isEndCut);
        }
        if (numCuts == 2 && passes(vert, fan)) {
            for (Index k = fan.begin; k < fan.end; ++k) {
                if (EndCut &cut = _cuts[FindEdgeEnd(_mesh, _mesh.GetVertexCorner(k))];
                    cut == EndCut::Cut) {
                    cut = EndCut::Passed;
                }
            }
        }
    }
    // From boundary to boundary.
    void CutOpenFan(Index vert, VertexFan const &fan) {
        int numCuts = 1;
        for (Index k = fan.begin; k < fan.end; ++k) {
            Index const corner = _mesh.GetVertexCorner(k);
            bool const isEndCut = isCut(_mesh.faceEdges[corner]);
            setCut(corner, isEndCut);
            numCuts += isEndCut ? 1 : 0;
        }
        EndCut &last = _cuts[FindEdgeEnd(_mesh, getInCorner(_mesh, fan.end - 1)) ^ 1u];
        last = EndCut::Cut;
        if (numCuts == 2 && passes(vert, fan)) {
            last = EndCut::Passed;
            _cuts[FindEdgeEnd(_mesh, _mesh.GetVertexCorner(fan.begin))] = EndCut::Passed;
        }
    }

private:
    void setCut(Index corner, bool isEndCut) {
        _cuts[FindEdgeEnd(_mesh, corner)] = isEndCut ? EndCut::Cut : EndCut::Whole;
    }
    // Whether a line passes the vertex whose polygon has two cuts.
    bool passes(Index vert, VertexFan const &fan) const {
        SharpVertex const *const sharp = _mesh.FindSharpVertex(vert);
        if (!sharp || sharp->rule != Crease::RULE_CREASE || _mesh.IsNonManifold(vert)) {
            return false;
        }
        Index cuts[2] = {fan.begin, fan.end}; // positions of the faces behind them
        if (fan.isClosed) {
            Index *next = cuts;
            for (Index k = fan.begin; k < fan.end; ++k) {
                if (_cuts[FindEdgeEnd(_mesh, _mesh.GetVertexCorner(k))] == EndCut::Cut) {
                    *next++ = k;
                }
            }
        }
        Index const before = cuts[1] - cuts[0];
        Index const behind = fan.isClosed ? fan.GetSize() - before : before;
        if (std::min(before, behind) < 2 || std::max(before, behind) > kMaxPassedFaces) {
            return false;
        }
        // Where faces are kept apart, so must the halves of the polygon be: as surface faces.
        if (fan.isClosed) {
            bool isParting = false;
            bool isInfinite = true;
            for (Index const k : cuts) {
                Index const edge = _mesh.faceEdges[_mesh.GetVertexCorner(k)];
                isParting = isParting || partsFaces(edge);
                isInfinite = isInfinite && Crease::IsInfinite(_mesh.GetEdgeSharpness(edge));
            }
            if (isParting && !isInfinite) {
                return false;
            }
        }
        auto const passesValues = [&](FVarChannel const &channel) {
            Level const &values = channel.values.levels[0];
            for (Index k = fan.begin; k < fan.end; ++k) {
                Index const value = values.faceVerts[_mesh.GetVertexCorner(k)];
                if (Crease::IsSharp(values.GetVertexSharpness(value))) {
                    return false;
                }
            }
            auto const isSeamAt = [&](Index k) {
                return isSeam(_mesh.faceEdges[_mesh.GetVertexCorner(k)], channel);
            };
            return !fan.isClosed || isSeamAt(cuts[0]) == isSeamAt(cuts[1]);
        };
        return std::all_of(_base.channels.begin(), _base.channels.end(), passesValues);
    }
    bool isCut(Index edge) const {
        return _mesh.IsBoundary(edge) || Crease::IsSharp(_mesh.GetEdgeSharpness(edge)) ||
               partsFaces(edge);
    }
    // Whether the faces of an interior edge must be kept apart.
    bool partsFaces(Index edge) const {
        IndexPair const &faces = _mesh.edgeFaces[edge];
        return (!_labels.empty() && _labels[faces[0]] != _labels[faces[1]]) ||
               _mesh.GetHoles(faces[0]) != _mesh.GetHoles(faces[1]) || isSeam(edge);
    }
    bool isSeam(Index edge) const {
        return std::any_of(_base.channels.begin(), _base.channels.end(),
                           [&](FVarChannel const &channel) { return isSeam(edge, channel); });
    }
    bool isSeam(Index edge, FVarChannel const &channel) const {
        auto const getValueEdge = [&](int side) {
            return channel.levels[0].GetFaceEdge(_mesh.edgeFaces[edge][side],
                                                 _mesh.edgeFaceLocals[edge][side]);
        };
        return getValueEdge(0) != getValueEdge(1);
    }

    Hierarchy const &_base;
    Level const &_mesh;
    Far::ConstIndexArray const _labels;
    EndCuts &_cuts;
};

} // namespace

EndCuts FindEndCuts(Hierarchy const &base, Far::ConstIndexArray labels) {
    Level const &mesh = base.mesh.levels[0];
    EndCuts cuts(2 * std::size_t(mesh.numEdges), EndCut::Whole);
    EndCutter cutter(base, labels, cuts);
    ParallelFor(mesh.numVertices, [&](Index vert) {
        ForEachFan(mesh, vert, [&](VertexFan const &fan) {
            if (fan.isClosed) {
                cutter.CutClosedFan(vert, fan);
            } else {
                cutter.CutOpenFan(vert, fan);
            }
        });
    });
    return cuts;
}

EndCuts GetEndCutsOfChannel(Level const &mesh, EndCuts const &cuts, FVarLevel const &channel) {
    Level const &values = *channel.values;
    EndCuts result(2 * std::size_t(values.numEdges), EndCut::Whole);
    // Faces have the same corners in both; the two sides of an edge agree on its ends.
    ParallelFor(values.numEdges, [&](Index edge) {
        Index const corner = values.GetSideCorner(edge, 0);
        std::size_t const end = FindEdgeEnd(mesh, corner);
        result[2 * std::size_t(edge)] = cuts[end];
        result[2 * std::size_t(edge) + 1] = cuts[end ^ 1u];
    });
    return result;
}

TruncationRefiner::TruncationRefiner(Level const &parent, EndCuts cuts, TagOptions tagOptions)
    : _parent(parent), _cuts(std::move(cuts)), _tagOptions(tagOptions) {
    _vertexCounts = ParallelSums<ChildCounts>(_parent.numVertices, [this](Index begin, Index end) {
        ChildCounts counts;
        for (Index pVert = begin; pVert < end; ++pVert) {
            counts.vertices += isCut(pVert) ? 1 : 0;
            forEachVFace(pVert, [&](VFace const &vFace) {
                ++counts.faces;
                counts.corners += vFace.count + (vFace.hasVVertex ? 2 : vFace.isHalf ? 1 : 0);
                counts.edges += vFace.isHalf ? 1 : 0;
            });
        }
        return counts;
    });
    _edgeCounts = ParallelSums<ChildCounts>(_parent.numEdges, [this](Index begin, Index end) {
        ChildCounts counts;
        for (std::size_t edgeEnd = 2 * std::size_t(begin); edgeEnd < 2 * std::size_t(end);
             ++edgeEnd) {
            counts.edges += _cuts[edgeEnd] == EndCut::Cut ? 1 : 0;
        }
        return counts;
    });
    ChildCounts const &vertices = _vertexCounts.back();
    _sizes.vertices = vertices.vertices + _parent.numCorners + _parent.GetNumBoundaries();
    _sizes.edges = std::int64_t(_parent.numCorners) + _parent.numEdges + _edgeCounts.back().edges +
                   vertices.edges;
    _sizes.faces = _parent.numFaces + vertices.faces;
    _sizes.corners = 2 * std::int64_t(_parent.numCorners) + vertices.corners;
    // The middle of a boundary, and a spoke at each end; but for two spokes where it passes a vertex.
    _sizes.freeBoundaries = 3 * std::int64_t(_parent.numFreeBoundaries);
    _sizes.sharpBoundariesA = 3 * std::int64_t(_parent.numSharpBoundariesA) - 2 * vertices.edges;
    _sizes.sharpBoundariesB = vertices.edges;
}

// Whether it stays, as one without edges does.
bool TruncationRefiner::isCut(Index pVert) const {
    Index const begin = _parent.vertFirstEdge[pVert];
    Index const end = _parent.vertFirstEdge[pVert + 1];
    Far::LocalIndex const *const locals = _parent.GetVertexEdgeLocals(pVert);
    for (Index i = begin; i < end; ++i) {
        if (_cuts[2 * std::size_t(_parent.vertEdges[i]) + locals[i - begin]] == EndCut::Cut) {
            return true;
        }
    }
    return begin == end;
}

// Calls function(vFace) for the V-faces of a vertex, in order.
template <typename FUNCTION>
void TruncationRefiner::forEachVFace(Index pVert, FUNCTION function) const {
    ForEachFan(_parent, pVert, [&](VertexFan const &fan) {
        auto const beginsWedge = [&](Index k) {
            return _cuts[FindEdgeEnd(_parent, _parent.GetVertexCorner(k))] != EndCut::Whole;
        };
        Index start = fan.begin;
        while (start < fan.end && !beginsWedge(start)) {
            ++start;
        }
        Index const size = fan.GetSize();
        if (start == fan.end) {
            function(VFace{fan, fan.begin, size, false});
            return;
        }
        if (_cuts[FindEdgeEnd(_parent, _parent.GetVertexCorner(start))] == EndCut::Passed) {
            int end = 0;
            for (Index i = 1; fan.isClosed && i < size && end == 0; ++i) {
                end = beginsWedge(fan.Advance(start, i)) ? int(i) : 0;
            }
            function(VFace{fan, start, size, false, !fan.isClosed, end});
            return;
        }
        Index begin = 0; // of the wedge, seen from the start
        for (Index i = 1; i <= size; ++i) {
            if (i == size || beginsWedge(fan.Advance(start, i))) {
                function(VFace{fan, fan.Advance(start, begin), i - begin, true});
                begin = i;
            }
        }
    });
}

void TruncationRefiner::listCrossedFaces(Level &child) const {
    std::vector<std::vector<CrossedFace>> facesOfRanges(
        std::size_t(GetNumParallelRanges(_parent.numVertices)));
    ParallelForRange(_parent.numVertices, [&](Index begin, Index end) {
        auto const range = std::size_t(begin / kParallelRange);
        Index cFace = _parent.numFaces + Index(_vertexCounts[range].faces);
        for (Index pVert = begin; pVert < end; ++pVert) {
            forEachVFace(pVert, [&](VFace const &vFace) {
                if (vFace.diagonalEnd > 0) {
                    facesOfRanges[range].push_back({cFace, vFace.diagonalEnd});
                }
                ++cFace;
            });
        }
    });
    child.crossedFaces.clear();
    for (std::vector<CrossedFace> const &faces : facesOfRanges) {
        child.crossedFaces.insert(child.crossedFaces.end(), faces.begin(), faces.end());
    }
}

void TruncationRefiner::relate(Refinement &refinement) const {
    refinement.isTruncation = true;
    refinement.edgeChildFaces.Resize(std::size_t(_parent.numEdges));
    std::fill_n(refinement.edgeChildFaces.data(), _parent.numEdges, Far::INDEX_INVALID);
    NumberVVertices(
        _vertexCounts, [this](Index pVert) { return isCut(pVert); }, refinement);
}

// Fills the faces of a child and, for FULL, the sides of its edges: in this order those across the
// corners of the F-faces, those along the parent's edges, the spokes, and the long edges of half faces.
template <bool FULL>
class TruncationRefiner::Builder : public FaceWriter<FULL> {
public:
    Builder(TruncationRefiner const &refiner, Refinement const &refinement, Level &child)
        : FaceWriter<FULL>(refiner._parent, refinement, child), _refiner(refiner) {}

    void Build() {
        if constexpr (FULL) {
            numberSpokes();
        }
        fillFFaces();
        fillVFaces();
        if constexpr (FULL) {
            finishBoundaries();
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

    // The vertex at the far end of the edge that a face begins to run along in a corner.
    Index farVertex(Index corner) const {
        return GetEdgeEndVertex(_refinement, FindEdgeEnd(_p, corner) ^ 1u);
    }
    // It runs around the F-face.
    EdgeSide cornerEdge(Index corner, Side side) const { return {corner, side}; }
    EdgeSide spoke(std::size_t end, Side side) const {
        return {FULL ? _spokes[end] : Far::INDEX_INVALID, side};
    }

    void numberSpokes() {
        _spokes.Resize(2 * std::size_t(_p.numEdges));
        ParallelForRange(_p.numEdges, [this](Index begin, Index end) {
            ChildCounts const &before = _refiner._edgeCounts[std::size_t(begin / kParallelRange)];
            Index cEdge = _p.numCorners + _p.numEdges + Index(before.edges);
            for (std::size_t i = 2 * std::size_t(begin); i < 2 * std::size_t(end); ++i) {
                _spokes[i] = _refiner._cuts[i] == EndCut::Cut ? cEdge++ : Far::INDEX_INVALID;
            }
        });
    }
    void fillFFaces() {
        ParallelForRange(_p.numFaces, [this](Index begin, Index end) {
            NextFace place = {begin, 2 * _p.faceFirstCorner[begin]};
            for (Index pFace = begin; pFace < end; ++pFace) {
                beginFace(place);
                Index corner = _p.faceFirstCorner[pFace];
                for (; corner < _p.faceFirstCorner[pFace + 1]; ++corner) {
                    Index const edge = _p.faceEdges[corner];
                    bool const isFirst = _p.GetSideCorner(edge, 0) == corner;
                    addCorner(place, farVertex(_p.GetPrevCorner(pFace, corner)),
                              cornerEdge(corner, kFirst));
                    addCorner(place, fVertex(corner),
                              {_p.numCorners + edge, isFirst ? kFirst : kSecond});
                }
            }
        });
    }
    void fillVFaces() {
        ParallelForRange(_p.numVertices, [this](Index begin, Index end) {
            ChildCounts const &before = _refiner._vertexCounts[std::size_t(begin / kParallelRange)];
            NextFace place = {_p.numFaces + Index(before.faces),
                              2 * _p.numCorners + Index(before.corners)};
            Index longEdge = _p.numCorners + _p.numEdges +
                             Index(_refiner._edgeCounts.back().edges + before.edges);
            for (Index pVert = begin; pVert < end; ++pVert) {
                _refiner.forEachVFace(pVert, [&](VFace const &vFace) {
                    if (vFace.diagonalEnd > 0) {
                        fillCrossedFace(vFace, place);
                    } else if (vFace.isHalf) {
                        fillHalfFace(vFace, longEdge++, place);
                    } else {
                        fillVFace(pVert, vFace, place);
                    }
                });
            }
        });
    }
    void fillCrossedFace(VFace const &vFace, NextFace &place) {
        beginFace(place);
        addFVertices(vFace, place);
    }
    void addFVertices(VFace const &vFace, NextFace &place) {
        for (Index i = 0; i < vFace.count; ++i) {
            Index const corner = _p.GetVertexCorner(vFace.GetPosition(i));
            addCorner(place, fVertex(corner), cornerEdge(corner, kSecond));
        }
    }
    void fillHalfFace(VFace const &vFace, Index longEdge, NextFace &place) {
        beginFace(place);
        Index const last = getInCorner(_p, vFace.GetPosition(vFace.count - 1));
        addCorner(place, farVertex(last), {longEdge, kFirst});
        if constexpr (FULL) {
            _edges[std::size_t(longEdge)].corners[kSecond] = kSharpBoundaryB;
        }
        addFVertices(vFace, place);
    }
    void fillVFace(Index pVert, VFace const &vFace, NextFace &place) {
        auto const cornerAt = [&](Index i) { return _p.GetVertexCorner(vFace.GetPosition(i)); };
        Index const first = cornerAt(0);
        beginFace(place);
        for (Index i = 1; i < vFace.count; ++i) {
            addCorner(place, fVertex(cornerAt(i)), cornerEdge(cornerAt(i), kSecond));
        }
        if (vFace.hasVVertex) {
            Index const last = getInCorner(_p, vFace.GetPosition(vFace.count - 1));
            addCorner(place, farVertex(last), spoke(FindEdgeEnd(_p, last) ^ 1u, kSecond));
            addCorner(place, _refinement.GetVertexChildVertex(pVert),
                      spoke(FindEdgeEnd(_p, first), kFirst));
        }
        addCorner(place, fVertex(first), cornerEdge(first, kSecond));
    }
    // An edge of one face alone is a boundary, and that face its first side.
    void finishBoundaries() {
        for (Index pEdge : _p.boundaryEdges) {
            std::size_t const end = 2 * std::size_t(pEdge);
            for (Index cEdge : {_p.numCorners + pEdge, _spokes[end], _spokes[end + 1]}) {
                if (cEdge == Far::INDEX_INVALID) { // it passes the vertex
                    continue;
                }
                auto &corners = _edges[std::size_t(cEdge)].corners;
                if (corners[kFirst] == kNoCorner) {
                    std::swap(corners[kFirst], corners[kSecond]);
                }
                corners[kSecond] = _p.edgeFaces[pEdge][1];
            }
        }
    }

    TruncationRefiner const &_refiner;
    Buffer<Index> _spokes; // by end of an edge, INDEX_INVALID where there is none
};

void TruncationRefiner::Refine(bool fullTopology, Refinement &refinement, Level &child) const {
    BeginRefinement(_parent, _sizes, fullTopology, refinement, child);
    child.isHexagonal = false;
    child.numHexagonalSteps = 0;
    child.numFFaceCorners = 2 * _parent.numCorners;
    child.numVVertices = Index(_vertexCounts.back().vertices);
    child.numVFaces = Index(_vertexCounts.back().faces);
    relate(refinement);
    listCrossedFaces(child);
    if (fullTopology) {
        Builder<true> builder(*this, refinement, child);
        builder.Build();
        BuildBaseLevel({builder.GetEdges().data(), child.numEdges}, child);
    } else {
        Builder<false>(*this, refinement, child).Build();
        FinishFaces(child);
    }
    EndRefinement(_tagOptions, refinement, child);
}

} // namespace OpenSubdivHex::FarExt::internal

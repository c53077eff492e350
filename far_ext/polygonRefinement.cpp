// SPDX-License-Identifier: Apache-2.0
#include "polygonRefinement.h"

#include "baseLevel.h"
#include "fvarLevel.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

using Index = Far::Index;

PolygonRules GetRulesOfChannel(LevelTopology const &mesh, PolygonRules const &rules,
                               FVarLevel const &channel) {
    PolygonRules result = rules;
    result.flatEdges.assign(std::size_t(channel.topology.numEdges), 0);
    for (std::size_t edge = 0; edge < rules.flatEdges.size(); ++edge) {
        std::size_t const k = 2 * edge;
        Index const valueEdge = channel.GetFaceEdge(mesh.edgeFaces[k], mesh.edgeFaceLocals[k]);
        result.flatEdges[std::size_t(valueEdge)] = rules.flatEdges[edge];
    }
    return result;
}

// The polygons, one after the other, with their edges.
class PolygonStep::Builder {
public:
    // An edge that only one face has will be a boundary of the kind given.
    Builder(LevelSizes const &sizes, Index numVVertices, BoundaryKind boundaryKind)
        : _numVVertices(numVVertices),
          _edges(std::size_t(sizes.edges), EdgeSides{{Far::INDEX_INVALID, boundaryKind}}) {
        _faceFirstCorner.reserve(std::size_t(sizes.faces) + 1);
        _faceVerts.reserve(std::size_t(sizes.corners));
    }

    void BeginFace() { _faceFirstCorner.push_back(Index(_faceVerts.size())); }
    // Adds a vertex to the face begun last, and the edge from there to the next one.  The first
    // side of a spoke runs from its V-vertex, as in the hexagonal step; that of another edge is the
    // first to come.  So both sides are the same in the mesh and in its channels, whose faces come
    // in another order.
    void AddCorner(Index vert, Index edge) {
        EdgeSides &sides = _edges[std::size_t(edge)];
        bool const isSecond = sides.corners[0] != Far::INDEX_INVALID;
        sides.corners[isSecond ? 1 : 0] = Index(_faceVerts.size());
        if (isSecond && vert < _numVVertices) {
            std::swap(sides.corners[0], sides.corners[1]);
        }
        _faceVerts.push_back(vert);
    }
    void SetBoundaryKind(Index edge, BoundaryKind kind) {
        _edges[std::size_t(edge)].corners[1] = kind;
    }

    std::vector<EdgeSides> const &GetEdges() const { return _edges; }

    void StoreFaces(LevelTopology &level) {
        BeginFace(); // the end of the last one
        level.faceFirstCorner.Resize(_faceFirstCorner.size());
        std::copy(_faceFirstCorner.begin(), _faceFirstCorner.end(), level.faceFirstCorner.data());
        level.faceVerts.Resize(_faceVerts.size());
        std::copy(_faceVerts.begin(), _faceVerts.end(), level.faceVerts.data());
    }

private:
    Index _numVVertices;
    std::vector<Index> _faceFirstCorner;
    std::vector<Index> _faceVerts;
    std::vector<EdgeSides> _edges;
};

PolygonStep::PolygonStep(LevelTopology &parent, PolygonRules rules, Sdc::Options sdcOptions)
    : _parent(parent), _rules(std::move(rules)), _sdcOptions(sdcOptions) {
    planVertices();
    planEdges();
}

bool PolygonStep::isQuad(Index pEdge) const {
    switch (_rules.scheme) {
    case SchemeType::Hexagonal:
        return !_rules.flatEdges.empty() && _rules.flatEdges[std::size_t(pEdge)];
    case SchemeType::DooSabin:
        return !_parent.IsBoundary(pEdge);
    case SchemeType::TriHex:
        break;
    }
    return false;
}

bool PolygonStep::makesEFace(Index pEdge) const {
    return isQuad(pEdge) || (isHexagonal() && !_parent.IsSharpBoundaryB(pEdge));
}

void PolygonStep::addVFace(Index vVertex, VertexFan const &fan, Index begin, Index count) {
    _vFaces.push_back({_vFaceCorners.size(), vVertex});
    for (Index i = 0; i < count; ++i) {
        Index const k = begin + i < fan.end ? begin + i : begin + i - (fan.end - fan.begin);
        Index const corner = _parent.GetVertexCorner(k);
        _vFaceCorners.push_back(corner);
        if (isTriHex()) {
            _vFaceCorners.push_back(_parent.GetPrevCorner(_parent.vertFaces[k], corner));
        }
    }
    _sizes.corners += std::int64_t(_vFaceCorners.size() - _vFaces.back().firstCorner) +
                      (vVertex == Far::INDEX_INVALID ? 0 : 1);
}

// The V-faces of a fan.
void PolygonStep::planFan(Index pVert, VertexFan const &fan) {
    Index const vVertex = _vertChildVerts[std::size_t(pVert)];
    Index const size = fan.end - fan.begin;
    if (vVertex == Far::INDEX_INVALID) {
        if (fan.isClosed && size == 2 && !isTriHex()) {
            _digons.emplace_back(endAt(_parent.GetVertexCorner(fan.begin)),
                                 endAt(_parent.GetVertexCorner(fan.begin + 1)));
        } else if (fan.isClosed && _rules.closeGaps) {
            addVFace(vVertex, fan, fan.begin, size);
        }
        return;
    }
    if (_rules.flatEdges.empty() || !_rules.closeGaps) {
        return;
    }
    // A run begins with a face that has another edge than a quad's before it: in an open fan, the
    // first.
    Index start = fan.begin;
    while (fan.isClosed && isQuad(_parent.faceEdges[_parent.GetVertexCorner(start)])) {
        ++start;
    }
    Index count = 1;
    for (Index i = 0; i < size; ++i) {
        Index const k = start + i < fan.end ? start + i : start + i - size;
        if (isQuad(inEdge(k))) {
            ++count;
            continue;
        }
        if (count > 1) {
            Index const begin = start + i - count + 1;
            addVFace(vVertex, fan, begin < fan.end ? begin : begin - size, count);
        }
        count = 1;
    }
}

void PolygonStep::planVertices() {
    _vertChildVerts.assign(std::size_t(_parent.numVertices), Far::INDEX_INVALID);
    for (Index pVert = 0; pVert < _parent.numVertices && isHexagonal(); ++pVert) {
        Index const begin = _parent.vertFirstEdge[pVert];
        Index const end = _parent.vertFirstEdge[pVert + 1];
        bool const hasQuadsAllAround =
            begin < end &&
            std::all_of(_parent.vertEdges.data() + begin, _parent.vertEdges.data() + end,
                        [this](Index pEdge) { return isQuad(pEdge); });
        if (!hasQuadsAllAround) {
            _vertChildVerts[std::size_t(pVert)] = Index(_sizes.vertices++);
        }
    }
    for (Index pVert = 0; pVert < _parent.numVertices; ++pVert) {
        ForEachFan(_parent, pVert, [&](VertexFan const &fan) { planFan(pVert, fan); });
    }
    _sizes.vertices += _parent.numCorners;
    _sizes.corners += _parent.numCorners;
    _sizes.faces = std::int64_t(_parent.numFaces) + std::int64_t(_vFaces.size());
}

// Edges are numbered in this order: those of the F-faces, the spokes, those of the edges.
void PolygonStep::planEdges() {
    _sizes.edges = _parent.numCorners;
    _spokes.assign(std::size_t(_parent.numCorners), Far::INDEX_INVALID);
    for (Index pFace = 0; pFace < _parent.numFaces && isHexagonal(); ++pFace) {
        Index const end = _parent.faceFirstCorner[pFace + 1];
        for (Index corner = _parent.faceFirstCorner[pFace]; corner < end; ++corner) {
            Index const prev = _parent.GetPrevCorner(pFace, corner);
            if (!isQuad(_parent.faceEdges[corner]) || !isQuad(_parent.faceEdges[prev])) {
                _spokes[std::size_t(corner)] = Index(_sizes.edges++);
            }
        }
    }
    _endEdges.assign(2 * std::size_t(_parent.numEdges), Far::INDEX_INVALID);
    if (isTriHex()) {
        // An edge between two V-faces, or one and a border.
        for (std::size_t i = 0; i < _vFaceCorners.size(); i += 2) {
            std::size_t const first = 2 * std::size_t(_parent.faceEdges[_vFaceCorners[i]]);
            _endEdges[first] = _endEdges[first + 1] = 0;
        }
        for (std::size_t first = 0; first < _endEdges.size(); first += 2) {
            if (_endEdges[first] == 0) {
                _endEdges[first] = _endEdges[first + 1] = Index(_sizes.edges++);
            }
        }
        return;
    }
    for (Index pEdge = 0; pEdge < _parent.numEdges; ++pEdge) {
        if (!makesEFace(pEdge)) {
            continue;
        }
        ++_sizes.faces;
        std::size_t const first = 2 * std::size_t(pEdge);
        bool const isBoundary = _parent.IsBoundary(pEdge);
        bool const isHexagon = !isBoundary && !isQuad(pEdge);
        _sizes.corners +=
            isHexagon ? HexIndexing::kNumEFaceCorners : HexIndexing::kNumBoundaryEFaceCorners;
        if (!isHexagon) {
            _endEdges[first] = Index(_sizes.edges++);
            _endEdges[first + 1] = isBoundary ? Far::INDEX_INVALID : Index(_sizes.edges++);
        }
    }
    joinDigons();
}

// Two quads that would have a face of two vertices between them share an edge: the one with the
// higher index goes.
void PolygonStep::joinDigons() {
    if (_digons.empty()) {
        return;
    }
    std::vector<Index> removed;
    for (auto &[end0, end1] : _digons) {
        if (_endEdges[end0] > _endEdges[end1]) {
            std::swap(end0, end1);
        }
        removed.push_back(_endEdges[end1]);
        _endEdges[end1] = _endEdges[end0];
    }
    std::sort(removed.begin(), removed.end());
    for (Index &edge : _endEdges) {
        edge -= Index(std::lower_bound(removed.begin(), removed.end(), edge) - removed.begin());
    }
    _sizes.edges -= std::int64_t(removed.size());
}

// The end of an edge, as a position in _endEdges, at the vertex of the corner where one of its
// faces begins to run along it.
std::size_t PolygonStep::endAt(Index startCorner) const {
    Index const pEdge = _parent.faceEdges[startCorner];
    return 2 * std::size_t(pEdge) + (_parent.GetSideCorner(pEdge, 0) == startCorner ? 0 : 1);
}

void PolygonStep::buildEFace(Index pEdge, Builder &builder) const {
    std::size_t const k = 2 * std::size_t(pEdge);
    auto fVertex = [this](Index corner) { return _parent.GetCornerChildVertex(corner); };
    auto vVertex = [&](int end) {
        return _vertChildVerts[std::size_t(_parent.edgeVerts[k + end])];
    };
    auto spoke = [this](Index corner) { return _spokes[std::size_t(corner)]; };
    Index const startA = _parent.GetSideCorner(pEdge, 0);
    Index const endA = _parent.GetNextCorner(_parent.edgeFaces[k], startA);
    Index const *const endEdges = _endEdges.data() + k;
    builder.BeginFace();
    if (_parent.IsBoundary(pEdge)) {
        bool const isFree = _parent.edgeFaces[k + 1] == kFreeBoundary;
        builder.SetBoundaryKind(endEdges[0], isFree ? kFreeBoundary : kSharpBoundaryB);
        builder.AddCorner(vVertex(0), endEdges[0]);
        builder.AddCorner(vVertex(1), spoke(endA));
        builder.AddCorner(fVertex(endA), startA);
        builder.AddCorner(fVertex(startA), spoke(startA));
        return;
    }
    Index const startB = _parent.GetSideCorner(pEdge, 1);
    Index const endB = _parent.GetNextCorner(_parent.edgeFaces[k + 1], startB);
    if (isQuad(pEdge)) {
        builder.AddCorner(fVertex(endB), startB);
        builder.AddCorner(fVertex(startB), endEdges[1]);
        builder.AddCorner(fVertex(endA), startA);
        builder.AddCorner(fVertex(startA), endEdges[0]);
        return;
    }
    builder.AddCorner(vVertex(0), spoke(endB));
    builder.AddCorner(fVertex(endB), startB);
    builder.AddCorner(fVertex(startB), spoke(startB));
    builder.AddCorner(vVertex(1), spoke(endA));
    builder.AddCorner(fVertex(endA), startA);
    builder.AddCorner(fVertex(startA), spoke(startA));
}

void PolygonStep::buildVFace(VFace const &vFace, std::size_t endCorner, Builder &builder) const {
    Index const *const corners = _vFaceCorners.data() + vFace.firstCorner;
    std::size_t const numCorners = endCorner - vFace.firstCorner;
    auto fVertex = [this](Index corner) { return _parent.GetCornerChildVertex(corner); };
    auto spoke = [this](Index corner) { return _spokes[std::size_t(corner)]; };
    auto edgeTo = [&](std::size_t i) {
        // In tri-hex every other edge is that of an F-face, between the corner before and this one.
        return isTriHex() && i % 2 == 1 ? corners[i] : _endEdges[endAt(corners[i])];
    };
    builder.BeginFace();
    if (vFace.vVertex == Far::INDEX_INVALID) {
        for (std::size_t i = 1; i <= numCorners; ++i) {
            builder.AddCorner(fVertex(corners[i % numCorners]), edgeTo((i + 1) % numCorners));
        }
        return;
    }
    builder.AddCorner(vFace.vVertex, spoke(corners[0]));
    for (std::size_t i = 0; i + 1 < numCorners; ++i) {
        builder.AddCorner(fVertex(corners[i]), edgeTo(i + 1));
    }
    builder.AddCorner(fVertex(corners[numCorners - 1]), spoke(corners[numCorners - 1]));
}

// What the parent knows of its children.
void PolygonStep::relateParent() {
    _parent.numVVertices = Index(_sizes.vertices - _parent.numCorners);
    _parent.vertChildVerts.Resize(0);
    _parent.vVertexParents.Resize(0);
    if (_parent.numVVertices != _parent.numVertices) {
        _parent.vertChildVerts.Resize(_vertChildVerts.size());
        _parent.vVertexParents.Resize(std::size_t(_parent.numVVertices));
        for (Index pVert = 0; pVert < _parent.numVertices; ++pVert) {
            Index const cVert = _vertChildVerts[std::size_t(pVert)];
            _parent.vertChildVerts[std::size_t(pVert)] = cVert;
            if (cVert != Far::INDEX_INVALID) {
                _parent.vVertexParents[std::size_t(cVert)] = pVert;
            }
        }
    }
    _parent.faceChildFaces.Resize(std::size_t(_parent.numFaces));
    std::iota(_parent.faceChildFaces.data(), _parent.faceChildFaces.data() + _parent.numFaces, 0);
    _parent.edgeChildFaces.Resize(std::size_t(_parent.numEdges));
    Index cFace = _parent.numFaces;
    for (Index pEdge = 0; pEdge < _parent.numEdges; ++pEdge) {
        _parent.edgeChildFaces[std::size_t(pEdge)] =
            makesEFace(pEdge) ? cFace++ : Far::INDEX_INVALID;
    }
}

void PolygonStep::buildFaces(Builder &builder) const {
    for (Index pFace = 0; pFace < _parent.numFaces; ++pFace) {
        builder.BeginFace();
        Index const end = _parent.faceFirstCorner[pFace + 1];
        for (Index corner = _parent.faceFirstCorner[pFace]; corner < end; ++corner) {
            builder.AddCorner(_parent.GetCornerChildVertex(corner), corner);
        }
    }
    for (Index pEdge = 0; pEdge < _parent.numEdges; ++pEdge) {
        if (makesEFace(pEdge)) {
            buildEFace(pEdge, builder);
        } else if (isHexagonal()) {
            Index const start = _parent.GetSideCorner(pEdge, 0);
            Index const end =
                _parent.GetNextCorner(_parent.edgeFaces[2 * std::size_t(pEdge)], start);
            builder.SetBoundaryKind(start, kSharpBoundaryB);
            builder.SetBoundaryKind(_spokes[std::size_t(start)], kSharpBoundaryA);
            builder.SetBoundaryKind(_spokes[std::size_t(end)], kSharpBoundaryA);
        }
    }
    for (std::size_t i = 0; i < _vFaces.size(); ++i) {
        bool const isLast = i + 1 == _vFaces.size();
        buildVFace(_vFaces[i], isLast ? _vFaceCorners.size() : _vFaces[i + 1].firstCorner, builder);
    }
}

namespace {

// The vertices whose faces the gaps of an open refinement have parted, now or in a level before.
void findPartedVertices(LevelTopology const &parent, LevelTopology &child) {
    auto const contains = [](std::vector<Index> const &verts, Index vert) {
        return std::binary_search(verts.begin(), verts.end(), vert);
    };
    for (Index cVert = 0; cVert < parent.numVVertices; ++cVert) {
        Index const pVert = parent.GetVVertexParent(cVert);
        int numFans = 0;
        ForEachFan(child, cVert, [&](VertexFan const &) { ++numFans; });
        bool const wasOne = !contains(parent.nonManifoldVerts, pVert);
        if (numFans > 1 && (wasOne || contains(parent.partedVerts, pVert))) {
            child.partedVerts.push_back(cVert);
        }
    }
}

void removeRelations(LevelTopology &level) {
    level.hasFullTopology = false;
    for (Buffer<Index> *array : {&level.faceEdges, &level.edgeVerts, &level.edgeFaces,
                                 &level.boundaryEdges, &level.halfFaces, &level.vertFirstFace,
                                 &level.vertFaces, &level.vertFirstEdge, &level.vertEdges}) {
        array->Resize(0);
    }
    for (Buffer<Far::LocalIndex> *array :
         {&level.edgeFaceLocals, &level.vertFaceLocals, &level.vertEdgeLocals}) {
        array->Resize(0);
    }
}

} // namespace

void PolygonStep::Refine(bool fullTopology, LevelTopology &child) {
    bool const isFree = isHexagonal() || _sdcOptions.GetVtxBoundaryInterpolation() ==
                                             Sdc::Options::VTX_BOUNDARY_NONE;
    relateParent();
    BeginLevel(_sizes, fullTopology, _parent, child);
    child.isHexagonal = false;
    child.numVFaces = Index(_vFaces.size());
    Builder builder(_sizes, _parent.numVVertices, isFree ? kFreeBoundary : kSharpBoundaryA);
    buildFaces(builder);
    builder.StoreFaces(child);
    BuildBaseLevel(builder.GetEdges(), child);
    if (isHexagonal() && !_rules.closeGaps) {
        findPartedVertices(_parent, child);
    }
    if (!fullTopology) {
        removeRelations(child);
    }
    EndLevel(_sdcOptions, _parent, child);
}

} // namespace OpenSubdivHex::FarExt::internal

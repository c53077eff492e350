// SPDX-License-Identifier: Apache-2.0
#include "baseImporter.h"

#include "baseLevel.h"
#include "indexSet.h"
#include "parallel.h"
#include "sharpFeatures.h"
#include "vertexFan.h"

#include <opensubdiv/vtr/fvarLevel.h>

#include <algorithm>
#include <set>

namespace OpenSubdivHex::FarExt::internal {

using Far::ConstIndexArray;
using Far::Index;

namespace {

std::string str(std::int64_t number) { return std::to_string(number); }

// Takes apart a base level into faces and edges, and puts them together as level 0.
class Importer {
public:
    Importer(Far::TopologyRefiner const &base, bool const *isHole)
        : _base(base.GetLevel(0)), _baseRefiner(base), _isHole(isHole) {}

    /// Null with a status when an edge has no face; the status may have warnings.
    std::unique_ptr<Hierarchy> Import(Status &status);

private:
    void importFaces();
    Status importEdges();
    Status warnOfInconsistentOrientation(std::vector<Index> const &edges) const;
    bool joinSides(Index edge, int numCorners);
    void importTags();
    void importVertexTags();
    bool isPinned(Index vert) const;
    Status importChannel(int channel);
    Status followVertex(Index vert, int channel, std::vector<Index> const &faceValues,
                        std::vector<float> &sharpness) const;

    bool isFree() const {
        return _baseRefiner.GetSchemeOptions().GetVtxBoundaryInterpolation() ==
               Sdc::Options::VTX_BOUNDARY_NONE;
    }
    bool isHole(Index face) const;
    // Whether a side of an edge starts at the first vertex that the base gives the edge.
    bool isForward(Index edge, int side) const {
        return _level->faceVerts[_edges[edge].corners[side]] == _base.GetEdgeVertices(edge)[0];
    }

    Far::TopologyLevel const &_base;
    Far::TopologyRefiner const &_baseRefiner;
    bool const *_isHole; // by face; null when only the base knows

    std::unique_ptr<Hierarchy> _hierarchy = std::make_unique<Hierarchy>();
    Level *_level = &_hierarchy->mesh.levels.emplace_back();
    std::vector<Index> _faceOfCorner;
    std::vector<EdgeSides> _edges;
};

std::unique_ptr<Hierarchy> Importer::Import(Status &status) {
    _level->numVertices = _base.GetNumVertices();
    _level->numFaces = _base.GetNumFaces();
    _level->numCorners = _base.GetNumFaceVertices();
    importFaces();
    status = importEdges();
    if (!status.IsOk()) {
        return nullptr;
    }
    BuildBaseLevel({_edges.data(), Index(_edges.size())}, *_level);
    importTags();
    ComputeSharpMasks(_baseRefiner.GetSchemeOptions(), *_level);
    for (int channel = 0; channel < _base.GetNumFVarChannels() && status.IsOk(); ++channel) {
        if (Status result = importChannel(channel); !result.IsOk()) {
            status = std::move(result);
        }
    }
    return std::move(_hierarchy);
}

void Importer::importFaces() {
    _level->faceFirstCorner.Resize(std::size_t(_level->numFaces) + 1);
    _level->faceVerts.Resize(_level->numCorners);
    _faceOfCorner.resize(_level->numCorners);
    OpenSubdiv::Vtr::internal::Level const &base = _baseRefiner.getLevel(0);
    ParallelFor(_level->numFaces, [&](Index face) {
        Index corner = base.getOffsetOfFaceVertices(face);
        _level->faceFirstCorner[face] = corner;
        for (Index vert : _base.GetFaceVertices(face)) {
            _faceOfCorner[corner] = face;
            _level->faceVerts[corner++] = vert;
        }
    });
    _level->faceFirstCorner[_level->numFaces] = _level->numCorners;
}

// Gives the sides of an edge that bounds one face, or joins two which run it in opposite
// directions, their order; false for any other edge.
bool Importer::joinSides(Index edge, int numCorners) {
    ConstIndexArray const verts = _base.GetEdgeVertices(edge);
    if (verts[0] == verts[1] || _base.IsEdgeNonManifold(edge)) {
        return false;
    }
    EdgeSides &sides = _edges[edge];
    if (numCorners == 1) {
        sides.corners[1] = isFree() ? kFreeBoundary : kSharpBoundaryA;
        return true;
    }
    if (numCorners != 2 || isForward(edge, 0) == isForward(edge, 1) ||
        _faceOfCorner[sides.corners[0]] == _faceOfCorner[sides.corners[1]]) {
        return false;
    }
    if (!isForward(edge, 0)) {
        std::swap(sides.corners[0], sides.corners[1]);
    }
    return true;
}

// An edge of any other kind comes apart: every face gets an edge of its own, the first of them with
// the edge's index.
Status Importer::importEdges() {
    _edges.assign(_base.GetNumEdges(), {{Far::INDEX_INVALID, Far::INDEX_INVALID}});
    std::vector<int> numCorners(_base.GetNumEdges(), 0);
    std::vector<std::pair<Index, Index>> others; // edge and corner, of third and later sides
    Index corner = 0;
    for (Index face = 0; face < _level->numFaces; ++face) {
        for (Index edge : _base.GetFaceEdges(face)) {
            if (numCorners[edge] < 2) {
                _edges[edge].corners[numCorners[edge]] = corner;
            } else {
                others.emplace_back(edge, corner);
            }
            ++numCorners[edge];
            ++corner;
        }
    }
    std::vector<Index> const irregular = ParallelSelect(
        _base.GetNumEdges(), [&](Index edge) { return !joinSides(edge, numCorners[edge]); });
    std::vector<Index> inconsistent;             // edges that two faces run in the same direction
    std::vector<std::pair<Index, Index>> second; // sides of edges that come apart, with the edge
    for (Index edge : irregular) {
        EdgeSides &sides = _edges[edge];
        Index const start = _base.GetEdgeVertices(edge)[0];
        Index const end = _base.GetEdgeVertices(edge)[1];
        if (numCorners[edge] == 0) {
            return Status(StatusCode::InvalidTopology, ComponentType::Edge, edge,
                          "edge " + str(edge) + " has no face");
        }
        if (numCorners[edge] == 2 && start != end && isForward(edge, 0) == isForward(edge, 1) &&
            _faceOfCorner[sides.corners[0]] != _faceOfCorner[sides.corners[1]]) {
            inconsistent.push_back(edge);
        }
        _level->lineEdges.push_back({edge, edge});
        if (numCorners[edge] > 1) {
            second.emplace_back(sides.corners[1], edge);
        }
    }
    for (auto const &[edge, otherCorner] : others) {
        second.emplace_back(otherCorner, edge);
    }
    std::sort(second.begin(), second.end());
    Status status = warnOfInconsistentOrientation(inconsistent);
    for (Index edge : irregular) {
        _edges[edge].corners[1] = kSharpBoundaryA;
    }
    for (auto const &[secondCorner, edge] : second) {
        _level->lineEdges.push_back({Index(_edges.size()), edge});
        _edges.push_back({{secondCorner, kSharpBoundaryA}});
    }
    for (LineEdge const &line : _level->lineEdges) {
        _level->nonManifoldEdges.push_back(line.edge);
    }
    return status;
}

// The edges still have both of their sides.
Status Importer::warnOfInconsistentOrientation(std::vector<Index> const &edges) const {
    Status status;
    if (!edges.empty()) {
        Index const edge = edges[0];
        ConstIndexArray const verts = _base.GetEdgeVertices(edge);
        status.AddWarning({WarningCode::InconsistentOrientation, ComponentType::Edge, edge,
                           std::int64_t(edges.size()),
                           "inconsistent orientation, taken as non-manifold: faces run " +
                               str(edges.size()) + (edges.size() == 1 ? " edge" : " edges") +
                               " in the same direction, first edge " + str(edge) +
                               " between vertices " + str(verts[0]) + " and " + str(verts[1]) +
                               ", of faces " + str(_faceOfCorner[_edges[edge].corners[0]]) +
                               " and " + str(_faceOfCorner[_edges[edge].corners[1]])});
    }
    return status;
}

bool Importer::isHole(Index face) const {
    if (_isHole) {
        return _isHole[face];
    }
    // With VTX_BOUNDARY_NONE Far makes holes of all faces at the boundary, to leave them out of its
    // limit surface; the paper's rule keeps them.
    ConstIndexArray const verts = _base.GetFaceVertices(face);
    bool const isImplied = isFree() && std::any_of(verts.begin(), verts.end(), [&](Index vert) {
                               return _base.IsVertexBoundary(vert);
                           });
    return _base.IsFaceHole(face) && !isImplied;
}

void Importer::importTags() {
    Level &level = *_level;
    // Edges that came apart are boundaries, so that the base's edges are all that can be creases.
    auto const isCrease = [&](Index edge) {
        return !level.IsBoundary(edge) && Sdc::Crease::IsSharp(_base.GetEdgeSharpness(edge));
    };
    if (!ParallelSelect(_base.GetNumEdges(), isCrease).empty()) {
        level.edgeSharpness.Resize(level.numEdges);
        ParallelFor(level.numEdges, [&](Index edge) {
            level.edgeSharpness[edge] = level.IsBoundary(edge) ? 0 : _base.GetEdgeSharpness(edge);
        });
    }
    importVertexTags();
    std::vector<Index> const holes =
        ParallelSelect(level.numFaces, [this](Index face) { return isHole(face); });
    if (!holes.empty()) {
        level.faceHoles.Resize(level.numFaces);
        std::fill_n(level.faceHoles.data(), level.numFaces, static_cast<unsigned char>(0));
        for (Index face : holes) {
            level.faceHoles[face] = kHole;
        }
    }
}

// As Far's rule for non-manifold vertices: they stay, unless two edges that came apart meet there,
// with no other boundary, and more faces than the base has edges there: the vertex then lies inside
// of a curve that three or more sheets share.  A vertex that a face has several times stays, too.
bool Importer::isPinned(Index vert) const {
    std::set<Index> lines;
    Index numInterior = 0;
    for (Index i = _level->vertFirstEdge[vert]; i < _level->vertFirstEdge[vert + 1]; ++i) {
        Index const edge = _level->vertEdges[i];
        Index const line = _level->GetEdgeLine(edge);
        IndexPair const &verts = _level->edgeVerts[edge];
        if (verts[0] == verts[1] || (_level->IsBoundary(edge) && line == Far::INDEX_INVALID)) {
            return true;
        }
        if (_level->IsBoundary(edge)) {
            lines.insert(line);
        } else {
            ++numInterior;
        }
    }
    std::set<Index> const faces(_level->vertFaces.begin() + _level->vertFirstFace[vert],
                                _level->vertFaces.begin() + _level->vertFirstFace[vert + 1]);
    Index const numFaces = _level->vertFirstFace[vert + 1] - _level->vertFirstFace[vert];
    return lines.size() != 2 || numFaces <= numInterior + 2 || Index(faces.size()) < numFaces;
}

// Far overlooks some of the vertices that a face has several times.
void Importer::importVertexTags() {
    Level &level = *_level;
    level.nonManifoldVerts = ParallelSelect(level.numVertices, [&](Index vert) {
        int numFans = 0;
        ForEachFan(level, vert, [&](VertexFan const &) { ++numFans; });
        return numFans > 1 || _base.IsVertexNonManifold(vert);
    });
    // Long faces are looked at below.
    std::vector<Index> const candidates = ParallelSelect(level.numFaces, [&](Index face) {
        constexpr Index kShort = 16;
        Index const *const verts = level.faceVerts.data() + level.faceFirstCorner[face];
        Index const *const end = level.faceVerts.data() + level.faceFirstCorner[face + 1];
        bool isRepeated = end - verts > kShort;
        for (Index const *vert = verts; vert < end && !isRepeated; ++vert) {
            isRepeated = std::find(verts, vert, *vert) != vert;
        }
        return isRepeated;
    });
    for (Index face : candidates) {
        std::vector<Index> verts(level.faceVerts.begin() + level.faceFirstCorner[face],
                                 level.faceVerts.begin() + level.faceFirstCorner[face + 1]);
        std::sort(verts.begin(), verts.end());
        for (std::size_t i = 1; i < verts.size(); ++i) {
            if (verts[i] == verts[i - 1]) {
                level.nonManifoldVerts.push_back(verts[i]);
            }
        }
    }
    for (LineEdge const &line : level.lineEdges) {
        IndexPair const &verts = level.edgeVerts[line.edge];
        level.nonManifoldVerts.insert(level.nonManifoldVerts.end(), verts.begin(), verts.end());
    }
    SortUnique(level.nonManifoldVerts);
    auto const isSharp = [&](Index vert) {
        return Sdc::Crease::IsSharp(_base.GetVertexSharpness(vert));
    };
    if (level.nonManifoldVerts.empty() && ParallelSelect(level.numVertices, isSharp).empty()) {
        return;
    }
    level.vertSharpness.Resize(level.numVertices);
    ParallelFor(level.numVertices,
                [&](Index vert) { level.vertSharpness[vert] = _base.GetVertexSharpness(vert); });
    for (Index vert : level.nonManifoldVerts) {
        if (isPinned(vert)) {
            level.vertSharpness[vert] = Sdc::Crease::SHARPNESS_INFINITE;
        }
    }
}

// What a value without seams at a non-manifold vertex needs to move as the vertex does: each fan of
// faces has a value of its own, which sees the sharp edges of its fan alone.
Status Importer::followVertex(Index vert, int channel, std::vector<Index> const &faceValues,
                              std::vector<float> &sharpness) const {
    Level const &level = *_level;
    std::vector<Index> corners;
    for (Index k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1]; ++k) {
        corners.push_back(level.GetVertexCorner(k));
    }
    auto const isSeam = [&](Index corner) { return faceValues[corner] != faceValues[corners[0]]; };
    if (std::any_of(corners.begin(), corners.end(), isSeam)) {
        return Status();
    }
    auto const refuse = [&](std::string const &what) {
        return Status(StatusCode::Unsupported, ComponentType::Vertex, vert,
                      "face-varying channel " + str(channel) + " has no seam at vertex " +
                          str(vert) + ", where " + what);
    };
    int numCreasedFans = 0;
    ForEachFanItems(level, vert, [&](FanItems const &fan) {
        auto const isCrease = [](RingItem const &item) {
            return Sdc::Crease::IsSemiSharp(item.sharpness);
        };
        numCreasedFans += std::any_of(fan.items.begin(), fan.items.end(), isCrease) ? 1 : 0;
    });
    if (numCreasedFans > 1 &&
        _baseRefiner.GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN) {
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
        return Status();
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
        return Status();
    }
    return refuse("faces do not all meet both ends of a non-manifold curve, or a semi-sharp crease "
                  "meets it");
}

// Far's tags tell which values stay (corners, and all boundary values with linear boundaries) and
// which follow a curve along their seams.
Status Importer::importChannel(int channel) {
    OpenSubdiv::Vtr::internal::FVarLevel const &fvar =
        _baseRefiner.getLevel(0).getFVarLevel(channel);
    std::vector<Index> faceValues;
    faceValues.reserve(_level->numCorners);
    for (Index face = 0; face < _level->numFaces; ++face) {
        ConstIndexArray const values = _base.GetFaceFVarValues(face, channel);
        faceValues.insert(faceValues.end(), values.begin(), values.end());
    }
    // By corner, since every vertex that a value is shared by has its own rule.  Where a face has a
    // vertex several times Far may know of one of its corners alone.
    std::vector<float> sharpness(_level->numCorners, 0.0f);
    for (Index corner = 0; corner < _level->numCorners && !fvar.isLinear(); ++corner) {
        sharpness[corner] = _level->GetVertexSharpness(_level->faceVerts[corner]);
    }
    for (Index vert = 0; vert < _level->numVertices && !fvar.isLinear(); ++vert) {
        ConstIndexArray const faces = _base.GetVertexFaces(vert);
        auto const tags = fvar.getVertexValueTags(vert);
        auto const siblings = fvar.getVertexFaceSiblings(vert);
        for (int i = 0; i < faces.size(); ++i) {
            auto const tag = tags[siblings[i]];
            float valueSharpness = _level->GetVertexSharpness(vert);
            if (tag.isMismatch() && !tag.isSemiSharp()) {
                valueSharpness = tag.isInfSharp() ? Sdc::Crease::SHARPNESS_INFINITE
                                                  : Sdc::Crease::SHARPNESS_SMOOTH;
            }
            Index const corner =
                _level->faceFirstCorner[faces[i]] + _base.GetVertexFaceLocalIndices(vert)[i];
            sharpness[corner] = valueSharpness;
        }
    }
    for (Index vert : _level->nonManifoldVerts) {
        Status status =
            fvar.isLinear() ? Status() : followVertex(vert, channel, faceValues, sharpness);
        if (!status.IsOk()) {
            return status;
        }
    }
    Sdc::Options options = _baseRefiner.GetSchemeOptions();
    options.SetFVarLinearInterpolation(_baseRefiner.GetFVarLinearInterpolation(channel));
    BuildFVarChannel(*_level, _base.GetNumFVarValues(channel), faceValues, sharpness, options,
                     _hierarchy->channels.emplace_back());
    return Status();
}

} // namespace

std::unique_ptr<Hierarchy> ImportBase(Far::TopologyRefiner const &base, bool const *isHole,
                                      Status &status) {
    return Importer(base, isHole).Import(status);
}

} // namespace OpenSubdivHex::FarExt::internal

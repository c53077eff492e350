// SPDX-License-Identifier: Apache-2.0
#include "topologyLevel.h"

#include "far_ext/vtr/baseCoords.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/report.h"
#include "far_ext/vtr/validator.h"

#include <algorithm>
#include <vector>

namespace OpenSubdivHex::FarExt {

using Index = Far::Index;
using internal::Buffer;
using internal::FVarChannel;
using internal::FVarLevel;
using internal::IndexPair;
using internal::Refinement;

namespace {

/// The indices that lie in a relation, which is empty in a level that does not have it.
Far::ConstIndexArray listAll(Buffer<Index> const &relation) {
    return {relation.data(), int(relation.size())};
}
Far::ConstIndexArray listAll(Buffer<IndexPair> const &relation) {
    return {relation.empty() ? nullptr : relation.data()->data(), 2 * int(relation.size())};
}

} // namespace

TopologyLevel::TopologyLevel(internal::Hierarchy const &hierarchy, int depth)
    : _hierarchy(&hierarchy), _level(&hierarchy.mesh.levels[std::size_t(depth)]), _depth(depth),
      _numVertices(_level->numVertices), _numEdges(_level->numEdges), _numFaces(_level->numFaces),
      _faceFirstCorner(_level->faceFirstCorner.data()), _faceVerts(_level->faceVerts.data()) {}

int TopologyLevel::GetNumBoundaryEdges() const { return _level->GetNumBoundaries(); }

bool TopologyLevel::HasFullTopology() const { return _level->hasFullTopology; }

Far::ConstIndexArray TopologyLevel::GetFaceEdges(Index f) const {
    return HasFullTopology() ? ConstIndexArray(_level->faceEdges.data() + _faceFirstCorner[f],
                                               _level->GetFaceSize(f))
                             : ConstIndexArray();
}

Far::ConstIndexArray TopologyLevel::GetEdgeVertices(Index e) const {
    return HasFullTopology() ? ConstIndexArray(_level->edgeVerts[e].data(), 2) : ConstIndexArray();
}

Far::ConstIndexArray TopologyLevel::GetEdgeFaces(Index e) const {
    return HasFullTopology()
               ? ConstIndexArray(_level->edgeFaces[e].data(), _level->IsBoundary(e) ? 1 : 2)
               : ConstIndexArray();
}

Far::ConstLocalIndexArray TopologyLevel::GetEdgeFaceLocalIndices(Index e) const {
    return HasFullTopology() ? ConstLocalIndexArray(_level->edgeFaceLocals[e].data(),
                                                    _level->IsBoundary(e) ? 1 : 2)
                             : ConstLocalIndexArray();
}

Far::ConstIndexArray TopologyLevel::GetVertexFaces(Index v) const {
    return HasFullTopology() ? _level->GetVertexFaces(v) : ConstIndexArray();
}

Far::ConstLocalIndexArray TopologyLevel::GetVertexFaceLocalIndices(Index v) const {
    return HasFullTopology()
               ? ConstLocalIndexArray(_level->vertFaceLocals.data() + _level->vertFirstFace[v],
                                      _level->GetNumVertexFaces(v))
               : ConstLocalIndexArray();
}

Far::ConstIndexArray TopologyLevel::GetVertexEdges(Index v) const {
    return HasFullTopology() ? _level->GetVertexEdges(v) : ConstIndexArray();
}

Far::ConstLocalIndexArray TopologyLevel::GetVertexEdgeLocalIndices(Index v) const {
    return HasFullTopology() ? ConstLocalIndexArray(_level->GetVertexEdgeLocals(v),
                                                    _level->GetVertexEdges(v).size())
                             : ConstLocalIndexArray();
}

Far::ConstIndexArray TopologyLevel::GetAllFaceEdges() const { return listAll(_level->faceEdges); }

Far::ConstIndexArray TopologyLevel::GetAllEdgeVertices() const {
    return listAll(_level->edgeVerts);
}

Far::ConstIndexArray TopologyLevel::GetAllEdgeFaces() const { return listAll(_level->edgeFaces); }

Far::ConstIndexArray TopologyLevel::GetVertexFaceOffsets() const {
    return listAll(_level->vertFirstFace);
}

Far::ConstIndexArray TopologyLevel::GetAllVertexFaces() const { return listAll(_level->vertFaces); }

Far::ConstIndexArray TopologyLevel::GetVertexEdgeOffsets() const {
    return listAll(_level->vertFirstEdge);
}

Far::ConstIndexArray TopologyLevel::GetAllVertexEdges() const { return listAll(_level->vertEdges); }

Index TopologyLevel::FindEdge(Index v0, Index v1) const {
    for (Index edge : GetVertexEdges(v0)) {
        ConstIndexArray const verts = GetEdgeVertices(edge);
        if ((verts[0] == v0 && verts[1] == v1) || (verts[0] == v1 && verts[1] == v0)) {
            return edge;
        }
    }
    return Far::INDEX_INVALID;
}

Index TopologyLevel::GetVertexCorner(Index v, int i) const {
    return _level->GetVertexCorner(_level->vertFirstFace[v] + i);
}

bool TopologyLevel::IsEdgeBoundary(Index e) const { return GetEdgeFaces(e).size() == 1; }

bool TopologyLevel::IsVertexBoundary(Index v) const {
    return GetVertexEdges(v).size() > GetVertexFaces(v).size();
}

bool TopologyLevel::IsEdgeNonManifold(Index e) const {
    std::vector<Index> const &edges = _level->nonManifoldEdges;
    return std::binary_search(edges.begin(), edges.end(), e);
}

bool TopologyLevel::IsVertexNonManifold(Index v) const { return _level->IsNonManifold(v); }

float TopologyLevel::GetEdgeSharpness(Index e) const {
    if (HasFullTopology() && _level->IsBoundary(e)) {
        bool const isFree = _level->edgeFaces[e][1] == internal::kFreeBoundary;
        return isFree ? Sdc::Crease::SHARPNESS_SMOOTH : Sdc::Crease::SHARPNESS_INFINITE;
    }
    return _level->GetEdgeSharpness(e);
}

float TopologyLevel::GetVertexSharpness(Index v) const { return _level->GetVertexSharpness(v); }

bool TopologyLevel::IsFaceHole(Index f) const { return _level->GetHoles(f) == internal::kHole; }

bool TopologyLevel::IsFaceHole(Index f, int half) const {
    return (_level->GetHoles(f) >> half & 1u) != 0;
}

Sdc::Crease::Rule TopologyLevel::GetVertexRule(Index v) const {
    internal::SharpVertex const *sharp = _level->FindSharpVertex(v);
    return sharp ? sharp->rule : Sdc::Crease::RULE_SMOOTH;
}

float TopologyLevel::GetFaceDiagonalSharpness(Index f) const {
    return _level->GetDiagonalSharpness(f);
}

int TopologyLevel::GetFaceDiagonalEnd(Index f) const { return _level->GetDiagonalEnd(f); }

bool TopologyLevel::IsFaceHalf(Index f) const { return _level->IsHalfFace(f); }

bool TopologyLevel::IsVertexValenceRegular(Index v) const {
    int const numFaces = GetVertexFaces(v).size();
    return IsVertexBoundary(v) ? (numFaces <= 2) : (numFaces == 3);
}

int TopologyLevel::GetNumFVarChannels() const { return int(_hierarchy->channels.size()); }

FVarLevel const &TopologyLevel::fvarLevel(int channel) const {
    return _hierarchy->channels[std::size_t(channel)].levels[std::size_t(_depth)];
}

int TopologyLevel::GetNumFVarValues(int channel) const {
    return _depth == 0 ? _hierarchy->channels[std::size_t(channel)].numValues
                       : fvarLevel(channel).values->numVertices;
}

Far::ConstIndexArray TopologyLevel::GetFaceFVarValues(Index f, int channel) const {
    if (_depth == 0) {
        FVarChannel const &values = _hierarchy->channels[std::size_t(channel)];
        return ConstIndexArray(values.faceValues.data() + _faceFirstCorner[f],
                               _level->GetFaceSize(f));
    }
    FVarLevel const &values = fvarLevel(channel);
    if (FVarLevel::SplitFace const *split = values.FindSplitFace(f)) {
        return ConstIndexArray(split->cornerValues.data(), int(split->cornerValues.size()));
    }
    return values.values->GetFaceVertices(values.valueFaces[f]);
}

bool TopologyLevel::IsFaceFVarSplit(Index f, int channel) const {
    return fvarLevel(channel).FindSplitFace(f) != nullptr;
}

Far::ConstIndexArray TopologyLevel::GetFaceFVarValues(Index f, int channel, int half) const {
    FVarLevel const &values = fvarLevel(channel);
    FVarLevel::SplitFace const *split = values.FindSplitFace(f);
    return split ? values.values->GetFaceVertices(split->valueFaces[half]) : ConstIndexArray();
}

bool TopologyLevel::DoesEdgeFVarTopologyMatch(Index e, int channel) const {
    if (IsEdgeBoundary(e)) {
        return true;
    }
    FVarLevel const &values = fvarLevel(channel);
    ConstIndexArray const faces = GetEdgeFaces(e);
    ConstLocalIndexArray const locals = GetEdgeFaceLocalIndices(e);
    return values.GetFaceEdge(faces[0], locals[0]) == values.GetFaceEdge(faces[1], locals[1]);
}

bool TopologyLevel::DoesVertexFVarTopologyMatch(Index v, int channel) const {
    ConstIndexArray const faces = GetVertexFaces(v);
    ConstLocalIndexArray const locals = GetVertexFaceLocalIndices(v);
    ConstIndexArray const edges = GetVertexEdges(v);
    auto isSplitHere = [&](int i) {
        bool const onDiagonal =
            locals[i] == kDiagonalStart || locals[i] == _level->GetDiagonalEnd(faces[i]);
        return onDiagonal && IsFaceFVarSplit(faces[i], channel);
    };
    for (int i = 0; i < faces.size(); ++i) {
        if (GetFaceFVarValues(faces[i], channel)[locals[i]] !=
                GetFaceFVarValues(faces[0], channel)[locals[0]] ||
            isSplitHere(i)) {
            return false;
        }
    }
    return std::all_of(edges.begin(), edges.end(),
                       [&](Index e) { return DoesEdgeFVarTopologyMatch(e, channel); });
}

bool TopologyLevel::DoesFaceFVarTopologyMatch(Index f, int channel) const {
    ConstIndexArray const verts = GetFaceVertices(f);
    return std::all_of(verts.begin(), verts.end(),
                       [&](Index v) { return DoesVertexFVarTopologyMatch(v, channel); });
}

Refinement const *TopologyLevel::refinementTo() const {
    return _depth > 0 ? &_hierarchy->mesh.refinements[std::size_t(_depth) - 1] : nullptr;
}

Refinement const *TopologyLevel::refinementFrom() const {
    return _depth + 1 < _hierarchy->numLevels ? &_hierarchy->mesh.refinements[std::size_t(_depth)]
                                              : nullptr;
}

FaceKind TopologyLevel::GetFaceKind(Index f) const {
    if (_depth == 0) {
        return FaceKind::Base;
    }
    if (f < _level->numFFaces) {
        return FaceKind::Face;
    }
    return f < _level->numFaces - _level->numVFaces ? FaceKind::Edge : FaceKind::Vertex;
}

Index TopologyLevel::GetFaceParentEdge(Index f) const {
    return GetFaceKind(f) == FaceKind::Edge ? refinementTo()->GetEFaceParent(f)
                                            : Far::INDEX_INVALID;
}

Index TopologyLevel::GetFaceParentVertex(Index f) const {
    return GetFaceKind(f) == FaceKind::Vertex ? refinementTo()->GetVFaceParent(f)
                                              : Far::INDEX_INVALID;
}

Index TopologyLevel::GetFaceParentFace(Index f) const {
    return _depth > 0 ? refinementTo()->GetFaceParentFace(f) : Far::INDEX_INVALID;
}

Index TopologyLevel::GetFaceBaseFace(Index f, int half) const {
    internal::Cell cell = {f, half};
    for (int depth = _depth; depth > 0; --depth) {
        cell = _hierarchy->mesh.refinements[std::size_t(depth) - 1].GetParentCell(cell);
    }
    return cell.face;
}

bool TopologyLevel::IsFaceBaseSplit(Index f) const {
    return _level->HasFaceHalves(f) && GetFaceBaseFace(f, 0) != GetFaceBaseFace(f, 1);
}

bool TopologyLevel::GetFaceBaseCoords(Index f, int half, float *uv) const {
    return internal::FindBaseCoords(_hierarchy->mesh, 0, _depth, {f, half},
                                    internal::CoordsOf::Plane, uv);
}

bool TopologyLevel::GetFaceBaseCoords(Index f, int half, double *uv) const {
    return internal::FindBaseCoords(_hierarchy->mesh, 0, _depth, {f, half},
                                    internal::CoordsOf::Plane, uv);
}

Index TopologyLevel::GetFaceSurfaceFace(Index f, int half) const {
    return internal::FindBaseFace(_hierarchy->mesh, _hierarchy->surfaceLevel, _depth, {f, half});
}

bool TopologyLevel::GetFaceSurfaceCoords(Index f, int half, float *uv) const {
    return internal::FindBaseCoords(_hierarchy->mesh, _hierarchy->surfaceLevel, _depth, {f, half},
                                    internal::CoordsOf::Parameterization, uv);
}

bool TopologyLevel::GetFaceSurfaceCoords(Index f, int half, double *uv) const {
    return internal::FindBaseCoords(_hierarchy->mesh, _hierarchy->surfaceLevel, _depth, {f, half},
                                    internal::CoordsOf::Parameterization, uv);
}

auto TopologyLevel::GetFaceChildFaces(Index f) const -> ChildFaceArray {
    return ChildFaceArray(refinementFrom() ? f : Far::INDEX_INVALID);
}

Far::ConstIndexArray TopologyLevel::GetFaceChildVertices(Index f) const {
    Refinement const *const refinement = refinementFrom();
    return refinement ? refinement->child->GetFaceVertices(f) : ConstIndexArray();
}

Far::ConstIndexArray TopologyLevel::GetFaceChildEdges(Index f) const {
    return refinementFrom() ? TopologyLevel(*_hierarchy, _depth + 1).GetFaceEdges(f)
                            : ConstIndexArray();
}

Far::ConstIndexArray TopologyLevel::GetEdgeChildEdges(Index e) const {
    Index const eFace = GetEdgeChildFace(e);
    if (eFace == Far::INDEX_INVALID || !IsEdgeBoundary(e)) {
        return ConstIndexArray();
    }
    ConstIndexArray const edges = TopologyLevel(*_hierarchy, _depth + 1).GetFaceEdges(eFace);
    return edges.empty() ? edges : ConstIndexArray(&edges[kBoundaryEFaceEdge], 1);
}

Index TopologyLevel::GetEdgeChildFace(Index e) const {
    return refinementFrom() ? refinementFrom()->GetEdgeChildFace(e) : Far::INDEX_INVALID;
}

Index TopologyLevel::GetVertexChildVertex(Index v) const {
    return refinementFrom() ? refinementFrom()->GetVertexChildVertex(v) : Far::INDEX_INVALID;
}

bool TopologyLevel::Validate(CallStatus *status) const {
    auto const validate = [&](internal::MeshLevels const &mesh) {
        return internal::Validate(mesh.levels[std::size_t(_depth)],
                                  _depth > 0 ? &mesh.refinements[std::size_t(_depth) - 1]
                                             : nullptr);
    };
    CallStatus result = validate(_hierarchy->mesh);
    for (int channel = 0; channel < GetNumFVarChannels() && result.IsOk(); ++channel) {
        // Values are the vertices of a mesh of their own; level 0 may have values without faces
        // and, in place of shared values, more vertices than values.
        CallStatus const cause = validate(_hierarchy->GetMesh(channel));
        if (!cause.IsOk()) {
            result = CallStatus(cause.GetCode(), ComponentType::NoComponent, Far::INDEX_INVALID,
                                "face-varying channel " + std::to_string(channel) + ": " +
                                    cause.GetErrorMessage());
        }
    }
    return internal::Report(result, status);
}

} // namespace OpenSubdivHex::FarExt

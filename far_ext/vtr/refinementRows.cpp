// SPDX-License-Identifier: Apache-2.0
#include "refinementRows.h"

#include "indexSet.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

RefinementRows::RefinementRows(Refinement const &refinement, HexSchemeOptions schemeOptions,
                               Interpolation interpolation)
    : _rules(GetRules(*refinement.parent, schemeOptions, interpolation)) {
    Level const &parent = *refinement.parent;
    _numFaces = parent.numFaces;
    _numVVertices = refinement.child->numVVertices;
    _faceFirstCorner = parent.faceFirstCorner.data();
    _faceVerts = parent.faceVerts.data();
    _vVertexParents =
        refinement.vVertexParents.empty() ? nullptr : refinement.vVertexParents.data();
    _vertFirstFace = parent.vertFirstFace.data();
    _vertFaces = parent.vertFaces.data();
    _vertFaceLocals = parent.vertFaceLocals.data();
    if (refinement.isTruncation) {
        _truncation.emplace(refinement, interpolation);
        _numFaces = 0;
        _numVVertices = refinement.child->numVertices;
        _vVertexParents = nullptr; // of no matter
    }
}

RefinementRows::RefinementRows(Refinement const &refinement, HexSchemeOptions schemeOptions,
                               Interpolation interpolation, Part part)
    : _rules(GetRules(*refinement.parent, schemeOptions, interpolation)), _part(std::move(part)) {
    Level const &parent = *refinement.parent;
    _numFaces = Index(_part.faces.size());
    _numVVertices = Index(_part.vVertices.size());
    IndexNumbering const numberOfVert(_part.verts, parent.numVertices);
    IndexNumbering const numberOfFace(_part.faces, parent.numFaces);
    _partFaceFirstCorner.push_back(0);
    for (Index face : _part.faces) {
        for (Index vert : parent.GetFaceVertices(face)) {
            _partFaceVerts.push_back(numberOfVert(vert));
        }
        _partFaceFirstCorner.push_back(Index(_partFaceVerts.size()));
    }
    _partVertFirstFace.assign(_part.verts.size() + 1, 0);
    Index nextVert = 0;
    if (refinement.isTruncation) {
        _truncation.emplace(refinement, interpolation);
        _faceFirstCorner = _partFaceFirstCorner.data();
        _vVertexParents = nullptr;
        return;
    }
    for (Index vVertex : _part.vVertices) {
        Index const pVert = refinement.GetVVertexParent(vVertex);
        Index const vert = numberOfVert(pVert);
        _partVVertexParents.push_back(vert);
        for (; nextVert <= vert; ++nextVert) {
            _partVertFirstFace[nextVert] = Index(_partVertFaces.size());
        }
        // None are there when the mask does not ask for them.
        if (_rules->GetVertexRule(pVert).HasFaces()) {
            for (Index k = parent.vertFirstFace[pVert]; k < parent.vertFirstFace[pVert + 1]; ++k) {
                _partVertFaces.push_back(numberOfFace(parent.vertFaces[k]));
                _partVertFaceLocals.push_back(parent.vertFaceLocals[k]);
            }
        }
    }
    std::fill(_partVertFirstFace.begin() + nextVert, _partVertFirstFace.end(),
              Index(_partVertFaces.size()));
    _faceFirstCorner = _partFaceFirstCorner.data();
    _faceVerts = _partFaceVerts.data();
    _vVertexParents = _partVVertexParents.data();
    _vertFirstFace = _partVertFirstFace.data();
    _vertFaces = _partVertFaces.data();
    _vertFaceLocals = _partVertFaceLocals.data();
}

VertexRule RefinementRows::partVertexRule(Index vert) const {
    VertexRule rule = _rules->GetVertexRule(_part.verts[vert]);
    int const last = rule.numSources - 1;
    rule.sources[last] = vert;
    for (int i = 0; i < last; ++i) {
        rule.sources[i] = partVertex(rule.sources[i]);
    }
    return rule;
}

// The number in the part of a vertex of the parent.
Index RefinementRows::partVertex(Index vert) const {
    return Index(std::lower_bound(_part.verts.begin(), _part.verts.end(), vert) -
                 _part.verts.begin());
}

void RefinementRows::getTruncationSources(Index vVertex, TruncationMask::Sources &sources) const {
    if (_part.verts.empty()) {
        _truncation->GetSources(vVertex, sources);
        return;
    }
    _truncation->GetSources(_part.vVertices[vVertex], sources);
    for (Index &vert : sources.verts) {
        vert = partVertex(vert);
    }
}

namespace {

RefinementRows::Part findTruncationPart(Refinement const &refinement, Interpolation interpolation,
                                        std::vector<Index> const &wanted) {
    RefinementRows::Part part;
    part.vVertices = wanted;
    TruncationMask const mask(refinement, interpolation);
    TruncationMask::Sources sources;
    for (Index cVert : wanted) {
        mask.GetSources(cVert, sources);
        part.verts.insert(part.verts.end(), sources.verts.begin(), sources.verts.end());
    }
    SortUnique(part.verts, refinement.parent->numVertices);
    return part;
}

} // namespace

RefinementRows::Part FindPart(Refinement const &refinement, HexSchemeOptions schemeOptions,
                              Interpolation interpolation, std::vector<Index> const &wanted) {
    if (refinement.isTruncation) {
        return findTruncationPart(refinement, interpolation, wanted);
    }
    Level const &parent = *refinement.parent;
    std::shared_ptr<RefinementRules const> const rules =
        GetRules(parent, schemeOptions, interpolation);
    RefinementRows::Part part;
    Index endOfFace = 0; // of the last corner, past its face
    for (Index cVert : wanted) {
        if (cVert >= refinement.child->numVVertices) {
            Index const corner = refinement.GetChildVertexCorner(cVert);
            if (corner >= endOfFace) {
                part.faces.push_back(parent.FindFaceOfCorner(corner));
                endOfFace = parent.faceFirstCorner[part.faces.back() + 1];
            }
            continue;
        }
        part.vVertices.push_back(cVert);
        Index const pVert = refinement.GetVVertexParent(cVert);
        VertexRule const rule = rules->GetVertexRule(pVert);
        part.verts.insert(part.verts.end(), rule.sources, rule.sources + rule.numSources);
        if (rule.HasFaces()) {
            for (Index face : parent.GetVertexFaces(pVert)) {
                part.faces.push_back(face);
            }
        }
    }
    SortUnique(part.faces, parent.numFaces);
    for (Index face : part.faces) {
        for (Index vert : parent.GetFaceVertices(face)) {
            part.verts.push_back(vert);
        }
    }
    SortUnique(part.verts, parent.numVertices);
    return part;
}

std::vector<Index> GetMadeVertices(Refinement const &refinement, RefinementRows::Part const &part) {
    Level const &parent = *refinement.parent;
    std::vector<Index> verts = part.vVertices;
    for (Index face : part.faces) {
        Index const end = parent.faceFirstCorner[face + 1];
        for (Index corner = parent.faceFirstCorner[face]; corner < end; ++corner) {
            verts.push_back(refinement.GetCornerChildVertex(corner));
        }
    }
    return verts;
}

} // namespace OpenSubdivHex::FarExt::internal

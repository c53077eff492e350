// SPDX-License-Identifier: Apache-2.0
#include "stencilStep.h"

#include "indexSet.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

StencilStep::StencilStep(TopologyLevel const &pLevel, SchemeOptions schemeOptions,
                         Interpolation interpolation)
    : _mask(pLevel, schemeOptions, interpolation) {
    LevelTopology const &topology = pLevel.GetTopology();
    _numFaces = topology.numFaces;
    _numVVertices = topology.numVVertices;
    _faceFirstCorner = topology.faceFirstCorner.data();
    _faceVerts = topology.faceVerts.data();
    _vVertexParents = topology.vVertexParents.empty() ? nullptr : topology.vVertexParents.data();
    _vertFirstFace = topology.vertFirstFace.data();
    _vertFaces = topology.vertFaces.data();
    _vertFaceLocals = topology.vertFaceLocals.data();
}

StencilStep::StencilStep(TopologyLevel const &pLevel, SchemeOptions schemeOptions,
                         Interpolation interpolation, Part part)
    : _mask(pLevel, schemeOptions, interpolation), _part(std::move(part)) {
    LevelTopology const &topology = pLevel.GetTopology();
    _numFaces = Index(_part.faces.size());
    _numVVertices = Index(_part.vVertices.size());
    IndexNumbering const numberOfVert(_part.verts, topology.numVertices);
    IndexNumbering const numberOfFace(_part.faces, topology.numFaces);
    _partFaceFirstCorner.push_back(0);
    for (Index face : _part.faces) {
        for (Index vert : pLevel.GetFaceVertices(face)) {
            _partFaceVerts.push_back(numberOfVert(vert));
        }
        _partFaceFirstCorner.push_back(Index(_partFaceVerts.size()));
    }
    _partVertFirstFace.assign(_part.verts.size() + 1, 0);
    Index nextVert = 0;
    for (Index vVertex : _part.vVertices) {
        Index const pVert = topology.GetVVertexParent(vVertex);
        Index const vert = numberOfVert(pVert);
        _partVVertexParents.push_back(vert);
        for (; nextVert <= vert; ++nextVert) {
            _partVertFirstFace[nextVert] = Index(_partVertFaces.size());
        }
        // None are there when the mask does not ask for them.
        Far::ConstIndexArray const faces = pLevel.GetVertexFaces(pVert);
        Far::ConstLocalIndexArray const locals = pLevel.GetVertexFaceLocalIndices(pVert);
        if (_mask.GetVertexMask(pVert).faceWeight > 0) {
            for (int i = 0; i < faces.size(); ++i) {
                _partVertFaces.push_back(numberOfFace(faces[i]));
                _partVertFaceLocals.push_back(locals[i]);
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

RefinementMask::VertexMask StencilStep::partVertexMask(Index vert) const {
    RefinementMask::VertexMask mask = _mask.GetVertexMask(_part.verts[vert]);
    for (int i = 0; i < mask.numNeighbors; ++i) {
        auto const place =
            std::lower_bound(_part.verts.begin(), _part.verts.end(), mask.neighbors[i]);
        mask.neighbors[i] = Index(place - _part.verts.begin());
    }
    return mask;
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "limitOrigins.h"

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

LimitOrigins::LimitOrigins(MeshLevels const &mesh, LimitRows &rows)
    : _mesh(mesh), _rows(rows), _latticeFaces(mesh, rows.GetLevel().depth) {}

CallStatus LimitOrigins::Find(HexSchemeOptions const &schemeOptions) {
    CallStatus result = _latticeFaces.FindMasks(schemeOptions, _rows);
    if (!result.IsOk()) {
        return result;
    }
    _regularFaces.emplace(_mesh, _rows.GetLevel().depth, _latticeFaces.GetMarks());
    result = _regularFaces->FindMasks(schemeOptions, _rows);
    if (!result.IsOk()) {
        return result;
    }
    _regularVertices.emplace(_mesh, schemeOptions, _rows, _regularFaces->GetOthers());
    return result;
}

std::vector<Index> LimitOrigins::GetVertices(int level) const {
    if (level == _rows.GetLevel().depth) {
        return _regularVertices->GetOthers();
    }
    std::vector<Index> verts = _regularVertices->GetVertices(level);
    if (level == 0) {
        std::vector<Index> const &ofLattice = _latticeFaces.GetVertices();
        verts.insert(verts.end(), ofLattice.begin(), ofLattice.end());
    }
    return verts;
}

LimitRow LimitOrigins::GetRow(int level, Index vert, Index sources[kMaxSources]) const {
    if (level == _rows.GetLevel().depth) {
        return _rows.GetRow(vert, 0, sources);
    }
    std::vector<Index> const &ofLattice = _latticeFaces.GetVertices();
    bool const isOfLattice =
        level == 0 && std::binary_search(ofLattice.begin(), ofLattice.end(), vert);
    return isOfLattice ? _latticeFaces.GetRow(vert, sources)
                       : _regularVertices->GetRow(level, vert, sources);
}

} // namespace OpenSubdivHex::FarExt::internal

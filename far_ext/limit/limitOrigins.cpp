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
    return _regularFaces->FindMasks(schemeOptions, _rows);
}

std::vector<Index> LimitOrigins::GetVertices(int level) const {
    if (level == _rows.GetLevel().depth) {
        return _regularFaces->GetOthers();
    }
    return level == 0 ? _latticeFaces.GetVertices() : std::vector<Index>();
}

LimitRow LimitOrigins::GetRow(int level, Index vert, Index sources[kMaxSources]) const {
    return level == _rows.GetLevel().depth ? _rows.GetRow(vert, 0, sources)
                                           : _latticeFaces.GetRow(vert, sources);
}

} // namespace OpenSubdivHex::FarExt::internal

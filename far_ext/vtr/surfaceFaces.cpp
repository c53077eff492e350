// SPDX-License-Identifier: Apache-2.0
#include "far_ext/surfaceFaces.h"

#include "level.h"

namespace OpenSubdivHex::FarExt {

using internal::CrossedFace;

int SurfaceFaces::GetNumFaces() const { return _level->numFaces + int(_level->cutFaces.size()); }

int SurfaceFaces::GetNumEdges() const { return _level->numEdges + int(_level->cutFaces.size()); }

CrossedFace const *SurfaceFaces::findCut(Index levelFace) const {
    return internal::FindCrossedFaceIn(_level->cutFaces, levelFace);
}

Far::Index SurfaceFaces::getRank(CrossedFace const &cut) const {
    return Index(&cut - _level->cutFaces.data());
}

auto SurfaceFaces::GetLevelFace(Index face) const -> LevelFace {
    Index const rank = face - _level->numFaces;
    return rank < 0 ? LevelFace{face, 0} : LevelFace{_level->cutFaces[std::size_t(rank)].face, 1};
}

Far::Index SurfaceFaces::GetFace(LevelFace levelFace) const {
    CrossedFace const *const cut = levelFace.half == 1 ? findCut(levelFace.face) : nullptr;
    return cut ? _level->numFaces + getRank(*cut) : levelFace.face;
}

bool SurfaceFaces::IsHalfOfCut(Index face) const {
    return face >= _level->numFaces || findCut(face);
}

FaceShape SurfaceFaces::GetShape(Index face) const {
    auto const [levelFace, half] = GetLevelFace(face);
    int const size = _level->GetFaceSize(levelFace);
    CrossedFace const *const cut = findCut(levelFace);
    return cut ? FaceShape(GetHalfSize(half, size, cut->end), true)
               : FaceShape(size, _level->IsHalfFace(levelFace));
}

bool SurfaceFaces::IsHole(Index face) const {
    auto const [levelFace, half] = GetLevelFace(face);
    unsigned const holes = _level->GetHoles(levelFace);
    return findCut(levelFace) ? (holes >> half & 1u) != 0 : holes == internal::kHole;
}

int SurfaceFaces::GetPlace(Index face, int local) const {
    auto const [levelFace, half] = GetLevelFace(face);
    CrossedFace const *const cut = findCut(levelFace);
    return cut ? GetPlaceInHalves(half, local, cut->end) : local;
}

Far::Index SurfaceFaces::GetVertex(Index face, int local) const {
    return _level
        ->faceVerts[_level->faceFirstCorner[GetLevelFace(face).face] + GetPlace(face, local)];
}

auto SurfaceFaces::GetEdge(Index face, int local) const -> Edge {
    auto const [levelFace, half] = GetLevelFace(face);
    CrossedFace const *const cut = findCut(levelFace);
    if (cut && local == 0) {
        return {_level->numEdges + getRank(*cut), half == 1};
    }
    int const place = cut ? GetPlaceInHalves(half, local, cut->end) : local;
    Index const edge = _level->faceEdges[_level->faceFirstCorner[levelFace] + place];
    return {edge,
            _level->edgeFaces[edge][0] != levelFace || _level->edgeFaceLocals[edge][0] != place};
}

auto SurfaceFaces::GetSide(Index edge, int side) const -> Side {
    if (Index const rank = edge - _level->numEdges; rank >= 0) {
        return {GetFace({_level->cutFaces[std::size_t(rank)].face, side}), 0};
    }
    Index const levelFace = _level->edgeFaces[edge][side];
    return levelFace < 0 ? Side{Far::INDEX_INVALID, 0}
                         : GetSideOfPlace(levelFace, _level->edgeFaceLocals[edge][side]);
}

auto SurfaceFaces::GetSideOfPlace(Index levelFace, int place) const -> Side {
    CrossedFace const *const cut = findCut(levelFace);
    if (!cut) {
        return {levelFace, place};
    }
    return {GetFace({levelFace, GetHalfOfEdge(place, cut->end)}), GetEdgeInHalf(place, cut->end)};
}

std::vector<Far::Index> SurfaceFaces::GetVertexFaces(Index vert) const {
    std::vector<Index> faces;
    for (Index k = _level->vertFirstFace[vert]; k < _level->vertFirstFace[vert + 1]; ++k) {
        Index const levelFace = _level->vertFaces[k];
        int const place = _level->vertFaceLocals[k];
        CrossedFace const *const cut = findCut(levelFace);
        if (!cut || place == kDiagonalStart || place >= cut->end) {
            faces.push_back(levelFace);
        }
        if (cut && place <= cut->end) {
            faces.push_back(GetFace({levelFace, 1}));
        }
    }
    return faces;
}

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "tileMap.h"

#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/runs.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::OsdExt::internal {

using FarExt::HexIndexing;
using FarExt::kEFaceSideB;
using FarExt::kEFaceSideShift;
using FarExt::internal::AppendRun;
using FarExt::internal::ParallelFor;

namespace {

/// The least faces of a tile, on the average, in the level that several tiles are made of.
constexpr int kMinTileFaces = 64;

void append(std::vector<TileMap::Run> &runs, TileMap::Run const &run) {
    AppendRun(runs, run, [](TileMap::Run const &a, TileMap::Run const &b) {
        return a.tile == b.tile && a.size == b.size;
    });
}

// The runs of count components.
template <class GET_TILE>
std::vector<TileMap::Run> makeRunsOf(Far::Index count, GET_TILE getTile) {
    std::vector<TileMap::Run> runs;
    for (Far::Index i = 0; i < count; ++i) {
        append(runs, TileMap::Run{i, i + 1, getTile(i)});
    }
    return runs;
}

} // namespace

TileMap::TileMap(Level const &base, int numTiles)
    : _numTiles(numTiles), _faceOrder(std::size_t(base.numFaces)) {
    std::iota(_faceOrder.begin(), _faceOrder.end(), 0);
    makeTiles(base);
}

// Cuts the order of the faces into pieces of as many corners each, if there are enough faces.
void TileMap::makeTiles(Level const &level) {
    std::vector<Tile> tilesOfFaces(_faceOrder.size(), 0);
    if (level.numFaces / kMinTileFaces + 1 >= _numTiles) {
        std::int64_t numCorners = 0;
        Tile tile = 0;
        for (Index const face : _faceOrder) {
            while (numCorners * _numTiles >= (tile + 1) * std::int64_t(level.numCorners)) {
                ++tile;
            }
            tilesOfFaces[std::size_t(face)] = tile;
            numCorners += level.faceFirstCorner[std::size_t(face) + 1] -
                          level.faceFirstCorner[std::size_t(face)];
        }
        _faceOrder = {};
    }
    makeRuns(level, tilesOfFaces);
}

// Makes the runs of a level whose numbering does not tell them.
void TileMap::makeRuns(Level const &level, std::vector<Tile> const &tilesOfFaces) {
    _faceRuns.clear();
    Index const *const firstCorners = level.faceFirstCorner.data();
    for (Index face = 0; face < level.numFaces; ++face) {
        append(_faceRuns, {face, face + 1, tilesOfFaces[std::size_t(face)],
                           firstCorners[face + 1] - firstCorners[face]});
    }
    std::vector<Tile> tilesOfVertices(std::size_t(level.numVertices));
    ParallelFor(level.numVertices, [&](Index vert) {
        Index const *const faces = level.vertFaces.data();
        Index const *const first = level.vertFirstFace.data() + vert;
        Tile tile = first[0] == first[1] ? kNoTile : tilesOfFaces[std::size_t(faces[*first])];
        for (Index k = first[0]; k < first[1]; ++k) {
            tile = tilesOfFaces[std::size_t(faces[k])] == tile ? tile : kNoTile;
        }
        tilesOfVertices[std::size_t(vert)] = tile;
    });
    _firstVertexRuns = makeRunsOf(level.numVertices,
                                  [&](Index vert) { return tilesOfVertices[std::size_t(vert)]; });
    _fVertexRuns.clear();
}

auto TileMap::getTilesOfFaces() const -> std::vector<Tile> {
    std::vector<Tile> tiles;
    for (Run const &run : _faceRuns) {
        tiles.insert(tiles.end(), std::size_t(run.end - run.begin), run.tile);
    }
    return tiles;
}

auto TileMap::findTile(Index face) const -> Tile {
    auto const next = std::upper_bound(_faceRuns.begin(), _faceRuns.end(), face,
                                       [](Index f, Run const &run) { return f < run.begin; });
    return std::prev(next)->tile;
}

void TileMap::Refine(Refinement const &refinement, Refinement const *before) {
    Level const &parent = *refinement.parent;
    Level const &child = *refinement.child;
    if (!_faceOrder.empty()) {
        refineOrder(refinement);
        makeTiles(child);
    } else if (!child.isHexagonal) {
        makeRuns(child, refineTilesOfFaces(refinement));
    } else {
        if (_fVertexRuns.empty()) {
            findEdges(parent);
        } else {
            refineEdges(*before);
        }
        _fVertexRuns.push_back(getInnerFaceRuns());
        addEFaces(parent);
    }
}

// In the order, each face is replaced by its children.
void TileMap::refineOrder(Refinement const &refinement) {
    Level const &parent = *refinement.parent;
    Level const &child = *refinement.child;
    std::vector<std::vector<Index>> vFacesOf(std::size_t(parent.numFaces));
    for (Index cFace = child.numFaces - child.numVFaces; cFace < child.numFaces; ++cFace) {
        vFacesOf[std::size_t(refinement.GetFaceParentFace(cFace))].push_back(cFace);
    }
    std::vector<Index> order;
    order.reserve(std::size_t(child.numFaces));
    for (Index const face : _faceOrder) {
        order.push_back(face); // the F-face has the same index
        Index const end = parent.faceFirstCorner[std::size_t(face) + 1];
        for (Index corner = parent.faceFirstCorner[std::size_t(face)]; corner < end; ++corner) {
            Index const edge = parent.faceEdges[std::size_t(corner)];
            Index const cFace = refinement.GetEdgeChildFace(edge);
            if (cFace != Far::INDEX_INVALID && parent.edgeFaces[std::size_t(edge)][0] == face) {
                order.push_back(cFace);
            }
        }
        std::vector<Index> const &vFaces = vFacesOf[std::size_t(face)];
        order.insert(order.end(), vFaces.begin(), vFaces.end());
    }
    _faceOrder.swap(order);
}

// The tiles of the faces of the child, whose refinement may be any.
auto TileMap::refineTilesOfFaces(Refinement const &refinement) const -> std::vector<Tile> {
    std::vector<Tile> const tiles = getTilesOfFaces();
    std::vector<Tile> cTiles(std::size_t(refinement.child->numFaces));
    ParallelFor(refinement.child->numFaces, [&](Index cFace) {
        cTiles[std::size_t(cFace)] = tiles[std::size_t(refinement.GetFaceParentFace(cFace))];
    });
    return cTiles;
}

// The tiles of the edges of a level, those of their first faces, and the borders to the others.
void TileMap::findEdges(Level const &level) {
    std::vector<Tile> const tiles = getTilesOfFaces();
    auto const getTile = [&](Index edge, std::size_t side) {
        return tiles[std::size_t(level.edgeFaces[std::size_t(edge)][side])];
    };
    _edgeRuns = makeRunsOf(level.numEdges, [&](Index edge) { return getTile(edge, 0); });
    _borders.clear();
    for (Index edge = 0; edge < level.numEdges; ++edge) {
        if (!level.IsBoundary(edge) && getTile(edge, 0) != getTile(edge, 1)) {
            _borders.push_back({level.edgeFaces[std::size_t(edge)][1],
                                int(level.edgeFaceLocals[std::size_t(edge)][1]), false,
                                getTile(edge, 1), getTile(edge, 0)});
        }
    }
    std::sort(_borders.begin(), _borders.end(), [](Border const &a, Border const &b) {
        return a.face != b.face ? a.face < b.face : a.local < b.local;
    });
}

// The same of the child that the hexagonal refinement of \p parent made, whose edges are known.  An edge of
// an F-face is in the tile of that, and so are most spokes.
void TileMap::refineEdges(Refinement const &refinement) {
    Level const &parent = *refinement.parent;
    std::vector<Run> const borderSpokes = refineBorders(refinement);
    HexIndexing const indexing = parent.ChildIndexing();
    std::vector<Run> cornerRuns;
    for (Run const &run : _faceRuns) {
        if (run.begin < parent.numFaces) {
            Index const end = std::min(run.end, parent.numFaces);
            append(cornerRuns, {parent.faceFirstCorner[std::size_t(run.begin)],
                                parent.faceFirstCorner[std::size_t(end)], run.tile});
        }
    }
    _edgeRuns = cornerRuns;
    auto spoke = borderSpokes.begin();
    for (Run const &run : cornerRuns) {
        Index const end = indexing.GetCornerChildSpoke(run.end);
        Index begin = indexing.GetCornerChildSpoke(run.begin);
        for (; spoke != borderSpokes.end() && spoke->begin < end; ++spoke) {
            append(_edgeRuns, {begin, spoke->begin, run.tile});
            append(_edgeRuns, *spoke);
            begin = spoke->end;
        }
        append(_edgeRuns, {begin, end, run.tile});
    }
    Index cEdge = indexing.GetBoundaryChildEdge(0);
    for (Index const edge : parent.boundaryEdges) {
        if (!parent.IsSharpBoundaryB(edge)) {
            append(_edgeRuns, {cEdge, cEdge + 1, findTile(parent.edgeFaces[std::size_t(edge)][0])});
            ++cEdge;
        }
    }
}

// Goes on from the borders to those of the child, all of which are in the E-faces of their edges,
// and gives the spokes that are in another tile than the face of their corner, ascending.
auto TileMap::refineBorders(Refinement const &refinement) -> std::vector<Run> {
    Level const &parent = *refinement.parent;
    struct BorderSide { // of an E-face
        Index face;
        bool isSideA;
        Tile faceTile;
        Tile endSpokeTile;
        Tile fFaceEdgeTile;
        Tile startSpokeTile;
    };
    std::vector<Run> spokes;
    std::vector<BorderSide> sides;
    std::vector<Tile> edgeTiles; // of the edges of a face
    for (auto border = _borders.begin(); border != _borders.end();) {
        Index const face = border->face;
        Tile const tile = border->faceTile;
        Index const first = parent.faceFirstCorner[std::size_t(face)];
        int const size = parent.faceFirstCorner[std::size_t(face) + 1] - first;
        Index const *const edges = parent.faceEdges.data() + first;
        auto const begin = border;
        edgeTiles.assign(std::size_t(size), tile);
        for (; border != _borders.end() && border->face == face; ++border) {
            edgeTiles[std::size_t(border->local)] = border->edgeTile;
        }
        auto const makesEFace = [&](int local) {
            return parent.numSharpBoundariesB == 0 || !parent.IsSharpBoundaryB(edges[local]);
        };
        // The tile that most of the faces around the F-vertex are in.
        auto const getSpokeTile = [&](int corner) {
            int const before = (corner == 0 ? size : corner) - 1;
            Tile const tileBefore = edgeTiles[std::size_t(before)];
            Tile const tileAfter = edgeTiles[std::size_t(corner)];
            if (tileBefore == tileAfter || !makesEFace(before)) {
                return tileAfter;
            }
            return makesEFace(corner) ? tile : tileBefore;
        };
        for (int corner = 0; corner < size; ++corner) {
            if (Tile const spokeTile = getSpokeTile(corner); spokeTile != tile) {
                Index const spoke = parent.ChildIndexing().GetCornerChildSpoke(first + corner);
                spokes.push_back({spoke, spoke + 1, spokeTile});
            }
        }
        for (auto it = begin; it != border; ++it) {
            int const end = it->local + 1 == size ? 0 : it->local + 1;
            sides.push_back({refinement.GetEdgeChildFace(edges[it->local]), it->isSideA,
                             it->edgeTile, getSpokeTile(end), tile, getSpokeTile(it->local)});
        }
    }
    std::sort(sides.begin(), sides.end(), [](BorderSide const &a, BorderSide const &b) {
        return a.face != b.face ? a.face < b.face : a.isSideA < b.isSideA;
    });
    _borders.clear();
    for (BorderSide const &side : sides) {
        auto const addBorder = [&](int localOfB, Tile edgeTile) {
            if (edgeTile != side.faceTile) {
                int const local = localOfB + (side.isSideA ? kEFaceSideShift : 0);
                _borders.push_back(
                    {side.face, local, FarExt::IsEFaceSideA(local), side.faceTile, edgeTile});
            }
        };
        static_assert(kEFaceSideB.endSpoke < kEFaceSideB.fFaceEdge &&
                      kEFaceSideB.fFaceEdge < kEFaceSideB.startSpoke);
        addBorder(kEFaceSideB.endSpoke, side.endSpokeTile);
        addBorder(kEFaceSideB.fFaceEdge, side.fFaceEdgeTile);
        addBorder(kEFaceSideB.startSpoke, side.startSpokeTile);
    }
    return spokes;
}

// The runs of the faces, those with a border cut out, for kNoTile.  The faces around an F-vertex
// come from a face and two of its edges, those around a V-vertex from the edges around its parent.
auto TileMap::getInnerFaceRuns() const -> std::vector<Run> {
    std::vector<Run> runs;
    auto border = _borders.begin();
    for (Run const &run : _faceRuns) {
        Index begin = run.begin;
        for (; border != _borders.end() && border->face < run.end; ++border) {
            if (border->face >= begin) { // else the last one was of the same face
                append(runs, {begin, border->face, run.tile, run.size});
                begin = border->face + 1;
                append(runs, {border->face, begin, kNoTile, run.size});
            }
        }
        append(runs, {begin, run.end, run.tile, run.size});
    }
    return runs;
}

// Adds the E-faces, of edges whose runs are known.
void TileMap::addEFaces(Level const &parent) {
    Index cFace = parent.numFaces;
    auto const add = [&](Index numEdges, Tile tile, int size) {
        append(_faceRuns, {cFace, cFace + numEdges, tile, size});
        cFace += numEdges;
    };
    Index const *boundary = parent.boundaryEdges.begin();
    for (Run const &run : _edgeRuns) {
        Index begin = run.begin;
        for (; boundary != parent.boundaryEdges.end() && *boundary < run.end; ++boundary) {
            add(*boundary - begin, run.tile, HexIndexing::kNumEFaceCorners);
            if (!parent.IsSharpBoundaryB(*boundary)) {
                add(1, run.tile, HexIndexing::kNumBoundaryEFaceCorners);
            }
            begin = *boundary + 1;
        }
        add(run.end - begin, run.tile, HexIndexing::kNumEFaceCorners);
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "tileMap.h"

#include "far_ext/parallel.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::TopologyLevel;
using FarExt::internal::LevelTopology;
using FarExt::internal::ParallelFor;
using FarExt::internal::ParallelSelect;

namespace {

/// The least faces of a tile, on the average, in the level that several tiles are made of.
constexpr int kMinTileFaces = 64;

} // namespace

TileMap::TileMap(TopologyLevel const &base, int numTiles)
    : _numTiles(numTiles), _faceOrder(std::size_t(base.GetNumFaces())) {
    std::iota(_faceOrder.begin(), _faceOrder.end(), 0);
    makeTiles(base);
}

// Cuts the order of the faces into pieces of as many corners each, if there are enough faces.
void TileMap::makeTiles(TopologyLevel const &level) {
    _tilesOfFaces.assign(_faceOrder.size(), 0);
    if (level.GetNumFaces() / kMinTileFaces + 1 < _numTiles) {
        _tilesOfFirstVertices.assign(std::size_t(level.GetNumVertices()), 0);
        return;
    }
    std::int64_t numCorners = 0;
    for (Index const face : _faceOrder) {
        _tilesOfFaces[std::size_t(face)] =
            Tile(numCorners * _numTiles / level.GetNumFaceVertices());
        numCorners += level.GetFaceVertices(face).size();
    }
    _faceOrder = {};
    makeVertexTiles(level);
}

void TileMap::makeVertexTiles(TopologyLevel const &level) {
    _tilesOfFVertices.clear();
    _tilesOfFirstVertices.resize(std::size_t(level.GetNumVertices()));
    ParallelFor(level.GetNumVertices(), [&](Index vert) {
        Far::ConstIndexArray const faces = level.GetVertexFaces(vert);
        Tile tile = faces.empty() ? kNoTile : _tilesOfFaces[std::size_t(faces[0])];
        for (Index const face : faces) {
            tile = _tilesOfFaces[std::size_t(face)] == tile ? tile : kNoTile;
        }
        _tilesOfFirstVertices[std::size_t(vert)] = tile;
    });
}

void TileMap::Refine(TopologyLevel const &parent) {
    LevelTopology const &topology = parent.GetTopology();
    TopologyLevel const child(topology.child);
    if (!_faceOrder.empty()) {
        refineOrder(parent);
        makeTiles(child);
        return;
    }
    // The faces around an F-vertex come from a face and two of its edges, those around a V-vertex
    // from the edges around its parent.  An edge, and its E-face, is where its first face is.
    std::vector<Tile> tilesOfFVertices = _tilesOfFaces;
    Index const *const edgeFaces = topology.edgeFaces.data();
    for (Index const edge : ParallelSelect(topology.numEdges, [&](Index e) {
             Index const *const faces = edgeFaces + 2 * std::size_t(e);
             return faces[1] >= 0 &&
                    _tilesOfFaces[std::size_t(faces[0])] != _tilesOfFaces[std::size_t(faces[1])];
         })) {
        tilesOfFVertices[std::size_t(edgeFaces[2 * std::size_t(edge) + 1])] = kNoTile;
    }

    _tilesOfFaces.resize(std::size_t(child.GetNumFaces()));
    for (Index cFace = child.GetNumFaces() - child.GetTopology().numVFaces;
         cFace < child.GetNumFaces(); ++cFace) {
        _tilesOfFaces[std::size_t(cFace)] =
            _tilesOfFaces[std::size_t(child.GetFaceParentFace(cFace))];
    }
    ParallelFor(topology.numEdges, [&](Index edge) {
        if (Index const cFace = topology.GetEdgeChildFace(edge); cFace != Far::INDEX_INVALID) {
            _tilesOfFaces[std::size_t(cFace)] =
                _tilesOfFaces[std::size_t(edgeFaces[2 * std::size_t(edge)])];
        }
    });
    if (child.GetTopology().isHexagonal) {
        _tilesOfFVertices.push_back(std::move(tilesOfFVertices));
    } else {
        makeVertexTiles(child);
    }
}

// In the order, each face is replaced by its children.
void TileMap::refineOrder(TopologyLevel const &parent) {
    LevelTopology const &topology = parent.GetTopology();
    TopologyLevel const child(topology.child);
    std::vector<std::vector<Index>> vFacesOf(std::size_t(topology.numFaces));
    for (Index cFace = child.GetNumFaces() - child.GetTopology().numVFaces;
         cFace < child.GetNumFaces(); ++cFace) {
        vFacesOf[std::size_t(child.GetFaceParentFace(cFace))].push_back(cFace);
    }
    std::vector<Index> order;
    order.reserve(std::size_t(child.GetNumFaces()));
    for (Index const face : _faceOrder) {
        order.push_back(topology.faceChildFaces[std::size_t(face)]);
        for (Index const edge : parent.GetFaceEdges(face)) {
            Index const cFace = topology.GetEdgeChildFace(edge);
            if (cFace != Far::INDEX_INVALID && topology.edgeFaces[2 * std::size_t(edge)] == face) {
                order.push_back(cFace);
            }
        }
        std::vector<Index> const &vFaces = vFacesOf[std::size_t(face)];
        order.insert(order.end(), vFaces.begin(), vFaces.end());
    }
    _faceOrder.swap(order);
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "truncationMask.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;
using Sdc::Crease;

namespace {

constexpr double kAlongEdge = 1.0 / 3;         // of W in T on a sharp edge
constexpr double kAlongCrease = 1.0 / 9;       // of each neighbour in V' on a crease
constexpr double kOfHexagonalCrease = 1.0 / 8; // in SharpVertex, where both edges are A edges

bool isBorder(Level const &level, Index edge) {
    return level.IsBoundary(edge) || Crease::IsSharp(level.GetEdgeSharpness(edge));
}

struct FaceCorner {
    Index face;
    Index corner;
};

// Where the other face of an interior edge begins to run along it.
FaceCorner getOtherSide(Level const &level, Index corner) {
    Index const edge = level.faceEdges[corner];
    int const side = level.GetSideCorner(edge, 0) == corner ? 1 : 0;
    return {level.edgeFaces[edge][side], level.GetSideCorner(edge, side)};
}

// How much of the sharp rule an edge has.
double getSharpShare(Level const &level, Index edge) {
    return level.IsBoundary(edge) ? 1 : std::min(1.0f, level.GetEdgeSharpness(edge));
}

} // namespace

Index GetEdgeEndVertex(Refinement const &truncation, std::size_t end) {
    Level const &parent = *truncation.parent;
    Index const edge = Index(end / 2);
    if (Index const corner = parent.GetSideCorner(edge, int(end % 2)); corner >= 0) {
        return truncation.GetCornerChildVertex(corner);
    }
    Index const *const boundaries = parent.boundaryEdges.begin();
    Index const *const found = std::lower_bound(boundaries, parent.boundaryEdges.end(), edge);
    return truncation.GetCornerChildVertex(parent.numCorners + Index(found - boundaries));
}

void TruncationMask::GetSources(Index cVert, Sources &sources) const {
    sources.verts.clear();
    sources.weights.clear();
    if (cVert < _refinement.child->numVVertices) {
        addVVertex(_refinement.GetVVertexParent(cVert), sources);
        return;
    }
    Index const corner = _refinement.GetChildVertexCorner(cVert);
    if (corner < _parent.numCorners) {
        addEdgeVertex(FindEdgeEnd(_parent, corner), sources);
    } else {
        addEdgeVertex(2 * std::size_t(_parent.boundaryEdges[corner - _parent.numCorners]) + 1,
                      sources);
    }
}

auto TruncationMask::getShares(Index vert, SharpVertex const *sharp) const -> RuleShares {
    double const smooth = sharp ? sharp->faceWeight * (_parent.GetNumVertexFaces(vert) + 1) : 1.0;
    double const crease =
        sharp ? (sharp->neighborWeights[0] + sharp->neighborWeights[1]) / (2 * kOfHexagonalCrease)
              : 0.0;
    bool const isFree = _parent.GetVertexEdges(vert).size() > _parent.GetNumVertexFaces(vert);
    return isFree ? RuleShares{0, crease, smooth} : RuleShares{smooth, crease, 0};
}

// The weight b on the smooth edge along which a face begins to run in a corner of the vertex.
double TruncationMask::getWeight(Index vert, Index corner) const {
    RuleShares const shares = getShares(vert, _parent.FindSharpVertex(vert));
    int const numFaces = _parent.GetNumVertexFaces(vert);
    if (shares.smooth == 1) {
        return ComputeTruncateWeight(numFaces);
    }
    // Faces are counted to both sides of the edge, up to sharp ones or all around.
    Index const edge = _parent.faceEdges[corner];
    int count = 0;
    auto const isLast = [&](Index bound) {
        ++count;
        return bound == edge || isBorder(_parent, bound);
    };
    FaceCorner at = {_parent.edgeFaces[edge][_parent.GetSideCorner(edge, 0) == corner ? 0 : 1],
                     corner};
    Index in = _parent.GetPrevCorner(at.face, at.corner);
    while (!isLast(_parent.faceEdges[in])) {
        at = getOtherSide(_parent, in);
        in = _parent.GetPrevCorner(at.face, at.corner);
    }
    Index const lastBound = _parent.faceEdges[in];
    if (lastBound == edge) {
        return ComputeTruncateWeight(count);
    }
    Index out = corner;
    do {
        at = getOtherSide(_parent, out);
        out = _parent.GetNextCorner(at.face, at.corner);
    } while (!isLast(_parent.faceEdges[out]));
    bool const isDart = _parent.faceEdges[out] == lastBound;
    double const ofSector = ComputeTruncateWeight(isDart ? count : 2 * count);
    return shares.smooth * ComputeTruncateWeight(numFaces) + (1 - shares.smooth) * ofSector;
}

void TruncationMask::addEdgeVertex(std::size_t end, Sources &sources) const {
    auto const add = [&](Index vert, double weight) {
        sources.verts.push_back(vert);
        sources.weights.push_back(weight);
    };
    Index const edge = Index(end / 2);
    int const side = int(end % 2);
    Index const vert = _parent.edgeVerts[edge][side];
    Index const other = _parent.edgeVerts[edge][1 - side];
    bool const isLinear = _interpolation == Interpolation::Varying;
    double const sharp = isLinear ? 1 : getSharpShare(_parent, edge);
    if (sharp == 1) {
        add(vert, 1 - kAlongEdge);
        add(other, kAlongEdge);
        return;
    }
    double const b = (1 - sharp) * getWeight(vert, _parent.GetSideCorner(edge, side));
    double ofFaces = 0; // that of a vertex which both faces have
    for (int i : {0, 1}) {
        ofFaces += b / _parent.GetFaceSize(_parent.edgeFaces[edge][i]);
    }
    add(vert, sharp * (1 - kAlongEdge) + (1 - sharp) - 2 * b + ofFaces);
    add(other, sharp * kAlongEdge + ofFaces);
    for (int i : {0, 1}) {
        Index const face = _parent.edgeFaces[edge][i];
        Index const start = _parent.GetSideCorner(edge, i);
        Index const last = _parent.GetNextCorner(face, start);
        for (Index at = _parent.GetNextCorner(face, last); at != start;
             at = _parent.GetNextCorner(face, at)) {
            add(_parent.faceVerts[at], b / _parent.GetFaceSize(face));
        }
    }
}

void TruncationMask::addVVertex(Index vert, Sources &sources) const {
    int const numFaces = _parent.GetNumVertexFaces(vert);
    if (_interpolation == Interpolation::Varying || numFaces == 0) {
        sources.verts.push_back(vert);
        sources.weights.push_back(1);
        return;
    }
    double rest = 1;
    auto const add = [&](Index source, double weight) {
        sources.verts.push_back(source);
        sources.weights.push_back(weight);
        rest -= weight;
    };
    // Neighbors come first, so that it does not matter for the sum which of them is left and right.
    SharpVertex const *const sharp = _parent.FindSharpVertex(vert);
    RuleShares const shares = getShares(vert, sharp);
    if (shares.crease > 0) {
        for (Index neighbor : sharp->neighbors) {
            add(neighbor, shares.crease * kAlongCrease);
        }
    }
    if (shares.border > 0) {
        Index const first = _parent.vertFirstEdge[vert];
        Index const last = _parent.vertFirstEdge[vert + 1] - 1;
        Far::LocalIndex const *const locals = _parent.GetVertexEdgeLocals(vert);
        for (Index i : {first, last}) {
            add(_parent.edgeVerts[_parent.vertEdges[i]][1 - locals[i - first]],
                shares.border * kAlongCrease);
        }
    }
    if (shares.smooth > 0) {
        double const ofFace = shares.smooth * 2 * ComputeTruncateWeight(numFaces) / numFaces;
        for (Index face : _parent.GetVertexFaces(vert)) {
            for (Index source : _parent.GetFaceVertices(face)) {
                add(source, ofFace / _parent.GetFaceSize(face));
            }
        }
    }
    sources.verts.push_back(vert);
    sources.weights.push_back(rest);
}

} // namespace OpenSubdivHex::FarExt::internal

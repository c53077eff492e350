// SPDX-License-Identifier: Apache-2.0
#include "truncationMask.h"

#include "far_ext/rules/sharpMask.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;
using Sdc::Crease;

namespace {

bool isBorder(Level const &level, Index edge) {
    return level.IsBoundary(edge) || Crease::IsSharp(level.GetEdgeSharpness(edge));
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
    double const smooth = sharp ? sharp->smoothShare : 1;
    double const crease = sharp ? sharp->creaseShare : 0;
    bool const isFree = _parent.GetVertexEdges(vert).size() > _parent.GetNumVertexFaces(vert);
    return isFree ? RuleShares{0, crease, smooth} : RuleShares{smooth, crease, 0};
}

// The number of faces that an edge counts as lying between at a vertex, where a face begins to run
// along it in a corner: those of a sector and of its mirror image.
int TruncationMask::countSector(Index corner) const {
    // They are counted to both sides of the edge, up to sharp ones or all around.
    auto const isBorderAt = [&](Index at) { return isBorder(_parent, _parent.faceEdges[at]); };
    Index const edge = _parent.faceEdges[corner];
    int count = 0;
    FaceCorner next = {_parent.edgeFaces[edge][_parent.GetSideCorner(edge, 0) == corner ? 0 : 1],
                       corner};
    bool isBorderBefore = false;
    do {
        ++count;
        Index const in = _parent.GetPrevCorner(next.face, next.corner);
        isBorderBefore = isBorderAt(in);
        next = _parent.IsBoundary(_parent.faceEdges[in])
                   ? FaceCorner{Far::INDEX_INVALID, Far::INDEX_INVALID}
                   : _parent.GetCornerAcross(in);
    } while (!isBorderBefore && next.corner != corner);
    if (next.corner == corner) {
        return count;
    }
    Index out = corner;
    do {
        ++count;
        FaceCorner const at = _parent.GetCornerAcross(out);
        out = _parent.GetNextCorner(at.face, at.corner);
    } while (!isBorderAt(out));
    bool const isDart = out == next.corner;
    return isDart ? count : 2 * count;
}

// Adds what the centroids weigh in the mask on the edge that starts in a corner of the vertex, as weights of the
// vertex and of its neighbors; each source once where all faces are triangles.
void TruncationMask::addCentroids(Index vert, Index corner, TruncateMask const &mask,
                                  Sources &sources) const {
    FaceCorner const across = _parent.GetCornerAcross(corner);
    Index const beside[] = {corner, _parent.GetNextCorner(across.face, across.corner)};
    Index const first = _parent.vertFirstFace[vert];
    int const numFaces = _parent.GetNumVertexFaces(vert);
    // For each corner of a face at the vertex.
    auto const getWeight = [&](FaceCorner const &at) {
        bool const isBeside = at.corner == beside[0] || at.corner == beside[1];
        return (mask.aroundWeight / numFaces + (isBeside ? mask.besideWeight : 0)) /
               _parent.GetFaceSize(at.face);
    };
    double own = mask.vertexWeight;
    for (Index k = first; k < first + numFaces; ++k) {
        FaceCorner const at = {_parent.vertFaces[k], _parent.GetVertexCorner(k)};
        double const weight = getWeight(at);
        own += weight;
        FaceCorner next = _parent.GetCornerAcross(at.corner);
        next.corner = _parent.GetNextCorner(next.face, next.corner);
        Index const end = _parent.GetPrevCorner(at.face, at.corner);
        Index source = _parent.GetNextCorner(at.face, at.corner);
        sources.Add(_parent.faceVerts[source], weight + getWeight(next));
        for (source = _parent.GetNextCorner(at.face, source); source != end;
             source = _parent.GetNextCorner(at.face, source)) {
            sources.Add(_parent.faceVerts[source], weight);
        }
    }
    sources.Add(vert, own);
}

void TruncationMask::addEdgeVertex(std::size_t end, Sources &sources) const {
    Index const edge = Index(end / 2);
    int const side = int(end % 2);
    Index const vert = _parent.edgeVerts[edge][side];
    Index const other = _parent.edgeVerts[edge][1 - side];
    bool const isLinear = _interpolation == Interpolation::Varying;
    double const sharp = isLinear ? 1 : getSharpShare(_parent, edge);
    if (sharp == 1) {
        sources.Add(vert, 1 - kTruncateAlongEdge);
        sources.Add(other, kTruncateAlongEdge);
        return;
    }
    Index const corner = _parent.GetSideCorner(edge, side);
    SharpVertex const *const sharpVertex = _parent.FindSharpVertex(vert);
    RuleShares const shares = getShares(vert, sharpVertex);
    TruncateMask mask = ComputeTruncateMask(_parent.GetNumVertexFaces(vert));
    if (shares.smooth != 1) {
        TruncateMask const ofSector = ComputeTruncateMask(countSector(corner));
        mask.besideWeight =
            shares.smooth * mask.besideWeight + (1 - shares.smooth) * ofSector.besideWeight;
        mask.aroundWeight *= shares.smooth;
        double const ofLine =
            addAlongLine(vert, sharpVertex, shares,
                         (1 - sharp) * ofSector.aroundWeight * kTruncateAround, sources);
        mask.vertexWeight = 1 - 2 * mask.besideWeight - mask.aroundWeight - ofLine / (1 - sharp);
    }
    mask.vertexWeight = sharp * (1 - kTruncateAlongEdge) + (1 - sharp) * mask.vertexWeight;
    mask.besideWeight *= 1 - sharp;
    mask.aroundWeight *= 1 - sharp;
    if (mask.aroundWeight > 0) {
        addCentroids(vert, corner, mask, sources);
        if (sharp > 0) {
            sources.Add(other, sharp * kTruncateAlongEdge);
        }
        return;
    }
    double ofFaces = 0; // that of a vertex which both faces have
    for (int i : {0, 1}) {
        ofFaces += mask.besideWeight / _parent.GetFaceSize(_parent.edgeFaces[edge][i]);
    }
    sources.Add(vert, mask.vertexWeight + ofFaces);
    sources.Add(other, sharp * kTruncateAlongEdge + ofFaces);
    for (int i : {0, 1}) {
        Index const face = _parent.edgeFaces[edge][i];
        Index const start = _parent.GetSideCorner(edge, i);
        Index const last = _parent.GetNextCorner(face, start);
        for (Index at = _parent.GetNextCorner(face, last); at != start;
             at = _parent.GetNextCorner(face, at)) {
            sources.Add(_parent.faceVerts[at], mask.besideWeight / _parent.GetFaceSize(face));
        }
    }
}

// The neighbors of a vertex along the crease or border that it is on, each with a weight by the shares
// of these rules.  Returns the sum of what is added.
double TruncationMask::addAlongLine(Index vert, SharpVertex const *sharp, RuleShares const &shares,
                                    double weight, Sources &sources) const {
    double sum = 0;
    auto const add = [&](Index neighbor, double ofNeighbor) {
        sources.Add(neighbor, ofNeighbor);
        sum += ofNeighbor;
    };
    if (shares.crease > 0 && weight > 0) {
        for (Index neighbor : sharp->neighbors) {
            add(neighbor, shares.crease * weight);
        }
    }
    if (shares.border > 0 && weight > 0) {
        Index const first = _parent.vertFirstEdge[vert];
        Index const last = _parent.vertFirstEdge[vert + 1] - 1;
        Far::LocalIndex const *const locals = _parent.GetVertexEdgeLocals(vert);
        for (Index i : {first, last}) {
            add(_parent.edgeVerts[_parent.vertEdges[i]][1 - locals[i - first]],
                shares.border * weight);
        }
    }
    return sum;
}

void TruncationMask::addVVertex(Index vert, Sources &sources) const {
    int const numFaces = _parent.GetNumVertexFaces(vert);
    if (_interpolation == Interpolation::Varying || numFaces == 0) {
        sources.Add(vert, 1);
        return;
    }
    SharpVertex const *const sharp = _parent.FindSharpVertex(vert);
    RuleShares const shares = getShares(vert, sharp);
    // Neighbors come first, so that it does not matter for the sum which of them is left and right.
    double rest = 1 - addAlongLine(vert, sharp, shares, kTruncateAlongCrease, sources);
    if (shares.smooth > 0) {
        double const ofFaces = 1 - ComputeTruncateMask(numFaces).vertexWeight;
        double const ofFace = shares.smooth * ofFaces / numFaces;
        for (Index face : _parent.GetVertexFaces(vert)) {
            for (Index source : _parent.GetFaceVertices(face)) {
                double const weight = ofFace / _parent.GetFaceSize(face);
                sources.Add(source, weight);
                rest -= weight;
            }
        }
    }
    sources.Add(vert, rest);
}

} // namespace OpenSubdivHex::FarExt::internal

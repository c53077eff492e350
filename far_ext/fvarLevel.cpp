// SPDX-License-Identifier: Apache-2.0
#include "fvarLevel.h"

#include "baseLevel.h"
#include "sharpFeatures.h"
#include "topologyRefinement.h"

namespace OpenSubdivHex::FarExt::internal {

// Defined here, where the type of their channels is complete.
LevelTopology::LevelTopology() = default;
LevelTopology::~LevelTopology() = default;

namespace {

using Far::Index;

// The corners where the two sides of an edge of the mesh begin, the second negative at a boundary.
EdgeSides sidesOf(LevelTopology const &mesh, Index edge) {
    EdgeSides sides;
    for (int side = 0; side < 2; ++side) {
        std::size_t const k = 2 * std::size_t(edge) + side;
        Index const face = mesh.edgeFaces[k];
        sides.corners[side] = face < 0 ? face : mesh.faceFirstCorner[face] + mesh.edgeFaceLocals[k];
    }
    return sides;
}

Index nextCorner(LevelTopology const &mesh, Index face, Index corner) {
    return corner + 1 == mesh.faceFirstCorner[face + 1] ? mesh.faceFirstCorner[face] : corner + 1;
}

// The edges of the value mesh: an edge of the mesh whose sides differ in a value falls into two.
// meshEdges gets the mesh edge that each comes from.
std::vector<EdgeSides> cutSeams(LevelTopology const &mesh, std::vector<Index> const &faceValues,
                                std::vector<Index> &meshEdges) {
    std::vector<EdgeSides> result;
    std::vector<EdgeSides> secondSides;
    std::vector<Index> secondMeshEdges;
    for (Index edge = 0; edge < mesh.numEdges; ++edge) {
        EdgeSides sides = sidesOf(mesh, edge);
        if (sides.corners[1] >= 0) {
            Index const next0 =
                nextCorner(mesh, mesh.edgeFaces[2 * std::size_t(edge)], sides.corners[0]);
            Index const next1 =
                nextCorner(mesh, mesh.edgeFaces[2 * std::size_t(edge) + 1], sides.corners[1]);
            if (faceValues[sides.corners[0]] != faceValues[next1] ||
                faceValues[sides.corners[1]] != faceValues[next0]) {
                secondSides.push_back({{sides.corners[1], kSharpBoundaryA}});
                secondMeshEdges.push_back(edge);
                sides.corners[1] = kSharpBoundaryA;
            }
        }
        result.push_back(sides);
        meshEdges.push_back(edge);
    }
    result.insert(result.end(), secondSides.begin(), secondSides.end());
    meshEdges.insert(meshEdges.end(), secondMeshEdges.begin(), secondMeshEdges.end());
    return result;
}

// Gives every fan of faces around a vertex of the level a vertex of its own: the first keeps the
// index, others are appended.
void splitFans(FVarLevel &channel, std::vector<EdgeSides> const &edges) {
    LevelTopology &level = channel.topology;
    std::vector<Index> valuesOfVertices(channel.numValues);
    for (Index value = 0; value < channel.numValues; ++value) {
        valuesOfVertices[value] = value;
    }
    for (Index vert = 0; vert < channel.numValues; ++vert) {
        Index fanVert = vert;
        bool isFirstFan = true;
        Index lastInEdge = Far::INDEX_INVALID;
        Index fanOutEdge = Far::INDEX_INVALID;
        for (Index i = level.vertFirstFace[vert]; i < level.vertFirstFace[vert + 1]; ++i) {
            Index const face = level.vertFaces[i];
            Index const first = level.faceFirstCorner[face];
            int const size = level.faceFirstCorner[face + 1] - first;
            Index const corner = first + level.vertFaceLocals[i];
            Index const outEdge = level.faceEdges[corner];
            Index const inEdge =
                level.faceEdges[first + (level.vertFaceLocals[i] + size - 1) % size];
            bool const goesOn =
                lastInEdge == outEdge && !level.IsBoundary(outEdge) && lastInEdge != fanOutEdge;
            if (!goesOn) {
                if (!isFirstFan) {
                    fanVert = Index(valuesOfVertices.size());
                    valuesOfVertices.push_back(vert);
                }
                isFirstFan = false;
                fanOutEdge = outEdge;
            }
            level.faceVerts[corner] = fanVert;
            lastInEdge = inEdge;
        }
    }
    channel.valuesOfVertices.Resize(valuesOfVertices.size());
    std::copy(valuesOfVertices.begin(), valuesOfVertices.end(), channel.valuesOfVertices.data());
    if (Index(valuesOfVertices.size()) > channel.numValues) {
        level.numVertices = Index(valuesOfVertices.size());
        BuildBaseLevel(edges, level);
    }
}

bool meetsFreeBoundary(LevelTopology const &level, Index vert, bool &meetsSharp) {
    bool meetsFree = false;
    meetsSharp = false;
    for (Index i = level.vertFirstEdge[vert]; i < level.vertFirstEdge[vert + 1]; ++i) {
        Index const edge = level.vertEdges[i];
        if (level.IsBoundary(edge)) {
            bool const isFree = level.edgeFaces[2 * std::size_t(edge) + 1] == kFreeBoundary;
            (isFree ? meetsFree : meetsSharp) = true;
        }
    }
    return meetsFree;
}

} // namespace

void BuildFVarLevel(LevelTopology const &mesh, Index numValues,
                    std::vector<Index> const &faceValues, std::vector<float> const &sharpness,
                    Sdc::Options sdcOptions, FVarLevel &channel) {
    LevelTopology &level = channel.topology;
    channel.numValues = numValues;
    channel.linearInterpolation = sdcOptions.GetFVarLinearInterpolation();
    channel.faceValues.Resize(faceValues.size());
    std::copy(faceValues.begin(), faceValues.end(), channel.faceValues.data());
    channel.valueFaces.Resize(mesh.numFaces);
    for (Index face = 0; face < mesh.numFaces; ++face) {
        channel.valueFaces[face] = face;
    }

    level.numVertices = numValues;
    level.numFaces = mesh.numFaces;
    level.numCorners = mesh.numCorners;
    level.faceFirstCorner.Resize(mesh.faceFirstCorner.size());
    std::copy(mesh.faceFirstCorner.begin(), mesh.faceFirstCorner.end(),
              level.faceFirstCorner.data());
    level.faceVerts.Resize(faceValues.size());
    std::copy(faceValues.begin(), faceValues.end(), level.faceVerts.data());
    std::vector<Index> meshEdges;
    std::vector<EdgeSides> const edges = cutSeams(mesh, faceValues, meshEdges);
    BuildBaseLevel(edges, level);
    splitFans(channel, edges);

    // The tags of the mesh; a seam is sharp without one.
    if (!mesh.edgeSharpness.empty()) {
        level.edgeSharpness.Resize(level.numEdges);
        for (Index edge = 0; edge < level.numEdges; ++edge) {
            level.edgeSharpness[edge] =
                level.IsBoundary(edge) ? 0 : mesh.GetEdgeSharpness(meshEdges[edge]);
        }
    }
    level.vertSharpness.Resize(level.numVertices);
    std::fill_n(level.vertSharpness.data(), level.numVertices, Sdc::Crease::SHARPNESS_SMOOTH);
    for (Index corner = 0; corner < level.numCorners; ++corner) {
        level.vertSharpness[level.faceVerts[corner]] = sharpness[corner];
    }
    for (Index vert = 0; vert < level.numVertices; ++vert) {
        // Where a seam meets a boundary that follows the paper's rule no curve goes on: a corner.
        bool meetsSharp;
        if (meetsFreeBoundary(level, vert, meetsSharp) && meetsSharp) {
            level.vertSharpness[vert] = Sdc::Crease::SHARPNESS_INFINITE;
        }
    }
    ComputeSharpMasks(sdcOptions, level);
}

void RefineFVarLevel(LevelTopology const &pMesh, FVarLevel &pChannel, Sdc::Options sdcOptions,
                     bool fullTopology, FVarLevel &cChannel) {
    RefineTopology(pChannel.topology, sdcOptions, fullTopology, cChannel.topology);
    cChannel.linearInterpolation = pChannel.linearInterpolation;
    cChannel.numValues = cChannel.topology.numVertices;

    LevelTopology const &pValues = pChannel.topology;
    LevelTopology const &cValues = cChannel.topology;
    HexIndexing const indexing = pMesh.ChildIndexing();
    std::size_t const numBEdges = pMesh.halfFaces.size();
    cChannel.valueFaces.Resize(std::size_t(pMesh.numFaces) + pMesh.numEdges - numBEdges);
    cChannel.splitFaces.clear();

    auto addSplitFace = [&](Index cFace, Index first, Index second) {
        FVarLevel::SplitFace split = {cFace, {first, second}, {}};
        for (int half = 1; half >= 0; --half) {
            for (int i = 0; i < HexIndexing::kNumBoundaryEFaceCorners; ++i) {
                split.values[kHexagonHalves[half][i]] =
                    cValues.faceVerts[cValues.faceFirstCorner[split.valueFaces[half]] + i];
            }
        }
        cChannel.splitFaces.push_back(split);
    };

    for (Index pFace = 0; pFace < pMesh.numFaces; ++pFace) {
        cChannel.valueFaces[indexing.GetFaceChildFace(pFace)] =
            pValues.ChildIndexing().GetFaceChildFace(pChannel.valueFaces[pFace]);
    }
    for (FVarLevel::SplitFace const &split : pChannel.splitFaces) {
        addSplitFace(indexing.GetFaceChildFace(split.face),
                     pValues.ChildIndexing().GetFaceChildFace(split.valueFaces[0]),
                     pValues.ChildIndexing().GetFaceChildFace(split.valueFaces[1]));
    }
    for (Index pEdge = 0; pEdge < pMesh.numEdges; ++pEdge) {
        Index const cFace = pMesh.GetEdgeChildFace(pEdge);
        if (cFace == Far::INDEX_INVALID) {
            continue;
        }
        std::size_t const k = 2 * std::size_t(pEdge);
        Index const valueEdge = pChannel.GetFaceEdge(pMesh.edgeFaces[k], pMesh.edgeFaceLocals[k]);
        cChannel.valueFaces[cFace] = pValues.GetEdgeChildFace(valueEdge);
        if (!pMesh.IsBoundary(pEdge)) {
            Index const otherEdge =
                pChannel.GetFaceEdge(pMesh.edgeFaces[k + 1], pMesh.edgeFaceLocals[k + 1]);
            if (otherEdge != valueEdge) {
                addSplitFace(cFace, cChannel.valueFaces[cFace],
                             pValues.GetEdgeChildFace(otherEdge));
            }
        }
    }
}

} // namespace OpenSubdivHex::FarExt::internal

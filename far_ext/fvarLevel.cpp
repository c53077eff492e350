// SPDX-License-Identifier: Apache-2.0
#include "fvarLevel.h"

#include "baseLevel.h"
#include "sharpFeatures.h"
#include "vertexFan.h"

namespace OpenSubdivHex::FarExt::internal {

// Defined here, where the type of their channels is complete.
LevelTopology::LevelTopology() = default;
LevelTopology::~LevelTopology() = default;

namespace {

using Far::Index;

// The edges of the value mesh: an edge of the mesh whose sides differ in a value falls into two.
// meshEdges gets the mesh edge that each comes from.
std::vector<EdgeSides> cutSeams(LevelTopology const &mesh, std::vector<Index> const &faceValues,
                                std::vector<Index> &meshEdges) {
    std::vector<EdgeSides> result;
    std::vector<EdgeSides> secondSides;
    std::vector<Index> secondMeshEdges;
    for (Index edge = 0; edge < mesh.numEdges; ++edge) {
        EdgeSides sides = {{mesh.GetSideCorner(edge, 0), mesh.GetSideCorner(edge, 1)}};
        if (sides.corners[1] >= 0) {
            std::size_t const k = 2 * std::size_t(edge);
            Index const next0 = mesh.GetNextCorner(mesh.edgeFaces[k], sides.corners[0]);
            Index const next1 = mesh.GetNextCorner(mesh.edgeFaces[k + 1], sides.corners[1]);
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
        ForEachFan(level, vert, [&](VertexFan const &fan) {
            if (fan.begin == level.vertFirstFace[vert]) {
                return;
            }
            for (Index i = fan.begin; i < fan.end; ++i) {
                level.faceVerts[level.GetVertexCorner(i)] = Index(valuesOfVertices.size());
            }
            valuesOfVertices.push_back(vert);
        });
    }
    channel.valuesOfVertices.Resize(valuesOfVertices.size());
    std::copy(valuesOfVertices.begin(), valuesOfVertices.end(), channel.valuesOfVertices.data());
    if (Index(valuesOfVertices.size()) > channel.numValues) {
        level.numVertices = Index(valuesOfVertices.size());
        BuildBaseLevel({edges.data(), Index(edges.size())}, level);
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
    BuildBaseLevel({edges.data(), Index(edges.size())}, level);
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

namespace {

// A V-face has the F-vertices of corners that no other V-face has.  No seam crosses these faces.
void relateVFaces(LevelTopology const &pMesh, LevelTopology const &cMesh, FVarLevel const &pChannel,
                  FVarLevel &cChannel) {
    if (cMesh.numVFaces == 0) {
        return;
    }
    LevelTopology const &pValues = pChannel.topology;
    LevelTopology const &cValues = cChannel.topology;
    std::vector<Index> vFaceOfCorner(pValues.numCorners, Far::INDEX_INVALID);
    for (Index face = cValues.numFaces - cValues.numVFaces; face < cValues.numFaces; ++face) {
        Index const lastVert = cValues.faceVerts[cValues.faceFirstCorner[face + 1] - 1];
        vFaceOfCorner[pValues.GetChildVertexCorner(lastVert)] = face;
    }
    std::vector<Index> vFaceOfMeshCorner(pMesh.numCorners);
    for (Index face = 0; face < pMesh.numFaces; ++face) {
        Index const first = pMesh.faceFirstCorner[face];
        Index const size = pMesh.faceFirstCorner[face + 1] - first;
        for (Index i = 0; i < size && !pChannel.FindSplitFace(face); ++i) {
            vFaceOfMeshCorner[first + i] =
                vFaceOfCorner[pValues.faceFirstCorner[pChannel.valueFaces[face]] + i];
        }
    }
    for (Index face = cMesh.numFaces - cMesh.numVFaces; face < cMesh.numFaces; ++face) {
        Index const lastVert = cMesh.faceVerts[cMesh.faceFirstCorner[face + 1] - 1];
        cChannel.valueFaces[face] = vFaceOfMeshCorner[pMesh.GetChildVertexCorner(lastVert)];
    }
}

} // namespace

void RelateFVarLevels(LevelTopology const &pMesh, LevelTopology const &cMesh,
                      FVarLevel const &pChannel, FVarLevel &cChannel) {
    cChannel.linearInterpolation = pChannel.linearInterpolation;
    cChannel.numValues = cChannel.topology.numVertices;

    LevelTopology const &pValues = pChannel.topology;
    LevelTopology const &cValues = cChannel.topology;
    cChannel.valueFaces.Resize(cMesh.numFaces);
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
        cChannel.valueFaces[pMesh.faceChildFaces[pFace]] =
            pValues.faceChildFaces[pChannel.valueFaces[pFace]];
    }
    for (FVarLevel::SplitFace const &split : pChannel.splitFaces) {
        addSplitFace(pMesh.faceChildFaces[split.face], pValues.faceChildFaces[split.valueFaces[0]],
                     pValues.faceChildFaces[split.valueFaces[1]]);
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
    relateVFaces(pMesh, cMesh, pChannel, cChannel);
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "fvarLevel.h"

#include "baseLevel.h"
#include "hierarchy.h"
#include "indexSet.h"
#include "parallel.h"
#include "quadFeatures.h"
#include "sharpFeatures.h"
#include "vertexFan.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

// The edges of the value mesh: a seam falls into two, of which the second follow all edges.
Buffer<EdgeSides> cutSeams(Level const &mesh, std::vector<Index> const &seams) {
    Buffer<EdgeSides> result;
    result.Resize(std::size_t(mesh.numEdges) + seams.size());
    ParallelFor(mesh.numEdges, [&](Index edge) {
        result[edge] = {{mesh.GetSideCorner(edge, 0), mesh.GetSideCorner(edge, 1)}};
    });
    ParallelFor(Index(seams.size()), [&](Index i) {
        EdgeSides &sides = result[seams[i]];
        result[mesh.numEdges + i] = {{sides.corners[1], kSharpBoundaryA}};
        sides.corners[1] = kSharpBoundaryA;
    });
    return result;
}

// Builds the value mesh, and gives every fan of faces around a vertex a vertex of its own: the first
// keeps the index, others are appended.
void buildLevel(Buffer<EdgeSides> const &edges, Level &level, FVarChannel &channel) {
    auto const build = [&] { return BuildBaseLevel({edges.data(), Index(edges.size())}, level); };
    std::vector<Index> furtherValues; // of the vertices that are appended
    for (Index vert : build()) {
        ForEachFan(level, vert, [&](VertexFan const &fan) {
            if (fan.begin == level.vertFirstFace[vert]) {
                return;
            }
            for (Index i = fan.begin; i < fan.end; ++i) {
                level.faceVerts[level.GetVertexCorner(i)] =
                    channel.numValues + Index(furtherValues.size());
            }
            furtherValues.push_back(vert);
        });
    }
    Index const numVertices = channel.numValues + Index(furtherValues.size());
    channel.valuesOfVertices.Resize(numVertices);
    ParallelFor(numVertices, [&](Index vert) {
        channel.valuesOfVertices[vert] =
            vert < channel.numValues ? vert : furtherValues[vert - channel.numValues];
    });
    if (!furtherValues.empty()) {
        level.numVertices = numVertices;
        build();
    }
}

// A vertex of the value mesh that a face has several times is non-manifold, as in the mesh, where the
// face then has a vertex several times, too.
void findNonManifoldVertices(Level const &mesh, Level &level) {
    for (Index vert : mesh.nonManifoldVerts) {
        std::vector<IndexPair> pairs; // of a face and a vertex
        for (Index k = mesh.vertFirstFace[vert]; k < mesh.vertFirstFace[vert + 1]; ++k) {
            pairs.push_back({mesh.vertFaces[k], level.faceVerts[mesh.GetVertexCorner(k)]});
        }
        std::sort(pairs.begin(), pairs.end());
        for (std::size_t i = 1; i < pairs.size(); ++i) {
            if (pairs[i] == pairs[i - 1]) {
                level.nonManifoldVerts.push_back(pairs[i][1]);
            }
        }
    }
    SortUnique(level.nonManifoldVerts);
}

bool meetsFreeAndSharpBoundary(Level const &level, Index vert) {
    bool meetsFree = false;
    bool meetsSharp = false;
    for (Index edge : level.GetVertexEdges(vert)) {
        if (level.IsBoundary(edge)) {
            bool const isFree = level.edgeFaces[edge][1] == kFreeBoundary;
            (isFree ? meetsFree : meetsSharp) = true;
        }
    }
    return meetsFree && meetsSharp;
}

// Gives values the greatest sharpness that they have at a corner.
void findVertexSharpness(std::vector<float> const &sharpness, Level &level) {
    level.vertSharpness.Resize(level.numVertices);
    std::fill_n(level.vertSharpness.data(), level.numVertices,
                float(Sdc::Crease::SHARPNESS_SMOOTH));
    for (Index corner : ParallelSelect(level.numCorners, [values = sharpness.data()](Index corner) {
             return Sdc::Crease::IsSharp(values[corner]);
         })) {
        float &ofVertex = level.vertSharpness[level.faceVerts[corner]];
        ofVertex = std::max(ofVertex, sharpness[corner]);
    }
    // Where a seam meets a boundary that follows the paper's rule no curve goes on: a corner.
    if (level.numFreeBoundaries == 0) {
        return;
    }
    for (Index edge : level.boundaryEdges) {
        for (Index vert : level.edgeVerts[edge]) {
            if (meetsFreeAndSharpBoundary(level, vert)) {
                level.vertSharpness[vert] = Sdc::Crease::SHARPNESS_INFINITE;
            }
        }
    }
}

} // namespace

std::vector<Index> FindSeams(Level const &mesh, Index const *faceValues) {
    return ParallelSelect(mesh.numEdges, [&](Index edge) {
        Index const corner0 = mesh.GetSideCorner(edge, 0);
        Index const corner1 = mesh.GetSideCorner(edge, 1);
        return corner1 >= 0 &&
               (faceValues[corner0] !=
                    faceValues[mesh.GetNextCorner(mesh.edgeFaces[edge][1], corner1)] ||
                faceValues[corner1] !=
                    faceValues[mesh.GetNextCorner(mesh.edgeFaces[edge][0], corner0)]);
    });
}

void BuildFVarChannel(Level const &mesh, Index numValues, Buffer<Index> faceValues,
                      std::vector<Index> const &seams, std::vector<float> const &sharpness,
                      Sdc::Options sdcOptions, FVarChannel &channel) {
    Level &level = channel.values.levels.emplace_back();
    FVarLevel &fvarLevel = channel.levels.emplace_back();
    channel.numValues = numValues;
    channel.linearInterpolation = sdcOptions.GetFVarLinearInterpolation();
    fvarLevel.values = &level;
    fvarLevel.valueFaces.Resize(mesh.numFaces);
    ParallelFor(mesh.numFaces, [&](Index face) { fvarLevel.valueFaces[face] = face; });

    level.numVertices = numValues;
    level.numFaces = mesh.numFaces;
    level.numCorners = mesh.numCorners;
    level.faceFirstCorner.Assign(mesh.faceFirstCorner);
    level.faceVerts.Assign(faceValues);
    buildLevel(cutSeams(mesh, seams), level, channel);
    findNonManifoldVertices(mesh, level);

    // The tags of the mesh; a seam is sharp without one.
    if (!mesh.edgeSharpness.empty()) {
        level.edgeSharpness.Resize(level.numEdges);
        ParallelFor(level.numEdges, [&](Index edge) {
            Index const meshEdge = edge < mesh.numEdges ? edge : seams[edge - mesh.numEdges];
            level.edgeSharpness[edge] =
                level.IsBoundary(edge) ? 0 : mesh.GetEdgeSharpness(meshEdge);
        });
    }
    findVertexSharpness(sharpness, level);
    ComputeSharpMasks({sdcOptions, FaceMask::Average}, level); // with others level 0 has the same
    FindBaseLineCorners(level);
    channel.faceValues = std::move(faceValues);
}

namespace {

// A V-face has the F-vertices of corners that no other V-face has, but for the one before the V-vertex
// in a truncation.  No seam crosses these faces.
template <typename ADD_SPLIT_FACE>
void relateVFaces(Refinement const &mesh, Refinement const &values, FVarLevel const &pLevel,
                  FVarLevel &cLevel, ADD_SPLIT_FACE const &addSplitFace) {
    Level const &pMesh = *mesh.parent;
    Level const &cMesh = *mesh.child;
    Level const &pValues = *values.parent;
    Level const &cValues = *values.child;
    if (cMesh.numVFaces == 0) {
        return;
    }
    std::vector<Index> vFaceOfCorner(pValues.numCorners, Far::INDEX_INVALID);
    for (Index face = cValues.numFaces - cValues.numVFaces; face < cValues.numFaces; ++face) {
        // All of its F-vertices, since it may begin with another than the mesh's does; of a truncation those alone
        // whose corners are at the vertex.
        Far::ConstIndexArray const verts = cValues.GetFaceVertices(face);
        for (int i = 0; i < verts.size(); ++i) {
            bool const isNext =
                values.isTruncation && i + 1 < verts.size() && verts[i + 1] < cValues.numVVertices;
            // The vertex at the far end of a boundary has no corner.
            Index const corner = values.GetChildVertexCorner(verts[i]);
            if (0 <= corner && corner < pValues.numCorners && !isNext) {
                vFaceOfCorner[corner] = face;
            }
        }
    }
    std::vector<Index> vFaceOfMeshCorner(pMesh.numCorners);
    for (Index face = 0; face < pMesh.numFaces; ++face) {
        Index const first = pMesh.faceFirstCorner[face];
        for (Index i = 0; i < pMesh.GetFaceSize(face) && !pLevel.FindSplitFace(face); ++i) {
            vFaceOfMeshCorner[first + i] =
                vFaceOfCorner[pValues.faceFirstCorner[pLevel.valueFaces[face]] + i];
        }
    }
    for (Index face = cMesh.numFaces - cMesh.numVFaces; face < cMesh.numFaces; ++face) {
        cLevel.valueFaces[face] = vFaceOfMeshCorner[mesh.GetFaceParentCorner(face)];
    }
    for (CrossedFace const &crossed : cMesh.crossedFaces) {
        if (crossed.face < cMesh.numFaces - cMesh.numVFaces) {
            continue; // an F-face
        }
        Index const second = vFaceOfMeshCorner[mesh.GetFaceFirstParentCorner(crossed.face)];
        if (second != cLevel.valueFaces[crossed.face]) {
            addSplitFace(crossed.face, cLevel.valueFaces[crossed.face], second);
        }
    }
}

} // namespace

void RefineFVarLevel(Refinement const &mesh, Refinement const &values, FVarLevel const &pLevel,
                     FVarLevel &cLevel) {
    Level const &pMesh = *mesh.parent;
    Level const &cValues = *values.child;
    cLevel.values = &cValues;
    cLevel.valueFaces.Resize(mesh.child->numFaces);
    cLevel.splitFaces.clear();

    auto const addSplitFace = [&](Index cFace, Index first, Index second) {
        Far::ConstIndexArray const halves[] = {cValues.GetFaceVertices(first),
                                               cValues.GetFaceVertices(second)};
        int const end = halves[1].size() - 1;
        FVarLevel::SplitFace split = {cFace, {first, second}, end, {}};
        split.cornerValues.resize(std::size_t(halves[0].size() + halves[1].size() - 2));
        for (int half = 1; half >= 0; --half) {
            for (int i = 0; i < halves[half].size(); ++i) {
                split.cornerValues[std::size_t(GetPlaceInHalves(half, i, end))] = halves[half][i];
            }
        }
        cLevel.splitFaces.push_back(std::move(split));
    };

    // F-faces have the indices of their parents.
    std::copy(pLevel.valueFaces.begin(), pLevel.valueFaces.end(), cLevel.valueFaces.data());
    for (FVarLevel::SplitFace const &split : pLevel.splitFaces) {
        addSplitFace(split.face, split.valueFaces[0], split.valueFaces[1]);
    }
    for (Index pEdge = 0; pEdge < pMesh.numEdges; ++pEdge) {
        Index const cFace = mesh.GetEdgeChildFace(pEdge);
        if (cFace == Far::INDEX_INVALID) {
            continue;
        }
        auto const valueEdgeOf = [&](int side) {
            return pLevel.GetFaceEdge(pMesh.edgeFaces[pEdge][side],
                                      pMesh.edgeFaceLocals[pEdge][side]);
        };
        Index const valueEdge = valueEdgeOf(0);
        cLevel.valueFaces[cFace] = values.GetEdgeChildFace(valueEdge);
        if (!pMesh.IsBoundary(pEdge)) {
            if (Index const otherEdge = valueEdgeOf(1); otherEdge != valueEdge) {
                addSplitFace(cFace, cLevel.valueFaces[cFace], values.GetEdgeChildFace(otherEdge));
            }
        }
    }
    relateVFaces(mesh, values, pLevel, cLevel, addSplitFace);
}

} // namespace OpenSubdivHex::FarExt::internal

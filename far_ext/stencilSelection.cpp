// SPDX-License-Identifier: Apache-2.0
#include "stencilSelection.h"

#include "fvarLevel.h"
#include "indexSet.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::ConstIndexArray;
using Far::Index;

namespace {

void append(std::vector<Index> &indices, ConstIndexArray more) {
    indices.insert(indices.end(), more.begin(), more.end());
}

// Calls function(vFace) for the V-faces of a vertex of the parent, which are in the order of these.
template <typename FUNCTION>
void forEachVFace(TopologyLevel const &cLevel, Index pVert, FUNCTION function) {
    Index const end = cLevel.GetNumFaces();
    Index vFace = end - cLevel.GetTopology().numVFaces;
    for (Index count = end - vFace; count > 0;) {
        Index const half = count / 2;
        if (cLevel.GetFaceParentVertex(vFace + half) < pVert) {
            vFace += half + 1;
            count -= half + 1;
        } else {
            count = half;
        }
    }
    for (; vFace < end && cLevel.GetFaceParentVertex(vFace) == pVert; ++vFace) {
        function(vFace);
    }
}

// The faces of a level whose GetFaceParentFace() is one of pFaces.
std::vector<Index> findChildFaces(TopologyLevel const &pLevel, TopologyLevel const &cLevel,
                                  std::vector<Index> const &pFaces) {
    std::vector<Index> result;
    for (Index pFace : pFaces) {
        append(result, pLevel.GetFaceChildFaces(pFace));
        for (Index pEdge : pLevel.GetFaceEdges(pFace)) {
            Index const eFace = pLevel.GetEdgeChildFace(pEdge);
            if (eFace != Far::INDEX_INVALID && pLevel.GetEdgeFaces(pEdge)[0] == pFace) {
                result.push_back(eFace);
            }
        }
        for (Index pVert : pLevel.GetFaceVertices(pFace)) {
            forEachVFace(cLevel, pVert, [&](Index vFace) {
                if (cLevel.GetFaceParentFace(vFace) == pFace) {
                    result.push_back(vFace);
                }
            });
        }
    }
    SortUnique(result, cLevel.GetNumFaces());
    return result;
}

// The face of a corner.
Index faceOfCorner(LevelTopology const &level, Index corner) {
    Index const *const first = level.faceFirstCorner.begin();
    return Index(std::upper_bound(first, level.faceFirstCorner.end(), corner) - first) - 1;
}

// The part of the step that makes each level but the first.
std::vector<StencilStep::Part> findParts(StencilPlan const &plan,
                                         std::vector<std::vector<Index>> wanted) {
    std::vector<StencilStep::Part> parts(plan.lastLevel);
    for (std::size_t level = parts.size(); level > 0; --level) {
        TopologyLevel const pLevel = plan.GetLevel(int(level) - 1);
        LevelTopology const &pTopology = pLevel.GetTopology();
        RefinementMask const mask(pLevel, plan.refiner.GetHexSchemeOptions(), plan.interpolation);
        StencilStep::Part &part = parts[level - 1];
        std::vector<Index> &pVerts = wanted[level - 1];
        Index endOfFace = 0; // of the last corner, past its face
        for (Index cVert : wanted[level]) {
            if (cVert >= pTopology.numVVertices) {
                Index const corner = pTopology.GetChildVertexCorner(cVert);
                if (corner >= endOfFace) {
                    part.faces.push_back(faceOfCorner(pTopology, corner));
                    endOfFace = pTopology.faceFirstCorner[part.faces.back() + 1];
                }
                continue;
            }
            part.vVertices.push_back(cVert);
            Index const pVert = pTopology.GetVVertexParent(cVert);
            RefinementMask::VertexMask const weights = mask.GetVertexMask(pVert);
            pVerts.push_back(pVert);
            pVerts.insert(pVerts.end(), weights.neighbors,
                          weights.neighbors + weights.numNeighbors);
            if (weights.faceWeight > 0) {
                append(part.faces, pLevel.GetVertexFaces(pVert));
            }
        }
        SortUnique(part.faces, pTopology.numFaces);
        for (Index face : part.faces) {
            append(pVerts, pLevel.GetFaceVertices(face));
        }
        SortUnique(pVerts, pTopology.numVertices);
    }
    if (!parts.empty()) {
        parts[0].verts = wanted[0];
    }
    for (std::size_t i = 1; i < parts.size(); ++i) {
        parts[i].verts = FindMadeVertices(plan.GetLevel(int(i) - 1), parts[i - 1]);
    }
    return parts;
}

} // namespace

std::vector<std::vector<Index>> FindFacesOfBaseFaces(TopologyRefiner const &refiner,
                                                     ConstIndexArray baseFaces, int lastLevel) {
    std::vector<std::vector<Index>> result(1);
    append(result[0], baseFaces);
    SortUnique(result[0], refiner.GetLevel(0).GetNumFaces());
    for (int level = 1; level <= lastLevel; ++level) {
        result.push_back(
            findChildFaces(refiner.GetLevel(level - 1), refiner.GetLevel(level), result.back()));
    }
    return result;
}

std::vector<Index> FindVerticesOfFaces(TopologyLevel const &mesh, int channel,
                                       std::vector<Index> const &faces) {
    std::vector<Index> verts;
    for (Index face : faces) {
        if (channel < 0) {
            append(verts, mesh.GetFaceVertices(face));
        } else if (mesh.IsFaceFVarSplit(face, channel)) {
            append(verts, mesh.GetFaceFVarValues(face, channel, 0));
            append(verts, mesh.GetFaceFVarValues(face, channel, 1));
        } else {
            append(verts, mesh.GetFaceFVarValues(face, channel));
        }
    }
    SortUnique(verts, channel < 0 ? mesh.GetNumVertices() : mesh.GetNumFVarValues(channel));
    return verts;
}

StencilSelection::StencilSelection(StencilPlan const &plan, std::vector<std::vector<Index>> wanted)
    : parts(findParts(plan, std::move(wanted))) {
    if (!parts.empty()) {
        sources = plan.GetSources(0, parts[0].verts);
    }
    indices = sources;
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    for (Index &source : sources) {
        source = Index(std::lower_bound(indices.begin(), indices.end(), source) - indices.begin());
    }
}

std::vector<Index> FindMadeVertices(TopologyLevel const &pLevel, StencilStep::Part const &part) {
    LevelTopology const &topology = pLevel.GetTopology();
    std::vector<Index> verts = part.vVertices;
    for (Index face : part.faces) {
        for (int i = 0; i < pLevel.GetFaceVertices(face).size(); ++i) {
            verts.push_back(topology.GetCornerChildVertex(pLevel.GetFaceFirstCorner(face) + i));
        }
    }
    return verts;
}

} // namespace OpenSubdivHex::FarExt::internal

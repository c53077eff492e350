// SPDX-License-Identifier: Apache-2.0
#include "stencilSelection.h"

#include "far_ext/vtr/indexSet.h"

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
void forEachVFace(Refinement const &refinement, Index pVert, FUNCTION function) {
    Index const end = refinement.child->numFaces;
    Index vFace = end - refinement.child->numVFaces;
    for (Index count = end - vFace; count > 0;) {
        Index const half = count / 2;
        if (refinement.GetVFaceParent(vFace + half) < pVert) {
            vFace += half + 1;
            count -= half + 1;
        } else {
            count = half;
        }
    }
    for (; vFace < end && refinement.GetVFaceParent(vFace) == pVert; ++vFace) {
        function(vFace);
    }
}

// The faces of the child whose Refinement::GetFaceParentFace() is one of pFaces.
std::vector<Index> findChildFaces(Refinement const &refinement, std::vector<Index> const &pFaces) {
    Level const &parent = *refinement.parent;
    std::vector<Index> result = pFaces; // F-faces have the indices of their parents
    for (Index pFace : pFaces) {
        Index const end = parent.faceFirstCorner[pFace + 1];
        for (Index corner = parent.faceFirstCorner[pFace]; corner < end; ++corner) {
            Index const pEdge = parent.faceEdges[corner];
            Index const eFace = refinement.GetEdgeChildFace(pEdge);
            if (eFace != Far::INDEX_INVALID && parent.edgeFaces[pEdge][0] == pFace) {
                result.push_back(eFace);
            }
            forEachVFace(refinement, parent.faceVerts[corner], [&](Index vFace) {
                if (refinement.GetFaceParentFace(vFace) == pFace) {
                    result.push_back(vFace);
                }
            });
        }
    }
    SortUnique(result, refinement.child->numFaces);
    return result;
}

// The part of the refinement that makes each level but the first.
std::vector<RefinementRows::Part> findParts(StencilPlan const &plan,
                                            std::vector<std::vector<Index>> wanted) {
    std::vector<RefinementRows::Part> parts(plan.lastLevel);
    for (int level = plan.lastLevel; level > 0; --level) {
        RefinementRows::Part &part = parts[level - 1];
        part = FindPart(plan.GetRefinement(level), plan.schemeOptions, plan.interpolation,
                        wanted[level]);
        std::vector<Index> &pVerts = wanted[level - 1];
        pVerts.insert(pVerts.end(), part.verts.begin(), part.verts.end());
        SortUnique(pVerts, plan.GetLevel(level - 1).numVertices);
    }
    if (!parts.empty()) {
        parts[0].verts = wanted[0];
    }
    for (std::size_t i = 1; i < parts.size(); ++i) {
        parts[i].verts = GetMadeVertices(plan.GetRefinement(int(i)), parts[i - 1]);
    }
    return parts;
}

} // namespace

std::vector<std::vector<Index>> FindFacesOfBaseFaces(MeshLevels const &mesh,
                                                     ConstIndexArray baseFaces, int lastLevel) {
    std::vector<std::vector<Index>> result(1);
    append(result[0], baseFaces);
    SortUnique(result[0], mesh.levels[0].numFaces);
    for (int level = 1; level <= lastLevel; ++level) {
        result.push_back(findChildFaces(mesh.refinements[level - 1], result.back()));
    }
    return result;
}

std::vector<Index> FindVerticesOfFaces(Hierarchy const &hierarchy, int level, int channel,
                                       std::vector<Index> const &faces) {
    Level const &mesh = hierarchy.mesh.levels[level];
    std::vector<Index> verts;
    if (channel < 0) {
        for (Index face : faces) {
            append(verts, mesh.GetFaceVertices(face));
        }
        SortUnique(verts, mesh.numVertices);
        return verts;
    }
    FVarChannel const &values = hierarchy.channels[channel];
    FVarLevel const &fvarLevel = values.levels[level];
    for (Index face : faces) {
        if (level == 0) {
            append(verts,
                   {values.faceValues.data() + mesh.faceFirstCorner[face], mesh.GetFaceSize(face)});
        } else if (FVarLevel::SplitFace const *split = fvarLevel.FindSplitFace(face)) {
            append(verts, fvarLevel.values->GetFaceVertices(split->valueFaces[0]));
            append(verts, fvarLevel.values->GetFaceVertices(split->valueFaces[1]));
        } else {
            append(verts, fvarLevel.values->GetFaceVertices(fvarLevel.valueFaces[face]));
        }
    }
    SortUnique(verts, level == 0 ? values.numValues : fvarLevel.values->numVertices);
    return verts;
}

StencilSelection::StencilSelection(StencilPlan const &plan, std::vector<std::vector<Index>> wanted)
    : parts(findParts(plan, std::move(wanted))) {
    if (!parts.empty()) {
        sources = plan.GetSources(0, parts[0].verts);
    }
    indices = sources;
    SortUnique(indices);
    for (Index &source : sources) {
        source = Index(std::lower_bound(indices.begin(), indices.end(), source) - indices.begin());
    }
}

} // namespace OpenSubdivHex::FarExt::internal

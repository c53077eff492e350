// SPDX-License-Identifier: Apache-2.0
#include "stencilSelection.h"

#include "far_ext/vtr/indexSet.h"

#include <algorithm>
#include <numeric>

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

// Sorts the parts by their faces, and joins those of one face.
void sortUnique(std::vector<FacePart> &parts) {
    std::sort(parts.begin(), parts.end(),
              [](FacePart const &a, FacePart const &b) { return a.face < b.face; });
    std::size_t size = 0;
    for (FacePart const &part : parts) {
        if (size > 0 && parts[size - 1].face == part.face) {
            parts[size - 1].halves |= part.halves;
        } else {
            parts[size++] = part;
        }
    }
    parts.resize(size);
}

// The cells of the child whose Refinement::GetParentCell() is in one of the parts.
std::vector<FacePart> findChildFaces(Refinement const &refinement,
                                     std::vector<FacePart> const &pParts) {
    Level const &parent = *refinement.parent;
    std::vector<FacePart> result = pParts; // F-faces have the indices of their parents
    for (FacePart const &pPart : pParts) {
        Index const first = parent.faceFirstCorner[pPart.face];
        for (int local = 0; local < parent.GetFaceSize(pPart.face); ++local) {
            Index const pEdge = parent.faceEdges[first + local];
            Index const eFace = refinement.GetEdgeChildFace(pEdge);
            if (eFace != Far::INDEX_INVALID &&
                (pPart.halves >> parent.GetHalfOfFaceEdge(pPart.face, local) & 1u) != 0) {
                bool const isFirst = parent.edgeFaces[pEdge][0] == pPart.face &&
                                     parent.edgeFaceLocals[pEdge][0] == local;
                if (HasHalves(refinement.child->GetFaceSize(eFace))) {
                    result.push_back({eFace, isFirst ? 1u : 2u});
                } else if (isFirst) {
                    result.push_back({eFace, kAllHalves});
                }
            }
            forEachVFace(refinement, parent.faceVerts[first + local], [&](Index vFace) {
                bool const hasHalves = refinement.child->FindCrossedFace(vFace);
                for (int half = 0; half < (hasHalves ? 2 : 1); ++half) {
                    Cell const pCell = refinement.GetParentCell({vFace, half});
                    if (pCell.face == pPart.face && (pPart.halves >> pCell.half & 1u) != 0) {
                        result.push_back({vFace, hasHalves ? 1u << half : kAllHalves});
                    }
                }
            });
        }
    }
    sortUnique(result);
    return result;
}

// Appends the vertices of a face, all or those of one half.
void appendPart(std::vector<Index> &indices, ConstIndexArray vertices, int diagonalEnd,
                unsigned halves) {
    if (halves == kAllHalves) {
        append(indices, vertices);
        return;
    }
    int const half = int(halves >> 1);
    for (int i = 0; i < GetHalfSize(half, vertices.size(), diagonalEnd); ++i) {
        indices.push_back(vertices[GetPlaceInHalves(half, i, diagonalEnd)]);
    }
}

// The part of the refinement that makes each level, behind a level that is taken whole.
std::vector<RefinementRows::Part> findParts(StencilPlan const &plan,
                                            std::vector<std::vector<Index>> wanted, bool hasWholes,
                                            int &wholeLevel) {
    auto const isWhole = [&](int level) {
        Index const numVertices = plan.GetLevel(level).numVertices;
        return hasWholes && (level == 0 || Index(wanted[level].size()) > numVertices / 2);
    };
    std::vector<RefinementRows::Part> parts(plan.lastLevel);
    int level = plan.lastLevel;
    for (; level > 0 && !isWhole(level); --level) {
        RefinementRows::Part &part = parts[level - 1];
        part = FindPart(plan.GetRefinement(level), plan.hexSchemeOptions, plan.interpolation,
                        wanted[level]);
        std::vector<Index> &pVerts = wanted[level - 1];
        pVerts.insert(pVerts.end(), part.verts.begin(), part.verts.end());
        SortUnique(pVerts, plan.GetLevel(level - 1).numVertices);
    }
    wholeLevel = hasWholes ? level : -1;
    if (level == plan.lastLevel) {
        return parts;
    }
    std::vector<Index> &first = parts[level].verts;
    if (hasWholes) {
        first.resize(plan.GetLevel(level).numVertices);
        std::iota(first.begin(), first.end(), 0);
    } else {
        first = wanted[0];
    }
    for (std::size_t i = std::size_t(level) + 1; i < parts.size(); ++i) {
        parts[i].verts = GetMadeVertices(plan.GetRefinement(int(i)), parts[i - 1]);
    }
    return parts;
}

} // namespace

std::vector<std::vector<FacePart>> FindFacesOfBaseFaces(MeshLevels const &mesh,
                                                        ConstIndexArray baseFaces, int lastLevel) {
    std::vector<std::vector<FacePart>> result(1);
    for (Index face : baseFaces) {
        result[0].push_back({face, kAllHalves});
    }
    sortUnique(result[0]);
    for (int level = 1; level <= lastLevel; ++level) {
        result.push_back(findChildFaces(mesh.refinements[level - 1], result.back()));
    }
    return result;
}

std::vector<Index> FindVerticesOfFaces(Hierarchy const &hierarchy, int level, int channel,
                                       std::vector<FacePart> const &parts) {
    Level const &mesh = hierarchy.mesh.levels[level];
    std::vector<Index> verts;
    if (channel < 0) {
        for (FacePart const &part : parts) {
            appendPart(verts, mesh.GetFaceVertices(part.face), mesh.GetDiagonalEnd(part.face),
                       part.halves);
        }
        SortUnique(verts, mesh.numVertices);
        return verts;
    }
    FVarChannel const &values = hierarchy.channels[channel];
    FVarLevel const &fvarLevel = values.levels[level];
    for (FacePart const &part : parts) {
        if (level == 0) {
            append(verts, {values.faceValues.data() + mesh.faceFirstCorner[part.face],
                           mesh.GetFaceSize(part.face)});
        } else if (FVarLevel::SplitFace const *split = fvarLevel.FindSplitFace(part.face)) {
            for (int half = 0; half < 2; ++half) {
                if ((part.halves >> half & 1u) != 0) {
                    append(verts, fvarLevel.values->GetFaceVertices(split->valueFaces[half]));
                }
            }
        } else {
            appendPart(verts, fvarLevel.values->GetFaceVertices(fvarLevel.valueFaces[part.face]),
                       mesh.GetDiagonalEnd(part.face), part.halves);
        }
    }
    SortUnique(verts, level == 0 ? values.numValues : fvarLevel.values->numVertices);
    return verts;
}

std::vector<std::vector<Index>> FindVerticesOfBaseFaces(StencilPlan const &plan,
                                                        Far::ConstIndexArray baseFaces) {
    auto const faces = FindFacesOfBaseFaces(plan.hierarchy.mesh, baseFaces, plan.lastLevel);
    std::vector<std::vector<Index>> verts(faces.size());
    for (int level = plan.firstStored; level <= plan.lastLevel; ++level) {
        verts[level] = FindVerticesOfFaces(plan.hierarchy, level, plan.channel, faces[level]);
    }
    return verts;
}

StencilSelection::StencilSelection(StencilPlan const &plan, std::vector<std::vector<Index>> wanted,
                                   bool hasWholes)
    : parts(findParts(plan, std::move(wanted), hasWholes, wholeLevel)) {
    if (hasWholes) {
        sources = plan.GetSources(0);
    } else if (!parts.empty()) {
        sources = plan.GetSources(0, parts[0].verts);
    }
    indices = sources;
    SortUnique(indices);
    for (Index &source : sources) {
        source = Index(std::lower_bound(indices.begin(), indices.end(), source) - indices.begin());
    }
}

} // namespace OpenSubdivHex::FarExt::internal

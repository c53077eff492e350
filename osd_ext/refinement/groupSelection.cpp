// SPDX-License-Identifier: Apache-2.0
#include "groupSelection.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::Level;
using FarExt::internal::Refinement;

namespace {

using Marks = std::vector<unsigned char>;

bool isMarked(Marks const &marks, Index i) { return marks[std::size_t(i)] != 0; }

// Calls select(item, add) for the items of each group: it adds those that the group keeps.
template <class ITEM, typename SELECT>
Groups<ITEM> selectItems(Groups<ITEM> const &groups, SELECT select) {
    std::vector<ITEM> kept;
    Groups<ITEM> result;
    for (int group = 0; group < groups.GetNumGroups(); ++group) {
        for (ITEM const *item = groups.Begin(group); item != groups.End(group); ++item) {
            select(*item, [&](ITEM const &part) { kept.push_back(part); });
        }
        result.firsts.push_back(kept.size());
    }
    result.items.Resize(kept.size());
    std::copy(kept.begin(), kept.end(), result.items.data());
    return result;
}

// Calls add(begin, end) for the parts of a run that are needed; short gaps take less time than a
// further part does.
template <class RUN, typename IS_NEEDED, typename ADD>
void forEachPart(RUN const &run, IS_NEEDED isNeeded, ADD add) {
    constexpr Index kMaxGap = 4;
    for (Index begin = run.begin; begin < run.end;) {
        if (!isNeeded(begin)) {
            ++begin;
            continue;
        }
        Index end = begin + 1;
        for (Index next = end; next < run.end && next <= end + kMaxGap; ++next) {
            if (isNeeded(next)) {
                end = next + 1;
            }
        }
        add(begin, end);
        begin = end;
    }
}

// Selects runs of faces of a level whose F-vertices make V-vertices, and marks all of these: those
// in gaps are made with the others.
Groups<IndexRun> selectFacesOfVertices(Groups<IndexRun> const &groups, Level const *level,
                                       Marks &isNeeded) {
    return selectItems(groups, [&](IndexRun const &run, auto add) {
        auto const getFirst = [&](Index face) {
            return isNeeded.begin() + level->ChildIndexing().GetCornerChildVertex(
                                          level->faceFirstCorner[std::size_t(face)]);
        };
        auto const isFaceNeeded = [&](Index face) {
            return std::find(getFirst(face), getFirst(face + 1), 1) != getFirst(face + 1);
        };
        forEachPart(run, isFaceNeeded, [&](Index begin, Index end) {
            std::fill(getFirst(begin), getFirst(end), 1);
            add(IndexRun{begin, end});
        });
    });
}

void selectVertices(PreparedRefinement const &prepared, Marks &isNeeded, RefinementGroups &result) {
    result.listedVertices =
        selectItems(prepared.listedVertices, [&](ListedVertex const &vertex, auto add) {
            if (isMarked(isNeeded, vertex.child)) {
                add(vertex);
            }
        });
    result.newVertexFaces =
        selectFacesOfVertices(prepared.newVertexFaces, prepared.before, isNeeded);
    result.olderVertexFaces =
        selectFacesOfVertices(prepared.olderVertexFaces, prepared.beforeThat, isNeeded);
    Level const &parent = *prepared.parent;
    result.vertexRuns = selectItems(prepared.vertexRuns, [&](VertexRun const &run, auto add) {
        auto const isVertexNeeded = [&](Index vert) { return isMarked(isNeeded, vert); };
        forEachPart(run, isVertexNeeded, [&](Index begin, Index end) {
            std::fill(isNeeded.begin() + begin, isNeeded.begin() + end, 1);
            Index const numBefore = parent.vertFirstFace[begin] - parent.vertFirstFace[run.begin];
            add(VertexRun{begin, end, run.firstCorner + std::size_t(numBefore)});
        });
    });
    result.weightedVertices =
        selectItems(prepared.weightedVertices, [&](WeightedVertex const &vertex, auto add) {
            if (isMarked(isNeeded, vertex.child)) {
                add(vertex);
            }
        });
}

// Those with an F-vertex that is needed, be it for a V-vertex.
Marks findNeededFaces(PreparedRefinement const &prepared, Refinement const &refinement,
                      Marks const &isNeeded) {
    Level const &parent = *prepared.parent;
    Marks isFaceNeeded(std::size_t(parent.numFaces), 0);
    FarExt::internal::ParallelFor(parent.numFaces, [&](Index face) {
        Far::ConstIndexArray const verts = parent.GetFaceVertices(face);
        bool isAny = false;
        for (int i = 0; i < verts.size(); ++i) {
            Index const child = refinement.GetVertexChildVertex(verts[i]);
            Index const corner = parent.faceFirstCorner[face] + i;
            isAny = isAny || isMarked(isNeeded, refinement.GetCornerChildVertex(corner)) ||
                    (child >= 0 && child < prepared.numVVertices && isMarked(isNeeded, child));
        }
        isFaceNeeded[std::size_t(face)] = static_cast<unsigned char>(isAny);
    });
    return isFaceNeeded;
}

void selectFaces(PreparedRefinement const &prepared, Marks const &isNeeded,
                 RefinementGroups &result) {
    result.faceRuns = selectItems(prepared.faceRuns, [&](IndexRun const &run, auto add) {
        auto const isFaceNeeded = [&](Index face) { return isMarked(isNeeded, face); };
        forEachPart(run, isFaceNeeded, [&](Index begin, Index end) { add(IndexRun{begin, end}); });
    });
    result.weightedFaces =
        selectItems(prepared.weightedFaces, [&](WeightedFace const &face, auto add) {
            if (isMarked(isNeeded, prepared.parent->FindFaceOfCorner(face.corner))) {
                add(face);
            }
        });
}

} // namespace

std::optional<RefinementGroups> SelectGroups(PreparedRefinement const &prepared,
                                             Refinement const &refinement,
                                             std::vector<unsigned char> isNeeded) {
    RefinementGroups result;
    selectVertices(prepared, isNeeded, result);
    if (refinement.isTruncation) {
        return result;
    }
    Marks const isFaceNeeded = findNeededFaces(prepared, refinement, isNeeded);
    constexpr double kMostFaces = 0.75;
    if (double(std::count(isFaceNeeded.begin(), isFaceNeeded.end(), 1)) >
        kMostFaces * double(isFaceNeeded.size())) {
        return {};
    }
    selectFaces(prepared, isFaceNeeded, result);
    return result;
}

} // namespace OpenSubdivHex::OsdExt::internal

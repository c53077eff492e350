// SPDX-License-Identifier: Apache-2.0
#include "hexRefinement.h"

#include "hexLevelWriter.h"
#include "indexSet.h"

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;

void placeRelations(Level &child) {
    PlaceArrays(child.memory, [&](auto place) { Level::ForEachRelation(child, place); });
    if (child.hasFullTopology && child.HasImpliedVertexEdges()) {
        child.vertFirstEdge.Place(child.vertFirstFace.data(), child.vertFirstFace.size());
    }
}

// B edges make no E-face, so that those behind them come earlier.
void fillEdgeChildFaces(Refinement &refinement) {
    Level const &parent = *refinement.parent;
    Buffer<Index> &eFaces = refinement.edgeChildFaces;
    eFaces.Resize(parent.halfFaces.empty() ? 0 : parent.numEdges);
    if (eFaces.empty()) {
        return;
    }
    HexIndexing const indexing = parent.ChildIndexing();
    // By the number of boundary edges before.
    std::vector<Index> numBBefore = {0};
    numBBefore.reserve(parent.boundaryEdges.size() + 1);
    for (Index pEdge : parent.boundaryEdges) {
        numBBefore.push_back(numBBefore.back() + Index(parent.IsSharpBoundaryB(pEdge)));
    }
    ParallelForRange(parent.numEdges, [&](Index begin, Index end) {
        auto const fillRun = [&](Index runBegin, Index runEnd, Index numBoundaryBefore) {
            for (Index pEdge = runBegin; pEdge < runEnd; ++pEdge) {
                eFaces[pEdge] = indexing.GetEdgeChildFace(pEdge, numBBefore[numBoundaryBefore]);
            }
        };
        ForEachRun(begin, end, parent.boundaryEdges, fillRun,
                   [&](Index pEdge, Index numBoundaryBefore) {
                       if (parent.IsSharpBoundaryB(pEdge)) {
                           eFaces[pEdge] = Far::INDEX_INVALID;
                       } else {
                           fillRun(pEdge, pEdge + 1, numBoundaryBefore);
                       }
                   });
    });
}

} // namespace

void RefineHexagonally(Level const &parent, TagOptions tagOptions, bool fullTopology,
                       Refinement &refinement, Level &child) {
    BeginRefinement(parent, GetHexagonalSizes(GetSizes(parent)), fullTopology, refinement, child);
    child.isHexagonal = true;
    child.numHexagonalSteps = parent.numHexagonalSteps + 1;
    child.hasFirstLineMasks = parent.hasFirstLineMasks;
    child.numVVertices = parent.numVertices;
    child.numVertsOfAnyValence = parent.numVertsOfAnyValence;
    child.numVFaces = 0;
    child.faceSizes = parent.faceSizes;
    child.faceSizes.insert(child.faceSizes.end(),
                           {HexIndexing::kNumBoundaryEFaceCorners, HexIndexing::kNumEFaceCorners});
    SortUnique(child.faceSizes);
    refinement.vertChildVerts.Resize(0);
    refinement.vVertexParents.Resize(0);
    fillEdgeChildFaces(refinement);
    placeRelations(child);
    HexLevelWriter(refinement, child).Write();
    EndRefinement(tagOptions, refinement, child);
}

} // namespace OpenSubdivHex::FarExt::internal

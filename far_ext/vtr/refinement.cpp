// SPDX-License-Identifier: Apache-2.0
#include "refinement.h"

#include "irregularFeatures.h"
#include "lineFeatures.h"
#include "quadFeatures.h"
#include "sharpFeatures.h"

namespace OpenSubdivHex::FarExt::internal {

void BeginRefinement(Level const &parent, LevelSizes const &sizes, bool fullTopology,
                     Refinement &refinement, Level &child) {
    using Index = Far::Index;
    refinement.parent = &parent;
    refinement.child = &child;
    refinement.isTruncation = false;
    child.depth = parent.depth + 1;
    child.numVertices = Index(sizes.vertices);
    child.numEdges = Index(sizes.edges);
    child.numFaces = Index(sizes.faces);
    child.numCorners = Index(sizes.corners);
    child.numFreeBoundaries = Index(sizes.freeBoundaries);
    child.numSharpBoundariesA = Index(sizes.sharpBoundariesA);
    child.numSharpBoundariesB = Index(sizes.sharpBoundariesB);
    child.numFFaces = parent.numFaces;
    child.numFFaceCorners = parent.numCorners;
    child.hasFirstLineMasks = false;
    child.partedVerts.clear();
    child.crossedFaces = parent.crossedFaces; // F-faces have the indices of their parents
    child.hasFullTopology = fullTopology;
    for (auto &rules : child.rules) {
        rules.Clear();
    }
    child.vertexMarks.Clear();
}

void EndRefinement(TagOptions options, Refinement const &refinement, Level &child) {
    RefineTags(refinement, options.sdcOptions, child);
    if (child.hasFullTopology) {
        ComputeSharpMasks(options, child);
    } else {
        child.sharpVerts.clear();
        child.sectorCorners.clear();
    }
    FindQuadCorners(options.faceMask, refinement, child);
    FindIrregularFeatures(options.faceMask, refinement, child);
    FindLineRowCorners(options, refinement, child);
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "baseFaceMap.h"

#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"

#include <numeric>

namespace OpenSubdivHex::FarExt {

BaseFaceMap::BaseFaceMap(TopologyRefiner const &refiner, int maxLevel)
    : BaseFaceMap(refiner.GetLevel(maxLevel)) {}

BaseFaceMap::BaseFaceMap(TopologyLevel const &level) {
    internal::MeshLevels const &mesh = level.GetHierarchy().mesh;
    internal::ResizeLarge(_baseFaces, std::size_t(level.GetNumFaces()));
    Index const numBaseFaces = mesh.levels[0].numFaces;
    std::iota(_baseFaces.begin(), _baseFaces.begin() + numBaseFaces, 0);
    for (int depth = 1; depth <= level.GetDepth(); ++depth) {
        addLevel(mesh.refinements[std::size_t(depth) - 1]);
    }
}

// The entries of F-faces are there: they are those of their parents.
void BaseFaceMap::addLevel(internal::Refinement const &refinement) {
    internal::Level const &parent = *refinement.parent;
    internal::Level const &child = *refinement.child;
    std::vector<std::vector<SplitFace>> splitFaces(
        std::size_t(internal::GetNumParallelRanges(parent.numEdges)));
    internal::ParallelForRange(parent.numEdges, [&](Index begin, Index end) {
        std::vector<SplitFace> &ofRange = splitFaces[std::size_t(begin / internal::kParallelRange)];
        for (Index edge = begin; edge < end; ++edge) {
            Index const cFace = refinement.GetEdgeChildFace(edge);
            if (cFace == Far::INDEX_INVALID) {
                continue;
            }
            auto const getBaseFace = [&](int side) {
                Index const face = parent.edgeFaces[edge][side];
                return GetBaseFace(
                    face, parent.GetHalfOfFaceEdge(face, parent.edgeFaceLocals[edge][side]));
            };
            _baseFaces[cFace] = getBaseFace(0);
            if (HasHalves(child.GetFaceSize(cFace))) {
                if (Index const second = getBaseFace(1); second != _baseFaces[cFace]) {
                    ofRange.push_back({cFace, {_baseFaces[cFace], second}});
                }
            }
        }
    });
    for (std::vector<SplitFace> const &ofRange : splitFaces) {
        for (SplitFace const &split : ofRange) {
            _baseFaces[split.face] = ~Index(_splitFaces.size());
            _splitFaces.push_back(split);
        }
    }
    for (Index cFace = child.numFaces - child.numVFaces; cFace < child.numFaces; ++cFace) {
        auto const getBaseFace = [&](int half) {
            internal::Cell const cell = refinement.GetParentCell({cFace, half});
            return GetBaseFace(cell.face, cell.half);
        };
        _baseFaces[cFace] = getBaseFace(0);
        if (Index const second = getBaseFace(1); second != _baseFaces[cFace]) {
            _splitFaces.push_back({cFace, {_baseFaces[cFace], second}});
            _baseFaces[cFace] = ~Index(_splitFaces.size() - 1);
        }
    }
}

} // namespace OpenSubdivHex::FarExt

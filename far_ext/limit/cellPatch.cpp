// SPDX-License-Identifier: Apache-2.0
#include "cellPatch.h"

#include "far_ext/executor.h"
#include "far_ext/vtr/hexRefinement.h"

#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

constexpr int kBoundaryCorners[kNumHalfCellCorners] = {0, 1, 2, 3};

void gather(LimitPatchGatherer &gatherer, Level const &level, Index face, CellPatch &cell) {
    int const first =
        gatherer.GatherCell(face, cell.locals.data(), cell.GetNumCorners(), cell.patch);
    int const size = level.GetFaceSize(face);
    for (int &local : cell.locals) {
        local = (local + size - first) % size;
    }
    cell.corners.clear();
    for (int const local : cell.locals) {
        cell.corners.push_back(cell.patch.faceVerts[std::size_t(local)]);
    }
}

// Makes a half cell of a child level, of a hexagon or a half face.
void gatherHalf(LimitPatchGatherer &gatherer, Level const &level, Index face, int half,
                CellPatch &cell) {
    int const(&locals)[kNumHalfCellCorners] =
        HasHalves(level.GetFaceSize(face)) ? kHexagonHalves[half] : kBoundaryCorners;
    cell.isWhole = false;
    cell.locals.assign(std::begin(locals), std::end(locals));
    gather(gatherer, level, face, cell);
}

// The side of vertex 0 of a level's vertex that a half of a face lies on.
int findSide(Level const &level, Index vert, Index face, int half) {
    std::vector<VertexSide> const sides = FindVertexSides(level, vert);
    for (std::size_t side = 0; side < sides.size(); ++side) {
        for (RingItem const &item : sides[side].items) {
            if (item.isFace && item.face == face && (item.half < 0 || item.half == half)) {
                return int(side);
            }
        }
    }
    return 0;
}

} // namespace

void GatherBaseCell(Level const &level, Index face, CellPatch &cell) {
    cell.isWhole = true;
    cell.locals.resize(std::size_t(level.GetFaceSize(face)));
    std::iota(cell.locals.begin(), cell.locals.end(), 0);
    LimitPatchGatherer gatherer(level);
    gather(gatherer, level, face, cell);
}

std::vector<CellChild> RefineCell(CellPatch const &cell, Sdc::Options sdcOptions,
                                  HexSchemeOptions const &schemeOptions,
                                  Interpolation interpolation) {
    ExecutorScope const alone(nullptr, 1); // patches are small
    Level parent;
    Level child;
    Refinement refinement;
    BuildPatchLevel(cell.patch, parent);
    RefineHexagonally(parent, sdcOptions, true, refinement, child);
    LimitPatchGatherer gatherer(child);

    int const numCorners = cell.GetNumCorners();
    int const firstEdge =
        cell.isWhole ? 0 : 1; // the long edge of a half cell makes none of its own
    std::vector<CellChild> children(std::size_t(numCorners - firstEdge + 1));
    if (cell.isWhole) {
        children[0].cell.locals = cell.locals;
        gather(gatherer, child, 0, children[0].cell);
    } else {
        gatherHalf(gatherer, child, 0, cell.GetHalf(), children[0].cell);
    }
    for (int i = firstEdge; i < numCorners; ++i) {
        int const local = cell.locals[std::size_t(i)];
        Index const edge = parent.faceEdges[local];
        bool const isFirst =
            parent.edgeFaces[edge][0] == 0 && parent.edgeFaceLocals[edge][0] == local;
        gatherHalf(gatherer, child, refinement.GetEdgeChildFace(edge), isFirst ? 0 : 1,
                   children[std::size_t(i - firstEdge + 1)].cell);
    }
    for (CellChild &result : children) {
        result.step =
            MakePatchStep(refinement, schemeOptions, interpolation, result.cell.patch.sources);
    }
    return children;
}

std::vector<CornerLimit> FindCornerLimits(CellPatch const &cell, LimitMaskFinder &finder) {
    ExecutorScope const alone(nullptr, 1);
    Level level;
    BuildPatchLevel(cell.patch, level);
    LimitPatchGatherer gatherer(level);
    LimitPatch patch;
    std::vector<CornerLimit> limits;
    for (Index const vert : cell.corners) {
        gatherer.Gather(vert, patch);
        LimitMaskFinder::MaskPointer const mask = finder.Find(patch);
        if (!mask) {
            return {};
        }
        int const half = cell.isWhole ? 0 : cell.GetHalf();
        int const side = patch.sides[std::size_t(findSide(level, vert, 0, half))];
        LimitMask::Tangents const &tangents = mask->sides[std::size_t(side)];
        auto const spread = [&](std::vector<double> const &weights) {
            std::vector<double> result(std::size_t(level.numVertices));
            for (std::size_t i = 0; i < weights.size(); ++i) {
                result[std::size_t(patch.sources[i])] += weights[i];
            }
            return result;
        };
        limits.push_back({spread(mask->weights), {spread(tangents.du), spread(tangents.dv)}});
    }
    return limits;
}

} // namespace OpenSubdivHex::FarExt::internal

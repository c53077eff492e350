// SPDX-License-Identifier: Apache-2.0
#include "cellPatch.h"

#include "far_ext/executor.h"
#include "far_ext/vtr/hexRefinement.h"

#include <cassert>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

// Level 0 has no irregular corners yet, whatever the mask.
constexpr FaceMask kMaskOfBase = FaceMask::Average;

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
    cell.kind = CellKind::Half;
    cell.locals.assign(std::begin(locals), std::end(locals));
    gather(gatherer, level, face, cell);
}

// Whether edge number local of a face runs as the face does.
bool isFirstSide(Level const &level, Index face, int local) {
    Index const edge = level.faceEdges[level.faceFirstCorner[face] + local];
    return level.edgeFaces[edge][0] == face && level.edgeFaceLocals[edge][0] == local;
}

// Makes an edge of a level that runs along one of level 0, from the start of one of its sides.
void gatherEdge(LimitPatchGatherer &gatherer, Level const &level, Index edge, int side,
                CellPatch &cell) {
    Index const face = level.edgeFaces[edge][side];
    int const local = level.edgeFaceLocals[edge][side];
    cell.locals = {local, (local + 1) % level.GetFaceSize(face)};
    gather(gatherer, level, face, cell);
}

// The side of a vertex of a patch that half 0 of face 0 lies on.
int findSide(Level const &level, Index vert) {
    std::vector<VertexSide> const sides = FindVertexSides(level, vert);
    for (std::size_t side = 0; side < sides.size(); ++side) {
        for (FanItem const &item : sides[side].items) {
            if (item.isFace && item.face == 0 && item.half <= 0) {
                return int(side);
            }
        }
    }
    return 0;
}

} // namespace

void GatherBaseCell(SurfaceFaces const &faces, Index face, Sdc::Options sdcOptions,
                    CellPatch &cell) {
    FaceShape const shape = faces.GetShape(face);
    cell.kind = shape.isHalf ? CellKind::HalfPolygon : CellKind::Whole;
    cell.locals.clear();
    for (int i = 0; i < shape.size; ++i) {
        cell.locals.push_back(faces.GetPlace(face, i));
    }
    LimitPatchGatherer gatherer(faces.GetLevel(), sdcOptions, kMaskOfBase);
    gather(gatherer, faces.GetLevel(), faces.GetLevelFace(face).face, cell);
}

void FinishPlainBaseCell(int numPoints, CellPatch &cell) {
    LimitPatch &patch = cell.patch;
    cell.locals.resize(std::size_t(patch.faceSizes[0]));
    std::iota(cell.locals.begin(), cell.locals.end(), 0);
    cell.corners.assign(patch.faceVerts.begin(), patch.faceVerts.begin() + patch.faceSizes[0]);
    patch.sources.resize(std::size_t(numPoints));
    std::iota(patch.sources.begin(), patch.sources.end(), 0);
    patch.edgeSharpness.resize(patch.faceVerts.size());
    patch.diagonalSharpness.resize(patch.faceSizes.size());
    patch.vertSharpness.resize(std::size_t(numPoints));
}

void FindBaseCellTurns(SurfaceFaces const &faces, Index face, int *turns) {
    Level const &level = faces.GetLevel();
    Index const first = level.faceFirstCorner[faces.GetLevelFace(face).face];
    int const size = faces.GetShape(face).size;
    for (int i = 0; i < size; ++i) {
        turns[i] = faces.GetEdge(face, i).isReversed ? 1 : 0;
        turns[size + i] = 0;
        Index const corner = first + faces.GetPlace(face, i);
        ForEachFan(level, level.faceVerts[corner], [&](VertexFan const &fan) {
            for (Index k = fan.begin; k < fan.end; ++k) {
                if (level.GetVertexCorner(k) == corner) {
                    turns[size + i] = int(k - fan.begin);
                }
            }
        });
    }
}

std::vector<CellPatch> GatherBorder(CellPatch const &baseCell, int const *turns,
                                    Sdc::Options sdcOptions, int onlyItem) {
    ExecutorScope const alone(nullptr, 1);
    Level level;
    BuildPatchLevel(baseCell.patch, level);
    LimitPatchGatherer gatherer(level, sdcOptions, kMaskOfBase);
    int const size = baseCell.GetNumCorners();
    std::vector<CellPatch> border;
    auto const isWanted = [&](int item) { return onlyItem < 0 || item == onlyItem; };
    for (int i = 0; i < size; ++i) {
        bool const isLong = i == 0 && baseCell.kind == CellKind::HalfPolygon;
        border.push_back({isLong ? CellKind::LongEdge : CellKind::Edge, {}, {}, {}});
        if (!isWanted(i)) {
            continue;
        }
        int const local = baseCell.locals[std::size_t(i)];
        if (isLong && !level.IsHalfFace(0)) {
            // A diagonal, from its start on.
            border.back().locals = {local, baseCell.locals[1]};
            if (turns[i] == 1) {
                std::swap(border.back().locals[0], border.back().locals[1]);
            }
            gather(gatherer, level, 0, border.back());
            continue;
        }
        int const side = isFirstSide(level, 0, local) == (turns[i] == 1) ? 1 : 0;
        gatherEdge(gatherer, level, level.faceEdges[local], side, border.back());
    }
    for (int i = 0; i < size; ++i) {
        border.push_back({CellKind::Vertex, {}, {}, {}});
        if (!isWanted(size + i)) {
            continue;
        }
        int const local = baseCell.locals[std::size_t(i)];
        ForEachFan(level, level.faceVerts[local], [&](VertexFan const &fan) {
            int const numFaces = int(fan.end - fan.begin);
            for (int k = 0; k < numFaces; ++k) {
                if (level.GetVertexCorner(fan.begin + k) == local) {
                    int const turn = turns[size + i];
                    Index const place = fan.begin + (k + numFaces - turn) % numFaces;
                    border.back().locals = {level.vertFaceLocals[place]};
                    gather(gatherer, level, level.vertFaces[place], border.back());
                }
            }
        });
    }
    return border;
}

namespace {

// A patch as a level, and what a step makes of it.
struct RefinedPatch {
    RefinedPatch(LimitPatch const &patch, Sdc::Options sdcOptions, FaceMask faceMask) {
        BuildPatchLevel(patch, parent);
        RefineHexagonally(parent, {sdcOptions, faceMask}, true, refinement, child);
    }

    Level parent;
    Level child;
    Refinement refinement;
};

// The children of a parent's cell, without the step.
class CellRefiner {
public:
    CellRefiner(Refinement const &refinement, Sdc::Options sdcOptions, FaceMask faceMask,
                CellPatch const &cell)
        : _refinement(refinement), _parent(*refinement.parent), _child(*refinement.child),
          _cell(cell), _gatherer(_child, sdcOptions, faceMask) {}

    std::vector<CellPatch> Refine() {
        switch (_cell.kind) {
        case CellKind::Whole:
            addFFace();
            addHalves(0);
            break;
        case CellKind::HalfPolygon:
        case CellKind::Half:
            addFFace();
            addHalves(1); // the long edge makes none
            break;
        case CellKind::Edge:
            addLongEdge();
            break;
        case CellKind::LongEdge:
            addSpoke(_cell.locals[0]);
            addFFace();
            addSpoke(_cell.locals[1]);
            break;
        case CellKind::Vertex:
            addVVertex();
            break;
        }
        return std::move(_children);
    }

private:
    CellPatch &add(CellKind kind) {
        _children.emplace_back();
        _children.back().kind = kind;
        return _children.back();
    }

    void addFFace() {
        CellPatch &child = add(_cell.kind);
        child.locals = _cell.locals;
        gather(_gatherer, _child, 0, child);
    }

    void addHalves(int firstCorner) {
        for (int i = firstCorner; i < _cell.GetNumCorners(); ++i) {
            int const local = _cell.locals[std::size_t(i)];
            Index const edge = _parent.faceEdges[local];
            gatherHalf(_gatherer, _child, _refinement.GetEdgeChildFace(edge),
                       isFirstSide(_parent, 0, local) ? 0 : 1, add(CellKind::Half));
        }
    }

    // The edge runs from the first of its two places in face 0, which may be behind the second.
    void addLongEdge() {
        int const size = _parent.GetFaceSize(0);
        bool const isForward = (_cell.locals[0] + 1) % size == _cell.locals[1];
        int const local = _cell.locals[isForward ? 0 : 1];
        Index const face = _refinement.GetEdgeChildFace(_parent.faceEdges[local]);
        bool const isStart = isForward == isFirstSide(_parent, 0, local);
        int const end = HasHalves(_child.GetFaceSize(face)) ? kDiagonalEnd : 1;
        CellPatch &child = add(CellKind::LongEdge);
        child.locals = {isStart ? 0 : end, isStart ? end : 0};
        gather(_gatherer, _child, face, child);
    }

    // From the E-face of the edge that begins there in face 0.
    void addVVertex() {
        int const local = _cell.locals[0];
        Index const face = _refinement.GetEdgeChildFace(_parent.faceEdges[local]);
        Index const vert = _refinement.GetVertexChildVertex(_parent.faceVerts[local]);
        Far::ConstIndexArray const verts = _child.GetFaceVertices(face);
        CellPatch &child = add(CellKind::Vertex);
        child.locals = {int(std::find(verts.begin(), verts.end(), vert) - verts.begin())};
        gather(_gatherer, _child, face, child);
    }

    // From the V-vertex to the F-vertex of a corner of face 0.
    void addSpoke(int local) {
        Index const vert = _refinement.GetVertexChildVertex(_parent.faceVerts[local]);
        Index const fVertex = _refinement.GetCornerChildVertex(local);
        for (Index const edge : _child.GetVertexEdges(fVertex)) {
            IndexPair const &ends = _child.edgeVerts[edge];
            if (ends[0] == vert || ends[1] == vert) {
                Index const face = _child.edgeFaces[edge][0];
                int const start = _child.edgeFaceLocals[edge][0];
                int const end = (start + 1) % _child.GetFaceSize(face);
                CellPatch &child = add(CellKind::Edge);
                child.locals = {ends[0] == vert ? start : end, ends[0] == vert ? end : start};
                gather(_gatherer, _child, face, child);
                return;
            }
        }
    }

    Refinement const &_refinement;
    Level const &_parent;
    Level const &_child;
    CellPatch const &_cell;
    LimitPatchGatherer _gatherer;
    std::vector<CellPatch> _children;
};

} // namespace

CellRefinement RefineCell(CellPatch const &cell, Sdc::Options sdcOptions,
                          HexSchemeOptions const &schemeOptions, Interpolation interpolation,
                          bool hasStep) {
    ExecutorScope const alone(nullptr, 1);
    RefinedPatch const refined(cell.patch, sdcOptions, schemeOptions.faceMask);
    Refinement const &refinement = refined.refinement;
    CellRefinement result;
    result.children = CellRefiner(refinement, sdcOptions, schemeOptions.faceMask, cell).Refine();
    if (!hasStep) {
        return result;
    }
    std::vector<int> rowOfVert(std::size_t(refined.child.numVertices), -1);
    for (CellPatch const &child : result.children) {
        for (Index const vert : child.patch.sources) {
            rowOfVert[std::size_t(vert)] = 0;
        }
    }
    std::vector<Index> verts;
    for (Index vert = 0; vert < refined.child.numVertices; ++vert) {
        if (rowOfVert[std::size_t(vert)] == 0) {
            rowOfVert[std::size_t(vert)] = int(verts.size());
            verts.push_back(vert);
        }
    }
    result.step = MakePatchStep(refinement, schemeOptions, interpolation, verts);
    for (CellPatch const &child : result.children) {
        std::vector<int> rows;
        rows.reserve(child.patch.sources.size());
        for (Index const vert : child.patch.sources) {
            rows.push_back(rowOfVert[std::size_t(vert)]);
        }
        result.rows.push_back(std::move(rows));
    }
    return result;
}

void UseNextMasks(
    LimitPatch const &patch, Sdc::Options sdcOptions, HexSchemeOptions const &schemeOptions,
    Interpolation interpolation,
    std::function<void(Refinement const &, RefinementRules const &)> const &function) {
    ExecutorScope const alone(nullptr, 1);
    RefinedPatch const refined(patch, sdcOptions, schemeOptions.faceMask);
    function(refined.refinement, RefinementRules(refined.child, schemeOptions, interpolation));
}

std::vector<CornerLimit> FindCornerLimits(CellPatch const &cell, LimitMaskFinder &finder) {
    ExecutorScope const alone(nullptr, 1);
    Level level;
    BuildPatchLevel(cell.patch, level);
    LimitPatchGatherer gatherer(level, finder.GetSdcOptions(), finder.GetFaceMask());
    LimitPatch patch;
    std::vector<CornerLimit> limits;
    for (Index const vert : cell.corners) {
        gatherer.Gather(vert, patch);
        LimitMaskFinder::MaskPointer const mask = finder.Find(patch);
        if (!mask) {
            return {};
        }
        int const side = patch.sides[std::size_t(findSide(level, vert))];
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

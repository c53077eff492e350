// SPDX-License-Identifier: Apache-2.0
#include "baseCoords.h"

#include "faceCoords.h"

#include <array>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

constexpr int kNumHalfCorners = HexIndexing::kNumBoundaryEFaceCorners;

SectorPoint getMiddle(SectorPoint p, SectorPoint q) {
    return {0.5 * (p.a + q.a), 0.5 * (p.b + q.b)};
}

// A cell that an edge made: half a hexagon, its long edge first; or the quad of a free boundary.
struct Quad {
    SectorPoint GetCenter() const {
        SectorPoint const longMiddle = getMiddle(corners[0], corners[1]);
        return isHalf ? longMiddle : getMiddle(longMiddle, getMiddle(corners[2], corners[3]));
    }

    std::array<SectorPoint, kNumHalfCorners> corners;
    bool isHalf;
};

// Edges make quads whose edge 0 is theirs.
Quad makeQuad(SectorPoint start, SectorPoint end, SectorPoint center, bool isHalf) {
    return {{start, end, getMiddle(end, center), getMiddle(start, center)}, isHalf};
}

// A cell in its base face: the F-face of that, or a quad in the sector of one of its edges.
struct PlacedCell {
    Index baseFace;  // a surface face
    int sector = -1; // negative for the F-face
    double scale = 1;
    Quad quad{};
};

PlacedCell place(MeshLevels const &mesh, int baseDepth, int depth, Cell cell) {
    SurfaceFaces const faces(mesh.levels[std::size_t(baseDepth)]);
    if (depth == baseDepth) {
        return {faces.GetFace({cell.face, cell.half})};
    }
    Refinement const &refinement = mesh.refinements[std::size_t(depth) - 1];
    Level const &parent = *refinement.parent;
    Cell const pCell = refinement.GetParentCell(cell);
    PlacedCell placed = place(mesh, baseDepth, depth - 1, pCell);
    bool const isWhole = placed.sector < 0;
    SectorPoint const center = isWhole ? SectorPoint() : placed.quad.GetCenter();
    if (cell.face < refinement.child->numFFaces) {
        placed.scale *= 0.5;
        for (SectorPoint &corner : placed.quad.corners) {
            corner = getMiddle(corner, center);
        }
        return placed;
    }
    Index const edge = refinement.GetEFaceParent(cell.face);
    int const side = HasHalves(refinement.child->GetFaceSize(cell.face)) ? cell.half : 0;
    int const local = parent.edgeFaceLocals[edge][side];
    bool const isHalf = parent.edgeFaces[edge][1] != kFreeBoundary;
    if (isWhole) {
        // An F-face has the number of its base face, and the places of edges there.
        placed.sector = faces.GetSideOfPlace(pCell.face, local).local;
        placed.quad = makeQuad({placed.scale, 0}, {0, placed.scale}, center, isHalf);
    } else {
        auto const &corners = placed.quad.corners;
        bool const isHexagon = HasHalves(parent.GetFaceSize(pCell.face));
        int const start = isHexagon ? GetEdgeInHalf(local) : local;
        placed.quad =
            makeQuad(corners[start], corners[(start + 1) % kNumHalfCorners], center, isHalf);
    }
    return placed;
}

// Whether hexagonal steps alone lead from one level to another.
bool areHexagonal(MeshLevels const &mesh, int baseDepth, int depth) {
    for (int level = baseDepth + 1; level <= depth; ++level) {
        if (!mesh.levels[std::size_t(level)].isHexagonal) {
            return false;
        }
    }
    return depth >= baseDepth;
}

} // namespace

Index FindBaseFace(MeshLevels const &mesh, int baseDepth, int depth, Cell cell) {
    if (!areHexagonal(mesh, baseDepth, depth)) {
        return Far::INDEX_INVALID;
    }
    for (; depth > baseDepth; --depth) {
        cell = mesh.refinements[std::size_t(depth) - 1].GetParentCell(cell);
    }
    return SurfaceFaces(mesh.levels[std::size_t(baseDepth)]).GetFace({cell.face, cell.half});
}

template <typename REAL>
bool FindBaseCoords(MeshLevels const &mesh, int baseDepth, int depth, Cell cell, CoordsOf coordsOf,
                    REAL *uv) {
    if (!areHexagonal(mesh, baseDepth, depth)) {
        return false;
    }
    PlacedCell const placed = place(mesh, baseDepth, depth, cell);
    FaceShape const shape =
        SurfaceFaces(mesh.levels[std::size_t(baseDepth)]).GetShape(placed.baseFace);
    int const size = shape.size;
    BasePolygon const polygon(shape);
    auto const parameterization = MakeFaceParameterization(size);
    auto const writePoint = [&](int sector, SectorPoint point, REAL *at) {
        if (coordsOf == CoordsOf::Plane) {
            polygon.Write(sector, point, at);
        } else {
            BasePolygon::Pair const coords =
                FindFaceCoords(parameterization, polygon, sector, point);
            at[0] = REAL(coords[0]);
            at[1] = REAL(coords[1]);
        }
    };
    if (placed.sector < 0) {
        for (int i = 0; i < size; ++i) {
            bool const isAtEnd = shape.GetSectorOfCorner(i) != i;
            writePoint(shape.GetSectorOfCorner(i),
                       isAtEnd ? SectorPoint{0, placed.scale} : SectorPoint{placed.scale, 0},
                       uv + 2 * i);
        }
        return true;
    }
    auto const write = [&](PlacedCell const &half, int const(&places)[kNumHalfCorners]) {
        for (int i = 0; i < kNumHalfCorners; ++i) {
            writePoint(half.sector, half.quad.corners[i], uv + 2 * places[i]);
        }
    };
    if (HasHalves(mesh.levels[std::size_t(depth)].GetFaceSize(cell.face))) {
        PlacedCell const other = place(mesh, baseDepth, depth, {cell.face, 1 - cell.half});
        if (other.baseFace == placed.baseFace) {
            write(placed, kHexagonHalves[cell.half]);
            write(other, kHexagonHalves[1 - cell.half]);
            return true;
        }
    }
    write(placed, {0, 1, 2, 3});
    return true;
}

template bool FindBaseCoords(MeshLevels const &, int, int, Cell, CoordsOf, float *);
template bool FindBaseCoords(MeshLevels const &, int, int, Cell, CoordsOf, double *);

} // namespace OpenSubdivHex::FarExt::internal

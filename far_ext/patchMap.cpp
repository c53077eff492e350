// SPDX-License-Identifier: Apache-2.0
#include "patchTableFactory.h"

#include "far_ext/patch/patchChecks.h"
#include "far_ext/vtr/baseCoords.h"
#include "far_ext/vtr/faceCoords.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace OpenSubdivHex::FarExt {

using Far::Index;
using internal::Cell;
using internal::Level;

namespace {

struct Point {
    double u;
    double v;
};

Point operator+(Point a, Point b) { return {a.u + b.u, a.v + b.v}; }
Point operator-(Point a, Point b) { return {a.u - b.u, a.v - b.v}; }
Point operator*(double s, Point a) { return {s * a.u, s * a.v}; }
double cross(Point a, Point b) { return a.u * b.v - a.v * b.u; }
Point middle(Point a, Point b) { return 0.5 * (a + b); }

// A cell in the plane of its face: a half has its long side first.
struct Polygon {
    std::vector<Point> corners;
    bool isHalf;

    Point GetCorner(std::size_t i) const { return corners[i % corners.size()]; }
    Point GetMiddle(std::size_t side) const {
        side %= corners.size();
        return isHalf && side == 0 ? FindCenter() : middle(corners[side], GetCorner(side + 1));
    }
    // Where children meet, and what they shrink towards.
    Point FindCenter() const {
        if (isHalf) {
            return middle(corners[0], corners[1]);
        }
        Point sum = {0, 0};
        for (Point const &corner : corners) {
            sum = sum + corner;
        }
        return 1.0 / double(corners.size()) * sum;
    }
    // Where kites meet: in a half at a third of the line from its long side to what is across.
    Point FindCenterOfKites() const {
        Point const center = FindCenter();
        if (!isHalf) {
            return center;
        }
        std::size_t const numCorners = corners.size();
        Point const across = middle(corners[(numCorners + 1) / 2], corners[numCorners / 2 + 1]);
        return center + 1.0 / 3 * (across - center);
    }
};

Polygon makeFace(FaceShape shape) {
    internal::BasePolygon const base(shape);
    std::array<double, 2> const center = base.GetCenter();
    Polygon polygon = {{}, shape.isHalf};
    for (int i = 0; i < shape.size; ++i) {
        std::array<double, 2> const corner = base.GetCorner(i);
        polygon.corners.push_back({center[0] + corner[0], center[1] + corner[1]});
    }
    return polygon;
}

// The child that has a place: 0 is that of the F-face, 1 + i that of edge i.
int findChild(Polygon const &cell, Point place, Polygon &child) {
    Point const center = cell.FindCenter();
    std::size_t const size = cell.corners.size();
    std::vector<Point> inner;
    for (Point const &corner : cell.corners) {
        inner.push_back(middle(corner, center));
    }
    // The edge in whose sector it lies: at the place where it crosses from the right of a spoke to the left.
    bool const isHalf = cell.isHalf;
    std::size_t edge = isHalf ? 1 : 0;
    for (std::size_t i = edge; i < size; ++i) {
        bool const isLeft = cross(cell.corners[i] - center, place - center) >= 0;
        bool const isRight = cross(cell.GetCorner(i + 1) - center, place - center) <= 0;
        bool const isLast = isHalf && i + 1 == size;
        bool const isFirst = isHalf && i == 1;
        if ((isLeft || isFirst) && (isRight || isLast)) {
            edge = i;
            break;
        }
    }
    std::size_t const next = (edge + 1) % size;
    if (cross(inner[next] - inner[edge], place - inner[edge]) >= 0) {
        child = {inner, isHalf};
        return 0;
    }
    child = {{cell.corners[edge], cell.corners[next], inner[next], inner[edge]}, true};
    return 1 + int(edge);
}

// The corner whose kite has a place.
int findKite(Polygon const &face, Point place) {
    Point const center = face.FindCenterOfKites();
    std::size_t const size = face.corners.size();
    for (std::size_t i = 0; i < size; ++i) {
        Point const before = face.GetMiddle(i + size - 1);
        Point const behind = face.GetMiddle(i);
        if (cross(before - center, place - center) >= 0 &&
            cross(behind - center, place - center) <= 0) {
            return int(i);
        }
    }
    return 0; // the centre, or nearly
}

Point evaluate(std::array<double, 8> const &q, double s, double t) {
    auto const at = [&](std::size_t i) { return Point{q[2 * i], q[2 * i + 1]}; };
    return (1 - t) * ((1 - s) * at(0) + s * at(1)) + t * ((1 - s) * at(3) + s * at(2));
}

// The half of a hexagon that has a place: half 0 lies to the left of the diagonal.
int findHalf(Polygon const &hexagon, Point place) {
    Point const center = hexagon.FindCenter();
    return cross(hexagon.corners[kDiagonalEnd] - center, place - center) >= 0 ? 0 : 1;
}

// Newton's method: the quadrilaterals are convex, and not far from parallelograms.
void invert(std::array<double, 8> const &q, Point place, double &s, double &t) {
    auto const at = [&](std::size_t i) { return Point{q[2 * i], q[2 * i + 1]}; };
    s = t = 0.5;
    constexpr int kMaxSteps = 20;
    constexpr double kConverged = 1e-14;
    for (int i = 0; i < kMaxSteps; ++i) {
        Point const missing = place - evaluate(q, s, t);
        Point const ds = (1 - t) * (at(1) - at(0)) + t * (at(2) - at(3));
        Point const dt = (1 - s) * (at(3) - at(0)) + s * (at(2) - at(1));
        double const determinant = cross(ds, dt);
        double const stepS = cross(missing, dt) / determinant;
        double const stepT = cross(ds, missing) / determinant;
        s += stepS;
        t += stepT;
        if (std::abs(stepS) + std::abs(stepT) < kConverged) {
            break;
        }
    }
}

} // namespace

// Builds the trees of faces: which cells have which children, down to patches.
class PatchMap::TreeBuilder {
public:
    TreeBuilder(PatchMap &map, TopologyRefiner const &refiner, internal::PatchCells const &cells)
        : _map(map), _refiner(refiner), _mesh(refiner.GetHierarchy().mesh),
          _surfaceLevel(refiner.GetHexSchemeOptions().GetSurfaceLevel()), _cells(cells),
          _firsts(_mesh.levels.size()) {
        for (int depth = cells.GetFirstLevel(); depth <= cells.GetLastLevel(); ++depth) {
            addPatches(depth);
        }
        SurfaceFaces const faces(_mesh.levels[std::size_t(_surfaceLevel)]);
        for (Index face = 0; face < faces.GetNumFaces(); ++face) {
            auto const [levelFace, half] = faces.GetLevelFace(face);
            _map._roots.push_back(
                makeNode(_surfaceLevel, {levelFace, half}, !faces.IsHalfOfCut(face)));
        }
    }

private:
    void addPatches(int depth) {
        Level const &level = _mesh.levels[std::size_t(depth)];
        std::vector<Index> &firsts = _firsts[std::size_t(depth)];
        firsts.assign(2 * std::size_t(level.numFaces), Far::INDEX_INVALID);
        for (internal::PatchCell const &cell : _cells.GetCells(depth)) {
            firsts[2 * std::size_t(cell.face) + std::size_t(cell.half)] =
                Index(_map._patches.size());
            addCell(_refiner.GetLevel(depth), cell);
        }
    }

    void addCell(TopologyLevel const &level, internal::PatchCell const &cell) {
        int const size = level.GetFaceVertices(cell.face).size();
        internal::FaceCells const cells = internal::FindFaceCells(level.GetLevel(), cell.face);
        Patch patch{level.GetFaceSurfaceFace(cell.face, cell.half),
                    level.GetFaceBaseFace(cell.face, cell.half),
                    {}};
        std::vector<double> uv(2 * std::size_t(size));
        internal::FindBaseCoords(_mesh, _surfaceLevel, level.GetDepth(), {cell.face, cell.half},
                                 internal::CoordsOf::Plane, uv.data());
        // A hexagon in two faces has only the vertices of the half.
        bool const isWhole =
            cells.IsCut() && level.GetFaceSurfaceFace(cell.face, 1 - cell.half) == patch.face;
        int const numCorners = cells.GetNumCorners(cell.half);
        Polygon polygon = {{}, cells.AreHalves()};
        for (int corner = 0; corner < numCorners; ++corner) {
            auto const i = std::size_t(isWhole ? cells.GetLocal(cell.half, corner) : corner);
            polygon.corners.push_back({uv[2 * i], uv[2 * i + 1]});
        }
        auto const add = [&](std::array<Point, 4> const &corners) {
            for (std::size_t i = 0; i < corners.size(); ++i) {
                patch.coords[2 * i] = corners[i].u;
                patch.coords[2 * i + 1] = corners[i].v;
            }
            _map._patches.push_back(patch);
        };
        if (!cells.HasKites(cell.half)) {
            add({polygon.corners[0], polygon.corners[1], polygon.corners[2], polygon.corners[3]});
            return;
        }
        Point const center = polygon.FindCenterOfKites();
        for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
            Point const corner = polygon.corners[i];
            add({corner, polygon.GetMiddle(i), center,
                 polygon.GetMiddle(i + polygon.corners.size() - 1)});
        }
    }

    // A node of a cell, whole or one half of a face.
    Node makeNode(int depth, Cell cell, bool isWhole) {
        Level const &level = _mesh.levels[std::size_t(depth)];
        int const size = level.GetFaceSize(cell.face);
        bool const isCut = level.HasFaceHalves(cell.face) && !isWhole;
        Node node = {Far::INDEX_INVALID, {Far::INDEX_INVALID, Far::INDEX_INVALID}};
        bool const hasPatches = depth >= _cells.GetFirstLevel() &&
                                (_cells.HasCell(depth, cell.face, isCut ? cell.half : 0) ||
                                 (isWhole && _cells.HasCell(depth, cell.face, 1)));
        if (hasPatches || depth == _cells.GetLastLevel()) {
            Index const *const firsts =
                _firsts[std::size_t(depth)].data() + 2 * std::size_t(cell.face);
            node.firstPatches[0] = firsts[isCut ? cell.half : 0];
            node.firstPatches[1] = firsts[1];
            return node;
        }
        std::vector<Node> children = {makeNode(depth + 1, cell, isWhole)};
        for (int local = 0; local < size; ++local) {
            bool const isLong = level.IsHalfFace(cell.face) && local == kHalfFaceLongEdge;
            if (isLong || (isCut && level.GetHalfOfFaceEdge(cell.face, local) != cell.half)) {
                continue; // of half faces the border, and what the other half has
            }
            Index const edge = level.faceEdges[level.faceFirstCorner[cell.face] + local];
            bool const isFirst =
                level.edgeFaces[edge][0] == cell.face && level.edgeFaceLocals[edge][0] == local;
            Index const child = _mesh.refinements[std::size_t(depth)].GetEdgeChildFace(edge);
            bool const isChildCut =
                HasHalves(_mesh.levels[std::size_t(depth) + 1].GetFaceSize(child));
            children.push_back(makeNode(depth + 1, {child, isChildCut && !isFirst ? 1 : 0}, false));
        }
        node.firstChild = Index(_map._children.size());
        _map._children.insert(_map._children.end(), children.begin(), children.end());
        return node;
    }

    PatchMap &_map;
    TopologyRefiner const &_refiner;
    internal::MeshLevels const &_mesh;
    int const _surfaceLevel;
    internal::PatchCells const &_cells;
    std::vector<std::vector<Index>> _firsts; // by level, face and half
};

PatchMap::PatchMap(TopologyRefiner const &refiner, PatchTableFactory::Options options,
                   CallStatus *status) {
    std::optional<internal::PatchCells> cells;
    if (!internal::Report(internal::FindPatchCells(refiner, options, cells), status)) {
        return;
    }
    SurfaceFaces const faces(
        refiner.GetLevel(refiner.GetHexSchemeOptions().GetSurfaceLevel()).GetLevel());
    for (Index face = 0; face < faces.GetNumFaces(); ++face) {
        _shapes.push_back(faces.GetShape(face));
    }
    TreeBuilder(*this, refiner, *cells);
}

auto PatchMap::FindPlace(Index face, double u, double v) const -> Place {
    Place place = {Far::INDEX_INVALID, 0, 0};
    if (face < 0 || face >= GetNumFaces() || !std::isfinite(u) || !std::isfinite(v)) {
        return place;
    }
    FaceShape const shape = _shapes[std::size_t(face)];
    auto const coords =
        internal::FindInPlane(internal::MakeFaceParameterization(shape.size), {u, v}).coords;
    Point const wanted = {coords[0], coords[1]};
    Polygon cell = makeFace(shape);
    Node node = _roots[std::size_t(face)];
    while (node.firstChild != Far::INDEX_INVALID) {
        Polygon child;
        int const i = findChild(cell, wanted, child);
        // A half has its long side first, and no child there.
        int const numBefore = cell.isHalf && i > 0 ? i - 1 : i;
        node = _children[std::size_t(node.firstChild) + std::size_t(numBefore)];
        cell = std::move(child);
    }
    // Half cells are not cut, but the faces of surfaces, and others as large as these.
    auto const size = int(cell.corners.size());
    internal::FaceCells const cells =
        cell.isHalf ? internal::FaceCells{size, 0, true} : internal::MakeFaceCells(size);
    int const half = cells.IsCut() ? findHalf(cell, wanted) : 0;
    if (node.firstPatches[half] == Far::INDEX_INVALID) {
        return place;
    }
    place.patch = node.firstPatches[half];
    if (cells.HasKites(half)) {
        place.patch += findKite(cell, wanted);
    }
    invert(GetCoords(place.patch), wanted, place.s, place.t);
    return place;
}

void PatchMap::GetFacePlace(Place const &place, double *u, double *v) const {
    Point const point = evaluate(GetCoords(place.patch), place.s, place.t);
    FaceShape const shape = _shapes[std::size_t(GetFace(place.patch))];
    std::array<double, 2> uv = {point.u, point.v};
    auto const parameterization = internal::MakeFaceParameterization(shape.size);
    if (parameterization.HasSubFaces()) {
        int sector = 0;
        internal::BasePolygon const polygon(shape);
        internal::SectorPoint const inSector = polygon.FindSector(uv, sector);
        uv = internal::FindFaceCoords(parameterization, polygon, sector, inSector);
    }
    *u = uv[0];
    *v = uv[1];
}

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include "cell/cellType.h"
#include "cell/flatness.h"
#include "cell/slopeBounds.h"
#include "cell/vector3.h"

#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::BfrExt {

namespace internal {

/// The pyramid that a camera sees.
class ViewGeometry {
public:
    /// Whether the camera has a picture.  Of one that looks along what is up, that is replaced.
    bool Set(Camera &camera) {
        constexpr double kHalfTurn = 180;
        constexpr double kPi = 3.14159265358979323846;
        _eye = ToVector3(camera.eye);
        Vector3 const toTarget = Subtract(ToVector3(camera.target), _eye);
        double const distance = GetLength(toTarget);
        double const upLength = GetLength(ToVector3(camera.up));
        if (!(camera.fieldOfView > 0) || !(camera.fieldOfView < kHalfTurn) || camera.width < 1 ||
            camera.height < 1 || !std::isfinite(distance) || !(distance > 0) ||
            !std::isfinite(upLength) || !(upLength > 0)) {
            return false;
        }
        constexpr double kLeastSine = 1e-9;
        _forward = Scale(toTarget, 1 / distance);
        Vector3 right = Cross(_forward, ToVector3(camera.up));
        if (!(GetLength(right) > kLeastSine * upLength)) {
            bool const isAlongZ = std::abs(_forward[2]) > std::abs(_forward[1]);
            camera.up[0] = 0;
            camera.up[1] = isAlongZ ? 1 : 0;
            camera.up[2] = isAlongZ ? 0 : -1;
            right = Cross(_forward, ToVector3(camera.up));
        }
        Vector3 const rightAxis = Scale(right, 1 / GetLength(right));
        Vector3 const upAxis = Cross(rightAxis, _forward);
        double const top = std::tan(camera.fieldOfView / 2 * kPi / kHalfTurn);
        double const side = top * camera.width / camera.height;
        // A point at depth 1 is outside from side or top on.
        for (std::size_t i = 0; i < 2; ++i) {
            Vector3 const &axis = i == 0 ? rightAxis : upAxis;
            double const slope = i == 0 ? side : top;
            _planes[2 * i] = Subtract(axis, Scale(_forward, slope));
            _planes[2 * i + 1] = Subtract(Scale(axis, -1), Scale(_forward, slope));
        }
        _pixelsAtDepth1 = camera.height / (2 * top);
        _largestSecant = std::sqrt(1 + top * top + side * side);
        return std::isfinite(_pixelsAtDepth1) && std::isfinite(_largestSecant);
    }

    Vector3 const &GetEye() const { return _eye; }

    /// Whether the hull of some points is outside of the picture, or behind the eye.
    bool IsOutside(CellValues const &points) const {
        auto const isBeyond = [&](Vector3 const &outwards) {
            for (int i = 0; i < points.GetNumPoints(); ++i) {
                if (!(Dot(outwards, Subtract(ToVector3(points.GetPoint(i)), _eye)) > 0)) {
                    return false;
                }
            }
            return true;
        };
        return std::any_of(std::begin(_planes), std::end(_planes), isBeyond) ||
               isBeyond(Scale(_forward, -1));
    }

    /// \brief How many pixels long a line of length 1 in the hull of some points is at most.
    ///
    /// A piece of it at depth z, and by an angle with the secant s away from the axis, has s/z times the
    /// pixels that it would have at depth 1.  Or, at distance r = s z, s^2/r times these.
    double GetPixelsPerUnit(CellValues const &points) const {
        double leastDepth = std::numeric_limits<double>::infinity();
        double largestSquare = 1; // of secants
        Vector3 least = {leastDepth, leastDepth, leastDepth};
        Vector3 largest = Scale(least, -1);
        for (int i = 0; i < points.GetNumPoints(); ++i) {
            Vector3 const toPoint = Subtract(ToVector3(points.GetPoint(i)), _eye);
            double const depth = Dot(_forward, toPoint);
            leastDepth = std::min(leastDepth, depth);
            largestSquare = std::max(largestSquare, Dot(toPoint, toPoint) / (depth * depth));
            for (std::size_t k = 0; k < 3; ++k) {
                least[k] = std::min(least[k], toPoint[k]);
                largest[k] = std::max(largest[k], toPoint[k]);
            }
        }
        Vector3 nearest;
        for (std::size_t k = 0; k < 3; ++k) {
            nearest[k] = std::max({least[k], -largest[k], 0.0});
        }
        double const byDistance = _largestSecant * _largestSecant / GetLength(nearest);
        double const byDepth = leastDepth > 0
                                   ? std::min(std::sqrt(largestSquare), _largestSecant) / leastDepth
                                   : std::numeric_limits<double>::infinity();
        return _pixelsAtDepth1 * std::min(byDepth, byDistance);
    }

private:
    Vector3 _eye = {};
    Vector3 _forward = {};
    std::array<Vector3, 4> _planes = {}; // through the eye and the sides of the picture, outwards
    double _pixelsAtDepth1 = 0;
    double _largestSecant = 1; // of the angles between the axis and what is in the picture
};

namespace {

/// Refines one face.
class TreeMaker {
public:
    TreeMaker(ViewGeometry const &geometry, View::Options const &options, CellTree const *previous,
              CellTree &tree, std::vector<CellVisibility> *visibility)
        : _geometry(geometry), _options(options), _previous(previous), _tree(tree),
          _visibility(visibility) {}

    /// \param cells  of the base face, which it refines
    void Make(RefinedCells &cells) {
        _cells = &cells;
        visit(RefinedCells::kBase, 0, _previous ? 0 : -1);
    }

private:
    void visit(std::size_t cell, int treeCell, int previousCell) {
        CellVisibility const found = find(cell);
        if (_visibility) {
            _visibility->resize(std::size_t(_tree.GetNumCells()));
            (*_visibility)[std::size_t(treeCell)] = found;
        }
        if (found != CellVisibility::Visible ||
            getCell(cell).GetLevel() >= _options.GetMaxLevel()) {
            return;
        }
        bool const wasRefined = previousCell >= 0 && _previous->IsRefined(previousCell);
        if (!isToRefine(cell, wasRefined ? _options.GetHysteresis() : 1)) {
            return;
        }
        std::size_t const firstChild = _cells->GetFirstChild(cell);
        std::size_t const numCells = _cells->GetSize();
        int const first = _tree.Refine(treeCell);
        for (int i = 0; i < _tree.GetNumChildren(treeCell); ++i) {
            visit(firstChild + std::size_t(i), first + i,
                  wasRefined ? _previous->GetFirstChild(previousCell) + i : -1);
            _cells->Drop(numCells); // what was made within the child
        }
    }

    CellValues const &getCell(std::size_t cell) const { return (*_cells)[cell]; }

    CellVisibility find(std::size_t cell) {
        if (!_options.IsCulling()) {
            return CellVisibility::Visible;
        }
        if (_geometry.IsOutside(getCell(cell))) {
            return CellVisibility::Outside;
        }
        return isBackFacing(cell, SlopeBounds::kMaxSteps) ? CellVisibility::BackFacing
                                                          : CellVisibility::Visible;
    }

    // Whether the cell faces away, or all cells do that some steps make of it.
    bool isBackFacing(std::size_t cell, int numSteps) {
        CellValues const &values = getCell(cell);
        SlopeBounds const *const bounds =
            values.HasSurfaceOfType() ? &SlopeBounds::Find(values.GetType()) : nullptr;
        if ((bounds && bounds->GetNumSteps() > numSteps) || !areCornersBackFacing(cell)) {
            return false;
        }
        if (bounds && bounds->Exist() && areSlopesBackFacing(values, *bounds)) {
            return true;
        }
        if (numSteps == 0) {
            return false;
        }
        std::size_t const first = _cells->GetFirstChild(cell);
        for (int i = 0; i < values.GetNumChildren(); ++i) {
            if (!isBackFacing(first + std::size_t(i), numSteps - 1)) {
                return false;
            }
        }
        return true;
    }

    void findCorners(std::size_t cell) {
        CellValues const &values = getCell(cell);
        int const numCorners =
            values.IsPlainBase() ? values.GetNumChildren() - 1 : values.GetType().GetNumCorners();
        _corners.resize(3 * std::size_t(numCorners));
        for (int i = 0; i < numCorners; ++i) {
            _cells->EvaluateCorner(cell, i, &_corners[3 * std::size_t(i)]);
        }
    }

    // Whether the polygon of the corners does, which others of the surface are likely to do as well then.
    bool areCornersBackFacing(std::size_t cell) {
        findCorners(cell);
        Vector3 const first = ToVector3(_corners.data());
        Vector3 area = {};
        for (std::size_t i = 3; i + 3 < _corners.size(); i += 3) {
            Vector3 const part = Cross(Subtract(ToVector3(&_corners[i]), first),
                                       Subtract(ToVector3(&_corners[i + 3]), first));
            area = {area[0] + part[0], area[1] + part[1], area[2] + part[2]};
        }
        return Dot(area, Subtract(_geometry.GetEye(), first)) < 0;
    }

    // With m the unit normal of the slopes, all normals are m + s w, with w of length 1 at most in their
    // plane.  With c the mean of the points and r how far they are from it, (m + s w) . (eye - p) is at
    // most m . (eye - c) - m . (p - c) + s (|part of eye - c in the plane| + r).
    bool areSlopesBackFacing(CellValues const &values, SlopeBounds const &bounds) const {
        SlopeBounds::Normals const normals = bounds.GetNormals(values);
        int const numPoints = values.GetNumPoints();
        Vector3 center = {};
        for (int i = 0; i < numPoints; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                center[k] += values.GetPoint(i)[k] / double(numPoints);
            }
        }
        double radius = 0;
        double depth = 0;
        for (int i = 0; i < numPoints; ++i) {
            Vector3 const d = Subtract(ToVector3(values.GetPoint(i)), center);
            radius = std::max(radius, GetLength(d));
            depth = std::max(depth, -Dot(normals.middle, d));
        }
        Vector3 const toEye = Subtract(_geometry.GetEye(), center);
        double const height = Dot(normals.middle, toEye);
        double const across = GetLength(Subtract(toEye, Scale(normals.middle, height)));
        return height + depth + normals.spread * (across + radius) < 0;
    }

    bool isToRefine(std::size_t cell, double fraction) {
        findCorners(cell);
        double const pixels = _geometry.GetPixelsPerUnit(getCell(cell));
        if (_options.GetEdgeLength() > 0) {
            for (std::size_t i = 0; i < _corners.size(); i += 3) {
                std::size_t const next = i + 3 < _corners.size() ? i + 3 : 0;
                Vector3 const side = Subtract(ToVector3(&_corners[next]), ToVector3(&_corners[i]));
                if (GetLength(side) * pixels > fraction * _options.GetEdgeLength()) {
                    return true;
                }
            }
        }
        return _options.GetFlatness() > 0 &&
               !_flatness.IsFlat(*_cells, cell, _corners,
                                 fraction * _options.GetFlatness() / pixels);
    }

    ViewGeometry const &_geometry;
    View::Options const &_options;
    CellTree const *const _previous;
    CellTree &_tree;
    std::vector<CellVisibility> *const _visibility;
    RefinedCells *_cells = nullptr;
    std::vector<double> _corners; // of the surface, of the cell that is looked at
    Flatness _flatness;
};

/// Refines an edge, whose points depend on its curve alone.
class EdgeMaker {
public:
    EdgeMaker(ViewGeometry const &geometry, View::Options const &options)
        : _geometry(geometry), _options(options) {}

    /// Adds what lies inside of the edge, from start to end.
    void Make(CellValues const &values, int start, int end,
              std::vector<Polyline::Place> &places) const {
        std::vector<CellType::Child> const &children = values.GetType().GetChildren();
        std::vector<CellValues> parts(children.size());
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i].SetChild(values, int(i));
        }
        if (parts.size() == 1) {
            if (values.GetLevel() + 1 < _options.GetMaxLevel()) {
                Make(parts[0], start, end, places); // the long edge that it becomes
            }
            return;
        }
        if (values.GetLevel() >= _options.GetMaxLevel() || !isToDivide(values, parts)) {
            return;
        }
        int const first = start + (end - start) / 4;
        int const second = end - (end - start) / 4;
        Make(parts[0], start, first, places);
        places.push_back(Polyline::Place(first));
        Make(parts[1], first, second, places);
        places.push_back(Polyline::Place(second));
        // It runs from the end.
        std::size_t const begin = places.size();
        Make(parts[2], 0, end - second, places);
        std::reverse(places.begin() + std::ptrdiff_t(begin), places.end());
        std::for_each(places.begin() + std::ptrdiff_t(begin), places.end(),
                      [&](Polyline::Place &place) { place = Polyline::Place(end - place); });
    }

private:
    bool isToDivide(CellValues const &values, std::vector<CellValues> const &parts) const {
        double ends[6];
        values.EvaluateCorner(0, ends);
        values.EvaluateCorner(1, ends + 3);
        double const length = GetLength(Subtract(ToVector3(ends + 3), ToVector3(ends)));
        double const pixels = _geometry.GetPixelsPerUnit(values);
        return (_options.GetEdgeLength() > 0 && length * pixels > _options.GetEdgeLength()) ||
               (_options.GetFlatness() > 0 &&
                !IsStraight(parts, ends, ends + 3, _options.GetFlatness() / pixels));
    }

    ViewGeometry const &_geometry;
    View::Options const &_options;
};

} // namespace

} // namespace internal

namespace {

// The first three numbers of some points.
template <typename REAL>
std::vector<double> gather(REAL const *points, std::ptrdiff_t stride, std::size_t numPoints) {
    std::vector<double> result;
    result.reserve(3 * numPoints);
    for (std::size_t i = 0; i < numPoints; ++i, points += stride) {
        result.insert(result.end(), points, points + 3);
    }
    return result;
}

} // namespace

View::View(Camera const &camera, Options options) : _camera(camera), _options(options) {
    auto const isNumber = [](double number) { return std::isfinite(number) && number >= 0; };
    auto geometry = std::make_shared<internal::ViewGeometry>();
    bool const hasAim = options.GetFlatness() > 0 || options.GetEdgeLength() > 0;
    if (geometry->Set(_camera) && hasAim && isNumber(options.GetFlatness()) &&
        isNumber(options.GetEdgeLength()) && isNumber(options.GetHysteresis()) &&
        options.GetHysteresis() <= 1 && options.GetMaxLevel() >= 0 &&
        options.GetMaxLevel() <= CellTree::kLastLevel) {
        _geometry = std::move(geometry);
    }
}

template <typename REAL>
CellTree View::MakeTree(Surface<REAL> const &surface, REAL const controlPoints[],
                        typename Surface<REAL>::PointDescriptor const &pointDesc,
                        CellTree const *previous, std::vector<CellVisibility> *visibility) const {
    CellTree tree(surface.GetFaceSize());
    if (visibility) {
        visibility->clear();
    }
    if (IsValid()) {
        bool const hasPrevious = previous && previous->GetFaceSize() == tree.GetFaceSize();
        std::vector<double> const points =
            gather(controlPoints, pointDesc.stride, std::size_t(surface.GetNumControlPoints()));
        // What they have taken of memory is kept for the next face.
        static thread_local internal::RefinedCells cells;
        if (internal::PlainFaceType const *const plain = surface._type.GetPlain()) {
            cells.SetBase(*plain, points.data(), 3);
        } else {
            cells.SetBase(*surface._type, points.data(), 3);
        }
        internal::TreeMaker(*_geometry, _options, hasPrevious ? previous : nullptr, tree,
                            visibility)
            .Make(cells);
    }
    if (visibility) {
        visibility->resize(std::size_t(tree.GetNumCells()));
    }
    return tree;
}

template <typename REAL>
Polyline View::MakeEdge(Surface<REAL> const &surface, int edge, REAL const controlPoints[],
                        typename Surface<REAL>::PointDescriptor const &pointDesc) const {
    if (!IsValid()) {
        return Polyline();
    }
    internal::CellType::BorderItem const &item =
        surface._type->GetBorderItem(surface.getTurns(), std::size_t(edge));
    std::vector<double> points;
    for (int const point : item.points) {
        REAL const *const from = controlPoints + std::ptrdiff_t(point) * pointDesc.stride;
        points.insert(points.end(), from, from + 3);
    }
    internal::CellValues values;
    values.SetBase(*item.type, points.data(), 3);
    std::vector<Polyline::Place> places;
    internal::EdgeMaker(*_geometry, _options).Make(values, 0, Polyline::kLength, places);
    Polyline polyline;
    Polyline::FromPlaces(places, &polyline);
    return item.isReversed ? polyline.GetReversed() : polyline;
}

template <typename REAL>
int View::FindLevels(Surface<REAL> const &surface, REAL const controlPoints[],
                     typename Surface<REAL>::PointDescriptor const &pointDesc, int levels[]) const {
    CellTree const tree = MakeTree(surface, controlPoints, pointDesc);
    int const size = surface.GetFaceSize();
    std::fill(levels, levels + size, 0);
    for (int cell = 1; cell < tree.GetNumCells(); ++cell) {
        if (tree.GetBorderSide(cell) >= 0) {
            int &level = levels[tree.GetEdge(cell)];
            level = std::max(level, tree.GetLevel(cell));
        }
    }
    levels[size] = tree.GetMaxLevel();
    return size + 1;
}

template <typename REAL>
CellForest View::MakeForest(SurfaceFactory const &factory, REAL const meshPoints[],
                            typename Surface<REAL>::PointDescriptor const &pointDesc,
                            CellForest const *previous, Counts *counts) const {
    using FarExt::internal::Level;
    FarExt::TopologyLevel const base = factory.GetLevel();
    Level const &level = factory.GetLevel().GetLevel();
    CellForest forest(factory.GetMesh());
    bool const hasPrevious = previous && previous->GetNumFaces() == forest.GetNumFaces();
    std::vector<std::vector<CellVisibility>> visibility(std::size_t(forest.GetNumFaces()));
    struct State {
        Surface<REAL> surface;
        std::vector<REAL> points;
    };
    constexpr Index kFacesOfRange = 16;
    FarExt::internal::ParallelForRange(
        forest.GetNumFaces(), [] { return State(); },
        [&](State &state, Index begin, Index end) {
            auto &[surface, points] = state;
            for (Index face = begin; face < end; ++face) {
                if (!factory.init(face, FarExt::Interpolation::Vertex, -1, surface).IsOk()) {
                    continue;
                }
                points.resize(3 * std::size_t(surface.GetNumControlPoints()));
                surface.GatherControlPoints(meshPoints, {3, pointDesc.stride}, points.data(), 3);
                CellTree const *const last = hasPrevious ? &previous->GetTree(face) : nullptr;
                forest.SetTree(face, MakeTree(surface, points.data(), 3, last,
                                              &visibility[std::size_t(face)]));
                for (int local = 0; local < surface.GetFaceSize(); ++local) {
                    Index const edge = level.faceEdges[level.faceFirstCorner[face] + local];
                    bool const isFirst =
                        level.edgeFaces[edge][0] == face && level.edgeFaceLocals[edge][0] == local;
                    if (isFirst && base.IsEdgeInfSharp(edge)) {
                        forest.SetEdge(edge, MakeEdge(surface, local, points.data(), 3));
                    }
                }
            }
        },
        kFacesOfRange);
    forest.MatchEdges();
    if (counts) {
        *counts = Counts();
        counts->cellsByLevel.assign(IsValid() ? std::size_t(_options.GetMaxLevel()) + 1 : 1, 0);
        for (Index face = 0; face < forest.GetNumFaces(); ++face) {
            CellTree const &tree = forest.GetTree(face);
            std::vector<CellVisibility> const &found = visibility[std::size_t(face)];
            for (std::size_t cell = 0; cell < found.size(); ++cell) {
                if (!tree.IsRefined(int(cell))) {
                    ++counts->cellsByLevel[std::size_t(tree.GetLevel(int(cell)))];
                    counts->outside += found[cell] == CellVisibility::Outside;
                    counts->backFacing += found[cell] == CellVisibility::BackFacing;
                }
            }
        }
    }
    return forest;
}

template CellTree View::MakeTree(Surface<float> const &, float const[],
                                 Surface<float>::PointDescriptor const &, CellTree const *,
                                 std::vector<CellVisibility> *) const;
template CellTree View::MakeTree(Surface<double> const &, double const[],
                                 Surface<double>::PointDescriptor const &, CellTree const *,
                                 std::vector<CellVisibility> *) const;
template Polyline View::MakeEdge(Surface<float> const &, int, float const[],
                                 Surface<float>::PointDescriptor const &) const;
template Polyline View::MakeEdge(Surface<double> const &, int, double const[],
                                 Surface<double>::PointDescriptor const &) const;
template int View::FindLevels(Surface<float> const &, float const[],
                              Surface<float>::PointDescriptor const &, int[]) const;
template int View::FindLevels(Surface<double> const &, double const[],
                              Surface<double>::PointDescriptor const &, int[]) const;
template CellForest View::MakeForest(SurfaceFactory const &, float const[],
                                     Surface<float>::PointDescriptor const &, CellForest const *,
                                     Counts *) const;
template CellForest View::MakeForest(SurfaceFactory const &, double const[],
                                     Surface<double>::PointDescriptor const &, CellForest const *,
                                     Counts *) const;

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include "cell/baseType.h"
#include "cell/cellGrid.h"
#include "stream/boundsData.h"
#include "stream/forestData.h"

#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/pi.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>

namespace OpenSubdivHex::BfrExt {

namespace internal {

/// The pyramid that a camera sees.
class ViewGeometry {
public:
    /// Whether the camera has a picture.  Of one that looks along what is up, that is replaced.
    bool Set(Camera &camera) {
        constexpr double kHalfTurn = 180;
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
        double const top = std::tan(camera.fieldOfView / 2 * FarExt::internal::kPi / kHalfTurn);
        double const side = top * camera.width / camera.height;
        // A point at depth 1 is outside from side or top on.
        for (std::size_t i = 0; i < 2; ++i) {
            Vector3 const &axis = i == 0 ? rightAxis : upAxis;
            double const slope = i == 0 ? side : top;
            double const scale = 1 / std::sqrt(1 + slope * slope);
            _planes[2 * i] = Scale(Subtract(axis, Scale(_forward, slope)), scale);
            _planes[2 * i + 1] = Scale(Subtract(Scale(axis, -1), Scale(_forward, slope)), scale);
        }
        _planes[4] = Scale(_forward, -1);
        _pixelsAtDepth1 = camera.height / (2 * top);
        _largestSecant = std::sqrt(1 + top * top + side * side);
        return std::isfinite(_pixelsAtDepth1) && std::isfinite(_largestSecant);
    }

    Vector3 const &GetEye() const { return _eye; }

    /// Whether a ball is outside of the picture, or behind the eye.
    bool IsOutside(Ball const &ball) const {
        Vector3 const d = Subtract(ball.center, _eye);
        return std::any_of(_planes.begin(), _planes.end(),
                           [&](Vector3 const &outwards) { return Dot(outwards, d) > ball.radius; });
    }

    /// Whether the hull of some points is outside.
    bool IsOutside(double const *points, std::size_t stride, int numPoints) const {
        return std::any_of(_planes.begin(), _planes.end(), [&](Vector3 const &outwards) {
            int i = 0;
            while (i < numPoints &&
                   Dot(outwards, Subtract(ToVector3(points + std::size_t(i) * stride), _eye)) > 0) {
                ++i;
            }
            return i == numPoints;
        });
    }

    /// \brief How many pixels long a line of length 1 in a ball is at most.
    ///
    /// A piece of it at depth z and distance r, so by an angle with the secant s = r/z away from the axis, has s/z times
    /// the pixels that it would have at depth 1: r/z^2 or s^2/r times these.
    double GetPixelsPerUnit(Ball const &ball) const {
        Vector3 const d = Subtract(ball.center, _eye);
        double const distance = GetLength(d);
        double const least = std::max(distance - ball.radius, 0.0);
        double const byDistance = _largestSecant * _largestSecant / least;
        double const depth = Dot(_forward, d) - ball.radius;
        if (!(depth > 0)) {
            return _pixelsAtDepth1 * byDistance;
        }
        double const secant = std::min((distance + ball.radius) / depth, _largestSecant);
        return _pixelsAtDepth1 * std::min(secant / depth, byDistance);
    }

private:
    Vector3 _eye = {};
    Vector3 _forward = {};
    std::array<Vector3, 5> _planes = {}; // through the eye, and the sides of the picture, outwards
    double _pixelsAtDepth1 = 0;
    double _largestSecant = 1; // of the angles between the axis and what is in the picture
};

/// A base face with its control points, of three numbers each.
class FaceToMeasure {
public:
    /// Sets it, the first three numbers of its points being read.
    template <typename REAL>
    void Set(BaseType const &type, REAL const *points, std::ptrdiff_t stride,
             std::size_t numPoints) {
        _type = type;
        _points.resize(3 * numPoints);
        for (std::size_t i = 0; i < _points.size(); i += 3, points += stride) {
            for (std::size_t k = 0; k < 3; ++k) {
                _points[i + k] = double(points[k]);
            }
        }
    }

    void SetCells(RefinedCells &cells) const {
        useType([&](auto const &type) { cells.SetBase(type, _points.data(), 3); });
    }
    void Sample(CellGrid &grid, std::vector<double> &samples) const {
        useType([&](auto const &type) { grid.Sample(type, _points.data(), samples); });
    }
    bool IsSharp() const { return _type.IsSharp(); }
    /// Whether the hull of its points is outside of the picture, which contains the surface.
    bool IsOutside(ViewGeometry const &geometry) const {
        return geometry.IsOutside(_points.data(), 3, int(_points.size() / 3));
    }

private:
    template <typename FUNCTION>
    void useType(FUNCTION const &function) const {
        if (PlainFaceType const *const plain = _type.GetPlain()) {
            function(*plain);
        } else {
            function(*_type);
        }
    }

    BaseType _type;
    std::vector<double> _points;
};

namespace {

/// \brief Refines one face.
///
/// Cells are measured together with their children where these are refined, from the base face on; the children of these
/// children where they are not expected to be flat.
class TreeMaker {
public:
    /// \param getBase   is called where something is not known
    /// \param measures  those of the face, which it adds to
    TreeMaker(ViewGeometry const &geometry, View::Options const &options,
              std::function<FaceToMeasure const &()> const &getBase, FaceMeasures &measures,
              CellTree const *previous, CellTree &tree, std::vector<CellVisibility> *visibility)
        : _geometry(geometry), _options(options), _getBase(getBase), _measures(measures),
          _previous(previous), _tree(tree), _visibility(visibility) {}

    void Make() {
        if (_measures.cells.empty()) {
            _measures.cells.emplace_back();
        }
        Node base = {nullptr, 0, true, true, 0};
        visit(base, 0, _previous ? 0 : -1);
    }

private:
    static constexpr std::size_t kNotMade = std::size_t(-1);

    /// A cell that is looked at.
    struct Node {
        Node *parent;
        int child; ///< which of that
        bool isWhole;
        bool isMeasuredFirst; ///< with its children; others with their parents
        std::size_t measures;
        std::size_t cell = kNotMade;
        double pixels = 0; ///< of a line of length 1
    };

    void visit(Node &node, int treeCell, int previousCell) {
        CellVisibility const found = _options.IsCulling() ? find(node) : CellVisibility::Visible;
        if (_visibility) {
            _visibility->resize(std::size_t(_tree.GetNumCells()));
            (*_visibility)[std::size_t(treeCell)] = found;
        }
        auto const getFraction = [&](int cell) {
            return cell >= 0 && _previous->IsRefined(cell) ? _options.GetHysteresis() : 1;
        };
        if (found != CellVisibility::Visible ||
            _tree.GetLevel(treeCell) >= _options.GetMaxLevel() ||
            !isTooLarge(node, getFraction(previousCell))) {
            return;
        }
        bool const wasRefined = previousCell >= 0 && _previous->IsRefined(previousCell);
        int const firstPrevious = wasRefined ? _previous->GetFirstChild(previousCell) : -1;
        int const first = _tree.Refine(treeCell);
        int const numChildren = getNumChildren(node);
        for (int i = 0; i < numChildren; ++i) {
            int const previousChild = wasRefined ? firstPrevious + i : -1;
            if (!node.isMeasuredFirst &&
                areChildrenExpectedToBeFlat(node, getFraction(previousChild))) {
                continue;
            }
            Node child = {&node, i, node.isWhole && i == 0, !node.isMeasuredFirst,
                          std::size_t(findChildren(node) + i)};
            bool const areMade = node.cell != kNotMade && _cells.HasChildren(node.cell);
            std::size_t const numCells = _cells.GetSize();
            visit(child, first + i, previousChild);
            if (areMade) {
                _cells.Drop(numCells); // what was made within the child
            }
        }
    }

    int getNumChildren(Node const &node) const {
        return node.isWhole ? _tree.GetFaceShape().GetNumSectors() + 1 : 4;
    }

    CellMeasures &getMeasures(Node const &node) { return _measures.cells[node.measures]; }

    int findChildren(Node const &node) {
        if (getMeasures(node).firstChild == 0) {
            getMeasures(node).firstChild = int(_measures.cells.size());
            _measures.cells.resize(_measures.cells.size() + std::size_t(getNumChildren(node)));
        }
        return getMeasures(node).firstChild;
    }

    std::size_t makeCell(Node &node) {
        if (node.cell == kNotMade && !node.parent) {
            _getBase().SetCells(_cells);
            node.cell = RefinedCells::kBase;
        } else if (node.cell == kNotMade) {
            node.cell = _cells.GetFirstChild(makeCell(*node.parent)) + std::size_t(node.child);
        }
        return node.cell;
    }

    CellMeasures const &measure(Node &node) {
        if (getMeasures(node).thickness >= 0) {
            return getMeasures(node);
        }
        if (!node.isMeasuredFirst) {
            sample(*node.parent);
            _grid->MeasureChildren(_samples, getMeasures(*node.parent), _isSharp,
                                   &_measures.cells[std::size_t(findChildren(*node.parent))]);
            return getMeasures(node);
        }
        sample(node);
        _grid->Measure(_samples, getMeasures(node));
        return getMeasures(node);
    }

    CellFacing const &findFacing(Node &node) {
        if (getMeasures(node).facing < 0) {
            sample(node.isMeasuredFirst ? node : *node.parent);
            CellFacing::Maker maker;
            _grid->AddPolygons(_samples, node.isMeasuredFirst ? 0 : 1 + node.child, maker);
            std::size_t const cell = makeCell(node);
            for (int corner = 0; corner < _cells[cell].GetType().GetNumCorners(); ++corner) {
                double du[3];
                double dv[3];
                _cells.EvaluateCorner(cell, corner, du, dv);
                maker.AddNormal(Cross(ToVector3(du), ToVector3(dv)));
            }
            getMeasures(node).facing = int(_measures.facings.size());
            _measures.facings.push_back(maker.Make());
        }
        return _measures.facings[std::size_t(getMeasures(node).facing)];
    }

    // Samples a cell before it is measured.
    void sample(Node &node) {
        if (_sampled == node.measures) {
            return;
        }
        _sampled = node.measures;
        _grid = &CellGrid::Get(node.isWhole ? _tree.GetFaceShape() : FaceShape());
        if (node.parent) {
            std::size_t const cell = makeCell(node);
            _isSharp = _cells[cell].GetType().IsSharp();
            _grid->Sample(_cells[cell], _samples);
        } else {
            _isSharp = _getBase().IsSharp();
            _getBase().Sample(*_grid, _samples);
        }
    }

    double findPixels(Node &node) {
        if (node.pixels == 0) {
            node.pixels = _geometry.GetPixelsPerUnit(measure(node).ball);
        }
        return node.pixels;
    }

    // Whole faces, which may be folded, never face away, and are outside where their edges are.
    CellVisibility find(Node &node) {
        if (!node.parent) {
            return _getBase().IsOutside(_geometry) ? CellVisibility::Outside
                                                   : CellVisibility::Visible;
        }
        if (_geometry.IsOutside(measure(node).ball)) {
            return CellVisibility::Outside;
        }
        return findFacing(node).IsBackFacing(_geometry.GetEye()) ? CellVisibility::BackFacing
                                                                 : CellVisibility::Visible;
    }

    // Whether children need not be measured, which are with their own.
    bool areChildrenExpectedToBeFlat(Node &node, double fraction) {
        return !(_options.GetEdgeLength() > 0) &&
               measure(node).childThickness * findPixels(node) <= fraction * _options.GetFlatness();
    }

    bool isTooLarge(Node &node, double fraction) {
        double const pixels = findPixels(node);
        return (_options.GetEdgeLength() > 0 &&
                measure(node).longestSide * pixels > fraction * _options.GetEdgeLength()) ||
               (_options.GetFlatness() > 0 &&
                measure(node).thickness * pixels > fraction * _options.GetFlatness());
    }

    ViewGeometry const &_geometry;
    View::Options const &_options;
    std::function<FaceToMeasure const &()> const &_getBase;
    FaceMeasures &_measures;
    CellTree const *const _previous;
    CellTree &_tree;
    std::vector<CellVisibility> *const _visibility;
    CellGrid *_grid = nullptr; // of the cell that was sampled last
    std::size_t _sampled = std::size_t(-1);
    bool _isSharp = false; // whether something sharp is near that
    RefinedCells &_cells = getCellsOfThread();
    std::vector<double> &_samples = getSamplesOfThread();

    // Their memory is kept for the next face.
    static RefinedCells &getCellsOfThread() {
        static thread_local RefinedCells cells;
        return cells;
    }
    static std::vector<double> &getSamplesOfThread() {
        static thread_local std::vector<double> samples;
        return samples;
    }
};

/// A ball around some points.
Ball findBall(double const *points, std::size_t stride, int numPoints) {
    auto const forEach = [&](auto const &function) {
        double const *point = points;
        for (int i = 0; i < numPoints; ++i, point += stride) {
            function(ToVector3(point));
        }
    };
    Ball ball;
    forEach([&](Vector3 const &point) { ball.center = Add(ball.center, point); });
    ball.center = Scale(ball.center, 1.0 / numPoints);
    double square = 0;
    forEach([&](Vector3 const &point) {
        Vector3 const d = Subtract(point, ball.center);
        square = std::max(square, Dot(d, d));
    });
    ball.radius = std::sqrt(square);
    return ball;
}

/// \brief Refines an edge, whose points depend on its curve alone.
///
/// Places are those of the edge in its own direction; parts of it may run the other way.
class EdgeMaker {
public:
    /// \param previous  what the edge was in the last frame, in its own direction
    EdgeMaker(ViewGeometry const &geometry, View::Options const &options, Polyline const &previous)
        : _geometry(geometry), _options(options), _previous(previous) {}

    /// The places inside of the edge, ascending.
    std::vector<Polyline::Place> Make(CellValues const &values) {
        visit(values, 0, Polyline::kLength);
        std::sort(_places.begin(), _places.end());
        return std::move(_places);
    }

private:
    // Adds the places inside of a part, which lie between start and end.
    void visit(CellValues const &values, int start, int end) {
        if (values.GetLevel() >= _options.GetMaxLevel() ||
            (_options.IsCulling() && _geometry.IsOutside(values.GetPoint(0), values.GetPaddedSize(),
                                                         values.GetNumPoints()))) {
            return;
        }
        std::vector<CellType::Child> const &children = values.GetType().GetChildren();
        std::vector<CellValues> parts(children.size());
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i].SetChild(values, int(i));
        }
        if (parts.size() == 1) {
            visit(parts[0], start, end); // the long edge that it becomes
            return;
        }
        int const first = start + (end - start) / 4;
        int const second = end - (end - start) / 4;
        Ball const ball =
            findBall(values.GetPoint(0), values.GetPaddedSize(), values.GetNumPoints());
        if (!isToDivide(values, parts, _geometry.GetPixelsPerUnit(ball),
                        wasDividedAt(first) ? _options.GetHysteresis() : 1)) {
            return;
        }
        _places.push_back(Polyline::Place(first));
        _places.push_back(Polyline::Place(second));
        visit(parts[0], start, first);
        visit(parts[1], first, second);
        visit(parts[2], end, second); // it runs from the end
    }

    // No part has a place of another one inside.
    bool wasDividedAt(int place) const {
        std::vector<Polyline::Place> const &places = _previous.GetPlaces();
        return std::binary_search(places.begin(), places.end(), place);
    }

    bool isToDivide(CellValues const &values, std::vector<CellValues> const &parts, double pixels,
                    double fraction) const {
        double ends[6];
        values.EvaluateCorner(0, ends);
        values.EvaluateCorner(1, ends + 3);
        Vector3 const along = Subtract(ToVector3(ends + 3), ToVector3(ends));
        double const length = GetLength(along);
        if (_options.GetEdgeLength() > 0 && length * pixels > fraction * _options.GetEdgeLength()) {
            return true;
        }
        // At a quarter of a curve that bends evenly, where parts meet, it has three quarters of its distance.
        constexpr double kFactor = 1.5;
        auto const isFar = [&](CellValues const &part) {
            double point[3];
            part.EvaluateCorner(1, point);
            Vector3 const d = Subtract(ToVector3(point), ToVector3(ends));
            double const distance = length > 0 ? GetLength(Cross(along, d)) / length : GetLength(d);
            return kFactor * distance * pixels > fraction * _options.GetFlatness();
        };
        return _options.GetFlatness() > 0 && (isFar(parts[0]) || isFar(parts[1]));
    }

    ViewGeometry const &_geometry;
    View::Options const &_options;
    Polyline const &_previous;
    std::vector<Polyline::Place> _places;
};

} // namespace

/// The data of a View.
struct ViewData {
    Camera camera;
    View::Options options;
    ViewGeometry geometry; ///< of a valid one
    bool isValid = false;
};

namespace {

// Refines a tree of one cell.
void refineTree(ViewData const &view, CellTree &tree,
                std::function<FaceToMeasure const &()> const &getBase, FaceMeasures &measures,
                CellTree const *previous, std::vector<CellVisibility> *visibility) {
    if (visibility) {
        visibility->clear();
    }
    if (view.isValid) {
        bool const hasPrevious = previous && previous->GetFaceShape() == tree.GetFaceShape();
        TreeMaker(view.geometry, view.options, getBase, measures, hasPrevious ? previous : nullptr,
                  tree, visibility)
            .Make();
    }
    if (visibility) {
        visibility->resize(std::size_t(tree.GetNumCells()));
    }
}

// The surface of one face after the other, with its control points.
template <typename REAL>
class FaceSurface {
public:
    FaceSurface(SurfaceFactory const &factory, REAL const *meshPoints, std::ptrdiff_t stride)
        : _factory(factory), _meshPoints(meshPoints), _stride(stride) {}

    // Whether there is one.
    bool Init(Far::Index face) {
        if (face != _face) {
            _face = face;
            _surface.Clear();
            if (_factory.TryInit(face, FarExt::Interpolation::Vertex, -1, _surface).IsOk()) {
                auto const numPoints = std::size_t(_surface.GetNumControlPoints());
                _points.resize(3 * numPoints);
                _surface.GatherControlPoints(_meshPoints, {3, int(_stride)}, _points.data(), 3);
                _base.Set(_surface.GetFace().type, _points.data(), 3, numPoints);
            }
        }
        return _surface.IsValid();
    }
    Surface<REAL> const &Get() const { return _surface; }
    REAL const *GetControlPoints() const { return _points.data(); }
    FaceToMeasure const &GetBase() const { return _base; }

private:
    SurfaceFactory const &_factory;
    REAL const *const _meshPoints;
    std::ptrdiff_t const _stride;
    Far::Index _face = Far::INDEX_INVALID;
    Surface<REAL> _surface;
    std::vector<REAL> _points;
    FaceToMeasure _base;
};

// View::MakeEdge().
template <typename REAL>
Polyline makeEdge(ViewData const &view, Surface<REAL> const &surface, int edge,
                  REAL const *controlPoints, std::ptrdiff_t stride, Polyline const *previous) {
    if (!view.isValid) {
        return Polyline();
    }
    CellType::BorderItem const &item =
        surface.GetFace().type->GetBorderItem(surface.GetFace().GetTurns(), std::size_t(edge));
    std::vector<double> points;
    for (int const point : item.points) {
        REAL const *const from = controlPoints + std::ptrdiff_t(point) * stride;
        points.insert(points.end(), from, from + 3);
    }
    CellValues values;
    values.SetBase(*item.type, points.data(), 3);
    Polyline last; // in the direction of the item
    if (previous) {
        last = item.isReversed ? previous->GetReversed() : *previous;
    }
    Polyline polyline;
    Polyline::FromPlaces(EdgeMaker(view.geometry, view.options, last).Make(values), &polyline);
    return item.isReversed ? polyline.GetReversed() : polyline;
}

// Counts the cells of a forest that are not refined.
View::Counts countCells(ForestData const &forest, int maxLevel,
                        std::vector<std::vector<CellVisibility>> const &visibility) {
    View::Counts counts;
    counts.cellsByLevel.assign(std::size_t(maxLevel) + 1, 0);
    for (std::size_t face = 0; face < visibility.size(); ++face) {
        CellTree const &tree = forest.trees[face];
        std::vector<CellVisibility> const &found = visibility[face];
        for (std::size_t cell = 0; cell < found.size(); ++cell) {
            if (!tree.IsRefined(int(cell))) {
                ++counts.cellsByLevel[std::size_t(tree.GetLevel(int(cell)))];
                counts.outside += found[cell] == CellVisibility::Outside;
                counts.backFacing += found[cell] == CellVisibility::BackFacing;
            }
        }
    }
    return counts;
}

// View::MakeForest().
template <typename REAL>
CellForest makeForest(ViewData const &view, SurfaceFactory const &factory, BoundsData *bounds,
                      REAL const *meshPoints, std::ptrdiff_t stride, CellForest const *previous,
                      View::Counts *counts, FarExt::CallStatus *status) {
    using Index = Far::Index;
    FarExt::SurfaceFaces const &faces = factory.GetFaces();
    // Diagonals between surface faces are infinitely sharp.
    auto const isInfSharp = [&](Index edge) {
        return edge >= factory.GetLevel().GetNumEdges() || factory.GetLevel().IsEdgeInfSharp(edge);
    };
    CellForest result(factory.GetMesh());
    ForestData &forest = result.GetData();
    ForestData const *const last = previous && previous->GetNumFaces() == forest.GetNumFaces()
                                       ? &previous->GetData()
                                       : nullptr;
    bool const hasLastEdges = last && last->edges.size() == forest.edges.size();
    std::vector<std::vector<CellVisibility>> visibility(counts ? std::size_t(forest.GetNumFaces())
                                                               : 0);
    // A tree grows in the memory of the last one, and is kept in no more than it takes.
    struct State {
        FaceSurface<REAL> surface;
        FaceMeasures measures;
        CellTree tree;
    };
    constexpr int kTriangle = 3;
    std::atomic<Index> firstWithout = forest.GetNumFaces(); // without a surface
    constexpr Index kFacesOfRange = 16;
    FarExt::internal::ParallelForRange(
        forest.GetNumFaces(),
        [&] {
            return State{{factory, meshPoints, stride}, {}, CellTree(kTriangle)};
        },
        [&](State &state, Index begin, Index end) {
            for (Index face = begin; face < end; ++face) {
                state.measures.Clear();
                FaceMeasures &measures = bounds ? bounds->faces[std::size_t(face)] : state.measures;
                if (measures.cells.empty() && !state.surface.Init(face)) {
                    Index first = firstWithout;
                    while (!faces.IsHole(face) && face < first &&
                           !firstWithout.compare_exchange_weak(first, face)) {
                    }
                    continue;
                }
                std::size_t const memory = measures.GetMemory();
                auto const getBase = [&]() -> FaceToMeasure const & {
                    state.surface.Init(face);
                    return state.surface.GetBase();
                };
                CellTree &tree = forest.trees[std::size_t(face)];
                state.tree = tree;
                refineTree(view, state.tree, std::cref(getBase), measures,
                           last ? &last->GetTree(face) : nullptr,
                           counts ? &visibility[std::size_t(face)] : nullptr);
                if (state.tree.IsRefined(0)) {
                    tree = state.tree;
                }
                if (bounds) {
                    bounds->Trim(face, memory);
                }
                for (int local = 0; local < tree.GetFaceSize(); ++local) {
                    auto const [edge, isReversed] = faces.GetEdge(face, local);
                    // The first of its faces that has a surface makes an edge, since holes have none.
                    if (!isInfSharp(edge) ||
                        (isReversed && factory.FaceHasLimitSurface(faces.GetSide(edge, 0).face)) ||
                        !state.surface.Init(face)) {
                        continue;
                    }
                    Polyline lastEdge; // empty where there is none
                    if (hasLastEdges) {
                        Polyline const &ofEdge = last->edges[std::size_t(edge)];
                        lastEdge = isReversed ? ofEdge.GetReversed() : ofEdge;
                    }
                    Polyline made = makeEdge(view, state.surface.Get(), local,
                                             state.surface.GetControlPoints(), 3, &lastEdge);
                    forest.edges[std::size_t(edge)] =
                        isReversed ? made.GetReversed() : std::move(made);
                }
            }
        },
        kFacesOfRange);
    result.MatchEdges();
    if (status && !view.isValid) {
        *status = FarExt::internal::Failure(
            FarExt::StatusCode::InvalidArgument,
            "the view is invalid: its camera has no picture, or an option is out of range");
    } else if (status) {
        Surface<REAL> none;
        *status = firstWithout < forest.GetNumFaces()
                      ? factory.TryInit(firstWithout, FarExt::Interpolation::Vertex, -1, none)
                      : FarExt::CallStatus();
    }
    if (counts) {
        *counts = countCells(forest, view.isValid ? view.options.GetMaxLevel() : 0, visibility);
    }
    return result;
}

} // namespace

} // namespace internal

View::View(Camera const &camera, Options options) {
    auto const isNumber = [](double number) { return std::isfinite(number) && number >= 0; };
    auto data = std::make_shared<internal::ViewData>();
    data->camera = camera;
    data->options = options;
    bool const hasAim = options.GetFlatness() > 0 || options.GetEdgeLength() > 0;
    data->isValid = data->geometry.Set(data->camera) && hasAim && isNumber(options.GetFlatness()) &&
                    isNumber(options.GetEdgeLength()) && isNumber(options.GetHysteresis()) &&
                    options.GetHysteresis() <= 1 && options.GetMaxLevel() >= 0 &&
                    options.GetMaxLevel() <= CellTree::kLastLevel;
    _data = std::move(data);
}

bool View::IsValid() const { return _data->isValid; }

Camera const &View::GetCamera() const { return _data->camera; }

View::Options const &View::GetOptions() const { return _data->options; }

template <typename REAL>
CellTree View::MakeTree(Surface<REAL> const &surface, REAL const controlPoints[],
                        typename Surface<REAL>::PointDescriptor const &pointDesc,
                        CellTree const *previous, std::vector<CellVisibility> *visibility) const {
    internal::FaceMeasures measures;
    internal::FaceToMeasure base;
    base.Set(surface.GetFace().type, controlPoints, pointDesc.stride,
             std::size_t(surface.GetNumControlPoints()));
    CellTree tree(surface.GetFaceShape());
    internal::refineTree(
        *_data, tree, [&]() -> internal::FaceToMeasure const & { return base; }, measures, previous,
        visibility);
    return tree;
}

template <typename REAL>
Polyline View::MakeEdge(Surface<REAL> const &surface, int edge, REAL const controlPoints[],
                        typename Surface<REAL>::PointDescriptor const &pointDesc,
                        Polyline const *previous) const {
    return internal::makeEdge(*_data, surface, edge, controlPoints, pointDesc.stride, previous);
}

template <typename REAL>
int View::FindLevels(Surface<REAL> const &surface, REAL const controlPoints[],
                     typename Surface<REAL>::PointDescriptor const &pointDesc, int levels[]) const {
    CellTree const tree = MakeTree(surface, controlPoints, pointDesc);
    int const size = surface.GetFaceSize();
    std::fill(levels, levels + size, 0);
    for (int cell = 1; cell < tree.GetNumCells(); ++cell) {
        auto const addLevel = [&](int edge) {
            levels[edge] = std::max(levels[edge], tree.GetLevel(cell));
        };
        if (tree.GetBorderSide(cell) >= 0) {
            addLevel(tree.GetEdge(cell));
        }
        if (tree.GetLongEdgeSide(cell) >= 0) {
            addLevel(0);
        }
    }
    levels[size] = tree.GetMaxLevel();
    return size + 1;
}

template <typename REAL>
CellForest View::MakeForest(SurfaceFactory const &factory, REAL const meshPoints[],
                            typename Surface<REAL>::PointDescriptor const &pointDesc,
                            CellForest const *previous, Counts *counts,
                            FarExt::CallStatus *status) const {
    return internal::makeForest(*_data, factory, nullptr, meshPoints, pointDesc.stride, previous,
                                counts, status);
}

template <typename REAL>
CellForest View::MakeForest(ViewBounds &bounds, REAL const meshPoints[],
                            typename Surface<REAL>::PointDescriptor const &pointDesc,
                            CellForest const *previous, Counts *counts,
                            FarExt::CallStatus *status) const {
    internal::BoundsData &data = bounds.GetData();
    data.SetPoints(meshPoints, pointDesc.stride);
    return internal::makeForest(*_data, data.factory, &data, meshPoints, pointDesc.stride, previous,
                                counts, status);
}

template CellTree View::MakeTree(Surface<float> const &, float const[],
                                 Surface<float>::PointDescriptor const &, CellTree const *,
                                 std::vector<CellVisibility> *) const;
template CellTree View::MakeTree(Surface<double> const &, double const[],
                                 Surface<double>::PointDescriptor const &, CellTree const *,
                                 std::vector<CellVisibility> *) const;
template Polyline View::MakeEdge(Surface<float> const &, int, float const[],
                                 Surface<float>::PointDescriptor const &, Polyline const *) const;
template Polyline View::MakeEdge(Surface<double> const &, int, double const[],
                                 Surface<double>::PointDescriptor const &, Polyline const *) const;
template int View::FindLevels(Surface<float> const &, float const[],
                              Surface<float>::PointDescriptor const &, int[]) const;
template int View::FindLevels(Surface<double> const &, double const[],
                              Surface<double>::PointDescriptor const &, int[]) const;
template CellForest View::MakeForest(SurfaceFactory const &, float const[],
                                     Surface<float>::PointDescriptor const &, CellForest const *,
                                     Counts *, FarExt::CallStatus *) const;
template CellForest View::MakeForest(ViewBounds &, float const[],
                                     Surface<float>::PointDescriptor const &, CellForest const *,
                                     Counts *, FarExt::CallStatus *) const;
template CellForest View::MakeForest(SurfaceFactory const &, double const[],
                                     Surface<double>::PointDescriptor const &, CellForest const *,
                                     Counts *, FarExt::CallStatus *) const;
template CellForest View::MakeForest(ViewBounds &, double const[],
                                     Surface<double>::PointDescriptor const &, CellForest const *,
                                     Counts *, FarExt::CallStatus *) const;

} // namespace OpenSubdivHex::BfrExt

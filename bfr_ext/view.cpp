// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include "cell/baseType.h"
#include "cell/cellMeasures.h"

#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/pi.h"

#include <algorithm>
#include <array>
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
            _planes[2 * i] = Subtract(axis, Scale(_forward, slope));
            _planes[2 * i + 1] = Subtract(Scale(axis, -1), Scale(_forward, slope));
        }
        _pixelsAtDepth1 = camera.height / (2 * top);
        _largestSecant = std::sqrt(1 + top * top + side * side);
        return std::isfinite(_pixelsAtDepth1) && std::isfinite(_largestSecant);
    }

    Vector3 const &GetEye() const { return _eye; }

    /// Whether a box is outside of the picture, or behind the eye.
    bool IsOutside(Box const &box) const {
        Vector3 const toLeast = Subtract(box.least, _eye);
        Vector3 const toLargest = Subtract(box.largest, _eye);
        auto const isBeyond = [&](Vector3 const &outwards) {
            return getLeast(outwards, toLeast, toLargest) > 0;
        };
        return std::any_of(std::begin(_planes), std::end(_planes), isBeyond) ||
               isBeyond(Scale(_forward, -1));
    }

    /// \brief How many pixels long a line of length 1 in a box is at most.
    ///
    /// A piece of it at depth z, and by an angle with the secant s away from the axis, has s/z times the
    /// pixels that it would have at depth 1.  Or, at distance r = s z, s^2/r times these.  Secants are largest
    /// at corners of the box, since places where they are no larger than a number are a convex cone.
    double GetPixelsPerUnit(Box const &box) const {
        Vector3 const toLeast = Subtract(box.least, _eye);
        Vector3 const toLargest = Subtract(box.largest, _eye);
        Vector3 nearest;
        for (std::size_t k = 0; k < 3; ++k) {
            nearest[k] = std::max({toLeast[k], -toLargest[k], 0.0});
        }
        double const byDistance = _largestSecant * _largestSecant / GetLength(nearest);
        double const leastDepth = getLeast(_forward, toLeast, toLargest);
        if (!(leastDepth > 0)) {
            return _pixelsAtDepth1 * byDistance;
        }
        // Contributions of each axis to the depth and to the square of the distance, at either end.
        Vector3 depths[2];
        Vector3 squares[2];
        for (std::size_t k = 0; k < 3; ++k) {
            depths[0][k] = _forward[k] * toLeast[k];
            depths[1][k] = _forward[k] * toLargest[k];
            squares[0][k] = toLeast[k] * toLeast[k];
            squares[1][k] = toLargest[k] * toLargest[k];
        }
        constexpr unsigned kNumCorners = 8;
        double ofCorners[kNumCorners]; // squares of secants
        for (unsigned corner = 0; corner < kNumCorners; ++corner) {
            unsigned const ends[3] = {corner & 1U, corner >> 1U & 1U, corner >> 2U};
            double const depth = depths[ends[0]][0] + depths[ends[1]][1] + depths[ends[2]][2];
            double const square = squares[ends[0]][0] + squares[ends[1]][1] + squares[ends[2]][2];
            ofCorners[corner] = square / (depth * depth);
        }
        double const largestSquare =
            std::max(1.0, *std::max_element(std::begin(ofCorners), std::end(ofCorners)));
        double const byDepth = std::min(std::sqrt(largestSquare), _largestSecant) / leastDepth;
        return _pixelsAtDepth1 * std::min(byDepth, byDistance);
    }

private:
    // The least product with a direction, of all places of a box.
    static double getLeast(Vector3 const &direction, Vector3 const &least, Vector3 const &largest) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            sum += std::min(direction[k] * least[k], direction[k] * largest[k]);
        }
        return sum;
    }

    Vector3 _eye = {};
    Vector3 _forward = {};
    std::array<Vector3, 4> _planes = {}; // through the eye and the sides of the picture, outwards
    double _pixelsAtDepth1 = 0;
    double _largestSecant = 1; // of the angles between the axis and what is in the picture
};

namespace {

/// The box of a cell's points.
Box getBox(CellValues const &values) {
    Box box;
    for (int i = 0; i < values.GetNumPoints(); ++i) {
        box.Add(values.GetPoint(i));
    }
    return box;
}

/// Writes the cell of a base face.
using SetBase = std::function<void(RefinedCells &)>;

/// \brief Refines one face.
///
/// Cells are made where something is asked of them that is not known yet.
class TreeMaker {
public:
    /// \param setBase   is called once at most
    /// \param measures  those of the face, which it adds to
    TreeMaker(ViewGeometry const &geometry, View::Options const &options, SetBase const &setBase,
              FaceMeasures &measures, CellTree const *previous, CellTree &tree,
              std::vector<CellVisibility> *visibility)
        : _geometry(geometry), _options(options), _setBase(setBase), _measures(measures),
          _previous(previous), _tree(tree), _visibility(visibility) {}

    void Make() {
        if (_measures.cells.empty()) {
            _measures.cells.emplace_back();
        }
        Node base = {nullptr, 0, true, 0};
        visit(base, 0, _previous ? 0 : -1);
    }

private:
    static constexpr std::size_t kNotMade = std::size_t(-1);

    /// A cell that is looked at.
    struct Node {
        Node *parent;
        int child; ///< which of that
        bool isWhole;
        std::size_t measures;
        std::size_t cell = kNotMade;
    };

    void visit(Node &node, int treeCell, int previousCell) {
        CellVisibility const found = find(node);
        if (_visibility) {
            _visibility->resize(std::size_t(_tree.GetNumCells()));
            (*_visibility)[std::size_t(treeCell)] = found;
        }
        if (found != CellVisibility::Visible ||
            _tree.GetLevel(treeCell) >= _options.GetMaxLevel()) {
            return;
        }
        bool const wasRefined = previousCell >= 0 && _previous->IsRefined(previousCell);
        if (!isToRefine(node, wasRefined ? _options.GetHysteresis() : 1)) {
            return;
        }
        int const first = _tree.Refine(treeCell);
        int const numChildren = getNumChildren(node);
        for (int i = 0; i < numChildren; ++i) {
            Node child = makeChild(node, i);
            bool const areMade = node.cell != kNotMade && _cells.HasChildren(node.cell);
            std::size_t const numCells = _cells.GetSize();
            visit(child, first + i, wasRefined ? _previous->GetFirstChild(previousCell) + i : -1);
            if (areMade) {
                _cells.Drop(numCells); // what was made within the child
            }
        }
    }

    int getNumChildren(Node const &node) const {
        return node.isWhole ? _tree.GetFaceSize() + 1 : 4;
    }

    Node makeChild(Node &parent, int child) {
        int first = getMeasures(parent).firstChild;
        if (first == 0) {
            first = int(_measures.cells.size());
            getMeasures(parent).firstChild = first;
            _measures.cells.resize(_measures.cells.size() + std::size_t(getNumChildren(parent)));
        }
        return {&parent, child, parent.isWhole && child == 0, std::size_t(first + child)};
    }

    CellMeasures &getMeasures(Node const &node) { return _measures.cells[node.measures]; }

    std::size_t makeCell(Node &node) {
        if (node.cell == kNotMade && !node.parent) {
            _setBase(_cells);
            node.cell = RefinedCells::kBase;
        } else if (node.cell == kNotMade) {
            node.cell = _cells.GetFirstChild(makeCell(*node.parent)) + std::size_t(node.child);
        }
        return node.cell;
    }

    CellValues const &makeValues(Node &node) { return _cells[makeCell(node)]; }

    Box const &findBox(Node &node) {
        if (!getMeasures(node).box.HasPoints()) {
            Box const box = getBox(makeValues(node));
            getMeasures(node).box = box;
        }
        return getMeasures(node).box;
    }

    CellVisibility find(Node &node) {
        if (!_options.IsCulling()) {
            return CellVisibility::Visible;
        }
        if (_geometry.IsOutside(findBox(node))) {
            return CellVisibility::Outside;
        }
        return findFacing(node).IsBackFacing(_geometry.GetEye()) ? CellVisibility::BackFacing
                                                                 : CellVisibility::Visible;
    }

    CellFacing const &findFacing(Node &node) {
        if (getMeasures(node).facing < 0) {
            // Needles may be folded inside of a face.
            int const numSteps = node.parent ? 2 : 3;
            CellFacing::Maker maker;
            addPolygons(makeCell(node), numSteps, maker);
            for (int corner = 0; corner < getNumCorners(makeCell(node)); ++corner) {
                double du[3];
                double dv[3];
                _cells.EvaluateCorner(makeCell(node), corner, du, dv);
                maker.AddNormal(Cross(ToVector3(du), ToVector3(dv)));
            }
            getMeasures(node).facing = int(_measures.facings.size());
            _measures.facings.push_back(maker.Make());
        }
        return _measures.facings[std::size_t(getMeasures(node).facing)];
    }

    // Adds those of the cells that some steps make of a cell.
    void addPolygons(std::size_t cell, int numSteps, CellFacing::Maker &maker) {
        if (numSteps == 0) {
            findCorners(cell);
            maker.Add(_corners);
            return;
        }
        std::size_t const first = _cells.GetFirstChild(cell);
        for (int i = 0; i < _cells.GetNumChildren(cell); ++i) {
            addPolygons(first + std::size_t(i), numSteps - 1, maker);
        }
    }

    int getNumCorners(std::size_t cell) const {
        CellValues const &values = _cells[cell];
        return values.IsPlainBase() ? values.GetNumChildren() - 1
                                    : values.GetType().GetNumCorners();
    }

    void findCorners(std::size_t cell) {
        int const numCorners = getNumCorners(cell);
        _corners.resize(3 * std::size_t(numCorners));
        for (int i = 0; i < numCorners; ++i) {
            _cells.EvaluateCorner(cell, i, &_corners[3 * std::size_t(i)]);
        }
    }

    bool isToRefine(Node &node, double fraction) {
        double const pixels = _geometry.GetPixelsPerUnit(findBox(node));
        if (_options.GetEdgeLength() > 0 &&
            findLongestSide(node) * pixels > fraction * _options.GetEdgeLength()) {
            return true;
        }
        return _options.GetFlatness() > 0 &&
               findThickness(node) * pixels > fraction * _options.GetFlatness();
    }

    double findLongestSide(Node &node) {
        if (getMeasures(node).longestSide < 0) {
            findCorners(makeCell(node));
            double longest = 0;
            for (std::size_t i = 0; i < _corners.size(); i += 3) {
                std::size_t const next = i + 3 < _corners.size() ? i + 3 : 0;
                Vector3 const side = Subtract(ToVector3(&_corners[next]), ToVector3(&_corners[i]));
                longest = std::max(longest, GetLength(side));
            }
            getMeasures(node).longestSide = longest;
        }
        return getMeasures(node).longestSide;
    }

    double findThickness(Node &node) {
        if (getMeasures(node).thickness < 0) {
            findCorners(makeCell(node));
            double const thickness = _flatness.FindThickness(_cells, node.cell, _corners);
            getMeasures(node).thickness = thickness;
        }
        return getMeasures(node).thickness;
    }

    ViewGeometry const &_geometry;
    View::Options const &_options;
    SetBase const &_setBase;
    FaceMeasures &_measures;
    CellTree const *const _previous;
    CellTree &_tree;
    std::vector<CellVisibility> *const _visibility;
    RefinedCells &_cells = getCellsOfThread();
    std::vector<double> _corners; // of the surface, of the cell that is looked at
    Flatness _flatness;

    // Their memory is kept for the next face.
    static RefinedCells &getCellsOfThread() {
        static thread_local RefinedCells cells;
        return cells;
    }
};

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
        Box const box = getBox(values);
        if (values.GetLevel() >= _options.GetMaxLevel() ||
            (_options.IsCulling() && _geometry.IsOutside(box))) {
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
        if (!isToDivide(values, parts, _geometry.GetPixelsPerUnit(box),
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
        double const length = GetLength(Subtract(ToVector3(ends + 3), ToVector3(ends)));
        return (_options.GetEdgeLength() > 0 &&
                length * pixels > fraction * _options.GetEdgeLength()) ||
               (_options.GetFlatness() > 0 &&
                !IsStraight(parts, ends, ends + 3, fraction * _options.GetFlatness() / pixels));
    }

    ViewGeometry const &_geometry;
    View::Options const &_options;
    Polyline const &_previous;
    std::vector<Polyline::Place> _places;
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
    internal::FaceMeasures measures;
    return makeTree(
        surface.GetFaceSize(),
        [&](internal::RefinedCells &cells) {
            setBase(surface, controlPoints, pointDesc.stride, cells);
        },
        measures, previous, visibility);
}

template <typename REAL>
void View::setBase(Surface<REAL> const &surface, REAL const *controlPoints, std::ptrdiff_t stride,
                   internal::RefinedCells &cells) {
    std::vector<double> const points =
        gather(controlPoints, stride, std::size_t(surface.GetNumControlPoints()));
    if (internal::PlainFaceType const *const plain = surface.GetFace().type.GetPlain()) {
        cells.SetBase(*plain, points.data(), 3);
    } else {
        cells.SetBase(*surface.GetFace().type, points.data(), 3);
    }
}

CellTree View::makeTree(int faceSize, std::function<void(internal::RefinedCells &)> const &setBase,
                        internal::FaceMeasures &measures, CellTree const *previous,
                        std::vector<CellVisibility> *visibility) const {
    CellTree tree(faceSize);
    if (visibility) {
        visibility->clear();
    }
    if (IsValid()) {
        bool const hasPrevious = previous && previous->GetFaceSize() == faceSize;
        internal::TreeMaker(*_geometry, _options, setBase, measures,
                            hasPrevious ? previous : nullptr, tree, visibility)
            .Make();
    }
    if (visibility) {
        visibility->resize(std::size_t(tree.GetNumCells()));
    }
    return tree;
}

template <typename REAL>
Polyline View::MakeEdge(Surface<REAL> const &surface, int edge, REAL const controlPoints[],
                        typename Surface<REAL>::PointDescriptor const &pointDesc,
                        Polyline const *previous) const {
    if (!IsValid()) {
        return Polyline();
    }
    internal::CellType::BorderItem const &item =
        surface.GetFace().type->GetBorderItem(surface.GetFace().GetTurns(), std::size_t(edge));
    std::vector<double> points;
    for (int const point : item.points) {
        REAL const *const from = controlPoints + std::ptrdiff_t(point) * pointDesc.stride;
        points.insert(points.end(), from, from + 3);
    }
    internal::CellValues values;
    values.SetBase(*item.type, points.data(), 3);
    Polyline last; // in the direction of the item
    if (previous) {
        last = item.isReversed ? previous->GetReversed() : *previous;
    }
    Polyline polyline;
    Polyline::FromPlaces(internal::EdgeMaker(*_geometry, _options, last).Make(values), &polyline);
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
    return makeForest(factory, nullptr, meshPoints, pointDesc.stride, previous, counts);
}

template <typename REAL>
CellForest View::MakeForest(ViewBounds &bounds, REAL const meshPoints[],
                            typename Surface<REAL>::PointDescriptor const &pointDesc,
                            CellForest const *previous, Counts *counts) const {
    bounds.setPoints(meshPoints, pointDesc.stride);
    return makeForest(bounds.GetFactory(), &bounds, meshPoints, pointDesc.stride, previous, counts);
}

// The surface of one face after the other, with its control points.
template <typename REAL>
class View::FaceSurface {
public:
    FaceSurface(SurfaceFactory const &factory, REAL const *meshPoints, std::ptrdiff_t stride)
        : _factory(factory), _meshPoints(meshPoints), _stride(stride) {}

    // Whether there is one.
    bool Init(Index face) {
        if (face != _face) {
            _face = face;
            _surface.Clear();
            if (_factory.TryInit(face, FarExt::Interpolation::Vertex, -1, _surface).IsOk()) {
                _points.resize(3 * std::size_t(_surface.GetNumControlPoints()));
                _surface.GatherControlPoints(_meshPoints, {3, int(_stride)}, _points.data(), 3);
            }
        }
        return _surface.IsValid();
    }
    Surface<REAL> const &Get() const { return _surface; }
    REAL const *GetControlPoints() const { return _points.data(); }

private:
    SurfaceFactory const &_factory;
    REAL const *const _meshPoints;
    std::ptrdiff_t const _stride;
    Index _face = Far::INDEX_INVALID;
    Surface<REAL> _surface;
    std::vector<REAL> _points;
};

template <typename REAL>
CellForest View::makeForest(SurfaceFactory const &factory, ViewBounds *bounds,
                            REAL const *meshPoints, std::ptrdiff_t stride,
                            CellForest const *previous, Counts *counts) const {
    using FarExt::internal::Level;
    FarExt::TopologyLevel const base = factory.GetLevel();
    Level const &level = factory.GetLevel().GetLevel();
    CellForest forest(factory.GetMesh());
    forest._plans = bounds ? bounds->_plans : nullptr;
    bool const hasPrevious = previous && previous->GetNumFaces() == forest.GetNumFaces();
    bool const hasPreviousEdges = hasPrevious && previous->_edges.size() == forest._edges.size();
    std::vector<std::vector<CellVisibility>> visibility(counts ? std::size_t(forest.GetNumFaces())
                                                               : 0);
    struct State {
        FaceSurface<REAL> surface;
        internal::FaceMeasures measures;
    };
    constexpr Index kFacesOfRange = 16;
    FarExt::internal::ParallelForRange(
        forest.GetNumFaces(),
        [&] {
            return State{{factory, meshPoints, stride}, {}};
        },
        [&](State &state, Index begin, Index end) {
            for (Index face = begin; face < end; ++face) {
                state.measures.Clear();
                internal::FaceMeasures &measures =
                    bounds ? bounds->_measures->faces[std::size_t(face)] : state.measures;
                if (measures.cells.empty() && !state.surface.Init(face)) {
                    continue;
                }
                std::size_t const memory = measures.GetMemory();
                CellTree const *const last = hasPrevious ? &previous->GetTree(face) : nullptr;
                auto const setBase = [&](internal::RefinedCells &cells) {
                    state.surface.Init(face);
                    View::setBase(state.surface.Get(), state.surface.GetControlPoints(), 3, cells);
                };
                CellTree tree = makeTree(level.GetFaceSize(face), std::cref(setBase), measures,
                                         last, counts ? &visibility[std::size_t(face)] : nullptr);
                if (tree.IsRefined(0)) {
                    forest.SetTree(face, std::move(tree));
                }
                if (bounds) {
                    bounds->trim(face, memory);
                }
                for (int local = 0; local < level.GetFaceSize(face); ++local) {
                    Index const edge = level.faceEdges[level.faceFirstCorner[face] + local];
                    bool const isReversed = forest.isReversed(face, local);
                    // The first of its faces that has a surface makes an edge, since holes have none.
                    if (!base.IsEdgeInfSharp(edge) ||
                        (isReversed && factory.FaceHasLimitSurface(level.edgeFaces[edge][0])) ||
                        !state.surface.Init(face)) {
                        continue;
                    }
                    Polyline lastEdge; // empty where there is none
                    if (hasPreviousEdges) {
                        Polyline const &ofEdge = previous->_edges[std::size_t(edge)];
                        lastEdge = isReversed ? ofEdge.GetReversed() : ofEdge;
                    }
                    Polyline const made = MakeEdge(state.surface.Get(), local,
                                                   state.surface.GetControlPoints(), 3, &lastEdge);
                    forest.SetEdge(edge, isReversed ? made.GetReversed() : made);
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
                                 Surface<float>::PointDescriptor const &, Polyline const *) const;
template Polyline View::MakeEdge(Surface<double> const &, int, double const[],
                                 Surface<double>::PointDescriptor const &, Polyline const *) const;
template int View::FindLevels(Surface<float> const &, float const[],
                              Surface<float>::PointDescriptor const &, int[]) const;
template int View::FindLevels(Surface<double> const &, double const[],
                              Surface<double>::PointDescriptor const &, int[]) const;
template CellForest View::MakeForest(SurfaceFactory const &, float const[],
                                     Surface<float>::PointDescriptor const &, CellForest const *,
                                     Counts *) const;
template CellForest View::MakeForest(ViewBounds &, float const[],
                                     Surface<float>::PointDescriptor const &, CellForest const *,
                                     Counts *) const;
template CellForest View::MakeForest(SurfaceFactory const &, double const[],
                                     Surface<double>::PointDescriptor const &, CellForest const *,
                                     Counts *) const;
template CellForest View::MakeForest(ViewBounds &, double const[],
                                     Surface<double>::PointDescriptor const &, CellForest const *,
                                     Counts *) const;

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include "cell/baseType.h"
#include "cell/cellGrid.h"

#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/pi.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <array>
#include <atomic>
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

/// The faces of a mesh in turn, with their control points, of three numbers each.
class FaceToMeasure {
public:
    FaceToMeasure(SurfaceFactory const &factory, PointArray const &meshPoints)
        : _factory(factory), _meshPoints(meshPoints) {}

    /// Goes to a face; false where that has no surface.
    bool Set(Far::Index face) {
        if (face != _number) {
            _number = face;
            _surface.Clear();
            if (_factory.TryInit(face, FarExt::Interpolation::Vertex, -1, _surface).IsOk()) {
                gather();
            }
        }
        return _surface.IsValid();
    }

    BaseType const &GetType() const { return _surface.GetFace().type; }
    void SetCells(RefinedCells &cells) const { cells.SetBase(GetType(), _points.data(), 3); }
    void Sample(CellGrid &grid, std::vector<double> &samples) const {
        grid.Sample(_surface.GetFace(), _points.data(), _sources, samples);
    }
    /// Whether the hull of its points is outside of the picture, which contains the surface.
    bool IsOutside(ViewGeometry const &geometry) const {
        return geometry.IsOutside(_points.data(), 3, _surface.GetNumControlPoints());
    }
    /// An edge of it, with its points.
    CellType::BorderItem const &SetEdge(int edge, CellValues &values) const {
        CellType::BorderItem const &item =
            GetType()->GetBorderItem(_surface.GetFace().GetTurns(), std::size_t(edge));
        std::vector<double> points;
        for (int const point : item.points) {
            auto const first = _points.begin() + 3 * std::ptrdiff_t(point);
            points.insert(points.end(), first, first + 3);
        }
        values.SetBase(BaseType(*item.type), points.data(), 3);
        return item;
    }

private:
    void gather() {
        BaseFace const &face = _surface.GetFace();
        _sources = {_meshPoints.floats,
                    _meshPoints.stride,
                    3,
                    std::size_t(face.numPoints),
                    nullptr,
                    face.GetPoints(),
                    &_shared};
        _points.resize(3 * std::size_t(face.numPoints));
        for (int i = 0; i < face.numPoints; ++i) {
            Vector3 const point = _meshPoints[face.GetPoints()[i]];
            std::copy(point.begin(), point.end(), &_points[3 * std::size_t(i)]);
        }
    }

    SurfaceFactory const &_factory;
    PointArray const _meshPoints;
    Far::Index _number = Far::INDEX_INVALID;
    Surface<float> _surface;
    SharedRings<float> _shared;
    RingSources<float> _sources = {}; // none of points in double precision
    std::vector<double> _points;
};

namespace {

/// \brief Refines one face.
///
/// Cells are measured together with their children where these are refined, from the base face on; the children of these
/// children where they are not expected to be flat.
class TreeMaker {
public:
    /// \param base      goes to the face where something is not known
    /// \param measures  those of the face, which it adds to
    TreeMaker(ViewGeometry const &geometry, View::Options const &options, FaceToMeasure &base,
              Far::Index face, FaceMeasures &measures, CellTree const *previous, CellTree &tree,
              std::vector<CellVisibility> *visibility)
        : _geometry(geometry), _options(options), _base(base), _face(face), _measures(measures),
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

    FaceToMeasure const &getBase() {
        _base.Set(_face);
        return _base;
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
            getBase().SetCells(_cells);
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
            std::size_t const cell = makeCell(node);
            std::vector<Vector3> normals;
            for (int corner = 0; corner < _cells[cell].GetType().GetNumCorners(); ++corner) {
                double du[3];
                double dv[3];
                _cells.EvaluateCorner(cell, corner, du, dv);
                normals.push_back(Cross(ToVector3(du), ToVector3(dv)));
            }
            getMeasures(node).facing = int(_measures.facings.size());
            _measures.facings.push_back(_grid->FindFacing(
                _samples, node.isMeasuredFirst ? 0 : 1 + node.child, std::move(normals)));
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
            _isSharp = getBase().GetType().IsSharp();
            getBase().Sample(*_grid, _samples);
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
            return getBase().IsOutside(_geometry) ? CellVisibility::Outside
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
    FaceToMeasure &_base;
    Far::Index const _face;
    FaceMeasures &_measures;
    CellTree const *const _previous;
    CellTree &_tree;
    std::vector<CellVisibility> *const _visibility;
    CellGrid *_grid = nullptr; // of the cell that was sampled last
    std::size_t _sampled = std::size_t(-1);
    bool _isSharp = false; // whether something sharp is near that
    // Of the thread, whose memory is kept for the next face.
    struct Scratch {
        static Scratch &Get() {
            static thread_local Scratch scratch;
            return scratch;
        }

        RefinedCells cells;
        std::vector<double> samples;
    };
    RefinedCells &_cells = Scratch::Get().cells;
    std::vector<double> &_samples = Scratch::Get().samples;
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

/// The data of a ViewBounds.  Several threads may work at the measures of different faces.
struct BoundsData {
    using Index = ViewBounds::Index;

    BoundsData(SurfaceFactory const &ofMesh, ViewBounds::Options const &ofBounds)
        : factory(ofMesh), options(ofBounds), faces(std::size_t(ofMesh.GetNumFaces())) {}

    /// Forgets what depends on positions that are not those of the last call.
    void SetPoints(PointArray const &meshPoints);
    /// Counts what a face has come to have, and forgets it if that is too much.
    void Trim(Index face, std::size_t memoryBefore);
    /// Forgets all.
    void Clear();

    SurfaceFactory const &factory;
    ViewBounds::Options const options;
    std::vector<Vector3> points; ///< the positions, once there are some
    std::vector<FaceMeasures> faces;
    std::atomic<std::size_t> memory{0}; ///< that measures take, in bytes

private:
    void forget(std::vector<char> const &isChanged);
};

void BoundsData::Clear() {
    points.clear();
    for (FaceMeasures &face : faces) {
        face = {};
    }
    memory = 0;
}

void BoundsData::SetPoints(PointArray const &meshPoints) {
    auto const numVertices = std::size_t(factory.GetLevel().GetNumVertices());
    bool const hadPoints = !points.empty();
    std::vector<char> isChanged(numVertices);
    points.resize(numVertices);
    FarExt::internal::ParallelFor(Index(numVertices), [&](Index vertex) {
        Vector3 const point = meshPoints[vertex];
        Vector3 &last = points[std::size_t(vertex)];
        isChanged[std::size_t(vertex)] = point != last;
        last = point;
    });
    if (hadPoints) {
        forget(isChanged);
    }
}

// Forgets the faces that have a control point which has changed.
void BoundsData::forget(std::vector<char> const &isChanged) {
    if (std::find(isChanged.begin(), isChanged.end(), char(true)) == isChanged.end()) {
        return;
    }
    constexpr Index kFacesOfRange = 64;
    FarExt::internal::ParallelForRange(
        factory.GetNumFaces(), [] { return Surface<float>(); },
        [&](Surface<float> &surface, Index begin, Index end) {
            for (Index face = begin; face < end; ++face) {
                FaceMeasures &measures = faces[std::size_t(face)];
                if (measures.cells.empty()) {
                    continue;
                }
                if (!factory.InitVertexSurface(face, &surface) ||
                    std::any_of(surface.GetFace().GetPoints(), surface.GetFace().GetTurns(),
                                [&](Index point) { return isChanged[std::size_t(point)]; })) {
                    memory -= measures.GetMemory();
                    measures = {};
                }
            }
        },
        kFacesOfRange);
}

void BoundsData::Trim(Index face, std::size_t memoryBefore) {
    FaceMeasures &measures = faces[std::size_t(face)];
    std::size_t const memoryNow = measures.GetMemory();
    if (memoryNow != memoryBefore &&
        (memory += memoryNow - memoryBefore) > options.GetMaxMemory()) {
        memory -= memoryNow;
        measures = {};
    }
}

/// The data of a View.
struct ViewData {
    Camera camera;
    View::Options options;
    ViewGeometry geometry; ///< of a valid one
    bool isValid = false;
};

namespace {

// Counts the cells of a forest that are not refined.
void countCells(CellForest const &forest, int maxLevel, View::Counts &counts) {
    counts.cellsByLevel.assign(std::size_t(maxLevel) + 1, 0);
    for (std::size_t face = 0; face < counts.visibilities.size(); ++face) {
        CellTree const &tree = forest.GetTree(int(face));
        std::vector<CellVisibility> const &found = counts.visibilities[face];
        for (std::size_t cell = 0; cell < found.size(); ++cell) {
            if (!tree.IsRefined(int(cell))) {
                ++counts.cellsByLevel[std::size_t(tree.GetLevel(int(cell)))];
                counts.outside += found[cell] == CellVisibility::Outside;
                counts.backFacing += found[cell] == CellVisibility::BackFacing;
            }
        }
    }
}

} // namespace

} // namespace internal

ViewBounds::ViewBounds(SurfaceFactory const &factory, Options options)
    : _data(std::make_unique<internal::BoundsData>(factory, options)) {}

ViewBounds::~ViewBounds() = default;

SurfaceFactory const &ViewBounds::GetFactory() const { return _data->factory; }

ViewBounds::Options const &ViewBounds::GetOptions() const { return _data->options; }

std::size_t ViewBounds::GetMemory() const { return _data->memory; }

void ViewBounds::Clear() { _data->Clear(); }

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

CellForest View::makeForest(SurfaceFactory const &factory, ViewBounds *viewBounds,
                            internal::PointArray const &meshPoints, CellForest const *previous,
                            Counts *counts, FarExt::CallStatus *status) const {
    FarExt::SurfaceFaces const &faces = factory.GetFaces();
    // Diagonals between surface faces are infinitely sharp.
    auto const isInfSharp = [&](Index edge) {
        return edge >= factory.GetLevel().GetNumEdges() || factory.GetLevel().IsEdgeInfSharp(edge);
    };
    internal::BoundsData *const bounds = viewBounds ? &viewBounds->GetData() : nullptr;
    if (bounds) {
        bounds->SetPoints(meshPoints);
    }
    CellForest forest(factory.GetMesh());
    CellForest const *const last =
        previous && previous->GetNumFaces() == forest.GetNumFaces() ? previous : nullptr;
    bool const hasLastEdges = last && last->GetFaces().GetNumEdges() == faces.GetNumEdges();
    if (counts) {
        *counts = {};
        counts->visibilities.resize(std::size_t(forest.GetNumFaces()));
    }
    // A tree grows in the memory of the last one, and is kept in no more than it takes.
    struct State {
        internal::FaceToMeasure base;
        internal::FaceMeasures measures;
        CellTree tree;
    };
    constexpr int kTriangle = 3;
    std::atomic<Index> firstWithout = forest.GetNumFaces(); // without a surface
    constexpr Index kFacesOfRange = 16;
    FarExt::internal::ParallelForRange(
        forest.GetNumFaces(),
        [&] {
            return State{{factory, meshPoints}, {}, CellTree(kTriangle)};
        },
        [&](State &state, Index begin, Index end) {
            for (Index face = begin; face < end; ++face) {
                state.measures.Clear();
                internal::FaceMeasures &measures =
                    bounds ? bounds->faces[std::size_t(face)] : state.measures;
                if (measures.cells.empty() && !state.base.Set(face)) {
                    Index first = firstWithout;
                    while (!faces.IsHole(face) && face < first &&
                           !firstWithout.compare_exchange_weak(first, face)) {
                    }
                    continue;
                }
                std::size_t const memory = measures.GetMemory();
                state.tree = forest.GetTree(face);
                bool const hasLastTree =
                    last && last->GetTree(face).GetFaceShape() == state.tree.GetFaceShape();
                std::vector<CellVisibility> *const visibility =
                    counts ? &counts->visibilities[std::size_t(face)] : nullptr;
                if (IsValid()) {
                    internal::TreeMaker(_data->geometry, _data->options, state.base, face, measures,
                                        hasLastTree ? &last->GetTree(face) : nullptr, state.tree,
                                        visibility)
                        .Make();
                }
                if (visibility) {
                    visibility->resize(std::size_t(state.tree.GetNumCells()));
                }
                if (state.tree.IsRefined(0)) {
                    forest.SetTree(face, state.tree);
                }
                if (bounds) {
                    bounds->Trim(face, memory);
                }
                for (int local = 0; IsValid() && local < state.tree.GetFaceSize(); ++local) {
                    auto const [edge, isReversed] = faces.GetEdge(face, local);
                    // The first of its faces that has a surface makes an edge, since holes have none.
                    if (!isInfSharp(edge) ||
                        (isReversed && factory.FaceHasLimitSurface(faces.GetSide(edge, 0).face)) ||
                        !state.base.Set(face)) {
                        continue;
                    }
                    internal::CellValues values;
                    bool const isTurned =
                        isReversed != state.base.SetEdge(local, values).isReversed;
                    auto const turn = [&](Polyline const &polyline) {
                        return isTurned ? polyline.GetReversed() : polyline;
                    };
                    Polyline const lastEdge = hasLastEdges ? turn(last->GetEdge(edge)) : Polyline();
                    Polyline made;
                    Polyline::FromPlaces(
                        internal::EdgeMaker(_data->geometry, _data->options, lastEdge).Make(values),
                        &made);
                    forest.SetEdge(edge, turn(made));
                }
            }
        },
        kFacesOfRange);
    forest.MatchEdges();
    if (status && !IsValid()) {
        *status = FarExt::internal::Failure(
            FarExt::StatusCode::InvalidArgument,
            "the view is invalid: its camera has no picture, or an option is out of range");
    } else if (status) {
        Surface<float> none;
        *status = firstWithout < forest.GetNumFaces()
                      ? factory.TryInit(firstWithout, FarExt::Interpolation::Vertex, -1, none)
                      : FarExt::CallStatus();
    }
    if (counts) {
        internal::countCells(forest, IsValid() ? GetOptions().GetMaxLevel() : 0, *counts);
    }
    return forest;
}

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#include "levelTessellation.h"

#include "cell/bfrPlace.h"
#include "cell/cellPlan.h"
#include "cell/cellStencil.h"
#include "cell/faceSections.h"

#include "far_ext/vtr/faceCoords.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>

#include <opensubdiv/far/types.h>

namespace OpenSubdivHex::BfrExt {

using internal::CellMesh;

namespace {

constexpr int kInvalid = OpenSubdiv::Far::INDEX_INVALID;

// Others are mostly those of one face, so that what is made for them is not used again.
constexpr int kMaxCellsOfPlan = 128;

// By edge, the level of which it has the polyline; -1: none.
std::vector<int> findEdgeLevels(std::vector<Polyline> const &edges) {
    std::vector<int> levels;
    levels.reserve(edges.size());
    for (Polyline const &edge : edges) {
        // Levels 0 and 1 give an edge the same.
        int level = 0;
        while (level <= Polyline::kLastLevel &&
               Polyline(level).GetNumPoints() < edge.GetNumPoints()) {
            ++level;
        }
        levels.push_back(level <= Polyline::kLastLevel && Polyline(level) == edge ? level : -1);
    }
    return levels;
}

// Cuts convex polygons, with vertices in straight lines, into triangles that all have an area: n corners take
// O(n log n) steps.
class Triangulator {
public:
    explicit Triangulator(std::vector<double> const &coords) : _coords(coords) {}

    // Appends the triangles of a polygon, corner by corner.
    void Add(std::vector<int> const &polygon, std::vector<std::array<int, 3>> &triangles) {
        setPolygon(polygon);
        for (std::size_t numLeft = polygon.size(); numLeft > 3; --numLeft) {
            std::size_t const ear = findEar();
            triangles.push_back(getCorner(ear));
            cut(ear);
        }
        triangles.push_back({polygon[_first], polygon[_next[_first]], polygon[_prev[_first]]});
    }

private:
    void setPolygon(std::vector<int> const &polygon) {
        std::size_t const size = polygon.size();
        _polygon = &polygon;
        _first = 0;
        _prev.resize(size);
        _next.resize(size);
        _isKept.assign(size, false);
        for (std::size_t i = 0; i < size; ++i) {
            _prev[i] = i == 0 ? size - 1 : i - 1;
            _next[i] = i + 1 == size ? 0 : i + 1;
        }
        _numLeaves = 1;
        while (_numLeaves < size) {
            _numLeaves *= 2;
        }
        _best.assign(2 * _numLeaves, 0.0);
        for (std::size_t i = 0; i < size; ++i) {
            _best[_numLeaves + i] = getQuality(getCorner(i));
        }
        for (std::size_t node = _numLeaves - 1; node > 0; --node) {
            _best[node] = std::max(_best[2 * node], _best[2 * node + 1]);
        }
    }

    void setQuality(std::size_t i, double quality) {
        std::size_t node = _numLeaves + i;
        _best[node] = quality;
        while ((node /= 2) > 0) {
            _best[node] = std::max(_best[2 * node], _best[2 * node + 1]);
        }
    }

    void cut(std::size_t ear) {
        std::size_t const prev = _prev[ear];
        std::size_t const next = _next[ear];
        _next[prev] = next;
        _prev[next] = prev;
        _first = ear == _first ? next : _first;
        setQuality(ear, 0);
        for (std::size_t const i : {prev, next}) {
            setQuality(i, _isKept[i] ? 0 : getQuality(getCorner(i)));
        }
    }

    std::array<int, 3> getCorner(std::size_t i) const {
        return {(*_polygon)[_prev[i]], (*_polygon)[i], (*_polygon)[_next[i]]};
    }

    double getX(int vert) const { return _coords[2 * std::size_t(vert)]; }
    double getY(int vert) const { return _coords[2 * std::size_t(vert) + 1]; }

    double getSquare(int from, int to) const {
        return std::pow(getX(to) - getX(from), 2) + std::pow(getY(to) - getY(from), 2);
    }

    // Twice the area over the square of the longest side.
    double getQuality(std::array<int, 3> const &t) const {
        double const area = (getX(t[1]) - getX(t[0])) * (getY(t[2]) - getY(t[0])) -
                            (getY(t[1]) - getY(t[0])) * (getX(t[2]) - getX(t[0]));
        return area /
               std::max({getSquare(t[0], t[1]), getSquare(t[1], t[2]), getSquare(t[2], t[0])});
    }

    // Whether all that would be left were a straight line, which the ends of the cut lie on.  Where it is not, the
    // first corners tell, since the polygon is convex.
    bool isRestFlat(std::size_t ear) const {
        int const start = (*_polygon)[_next[ear]];
        int const end = (*_polygon)[_prev[ear]];
        for (std::size_t i = _next[_next[ear]]; i != _prev[ear]; i = _next[i]) {
            if (getQuality({start, (*_polygon)[i], end}) > kLeastQuality) {
                return false;
            }
        }
        return true;
    }

    // The best triangle that does not leave a line behind; the first of those that are as good.
    std::size_t findEar() {
        while (_best[1] > kLeastQuality) {
            double const least = std::max(_best[1] / (1 + kLeastQuality), kLeastQuality);
            std::size_t node = 1;
            while (node < _numLeaves) {
                node *= 2;
                node += _best[node] < least ? 1 : 0;
            }
            std::size_t const ear = node - _numLeaves;
            if (!isRestFlat(ear)) {
                return ear;
            }
            // Later cuts shorten the line, and leave a line.
            _isKept[ear] = true;
            setQuality(ear, 0);
        }
        return _first;
    }

    static constexpr double kLeastQuality = 1e-9;

    std::vector<double> const &_coords;
    // Of the polygon that is cut, by its corners as they were given.
    std::vector<int> const *_polygon = nullptr;
    std::size_t _first = 0; // of those that are left
    std::vector<std::size_t> _prev;
    std::vector<std::size_t> _next;
    std::vector<bool> _isKept; // to the end, since a line would be left
    // A tree of the best qualities, the root at 1 and the corners from _numLeaves on.
    std::vector<double> _best;
    std::size_t _numLeaves = 0;
};

// Whether triangles have more indices than an int counts.
bool areTooMany(double numTriangles) {
    return 3 * numTriangles > double(std::numeric_limits<int>::max());
}

} // namespace

LevelTessellation::LevelTessellation(Parameterization const &parameterization, int level,
                                     Options options) {
    initialize(parameterization, 1, &level, options);
}

LevelTessellation::LevelTessellation(Parameterization const &parameterization, int numLevels,
                                     int const levels[], Options options) {
    initialize(parameterization, numLevels, levels, options);
}

LevelTessellation::LevelTessellation(CellTree const &tree, Polyline const edges[],
                                     Options options) {
    std::vector<Polyline> polylines;
    bool hasAllPoints = true;
    for (int edge = 0; edge < tree.GetFaceSize(); ++edge) {
        polylines.push_back(tree.GetEdgePolyline(edge));
        if (edges) {
            hasAllPoints = hasAllPoints && edges[edge].Contains(polylines.back());
            polylines.back() = edges[edge];
        }
    }
    // A half cell makes two triangles at least.
    if (!setOptions(options) || !hasAllPoints || areTooMany(2.0 * (tree.GetNumLeaves() - 1))) {
        return;
    }
    _parameterization = Parameterization(tree.GetFaceSize());
    CellMesh const mesh(tree, polylines.data());
    std::vector<int> edgeLevels = findEdgeLevels(polylines);
    _tree = std::make_shared<Tree>(Tree{tree, std::move(polylines), std::move(edgeLevels), {}});
    setCells(mesh);
    if (tree.GetNumCells() <= kMaxCellsOfPlan) {
        _cellPlans = std::make_shared<LazyCellPlans>();
    }
}

LevelTessellation::LevelTessellation(internal::FaceSections const &sections, int section,
                                     Options const &options) {
    if (!setOptions(options)) {
        return;
    }
    int const size = sections.GetFaceSize();
    _parameterization = Parameterization(size);
    _section = std::make_shared<Section>(Section{section, sections.GetNumSections(), {}});
    internal::CellShape shape = {};
    CellTree tree = sections.MakeTree(section, &shape);
    // Those that it has a side on.
    std::vector<Polyline> edges(static_cast<std::size_t>(size));
    std::vector<int> const polygon = sections.GetPolygon(section);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        CellMesh::Vertex const &start = sections.GetVertices()[std::size_t(polygon[i])];
        CellMesh::Vertex const &end =
            sections.GetVertices()[std::size_t(polygon[(i + 1) % polygon.size()])];
        if (sections.AreOnEdge(start, end)) {
            edges[std::size_t(start.sector)] = sections.GetEdge(start.sector);
        }
    }
    CellMesh const mesh(tree, edges.data(), shape);
    _levels = sections.GetLevels();
    if (_levels.empty()) {
        // Points on the other edges are made as those of the face, too.
        std::vector<Polyline> ofFace;
        ofFace.reserve(edges.size());
        for (int edge = 0; edge < size; ++edge) {
            ofFace.push_back(sections.GetEdge(edge));
        }
        _tree = std::make_shared<Tree>(Tree{tree, std::move(edges), findEdgeLevels(ofFace), {}});
    } else {
        _cellPlans = std::make_shared<LazyCellPlans>();
    }
    setSection(mesh, sections);
}

bool LevelTessellation::setOptions(Options const &options) {
    int const facetSize = options.GetFacetSize();
    int const facetStride = options.GetFacetStride() == 0 ? facetSize : options.GetFacetStride();
    int const coordStride = options.GetCoordStride() == 0 ? 2 : options.GetCoordStride();
    _firstFacetIndices = {0};
    if (coordStride < 2 || (facetSize != 0 && facetSize != 3 && facetSize != 4) ||
        facetStride < facetSize) {
        return false;
    }
    _facetSize = facetSize;
    _facetStride = facetSize == 0 ? 0 : facetStride;
    _coordStride = coordStride;
    return true;
}

void LevelTessellation::initialize(Parameterization const &parameterization, int numLevels,
                                   int const levels[], Options const &options) {
    int const size = parameterization.GetFaceSize();
    bool const areLevelsValid = (numLevels == 1 || numLevels == size || numLevels == size + 1) &&
                                std::all_of(levels, levels + numLevels, [](int level) {
                                    return 0 <= level && level <= kLastLevel;
                                });
    if (!setOptions(options) || !parameterization.IsValid() || !areLevelsValid) {
        return;
    }
    _parameterization = parameterization;
    if (numLevels == 1) {
        _levels.assign(std::size_t(size) + 1, levels[0]);
    } else {
        _levels.assign(levels, levels + size);
        _levels.push_back(numLevels > size ? levels[size]
                                           : *std::max_element(levels, levels + size));
    }
    if (areTooMany(2 * (internal::FaceSections::CountLeaves(_levels) - 1))) {
        *this = LevelTessellation(Parameterization(), 0);
        return;
    }
    std::vector<Polyline> edges;
    std::for_each(_levels.begin(), _levels.end() - 1,
                  [&](int level) { edges.emplace_back(level); });
    setCells(CellMesh(CellTree(size, _levels.data(), _levels.back()), edges.data()));
    _cellPlans = std::make_shared<LazyCellPlans>();
}

// For faces outside and inside lattices, each for points and for derivatives.
struct LevelTessellation::LazyCellPlans {
    std::once_flag once[2][2];
    std::unique_ptr<internal::CellPlan const> plans[2][2];
};

// The highest of the places that a plan has.
int LevelTessellation::getLevelOfPlaces(bool isOfDerivatives) const {
    if (!_tree) {
        return isOfDerivatives ? *std::max_element(_levels.begin(), _levels.end()) : _levels.back();
    }
    int level = _tree->cells.GetMaxLevel();
    for (Polyline const &edge : _tree->edges) {
        // Places of a level are multiples of that of its first one.
        for (int const place : edge.GetPlaces()) {
            while (isOfDerivatives && place % (Polyline::kLength >> level) != 0) {
                ++level;
            }
        }
    }
    return level;
}

internal::CellPlan const &LevelTessellation::getCellPlan(bool isInLattice,
                                                         bool isOfDerivatives) const {
    using internal::CellPlan;
    std::size_t const kind[2] = {isInLattice ? 1U : 0U, isOfDerivatives ? 1U : 0U};
    std::unique_ptr<CellPlan const> &plan = _cellPlans->plans[kind[0]][kind[1]];
    std::call_once(_cellPlans->once[kind[0]][kind[1]], [&] {
        std::vector<internal::LeafPlaces::Place> places;
        places.reserve(_places.size());
        for (SectorCoords const &place : _places) {
            places.push_back({place.sector, {place.start, place.end}});
        }
        plan = std::make_unique<CellPlan const>(
            GetFaceSize(), getLevelOfPlaces(isOfDerivatives), places,
            isOfDerivatives ? CellPlan::Use::Derivatives : CellPlan::Use::Points, isInLattice);
    });
    return *plan;
}

// Takes the vertices of the mesh in an order, those of the boundary first, and returns their places.
std::vector<int> LevelTessellation::setPlaces(CellMesh const &mesh, std::vector<int> const &order) {
    std::vector<CellMesh::Vertex> const &verts = mesh.GetVertices();
    std::vector<int> places(verts.size(), kInvalid);
    FarExt::internal::BasePolygon const polygon(GetFaceSize());
    _coords.resize(2 * order.size());
    _places.reserve(order.size());
    for (std::size_t place = 0; place < order.size(); ++place) {
        CellMesh::Vertex const &vert = verts[std::size_t(order[place])];
        places[std::size_t(order[place])] = int(place);
        double const start = std::ldexp(double(vert.a), -internal::CellShape::kBits);
        double const end = std::ldexp(double(vert.b), -internal::CellShape::kBits);
        internal::Pair const coords =
            FarExt::internal::FindFaceCoords(polygon, vert.sector, {start, end});
        std::copy(coords.begin(), coords.end(), &_coords[2 * place]);
        _places.push_back({vert.sector, start, end});
        if (_tree && vert.cell >= 0) {
            _tree->corners.push_back({vert.cell, vert.corner, int(place)});
        }
    }
    if (_tree) {
        sortByCell(_tree->corners);
    }
    if (_parameterization.HasSubFaces()) {
        _bfrPlaces = std::make_shared<LazyBfrPlaces>();
    }
    return places;
}

struct LevelTessellation::LazyBfrPlaces {
    std::once_flag once;
    std::vector<internal::BfrPlace> places;
};

std::vector<internal::BfrPlace> const &LevelTessellation::getBfrPlaces() const {
    std::call_once(_bfrPlaces->once, [&] {
        _bfrPlaces->places.reserve(_places.size());
        for (std::size_t i = 0; i < _places.size(); ++i) {
            _bfrPlaces->places.push_back(
                internal::FindBfrPlace(_parameterization, {_coords[2 * i], _coords[2 * i + 1]}, 0));
        }
    });
    return _bfrPlaces->places;
}

void LevelTessellation::sortByCell(std::vector<CellCorner> &corners) {
    std::sort(corners.begin(), corners.end(), [](CellCorner const &a, CellCorner const &b) {
        return a.cell != b.cell ? a.cell < b.cell : a.corner < b.corner;
    });
}

std::vector<LevelTessellation::CellCorner> LevelTessellation::findCornersOfDerivatives() const {
    CellTree const &tree = _tree->cells;
    std::vector<CellCorner> corners;
    corners.reserve(_places.size());
    for (std::size_t place = 0; place < _places.size(); ++place) {
        int const sector = _places[place].sector;
        internal::Pair coords = {_places[place].start, _places[place].end};
        int cell = 0;
        bool isWhole = true;
        int corner = -1;
        while ((corner = internal::FindCellCorner(isWhole ? GetFaceSize() : 0, sector, coords)) <
                   0 &&
               tree.IsRefined(cell)) {
            internal::CellStep const step = internal::FindCellStep(isWhole, sector, coords);
            coords = step.map->Apply(coords); // without rounding
            cell = tree.GetFirstChild(cell) + int(step.child);
            isWhole = step.isChildWhole;
        }
        if (corner >= 0) {
            corners.push_back({cell, corner, int(place)});
        }
    }
    sortByCell(corners);
    return corners;
}

// All that the mesh has.
void LevelTessellation::setCells(CellMesh const &mesh) {
    std::size_t const numVerts = mesh.GetVertices().size();
    std::vector<bool> isOnBoundary(numVerts);
    std::vector<int> order;
    order.reserve(numVerts);
    for (int edge = 0; edge < GetFaceSize(); ++edge) {
        std::vector<int> const edgeVerts = mesh.GetEdgeVertices(edge);
        _firstEdgeCoords.push_back(int(order.size()));
        order.insert(order.end(), edgeVerts.begin(), edgeVerts.end() - 1);
    }
    _firstEdgeCoords.push_back(int(order.size()));
    for (int const vert : order) {
        isOnBoundary[std::size_t(vert)] = true;
    }
    for (std::size_t vert = 0; vert < numVerts; ++vert) {
        if (!isOnBoundary[vert]) {
            order.push_back(int(vert));
        }
    }
    setFacets(mesh, setPlaces(mesh, order));
}

// Sets the places of the polygons of a section: the mesh has more places beside it.
void LevelTessellation::setSection(CellMesh const &mesh, internal::FaceSections const &sections) {
    std::vector<int> const polygon = sections.GetPolygon(_section->number);
    std::vector<int> order;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        CellMesh::Vertex const &start = sections.GetVertices()[std::size_t(polygon[i])];
        CellMesh::Vertex const &end =
            sections.GetVertices()[std::size_t(polygon[(i + 1) % polygon.size()])];
        int const first = int(order.size());
        _firstEdgeCoords.push_back(first);
        order.push_back(mesh.Find(start.sector, {start.a, start.b}));
        // If two vertices are in different sectors, one lies on the line between these.
        int const size = GetFaceSize();
        if (start.sector == end.sector) {
            mesh.AppendBetween(start.sector, {start.a, start.b}, {end.a, end.b}, order);
        } else if (end.b == 0 && end.sector == (start.sector + 1) % size) {
            mesh.AppendBetween(start.sector, {start.a, start.b}, {0, end.a}, order);
        } else {
            mesh.AppendBetween(end.sector, {0, start.a}, {end.a, end.b}, order);
        }
        if (!sections.IsOnEdge(start)) {
            continue;
        }
        int const before =
            start.b == 0
                ? 0
                : 1 + sections.CountPointsBefore(start.sector, sections.GetPlaceOnEdge(start));
        int const count = sections.AreOnEdge(start, end) ? int(order.size()) - first : 1;
        _section->border.push_back({start.sector, before - 1, count, first});
    }
    _firstEdgeCoords.push_back(int(order.size()));
    std::vector<bool> isInside(mesh.GetVertices().size());
    mesh.ForEachCell([&](CellMesh::Polygon &cell) {
        for (int const vert : cell.verts) {
            isInside[std::size_t(vert)] = true;
        }
    });
    for (int const vert : order) {
        isInside[std::size_t(vert)] = false;
    }
    for (std::size_t vert = 0; vert < isInside.size(); ++vert) {
        if (isInside[vert]) {
            order.push_back(int(vert));
        }
    }
    setFacets(mesh, setPlaces(mesh, order));
}

// All places in a face that is a regular polygon.
std::vector<double> LevelTessellation::findRegularCoords() const {
    std::vector<double> coords;
    coords.reserve(_coords.size());
    double const unit = 2 * FarExt::internal::kPi / GetFaceSize();
    for (SectorCoords const &place : _places) {
        double const start = unit * place.sector;
        double const end = unit * (place.sector + 1);
        coords.push_back(place.start * std::cos(start) + place.end * std::cos(end));
        coords.push_back(place.start * std::sin(start) + place.end * std::sin(end));
    }
    return coords;
}

void LevelTessellation::setFacets(CellMesh const &mesh, std::vector<int> const &places) {
    auto const addFacet = [&](int const *facet, int numVerts, int level) {
        _facetIndices.insert(_facetIndices.end(), facet, facet + numVerts);
        _firstFacetIndices.push_back(int(_facetIndices.size()));
        _facetLevels.push_back(level);
    };
    // By Euler's formula; quads and polygons are fewer.
    std::size_t const numTriangles =
        2 * std::size_t(GetNumCoords()) - std::size_t(GetNumBoundaryCoords()) - 2;
    if (areTooMany(double(numTriangles))) {
        *this = LevelTessellation(Parameterization(), 0);
        return;
    }
    if (_facetSize == 0) {
        for (CellMesh::Polygon &polygon : mesh.GetMergedPolygons()) {
            for (int &vert : polygon.verts) {
                vert = places[std::size_t(vert)];
            }
            addFacet(polygon.verts.data(), int(polygon.verts.size()), polygon.level);
        }
    } else {
        std::size_t const numFacets = _facetSize == 3 ? numTriangles : numTriangles / 2;
        _facetIndices.reserve(std::size_t(_facetSize) * numFacets);
        _firstFacetIndices.reserve(numFacets + 1);
        _facetLevels.reserve(numFacets);
        std::vector<double> const coords = findRegularCoords();
        Triangulator triangulator(coords);
        std::vector<std::array<int, 3>> triangles;
        mesh.ForEachCell([&](CellMesh::Polygon &polygon) {
            std::vector<int> &facet = polygon.verts;
            for (int &vert : facet) {
                vert = places[std::size_t(vert)];
            }
            if (_facetSize == 4 && facet.size() == 4) {
                addFacet(facet.data(), 4, polygon.level);
                return;
            }
            triangles.clear();
            triangulator.Add(facet, triangles);
            for (std::array<int, 3> const &triangle : triangles) {
                addFacet(triangle.data(), 3, polygon.level);
            }
        });
    }
    _facetIndices.shrink_to_fit();
    _firstFacetIndices.shrink_to_fit();
    _facetLevels.shrink_to_fit();
}

template <typename REAL>
int LevelTessellation::GetPlaneCoords(REAL coordTuples[]) const {
    FarExt::internal::BasePolygon const polygon(GetFaceSize());
    for (SectorCoords const &place : _places) {
        polygon.Write(place.sector, {place.start, place.end}, coordTuples);
        coordTuples += _coordStride;
    }
    return GetNumCoords();
}

template int LevelTessellation::GetPlaneCoords(float[]) const;
template int LevelTessellation::GetPlaneCoords(double[]) const;

int LevelTessellation::GetLevels(int levels[]) const {
    std::copy(_levels.begin(), _levels.end(), levels);
    return int(_levels.size());
}

bool LevelTessellation::IsUniform() const {
    return !_levels.empty() && std::all_of(_levels.begin(), _levels.end(),
                                           [&](int level) { return level == _levels[0]; });
}

int LevelTessellation::GetFacetSizes(int sizes[]) const {
    for (std::size_t i = 0; i + 1 < _firstFacetIndices.size(); ++i) {
        sizes[i] = _firstFacetIndices[i + 1] - _firstFacetIndices[i];
    }
    return GetNumFacets();
}

int LevelTessellation::GetFacetLevels(int levels[]) const {
    std::copy(_facetLevels.begin(), _facetLevels.end(), levels);
    return GetNumFacets();
}

int LevelTessellation::GetFacets(int facetTuples[]) const {
    for (std::size_t i = 0; i + 1 < _firstFacetIndices.size(); ++i) {
        int const *const begin = _facetIndices.data() + _firstFacetIndices[i];
        int const *const end = _facetIndices.data() + _firstFacetIndices[i + 1];
        std::copy(begin, end, facetTuples);
        std::fill(facetTuples + (end - begin), facetTuples + std::max(_facetSize, int(end - begin)),
                  kInvalid);
        facetTuples += _facetSize == 0 ? int(end - begin) : _facetStride;
    }
    return GetNumFacets();
}

template <typename FUNCTION>
void LevelTessellation::transform(int facetTuples[], FUNCTION function) const {
    for (std::size_t i = 0; i + 1 < _firstFacetIndices.size(); ++i) {
        int const size = _firstFacetIndices[i + 1] - _firstFacetIndices[i];
        std::transform(facetTuples, facetTuples + size, facetTuples, function);
        facetTuples += _facetSize == 0 ? size : _facetStride;
    }
}

void LevelTessellation::TransformFacetCoordIndices(int facetTuples[], int commonOffset) const {
    transform(facetTuples, [=](int index) { return index + commonOffset; });
}

void LevelTessellation::TransformFacetCoordIndices(int facetTuples[], int const boundaryIndices[],
                                                   int interiorOffset) const {
    int const numBoundary = GetNumBoundaryCoords();
    transform(facetTuples, [=](int index) {
        return index < numBoundary ? boundaryIndices[index] : index + interiorOffset;
    });
}

void LevelTessellation::TransformFacetCoordIndices(int facetTuples[], int const boundaryIndices[],
                                                   int const interiorIndices[]) const {
    int const numBoundary = GetNumBoundaryCoords();
    transform(facetTuples, [=](int index) {
        return index < numBoundary ? boundaryIndices[index] : interiorIndices[index - numBoundary];
    });
}

} // namespace OpenSubdivHex::BfrExt

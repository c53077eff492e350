// SPDX-License-Identifier: Apache-2.0
#include "tessellationData.h"

#include "cellStencil.h"

#include "far_ext/vtr/faceCoords.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <opensubdiv/far/types.h>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

constexpr int kInvalid = OpenSubdiv::Far::INDEX_INVALID;

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
    // The polygon that is cut, by its corners as they were given.
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

bool TessellationData::SetTree(CellTree const &cells, Polyline const edges[],
                               LevelTessellation::Options const &options) {
    std::vector<Polyline> polylines;
    bool hasAllPoints = true;
    for (int edge = 0; edge < cells.GetFaceSize(); ++edge) {
        polylines.push_back(cells.GetEdgePolyline(edge));
        if (edges) {
            hasAllPoints = hasAllPoints && edges[edge].Contains(polylines.back());
            polylines.back() = edges[edge];
        }
    }
    // A half cell makes two triangles at least.
    if (!setOptions(options) || !hasAllPoints || areTooMany(2.0 * (cells.GetNumLeaves() - 1))) {
        return false;
    }
    parameterization = Parameterization(cells.GetFaceShape());
    CellMesh const mesh(cells, polylines.data());
    placeLevels = PlaceLevels(cells, polylines);
    return setFace(mesh);
}

bool TessellationData::SetSection(FaceSections const &sections, int number,
                                  LevelTessellation::Options const &options) {
    if (!setOptions(options)) {
        return false;
    }
    int const size = sections.GetFaceShape().size;
    parameterization = Parameterization(sections.GetFaceShape());
    section = number;
    numSections = sections.GetNumSections();
    CellShape shape = {};
    CellTree cells = sections.MakeTree(number, &shape);
    std::vector<CellMesh::Vertex> polygon;
    for (int const vert : sections.GetPolygon(number)) {
        polygon.push_back(sections.GetVertices()[std::size_t(vert)]);
    }
    auto const isOnEdge = [&](std::size_t side) {
        return sections.AreOnEdge(polygon[side], polygon[(side + 1) % polygon.size()]);
    };
    // The edges that it has a side on.
    std::vector<Polyline> edges(static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        if (isOnEdge(i)) {
            int const edge = sections.FindEdge(polygon[i]).edge;
            edges[std::size_t(edge)] = sections.GetEdge(edge);
        }
    }
    CellMesh const mesh(cells, edges.data(), shape);
    levels = sections.GetLevels();
    placeLevels = sections.GetPlaceLevels();
    bool const areSet = setCells(mesh, polygon);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        EdgePlace<int> const onEdge = sections.FindEdge(polygon[i]);
        if (onEdge.edge >= 0) {
            int const first = firstEdgeCoords[i];
            int const before = onEdge.end == 0 ? 0 : 1 + sections.CountPointsBefore(onEdge);
            int const count = isOnEdge(i) ? firstEdgeCoords[i + 1] - first : 1;
            border.push_back({onEdge.edge, before - 1, count, first, false});
        }
    }
    return areSet;
}

bool TessellationData::setOptions(LevelTessellation::Options const &options) {
    facetSize = options.GetFacetSize();
    facetStride = options.GetFacetStride() == 0 ? facetSize : options.GetFacetStride();
    coordStride = options.GetCoordStride() == 0 ? 2 : options.GetCoordStride();
    firstFacetIndices = {0};
    if (coordStride < 2 || (facetSize != 0 && facetSize != 3 && facetSize != 4) ||
        facetStride < facetSize) {
        return false;
    }
    facetStride = facetSize == 0 ? 0 : facetStride;
    return true;
}

bool TessellationData::SetLevels(Parameterization const &ofFace, int numLevels, int const ofEdges[],
                                 LevelTessellation::Options const &options) {
    int const size = ofFace.GetFaceSize();
    bool const areLevelsValid = (numLevels == 1 || numLevels == size || numLevels == size + 1) &&
                                std::all_of(ofEdges, ofEdges + numLevels, [](int level) {
                                    return 0 <= level && level <= LevelTessellation::kLastLevel;
                                });
    if (!setOptions(options) || !ofFace.IsValid() || !areLevelsValid) {
        return false;
    }
    parameterization = ofFace;
    if (numLevels == 1) {
        levels.assign(std::size_t(size) + 1, ofEdges[0]);
    } else {
        levels.assign(ofEdges, ofEdges + size);
        levels.push_back(numLevels > size ? ofEdges[size]
                                          : *std::max_element(ofEdges, ofEdges + size));
    }
    FaceShape const shape = GetFaceShape();
    if (areTooMany(2 * (FaceSections::CountLeaves(shape, levels.back()) - 1))) {
        return false;
    }
    placeLevels = PlaceLevels({shape, levels});
    std::vector<Polyline> const edges(placeLevels.ofEdges.begin(), placeLevels.ofEdges.end());
    CellTree const cells(shape, levels.data(), levels.back());
    CellMesh const mesh(cells, edges.data());
    return setFace(mesh);
}

CellPlan const &TessellationData::GetCellPlan(bool isInLattice, bool isOfDerivatives) const {
    std::size_t const kind[2] = {isInLattice ? 1U : 0U, isOfDerivatives ? 1U : 0U};
    std::unique_ptr<CellPlan const> &plan = _plans[kind[0]][kind[1]];
    std::call_once(_oncePlans[kind[0]][kind[1]], [&] {
        plan = std::make_unique<CellPlan const>(
            GetFaceShape(), isOfDerivatives ? placeLevels.ofAll : placeLevels.ofInside, places,
            isOfDerivatives ? CellPlan::Use::Derivatives : CellPlan::Use::Points, isInLattice);
    });
    return *plan;
}

// Takes the vertices of the mesh in an order, those of the boundary first, and returns their places.
std::vector<int> TessellationData::setPlaces(CellMesh const &mesh, std::vector<int> const &order) {
    std::vector<CellMesh::Vertex> const &verts = mesh.GetVertices();
    std::vector<int> ofVertices(verts.size(), kInvalid);
    FarExt::internal::BasePolygon const polygon(GetFaceShape());
    coords.resize(2 * order.size());
    places.reserve(order.size());
    for (std::size_t place = 0; place < order.size(); ++place) {
        CellMesh::Vertex const &vert = verts[std::size_t(order[place])];
        ofVertices[std::size_t(order[place])] = int(place);
        Pair const inSector = {std::ldexp(double(vert.coords[0]), -CellShape::kBits),
                               std::ldexp(double(vert.coords[1]), -CellShape::kBits)};
        Pair const coordsOfPlace = FarExt::internal::FindFaceCoords(
            parameterization, polygon, vert.sector, {inSector[0], inSector[1]});
        std::copy(coordsOfPlace.begin(), coordsOfPlace.end(), &coords[2 * place]);
        places.push_back({vert.sector, inSector});
    }
    return ofVertices;
}

std::vector<BfrPlace> const &TessellationData::GetBfrPlaces() const {
    std::call_once(_onceBfrPlaces, [&] {
        _bfrPlaces.reserve(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            _bfrPlaces.push_back(FindBfrPlace(parameterization, GetFaceShape(),
                                              {coords[2 * i], coords[2 * i + 1]}, 0));
        }
    });
    return _bfrPlaces;
}

bool TessellationData::setFace(CellMesh const &mesh) {
    bool const areSet = setCells(mesh, mesh.GetFaceVertices());
    for (int edge = 0; edge < GetFaceSize(); ++edge) {
        int const first = firstEdgeCoords[std::size_t(edge)];
        border.push_back({edge, -1, firstEdgeCoords[std::size_t(edge) + 1] - first, first, true});
    }
    return areSet;
}

// Sets the places of a polygon: of the face, or of a section, beside which the mesh has more.
bool TessellationData::setCells(CellMesh const &mesh,
                                std::vector<CellMesh::Vertex> const &polygon) {
    std::vector<int> order;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        auto const &[sector, start] = polygon[i];
        auto const &[endSector, end] = polygon[(i + 1) % polygon.size()];
        firstEdgeCoords.push_back(int(order.size()));
        order.push_back(mesh.Find(sector, start));
        // If two vertices lie in different sectors, one of them lies on the line between the sectors.
        if (sector == endSector) {
            mesh.AppendBetween(sector, start, end, order);
        } else if (GetFaceShape().isHalf && start[0] == 0 && endSector == 1 && end[1] == 0) {
            mesh.AppendBetween(endSector, {-start[1], 0}, end, order); // the long edge
        } else if (end[1] == 0 && endSector == (sector + 1) % GetFaceSize()) {
            mesh.AppendBetween(sector, start, {0, end[0]}, order);
        } else {
            mesh.AppendBetween(endSector, {0, start[0]}, end, order);
        }
    }
    firstEdgeCoords.push_back(int(order.size()));
    std::vector<bool> isInside(mesh.GetVertices().size(), numSections == 1);
    if (numSections > 1) {
        mesh.ForEachCell([&](CellMesh::Polygon &cell) {
            for (int const vert : cell.verts) {
                isInside[std::size_t(vert)] = true;
            }
        });
    }
    for (int const vert : order) {
        isInside[std::size_t(vert)] = false;
    }
    for (std::size_t vert = 0; vert < isInside.size(); ++vert) {
        if (isInside[vert]) {
            order.push_back(int(vert));
        }
    }
    return setFacets(mesh, setPlaces(mesh, order));
}

// All places in a face that is a regular polygon, or half of one.
std::vector<double> TessellationData::findRegularCoords() const {
    std::vector<double> result(2 * places.size());
    FarExt::internal::BasePolygon const polygon(GetFaceShape());
    double *uv = result.data();
    for (auto const &[sector, inSector] : places) {
        polygon.Write(sector, {inSector[0], inSector[1]}, uv);
        if (GetFaceShape() == FaceShape(3)) { // from the right-angled triangle
            uv[0] += uv[1] / 2;
            uv[1] *= std::sqrt(0.75);
        }
        uv += 2;
    }
    return result;
}

bool TessellationData::setFacets(CellMesh const &mesh, std::vector<int> const &placesOfVertices) {
    auto const addFacet = [&](int const *facet, int numVerts, int level) {
        facetIndices.insert(facetIndices.end(), facet, facet + numVerts);
        firstFacetIndices.push_back(int(facetIndices.size()));
        facetLevels.push_back(level);
        maxFacetSize = std::max(maxFacetSize, numVerts);
    };
    // The number of triangles by Euler's formula; quads and polygons are fewer.
    std::size_t const numTriangles =
        2 * std::size_t(GetNumCoords()) - std::size_t(GetNumBoundaryCoords()) - 2;
    if (areTooMany(double(numTriangles))) {
        return false;
    }
    if (facetSize == 0) {
        for (CellMesh::Polygon &polygon : mesh.GetMergedPolygons()) {
            for (int &vert : polygon.verts) {
                vert = placesOfVertices[std::size_t(vert)];
            }
            addFacet(polygon.verts.data(), int(polygon.verts.size()), polygon.level);
        }
    } else {
        std::size_t const numFacets = facetSize == 3 ? numTriangles : numTriangles / 2;
        facetIndices.reserve(std::size_t(facetSize) * numFacets);
        firstFacetIndices.reserve(numFacets + 1);
        facetLevels.reserve(numFacets);
        std::vector<double> const regularCoords = findRegularCoords();
        Triangulator triangulator(regularCoords);
        std::vector<std::array<int, 3>> triangles;
        mesh.ForEachCell([&](CellMesh::Polygon &polygon) {
            std::vector<int> &facet = polygon.verts;
            for (int &vert : facet) {
                vert = placesOfVertices[std::size_t(vert)];
            }
            if (facetSize == 4 && facet.size() == 4) {
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
    facetIndices.shrink_to_fit();
    firstFacetIndices.shrink_to_fit();
    facetLevels.shrink_to_fit();
    return true;
}

} // namespace OpenSubdivHex::BfrExt::internal

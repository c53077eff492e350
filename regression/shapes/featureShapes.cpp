// SPDX-License-Identifier: Apache-2.0
#include "featureShapes.h"

#include "meshOperations.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

constexpr float kInfinite = 10;

using Pairs = std::vector<int>;

Shape makeShape(std::vector<double> positions, std::vector<std::vector<int>> const &faces) {
    Shape shape;
    shape.positions = std::move(positions);
    for (std::vector<int> const &face : faces) {
        shape.faceSizes.push_back(int(face.size()));
        shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
    }
    return shape;
}

/// Values without symmetry, so that no error of a weight cancels.
void fillValues(FVarChannel &channel, int numValues) {
    channel.values.resize(std::size_t(channel.width) * numValues);
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
        channel.values[i] = std::sin(1.3 * double(i * i % 101)) + 0.01 * double(i);
    }
}

int find(std::vector<int> &parents, int i) {
    while (parents[i] != i) {
        i = parents[i] = parents[parents[i]];
    }
    return i;
}

/// The sides of each edge: the corner where a face begins to run along it, and where it ends.
using Sides = std::map<std::pair<int, int>, std::vector<std::pair<int, int>>>;

Sides findSides(Shape const &shape) {
    Sides sides;
    int first = 0;
    for (int size : shape.faceSizes) {
        for (int i = 0; i < size; ++i) {
            int const start = first + i;
            int const end = first + (i + 1) % size;
            int const v = shape.faceVertices[start];
            int const w = shape.faceVertices[end];
            if (v < w) {
                sides[{v, w}].emplace_back(start, end);
            } else {
                sides[{w, v}].emplace_back(end, start);
            }
        }
        first += size;
    }
    return sides;
}

/// Vertices in a grid of numX + 1 columns, as MakeTiling makes quads and triangles.
int gridVertex(int numX, int x, int y) { return y * (numX + 1) + x; }

/// The edges of a path along vertices.
Pairs path(std::vector<int> const &vertices) {
    Pairs pairs;
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
        pairs.insert(pairs.end(), {vertices[i], vertices[i + 1]});
    }
    return pairs;
}

std::vector<int> gridRow(int numX, int y, int x0, int x1) {
    std::vector<int> vertices;
    for (int x = x0; x <= x1; ++x) {
        vertices.push_back(gridVertex(numX, x, y));
    }
    return vertices;
}

std::vector<int> gridColumn(int numX, int x, int y0, int y1) {
    std::vector<int> vertices;
    for (int y = y0; y <= y1; ++y) {
        vertices.push_back(gridVertex(numX, x, y));
    }
    return vertices;
}

/// The border of the block of cells from (x0, y0) to (x1, y1).
std::vector<int> gridLoop(int numX, int x0, int y0, int x1, int y1) {
    std::vector<int> vertices;
    for (int x = x0; x < x1; ++x) {
        vertices.push_back(gridVertex(numX, x, y0));
    }
    for (int y = y0; y < y1; ++y) {
        vertices.push_back(gridVertex(numX, x1, y));
    }
    for (int x = x1; x > x0; --x) {
        vertices.push_back(gridVertex(numX, x, y1));
    }
    for (int y = y1; y >= y0; --y) {
        vertices.push_back(gridVertex(numX, x0, y));
    }
    return vertices;
}

Shape named(std::string name, Shape shape) {
    shape.name = std::move(name);
    return shape;
}

Shape deformedTiling(Tiling tiling, int numX, int numY) {
    Shape shape = MakeTiling(tiling, numX, numY);
    for (double &coordinate : shape.positions) {
        coordinate *= 0.3;
    }
    Deform(shape);
    return shape;
}

void addCreases(Shape &shape, Pairs const &pairs, std::vector<float> const &sharpness) {
    shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), pairs.begin(), pairs.end());
    for (std::size_t i = 0; i < pairs.size() / 2; ++i) {
        shape.creaseSharpness.push_back(sharpness[i % sharpness.size()]);
    }
}

void addCorner(Shape &shape, int vertex, float sharpness) {
    shape.cornerVertices.push_back(vertex);
    shape.cornerSharpness.push_back(sharpness);
}

Shape withCreases(Shape shape, Pairs const &pairs, std::vector<float> const &sharpness) {
    addCreases(shape, pairs, sharpness);
    return shape;
}

/// The edges of a shape that have a vertex outside the set on neither side: all within it.
Pairs edgesWithin(Shape const &shape, std::set<int> const &vertices) {
    Pairs pairs;
    for (auto const &[edge, sides] : findSides(shape)) {
        if (vertices.count(edge.first) != 0 && vertices.count(edge.second) != 0) {
            pairs.insert(pairs.end(), {edge.first, edge.second});
        }
    }
    return pairs;
}

Pairs allEdges(Shape const &shape) {
    Pairs pairs;
    for (auto const &[edge, sides] : findSides(shape)) {
        pairs.insert(pairs.end(), {edge.first, edge.second});
    }
    return pairs;
}

std::vector<Shape> creaseShapes() {
    std::vector<Shape> shapes;
    constexpr int n = 4; // columns and rows of the grids
    Shape const quads = deformedTiling(Tiling::Quads, n, n);
    Shape const triangles = deformedTiling(Tiling::Triangles, n, n);
    Shape const hexagons = deformedTiling(Tiling::Hexagons, 3, 3);
    Shape const &icosahedron = GetShape("icosahedron");
    Shape const &cube = GetShape("cube");
    auto add = [&](std::string name, Shape shape) {
        shapes.push_back(named(std::move(name), std::move(shape)));
    };
    std::vector<std::pair<std::string, Shape const *>> const grids = {{"Quads", &quads},
                                                                      {"Triangles", &triangles}};
    // The ring of five vertices of the icosahedron: two faces on one side, three on the other.
    Pairs const pentagon = path({0, 1, 2, 3, 4, 0});
    Pairs const loop = path(gridLoop(n, 1, 1, 3, 3));
    Pairs const row = path(gridRow(n, 2, 0, n));
    Pairs const column = path(gridColumn(n, 2, 0, n));

    add("plainTriangles", triangles);
    add("plainHexagons", hexagons);
    add("creaseLoopClosed", withCreases(icosahedron, pentagon, {kInfinite}));
    add("semiSharpLoopClosed", withCreases(icosahedron, pentagon, {0.5f, 1, 1.75f, 2.25f, 3}));
    add("semiSharpLoopUniform", withCreases(icosahedron, pentagon, {1.5f}));
    add("allCreases", withCreases(cube, allEdges(cube), {kInfinite}));
    add("allSemiSharp", withCreases(cube, allEdges(cube), {0.25f, 1.25f, 2.5f, 0.75f, 3.5f}));
    add("allSemiSharpHexagons",
        withCreases(hexagons, allEdges(hexagons), {0.5f, 1.25f, 2.75f, 10, 0.75f}));
    {
        // Edges between hexagons alone, and around pentagons.
        Shape const &ball = GetShape("truncatedIcosahedron");
        std::set<int> vertices;
        for (int v = 0; v < 14; ++v) {
            vertices.insert(v);
        }
        add("creasedBall", withCreases(ball, edgesWithin(ball, vertices), {2.5f, 10, 1.5f}));
    }
    for (auto const &[suffix, grid] : grids) {
        add("creaseLoop" + suffix, withCreases(*grid, loop, {kInfinite}));
        add("creaseMeetsBorder" + suffix, withCreases(*grid, row, {kInfinite}));
        add("semiSharpMeetsBorder" + suffix, withCreases(*grid, row, {1.75f}));
        add("mixedSharpness" + suffix, withCreases(*grid, row, {0.25f, 1.5f, 10, 2.75f}));
        add("darts" + suffix, withCreases(*grid, path(gridRow(n, 2, 1, 3)), {kInfinite}));
        add("semiSharpDart" + suffix, withCreases(*grid, path(gridRow(n, 2, 0, 2)), {1.5f, 0.5f}));
        Shape crossing = withCreases(*grid, row, {kInfinite});
        add("crossing" + suffix, withCreases(crossing, column, {kInfinite}));
        crossing = withCreases(*grid, row, {2.25f});
        add("semiSharpCrossing" + suffix, withCreases(crossing, column, {kInfinite}));
        crossing = withCreases(*grid, row, {0.75f});
        add("semiSharpsCrossing" + suffix, withCreases(crossing, column, {1.5f}));
        Shape const junction = withCreases(*grid, path(gridRow(n, 2, 0, 2)), {kInfinite});
        add("junction" + suffix,
            withCreases(junction, path(gridColumn(n, 2, 0, n)), {kInfinite, 3.5f}));
        // Through the corner of the grid: its border and two inner creases.
        add("creaseToCorner" + suffix, withCreases(*grid,
                                                   path({gridVertex(n, 0, 0), gridVertex(n, 0, 1),
                                                         gridVertex(n, 1, 1), gridVertex(n, 2, 1)}),
                                                   {2.5f}));

        Shape corners = *grid;
        addCorner(corners, gridVertex(n, 1, 1), kInfinite);
        addCorner(corners, gridVertex(n, 2, 2), 1.5f);
        addCorner(corners, gridVertex(n, 3, 1), 0.5f);
        addCorner(corners, gridVertex(n, 2, 0), kInfinite); // on the border
        addCorner(corners, gridVertex(n, 0, 2), 1.25f);
        add("corners" + suffix, corners);
        add("cornersOnCreases" + suffix,
            withCreases(withCreases(corners, path(gridRow(n, 1, 0, n)), {2.5f}), row, {kInfinite}));
    }
    {
        // The diagonal of the triangle grid ends in two of its corners.
        std::vector<int> diagonal;
        for (int i = 0; i <= n; ++i) {
            diagonal.push_back(gridVertex(n, i, i));
        }
        add("creaseThroughCorner", withCreases(triangles, path(diagonal), {kInfinite}));
        add("semiSharpThroughCorner", withCreases(triangles, path(diagonal), {1.25f, 2}));
    }
    {
        // Wide sectors of all sizes: spokes of a fan of 12, also semi-sharp.
        Shape const &fan = GetShape("prism12");
        Shape const &pyramid = GetShape("pyramid12");
        add("creasedPrism", withCreases(fan, allEdges(fan), {10, 0, 0, 1.5f, 0, 2.25f}));
        int const apex = 12;
        add("wideSectors", withCreases(pyramid, path({0, apex, 3}), {kInfinite}));
        add("widestSector", withCreases(pyramid, path({0, apex, 1}), {kInfinite}));
        add("semiSharpSectors", withCreases(pyramid, path({0, apex, 4}), {0.5f, 1.75f}));
        Shape three = withCreases(pyramid, path({0, apex, 4}), {kInfinite});
        add("threeSectors", withCreases(three, path({8, apex}), {2.5f}));
    }
    return shapes;
}

std::vector<Shape> faceVaryingShapes() {
    std::vector<Shape> shapes;
    constexpr int n = 4;
    Shape const quads = deformedTiling(Tiling::Quads, n, n);
    Shape const triangles = deformedTiling(Tiling::Triangles, n, n);
    Shape const &cube = GetShape("cube");
    Shape const &icosahedron = GetShape("icosahedron");
    auto add = [&](std::string name, Shape shape, std::vector<FVarChannel> channels) {
        shape.fvarChannels = std::move(channels);
        shapes.push_back(named(std::move(name), std::move(shape)));
    };
    Pairs const row = path(gridRow(n, 2, 0, n));
    Pairs const column = path(gridColumn(n, 2, 0, n));
    Pairs const loop = path(gridLoop(n, 1, 1, 3, 3));
    Pairs const pentagon = path({0, 1, 2, 3, 4, 0});

    add("cubeOfCharts", cube, {MakeFaceChannel(cube), MakeVertexChannel(cube)});
    add("semiSharpCubeOfCharts", withCreases(cube, allEdges(cube), {0.5f, 1.75f, 10}),
        {MakeFaceChannel(cube)});
    add("seamLoop", icosahedron, {MakeSeamChannel(icosahedron, pentagon)});
    add("seamLoopOnCrease", withCreases(icosahedron, pentagon, {kInfinite}),
        {MakeSeamChannel(icosahedron, pentagon), MakeVertexChannel(icosahedron)});
    add("seamOnSemiSharp", withCreases(quads, row, {1.5f, 2.75f}),
        {MakeSeamChannel(quads, row), MakeSeamChannel(quads, loop)});
    add("seamAcrossCrease", withCreases(triangles, row, {kInfinite, 2.5f}),
        {MakeSeamChannel(triangles, column), MakeSeamChannel(triangles, row)});
    add("seamEndsInside", quads, {MakeSeamChannel(quads, path(gridRow(n, 2, 1, 3)))});
    add("seamEndsInsideTriangles", triangles,
        {MakeSeamChannel(triangles, path(gridRow(n, 2, 0, 2)))});
    Pairs cross = row;
    cross.insert(cross.end(), column.begin(), column.end());
    add("seamsCross", triangles, {MakeSeamChannel(triangles, cross), MakeFaceChannel(triangles)});
    add("widths", quads, [&] {
        std::vector<FVarChannel> channels{MakeSeamChannel(quads, row), MakeFaceChannel(quads),
                                          MakeVertexChannel(quads)};
        channels[0].width = 1;
        channels[1].width = 5;
        for (FVarChannel &channel : channels) {
            fillValues(channel, 1 + *std::max_element(channel.valueIndices.begin(),
                                                      channel.valueIndices.end()));
        }
        return channels;
    }());
    {
        // Both halves of the grid have the same texture: values at distant vertices are one.
        FVarChannel mirrored;
        for (int v : quads.faceVertices) {
            int const x = v % (n + 1);
            int const y = v / (n + 1);
            mirrored.valueIndices.push_back(y * (n + 1) + std::min(x, n - x));
        }
        fillValues(mirrored, (n + 1) * (n + 1));
        add("mirroredTexture", quads, {mirrored});
        // One value for all corners.
        FVarChannel single;
        single.valueIndices.assign(quads.faceVertices.size(), 0);
        fillValues(single, 1);
        add("singleValue", quads, {single});
    }
    {
        Shape corners = quads;
        addCorner(corners, gridVertex(n, 2, 2), 1.5f);
        addCorner(corners, gridVertex(n, 1, 2), kInfinite);
        add("cornersOnSeam", corners, {MakeSeamChannel(quads, row)});
    }
    return shapes;
}

std::vector<Shape> holeAndFlawShapes() {
    std::vector<Shape> shapes;
    constexpr int n = 4;
    Shape const quads = deformedTiling(Tiling::Quads, n, n);
    auto add = [&](std::string name, Shape shape) {
        shapes.push_back(named(std::move(name), std::move(shape)));
    };
    Shape holes = quads;
    holes.holeFaces = {5, 6};
    add("holesInside", holes);
    holes.holeFaces = {0, 1, 7};
    add("holesBesideBorder", withCreases(holes, path(gridRow(n, 2, 0, n)), {1.5f}));
    holes = GetShape("cube");
    holes.holeFaces = {2};
    add("cubeWithHole", holes);

    auto random = [](int numVertices) {
        std::vector<double> positions;
        for (int i = 0; i < 3 * numVertices; ++i) {
            positions.push_back(std::sin(1.7 * i * i + 0.3 * i) + 0.1 * (i % 7));
        }
        return positions;
    };
    auto flawed = [&](std::string name, int numVertices,
                      std::vector<std::vector<int>> const &faces) {
        add(std::move(name), makeShape(random(numVertices), faces));
    };
    flawed("bowTie", 5, {{0, 1, 2}, {2, 3, 4}});
    flawed("bowTieOfFans", 9, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {4, 5, 6}, {4, 6, 7}, {4, 7, 8}});
    flawed(
        "closedBowTie", 7,
        {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}});
    flawed("threeFaceEdge", 5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    flawed("fiveFaceEdge", 7, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}, {0, 1, 6}});
    flawed(
        "tetrahedraOnEdge", 6,
        {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}, {0, 1, 4}, {0, 5, 1}, {0, 4, 5}, {1, 5, 4}});
    flawed("degenerateQuad", 5, {{0, 1, 2, 2}, {2, 1, 3, 4}});
    flawed("degenerateTriangle", 5, {{0, 1, 2, 3}, {3, 2, 4}, {4, 2, 2}});
    flawed("fourFacesOnEdgeAndBorder", 8, {{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}});
    // A fin on a grid: three sheets along the line 1-4-7, of which 4 is inside the crease.
    std::vector<std::vector<int>> const sheets = {{0, 1, 4, 3}, {1, 2, 5, 4},  {3, 4, 7, 6},
                                                  {4, 5, 8, 7}, {1, 4, 10, 9}, {4, 7, 11, 10}};
    flawed("fin", 12, sheets);
    add("finWithCrease", withCreases(makeShape(random(12), sheets), {3, 4, 4, 5}, {kInfinite}));
    add("finWithCreaseToIt", withCreases(makeShape(random(12), sheets), {3, 4}, {kInfinite}));
    add("finWithSemiSharp", withCreases(makeShape(random(12), sheets), {3, 4}, {1.5f}));
    Shape cornerFin = makeShape(random(12), sheets);
    addCorner(cornerFin, 4, 1.5f);
    add("finWithCorner", cornerFin);
    Shape textured = makeShape(random(12), sheets);
    textured.fvarChannels = {MakeVertexChannel(textured), MakeFaceChannel(textured),
                             MakeSeamChannel(textured, {3, 4, 4, 5})};
    add("texturedFin", textured);

    Shape leftHanded = withCreases(quads, path(gridRow(n, 2, 0, n)), {kInfinite});
    leftHanded.fvarChannels = {MakeSeamChannel(quads, path(gridColumn(n, 2, 0, n)))};
    leftHanded.leftHanded = true;
    add("leftHanded", leftHanded);
    return shapes;
}

std::vector<Shape> realShapes() {
    std::vector<Shape> shapes;
    for (Shape const &shape : GetShapes()) {
        if (shape.name == "spot" || shape.name == "suzanne" || shape.name == "teapot") {
            shapes.push_back(shape);
        }
    }
    return shapes;
}

} // namespace

Shape MakeTiling(Tiling tiling, int numX, int numY) {
    std::vector<double> positions;
    std::vector<std::vector<int>> faces;
    double const slope = tiling == Tiling::Triangles ? -0.5 : 0; // the shift of a row
    double const height = tiling == Tiling::Triangles ? std::sqrt(0.75) : 1;
    if (tiling == Tiling::Hexagons) {
        std::map<std::pair<int, int>, int> vertices;
        for (int row = 0; row < numY; ++row) {
            for (int column = 0; column < numX; ++column) {
                int const x = 2 * column + row % 2;
                std::vector<int> face;
                for (auto const &[px, py] : std::vector<std::pair<int, int>>{{x, row},
                                                                             {x + 1, row},
                                                                             {x + 2, row},
                                                                             {x + 2, row + 1},
                                                                             {x + 1, row + 1},
                                                                             {x, row + 1}}) {
                    auto const [place, isNew] =
                        vertices.try_emplace({px, py}, int(positions.size() / 3));
                    if (isNew) {
                        positions.insert(positions.end(),
                                         {std::sqrt(0.75) * px,
                                          1.5 * py + ((px + py) % 2 == 0 ? 0.25 : -0.25), 0});
                    }
                    face.push_back(place->second);
                }
                faces.push_back(face);
            }
        }
        return named("hexagonTiling", makeShape(positions, faces));
    }
    for (int y = 0; y <= numY; ++y) {
        for (int x = 0; x <= numX; ++x) {
            positions.insert(positions.end(), {x + slope * y, height * y, 0});
        }
    }
    for (int y = 0; y < numY; ++y) {
        for (int x = 0; x < numX; ++x) {
            int const v = gridVertex(numX, x, y);
            int const w = gridVertex(numX, x, y + 1);
            if (tiling == Tiling::Triangles) {
                faces.push_back({v, v + 1, w + 1});
                faces.push_back({v, w + 1, w});
            } else {
                faces.push_back({v, v + 1, w + 1, w});
            }
        }
    }
    return named(tiling == Tiling::Triangles ? "triangleTiling" : "quadTiling",
                 makeShape(positions, faces));
}

FVarChannel MakeVertexChannel(Shape const &shape) {
    FVarChannel channel;
    channel.valueIndices = shape.faceVertices;
    fillValues(channel, shape.GetNumVertices());
    return channel;
}

FVarChannel MakeSeamChannel(Shape const &shape, std::vector<int> const &pairs) {
    std::set<std::pair<int, int>> cut;
    for (std::size_t i = 0; i < pairs.size(); i += 2) {
        cut.insert(std::minmax(pairs[i], pairs[i + 1]));
    }
    std::vector<int> parents(shape.faceVertices.size());
    std::iota(parents.begin(), parents.end(), 0);
    for (auto const &[edge, sides] : findSides(shape)) {
        for (std::size_t i = 1; i < sides.size() && cut.count(edge) == 0; ++i) {
            parents[find(parents, sides[i].first)] = find(parents, sides[0].first);
            parents[find(parents, sides[i].second)] = find(parents, sides[0].second);
        }
    }
    FVarChannel channel;
    std::map<int, int> values;
    for (int corner = 0; corner < int(parents.size()); ++corner) {
        auto const [place, isNew] = values.try_emplace(find(parents, corner), int(values.size()));
        channel.valueIndices.push_back(place->second);
    }
    fillValues(channel, int(values.size()));
    return channel;
}

FVarChannel MakeFaceChannel(Shape const &shape) {
    FVarChannel channel;
    channel.valueIndices.resize(shape.faceVertices.size());
    std::iota(channel.valueIndices.begin(), channel.valueIndices.end(), 0);
    fillValues(channel, int(channel.valueIndices.size()));
    return channel;
}

std::vector<Shape> const &GetFeatureShapes() {
    static std::vector<Shape> const shapes = [] {
        std::vector<Shape> result;
        for (auto const &part :
             {creaseShapes(), faceVaryingShapes(), holeAndFlawShapes(), realShapes()}) {
            result.insert(result.end(), part.begin(), part.end());
        }
        for (Shape &shape : result) {
            shape.closed = CountBoundaryEdges(shape) == 0;
            shape.manifold = IsManifold(shape);
        }
        return result;
    }();
    return shapes;
}

std::vector<Shape> const &GetAllShapes() {
    static std::vector<Shape> const shapes = [] {
        std::vector<Shape> result = GetShapes();
        result.insert(result.end(), GetFeatureShapes().begin(), GetFeatureShapes().end());
        return result;
    }();
    return shapes;
}

Shape const &GetFeatureShape(std::string const &name) {
    for (Shape const &shape : GetFeatureShapes()) {
        if (shape.name == name) {
            return shape;
        }
    }
    throw std::out_of_range("no feature shape " + name);
}

} // namespace OpenSubdivHex::Regression

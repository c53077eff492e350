// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

#include "meshOperations.h"
#include "objShape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

double const kPi = std::acos(-1.0);

/// Collects faces over vertices that are named by integer keys and made when first met.
class ShapeBuilder {
public:
    using Key = std::array<int, 3>;

    explicit ShapeBuilder(std::string name) { _shape.name = std::move(name); }

    int AddVertex(double x, double y, double z) {
        _shape.positions.push_back(x);
        _shape.positions.push_back(y);
        _shape.positions.push_back(z);
        return _shape.GetNumVertices() - 1;
    }

    /// The vertex of \p key; the first call for the key gives its position.
    int GetVertex(Key key, double x, double y, double z) {
        auto const found = _vertices.find(key);
        if (found != _vertices.end()) {
            return found->second;
        }
        return _vertices[key] = AddVertex(x, y, z);
    }

    void AddFace(std::vector<int> const &vertices) {
        _shape.faceSizes.push_back(int(vertices.size()));
        _shape.faceVertices.insert(_shape.faceVertices.end(), vertices.begin(), vertices.end());
    }

    Shape Take() { return std::move(_shape); }

private:
    Shape _shape;
    std::map<Key, int> _vertices;
};

std::string numbered(char const *name, int n) { return name + std::to_string(n); }

Shape makeTetrahedron() {
    ShapeBuilder builder("tetrahedron");
    builder.AddVertex(1, 1, 1);
    builder.AddVertex(1, -1, -1);
    builder.AddVertex(-1, 1, -1);
    builder.AddVertex(-1, -1, 1);
    builder.AddFace({0, 1, 2});
    builder.AddFace({0, 3, 1});
    builder.AddFace({0, 2, 3});
    builder.AddFace({1, 3, 2});
    return builder.Take();
}

Shape makeOctahedron() {
    ShapeBuilder builder("octahedron");
    builder.AddVertex(1, 0, 0);
    builder.AddVertex(0, 1, 0);
    builder.AddVertex(-1, 0, 0);
    builder.AddVertex(0, -1, 0);
    builder.AddVertex(0, 0, 1);
    builder.AddVertex(0, 0, -1);
    for (int i = 0; i < 4; ++i) {
        builder.AddFace({i, (i + 1) % 4, 4});
        builder.AddFace({(i + 1) % 4, i, 5});
    }
    return builder.Take();
}

/// The surface of a set of unit cubes: its quads between a filled and an empty cell.
Shape makeVoxelSurface(std::string name, std::set<std::array<int, 3>> const &cells) {
    ShapeBuilder builder(std::move(name));
    for (std::array<int, 3> const &cell : cells) {
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = 0; side < 2; ++side) {
                std::array<int, 3> neighbour = cell;
                neighbour[axis] += side == 0 ? -1 : 1;
                if (cells.count(neighbour) != 0) {
                    continue;
                }
                std::vector<int> face;
                for (int i = 0; i < 4; ++i) {
                    std::array<int, 3> corner = cell;
                    corner[axis] += side;
                    corner[(axis + 1) % 3] += i == 1 || i == 2;
                    corner[(axis + 2) % 3] += i >= 2;
                    face.push_back(builder.GetVertex(corner, 2 * corner[0] - 1, 2 * corner[1] - 1,
                                                     2 * corner[2] - 1));
                }
                if (side == 0) {
                    std::swap(face[1], face[3]);
                }
                builder.AddFace(face);
            }
        }
    }
    return builder.Take();
}

Shape makeCube() { return makeVoxelSurface("cube", {{0, 0, 0}}); }

Shape makeGenus2() {
    std::set<std::array<int, 3>> cells;
    for (int x = 0; x < 5; ++x) {
        for (int y = 0; y < 3; ++y) {
            if (y != 1 || x % 2 == 0) {
                cells.insert({x, y, 0});
            }
        }
    }
    Shape shape = makeVoxelSurface("genus2", cells);
    for (double &coordinate : shape.positions) {
        coordinate *= 0.3;
    }
    return shape;
}

void addRing(ShapeBuilder &builder, int n, double radius, double z) {
    for (int i = 0; i < n; ++i) {
        double const angle = 2 * kPi * i / n;
        builder.AddVertex(radius * std::cos(angle), radius * std::sin(angle), z);
    }
}

std::vector<int> ringFace(int n, int first, bool reversed) {
    std::vector<int> face;
    for (int i = 0; i < n; ++i) {
        face.push_back(first + (reversed ? n - 1 - i : i));
    }
    return face;
}

Shape makePyramid(int n) {
    ShapeBuilder builder(numbered("pyramid", n));
    addRing(builder, n, 1, -0.5);
    int const apex = builder.AddVertex(0, 0, 1);
    builder.AddFace(ringFace(n, 0, true));
    for (int i = 0; i < n; ++i) {
        builder.AddFace({i, (i + 1) % n, apex});
    }
    return builder.Take();
}

/// Two n-gons back to back: closed, all vertices of valence 2, no volume.
Shape makeDihedron(int n) {
    ShapeBuilder builder(numbered("dihedron", n));
    addRing(builder, n, 1, 0);
    builder.AddFace(ringFace(n, 0, false));
    builder.AddFace(ringFace(n, 0, true));
    return builder.Take();
}

Shape makePolygon(int n) {
    ShapeBuilder builder(numbered("polygon", n));
    addRing(builder, n, 1, 0);
    builder.AddFace(ringFace(n, 0, false));
    return builder.Take();
}

Shape makeDiscFan(int n) {
    ShapeBuilder builder(numbered("discFan", n));
    addRing(builder, n, 1, 0);
    int const centre = builder.AddVertex(0, 0, 0.4);
    for (int i = 0; i < n; ++i) {
        builder.AddFace({i, (i + 1) % n, centre});
    }
    return builder.Take();
}

/// Quads around a ring, open at both ends: radii and heights of the rings tell which surface.
Shape makeTube(std::string name, int n, std::vector<std::array<double, 2>> const &rings) {
    ShapeBuilder builder(std::move(name));
    for (std::array<double, 2> const &ring : rings) {
        addRing(builder, n, ring[0], ring[1]);
    }
    for (int ring = 0; ring + 1 < int(rings.size()); ++ring) {
        for (int i = 0; i < n; ++i) {
            int const j = (i + 1) % n;
            int const first = ring * n;
            builder.AddFace({first + i, first + j, first + n + j, first + n + i});
        }
    }
    return builder.Take();
}

void addTorusVertex(ShapeBuilder &builder, double u, double v) {
    double const radius = 1 + 0.4 * std::cos(2 * kPi * v);
    builder.AddVertex(radius * std::cos(2 * kPi * u), radius * std::sin(2 * kPi * u),
                      0.4 * std::sin(2 * kPi * v));
}

Shape makeQuadTorus(int numU, int numV) {
    ShapeBuilder builder("torus");
    for (int i = 0; i < numU; ++i) {
        for (int j = 0; j < numV; ++j) {
            addTorusVertex(builder, double(i) / numU, double(j) / numV);
        }
    }
    auto const vertex = [&](int i, int j) { return i % numU * numV + j % numV; };
    for (int i = 0; i < numU; ++i) {
        for (int j = 0; j < numV; ++j) {
            builder.AddFace(
                {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    return builder.Take();
}

/// The vertices of the hexagon in \p row and \p column of a brick wall, as places on a grid: odd
/// rows are half a brick, one place, to the right.
std::array<std::array<int, 2>, 6> brick(int row, int column) {
    int const x = 2 * column + row % 2;
    return {
        {{x, row}, {x + 1, row}, {x + 2, row}, {x + 2, row + 1}, {x + 1, row + 1}, {x, row + 1}}};
}

/// The height that makes regular hexagons of bricks.
double brickHeight(int x, int row) { return 1.5 * row + ((x + row) % 2 == 0 ? 0.25 : -0.25); }

/// The regular honeycomb on a torus; \p rows is even.
Shape makeHexTorus(int rows, int columns) {
    ShapeBuilder builder("hexTorus");
    for (int row = 0; row < rows; ++row) {
        for (int x = 0; x < 2 * columns; ++x) {
            addTorusVertex(builder, double(x) / (2 * columns), brickHeight(x, row) / (1.5 * rows));
        }
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            std::vector<int> face;
            for (auto const [x, y] : brick(row, column)) {
                face.push_back(y % rows * 2 * columns + x % (2 * columns));
            }
            builder.AddFace(face);
        }
    }
    return builder.Take();
}

Shape makeHexGrid(int rows, int columns) {
    ShapeBuilder builder("hexGrid");
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            std::vector<int> face;
            for (auto const [x, y] : brick(row, column)) {
                face.push_back(builder.GetVertex({x, y, 0}, 0.3 * std::sqrt(3.0) / 2 * x,
                                                 0.3 * brickHeight(x, y), 0));
            }
            builder.AddFace(face);
        }
    }
    return builder.Take();
}

Shape makeGrid(char const *name, int numX, int numY, bool triangles) {
    ShapeBuilder builder(name);
    for (int y = 0; y <= numY; ++y) {
        for (int x = 0; x <= numX; ++x) {
            builder.AddVertex(0.4 * x, 0.4 * y, 0);
        }
    }
    for (int y = 0; y < numY; ++y) {
        for (int x = 0; x < numX; ++x) {
            int const v = y * (numX + 1) + x;
            int const w = v + numX + 1;
            if (triangles) {
                builder.AddFace({v, v + 1, w + 1});
                builder.AddFace({v, w + 1, w});
            } else {
                builder.AddFace({v, v + 1, w + 1, w});
            }
        }
    }
    return builder.Take();
}

/// A pentagon, a quad and triangles around one vertex, and a heptagon beside them: open.
Shape makeMixedPatch() {
    ShapeBuilder builder("mixedPatch");
    builder.AddVertex(0, 0, 0.3);
    addRing(builder, 8, 1, 0);
    for (int i = 0; i < 4; ++i) {
        builder.AddVertex(1.4 + 0.3 * (i % 2), -0.2 + 0.4 * i, 0.1);
    }
    builder.AddFace({0, 1, 2, 3, 4});
    builder.AddFace({0, 4, 5, 6});
    builder.AddFace({0, 6, 7});
    builder.AddFace({0, 7, 8});
    builder.AddFace({0, 8, 1});
    builder.AddFace({3, 2, 1, 9, 10, 11, 12});
    return builder.Take();
}

Shape makeIsolatedVertex() {
    Shape shape = makeGrid("isolatedVertex", 2, 1, false);
    // In the middle of the numbering, so that an index that forgets it is off for what follows.
    shape.positions.insert(shape.positions.begin() + 3 * 2, {3.1, 1.7, -0.4});
    for (int &v : shape.faceVertices) {
        v += v >= 2;
    }
    return shape;
}

std::vector<Shape> makeShapes() {
    std::vector<Shape> shapes;
    shapes.push_back(makeTetrahedron());
    shapes.push_back(makeCube());
    shapes.push_back(makeOctahedron());
    shapes.push_back(MakeDual("dodecahedron", MakeIcosahedron()));
    shapes.push_back(MakeIcosahedron());
    for (int n : {3, 5, 6, 8, 12}) {
        shapes.push_back(MakePrism(n));
        shapes.push_back(makePyramid(n));
    }
    for (int n : {64, 360}) {
        shapes.push_back(MakePrism(n));
        shapes.push_back(MakeBipyramid(n));
    }
    shapes.push_back(makeDihedron(5));
    shapes.push_back(makeQuadTorus(8, 5));
    shapes.push_back(makeHexTorus(6, 5));
    shapes.push_back(makeGenus2());
    shapes.push_back(MakeTruncated("truncatedCube", makeCube()));
    shapes.push_back(MakeTruncated("truncatedIcosahedron", MakeIcosahedron()));
    shapes.push_back(MakeChamfered("chamferedCube", makeCube()));
    shapes.push_back(MakeUnion("twoComponents", MakePrism(5), makeTetrahedron(), 3));

    for (int n : {3, 4, 5, 6, 9}) {
        shapes.push_back(makePolygon(n));
    }
    shapes.push_back(makeGrid("quadGrid", 4, 3, false));
    shapes.push_back(makeGrid("triangleGrid", 4, 3, true));
    shapes.push_back(makeHexGrid(3, 4));
    shapes.push_back(makeMixedPatch());
    shapes.push_back(makeTube("openCylinder", 7, {{1, -1}, {1, 0}, {1, 1}}));
    shapes.push_back(makeTube("annulus", 6, {{1, 0}, {0.5, 0}}));
    shapes.push_back(makeDiscFan(7));
    shapes.push_back(MakeUnion("closedAndOpen", makeCube(), makeDiscFan(5), 4));
    shapes.push_back(makeIsolatedVertex());
    for (Shape &shape : shapes) {
        Deform(shape);
    }

    // A copy of the tests on another machine has its meshes elsewhere.
    char const *const folderThere = std::getenv("OPENSUBDIVHEX_MESHES_DIR");
    std::filesystem::path const folder = folderThere ? folderThere : OPENSUBDIVHEX_MESHES_DIR;
    for (char const *name : {"spot", "suzanne", "teapot"}) {
        std::filesystem::path const file = folder / (std::string(name) + ".obj");
        if (!folder.empty() && std::filesystem::exists(file)) {
            shapes.push_back(LoadObjShape(name, file.string()));
            if (!IsManifold(shapes.back())) {
                shapes.push_back(MakeSplit(std::string(name) + "Split", shapes.back()));
            }
        }
    }
    for (Shape &shape : shapes) {
        shape.closed = CountBoundaryEdges(shape) == 0;
        shape.manifold = IsManifold(shape);
    }
    return shapes;
}

} // namespace

Shape MakeIcosahedron() {
    ShapeBuilder builder("icosahedron");
    double const height = 1 / std::sqrt(5.0);
    for (int ring = 0; ring < 2; ++ring) {
        for (int i = 0; i < 5; ++i) {
            double const angle = 2 * kPi * (i + 0.5 * ring) / 5;
            builder.AddVertex(2 * height * std::cos(angle), 2 * height * std::sin(angle),
                              ring == 0 ? -height : height);
        }
    }
    int const south = builder.AddVertex(0, 0, -1);
    int const north = builder.AddVertex(0, 0, 1);
    for (int i = 0; i < 5; ++i) {
        int const j = (i + 1) % 5;
        builder.AddFace({j, i, south});
        builder.AddFace({i, j, 5 + i});
        builder.AddFace({j, 5 + j, 5 + i});
        builder.AddFace({5 + i, 5 + j, north});
    }
    return builder.Take();
}

Shape MakePrism(int n) {
    ShapeBuilder builder(numbered("prism", n));
    addRing(builder, n, 1, -0.8);
    addRing(builder, n, 1, 0.8);
    builder.AddFace(ringFace(n, 0, true));
    for (int i = 0; i < n; ++i) {
        int const j = (i + 1) % n;
        builder.AddFace({i, j, n + j, n + i});
    }
    builder.AddFace(ringFace(n, n, false));
    return builder.Take();
}

Shape MakeBipyramid(int n) {
    ShapeBuilder builder(numbered("bipyramid", n));
    addRing(builder, n, 1, 0);
    int const south = builder.AddVertex(0, 0, -1);
    int const north = builder.AddVertex(0, 0, 1);
    for (int i = 0; i < n; ++i) {
        builder.AddFace({i, (i + 1) % n, north});
        builder.AddFace({(i + 1) % n, i, south});
    }
    return builder.Take();
}

Shape MakePole(int n, int numTimes) {
    ShapeBuilder builder(numbered("pole", n));
    builder.AddVertex(0, 0, 1);
    constexpr int kNumRings = 3;
    for (int ring = 0; ring < kNumRings; ++ring) {
        addRing(builder, n, ring + 1, -ring);
    }
    for (int i = 0; i < n; ++i) {
        std::vector<int> face(std::size_t(numTimes), 0);
        face.insert(face.end(), {1 + i, 1 + (i + 1) % n});
        builder.AddFace(face);
    }
    for (int ring = 1; ring < kNumRings; ++ring) {
        int const inner = 1 + (ring - 1) * n;
        int const outer = inner + n;
        for (int i = 0; i < n; ++i) {
            int const next = (i + 1) % n;
            builder.AddFace({inner + i, outer + i, outer + next, inner + next});
        }
    }
    return builder.Take();
}

Shape MakePoleOfSpokes(int n) {
    Shape shape = MakePole(n, 1);
    for (int i = 0; i < n; ++i) {
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {0, 1 + i});
        shape.creaseSharpness.push_back(0.5F + 3 * float(i) / float(n));
    }
    return shape;
}

std::vector<Shape> const &GetShapes() {
    static std::vector<Shape> const shapes = makeShapes();
    return shapes;
}

std::vector<Shape> const &GetManifoldShapes() {
    static std::vector<Shape> const shapes = [] {
        std::vector<Shape> manifold;
        std::copy_if(GetShapes().begin(), GetShapes().end(), std::back_inserter(manifold),
                     [](Shape const &shape) { return shape.manifold; });
        return manifold;
    }();
    return shapes;
}

Shape const &GetShape(std::string const &name) {
    for (Shape const &shape : GetShapes()) {
        if (shape.name == name) {
            return shape;
        }
    }
    throw std::out_of_range("no shape is called " + name);
}

int GetTestLevel(Shape const &shape, int maxLevel, double maxCorners) {
    // C' = C + 6 Ei + 4 Eb where C = 2 Ei + Eb, so C' = 4C + Eb; Eb stays as it is.
    double const numBoundaryEdges = CountBoundaryEdges(shape);
    double corners = shape.GetNumCorners();
    maxCorners /= OPENSUBDIVHEX_TEST_DIVISOR;
    int level = 0;
    while (level < maxLevel && 4 * corners + numBoundaryEdges <= maxCorners) {
        corners = 4 * corners + numBoundaryEdges;
        ++level;
    }
    return level;
}

} // namespace OpenSubdivHex::Regression

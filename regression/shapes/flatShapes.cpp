// SPDX-License-Identifier: Apache-2.0
#include "flatShapes.h"

#include <array>
#include <cmath>
#include <map>

namespace OpenSubdivHex::Regression {

namespace {

void addFace(Shape &shape, std::vector<int> const &vertices) {
    shape.faceSizes.push_back(int(vertices.size()));
    shape.faceVertices.insert(shape.faceVertices.end(), vertices.begin(), vertices.end());
}

Shape withName(std::string name, Shape shape) {
    shape.name = std::move(name);
    return shape;
}

} // namespace

Shape MakeBox(int numX, int numY, int numZ) {
    std::array<int, 3> const size{numX, numY, numZ};
    Shape shape;
    shape.name = "box";
    shape.closed = true;
    shape.manifold = true;
    std::map<std::array<int, 3>, int> vertices;
    auto vertexAt = [&](std::array<int, 3> const &place) {
        auto const [known, isNew] = vertices.try_emplace(place, shape.GetNumVertices());
        if (isNew) {
            shape.positions.insert(shape.positions.end(), place.begin(), place.end());
        }
        return known->second;
    };
    for (int axis = 0; axis < 3; ++axis) {
        int const u = (axis + 1) % 3;
        int const v = (axis + 2) % 3;
        for (int side : {0, size[axis]}) {
            for (int i = 0; i < size[u]; ++i) {
                for (int j = 0; j < size[v]; ++j) {
                    // Counter-clockwise seen from the upper side of the axis.
                    std::vector<int> face;
                    for (auto const &[du, dv] :
                         {std::pair{0, 0}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 1}}) {
                        std::array<int, 3> place{};
                        place[axis] = side;
                        place[u] = i + du;
                        place[v] = j + dv;
                        face.push_back(vertexAt(place));
                    }
                    if (side == 0) {
                        std::swap(face[1], face[3]);
                    }
                    addFace(shape, face);
                }
            }
        }
    }
    return shape;
}

Shape MakePrism(int numSides, int numColumns, int numRows) {
    double const pi = std::acos(-1.0);
    int const ring = numSides * numColumns;
    Shape shape;
    shape.name = "prism";
    shape.closed = true;
    shape.manifold = true;
    for (int row = 0; row <= numRows; ++row) {
        for (int side = 0; side < numSides; ++side) {
            double const start = 2 * pi * side / numSides;
            double const end = 2 * pi * (side + 1) / numSides;
            for (int column = 0; column < numColumns; ++column) {
                double const t = double(column) / numColumns;
                shape.positions.insert(shape.positions.end(),
                                       {(1 - t) * std::cos(start) + t * std::cos(end),
                                        (1 - t) * std::sin(start) + t * std::sin(end),
                                        double(row)});
            }
        }
    }
    std::vector<int> bottom;
    std::vector<int> top;
    for (int i = 0; i < ring; ++i) {
        bottom.push_back(ring - 1 - i);
        top.push_back(numRows * ring + i);
        for (int row = 0; row < numRows; ++row) {
            int const next = (i + 1) % ring;
            addFace(shape, {row * ring + i, row * ring + next, (row + 1) * ring + next,
                            (row + 1) * ring + i});
        }
    }
    addFace(shape, bottom);
    addFace(shape, top);
    return shape;
}

std::vector<Shape> const &GetFlatShapes() {
    static std::vector<Shape> const shapes{
        withName("box111", MakeBox(1, 1, 1)),       withName("box222", MakeBox(2, 2, 2)),
        withName("box321", MakeBox(3, 2, 1)),       withName("box143", MakeBox(1, 4, 3)),
        withName("prism3x2x2", MakePrism(3, 2, 2)), withName("prism5x3x1", MakePrism(5, 3, 1)),
        withName("prism6x1x3", MakePrism(6, 1, 3)), withName("prism30x2x4", MakePrism(30, 2, 4)),
    };
    return shapes;
}

} // namespace OpenSubdivHex::Regression

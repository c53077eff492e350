// SPDX-License-Identifier: Apache-2.0
#include "meshes.h"

#include "regression/shapes/meshOperations.h"

#include <cmath>
#include <random>

namespace OpenSubdivHex::Regression {
namespace {

/// What the faces of a torus are.
enum class Faces {
    Quads,
    Triangles,         ///< quads that are cut in two
    IrregularTriangles ///< the same, each quad along a diagonal by chance
};

/// numU x numV quads, or what they are cut into.
Shape makeTorus(char const *name, int numU, int numV, Faces faces) {
    double const kTwoPi = 2 * std::acos(-1.0);
    Shape shape;
    shape.name = name;
    std::mt19937 random;
    for (int u = 0; u < numU; ++u) {
        for (int v = 0; v < numV; ++v) {
            double const radius = 1 + 0.4 * std::cos(kTwoPi * v / numV);
            double const angle = kTwoPi * u / numU;
            shape.positions.push_back(radius * std::cos(angle));
            shape.positions.push_back(radius * std::sin(angle));
            shape.positions.push_back(0.4 * std::sin(kTwoPi * v / numV));
        }
    }
    auto const addFace = [&](std::vector<int> const &vertices) {
        shape.faceSizes.push_back(int(vertices.size()));
        shape.faceVertices.insert(shape.faceVertices.end(), vertices.begin(), vertices.end());
    };
    auto const vertex = [&](int u, int v) { return u % numU * numV + v % numV; };
    for (int u = 0; u < numU; ++u) {
        for (int v = 0; v < numV; ++v) {
            int const a = vertex(u, v);
            int const b = vertex(u + 1, v);
            int const c = vertex(u + 1, v + 1);
            int const d = vertex(u, v + 1);
            if (faces == Faces::IrregularTriangles && random() % 2 == 0) {
                addFace({a, b, d});
                addFace({b, c, d});
            } else if (faces != Faces::Quads) {
                addFace({a, b, c});
                addFace({a, c, d});
            } else {
                addFace({a, b, c, d});
            }
        }
    }
    shape.closed = true;
    shape.manifold = true;
    return shape;
}

} // namespace

Shape MakeQuadMesh() { return makeTorus("quad", 48, 32, Faces::Quads); }

Shape MakeTriangleMesh() { return makeTorus("triangle", 64, 40, Faces::Triangles); }

Shape MakeIrregularMesh() { return makeTorus("irregular", 64, 40, Faces::IrregularTriangles); }

Shape MakeHexMesh() { return MakeDual("hex", MakeTriangleMesh()); }

Shape MakeSmallQuadMesh() { return makeTorus("small quad", 24, 16, Faces::Quads); }

Shape MakeLargeMesh(bool triangles) {
    return makeTorus(triangles ? "large triangle" : "large quad", 1000, 640,
                     triangles ? Faces::Triangles : Faces::Quads);
}

double CountEdges(Shape const &shape) { return shape.GetNumCorners() / 2.0; }

// After the first step all faces are quads: F' = C, then F' = 4F, and V' = V + F + E.
double CountCatmarkVertices(Shape const &shape, int level) {
    double numVertices = shape.GetNumVertices();
    double numFaces = shape.GetNumFaces();
    double numEdges = CountEdges(shape);
    for (int i = 0; i < level; ++i) {
        numVertices += numFaces + numEdges;
        numFaces = i == 0 ? shape.GetNumCorners() : 4 * numFaces;
        numEdges = 2 * numFaces;
    }
    return numVertices;
}

// One vertex per corner, V' = 2E, and E' = 4E.
double CountDooSabinVertices(Shape const &shape, int level) {
    return level == 0 ? shape.GetNumVertices() : 2 * CountEdges(shape) * std::pow(4.0, level - 1);
}

} // namespace OpenSubdivHex::Regression

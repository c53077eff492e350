// SPDX-License-Identifier: Apache-2.0
#include "meshes.h"

#include "regression/shapes/meshOperations.h"

#include <cmath>

namespace OpenSubdivHex::Regression {
namespace {

/// numU x numV quads, each of them cut in two if \p triangles.
Shape makeTorus(char const *name, int numU, int numV, bool triangles) {
    double const kTwoPi = 2 * std::acos(-1.0);
    Shape shape;
    shape.name = name;
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
            if (triangles) {
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

Shape MakeQuadMesh() { return makeTorus("quad", 48, 32, false); }

Shape MakeTriangleMesh() { return makeTorus("triangle", 64, 40, true); }

Shape MakeHexMesh() { return MakeDual("hex", MakeTriangleMesh()); }

Shape MakeSmallQuadMesh() { return makeTorus("small quad", 24, 16, false); }

Shape MakeLargeMesh(bool triangles) {
    return makeTorus(triangles ? "large triangle" : "large quad", 1000, 640, triangles);
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

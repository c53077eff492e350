// SPDX-License-Identifier: Apache-2.0
#include "meshes.h"

#include "regression/shapes/meshOperations.h"
#include "regression/shapes/torus.h"

#include <cmath>

namespace OpenSubdivHex::Regression {
namespace {

Shape makeTorus(char const *name, int numU, int numV, TorusFaces faces) {
    Shape shape = MakeTorus(numU, numV, faces, 1, 0.4);
    shape.name = name;
    return shape;
}

} // namespace

Shape MakeQuadMesh() { return makeTorus("quad", 48, 32, TorusFaces::Quads); }

Shape MakeTriangleMesh() { return makeTorus("triangle", 64, 40, TorusFaces::Triangles); }

Shape MakeIrregularMesh() { return makeTorus("irregular", 64, 40, TorusFaces::IrregularTriangles); }

Shape MakeHexMesh() { return MakeDual("hex", MakeTriangleMesh()); }

Shape MakeSmallQuadMesh() { return makeTorus("small quad", 24, 16, TorusFaces::Quads); }

Shape MakeLargeMesh(bool triangles) {
    return makeTorus(triangles ? "large triangle" : "large quad", 1000, 640,
                     triangles ? TorusFaces::Triangles : TorusFaces::Quads);
}

Shape MakeFrameMesh() { return makeTorus("frame", 400, 250, TorusFaces::Quads); }

double CountEdges(Shape const &shape) { return shape.GetNumCorners() / 2.0; }

// All vertices stay, and each corner has another one.  E' = 4E.
double CountHexVertices(Shape const &shape, int level) {
    double numVertices = shape.GetNumVertices();
    double numEdges = CountEdges(shape);
    for (int i = 0; i < level; ++i) {
        numVertices += 2 * numEdges;
        numEdges *= 4;
    }
    return numVertices;
}

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

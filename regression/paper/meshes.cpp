// SPDX-License-Identifier: Apache-2.0
#include "meshes.h"

#include "regression/shapes/meshOperations.h"
#include "regression/shapes/objShape.h"

#include <algorithm>

namespace OpenSubdivHex::Regression {

Shape MakeDodecahedron() { return MakeDual("dodecahedron", MakeIcosahedron()); }

Shape LoadTutorialMesh(std::string const &name) {
    Shape shape = LoadObjShape(name, TUTORIAL_MESHES_DIR "/" + name + ".obj");
    for (int vertex = 0; vertex < shape.GetNumVertices(); ++vertex) {
        double *const p = &shape.positions[3 * vertex]; // y up in the file
        std::rotate(p, p + 2, p + 3);
    }
    return shape;
}

} // namespace OpenSubdivHex::Regression

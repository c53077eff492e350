// SPDX-License-Identifier: Apache-2.0
#include "torus.h"

#include <cmath>
#include <random>

namespace OpenSubdivHex::Regression {

Shape MakeTorus(int numU, int numV, TorusFaces faces, double radius, double tubeRadius) {
    double const kTwoPi = 2 * std::acos(-1.0);
    Shape shape;
    shape.name = "torus";
    shape.closed = true;
    shape.manifold = true;
    for (int u = 0; u < numU; ++u) {
        for (int v = 0; v < numV; ++v) {
            double const angle = kTwoPi * u / numU;
            double const tubeAngle = kTwoPi * v / numV;
            double const out = radius + tubeRadius * std::cos(tubeAngle);
            shape.positions.insert(
                shape.positions.end(),
                {out * std::cos(angle), out * std::sin(angle), tubeRadius * std::sin(tubeAngle)});
        }
    }
    auto const addFace = [&](std::initializer_list<int> vertices) {
        shape.faceSizes.push_back(int(vertices.size()));
        shape.faceVertices.insert(shape.faceVertices.end(), vertices);
    };
    auto const vertex = [&](int u, int v) { return u % numU * numV + v % numV; };
    std::mt19937 random;
    for (int u = 0; u < numU; ++u) {
        for (int v = 0; v < numV; ++v) {
            int const a = vertex(u, v);
            int const b = vertex(u + 1, v);
            int const c = vertex(u + 1, v + 1);
            int const d = vertex(u, v + 1);
            if (faces == TorusFaces::Quads) {
                addFace({a, b, c, d});
            } else if (faces == TorusFaces::IrregularTriangles && random() % 2 == 0) {
                addFace({a, b, d});
                addFace({b, c, d});
            } else {
                addFace({a, b, c});
                addFace({a, c, d});
            }
        }
    }
    return shape;
}

} // namespace OpenSubdivHex::Regression

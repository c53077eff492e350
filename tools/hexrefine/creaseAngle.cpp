// SPDX-License-Identifier: Apache-2.0
#include "creaseAngle.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace OpenSubdivHex::Tools {

namespace {

using Vector = std::array<double, 3>;

Vector cross(Vector const &a, Vector const &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(Vector const &a, Vector const &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Newell's normal, 1 long or 0, from the first vertex of the face so that its place costs no
/// precision.
Vector computeNormal(Mesh const &mesh, int const *vertices, int size) {
    auto const edgeTo = [&](int i) {
        Vector vector;
        for (std::size_t k = 0; k < 3; ++k) {
            vector[k] = double(mesh.positions[3 * std::size_t(vertices[i]) + k]) -
                        double(mesh.positions[3 * std::size_t(vertices[0]) + k]);
        }
        return vector;
    };
    Vector normal = {0, 0, 0};
    for (int i = 1; i + 1 < size; ++i) {
        Vector const area = cross(edgeTo(i), edgeTo(i + 1));
        for (std::size_t k = 0; k < 3; ++k) {
            normal[k] += area[k];
        }
    }
    double const length = std::hypot(normal[0], normal[1], normal[2]);
    for (double &number : normal) {
        number /= length > 0 ? length : 1;
    }
    return normal;
}

/// From 0 to pi; 0 when one of the vectors is 0.
double computeAngle(Vector const &a, Vector const &b) {
    Vector const sine = cross(a, b);
    return std::atan2(std::sqrt(dot(sine, sine)), dot(a, b));
}

/// One side of an edge: a face, and whether it runs the edge from the lower vertex to the higher.
struct Side {
    std::pair<int, int> edge;
    int face;
    bool isForward;
};

} // namespace

void AddCreases(double degrees, Mesh *mesh) {
    std::vector<Vector> normals;
    std::vector<Side> sides;
    normals.reserve(mesh->faceSizes.size());
    sides.reserve(mesh->faceVertices.size());
    int const *vertices = mesh->faceVertices.data();
    for (int size : mesh->faceSizes) {
        for (int i = 0; i < size; ++i) {
            int const next = vertices[(i + 1) % size];
            sides.push_back(
                {std::minmax(vertices[i], next), int(normals.size()), vertices[i] < next});
        }
        normals.push_back(computeNormal(*mesh, vertices, size));
        vertices += size;
    }
    std::sort(sides.begin(), sides.end(),
              [](Side const &a, Side const &b) { return a.edge < b.edge; });

    MeshTags &tags = mesh->tags;
    std::map<std::pair<int, int>, float> creases;
    for (std::size_t i = 0; i < tags.creaseSharpness.size(); ++i) {
        creases[std::minmax(tags.creaseVertices[2 * i], tags.creaseVertices[2 * i + 1])] =
            tags.creaseSharpness[i];
    }
    double const maxAngle = degrees * std::acos(-1.0) / 180;
    for (auto side = sides.begin(); side != sides.end();) {
        auto const end = std::find_if(side, sides.end(),
                                      [&](Side const &other) { return other.edge != side->edge; });
        if (end - side == 2 && side[0].isForward != side[1].isForward &&
            computeAngle(normals[side[0].face], normals[side[1].face]) > maxAngle) {
            creases[side->edge] = OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE;
        }
        side = end;
    }
    tags.creaseVertices.clear();
    tags.creaseSharpness.clear();
    for (auto const &[edge, sharpness] : creases) {
        tags.creaseVertices.insert(tags.creaseVertices.end(), {edge.first, edge.second});
        tags.creaseSharpness.push_back(sharpness);
    }
}

} // namespace OpenSubdivHex::Tools

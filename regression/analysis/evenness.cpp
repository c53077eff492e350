// SPDX-License-Identifier: Apache-2.0
#include "evenness.h"

#include "smoothness.h"

#include <opensubdiv/sdc/crease.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace OpenSubdivHex::Regression {

namespace {

using Eigen::Vector3d;

double const kPi = std::acos(-1.0);

/// Groups of MeasureTorusUnevenness.
constexpr int kNumParallels = 128;

void addVertex(Vector3d const &position, Shape &shape) {
    shape.positions.insert(shape.positions.end(), position.begin(), position.end());
}

void addFace(std::initializer_list<int> vertices, Shape &shape) {
    shape.faceSizes.push_back(int(vertices.size()));
    shape.faceVertices.insert(shape.faceVertices.end(), vertices);
}

/// The triangles that have all other points behind them; of points in general position on a sphere.
void addHull(std::vector<Vector3d> const &points, Shape &shape) {
    int const numPoints = int(points.size());
    for (int a = 0; a < numPoints; ++a) {
        for (int b = a + 1; b < numPoints; ++b) {
            for (int c = b + 1; c < numPoints; ++c) {
                Vector3d const normal = (points[b] - points[a]).cross(points[c] - points[a]);
                double const height = normal.dot(points[a]);
                double const side = height < 0 ? -1 : 1;
                bool const isOutside =
                    std::all_of(points.begin(), points.end(), [&](Vector3d const &point) {
                        return side * (normal.dot(point) - height) < 1e-12;
                    });
                if (isOutside && side > 0) {
                    addFace({a, b, c}, shape);
                } else if (isOutside) {
                    addFace({a, c, b}, shape);
                }
            }
        }
    }
}

Shape makeHull(char const *name, std::vector<Vector3d> const &points) {
    Shape shape;
    shape.name = name;
    for (Vector3d const &point : points) {
        addVertex(point, shape);
    }
    addHull(points, shape);
    return shape;
}

} // namespace

std::vector<double> ComputeVertexAreas(PolygonMesh const &mesh) {
    std::vector<double> areas(mesh.positions.size(), 0.0);
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        int const size = mesh.GetFaceSize(face);
        Vector3d const first = mesh.positions[mesh.GetFaceVertex(face, 0)];
        Vector3d doubled = Vector3d::Zero();
        for (int i = 2; i < size; ++i) {
            doubled += (mesh.positions[mesh.GetFaceVertex(face, i - 1)] - first)
                           .cross(mesh.positions[mesh.GetFaceVertex(face, i)] - first);
        }
        for (int i = 0; i < size; ++i) {
            areas[mesh.GetFaceVertex(face, i)] += doubled.norm() / 2 / size;
        }
    }
    return areas;
}

Eigen::VectorXd MeasureDeviations(PolygonMesh const &mesh, std::vector<int> const &vertices,
                                  std::vector<int> const &groups, Curvature curvature) {
    struct Sum {
        double area = 0;
        double curvature = 0;
    };
    std::vector<double> const areas = ComputeVertexAreas(mesh);
    std::map<int, Sum> sums;
    Sum all;
    Eigen::VectorXd values(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        auto const [smaller, larger] = EstimateCurvatures(mesh, vertices[i]);
        double const value =
            curvature == Curvature::Mean ? (smaller + larger) / 2 : smaller * larger;
        values[Eigen::Index(i)] = value;
        for (Sum *sum : {&sums[groups[i]], &all}) {
            sum->area += areas[vertices[i]];
            sum->curvature += areas[vertices[i]] * value;
        }
    }
    double const mean = std::abs(all.curvature / all.area);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        Sum const &sum = sums[groups[i]];
        double &value = values[Eigen::Index(i)];
        value =
            std::sqrt(areas[vertices[i]] / all.area) * (value - sum.curvature / sum.area) / mean;
    }
    return values;
}

double MeasureUnevenness(PolygonMesh const &mesh, std::vector<int> const &vertices,
                         std::vector<int> const &groups, Curvature curvature) {
    return MeasureDeviations(mesh, vertices, groups, curvature).norm();
}

double MeasureSphereUnevenness(PolygonMesh const &mesh) {
    std::vector<int> vertices(mesh.positions.size());
    std::iota(vertices.begin(), vertices.end(), 0);
    return MeasureUnevenness(mesh, vertices, std::vector<int>(vertices.size(), 0));
}

namespace {

/// The vertices of one sector whose angle around the tube, in turns, isWanted, by parallels.
template <typename IS_WANTED>
VertexGroups findInSector(PolygonMesh const &mesh, int numU, IS_WANTED isWanted) {
    VertexGroups result;
    for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
        Vector3d const &position = mesh.positions[vertex];
        double const around = std::atan2(position.y(), position.x());
        double const out = std::hypot(position.x(), position.y()) - kTorusRadius;
        double const angle = std::atan2(position.z(), out) / (2 * kPi);
        if (around >= 0 && around < 2 * kPi / numU && isWanted(angle)) {
            result.vertices.push_back(vertex);
            result.groups.push_back(int(std::floor(angle * kNumParallels)));
        }
    }
    return result;
}

double measure(PolygonMesh const &mesh, VertexGroups const &chosen) {
    return MeasureUnevenness(mesh, chosen.vertices, chosen.groups);
}

} // namespace

VertexGroups FindTorusSector(PolygonMesh const &mesh, int numU) {
    return findInSector(mesh, numU, [](double) { return true; });
}

double MeasureTorusUnevenness(PolygonMesh const &mesh, int numU) {
    return measure(mesh, FindTorusSector(mesh, numU));
}

VertexGroups FindTorusStrip(PolygonMesh const &mesh, int numU, double line, double rowWidth,
                            int strip) {
    constexpr double kMargin = 0.125;
    double const kept = (2 + std::cos(2 * kPi / numU)) / 3; // of the radius, at vertices
    double const radius = kTorusRadius + kTubeRadius * std::cos(2 * kPi * line);
    line = std::atan2(kTubeRadius * std::sin(2 * kPi * line), kept * radius - kTorusRadius) /
           (2 * kPi);
    return findInSector(mesh, numU, [&](double angle) {
        double const turns = angle - line;
        double const rows = (turns - std::round(turns)) / rowWidth;
        return rows >= std::max(double(strip), kMargin) && rows < strip + 1;
    });
}

std::vector<double> MeasureTorusStrips(PolygonMesh const &mesh, int numU, double line,
                                       double rowWidth, int numStrips) {
    std::vector<double> result;
    for (int strip = 0; strip < numStrips; ++strip) {
        result.push_back(measure(mesh, FindTorusStrip(mesh, numU, line, rowWidth, strip)));
    }
    return result;
}

Shape MakeCreasedTorus(int numU, int numV, TorusFaces faces) {
    Shape shape = MakeTorus(numU, numV, faces);
    for (int i = 0; i < numU; ++i) {
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                       {i * numV, (i + 1) % numU * numV});
        shape.creaseSharpness.push_back(OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE);
    }
    return shape;
}

Shape MakeOpenTorus(int numU, int numV, TorusFaces faces) {
    Shape shape = MakeTorus(numU, numV, faces);
    shape.closed = false;
    int const facesPerQuad = faces == TorusFaces::Quads ? 1 : 2;
    int const size = faces == TorusFaces::Quads ? 4 : 3;
    for (int i = numU - 1; i >= 0; --i) {
        auto const first = std::ptrdiff_t(i) * numV * facesPerQuad;
        shape.faceSizes.erase(shape.faceSizes.begin() + first,
                              shape.faceSizes.begin() + first + facesPerQuad);
        shape.faceVertices.erase(shape.faceVertices.begin() + first * size,
                                 shape.faceVertices.begin() + (first + facesPerQuad) * size);
    }
    return shape;
}

std::vector<Shape> MakeTrianglePlatonics() {
    Shape icosahedron = MakeIcosahedron();
    icosahedron.name = "icosahedron";
    return {makeHull("tetrahedron", {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}),
            makeHull("octahedron",
                     {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}),
            icosahedron};
}

Shape MakeSphereHull(int numPoints, int numSteps) {
    std::mt19937 random(1);
    auto const draw = [&random] { return 2.0 * random() / double(std::mt19937::max()) - 1; };
    std::vector<Vector3d> points;
    while (int(points.size()) < numPoints) {
        Vector3d const point(draw(), draw(), draw());
        if (point.norm() < 1 && point.norm() > 0.1) {
            points.push_back(point.normalized());
        }
    }
    for (int step = 0; step < numSteps; ++step) {
        std::vector<Vector3d> moved = points;
        for (int i = 0; i < numPoints; ++i) {
            Vector3d force = Vector3d::Zero();
            for (int j = 0; j < numPoints; ++j) {
                Vector3d const offset = points[i] - points[j];
                force += offset / std::max(1e-12, std::pow(offset.norm(), 3));
            }
            moved[i] = (points[i] + force / (2 * numPoints * std::sqrt(numPoints))).normalized();
        }
        points = moved;
    }
    return makeHull("sphere hull", points);
}

Shape MakeSphereOfQuads(Shape const &shape) {
    PolygonMesh const mesh = RefineSurface(shape, OpenSubdiv::Sdc::SCHEME_CATMARK, 1).back().mesh;
    Shape result;
    result.name = shape.name + " in quads";
    result.faceVertices = mesh.faceVertices;
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        result.faceSizes.push_back(mesh.GetFaceSize(face));
    }
    for (Vector3d const &position : mesh.positions) {
        addVertex(position.normalized(), result);
    }
    return result;
}

} // namespace OpenSubdivHex::Regression

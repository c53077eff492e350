// SPDX-License-Identifier: Apache-2.0
#include "ripple.h"

#include "evenness.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

using Point = std::complex<double>;

double const kPi = std::acos(-1.0);

/// Rings of control faces: curvature up to the distance 1 does not know where the mesh ends.
constexpr int kNumControlRings = 3;

/// The height of the control points, so small that slopes do not matter.
constexpr double kHeight = 1e-3;

int countRegularSectors(Tiling tiling) {
    return tiling == Tiling::Triangles ? 6 : tiling == Tiling::Quads ? 4 : 3;
}

/// The faces of one sector of a regular tiling around the vertex at the origin.
std::vector<std::vector<Point>> makeSector(Tiling tiling, int numRings) {
    auto const turn = [](int degrees) { return std::polar(1.0, degrees * kPi / 180); };
    std::vector<std::vector<Point>> faces;
    for (int i = 0; i < numRings; ++i) {
        for (int j = 0; j < numRings; ++j) {
            if (tiling == Tiling::Quads) {
                Point const first(i, j);
                faces.push_back(
                    {first, first + turn(0), first + turn(0) + turn(90), first + turn(90)});
            } else if (tiling == Tiling::Triangles) {
                Point const first = double(i) * turn(0) + double(j) * turn(60);
                if (i + j < numRings) {
                    faces.push_back({first, first + turn(0), first + turn(60)});
                }
                if (i + j < numRings - 1) {
                    faces.push_back(
                        {first + turn(0), first + turn(0) + turn(60), first + turn(60)});
                }
            } else {
                // A corner of the first is the origin; three such wedges of 120 degrees are the plane.
                Point const middle =
                    1.0 + std::sqrt(3.0) * (double(i) * turn(-90) + double(j) * turn(30));
                std::vector<Point> face(6);
                for (int corner = 0; corner < 6; ++corner) {
                    face[corner] = middle + turn(180 + 60 * corner);
                }
                faces.push_back(face);
            }
        }
    }
    return faces;
}

} // namespace

Shape MakeVertexDisk(Tiling tiling, int valence, int numRings, DiskPart part) {
    constexpr double kTolerance = 1e-6;
    std::vector<Point> points{0};
    auto const findPoint = [&points](Point const &point) {
        auto const found = std::find_if(points.begin(), points.end(), [&](Point const &other) {
            return std::abs(other - point) < kTolerance;
        });
        auto const number = int(found - points.begin());
        if (found == points.end()) {
            points.push_back(point);
        }
        return number;
    };
    Shape shape;
    shape.name = "vertex disk";
    int const numRegular = countRegularSectors(tiling);
    double const parts = part == DiskPart::Half ? 2.0 * valence : valence;
    for (int sector = 0; sector < valence; ++sector) {
        for (std::vector<Point> const &face : makeSector(tiling, numRings)) {
            shape.faceSizes.push_back(int(face.size()));
            for (Point const &corner : face) {
                double const angle = std::arg(corner) * numRegular + 2 * kPi * sector;
                double const distance = std::abs(corner);
                shape.faceVertices.push_back(
                    distance < kTolerance ? 0 : findPoint(std::polar(distance, angle / parts)));
            }
        }
    }
    for (Point const &point : points) {
        shape.positions.insert(shape.positions.end(), {point.real(), point.imag(), 0});
    }
    return shape;
}

std::vector<int> FindRing(PolygonMesh const &mesh, int ring) {
    std::vector<int> vertices;
    for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
        double const distance = mesh.positions[vertex].head<2>().norm();
        if (distance < std::ldexp(1.0, -ring) && distance >= std::ldexp(0.5, -ring)) {
            vertices.push_back(vertex);
        }
    }
    if (vertices.empty()) {
        throw std::runtime_error("a ring without vertices");
    }
    return vertices;
}

std::vector<double> MeasureRipple(Tiling tiling, int valence, AnyScheme const &scheme,
                                  Quadratic quadratic, int numRings, int level) {
    Shape shape = MakeVertexDisk(tiling, valence, kNumControlRings);
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        double const x = shape.positions[i];
        double const y = shape.positions[i + 1];
        shape.positions[i + 2] =
            kHeight * (quadratic == Quadratic::Elliptic ? x * x + y * y : x * x - y * y);
    }
    PolygonMesh const mesh = RefineSurface(shape, scheme, level).back().mesh;

    // All sectors of the elliptic one are alike, and one is looked at; no vertices lie in a line from
    // the origin where it begins.
    double const firstAngle = quadratic == Quadratic::Elliptic ? 0.01 : -kPi;
    double const lastAngle = quadratic == Quadratic::Elliptic ? firstAngle + 2 * kPi / valence : 4;
    Curvature const curvature =
        quadratic == Quadratic::Elliptic ? Curvature::Mean : Curvature::Gaussian;
    std::vector<double> ripple;
    for (int ring = 0; ring < numRings; ++ring) {
        std::vector<int> vertices = FindRing(mesh, ring);
        vertices.erase(std::remove_if(vertices.begin(), vertices.end(),
                                      [&](int vertex) {
                                          auto const position = mesh.positions[vertex].head<2>();
                                          double const angle =
                                              std::atan2(position.y(), position.x());
                                          return angle < firstAngle || angle >= lastAngle;
                                      }),
                       vertices.end());
        ripple.push_back(
            MeasureUnevenness(mesh, vertices, std::vector<int>(vertices.size(), 0), curvature));
    }
    return ripple;
}

} // namespace OpenSubdivHex::Regression

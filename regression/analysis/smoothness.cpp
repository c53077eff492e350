// SPDX-License-Identifier: Apache-2.0
#include "smoothness.h"

#include "spectrum.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

namespace {

using Eigen::Vector3d;

Vector3d computeCentroid(PolygonMesh const &mesh, int face) {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < mesh.GetFaceSize(face); ++i) {
        sum += mesh.positions[mesh.GetFaceVertex(face, i)];
    }
    return sum / mesh.GetFaceSize(face);
}

/// The vector area, not normalized.
Vector3d computeNormal(PolygonMesh const &mesh, int face) {
    Vector3d const first = mesh.positions[mesh.GetFaceVertex(face, 0)];
    Vector3d normal = Vector3d::Zero();
    for (int i = 2; i < mesh.GetFaceSize(face); ++i) {
        normal += (mesh.positions[mesh.GetFaceVertex(face, i - 1)] - first)
                      .cross(mesh.positions[mesh.GetFaceVertex(face, i)] - first);
    }
    return normal;
}

void insert(int value, std::vector<int> *values) {
    if (std::find(values->begin(), values->end(), value) == values->end()) {
        values->push_back(value);
    }
}

/// The vertices of the faces that touch one of \p vertices, each once, \p vertices first.
std::vector<int> addRing(PolygonMesh const &mesh, std::vector<int> vertices) {
    std::vector<int> const inner = vertices;
    for (int vertex : inner) {
        for (int k = mesh.vertexFirst[vertex]; k < mesh.vertexFirst[vertex + 1]; ++k) {
            int const face = mesh.vertexFaces[k];
            for (int i = 0; i < mesh.GetFaceSize(face); ++i) {
                insert(mesh.GetFaceVertex(face, i), &vertices);
            }
        }
    }
    return vertices;
}

/// A vertex and those that it shares an edge with.
std::vector<int> findNeighbors(PolygonMesh const &mesh, int vertex) {
    std::vector<int> neighbors{vertex};
    for (int k = mesh.vertexFirst[vertex]; k < mesh.vertexFirst[vertex + 1]; ++k) {
        int const face = mesh.vertexFaces[k];
        int const size = mesh.GetFaceSize(face);
        for (int i = 0; i < size; ++i) {
            if (mesh.GetFaceVertex(face, i) == vertex) {
                insert(mesh.GetFaceVertex(face, (i + 1) % size), &neighbors);
                insert(mesh.GetFaceVertex(face, (i + size - 1) % size), &neighbors);
            }
        }
    }
    return neighbors;
}

} // namespace

Smoothness MeasureSmoothness(PolygonMesh const &mesh) {
    std::vector<Vector3d> normals;
    std::vector<Vector3d> centroids;
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        normals.push_back(computeNormal(mesh, face));
        centroids.push_back(computeCentroid(mesh, face));
    }
    Smoothness smoothness;
    for (auto const [a, b] : mesh.edgeFaces) {
        double const angle =
            std::atan2(normals[a].cross(normals[b]).norm(), normals[a].dot(normals[b]));
        smoothness.maxNormalAngle = std::max(smoothness.maxNormalAngle, angle);
        smoothness.maxCurvature =
            std::max(smoothness.maxCurvature, angle / (centroids[a] - centroids[b]).norm());
    }
    return smoothness;
}

std::vector<int> FindNearVertices(PolygonMesh const &mesh, int vertex) {
    return addRing(mesh, findNeighbors(mesh, vertex));
}

std::array<double, 2> EstimateCurvatures(PolygonMesh const &mesh, int vertex) {
    Vector3d normal = Vector3d::Zero();
    for (int k = mesh.vertexFirst[vertex]; k < mesh.vertexFirst[vertex + 1]; ++k) {
        normal += computeNormal(mesh, mesh.vertexFaces[k]).normalized();
    }
    normal.normalize();
    Vector3d const xAxis = normal.unitOrthogonal();
    Vector3d const yAxis = normal.cross(xAxis);

    // z = a + b x + c y + d x^2 + e x y + f y^2, in units of the neighbourhood's size.
    std::vector<int> const points = FindNearVertices(mesh, vertex);
    double size = 0;
    for (int point : points) {
        size = std::max(size, (mesh.positions[point] - mesh.positions[vertex]).norm());
    }
    Eigen::Index const count = Eigen::Index(points.size());
    Eigen::Matrix<double, Eigen::Dynamic, 6> terms(count, 6);
    Eigen::VectorXd heights(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        Vector3d const offset = (mesh.positions[points[i]] - mesh.positions[vertex]) / size;
        double const x = offset.dot(xAxis);
        double const y = offset.dot(yAxis);
        terms.row(i) << 1, x, y, x * x, x * y, y * y;
        heights(i) = offset.dot(normal);
    }
    Eigen::VectorXd const fit = terms.colPivHouseholderQr().solve(heights);

    Eigen::Matrix2d first;
    first << 1 + fit(1) * fit(1), fit(1) * fit(2), fit(1) * fit(2), 1 + fit(2) * fit(2);
    Eigen::Matrix2d second;
    second << 2 * fit(3), fit(4), fit(4), 2 * fit(5);
    second /= std::sqrt(1 + fit(1) * fit(1) + fit(2) * fit(2)) * size;
    Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> const solver(second, first);
    return {solver.eigenvalues()(0), solver.eigenvalues()(1)};
}

double MeasureCurvature(PolygonMesh const &mesh, MeshCenter center) {
    std::vector<int> vertices{center.index};
    if (center.kind == CenterKind::Face) {
        auto const first = mesh.faceVertices.begin() + mesh.faceFirst[center.index];
        vertices.assign(first, first + mesh.GetFaceSize(center.index));
    }
    double largest = 0;
    for (int vertex : addRing(mesh, vertices)) {
        for (double curvature : EstimateCurvatures(mesh, vertex)) {
            largest = std::max(largest, std::abs(curvature));
        }
    }
    return largest;
}

PolygonMesh MakePlanarMesh(LocalSubdivision const &subdivision, Eigen::VectorXcd const &map) {
    PolygonMesh mesh;
    for (std::complex<double> position : map) {
        mesh.positions.emplace_back(position.real(), position.imag(), 0);
    }
    std::vector<std::vector<int>> vertexFaces(subdivision.GetNumVertices());
    mesh.faceFirst.push_back(0);
    for (std::vector<int> const &face : subdivision.faces) {
        for (int vertex : face) {
            vertexFaces[vertex].push_back(mesh.GetNumFaces());
            mesh.faceVertices.push_back(vertex);
        }
        mesh.faceFirst.push_back(int(mesh.faceVertices.size()));
    }
    mesh.vertexFirst.push_back(0);
    for (std::vector<int> const &faces : vertexFaces) {
        mesh.vertexFaces.insert(mesh.vertexFaces.end(), faces.begin(), faces.end());
        mesh.vertexFirst.push_back(int(mesh.vertexFaces.size()));
    }
    return mesh;
}

std::vector<double> TraceCurvature(LocalSubdivision const &subdivision, int numSteps) {
    Eigen::VectorXcd const map = ComputeCharacteristicMap(subdivision);
    Eigen::Matrix<double, Eigen::Dynamic, 3> positions(map.size(), 3);
    constexpr double kHeight = 1e-3; // nearly flat, so that slopes do not matter
    positions << map.real(), map.imag(), kHeight * (map.cwiseAbs2() + map.cwiseProduct(map).real());

    PolygonMesh mesh = MakePlanarMesh(subdivision, map);
    int const numCenterVertices =
        subdivision.centerKind == CenterKind::Vertex ? 1 : subdivision.order;
    std::vector<double> curvatures;
    for (int step = 0; step <= numSteps; ++step) {
        for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
            mesh.positions[vertex] = positions.row(vertex);
        }
        double largest = 0;
        for (int vertex = 0; vertex < numCenterVertices; ++vertex) {
            for (double curvature : EstimateCurvatures(mesh, vertex)) {
                largest = std::max(largest, std::abs(curvature));
            }
        }
        curvatures.push_back(largest / kHeight);
        positions = subdivision.matrix * positions;
    }
    return curvatures;
}

} // namespace OpenSubdivHex::Regression

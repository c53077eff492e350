// SPDX-License-Identifier: Apache-2.0
#include "besideLines.h"

#include "evenness.h"
#include "ripple.h"
#include "smoothness.h"

#include <cmath>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

double const kPi = std::acos(-1.0);

} // namespace

double GetTubeRowHeight(int numAround, double rowHeight) { return rowHeight * 2 * kPi / numAround; }

Shape MakeTube(int numAround, int numRows, double rowHeight) {
    Shape shape;
    shape.name = "tube";
    shape.manifold = true;
    for (int row = 0; row <= numRows; ++row) {
        for (int i = 0; i < numAround; ++i) {
            double const angle = 2 * kPi * i / numAround;
            shape.positions.insert(
                shape.positions.end(),
                {std::cos(angle), std::sin(angle), row * GetTubeRowHeight(numAround, rowHeight)});
        }
    }
    for (int row = 0; row < numRows; ++row) {
        for (int i = 0; i < numAround; ++i) {
            int const next = (i + 1) % numAround;
            shape.faceSizes.push_back(4);
            shape.faceVertices.insert(shape.faceVertices.end(),
                                      {row * numAround + i, row * numAround + next,
                                       (row + 1) * numAround + next, (row + 1) * numAround + i});
        }
    }
    return shape;
}

std::vector<double> MeasureTube(PolygonMesh const &mesh, double rowHeight, int numQuarters) {
    constexpr double kMargin = 0.02;
    constexpr int kQuarters = 4; // of a row
    std::vector<double> sums(std::size_t(numQuarters), 0.0);
    std::vector<int> counts(std::size_t(numQuarters), 0);
    for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
        Eigen::Vector3d const &position = mesh.positions[std::size_t(vertex)];
        double const rows = position.z() / rowHeight;
        auto const quarter = std::size_t(std::floor(kQuarters * std::max(rows, 0.0)));
        if (rows < kMargin || quarter >= sums.size()) {
            continue;
        }
        auto const [smaller, larger] = EstimateCurvatures(mesh, vertex);
        double const ofCylinder = 1 / position.head<2>().norm();
        sums[quarter] += std::abs(smaller + larger) / ofCylinder;
        ++counts[quarter];
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] /= counts[i];
    }
    return sums;
}

Shape MakeHalfDisk(Tiling tiling, int numFaces) {
    constexpr int kNumControlRings = 4;
    constexpr double kHeight = 1e-3; // so that slopes do not matter
    Shape shape = MakeVertexDisk(tiling, numFaces, kNumControlRings, DiskPart::Half);
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        shape.positions[i + 2] = kHeight * shape.positions[i] * shape.positions[i];
    }
    return shape;
}

std::vector<double> MeasureHalfDisk(PolygonMesh const &mesh, int numRings) {
    std::vector<double> result;
    for (int ring = 0; ring < numRings; ++ring) {
        std::vector<int> const vertices = FindRing(mesh, ring);
        result.push_back(MeasureUnevenness(mesh, vertices, std::vector<int>(vertices.size(), 0)));
    }
    return result;
}

std::vector<double> MeasureHalfDisk(Tiling tiling, int numFaces, AnyScheme const &scheme,
                                    int numRings, int level) {
    OpenSubdiv::Sdc::Options options;
    options.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    Shape const shape = MakeHalfDisk(tiling, numFaces);
    return MeasureHalfDisk(RefineSurface(shape, scheme, level, MeshCenter(), options).back().mesh,
                           numRings);
}

} // namespace OpenSubdivHex::Regression

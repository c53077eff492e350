// SPDX-License-Identifier: Apache-2.0
//
// The eigenvalues of two steps around a vertex of a sharp line: in a sector of a border, at a corner, at the end of a crease.
#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/shapes.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <deque>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression::lineSpectrumTest {

namespace {

using FarExt::FaceMask;
using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;
namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

constexpr int kDepth = 4; ///< the neighbourhood of the vertex is regular from there on
double const kPi = std::acos(-1.0);

HexSchemeOptions hexagonal(FaceMask mask) { return {mask, SchemeType::Hexagonal, FirstStep::Same}; }

/// Faces in a row around vertex 0, over a part of a turn: quads or triangles.  The whole turn closes.
Shape makeFan(int numFaces, int faceSize, double turns) {
    Shape shape;
    shape.name = "fan";
    bool const isClosed = turns == 1;
    shape.positions = {0, 0, 0};
    auto const add = [&](double radius, double at) {
        double const angle = 2 * kPi * turns * at / numFaces;
        shape.positions.insert(shape.positions.end(),
                               {radius * std::cos(angle), radius * std::sin(angle), 0});
    };
    int const numSpokes = numFaces + (isClosed ? 0 : 1);
    for (int i = 0; i < numSpokes; ++i) {
        add(1, i);
    }
    for (int i = 0; i < numFaces; ++i) {
        add(1.4, i + 0.5);
        shape.faceSizes.push_back(faceSize);
        shape.faceVertices.insert(shape.faceVertices.end(), {0, 1 + i});
        if (faceSize == 4) {
            shape.faceVertices.push_back(1 + numSpokes + i);
        }
        shape.faceVertices.push_back(1 + (i + 1) % numSpokes);
    }
    return shape;
}

/// The face at a vertex from which others are told: the first one counter-clockwise from the direction (1, 0), or
/// that across it.
int findFirstFace(FarExt::TopologyLevel const &level, std::vector<std::array<double, 2>> const &at,
                  int vertex) {
    int result = -1;
    double least = 0;
    for (int const face : level.GetVertexFaces(vertex)) {
        std::complex<double> center = 0;
        for (int const corner : level.GetFaceVertices(face)) {
            auto const &[x, y] = at[std::size_t(corner)];
            center += std::complex<double>(x, y);
        }
        double const angle = std::arg(center);
        double const turned = angle < -1e-9 ? angle + 2 * kPi : angle;
        if (result < 0 || turned < least) {
            result = face;
            least = turned;
        }
    }
    return result;
}

/// \brief The vertices around a center in an order that the faces tell: of the faces up to two edges away from its own.
///
/// \param local  where the first face begins
std::vector<int> walk(FarExt::TopologyLevel const &level, Far::ConstIndexArray own, int firstFace,
                      int local) {
    constexpr int kNumRings = 2;
    struct Step {
        int face;
        int local;
        int ring;
    };
    std::vector<int> vertices;
    std::set<int> known;
    std::set<int> seen{firstFace};
    std::deque<Step> steps{{firstFace, local, 0}};
    for (; !steps.empty(); steps.pop_front()) {
        Step const step = steps.front();
        int const size = level.GetFaceVertices(step.face).size();
        for (int i = 0; i < size; ++i) {
            int const place = (step.local + i) % size;
            int const corner = level.GetFaceVertices(step.face)[place];
            if (known.insert(corner).second) {
                vertices.push_back(corner);
            }
            int const edge = level.GetFaceEdges(step.face)[place];
            auto const sides = level.GetEdgeFaces(edge);
            if (sides.size() != 2) {
                continue;
            }
            int const side = sides[0] == step.face ? 1 : 0;
            int const ring = own.FindIndex(sides[side]) >= 0 ? 0 : step.ring + 1;
            if (ring <= kNumRings && seen.insert(sides[side]).second) {
                steps.push_back({sides[side], level.GetEdgeFaceLocalIndices(edge)[side], ring});
            }
        }
    }
    return vertices;
}

/// A vertex in terms of those of an earlier level.
struct Combination {
    void Clear() { weights.clear(); }
    void AddWithWeight(Combination const &other, double weight) {
        for (auto const &[vertex, part] : other.weights) {
            weights[vertex] += weight * part;
        }
    }
    std::map<int, double> weights;
};

/// A point of the plane.
struct Point {
    void Clear() { at = {0, 0}; }
    void AddWithWeight(Point const &other, double weight) {
        at[0] += weight * other.at[0];
        at[1] += weight * other.at[1];
    }
    std::array<double, 2> at = {0, 0};
};

/// \brief The moduli of the eigenvalues of a step around vertex 0 of a shape, or around the face that a truncation made
/// of it where it was not kept, descending.  The masks of two steps alternate beside lines: they are square roots of
/// those of both.
std::vector<double> findEigenvalues(Shape const &shape, HexSchemeOptions const &scheme) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(), options, {scheme});
    FarExt::TopologyRefiner::UniformOptions uniformOptions(kDepth + 2);
    uniformOptions.fullTopologyInLastLevel = true;
    if (!refiner || !refiner->RefineUniform(uniformOptions)) {
        ADD_FAILURE() << "no levels";
        return {};
    }
    FarExt::PrimvarRefinerReal<double> const primvars(*refiner);
    std::vector<Point> points(std::size_t(shape.GetNumVertices()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].at = {shape.positions[3 * i], shape.positions[3 * i + 1]};
    }
    FarExt::TopologyLevel const &first = refiner->GetLevel(1);
    int center = -1; // a face that is made of vertex 0, which then is not there
    for (int f = 0; f < first.GetNumFaces(); ++f) {
        if (refiner->GetLevel(0).GetVertexChildVertex(0) < 0 && first.GetFaceParentVertex(f) == 0) {
            center = f;
        }
    }
    std::vector<int> walks[2];
    std::vector<Combination> values;
    for (int depth = 0; depth <= kDepth + 2; ++depth) {
        FarExt::TopologyLevel const &level = refiner->GetLevel(depth);
        if (depth > 0) {
            std::vector<Point> next(std::size_t(level.GetNumVertices()));
            primvars.Interpolate(depth, points, next);
            points.swap(next);
        }
        if (depth > kDepth) {
            std::vector<Combination> next(std::size_t(level.GetNumVertices()));
            primvars.Interpolate(depth, values, next);
            values.swap(next);
        }
        if (depth == kDepth || depth == kDepth + 2) {
            std::vector<std::array<double, 2>> at;
            auto const &origin = points[0].at; // vertex 0 keeps its number
            for (Point const &point : points) {
                at.push_back({point.at[0] - origin[0], point.at[1] - origin[1]});
            }
            std::vector<int> &found = walks[depth == kDepth ? 0 : 1];
            if (center >= 0) {
                found = walk(level, {&center, 1}, center, 0);
            } else {
                int const face = findFirstFace(level, at, 0);
                int const local = level.GetFaceVertices(face).FindIndex(0);
                found = walk(level, level.GetVertexFaces(0), face, local);
            }
        }
        if (depth == kDepth) {
            values.resize(std::size_t(level.GetNumVertices()));
            for (std::size_t i = 0; i < values.size(); ++i) {
                values[i].weights[int(i)] = 1;
            }
        }
    }
    EXPECT_EQ(walks[0].size(), walks[1].size());
    std::map<int, int> numbers;
    for (std::size_t i = 0; i < walks[0].size(); ++i) {
        numbers[walks[0][i]] = int(i);
    }
    auto const size = Eigen::Index(walks[0].size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        for (auto const &[source, weight] : values[std::size_t(walks[1][std::size_t(i)])].weights) {
            auto const found = numbers.find(source);
            if (found == numbers.end()) {
                ADD_FAILURE() << "it depends on what is further away";
                return {};
            }
            matrix(i, found->second) = weight;
        }
    }
    std::vector<double> moduli;
    Eigen::VectorXcd const eigenvalues = Eigen::EigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
    for (std::complex<double> value : eigenvalues) {
        moduli.push_back(std::sqrt(std::abs(value)));
    }
    std::sort(moduli.rbegin(), moduli.rend());
    return moduli;
}

struct Row {
    int numFaces;
    std::vector<double> values; ///< behind the first, which is 1
};

void expectEigenvalues(Shape const &shape, HexSchemeOptions const &scheme,
                       std::vector<double> const &expected) {
    std::vector<double> const values = findEigenvalues(shape, scheme);
    ASSERT_GT(values.size(), expected.size());
    EXPECT_NEAR(values[0], 1, 1e-10);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(values[i + 1], expected[i], 5.1e-5) << i;
    }
}

Shape makeCorner(int numFaces) {
    Shape shape = makeFan(numFaces, 4, 0.25);
    shape.cornerVertices = {0};
    shape.cornerSharpness = {10};
    return shape;
}

} // namespace

// Along the border 1/2, 1/4; the others lie across.  In a sector of one face curvature is bounded; in one of two the
// twist grows by .3630 / (.5638 / 2) = 1.288 in each step, in larger ones by .4192 to .4876 over 1/4.
TEST(LineSpectrum, SectorsOfBorders) {
    for (Row const &row :
         {Row{1, {0.5, 0.5, 0.25, 0.2496, 0.1127}}, Row{2, {0.5638, 0.5, 0.3630, 0.25}},
          Row{3, {0.5, 0.4999, 0.4192, 0.3196, 0.25}},
          Row{4, {0.5, 0.4999, 0.4529, 0.3865, 0.3143, 0.25}}, Row{5, {0.5, 0.4998, 0.4693}},
          Row{6, {0.5, 0.4998, 0.4784}}, Row{8, {0.5, 0.4997, 0.4876}}}) {
        SCOPED_TRACE(row.numFaces);
        for (int faceSize : {3, 4}) {
            expectEigenvalues(makeFan(row.numFaces, faceSize, 0.5), hexagonal(FaceMask::Smooth),
                              row.values);
        }
    }
    expectEigenvalues(makeFan(1, 4, 0.5), hexagonal(FaceMask::Cosine),
                      {0.5, 0.36507, 0.30619, 0.125});
}

// A truncation makes half a polygon of a vertex on a border.  Behind 1/2 along the border and across it nothing is above
// 1/4, so that curvature is bounded.
TEST(LineSpectrum, SectorsOfTruncatedBorders) {
    for (Row const &row :
         {Row{1, {0.5, 0.5, 0.25, 0.2496, 0.1127}}, Row{2, {0.5, 0.5, 0.25, 0.25, 0.1991}},
          Row{3, {0.5, 0.5, 0.25, 0.25, 0.25, 0.2257}},
          Row{4, {0.5, 0.5, 0.25, 0.25, 0.25, 0.2360}},
          Row{5, {0.5, 0.5, 0.25, 0.25, 0.25, 0.2409}},
          Row{6, {0.5, 0.5, 0.25, 0.25, 0.25, 0.2437}},
          Row{8, {0.5, 0.5, 0.25, 0.25, 0.25, 0.2464}},
          Row{64, {0.5, 0.5, 0.25, 0.25, 0.25, 0.2499}}}) {
        SCOPED_TRACE(row.numFaces);
        expectEigenvalues(makeFan(row.numFaces, 3, 0.5),
                          {FaceMask::Smooth, SchemeType::Hexagonal, FirstStep::Truncate},
                          row.values);
    }
}

// The two sides of a crease are two borders, which have the values along it in common.
TEST(LineSpectrum, SectorsOfTruncatedCreases) {
    for (int numFaces : {2, 3, 5}) {
        SCOPED_TRACE(numFaces);
        Shape shape = makeFan(3 + numFaces, 3, 1);
        shape.creaseVertexPairs = {0, 1, 0, 1 + numFaces};
        shape.creaseSharpness = {10, 10};
        std::vector<double> expected{0.5, 0.5, 0.5, 0.25, 0.25, 0.25, 0.25, 0.2409, 0.2257};
        if (numFaces == 2) {
            expected = {0.5, 0.5, 0.5, 0.25, 0.25, 0.25, 0.2257, 0.1991};
        } else if (numFaces == 3) {
            expected = {0.5, 0.5, 0.5, 0.25, 0.25, 0.25, 0.25, 0.2257, 0.2257};
        }
        expectEigenvalues(shape, {FaceMask::Smooth, SchemeType::Hexagonal, FirstStep::Truncate},
                          expected);
    }
}

// Along each of the two borders 1/2, 1/8.  Between them one face has a twist that grows by .3630 / (1/4) = 1.452.
// Two faces and more have a third value of 1/2, and so no tangent plane but by chance.
TEST(LineSpectrum, Corners) {
    for (Row const &row : {Row{1, {0.5, 0.5, 0.3630, 0.125}}, Row{2, {0.5638, 0.5, 0.5, 0.3630}},
                           Row{3, {0.5, 0.5, 0.4999, 0.4192}}, Row{4, {0.5, 0.5, 0.4999, 0.4529}},
                           Row{6, {0.5, 0.5, 0.4998, 0.4784}}}) {
        SCOPED_TRACE(row.numFaces);
        expectEigenvalues(makeCorner(row.numFaces), hexagonal(FaceMask::Smooth), row.values);
    }
}

// The end of a crease in the inside.  The surface has a tangent plane; curvature grows by .3476 / (1/4) = 1.39 with three
// faces, and then by 1.47, 1.45 and 1.40.
TEST(LineSpectrum, Darts) {
    for (Row const &row : {Row{3, {0.5, 0.5, 0.3476, 0.25}}, Row{4, {0.5638, 0.5283, 0.4373}},
                           Row{5, {0.5966, 0.5553, 0.4796}}, Row{6, {0.6153, 0.5794, 0.5}}}) {
        SCOPED_TRACE(row.numFaces);
        Shape shape = makeFan(row.numFaces, 4, 1);
        shape.creaseVertexPairs = {0, 1};
        shape.creaseSharpness = {10};
        expectEigenvalues(shape, hexagonal(FaceMask::Smooth), row.values);
    }
}

} // namespace OpenSubdivHex::Regression::lineSpectrumTest

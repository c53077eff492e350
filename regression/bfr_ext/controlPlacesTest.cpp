// SPDX-License-Identifier: Apache-2.0
//
// Places on the control mesh, and where they are on the surface.
#include "facePlaces.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <vector>

namespace OpenSubdivHex::Regression::controlPlacesTest {
namespace {

using BfrExt::Surface;
using BfrExt::SurfaceFactory;

constexpr int kSize = 6; // squares to a side

int getVertex(int x, int y) { return y * (kSize + 1) + x; }

/// \brief A flat sheet of squares of side 1, some of which are two triangles.
///
/// With \p isLattice all of them are, along one diagonal.  With tags the sheet has a crease, whose vertices have two to
/// four faces on a side, a dart, a corner and a hole.
Shape makeSheet(bool hasTags, bool isLattice = false) {
    Shape shape;
    shape.name = "sheet";
    for (int y = 0; y <= kSize; ++y) {
        for (int x = 0; x <= kSize; ++x) {
            shape.positions.insert(shape.positions.end(), {double(x), double(y), 0});
        }
    }
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            int const square[4] = {getVertex(x, y), getVertex(x + 1, y), getVertex(x + 1, y + 1),
                                   getVertex(x, y + 1)};
            int const kind = isLattice ? 1 : (x * x + 3 * x * y + y) % 3;
            std::vector<std::vector<int>> const faces =
                kind == 0   ? std::vector<std::vector<int>>{{0, 1, 2, 3}}
                : kind == 1 ? std::vector<std::vector<int>>{{0, 1, 2}, {0, 2, 3}}
                            : std::vector<std::vector<int>>{{3, 0, 1}, {1, 2, 3}};
            for (auto const &face : faces) {
                shape.faceSizes.push_back(int(face.size()));
                for (int const corner : face) {
                    shape.faceVertices.push_back(square[corner]);
                }
            }
        }
    }
    if (hasTags) {
        for (int x = 0; x < kSize; ++x) {
            shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                           {getVertex(x, 3), getVertex(x + 1, 3)});
            shape.creaseSharpness.push_back(Sdc::Crease::SHARPNESS_INFINITE);
        }
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                       {getVertex(2, 1), getVertex(3, 1)});
        shape.creaseSharpness.push_back(2);
        shape.cornerVertices = {getVertex(4, 4)};
        shape.cornerSharpness = {Sdc::Crease::SHARPNESS_INFINITE};
        shape.holeFaces = {1};
    }
    return shape;
}

struct Sheet {
    Sheet(Shape const &sheet, FarExt::FirstStep firstStep) : shape(sheet) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
        refiner = CreateSurfaceRefiner(shape, {ReferenceMask::Smooth, firstStep}, 0, options);
        factory = SurfaceFactory::Create(*refiner);
        controlPoints = FindControlPoints(*refiner, shape.positions);
    }

    /// The place of the mean of a face's vertices with these weights.
    std::array<double, 2> FindUv(int face, std::vector<double> const &weights) const {
        auto const size = int(weights.size());
        BfrExt::Parameterization const parameterization(size);
        std::array<double, 2> place = {};
        for (int i = 0; i < size; ++i) {
            std::array<double, 2> vertex;
            parameterization.GetVertexCoord(i, vertex.data());
            parameterization.ConvertToPlane(vertex.data(), vertex.data());
            place[0] += weights[std::size_t(i)] * vertex[0];
            place[1] += weights[std::size_t(i)] * vertex[1];
        }
        parameterization.ConvertFromPlane(place.data(), place.data());
        EXPECT_LT(face, shape.GetNumFaces());
        return place;
    }
    Vector3 Mean(Far::ConstIndexArray vertices, std::vector<double> const &weights) const {
        Vector3 mean = {};
        for (int i = 0; i < vertices.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                mean[k] +=
                    weights[std::size_t(i)] * shape.positions[std::size_t(3 * vertices[i]) + k];
            }
        }
        return mean;
    }
    /// The point of the surface; false in holes.
    bool Evaluate(int controlFace, std::array<double, 2> const &controlUv, Vector3 &point,
                  int *face = nullptr) const {
        int surfaceFace = -1;
        double uv[2];
        FarExt::CallStatus status;
        EXPECT_TRUE(
            factory->FindSurfacePlace(controlFace, controlUv.data(), &surfaceFace, uv, &status))
            << status.GetErrorMessage();
        if (face) {
            *face = surfaceFace;
        }
        Surface<double> surface;
        if (factory->GetFaces().IsHole(surfaceFace) ||
            !factory->InitVertexSurface(surfaceFace, &surface)) {
            return false;
        }
        point = EvaluateSurface(surface, controlPoints, uv).p;
        return true;
    }

    Shape shape;
    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<SurfaceFactory> factory;
    std::vector<double> controlPoints;
};

/// Weights of the vertices of a face: all of a grid over it, its vertices and edges included.
std::vector<std::vector<double>> makeWeights(int size, int number) {
    std::vector<std::vector<double>> result;
    for (int i = 0; i < size; ++i) {
        for (int a = 0; a <= number; ++a) {
            for (int b = 0; a + b <= number; ++b) {
                std::vector<double> weights(std::size_t(size),
                                            double(number - a - b) / number / size);
                weights[std::size_t(i)] += double(a) / number;
                weights[std::size_t((i + 1) % size)] += double(b) / number;
                result.push_back(weights);
            }
        }
    }
    return result;
}

} // namespace

TEST(ControlPlaces, WithoutAFirstStepAreThoseOfSurfaces) {
    Sheet const sheet(makeSheet(true), FarExt::FirstStep::Same);
    float const uv[2] = {0.25f, 0.5f};
    float found[2];
    int face = -1;
    EXPECT_TRUE(sheet.factory->FindSurfacePlace(4, uv, &face, found));
    EXPECT_EQ(face, 4);
    EXPECT_TRUE(std::equal(uv, uv + 2, found));
}

// The surface of a flat sheet is flat, and spreads nearly as the sheet does, on a lattice exactly so.
TEST(ControlPlaces, BehindATruncationLieWhereTheyDoOnAFlatSheet) {
    for (bool const hasTags : {false, true}) {
        for (bool const isLattice : {false, true}) {
            Sheet const sheet(makeSheet(hasTags, isLattice), FarExt::FirstStep::Truncate);
            FarExt::TopologyLevel const &control = sheet.refiner->GetLevel(0);
            double largestInside = 0;
            int numPoints = 0;
            for (int face = 0; face < control.GetNumFaces(); ++face) {
                Far::ConstIndexArray const vertices = control.GetFaceVertices(face);
                for (auto const &weights : makeWeights(vertices.size(), 7)) {
                    Vector3 point;
                    if (!sheet.Evaluate(face, sheet.FindUv(face, weights), point)) {
                        continue;
                    }
                    Vector3 const expected = sheet.Mean(vertices, weights);
                    double const distance = GetDistance(point, expected);
                    EXPECT_LT(distance, 0.25)
                        << "face " << face; // corners of two faces are rounded
                    if (std::abs(expected[0] - 3) < 1 && std::abs(expected[1] - 3) < 1) {
                        largestInside = std::max(largestInside, distance);
                    }
                    ++numPoints;
                }
            }
            EXPECT_GT(numPoints, 2000);
            EXPECT_LT(largestInside, isLattice && !hasTags ? 1e-6 : 0.2);
            EXPECT_GT(largestInside, isLattice && !hasTags ? 0 : 0.05);
        }
    }
}

// Faces agree about the points of their common edges and vertices.
TEST(ControlPlaces, OnEdgesAreOnePointFromAllFaces) {
    for (bool const hasTags : {false, true}) {
        Shape shape = makeSheet(hasTags);
        for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
            shape.positions[i + 2] =
                std::sin(shape.positions[i]) * std::cos(shape.positions[i + 1]);
        }
        Sheet const sheet(shape, FarExt::FirstStep::Truncate);
        FarExt::TopologyLevel const &control = sheet.refiner->GetLevel(0);
        std::map<std::array<int, 3>, Vector3> points;
        int numShared = 0;
        for (int face = 0; face < control.GetNumFaces(); ++face) {
            Far::ConstIndexArray const vertices = control.GetFaceVertices(face);
            for (int i = 0; i < vertices.size(); ++i) {
                int const next = (i + 1) % vertices.size();
                for (int k = 0; k <= 12; ++k) {
                    std::vector<double> weights(std::size_t(vertices.size()), 0.0);
                    weights[std::size_t(i)] = 1 - k / 12.0;
                    weights[std::size_t(next)] = k / 12.0;
                    Vector3 point;
                    if (!sheet.Evaluate(face, sheet.FindUv(face, weights), point)) {
                        continue;
                    }
                    bool const isAscending = vertices[i] < vertices[next];
                    std::array<int, 3> key = {std::min(vertices[i], vertices[next]),
                                              std::max(vertices[i], vertices[next]),
                                              isAscending ? k : 12 - k};
                    if (k == 0 || k == 12) {
                        int const vertex = vertices[k == 0 ? i : next];
                        key = {vertex, vertex, 0};
                    }
                    auto const [known, isNew] = points.emplace(key, point);
                    EXPECT_LT(GetDistance(known->second, point), 1e-9)
                        << "face " << face << " edge " << i << " at " << k;
                    numShared += !isNew;
                }
            }
        }
        EXPECT_GT(numShared, 1000);
    }
}

// A place in a face of the control mesh is in a face of level 1 that this face made, or one of its vertices did.
TEST(ControlPlaces, LieInFacesThatTheirFaceMade) {
    Sheet const sheet(makeSheet(true), FarExt::FirstStep::Truncate);
    FarExt::TopologyLevel const &control = sheet.refiner->GetLevel(0);
    FarExt::TopologyLevel const &level = sheet.factory->GetLevel();
    for (int face = 0; face < control.GetNumFaces(); ++face) {
        Far::ConstIndexArray const vertices = control.GetFaceVertices(face);
        for (auto const &weights : makeWeights(vertices.size(), 5)) {
            double const uv[2] = {sheet.FindUv(face, weights)[0], sheet.FindUv(face, weights)[1]};
            double found[2];
            int surfaceFace = -1;
            ASSERT_TRUE(sheet.factory->FindSurfacePlace(face, uv, &surfaceFace, found));
            int const levelFace = sheet.factory->GetFaces().GetLevelFace(surfaceFace).face;
            auto const largest = std::max_element(weights.begin(), weights.end());
            if (level.GetFaceKind(levelFace) == FarExt::FaceKind::Vertex) {
                EXPECT_EQ(level.GetFaceParentVertex(levelFace),
                          vertices[int(largest - weights.begin())]);
                EXPECT_GT(*largest, 0.66);
            } else {
                EXPECT_EQ(level.GetFaceParentFace(levelFace), face);
            }
        }
    }
}

TEST(ControlPlaces, AreRefusedByName) {
    Sheet sheet(makeSheet(true), FarExt::FirstStep::Truncate);
    double const uv[2] = {0.25, 0.25};
    double found[2] = {-1, -1};
    int face = -1;
    FarExt::CallStatus status;
    for (int const none : {-1, sheet.shape.GetNumFaces()}) {
        EXPECT_FALSE(sheet.factory->FindSurfacePlace(none, uv, &face, found, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetComponentIndex(), none);
    }
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for (double const none : {kNan, kInfinite, -kInfinite}) {
        for (std::array<double, 2> const &nowhere : {std::array{none, 0.5}, {0.5, none}}) {
            EXPECT_FALSE(sheet.factory->FindSurfacePlace(2, nowhere.data(), &face, found, &status));
            EXPECT_EQ(status.GetErrorMessage(), "u and v are not finite, in face 2 of level 0");
            EXPECT_EQ(status.GetComponentIndex(), 2);
        }
    }
    sheet.refiner->RefineUniform(1);
    EXPECT_FALSE(sheet.factory->FindSurfacePlace(0, uv, &face, found, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    Sheet const ofTriHex(makeSheet(false), FarExt::FirstStep::TriHex);
    EXPECT_FALSE(ofTriHex.factory->FindSurfacePlace(0, uv, &face, found, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
    EXPECT_EQ(face, -1);
    EXPECT_EQ(found[0], -1);
}

} // namespace OpenSubdivHex::Regression::controlPlacesTest

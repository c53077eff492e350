// SPDX-License-Identifier: Apache-2.0
//
// Places of surfaces, which are evaluated by Gregory patches, beside stencils, which are exact.
#include "facePlaces.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include "bfr_ext/cell/facePatches.h"
#include "bfr_ext/surfacePlaces.h"
#include "far_ext/executor.h"

#include "regression/shapes/featureShapes.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace OpenSubdivHex::Regression::surfacePlacesTest {
namespace {

using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using Uv = std::array<double, 2>;

constexpr double kDegree = 3.14159265358979323846 / 180;

Sdc::Options getOptions() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    return options;
}

/// A surface with its patch points.
struct PlacedSurface {
    /// Whether the face has one.
    bool Init(SurfaceFactory const &factory, std::vector<double> const &positions, int face) {
        if (!factory.InitVertexSurface(face, &surface)) {
            return false;
        }
        points.resize(3 * std::size_t(surface.GetNumPatchPoints()));
        surface.PreparePatchPoints(positions.data(), 3, points.data(), 3);
        return true;
    }
    std::array<Vector3, 6> Evaluate(Uv const &uv) const {
        std::array<Vector3, 6> r;
        surface.Evaluate(uv.data(), points.data(), 3, r[0].data(), r[1].data(), r[2].data(),
                         r[3].data(), r[4].data(), r[5].data());
        return r;
    }

    Surface<double> surface;
    std::vector<double> points;
};

/// An L of three quads with height, all of whose outer edges are sharp: on the wide side of its two corners inside there are
/// three faces.
Shape makeL() {
    Shape shape;
    for (double const z : {0.0, 1.0}) {
        for (Uv const &xy :
             {Uv{0, 0}, Uv{1, 0}, Uv{2, 0}, Uv{0, 1}, Uv{1, 1}, Uv{2, 1}, Uv{0, 2}, Uv{1, 2}}) {
            shape.positions.insert(shape.positions.end(),
                                   {xy[0], xy[1], z + 0.3 * (2 * z - 1) * xy[0] * xy[1]});
        }
    }
    auto const addFace = [&](std::array<int, 4> const &verts) {
        shape.faceSizes.push_back(4);
        shape.faceVertices.insert(shape.faceVertices.end(), verts.begin(), verts.end());
    };
    auto const addCrease = [&](int a, int b) {
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {a, b});
        shape.creaseSharpness.push_back(10);
    };
    for (auto const &[a, b, c, d] : {std::array{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}}) {
        addFace({d, c, b, a});
        addFace({a + 8, b + 8, c + 8, d + 8});
    }
    constexpr int kOutline[] = {0, 1, 2, 5, 4, 7, 6, 3};
    for (int i = 0; i < 8; ++i) {
        int const a = kOutline[i];
        int const b = kOutline[(i + 1) % 8];
        addFace({a, b, b + 8, a + 8});
        addCrease(a, b);
        addCrease(a + 8, b + 8);
        if (a != 1 && a != 3) {
            addCrease(a, a + 8);
        }
    }
    return shape;
}

/// Places inside of a face: at some share of the way from its centre to its edges.
std::vector<Uv> findPlaces(int size, int number, double distance = 1) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<Uv> places;
    for (int i = 0; i < number; ++i) {
        double const alongEdge = share(random);
        double const t = distance * (0.98 * std::sqrt(share(random)) + 0.01);
        places.push_back(MakeFacePlace(size, i % size, t * (1 - alongEdge), t * alongEdge));
    }
    return places;
}

double getSize(std::vector<double> const &positions) {
    Vector3 extent;
    for (std::size_t k = 0; k < 3; ++k) {
        double low = positions[k];
        double high = low;
        for (std::size_t i = k; i < positions.size(); i += 3) {
            low = std::min(low, positions[i]);
            high = std::max(high, positions[i]);
        }
        extent[k] = high - low;
    }
    return GetLength(extent);
}

/// How far places lie from the surface, of its size, and their normals from its own, in degrees: rms.
struct Errors {
    double distance = 0;
    double largest = 0;
    double angle = 0;
    int number = 0;
};

Errors findErrors(Shape const &shape, ReferenceMask mask, SurfaceFactory::Options options,
                  int numPlaces) {
    auto const refiner = CreateRefiner(shape, mask, 0, getOptions());
    auto const factory = SurfaceFactory::Create(*refiner, options);
    double const size = getSize(shape.positions);
    Errors errors;
    PlacedSurface surface;
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        if (!surface.Init(*factory, shape.positions, face)) {
            continue;
        }
        for (Uv const &uv : findPlaces(surface.surface.GetFaceSize(), numPlaces)) {
            SurfacePoint const exact = EvaluateSurface(surface.surface, shape.positions, uv.data());
            std::array<Vector3, 6> const found = surface.Evaluate(uv);
            Vector3 const cross = Cross(exact.du, exact.dv);
            if (GetLength(cross) < 1e-2 * GetLength(exact.du) * GetLength(exact.dv)) {
                continue; // hardly a plane
            }
            Vector3 const normal = Normalize(cross);
            double const distance = std::abs(Dot(normal, Subtract(found[0], exact.p))) / size;
            double const cosine = Dot(normal, Normalize(Cross(found[1], found[2])));
            double const angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / kDegree;
            errors.distance += distance * distance;
            errors.largest = std::max(errors.largest, distance);
            errors.angle += angle * angle;
            ++errors.number;
        }
    }
    errors.distance = std::sqrt(errors.distance / errors.number);
    errors.angle = std::sqrt(errors.angle / errors.number);
    return errors;
}

Errors findErrors(Shape const &shape, ReferenceMask mask, int level, int numPlaces) {
    return findErrors(
        shape, mask,
        SurfaceFactory::Options().SetApproxLevelSmooth(level).SetApproxLevelSharp(level),
        numPlaces);
}

} // namespace

class SurfacePlacesTest : public testing::TestWithParam<ReferenceMask> {};

TEST_P(SurfacePlacesTest, LieOnTheSurface) {
    Shape const shape = MakeTorus(12, 8, TorusFaces::Quads);
    Errors const errors = findErrors(shape, GetParam(), 3, 4);
    EXPECT_EQ(errors.number, 4 * shape.GetNumFaces());
    EXPECT_LT(errors.distance, 3e-5);
    EXPECT_LT(errors.largest, 4e-4);
    EXPECT_LT(errors.angle, 1.5);
    Errors const finer = findErrors(shape, GetParam(), 4, 4);
    EXPECT_LT(finer.distance, 0.6 * errors.distance);
    EXPECT_LT(finer.angle, 0.7 * errors.angle);
}

// Derivatives of patches leave out the change of inner points' shares, as OpenSubdiv's do.
TEST_P(SurfacePlacesTest, DerivativesAreNearlyThoseOfTheirPoints) {
    constexpr double kStep = 1e-5;
    double sum = 0;
    int number = 0;
    for (int const size : {3, 4, 5, 6, 7, 12}) {
        Shape const shape = MakePrism(size);
        auto const refiner = CreateRefiner(shape, GetParam(), 0, getOptions());
        auto const factory = SurfaceFactory::Create(*refiner);
        PlacedSurface surface;
        ASSERT_TRUE(surface.Init(*factory, shape.positions, 0));
        ASSERT_EQ(surface.surface.GetFaceSize(), size);
        for (Uv const &uv : findPlaces(size, 200)) {
            std::array<Vector3, 6> const at = surface.Evaluate(uv);
            for (std::size_t k = 0; k < 2; ++k) {
                Uv beside[2] = {uv, uv};
                beside[0][k] -= kStep;
                beside[1][k] += kStep;
                Vector3 const difference =
                    Scale(Subtract(surface.Evaluate(beside[1])[0], surface.Evaluate(beside[0])[0]),
                          0.5 / kStep);
                double const error = GetDistance(difference, at[1 + k]) / GetLength(at[1 + k]);
                EXPECT_LT(error, 0.5) << size << " " << uv[0] << " " << uv[1];
                sum += error;
                ++number;
            }
        }
    }
    EXPECT_LT(sum / number, 0.03);
}

TEST_P(SurfacePlacesTest, PatchesMeet) {
    // Bends as they may be, places that are near each other have near points.
    constexpr int kNumSteps = 4000;
    for (int const size : {3, 4, 5, 6, 8}) {
        Shape const shape = MakePrism(size);
        auto const refiner = CreateRefiner(shape, GetParam(), 0, getOptions());
        auto const factory = SurfaceFactory::Create(*refiner);
        PlacedSurface surface;
        ASSERT_TRUE(surface.Init(*factory, shape.positions, 0));
        std::vector<Uv> ends = findPlaces(size, 12);
        for (Uv &end : ends) {
            end = ToPlane(size, end.data());
        }
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            Vector3 last{};
            Vector3 lastNormal{};
            for (int step = 0; step <= kNumSteps; ++step) {
                double const t = double(step) / kNumSteps;
                std::array<Vector3, 6> const at = surface.Evaluate(
                    FromPlane(size, {ends[i][0] + t * (ends[i + 1][0] - ends[i][0]),
                                     ends[i][1] + t * (ends[i + 1][1] - ends[i][1])}));
                Vector3 const normal = Normalize(Cross(at[1], at[2]));
                if (step > 0) {
                    ASSERT_LT(GetDistance(at[0], last), 20.0 / kNumSteps) << size;
                    ASSERT_LT(GetDistance(normal, lastNormal), 150.0 / kNumSteps) << size;
                }
                last = at[0];
                lastNormal = normal;
            }
        }
    }
}

// Both faces of an edge have the same curve there, but for rounding.
TEST_P(SurfacePlacesTest, FacesMeet) {
    Shape const shape = MakeTorus(8, 6, TorusFaces::IrregularTriangles);
    auto const refiner = CreateRefiner(shape, GetParam(), 0, getOptions());
    auto const factory = SurfaceFactory::Create(*refiner);
    FarExt::TopologyLevel const level = refiner->GetLevel(0);
    int numEdges = 0;
    for (int edge = 0; edge < level.GetNumEdges(); ++edge) {
        Far::ConstIndexArray const faces = level.GetEdgeFaces(edge);
        if (faces.size() != 2) {
            continue;
        }
        ++numEdges;
        PlacedSurface surfaces[2];
        int locals[2];
        for (int side = 0; side < 2; ++side) {
            ASSERT_TRUE(surfaces[side].Init(*factory, shape.positions, faces[side]));
            Far::ConstIndexArray const edges = level.GetFaceEdges(faces[side]);
            locals[side] = int(std::find(edges.begin(), edges.end(), edge) - edges.begin());
        }
        for (double const t : {0.0, 0.1, 0.25, 1.0 / 3, 0.5, 0.77, 1.0}) {
            std::array<Vector3, 6> found[2];
            for (int side = 0; side < 2; ++side) {
                Uv uv;
                surfaces[side].surface.GetParameterization().GetEdgeCoord(
                    locals[side], side == 0 ? t : 1 - t, uv.data());
                found[side] = surfaces[side].Evaluate(uv);
            }
            EXPECT_LT(GetDistance(found[0][0], found[1][0]), 1e-12) << "edge " << edge << " " << t;
            Vector3 const normals[2] = {Normalize(Cross(found[0][1], found[0][2])),
                                        Normalize(Cross(found[1][1], found[1][2]))};
            EXPECT_LT(GetDistance(normals[0], normals[1]), 1e-7) << "edge " << edge << " " << t;
        }
    }
    EXPECT_GT(numEdges, 100);
}

// There is no tangent plane, and each side has the curves of its sharp edges.
TEST_P(SurfacePlacesTest, MeetAtWideCorners) {
    Shape const shape = makeL();
    auto const refiner = CreateRefiner(shape, GetParam(), 0, getOptions());
    auto const factory = SurfaceFactory::Create(*refiner);
    FarExt::SurfaceFaces const &faces = factory->GetFaces();
    for (int edge = 0; edge < faces.GetNumEdges(); ++edge) {
        for (double const t : {0.0, 0.02, 0.08, 0.2, 0.5, 0.7, 0.92, 0.99}) {
            Vector3 found[2];
            for (int i = 0; i < 2; ++i) {
                FarExt::SurfaceFaces::Side const side = faces.GetSide(edge, i);
                PlacedSurface surface;
                ASSERT_TRUE(surface.Init(*factory, shape.positions, side.face));
                bool const isReversed = faces.GetEdge(side.face, side.local).isReversed;
                Uv uv;
                surface.surface.GetParameterization().GetEdgeCoord(
                    side.local, isReversed ? 1 - t : t, uv.data());
                found[i] = surface.Evaluate(uv)[0];
            }
            EXPECT_LT(GetDistance(found[0], found[1]), 1e-12) << "edge " << edge << " " << t;
        }
    }
}

// What a cache has kept of other faces and levels changes no bit.
TEST_P(SurfacePlacesTest, DoNotDependOnFacesBefore) {
    for (Shape const &shape : {MakeTorus(6, 4, TorusFaces::IrregularTriangles), MakePrism(5)}) {
        auto const refiner = CreateRefiner(shape, GetParam(), 0, getOptions());
        BfrExt::SurfaceFactoryCache cache;
        for (int const level : {4, 2, 3}) {
            auto const options =
                SurfaceFactory::Options().SetApproxLevelSmooth(level).SetApproxLevelSharp(level);
            auto const factory = SurfaceFactory::Create(
                *refiner, SurfaceFactory::Options(options).SetExternalCache(&cache));
            for (int face = shape.GetNumFaces() - 1; face >= 0; --face) {
                auto const fresh = SurfaceFactory::Create(*refiner, options);
                PlacedSurface surfaces[2];
                ASSERT_TRUE(surfaces[0].Init(*factory, shape.positions, face));
                ASSERT_TRUE(surfaces[1].Init(*fresh, shape.positions, face));
                for (Uv const &uv : findPlaces(surfaces[0].surface.GetFaceSize(), 20)) {
                    ASSERT_EQ(surfaces[0].Evaluate(uv), surfaces[1].Evaluate(uv))
                        << "level " << level << ", face " << face;
                }
            }
        }
    }
}

// Where a place is in its patch, and how that changes.
TEST(SurfacePlaces, InPatchesChangeAsTheirDerivativesSay) {
    using BfrExt::internal::FindBfrPlace;
    using BfrExt::internal::FindPatchPlace;
    using BfrExt::internal::PatchPlace;
    constexpr double kStep = 1e-5;
    for (FarExt::FaceShape const shape : std::initializer_list<FarExt::FaceShape>{
             3, 4, 5, 6, 7, 12, {3, true}, {4, true}, {5, true}, {6, true}, {8, true}}) {
        int const size = shape.size;
        SCOPED_TRACE(testing::Message() << size << ", half " << shape.isHalf);
        for (int const level : {2, 3, 5}) {
            auto const find = [&](Uv const &uv) {
                return FindPatchPlace(FindBfrPlace(BfrExt::Parameterization(size), shape, uv, 0),
                                      shape, level, 2);
            };
            // A sector has 1 + 4 + 16 ... half cells.
            int const numPatches = FarExt::internal::MakeFaceCells(shape).GetNumPatches() +
                                   shape.GetNumSectors() * ((1 << 2 * level) - 1) / 3;
            std::vector<bool> isMet(static_cast<std::size_t>(numPatches));
            std::vector<Uv> places = findPlaces(size, 400);
            // Places near the centre, whose patches are of the whole cell.
            std::vector<Uv> const nearCenter = findPlaces(size, 40, 0.02);
            places.insert(places.end(), nearCenter.begin(), nearCenter.end());
            for (Uv const &uv : places) {
                PatchPlace const at = find(uv);
                ASSERT_LT(std::size_t(at.patch), isMet.size());
                isMet[std::size_t(at.patch)] = true;
                EXPECT_TRUE(at.s >= -1e-12 && at.s <= 1 + 1e-12) << at.s;
                EXPECT_TRUE(at.t >= -1e-12 && at.t <= 1 + 1e-12) << at.t;
                for (std::size_t k = 0; k < 2; ++k) {
                    Uv beside[2] = {uv, uv};
                    beside[0][k] -= kStep;
                    beside[1][k] += kStep;
                    PatchPlace const before = find(beside[0]);
                    PatchPlace const behind = find(beside[1]);
                    if (before.patch != at.patch || behind.patch != at.patch) {
                        continue;
                    }
                    double const factor = 0.5 / kStep;
                    double const scale = std::ldexp(1.0, level);
                    double const tolerance =
                        1e-5 * (scale + std::abs(at.first[0][k]) + std::abs(at.first[1][k]));
                    EXPECT_NEAR(factor * (behind.s - before.s), at.first[0][k], tolerance);
                    EXPECT_NEAR(factor * (behind.t - before.t), at.first[1][k], tolerance);
                    for (std::size_t i = 0; i < 2; ++i) {
                        // By u twice, by both, by v twice.
                        auto const expectNear = [&](double difference, double derivative) {
                            EXPECT_NEAR(difference, derivative,
                                        1e-4 * scale * scale + 5e-5 * std::abs(derivative));
                        };
                        expectNear(factor * (behind.first[i][k] - before.first[i][k]),
                                   at.second[2 * k][i]);
                        expectNear(factor * (behind.first[i][1 - k] - before.first[i][1 - k]),
                                   at.second[1][i]);
                    }
                }
            }
            for (Uv const &uv : findPlaces(size, 4000)) {
                isMet[std::size_t(find(uv).patch)] = true;
            }
            if (level == 2) {
                EXPECT_EQ(std::count(isMet.begin(), isMet.end(), false), 0) << size;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Masks, SurfacePlacesTest,
                         testing::Values(ReferenceMask::Average, ReferenceMask::Cosine,
                                         ReferenceMask::Smooth),
                         [](auto const &test) { return std::string(ToString(test.param)); });

// Semi-sharp and sharp edges, corners, boundaries, and parts that are no manifold.
TEST(SurfacePlaces, OfAllShapesLieOnTheSurface) {
    int numShapes = 0;
    for (auto const *shapes : {&GetManifoldShapes(), &GetFeatureShapes()}) {
        for (Shape const &shape : *shapes) {
            if (shape.GetNumFaces() > 80) {
                continue;
            }
            Errors const errors = findErrors(shape, ReferenceMask::Smooth, 3, 3);
            if (errors.number == 0) {
                continue;
            }
            ++numShapes;
            EXPECT_LT(errors.distance, 3e-4) << shape.name;
            EXPECT_LT(errors.largest, 4e-3) << shape.name;
            EXPECT_LT(errors.angle, 6) << shape.name;
        }
    }
    EXPECT_GT(numShapes, 10);
}

// Two edges far from the other faces of a torus.
TEST(SurfacePlaces, NearSharpFeaturesHaveALevelOfTheirOwn) {
    Shape shape = MakeTorus(14, 10, TorusFaces::Quads);
    auto const corner = shape.faceVertices.begin();
    shape.creaseVertexPairs = {corner[0], corner[1], corner[1], corner[2]};
    shape.creaseSharpness = {2.5F, 2.5F};
    auto const getLevels = [](int sharp) {
        return SurfaceFactory::Options().SetApproxLevelSmooth(2).SetApproxLevelSharp(sharp);
    };
    Errors const errors[2] = {findErrors(shape, ReferenceMask::Smooth, getLevels(2), 4),
                              findErrors(shape, ReferenceMask::Smooth, getLevels(5), 4)};
    EXPECT_LT(errors[1].largest, 0.5 * errors[0].largest);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getOptions());
    auto const coarse = SurfaceFactory::Create(*refiner, getLevels(2));
    auto const factory = SurfaceFactory::Create(*refiner, getLevels(5));
    int numSharp = 0;
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        PlacedSurface surfaces[2];
        ASSERT_TRUE(surfaces[0].Init(*coarse, shape.positions, face));
        ASSERT_TRUE(surfaces[1].Init(*factory, shape.positions, face));
        Uv const uv = {0.21, 0.33};
        bool const isSharp = surfaces[0].Evaluate(uv)[0] != surfaces[1].Evaluate(uv)[0];
        numSharp += isSharp ? 1 : 0;
        // Faces with a sharp edge, and those around their neighbours.
        Far::ConstIndexArray const verts = refiner->GetLevel(0).GetFaceVertices(face);
        for (int const vert : shape.creaseVertexPairs) {
            EXPECT_TRUE(isSharp || verts.FindIndex(vert) == Far::INDEX_INVALID) << face;
        }
    }
    EXPECT_GT(numSharp, 6);
    EXPECT_LT(numSharp, shape.GetNumFaces() / 2);
}

// Varying data are bilinear between the corners of patches, where they are exact.
TEST(SurfacePlaces, OfVaryingData) {
    Shape const shape = MakeTorus(8, 6, TorusFaces::Quads);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getOptions());
    auto const factory = SurfaceFactory::Create(*refiner);
    Surface<double> surface;
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        ASSERT_TRUE(factory->InitVaryingSurface(face, &surface));
        std::vector<double> points(3 * std::size_t(surface.GetNumPatchPoints()));
        surface.PreparePatchPoints(shape.positions.data(), 3, points.data(), 3);
        for (Uv const &uv : findPlaces(surface.GetFaceSize(), 6)) {
            Vector3 p;
            surface.Evaluate(uv.data(), points.data(), 3, p.data());
            SurfacePoint const exact = EvaluateSurface(surface, shape.positions, uv.data());
            EXPECT_LT(GetDistance(p, exact.p), 5e-2 * GetLength(exact.du)) << "face " << face;
        }
    }
}

TEST(SurfacePlaces, OfAnySizeAndStride) {
    Shape const shape = MakeTorus(12, 8, TorusFaces::Quads);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getOptions());
    auto const factory = SurfaceFactory::Create(*refiner);
    Surface<float> surface;
    ASSERT_TRUE(factory->InitVertexSurface(5, &surface));
    std::size_t const numVerts = shape.positions.size() / 3;
    std::vector<float> data(11 * numVerts);
    for (std::size_t i = 0; i < data.size(); ++i) {
        data[i] = std::sin(float(i));
    }
    float const uv[2] = {0.3F, 0.4F};
    auto const numPoints = std::size_t(surface.GetNumPatchPoints());
    std::vector<float> all(11 * numPoints);
    surface.PreparePatchPoints(data.data(), 11, all.data(), 11);
    // Points of the mesh may be of the other precision.
    std::vector<float> ofDoubles(all.size());
    surface.PreparePatchPoints(std::vector<double>(data.begin(), data.end()).data(), 11,
                               ofDoubles.data(), 11);
    EXPECT_EQ(ofDoubles, all);
    float expected[6][11];
    surface.Evaluate(uv, all.data(), 11, expected[0], expected[1], expected[2], expected[3],
                     expected[4], expected[5]);
    for (int size = 1; size <= 11; ++size) {
        for (int const stride : {size, 11, 12}) {
            // No number is read or written beside the points.
            constexpr float kUntouched = 77;
            std::vector<float> points(std::size_t(stride) * (numPoints - 1) + std::size_t(size),
                                      kUntouched);
            surface.PreparePatchPoints(data.data(), {size, 11}, points.data(), {size, stride});
            float results[6][12];
            std::fill_n(&results[0][0], 6 * 12, kUntouched);
            surface.Evaluate(uv, points.data(), {size, stride}, results[0], results[1], results[2],
                             results[3], results[4], results[5]);
            for (int i = 0; i < 6; ++i) {
                for (int k = 0; k < 12; ++k) {
                    EXPECT_EQ(results[i][k], k < size ? expected[i][k] : kUntouched)
                        << size << " " << stride << " " << i << " " << k;
                }
            }
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (i % std::size_t(stride) >= std::size_t(size)) {
                    ASSERT_EQ(points[i], kUntouched);
                }
            }
            float first[3][12];
            surface.Evaluate(uv, points.data(), {size, stride}, first[0]);
            EXPECT_TRUE(std::equal(first[0], first[0] + size, expected[0]));
            surface.Evaluate(uv, points.data(), {size, stride}, first[0], first[1], first[2]);
            EXPECT_TRUE(std::equal(first[1], first[1] + size, expected[1]));
        }
    }
}

// What single precision leaves out is no more than rounding, and weights have the sum 1.
TEST(SurfacePlaces, OfSinglePrecisionDifferByRounding) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (TorusFaces const faces :
         {TorusFaces::Quads, TorusFaces::Triangles, TorusFaces::IrregularTriangles}) {
        Shape const shape = MakeTorus(8, 6, faces);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getOptions());
        auto const factory = SurfaceFactory::Create(*refiner);
        std::vector<float> data(shape.positions.size());
        for (std::size_t i = 0; i < data.size(); ++i) {
            data[i] = i % 3 == 0 ? 1 : uniform(random);
        }
        std::vector<double> const sameData(data.begin(), data.end());
        for (int face = 0; face < shape.GetNumFaces(); ++face) {
            PlacedSurface exact;
            ASSERT_TRUE(exact.Init(*factory, sameData, face));
            Surface<float> surface;
            ASSERT_TRUE(factory->InitVertexSurface(face, &surface));
            std::vector<float> points(exact.points.size());
            surface.PreparePatchPoints(data.data(), 3, points.data(), 3);
            for (Uv const &uv : findPlaces(surface.GetFaceSize(), 20)) {
                float const sameUv[2] = {float(uv[0]), float(uv[1])};
                float p[3];
                float du[3];
                float dv[3];
                surface.Evaluate(sameUv, points.data(), 3, p, du, dv);
                std::array<Vector3, 6> const expected = exact.Evaluate({sameUv[0], sameUv[1]});
                EXPECT_NEAR(p[0], 1, 1e-6);
                for (std::size_t k = 0; k < 3; ++k) {
                    EXPECT_NEAR(p[k], expected[0][k], 8e-6);
                    EXPECT_NEAR(du[k], expected[1][k], 2e-4);
                    EXPECT_NEAR(dv[k], expected[2][k], 2e-4);
                }
            }
        }
    }
}

// Any order of faces, some of which come several times and some never, and any threads.
TEST(SurfacePlaces, OfManyFacesAreThoseOfEach) {
    Shape const shape = MakeTorus(8, 6, TorusFaces::IrregularTriangles);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getOptions());
    auto factory = SurfaceFactory::Create(*refiner);
    constexpr int kNumPlaces = 500;
    std::mt19937 random(3);
    std::vector<int> faces;
    std::vector<double> uvs;
    for (Uv const &uv : findPlaces(3, kNumPlaces)) {
        faces.push_back(int(random() % (unsigned(shape.GetNumFaces()) / 2)));
        uvs.insert(uvs.end(), uv.begin(), uv.end());
    }
    std::vector<double> expected[3];
    PlacedSurface surface;
    for (std::size_t i = 0; i < std::size_t(kNumPlaces); ++i) {
        ASSERT_TRUE(surface.Init(*factory, shape.positions, faces[i]));
        std::array<Vector3, 6> const at = surface.Evaluate({uvs[2 * i], uvs[2 * i + 1]});
        for (std::size_t k = 0; k < 3; ++k) {
            expected[k].insert(expected[k].end(), at[k].begin(), at[k].end());
        }
    }
    using Places = BfrExt::SurfacePlaces<double>;
    auto const places = Places::Create(*factory, kNumPlaces, faces.data(), uvs.data());
    ASSERT_TRUE(places);
    EXPECT_EQ(places->GetNumPlaces(), kNumPlaces);
    factory.reset();
    for (int const numThreads : {1, 3}) {
        FarExt::SetNumThreads(numThreads);
        std::vector<double> results[3];
        for (std::vector<double> &result : results) {
            result.resize(3 * std::size_t(kNumPlaces));
        }
        places->Evaluate(shape.positions.data(), 3, results[0].data(), results[1].data(),
                         results[2].data(), 3);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(results[k], expected[k]);
        }
        std::vector<double> alone(5 * std::size_t(kNumPlaces), 77);
        places->Evaluate(shape.positions.data(), 3, alone.data(), {3, 5});
        for (std::size_t i = 0; i < alone.size(); ++i) {
            ASSERT_EQ(alone[i], i % 5 < 3 ? expected[0][i / 5 * 3 + i % 5] : 77);
        }
    }
    FarExt::SetNumThreads(0);

    auto const other = SurfaceFactory::Create(*refiner);
    FarExt::CallStatus status;
    EXPECT_EQ(Places::Create(*other, 0, nullptr, nullptr)->GetNumPlaces(), 0);
    Places::Options ofChannel;
    ofChannel.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
    ofChannel.fvarChannel = 7;
    EXPECT_FALSE(Places::Create(*other, 0, nullptr, nullptr, ofChannel, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    EXPECT_FALSE(Places::Create(*other, -1, nullptr, nullptr, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    float const v = uvs[2 * 5 + 1];
    uvs[2 * 5 + 1] = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(Places::Create(*other, kNumPlaces, faces.data(), uvs.data(), &status));
    EXPECT_EQ(status.GetComponentIndex(), faces[5]);
    EXPECT_EQ(status.GetErrorMessage(),
              "u and v of place 5 are not finite, in face " + std::to_string(faces[5]));
    uvs[2 * 5 + 1] = v;
    faces[7] = shape.GetNumFaces();
    EXPECT_FALSE(Places::Create(*other, kNumPlaces, faces.data(), uvs.data(), &status));
    EXPECT_EQ(status.GetComponentIndex(), shape.GetNumFaces());
}

// Patches of quads in a lattice are sums of the control points, those of other faces are sums of a few points more.
TEST(SurfacePlaces, HaveFewPatchPoints) {
    auto const quads = MakeTorus(12, 8, TorusFaces::Quads);
    auto const triangles = MakeTorus(6, 5, TorusFaces::IrregularTriangles);
    for (Shape const *const shape : {&quads, &triangles, &GetFeatureShape("dartsTriangles")}) {
        auto const refiner = CreateRefiner(*shape, ReferenceMask::Smooth, 0, getOptions());
        std::vector<int> numPoints[2];
        for (int const level : {2, 4}) {
            auto const factory = SurfaceFactory::Create(
                *refiner,
                SurfaceFactory::Options().SetApproxLevelSmooth(level).SetApproxLevelSharp(level));
            for (int face = 0; face < shape->GetNumFaces(); ++face) {
                Surface<float> surface;
                ASSERT_TRUE(factory->InitVertexSurface(face, &surface));
                int const number = surface.GetNumPatchPoints();
                EXPECT_LT(number, 300);
                EXPECT_EQ(shape == &quads, number == surface.GetNumControlPoints());
                numPoints[level / 4].push_back(number);
            }
        }
        EXPECT_EQ(numPoints[0], numPoints[1]);
    }
}

TEST(SurfacePlaces, OfInvalidSurfacesAndPlacesAreNone) {
    Surface<double> surface;
    EXPECT_EQ(surface.GetNumPatchPoints(), 0);
    double untouched = 7;
    surface.ComputePatchPoints(&untouched, 1);
    EXPECT_EQ(untouched, 7);

    Shape const shape = MakePrism(4);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getOptions());
    auto const factory = SurfaceFactory::Create(*refiner);
    PlacedSurface placed;
    ASSERT_TRUE(placed.Init(*factory, shape.positions, 0));
    double const none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(placed.Evaluate({none, 0.5})[0][0]));
    // Outside is on the boundary, towards the centre.
    EXPECT_EQ(placed.Evaluate({5, 5})[0], placed.Evaluate({1, 1})[0]);
    EXPECT_EQ(placed.Evaluate({2, 0.5})[0], placed.Evaluate({1, 0.5})[0]);
}

} // namespace OpenSubdivHex::Regression::surfacePlacesTest

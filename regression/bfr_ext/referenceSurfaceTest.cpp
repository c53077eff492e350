// SPDX-License-Identifier: Apache-2.0
//
// Surfaces against the limits that the reference finds by refining again and again.
#include "facePlaces.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include "regression/far_ext/referenceMatch.h"
#include "regression/far_ext/taggedMatch.h"
#include "regression/reference/baseRegions.h"
#include "regression/reference/largestValue.h"
#include "regression/reference/limitReference.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace OpenSubdivHex::Regression::referenceSurfaceTest {

namespace {

/// A shape refined by the reference, with the places that vertices of its last level have.
class ReferenceSurface {
public:
    /// \param refiner  of the shape, refined to the surface level
    ReferenceSurface(Shape const &shape, FarExt::TopologyRefiner const &refiner, ReferenceMask mask)
        : _mask(mask), _positions(GetPositions(shape)) {
        TaggedMatch const match(shape, refiner);
        EXPECT_EQ(match.GetError(), "");
        int const level = refiner.GetMaxLevel();
        _mesh = match.GetMesh(level);
        if (level > 0) {
            _positions = Interpolate(match.GetMesh(0), _mesh, mask, _positions);
        }
        _pieces = MakeBasePieces(_mesh);
        FarExt::SurfaceFaces const faces(refiner.GetLevel(level).GetLevel());
        for (BasePiece &piece : _pieces) {
            // The library may begin a face at another corner.
            std::vector<int> const &corners = match.GetLibraryCorners(level, piece.face);
            // A face that a crease crosses is two of the reference, as long as it is sharp.
            int const half = std::max(match.GetLibraryHalf(level, piece.face), 0);
            piece.baseFace = faces.GetFace({match.GetLibraryFace(level, piece.face), half});
            int const size = faces.GetShape(piece.baseFace).size;
            ReferencePolygon const polygon = DivideBasePolygon(size, 0)[0];
            for (int local = 0; local < size; ++local) {
                auto const corner = std::find(corners.begin(), corners.end(),
                                              faces.GetPlace(piece.baseFace, local));
                if (corner != corners.end()) {
                    piece.places[std::size_t(corner - corners.begin())] =
                        polygon[std::size_t(local)];
                }
            }
        }
        setPlaces();
    }

    void Refine() {
        TaggedMesh child = Regression::Refine(_mesh);
        _pieces = RefineBasePieces(_mesh, child, _pieces);
        _positions = Interpolate(_mesh, child, _mask, _positions);
        _mesh = std::move(child);
        setPlaces();
    }

    struct Place {
        int baseFace;
        std::array<double, 2> inPlane; // of triangles and quads, (u, v)
    };
    /// By vertex, in all base faces around.
    std::map<int, std::vector<Place>> const &GetPlaces() const { return _places; }
    TaggedMesh const &GetMesh() const { return _mesh; }

    Vector3 FindLimit(LimitReference &limits, int vertex) const {
        Eigen::RowVectorXd const limit = limits.Find(_mesh, _positions, vertex);
        return {limit[0], limit[1], limit[2]};
    }

private:
    void setPlaces() {
        _places.clear();
        for (BasePiece const &piece : _pieces) {
            for (std::size_t i = 0; i < piece.corners.size(); ++i) {
                int const vertex = _mesh.faces[piece.face].vertices[piece.corners[i]];
                _places[vertex].push_back({piece.baseFace, piece.places[i]});
            }
        }
    }

    ReferenceMask const _mask;
    TaggedMesh _mesh;
    ReferenceValues _positions;
    std::vector<BasePiece> _pieces;
    std::map<int, std::vector<Place>> _places;
};

/// Counts of comparisons, for the log.
struct Comparison {
    void Report() const {
        std::cout << numPlaces << " places, the largest distance " << largest << " of the size\n";
    }

    long numPlaces = 0;
    double largest = 0;
};

void expectLimits(SurfaceSet<double> const &surfaces, ReferenceSurface const &reference,
                  double size, std::size_t maxNumVertices, LimitReference &limits,
                  Comparison &comparison) {
    auto const hasSurface = [&](ReferenceSurface::Place const &place) {
        return surfaces[place.baseFace].IsValid();
    };
    std::vector<int> vertices;
    for (auto const &[vertex, places] : reference.GetPlaces()) {
        if (std::any_of(places.begin(), places.end(), hasSurface)) {
            vertices.push_back(vertex);
        }
    }
    std::mt19937 random(unsigned(vertices.size()));
    std::shuffle(vertices.begin(), vertices.end(), random);
    vertices.resize(std::min(vertices.size(), maxNumVertices));
    for (int const vertex : vertices) {
        Vector3 const limit = reference.FindLimit(limits, vertex);
        for (ReferenceSurface::Place const &place : reference.GetPlaces().at(vertex)) {
            if (!hasSurface(place)) {
                continue;
            }
            FacePlace const uv = FromPlane(surfaces[place.baseFace].GetFaceSize(), place.inPlane);
            double const distance =
                GetDistance(surfaces.EvaluatePosition(place.baseFace, uv.data()), limit) / size;
            comparison.largest = std::max(comparison.largest, distance);
            ++comparison.numPlaces;
            ASSERT_LE(distance, 1e-11) << "vertex " << vertex << ", face " << place.baseFace
                                       << " at " << place.inPlane[0] << ", " << place.inPlane[1];
        }
    }
}

/// At some of the levels up to \p maxLevel behind the surface level.
void expectLimits(Shape const &shape, SurfaceCase const &surfaceCase,
                  Sdc::Options::VtxBoundaryInterpolation boundary, int maxLevel,
                  std::size_t maxNumVertices, LimitReference &limits, Comparison &comparison) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    auto const refiner = CreateSurfaceRefiner(shape, surfaceCase, 0, options);
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    ReferenceSurface reference(shape, *refiner, surfaceCase.mask);
    double const size = GetSize(GetPositions(shape));
    int const lastLevel = GetTestLevel(shape, maxLevel, surfaceCase.HasFirstStep() ? 1000 : 4000);
    for (int level = 0; level <= lastLevel; ++level) {
        SCOPED_TRACE(testing::Message()
                     << shape.name << ", boundary rule " << boundary << ", level " << level);
        if (level > 0) {
            reference.Refine();
        }
        ASSERT_NO_FATAL_FAILURE(
            expectLimits(surfaces, reference, size, maxNumVertices, limits, comparison));
    }
}

} // namespace

class ReferenceSurfaceTest : public testing::TestWithParam<SurfaceCase> {};
class ReferenceFeatureTest : public testing::TestWithParam<SurfaceCase> {};
class ReferenceDerivativeTest : public testing::TestWithParam<ReferenceMask> {};

TEST_P(ReferenceSurfaceTest, PointsAreTheLimitsOfTheReference) {
    constexpr int kManyCorners = 300; // the reference takes long for polygons of as many sides
    LimitReference limits(GetParam().mask);
    Comparison comparison;
    for (Shape const &shape : GetParam().IsPlain() ? GetManifoldShapes() : GetShapes()) {
        if (GetParam().HasFirstStep() && shape.GetNumCorners() > kManyCorners) {
            continue;
        }
        ASSERT_NO_FATAL_FAILURE(expectLimits(
            shape, GetParam(), Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, 3, 6, limits, comparison));
    }
    comparison.Report();
}

TEST_P(ReferenceFeatureTest, PointsAreTheLimitsOfTheReference) {
    LimitReference limits(GetParam().mask);
    Comparison comparison;
    for (Shape const &shape : GetFeatureShapes()) {
        for (auto const boundary :
             {Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
            ASSERT_NO_FATAL_FAILURE(
                expectLimits(shape, GetParam(), boundary, 1, 4, limits, comparison));
        }
    }
    comparison.Report();
}

namespace {

/// The derivatives of the quadratic function that is nearest to some points: by u, by v, and the second ones.
std::array<Vector3, 5> fitDerivatives(std::vector<std::array<double, 2>> const &places,
                                      std::vector<Vector3> const &points) {
    Eigen::MatrixXd terms(Eigen::Index(places.size()), 6);
    Eigen::MatrixXd values(Eigen::Index(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i) {
        auto const [u, v] = places[i];
        terms.row(Eigen::Index(i)) << 1, u, v, u * u, u * v, v * v;
        values.row(Eigen::Index(i)) << points[i][0], points[i][1], points[i][2];
    }
    Eigen::MatrixXd const found = terms.colPivHouseholderQr().solve(values);
    double const factors[] = {1, 1, 2, 1, 2};
    std::array<Vector3, 5> derivatives;
    for (Eigen::Index i = 0; i < 5; ++i) {
        derivatives[std::size_t(i)] =
            Scale({found(1 + i, 0), found(1 + i, 1), found(1 + i, 2)}, factors[i]);
    }
    return derivatives;
}

Vector3 sum(double a, Vector3 const &x, double b, Vector3 const &y) {
    return Subtract(Scale(x, a), Scale(y, -b));
}

/// Derivatives by u and v, from those by the coordinates of the plane of a face.
std::array<Vector3, 5> toUv(int faceSize, FacePlace const &uv,
                            std::array<Vector3, 5> const &inPlane) {
    auto const [place, byU, byV, byUv] =
        FarExt::internal::FindInPlane(BfrExt::Parameterization(faceSize), uv);
    auto const first = [&](FacePlace const &d) { return sum(d[0], inPlane[0], d[1], inPlane[1]); };
    auto const second = [&](FacePlace const &d, FacePlace const &e) {
        Vector3 const ofOne = sum(d[0] * e[0], inPlane[2], d[1] * e[1], inPlane[4]);
        return sum(1, ofOne, d[0] * e[1] + d[1] * e[0], inPlane[3]);
    };
    return {first(byU), first(byV), second(byU, byU), sum(1, second(byU, byV), 1, first(byUv)),
            second(byV, byV)};
}

/// How far second derivatives are from those of fitDerivatives(), over the length of the longest.
double getDistanceOfSecond(std::array<Vector3, 3> const &found,
                           std::array<Vector3, 5> const &expected) {
    double distance = 0;
    double length = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        distance = GetLarger(distance, GetDistance(found[i], expected[2 + i]));
        length = std::max(length, GetLength(expected[2 + i]));
    }
    return distance / length;
}

/// How far a place in a polygon is from the lines between the triangles of the centre and an edge each.
double getDistanceToSectors(ReferencePolygon const &polygon, std::array<double, 2> const &place) {
    std::array<double, 2> center{};
    for (std::array<double, 2> const &corner : polygon) {
        center[0] += corner[0] / double(polygon.size());
        center[1] += corner[1] / double(polygon.size());
    }
    double distance = 1;
    auto const addLine = [&](std::array<double, 2> const &p, std::array<double, 2> const &q) {
        std::array<double, 2> const d = {q[0] - p[0], q[1] - p[1]};
        double const cross = d[0] * (place[1] - p[1]) - d[1] * (place[0] - p[0]);
        distance = std::min(distance, std::abs(cross) / std::hypot(d[0], d[1]));
    };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        addLine(polygon[i], polygon[(i + 1) % polygon.size()]);
        addLine(polygon[i], center);
    }
    return distance;
}

} // namespace

// Inside of sectors, between which parameters have kinks.
TEST_P(ReferenceDerivativeTest, DerivativesAreThoseOfTheReference) {
    constexpr int kLevel = 6;
    constexpr double kDistance = 0.07;
    LimitReference limits(GetParam());
    int numPlaces = 0;
    double largest = 0;
    double sum = 0;
    double largestOfSecond = 0;
    double sumOfSecond = 0;
    for (char const *const name : {"cube", "icosahedron", "creasedBall", "dartsQuads"}) {
        SCOPED_TRACE(name);
        auto const &plain = GetManifoldShapes();
        bool const isPlain = std::any_of(plain.begin(), plain.end(),
                                         [&](Shape const &shape) { return shape.name == name; });
        Shape const &shape = isPlain ? GetShape(name) : GetFeatureShape(name);
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        auto const refiner = CreateRefiner(shape, GetParam(), 0, options);
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        ReferenceSurface reference(shape, *refiner, GetParam());
        for (int level = 0; level < kLevel; ++level) {
            reference.Refine();
        }
        std::mt19937 random(7);
        auto const &places = reference.GetPlaces();
        TaggedMesh const &mesh = reference.GetMesh();
        for (int sample = 0; sample < 60; ++sample) {
            auto const chosen = std::next(places.begin(), std::ptrdiff_t(random() % places.size()));
            ReferenceSurface::Place const &place = chosen->second.front();
            ReferencePolygon const polygon =
                DivideBasePolygon(surfaces[place.baseFace].GetFaceSize(), 0)[0];
            if (getDistanceToSectors(polygon, place.inPlane) < kDistance) {
                continue;
            }
            std::vector<std::array<double, 2>> around;
            std::vector<Vector3> points;
            std::set<int> vertices;
            for (TaggedMesh::Side const corner : mesh.vertices[chosen->first].corners) {
                auto const &face = mesh.faces[corner.face];
                vertices.insert(face.vertices.begin(), face.vertices.end());
            }
            for (int const vertex : vertices) {
                auto const &uv = places.at(vertex).front().inPlane;
                around.push_back({uv[0] - place.inPlane[0], uv[1] - place.inPlane[1]});
                points.push_back(reference.FindLimit(limits, vertex));
            }
            int const size = surfaces[place.baseFace].GetFaceSize();
            FacePlace const uv = FromPlane(size, place.inPlane);
            std::array<Vector3, 5> const expected = toUv(size, uv, fitDerivatives(around, points));
            SurfacePoint const point = surfaces.Evaluate(place.baseFace, uv.data());
            ++numPlaces;
            if (GetParam() == ReferenceMask::Smooth) {
                double const distance = getDistanceOfSecond(
                    surfaces.EvaluateSecond(place.baseFace, uv.data()), expected);
                largestOfSecond = GetLarger(largestOfSecond, distance);
                sumOfSecond += distance;
            }
            for (auto const &[found, wanted] :
                 {std::pair(point.du, expected[0]), std::pair(point.dv, expected[1])}) {
                double const distance = GetDistance(found, wanted) / GetLength(wanted);
                largest = GetLarger(largest, distance);
                sum += distance / 2;
                ASSERT_LE(distance, 0.026) << "face " << place.baseFace << " at "
                                           << place.inPlane[0] << ", " << place.inPlane[1];
            }
        }
    }
    std::cout << numPlaces << " places, the largest distance " << largest << " of the length, "
              << sum / numPlaces << " on average; of second derivatives " << largestOfSecond
              << " and " << sumOfSecond / numPlaces << '\n';
    EXPECT_GT(numPlaces, 60);
    // Derivatives of a fit are off by as much as they change over its points, which lie in a 32nd of the face: second
    // ones by .3 and .05, and more where quads have a mask for each place.
    double const factor = GetParam() == ReferenceMask::Smooth ? 3 : 1;
    EXPECT_LE(sum, 0.0011 * factor * numPlaces);
    EXPECT_LE(largestOfSecond, 0.4 * factor);
    EXPECT_LE(sumOfSecond, 0.06 * factor * numPlaces);
}

namespace {

std::string getName(testing::TestParamInfo<SurfaceCase> const &info) {
    return info.param.GetName();
}

} // namespace

INSTANTIATE_TEST_SUITE_P(Masks, ReferenceSurfaceTest, testing::ValuesIn(kPlainCases), getName);
INSTANTIATE_TEST_SUITE_P(Truncate, ReferenceSurfaceTest, testing::ValuesIn(kTruncateCases),
                         getName);
INSTANTIATE_TEST_SUITE_P(TriHex, ReferenceSurfaceTest, testing::ValuesIn(kTriHexCases), getName);
INSTANTIATE_TEST_SUITE_P(Masks, ReferenceFeatureTest, testing::ValuesIn(kPlainCases), getName);
INSTANTIATE_TEST_SUITE_P(Truncate, ReferenceFeatureTest, testing::ValuesIn(kTruncateCases),
                         getName);
// With Average there are none.
INSTANTIATE_TEST_SUITE_P(Masks, ReferenceDerivativeTest,
                         testing::Values(ReferenceMask::Cosine, ReferenceMask::Smooth),
                         [](auto const &mask) { return std::string(ToString(mask.param)); });

} // namespace OpenSubdivHex::Regression::referenceSurfaceTest

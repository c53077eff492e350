// SPDX-License-Identifier: Apache-2.0
//
// The base faces of refined faces and halves, and places in their parameter planes.
#include "far_ext/baseFaceMap.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/level.h"
#include "referenceMatch.h"
#include "regionMatch.h"
#include "regression/reference/baseRegions.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"
#include "valueLevels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace OpenSubdivHex::Regression::baseFaceTest {

namespace {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;
using Polygon = ReferencePolygon;

/// Calls check(shape, refiner) for all shapes and boundary rules.
template <typename CHECK>
void forEachRefiner(int maxLevel, double maxCorners, CHECK const &check) {
    for (Shape const &shape : GetAllShapes()) {
        for (auto boundary : kBoundaries) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(boundary);
            check(shape, *CreateRefiner(shape, ReferenceMask::Smooth,
                                        GetTestLevel(shape, maxLevel, maxCorners), options));
            if (testing::Test::HasFatalFailure()) {
                return;
            }
        }
    }
}

bool hasRepeatedVertex(Shape const &shape) {
    auto first = shape.faceVertices.begin();
    bool result = false;
    for (int size : shape.faceSizes) {
        result = result || int(std::set<int>(first, first + size).size()) < size;
        first += size;
    }
    return result;
}

/// A face, or a half with a base face of its own: its corners and their places.
struct Piece {
    int baseFace;
    std::vector<int> corners;
    Polygon polygon;
};

std::vector<Piece> findPieces(TopologyLevel const &level) {
    std::vector<Piece> pieces;
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        int const size = level.GetFaceVertices(face).size();
        bool const isSplit = level.IsFaceBaseSplit(face);
        for (int half = 0; half < (isSplit ? 2 : 1); ++half) {
            Piece piece{level.GetFaceBaseFace(face, half), {}, {}};
            int const end = level.GetFaceDiagonalEnd(face);
            for (int i = 0; i < (isSplit ? FarExt::GetHalfSize(half, size, end) : size); ++i) {
                piece.corners.push_back(isSplit ? FarExt::GetPlaceInHalves(half, i, end) : i);
            }
            piece.polygon.resize(piece.corners.size());
            if (!level.GetFaceBaseCoords(face, half, piece.polygon[0].data())) {
                ADD_FAILURE() << "face " << face << " has no coordinates";
                return {};
            }
            for (int &corner : piece.corners) {
                corner = level.GetFaceVertices(face)[corner];
            }
            pieces.push_back(piece);
        }
    }
    return pieces;
}

double computeArea(Polygon const &polygon) {
    double area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        auto const &p = polygon[i];
        auto const &q = polygon[(i + 1) % polygon.size()];
        area += 0.5 * (p[0] * q[1] - p[1] * q[0]);
    }
    return area;
}

/// Halves of hexagons that lie in one base face.
std::vector<Polygon> cutHexagons(std::vector<Piece> const &pieces, int baseFace, int baseSize) {
    std::vector<Polygon> result;
    for (Piece const &piece : pieces) {
        if (piece.baseFace != baseFace) {
            continue;
        }
        bool const isFFace = result.empty(); // the first has the index of the base face
        if (piece.polygon.size() == 6 && !(isFFace && baseSize == 6)) {
            for (auto const &half : FarExt::kHexagonHalves) {
                result.emplace_back();
                for (int i : half) {
                    result.back().push_back(piece.polygon[std::size_t(i)]);
                }
            }
        } else {
            result.push_back(piece.polygon);
        }
    }
    return result;
}

/// Whether the polygons are the same, up to their order and where each begins.
bool areSame(std::vector<Polygon> actual, std::vector<Polygon> expected) {
    auto const toGrid = [](std::vector<Polygon> const &polygons) {
        std::multiset<std::vector<std::array<long long, 2>>> result;
        for (Polygon const &polygon : polygons) {
            std::vector<std::array<long long, 2>> corners;
            for (auto const &point : polygon) {
                // Not on the middle between two numbers, where points of quads lie.
                corners.push_back({std::llround(point[0] * 1e9 + 0.3), //
                                   std::llround(point[1] * 1e9 + 0.3)});
            }
            std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                        corners.end());
            result.insert(corners);
        }
        return result;
    };
    return toGrid(actual) == toGrid(expected);
}

/// The cube from -1 to 1, all of whose edges are sharp.
Shape makeSharpCube() {
    Shape cube = GetShape("cube");
    for (int v = 0; v < 8; ++v) {
        for (int k = 0; k < 3; ++k) {
            double &x = cube.positions[std::size_t(3 * v + k)];
            x = x > 0 ? 1 : -1;
        }
    }
    for (int f = 0; f < 6; ++f) {
        for (int i = 0; i < 4; ++i) {
            int const v0 = cube.faceVertices[std::size_t(4 * f + i)];
            int const v1 = cube.faceVertices[std::size_t(4 * f + (i + 1) % 4)];
            if (v0 < v1) {
                cube.creaseVertexPairs.insert(cube.creaseVertexPairs.end(), {v0, v1});
                cube.creaseSharpness.push_back(kInfiniteSharpness);
            }
        }
    }
    return cube;
}

constexpr int kTorusColumns = 5;
constexpr int kTorusRows = 4;

/// From one place to another on a flat torus of unit squares, on the shortest way.
std::array<double, 2> subtractOnTorus(std::array<double, 2> const &p,
                                      std::array<double, 2> const &q) {
    return {std::remainder(p[0] - q[0], kTorusColumns), std::remainder(p[1] - q[1], kTorusRows)};
}

/// A place on that torus with the interface of Far's primvar refiner.
struct TorusPoint {
    void Clear() { isClear = true; }
    void AddWithWeight(TorusPoint const &other, double weight) {
        if (isClear) { // weights sum to 1: the rest is in terms of this one
            isClear = false;
            start = place = other.place;
        }
        std::array<double, 2> const way = subtractOnTorus(other.place, start);
        place[0] += weight * way[0];
        place[1] += weight * way[1];
    }

    std::array<double, 2> place = {};
    std::array<double, 2> start = {};
    bool isClear = true;
};

/// Quads, of which face j * kTorusColumns + i has its corners at (i, j) ... (i + 1, j + 1).
Shape makeFlatTorus() {
    Shape torus;
    torus.name = "flat torus";
    torus.closed = torus.manifold = true;
    auto const vertex = [](int i, int j) {
        return j % kTorusRows * kTorusColumns + i % kTorusColumns;
    };
    for (int j = 0; j < kTorusRows; ++j) {
        for (int i = 0; i < kTorusColumns; ++i) {
            torus.positions.insert(torus.positions.end(), {double(i), double(j), 0});
            torus.faceSizes.push_back(4);
            for (int const corner :
                 {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)}) {
                torus.faceVertices.push_back(corner);
            }
        }
    }
    return torus;
}

} // namespace

TEST(BaseFace, RegionsAndHolesEqualReference) {
    forEachRefiner(4, 8000, [](Shape const &shape, TopologyRefiner const &refiner) {
        ASSERT_EQ(FindRegionError(shape, refiner), "");
    });
}

TEST(BaseFace, SharpCubeKnowsItsSides) {
    Shape const cube = makeSharpCube();
    auto const refiner = CreateRefiner(cube, ReferenceMask::Smooth, 6);
    auto const positions = InterpolateLevels(*refiner, GetPositions(cube));
    for (int depth = 1; depth <= 6; ++depth) {
        TopologyLevel const &level = refiner->GetLevel(depth);
        int numSplit = 0;
        for (int face = 0; face < level.GetNumFaces(); ++face) {
            numSplit += level.IsFaceBaseSplit(face) ? 1 : 0;
            ASSERT_EQ(level.IsFaceBaseSplit(face), level.GetFaceDiagonalSharpness(face) > 0);
        }
        // Along an edge 1, 3, 5, 11, 21 ... segments, of which 1, 1, 3, 5, 11 ... are diagonals.
        int const numDiagonals[] = {0, 1, 1, 3, 5, 11, 21};
        ASSERT_EQ(numSplit, 12 * numDiagonals[depth]);
        for (Piece const &piece : findPieces(level)) {
            // The side of the cube is the plane of the base face's vertices.
            auto const base = refiner->GetLevel(0).GetFaceVertices(piece.baseFace);
            for (int axis = 0; axis < 3; ++axis) {
                double const side = positions[0](base[0], axis);
                if (positions[0](base[1], axis) == side && positions[0](base[2], axis) == side) {
                    for (int vertex : piece.corners) {
                        ASSERT_NEAR(positions[std::size_t(depth)](vertex, axis), side, 1e-12);
                    }
                }
            }
        }
    }
}

// Mirrored at each line of the lattice a flat torus stays as it is, and so do its refinements: points
// on lines stay there, others on their side.  So the squares themselves say what lies in them.
TEST(BaseFace, SmoothTorusLiesInItsSquares) {
    Shape const torus = makeFlatTorus();
    int const numFaces = torus.GetNumFaces();
    auto const refiner = CreateRefiner(torus, ReferenceMask::Smooth, 6);
    FarExt::PrimvarRefinerReal<double> const primvarRefiner(*refiner);
    for (bool const isVarying : {false, true}) {
        std::vector<TorusPoint> points(std::size_t(torus.GetNumVertices()));
        for (std::size_t v = 0; v < points.size(); ++v) {
            points[v].place = {torus.positions[3 * v], torus.positions[3 * v + 1]};
        }
        for (int depth = 1; depth <= 6; ++depth) {
            SCOPED_TRACE(testing::Message() << "level " << depth << ", varying " << isVarying);
            TopologyLevel const &level = refiner->GetLevel(depth);
            std::vector<TorusPoint> refined(std::size_t(level.GetNumVertices()));
            if (isVarying) {
                primvarRefiner.InterpolateVarying(depth, points, refined);
            } else {
                primvarRefiner.Interpolate(depth, points, refined);
            }
            points = refined;

            std::vector<double> areas(torus.faceSizes.size());
            std::vector<double> parameterAreas(torus.faceSizes.size());
            for (Piece const &piece : findPieces(level)) {
                std::array<double, 2> const middle = {piece.baseFace % kTorusColumns + 0.5,
                                                      piece.baseFace / kTorusColumns + 0.5};
                Polygon polygon;
                for (int const vertex : piece.corners) {
                    auto const way = subtractOnTorus(points[std::size_t(vertex)].place, middle);
                    ASSERT_LE(std::max(std::abs(way[0]), std::abs(way[1])), 0.5 + 1e-12)
                        << "vertex " << vertex << ", base face " << piece.baseFace;
                    polygon.push_back({way[0], way[1]});
                }
                double const area = computeArea(polygon);
                ASSERT_GT(area, 0);
                areas[std::size_t(piece.baseFace)] += area;
                parameterAreas[std::size_t(piece.baseFace)] += computeArea(piece.polygon);
            }
            for (int face = 0; face < numFaces; ++face) {
                EXPECT_NEAR(areas[std::size_t(face)], 1, 1e-12) << "base face " << face;
                EXPECT_EQ(parameterAreas[std::size_t(face)], 1) << "base face " << face;
            }
            // Along an edge of the base mesh (2^n - (-1)^n) / 3 hexagons: each becomes one and two
            // edges, and each edge becomes one.
            int numSplit = 0;
            for (int face = 0; face < level.GetNumFaces(); ++face) {
                numSplit += level.IsFaceBaseSplit(face) ? 1 : 0;
            }
            int const numOfEdge = ((1 << depth) + (depth % 2 == 0 ? -1 : 1)) / 3;
            EXPECT_EQ(numSplit, 2 * numFaces * numOfEdge);
        }
    }
}

TEST(BaseFace, CoordsAreThoseOfDividedPolygons) {
    int numPolygons = 0;
    forEachRefiner(4, 4000, [&](Shape const &shape, TopologyRefiner const &refiner) {
        bool const isFree = refiner.GetSchemeOptions().GetVtxBoundaryInterpolation() ==
                            Sdc::Options::VTX_BOUNDARY_NONE;
        if (isFree && !shape.closed) {
            return; // there are quads that are no halves
        }
        for (int depth = 0; depth <= refiner.GetMaxLevel(); ++depth) {
            std::vector<Piece> const pieces = findPieces(refiner.GetLevel(depth));
            for (int face = 0; face < std::min(shape.GetNumFaces(), 20); ++face) {
                int const size = refiner.GetLevel(0).GetFaceVertices(face).size();
                ASSERT_TRUE(
                    areSame(cutHexagons(pieces, face, size), DivideBasePolygon(size, depth)))
                    << "base face " << face << ", level " << depth;
                ++numPolygons;
            }
        }
    });
    EXPECT_GT(numPolygons, 1000);
}

TEST(BaseFace, AreasSumToTheWhole) {
    forEachRefiner(5, 6000, [](Shape const &shape, TopologyRefiner const &refiner) {
        for (int depth = 0; depth <= refiner.GetMaxLevel(); ++depth) {
            std::vector<double> areas(std::size_t(shape.GetNumFaces()));
            for (Piece const &piece : findPieces(refiner.GetLevel(depth))) {
                double const area = computeArea(piece.polygon);
                ASSERT_GT(area, 0); // none is turned over
                areas[std::size_t(piece.baseFace)] += area;
            }
            for (int face = 0; face < shape.GetNumFaces(); ++face) {
                int const size = refiner.GetLevel(0).GetFaceVertices(face).size();
                double const whole =
                    size == 3 ? 0.5 : size / (4 * std::tan(std::acos(-1.0) / size));
                if (size == 4) {
                    ASSERT_EQ(areas[std::size_t(face)], 1) << "base face " << face;
                } else {
                    ASSERT_NEAR(areas[std::size_t(face)], whole, 1e-12 * whole);
                }
            }
        }
    });
}

TEST(BaseFace, CoordsOfAVertexAreTheSameBits) {
    forEachRefiner(4, 6000, [](Shape const &shape, TopologyRefiner const &refiner) {
        if (hasRepeatedVertex(shape)) {
            return; // such a vertex has several places
        }
        std::map<std::pair<int, int>, std::array<double, 2>> places; // by base face and vertex
        for (int depth = 0; depth <= refiner.GetMaxLevel(); ++depth) {
            TopologyLevel const &level = refiner.GetLevel(depth);
            double const unit = std::ldexp(1.0, depth + 2);
            for (Piece const &piece : findPieces(level)) {
                int const size = refiner.GetLevel(0).GetFaceVertices(piece.baseFace).size();
                for (std::size_t i = 0; i < piece.corners.size(); ++i) {
                    auto const &point = piece.polygon[i];
                    auto const inserted =
                        places.try_emplace({piece.baseFace, piece.corners[i]}, point);
                    ASSERT_EQ(inserted.first->second, point);
                    if (size == 4 && shape.closed) {
                        ASSERT_EQ(point[0] * unit, std::floor(point[0] * unit));
                        ASSERT_EQ(point[1] * unit, std::floor(point[1] * unit));
                    }
                }
            }
        }
        std::vector<float> floats(2 * 6);
        std::vector<double> doubles(2 * 6);
        TopologyLevel const &last = refiner.GetLevel(refiner.GetMaxLevel());
        for (int face = shape.GetNumFaces(); face < last.GetNumFaces(); ++face) {
            for (int half = 0; half < 2; ++half) {
                ASSERT_TRUE(last.GetFaceBaseCoords(face, half, floats.data()));
                ASSERT_TRUE(last.GetFaceBaseCoords(face, half, doubles.data()));
                for (std::size_t i = 0; i < floats.size(); ++i) {
                    ASSERT_EQ(floats[i], float(doubles[i]));
                }
            }
        }
    });
}

TEST(BaseFace, OtherStepsCountToTheFirst) {
    for (Shape shape : GetShapes()) {
        shape.fvarChannels.clear(); // not all steps take them
        for (int kind = 0; kind < 5; ++kind) {
            SCOPED_TRACE(testing::Message() << shape.name << ", kind " << kind);
            FarExt::HexSchemeOptions options;
            options.schemeType = kind == 0   ? FarExt::SchemeType::DooSabin
                                 : kind == 1 ? FarExt::SchemeType::TriHex
                                             : FarExt::SchemeType::Hexagonal;
            options.firstStep = kind == 2   ? FarExt::FirstStep::TriHex
                                : kind == 4 ? FarExt::FirstStep::Truncate
                                            : FarExt::FirstStep::Same;
            auto const refiner =
                FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape), {options});
            ASSERT_TRUE(refiner);
            int const maxLevel = GetTestLevel(shape, 3, 4000);
            if (kind == 3) {
                TopologyRefiner::CoplanarOptions coplanar(maxLevel);
                coplanar.angleTolerance = 20;
                ASSERT_TRUE(refiner->RefineCoplanar(shape.positions.data(), coplanar));
            } else {
                ASSERT_TRUE(refiner->RefineUniform(maxLevel));
            }
            FarExt::BaseFaceMap const map(*refiner);
            bool isHexagonal = true;
            for (int depth = 1; depth <= maxLevel; ++depth) {
                TopologyLevel const &level = refiner->GetLevel(depth);
                TopologyLevel const &parent = refiner->GetLevel(depth - 1);
                for (int face = 0; face < level.GetNumFaces(); ++face) {
                    int const pFace = level.GetFaceParentFace(face);
                    bool const isOfPart =
                        level.GetFaceBaseFace(face) == parent.GetFaceBaseFace(pFace) ||
                        level.GetFaceBaseFace(face) == parent.GetFaceBaseFace(pFace, 1);
                    ASSERT_TRUE(isOfPart);
                    ASSERT_EQ(map.GetBaseFace(face), level.GetFaceBaseFace(face));
                    ASSERT_EQ(map.GetBaseFace(face, 1), level.GetFaceBaseFace(face, 1));
                    ASSERT_EQ(map.IsSplit(face), level.IsFaceBaseSplit(face));
                    // A hexagon between two faces is split when these are not of one base face.
                    bool const isHexagon = level.GetFaceKind(face) == FarExt::FaceKind::Edge &&
                                           level.GetFaceVertices(face).size() == 6;
                    if (level.GetFaceKind(face) != FarExt::FaceKind::Face && !isHexagon) {
                        ASSERT_FALSE(level.IsFaceBaseSplit(face));
                    }
                }
                std::vector<double> uv(2 * 1000, -7);
                // A coplanar step where no edge is flat.
                isHexagonal = isHexagonal && kind == 3 && level.GetLevel().isHexagonal;
                ASSERT_EQ(level.GetFaceBaseCoords(0, 0, uv.data()), isHexagonal);
                ASSERT_TRUE(isHexagonal || uv[0] == -7);
            }
        }
    }
}

TEST(BaseFace, MapsOfLevelsAgree) {
    Shape const &shape = GetFeatureShapes()[0];
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 4);
    FarExt::BaseFaceMap const whole(*refiner);
    for (int depth = 0; depth <= 4; ++depth) {
        for (FarExt::BaseFaceMap const &map : {FarExt::BaseFaceMap(*refiner, depth),
                                               FarExt::BaseFaceMap(refiner->GetLevel(depth))}) {
            ASSERT_EQ(map.GetNumFaces(), refiner->GetLevel(depth).GetNumFaces());
            std::size_t numSplit = 0;
            for (int face = 0; face < map.GetNumFaces(); ++face) {
                ASSERT_EQ(map.IsSplit(face), whole.IsSplit(face));
                ASSERT_EQ(map.GetBaseFace(face, 0), whole.GetBaseFace(face, 0));
                ASSERT_EQ(map.GetBaseFace(face, 1), whole.GetBaseFace(face, 1));
                if (map.IsSplit(face)) {
                    ASSERT_EQ(map.GetSplitFaces()[numSplit++].face, face);
                }
            }
            ASSERT_EQ(numSplit, map.GetSplitFaces().size());
        }
    }
}

} // namespace OpenSubdivHex::Regression::baseFaceTest

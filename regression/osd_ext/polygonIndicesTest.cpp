// SPDX-License-Identifier: Apache-2.0
//
// Polygons and triangles that draw a level: where hexagons are cut, and what their corners have.
#include "drawnFaces.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace OpenSubdivHex::Regression::polygonIndicesTest {

namespace {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;
using OsdExt::CreaseCuts;
using OsdExt::DrawOptions;
using OsdExt::PolygonIndices;

std::unique_ptr<TopologyRefiner> refine(Shape const &shape, int level, Sdc::Options options = {}) {
    auto refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape, options));
    TopologyRefiner::UniformOptions uniform(level);
    uniform.fullTopologyInLastLevel = true;
    EXPECT_TRUE(refiner && refiner->RefineUniform(uniform));
    return refiner;
}

Far::ConstIndexArray toArray(std::vector<int> const &labels) {
    return {labels.data(), int(labels.size())};
}

} // namespace

TEST(PolygonIndices, AllOptionsOfAllShapes) {
    for (Shape const &shape : GetAllShapes()) {
        Sdc::Options sdcOptions;
        sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        auto const refiner = refine(shape, GetTestLevel(shape, 3, 4000), sdcOptions);
        std::vector<int> labels(shape.faceSizes.size());
        for (int face = 0; face < shape.GetNumFaces(); ++face) {
            labels[std::size_t(face)] = face * face % 3;
        }
        for (int depth = 0; depth <= refiner->GetMaxLevel(); ++depth) {
            TopologyLevel const &level = refiner->GetLevel(depth);
            FarExt::LimitSides const sides(level);
            for (int bits = 0; bits < 128; bits += 1 + depth) {
                SCOPED_TRACE(testing::Message()
                             << shape.name << ", level " << depth << ", options " << bits);
                DrawOptions options;
                options.cutBaseFaces = (bits & 1) != 0;
                options.labels =
                    (bits & 2) != 0 ? toArray(labels) : Far::ConstIndexArray(nullptr, 0);
                options.cutCreases = CreaseCuts(bits >> 2 & 1 ? bits % 3 : 0);
                options.sides = (bits & 8) != 0 ? &sides : nullptr;
                options.splitVertices = options.sides && (bits & 16) != 0;
                options.generateBaseCoords = (bits & 32) != 0;
                options.drawHoles = (bits & 64) != 0;
                options.separateVertices = bits % 3 == 1;
                options.vertexOffset = bits;
                for (int channel = refiner->GetNumFVarChannels() - 1; channel >= 0; --channel) {
                    if ((bits >> channel & 1) != 0) {
                        options.fvarChannels.push_back(channel);
                    }
                }
                ASSERT_EQ(FindDrawingError(level, options), "");
            }
        }
    }
}

TEST(PolygonIndices, OtherSteps) {
    for (Shape const &shape : GetManifoldShapes()) {
        for (int kind = 0; kind < 5; ++kind) {
            FarExt::TopologyRefinerFactory::Options factoryOptions;
            factoryOptions.hexSchemeOptions.firstStep = kind == 1   ? FarExt::FirstStep::TriHex
                                                        : kind == 4 ? FarExt::FirstStep::Truncate
                                                                    : FarExt::FirstStep::Same;
            factoryOptions.hexSchemeOptions.schemeType = kind == 2 ? FarExt::SchemeType::DooSabin
                                                         : kind == 3
                                                             ? FarExt::SchemeType::TriHex
                                                             : FarExt::SchemeType::Hexagonal;
            Shape holed = shape;
            holed.holeFaces = {0, shape.GetNumFaces() / 2};
            holed.fvarChannels.clear(); // not all steps take them
            auto const refiner =
                FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(holed), factoryOptions);
            ASSERT_TRUE(refiner) << shape.name << ", kind " << kind;
            int const maxLevel = GetTestLevel(shape, 2, 4000);
            ASSERT_TRUE(kind == 0 ? refiner->RefineCoplanar(shape.positions.data(), maxLevel)
                                  : refiner->RefineUniform(maxLevel));
            DrawOptions options;
            ASSERT_EQ(FindDrawingError(refiner->GetLevel(maxLevel), options), "") << shape.name;
            options.generateBaseCoords = true;
            FarExt::CallStatus status;
            if (kind > 0 && maxLevel > 0) {
                EXPECT_EQ(
                    OsdExt::CreatePolygonIndices(refiner->GetLevel(maxLevel), options, &status)
                        .GetNumPolygons(),
                    0);
                EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
            }
        }
    }
}

TEST(PolygonIndices, CutsOnlyWhereLabelsDiffer) {
    Shape const &torus = GetShape("torus");
    auto const refiner = refine(torus, 3);
    TopologyLevel const &level = refiner->GetLevel(3);
    std::vector<int> labels(std::size_t(torus.GetNumFaces()), 5);
    DrawOptions options;
    options.cutBaseFaces = false;
    options.labels = toArray(labels);
    PolygonIndices const whole = OsdExt::CreatePolygonIndices(level, options);
    EXPECT_EQ(whole.GetNumPolygons(), level.GetNumFaces());
    // One face of another label: at level 3, an edge is 5 segments, 3 of which are diagonals.
    labels[7] = 6;
    PolygonIndices const cut = OsdExt::CreatePolygonIndices(level, options);
    int const numSides = refiner->GetLevel(0).GetFaceVertices(7).size();
    EXPECT_EQ(cut.GetNumPolygons(), level.GetNumFaces() + 3 * numSides);
    for (int i = 0; i < cut.GetNumPolygons(); ++i) {
        EXPECT_EQ(cut.labels[std::size_t(i)], cut.baseFaces[std::size_t(i)] == 7 ? 6 : 5);
    }
}

// Each drawn part of a mesh is a surface that ends where the part does: its border is the polyline of
// the base edges around it.
TEST(PolygonIndices, PartsEndAtPolylines) {
    Shape strip = MakeTiling(Tiling::Quads, 4, 2);
    strip.holeFaces = {3};
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    for (int depth = 0; depth <= 4; ++depth) {
        auto const refiner = refine(strip, depth, sdcOptions);
        int const numSegments[] = {1, 1, 3, 5, 11};
        for (bool drawHoles : {false, true}) {
            DrawOptions options;
            options.drawHoles = drawHoles;
            PolygonIndices const polygons =
                OsdExt::CreatePolygonIndices(refiner->GetLevel(depth), options);
            std::map<int, std::set<std::pair<int, int>>> borders; // of each base face
            std::size_t corner = 0;
            for (int i = 0; i < polygons.GetNumPolygons(); ++i) {
                int const size = polygons.sizes[std::size_t(i)];
                auto &border = borders[polygons.baseFaces[std::size_t(i)]];
                for (int k = 0; k < size; ++k) {
                    int const v = polygons.vertices[corner + std::size_t(k)];
                    int const w = polygons.vertices[corner + std::size_t((k + 1) % size)];
                    if (border.erase({w, v}) == 0) {
                        ASSERT_TRUE(border.insert({v, w}).second);
                    }
                }
                corner += std::size_t(size);
            }
            EXPECT_EQ(borders.count(3), drawHoles ? 1u : 0u);
            EXPECT_EQ(borders.size(), std::size_t(strip.GetNumFaces()) - (drawHoles ? 0 : 1));
            for (auto const &[face, border] : borders) {
                EXPECT_EQ(border.size(), 4u * std::size_t(numSegments[depth])) << "face " << face;
            }
        }
    }
}

TEST(PolygonIndices, SplitVerticesAreThoseOfSides) {
    Shape const &shape = GetFeatureShape("allCreases");
    auto const refiner = refine(shape, 2);
    TopologyLevel const &level = refiner->GetLevel(2);
    FarExt::LimitSides const sides(level);
    DrawOptions options;
    options.sides = &sides;
    options.splitVertices = true;
    PolygonIndices const polygons = OsdExt::CreatePolygonIndices(level, options);
    std::set<int> const used(polygons.vertices.begin(), polygons.vertices.end());
    EXPECT_EQ(int(used.size()), sides.GetNumSides());
    EXPECT_EQ(polygons.vertices, polygons.sides);
    options.splitVertices = false;
    PolygonIndices const whole = OsdExt::CreatePolygonIndices(level, options);
    for (std::size_t i = 0; i < polygons.vertices.size(); ++i) {
        ASSERT_EQ(sides.GetVertex(polygons.vertices[i]), whole.vertices[i]);
    }
}

// A box whose edges are all creases and seams: each base face has vertices of its own, in all that a
// renderer draws by one index for each corner.
TEST(PolygonIndices, SeparateVerticesAreThoseOfBaseFaces) {
    Shape cube = GetShape("cube");
    FVarChannel channel;
    channel.valueIndices.resize(std::size_t(cube.GetNumCorners()));
    std::iota(channel.valueIndices.begin(), channel.valueIndices.end(), 0);
    channel.values.resize(2 * channel.valueIndices.size());
    cube.fvarChannels = {channel};
    for (int corner = 0; corner < cube.GetNumCorners(); ++corner) {
        int const v = cube.faceVertices[std::size_t(corner)];
        int const w = cube.faceVertices[std::size_t(corner % 4 < 3 ? corner + 1 : corner - 3)];
        if (v < w) {
            cube.creaseVertexPairs.insert(cube.creaseVertexPairs.end(), {v, w});
            cube.creaseSharpness.push_back(Sdc::Crease::SHARPNESS_INFINITE);
        }
    }
    auto const refiner = refine(cube, 3);
    TopologyLevel const &level = refiner->GetLevel(3);
    FarExt::LimitSides const sides(level);
    // Seams alone, creases alone, both, both where vertices are split by sides, and places alone.
    for (int kind = 0; kind < 5; ++kind) {
        SCOPED_TRACE(kind);
        DrawOptions options;
        options.separateVertices = true;
        bool const hasSides = kind != 0 && kind != 4;
        bool const hasValues = kind != 1 && kind != 4;
        options.sides = hasSides ? &sides : nullptr;
        options.splitVertices = kind == 3;
        options.generateBaseCoords = kind == 4;
        if (hasValues) {
            options.fvarChannels = {0};
        }
        PolygonIndices const polygons = OsdExt::CreatePolygonIndices(level, options);
        OsdExt::DrawnVertices const &drawn = polygons.drawnVertices;
        // The four vertices inside each of 12 edges are there twice, the corners three times.
        EXPECT_EQ(drawn.GetNumVertices(), level.GetNumVertices() + 12 * 4 + 8 * 2);
        std::vector<int> baseFaces(drawn.vertices.size(), -1);
        std::size_t corner = 0;
        for (int i = 0; i < polygons.GetNumPolygons(); ++i) {
            for (int k = 0; k < polygons.sizes[std::size_t(i)]; ++k, ++corner) {
                auto const vert = std::size_t(polygons.vertices[corner]);
                int const baseFace = polygons.baseFaces[std::size_t(i)];
                ASSERT_TRUE(baseFaces[vert] < 0 || baseFaces[vert] == baseFace);
                baseFaces[vert] = baseFace;
                if (hasValues) {
                    ASSERT_EQ(drawn.fvarValues[0][vert], polygons.fvarValues[0][corner]);
                }
                if (hasSides) {
                    ASSERT_EQ(drawn.sides[vert], polygons.sides[corner]);
                }
                if (kind == 4) {
                    ASSERT_EQ(drawn.baseFaces[vert], baseFace);
                    ASSERT_EQ(drawn.baseCoords[2 * vert], polygons.baseCoords[2 * corner]);
                    ASSERT_EQ(drawn.baseCoords[2 * vert + 1], polygons.baseCoords[2 * corner + 1]);
                }
            }
        }
    }
}

TEST(PolygonIndices, RefusesWhatDoesNotFit) {
    Shape const &shape = GetShape("cube");
    auto const refiner = refine(shape, 1);
    TopologyLevel const &level = refiner->GetLevel(1);
    auto const expectRefused = [&](DrawOptions const &options, std::string const &cause) {
        FarExt::CallStatus status;
        PolygonIndices const polygons = OsdExt::CreatePolygonIndices(level, options, &status);
        EXPECT_EQ(polygons.GetNumPolygons(), 0);
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetErrorMessage(), cause);
        EXPECT_EQ(OsdExt::CreateTriangleIndices(level, options, &status).GetNumTriangles(), 0);
        EXPECT_EQ(status.GetErrorMessage(), cause);
    };
    DrawOptions options;
    options.fvarChannels = {0};
    expectRefused(options, "there is no face-varying channel 0; the mesh has 0");
    options = DrawOptions();
    std::vector<int> const labels(5);
    options.labels = toArray(labels);
    expectRefused(options, "labels are one for each of the 6 base faces, but 5 were given");
    options = DrawOptions();
    options.splitVertices = true;
    expectRefused(options, "vertices are split by sides, and none are given");
    FarExt::LimitSides const sides(refiner->GetLevel(0));
    options.sides = &sides;
    expectRefused(options, "the sides are those of 8 vertices; the level has 32");
    // Sides of a level with as many vertices, whose edges are creases.
    Shape creased = shape;
    for (int corner = 0; corner < shape.GetNumCorners(); ++corner) {
        int const v = shape.faceVertices[std::size_t(corner)];
        int const w = shape.faceVertices[std::size_t(corner % 4 < 3 ? corner + 1 : corner - 3)];
        creased.creaseVertexPairs.insert(creased.creaseVertexPairs.end(), {v, w});
        creased.creaseSharpness.push_back(Sdc::Crease::SHARPNESS_INFINITE);
    }
    auto const creasedRefiner = refine(creased, 1);
    FarExt::LimitSides const smoothSides(level);
    FarExt::LimitSides const creasedSides(creasedRefiner->GetLevel(1));
    EXPECT_EQ(creasedSides.GetNumVertices(), smoothSides.GetNumVertices());
    options.sides = &creasedSides;
    expectRefused(options, "the sides are those of another level than level 1, whose creases split "
                           "vertices elsewhere");
    FarExt::CallStatus status;
    options.sides = &smoothSides;
    EXPECT_EQ(CreatePolygonIndices(creasedRefiner->GetLevel(1), options, &status).GetNumPolygons(),
              0);
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    // Another level has equal sides.
    auto const sameRefiner = refine(creased, 1);
    EXPECT_TRUE(creasedSides.IsOf(sameRefiner->GetLevel(1)));
    options.sides = &creasedSides;
    EXPECT_GT(CreatePolygonIndices(sameRefiner->GetLevel(1), options).GetNumPolygons(), 0);
    options = DrawOptions();
    options.vertexOffset = -1;
    expectRefused(options, "the vertex offset is -1, and vertices would be negative");
    options = DrawOptions();
    options.cutCreases = static_cast<CreaseCuts>(3);
    expectRefused(options, "there is no CreaseCuts 3");
    // The last index is the largest that there is, then one too many.
    options = DrawOptions();
    options.vertexOffset = std::numeric_limits<int>::max() - 31;
    EXPECT_GT(CreatePolygonIndices(level, options).GetNumPolygons(), 0);
    ++options.vertexOffset;
    EXPECT_EQ(CreatePolygonIndices(level, options, &status).GetNumPolygons(), 0);
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::TooLarge);
    EXPECT_NE(status.GetErrorMessage().find("2147483648"), std::string::npos)
        << status.GetErrorMessage();
    // Such a level knows of no edges, and so of no sides.
    ASSERT_TRUE(refiner->RefineUniform(1));
    FarExt::LimitSides const noSides(refiner->GetLevel(1));
    EXPECT_TRUE(sides.IsValid());
    EXPECT_FALSE(noSides.IsValid());
    EXPECT_EQ(noSides.GetNumVertices(), 0);
    EXPECT_EQ(noSides.GetNumSides(), 0);
    options = DrawOptions();
    options.sides = &noSides;
    expectRefused(options, "level 1 has no full topology, and so no sides: see "
                           "UniformOptions::fullTopologyInLastLevel");
}

TEST(TriangleIndices, PolygonsOfLessThanThreeMakeNone) {
    PolygonIndices polygons;
    polygons.sizes = {2, 3, 0, 1, 4};
    polygons.faces = {0, 1, 2, 3, 4};
    polygons.vertices = {8, 9, 1, 2, 3, 7, 4, 5, 6, 0};
    OsdExt::TriangleIndices const triangles = OsdExt::CreateTriangleIndices(polygons);
    EXPECT_EQ(triangles.GetNumTriangles(), 3);
    EXPECT_EQ(triangles.faces, (std::vector<int>{1, 4, 4}));
    EXPECT_EQ(triangles.vertices, (std::vector<int>{1, 2, 3, 4, 5, 0, 5, 6, 0}));
}

} // namespace OpenSubdivHex::Regression::polygonIndicesTest

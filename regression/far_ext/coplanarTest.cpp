// SPDX-License-Identifier: Apache-2.0
//
// RefineCoplanar: every shape against the reference, and what the header promises.
#include "expectations.h"

#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/flatShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace OpenSubdivHex::Regression::coplanarTest {

using FarExt::HexSchemeOptions;
using FarExt::SchemeType;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

using CoplanarOptions = TopologyRefiner::CoplanarOptions;
using Counts = std::array<int, 3>;

CoplanarOptions makeOptions(int level, double angleTolerance, bool closeGaps = true) {
    CoplanarOptions options(level);
    options.angleTolerance = angleTolerance;
    options.closeGaps = closeGaps;
    options.fullTopologyInLastLevel = true;
    return options;
}

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape, ReferenceMask mask,
                                               CoplanarOptions const &options,
                                               Sdc::Options sdcOptions = Sdc::Options()) {
    auto refiner = CreateRefiner(shape, mask, 0, sdcOptions);
    FarExt::CallStatus status;
    if (!refiner->RefineCoplanar(shape.positions.data(), options, &status)) {
        throw std::runtime_error(shape.name + ": " + status.GetErrorMessage());
    }
    return refiner;
}

Counts counts(TopologyLevel const &level) {
    return {level.GetNumVertices(), level.GetNumEdges(), level.GetNumFaces()};
}

bool isQuad(TopologyRefiner const &refiner, int level, int edge) {
    TopologyLevel const &pLevel = refiner.GetLevel(level);
    return !pLevel.IsEdgeBoundary(edge) &&
           refiner.GetLevel(level + 1).GetFaceVertices(pLevel.GetEdgeChildFace(edge)).size() == 4;
}

/// The edges that make quads are those that the reference finds, but for angles that are as large
/// as the tolerance up to rounding.
void expectFlatEdges(TopologyRefiner const &refiner, TaggedMatch const &match, ReferenceMask mask,
                     ReferenceValues positions, double angleTolerance) {
    for (int level = 0; level < match.GetMaxLevel(); ++level) {
        TaggedMesh const &mesh = match.GetMesh(level);
        auto const flat = FindFlatEdges(mesh, positions, angleTolerance * (1 - 1e-6));
        auto const nearlyFlat = FindFlatEdges(mesh, positions, angleTolerance * (1 + 1e-6));
        for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
            int const edge = match.GetLibraryEdge(level, mesh.edges[e]);
            if (edge >= 0 && flat[e] == nearlyFlat[e]) {
                ASSERT_EQ(isQuad(refiner, level, edge), flat[e])
                    << "level " << level << ", edge " << edge;
            }
        }
        positions = Interpolate(mesh, match.GetMesh(level + 1), mask, positions);
    }
}

void expectMeshEqual(Shape const &shape, ReferenceMask mask, Sdc::Options sdcOptions,
                     CoplanarOptions const &options) {
    auto const refiner = createRefiner(shape, mask, options, sdcOptions);
    TaggedMatch const match(shape, *refiner, -1, options.closeGaps);
    ASSERT_EQ(match.GetError(), "");
    ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
    ASSERT_NO_FATAL_FAILURE(ExpectNumbering(*refiner));
    ReferenceValues const positions = GetPositions(shape);
    if (shape.fvarChannels.empty()) {
        ASSERT_NO_FATAL_FAILURE(
            expectFlatEdges(*refiner, match, mask, positions, options.angleTolerance));
    }
    ASSERT_NO_FATAL_FAILURE(ExpectVertexValuesEqual(*refiner, match, mask, positions));
    ASSERT_NO_FATAL_FAILURE(ExpectVaryingValuesEqual(*refiner, match, positions));
}

void expectChannelsEqual(Shape const &shape, ReferenceMask mask, Sdc::Options sdcOptions,
                         CoplanarOptions const &options) {
    auto const refiner = createRefiner(shape, mask, options, sdcOptions);
    for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
        SCOPED_TRACE(testing::Message() << "channel " << channel);
        TaggedMatch const match(shape, *refiner, channel, options.closeGaps);
        ASSERT_EQ(match.GetError(), "");
        ASSERT_NO_FATAL_FAILURE(ExpectChannelValuesEqual(
            *refiner, match, mask, GetValues(shape.fvarChannels[channel]), channel));
    }
}

/// Calls check(options) for tolerances from none to all, closed and open.
template <typename CHECK>
void forEachOptions(int level, std::vector<double> const &tolerances, CHECK const &check) {
    for (double tolerance : tolerances) {
        for (bool closeGaps : {true, false}) {
            SCOPED_TRACE(testing::Message()
                         << "tolerance " << tolerance << (closeGaps ? ", closed" : ", open"));
            check(makeOptions(level, tolerance, closeGaps));
        }
    }
}

std::vector<int> faceVertices(TopologyLevel const &level, int face) {
    auto const vertices = level.GetFaceVertices(face);
    return std::vector<int>(vertices.begin(), vertices.end());
}

/// Every level has the same faces, V-faces up to where they begin.
void expectSameFaces(TopologyRefiner const &actual, TopologyRefiner const &expected) {
    ASSERT_EQ(actual.GetMaxLevel(), expected.GetMaxLevel());
    for (int level = 1; level <= actual.GetMaxLevel(); ++level) {
        TopologyLevel const &a = actual.GetLevel(level);
        TopologyLevel const &b = expected.GetLevel(level);
        ASSERT_EQ(counts(a), counts(b));
        for (int f = 0; f < a.GetNumFaces(); ++f) {
            ASSERT_EQ(a.GetFaceKind(f), b.GetFaceKind(f));
            std::vector<int> vertices = faceVertices(a, f);
            std::vector<int> const other = faceVertices(b, f);
            if (vertices != other && a.GetFaceKind(f) == FarExt::FaceKind::Vertex) {
                std::rotate(vertices.begin(), std::find(vertices.begin(), vertices.end(), other[0]),
                            vertices.end());
            }
            ASSERT_EQ(vertices, other) << "level " << level << ", face " << f;
        }
    }
}

} // namespace

TEST(Coplanar, ShapesEqualReference) {
    for (auto const *shapes : {&GetManifoldShapes(), &GetFlatShapes()}) {
        for (Shape const &shape : *shapes) {
            for (auto boundary : kBoundaries) {
                if (shape.closed && boundary != Sdc::Options::VTX_BOUNDARY_NONE) {
                    continue;
                }
                SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
                Sdc::Options sdcOptions;
                sdcOptions.SetVtxBoundaryInterpolation(boundary);
                int const level = GetTestLevel(shape, 3, 3000);
                forEachOptions(level, {0.1, 10, 60, 180}, [&](CoplanarOptions const &options) {
                    for (ReferenceMask mask : kMasks) {
                        SCOPED_TRACE(ToString(mask));
                        expectMeshEqual(shape, mask, sdcOptions, options);
                    }
                });
            }
        }
    }
}

TEST(Coplanar, FeatureShapesEqualReference) {
    for (Shape const &shape : GetFeatureShapes()) {
        for (auto boundary : kBoundaries) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            Sdc::Options sdcOptions;
            sdcOptions.SetVtxBoundaryInterpolation(boundary);
            sdcOptions.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
            int const level = GetTestLevel(shape, 3, 3000);
            forEachOptions(level, {10, 60}, [&](CoplanarOptions const &options) {
                expectMeshEqual(shape, ReferenceMask::Smooth, sdcOptions, options);
            });
        }
    }
}

TEST(Coplanar, FaceVaryingEqualsReference) {
    for (Shape const &shape : GetFeatureShapes()) {
        for (auto boundary : kBoundaries) {
            for (auto linear :
                 {Sdc::Options::FVAR_LINEAR_NONE, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1,
                  Sdc::Options::FVAR_LINEAR_ALL}) {
                SCOPED_TRACE(testing::Message()
                             << shape.name << ", boundary " << boundary << ", linear " << linear);
                Sdc::Options sdcOptions;
                sdcOptions.SetVtxBoundaryInterpolation(boundary);
                sdcOptions.SetFVarLinearInterpolation(linear);
                int const level = GetTestLevel(shape, 3, 3000);
                forEachOptions(level, {10, 60}, [&](CoplanarOptions const &options) {
                    expectChannelsEqual(shape, ReferenceMask::Cosine, sdcOptions, options);
                });
            }
        }
    }
}

TEST(Coplanar, BoxCounts) {
    Shape const box = MakeBox(2, 2, 2);
    auto const closed = createRefiner(box, ReferenceMask::Average, makeOptions(2, 0.1));
    EXPECT_EQ(counts(closed->GetLevel(0)), (Counts{26, 48, 24}));
    EXPECT_EQ(counts(closed->GetLevel(1)), (Counts{116, 216, 102}));
    EXPECT_EQ(counts(closed->GetLevel(2)), (Counts{524, 912, 390}));
    EXPECT_FALSE(closed->IsUniform());
    auto const open = createRefiner(box, ReferenceMask::Average, makeOptions(1, 0.1, false));
    EXPECT_EQ(open->GetLevel(1).GetNumBoundaryEdges(), 96);
    EXPECT_EQ(counts(open->GetLevel(1)), (Counts{116, 216, 72}));
}

TEST(Coplanar, FlatShapesStayWatertight) {
    for (Shape const &shape : GetFlatShapes()) {
        for (double tolerance : {0.1, 20.0, 100.0}) {
            SCOPED_TRACE(shape.name + ", tolerance " + std::to_string(tolerance));
            auto const refiner =
                createRefiner(shape, ReferenceMask::Average,
                              makeOptions(GetTestLevel(shape, 4, 30000), tolerance));
            for (int level = 1; level <= refiner->GetMaxLevel(); ++level) {
                TopologyLevel const &topology = refiner->GetLevel(level);
                auto const [numVertices, numEdges, numFaces] = counts(topology);
                EXPECT_EQ(topology.GetNumBoundaryEdges(), 0);
                EXPECT_EQ(numVertices - numEdges + numFaces, 2);
                for (int v = 0; v < numVertices; ++v) {
                    ASSERT_FALSE(topology.IsVertexNonManifold(v));
                }
            }
        }
    }
}

TEST(Coplanar, FlatSidesStayFlat) {
    // Faces of a box's side at distance 2 and more from its edges lie in the middle of flat faces:
    // none is a hexagon, and all their points stay in the plane.
    Shape const box = MakeBox(6, 6, 6);
    auto const refiner = createRefiner(box, ReferenceMask::Average, makeOptions(3, 0.1));
    std::vector<ReferenceValues> const levels = InterpolateLevels(*refiner, GetPositions(box));
    int numFaces = 0;
    for (int level = 1; level <= 3; ++level) {
        TopologyLevel const &topology = refiner->GetLevel(level);
        for (int f = 0; f < topology.GetNumFaces(); ++f) {
            bool isInside = true;
            for (int v : topology.GetFaceVertices(f)) {
                for (int axis : {0, 1}) {
                    isInside = isInside && std::abs(levels[level](v, axis) - 3) < 1;
                }
                isInside = isInside && levels[level](v, 2) < 3;
            }
            if (isInside) {
                ++numFaces;
                ASSERT_EQ(topology.GetFaceVertices(f).size(), 4) << "level " << level;
                for (int v : topology.GetFaceVertices(f)) {
                    ASSERT_EQ(levels[level](v, 2), 0);
                }
            }
        }
    }
    EXPECT_GT(numFaces, 50);
}

TEST(Coplanar, AllFlatIsDooSabin) {
    for (auto const *shapes : {&GetManifoldShapes(), &GetFlatShapes()}) {
        for (Shape shape : *shapes) {
            if (!shape.closed) {
                continue;
            }
            SCOPED_TRACE(shape.name);
            shape.fvarChannels.clear();
            // The quads of a dihedron have no area.
            bool const isDihedron = shape.name.rfind("dihedron", 0) == 0;
            int const level = isDihedron ? 1 : GetTestLevel(shape, 2, 10000);
            HexSchemeOptions schemeOptions;
            schemeOptions.schemeType = SchemeType::DooSabin;
            auto const dooSabin =
                CreateRefiner(shape, ReferenceMask::Cosine, level, Sdc::Options(), schemeOptions);
            auto const coplanar =
                createRefiner(shape, ReferenceMask::Cosine, makeOptions(level, 180));
            ASSERT_NO_FATAL_FAILURE(expectSameFaces(*coplanar, *dooSabin));
            EXPECT_EQ(FarExt::StencilTableFactory::Create(*coplanar)->GetWeights(),
                      FarExt::StencilTableFactory::Create(*dooSabin)->GetWeights());
        }
    }
}

TEST(Coplanar, NoFlatEdgeIsUniform) {
    for (char const *name : {"icosahedron", "truncatedIcosahedron", "genus2", "mixedPatch"}) {
        SCOPED_TRACE(name);
        Shape const &shape = GetShape(name);
        auto const uniform = CreateRefiner(shape, ReferenceMask::Smooth, 2);
        auto const coplanar = createRefiner(shape, ReferenceMask::Smooth, makeOptions(2, 0));
        ASSERT_NO_FATAL_FAILURE(expectSameFaces(*coplanar, *uniform));
        for (int level = 1; level <= 2; ++level) {
            TopologyLevel const &a = coplanar->GetLevel(level);
            TopologyLevel const &b = uniform->GetLevel(level);
            for (int f = 0; f < a.GetNumFaces(); ++f) {
                auto const edges = a.GetFaceEdges(f);
                ASSERT_TRUE(std::equal(edges.begin(), edges.end(), b.GetFaceEdges(f).begin()));
            }
        }
        EXPECT_EQ(FarExt::StencilTableFactory::Create(*coplanar)->GetWeights(),
                  FarExt::StencilTableFactory::Create(*uniform)->GetWeights());
    }
}

TEST(Coplanar, TheRestPoseFixesTheTopology) {
    Shape const &box = GetFlatShapes()[1];
    auto const refiner = createRefiner(box, ReferenceMask::Smooth, makeOptions(3, 0.1));
    TaggedMatch const match(box, *refiner);
    ASSERT_EQ(match.GetError(), "");
    ReferenceValues pose = GetPositions(box);
    for (Eigen::Index i = 0; i < pose.rows(); ++i) {
        pose.row(i) *= 1 + 0.3 * std::sin(double(i * i));
    }
    ExpectVertexValuesEqual(*refiner, match, ReferenceMask::Smooth, pose);
}

TEST(Coplanar, FloatAndDoublePositionsGiveTheSame) {
    for (Shape const &shape : GetFlatShapes()) {
        SCOPED_TRACE(shape.name);
        std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
        auto const expected = createRefiner(shape, ReferenceMask::Average, makeOptions(2, 0.1));
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0);
        ASSERT_TRUE(refiner->RefineCoplanar(positions.data(), makeOptions(2, 0.1)));
        ASSERT_NO_FATAL_FAILURE(expectSameFaces(*refiner, *expected));
    }
}

TEST(Coplanar, FacesWithoutAreaHaveNoNormal) {
    // Three quads in a row, the one in the middle with no width.
    Shape shape;
    shape.positions = {0, 0, 0, 1, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 1, 1, 0, 2, 1, 0};
    shape.faceSizes.assign(3, 4);
    shape.faceVertices = {0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6};
    auto const refiner = createRefiner(shape, ReferenceMask::Average, makeOptions(1, 180));
    for (int e = 0; e < refiner->GetLevel(0).GetNumEdges(); ++e) {
        EXPECT_FALSE(isQuad(*refiner, 0, e));
    }
    // With some width all is flat.
    for (int v : {2, 6}) {
        shape.positions[3 * v] = 1.5;
    }
    auto const wide = createRefiner(shape, ReferenceMask::Average, makeOptions(1, 0.1));
    int numQuads = 0;
    for (int e = 0; e < wide->GetLevel(0).GetNumEdges(); ++e) {
        numQuads += isQuad(*wide, 0, e);
    }
    EXPECT_EQ(numQuads, 2);
}

TEST(Coplanar, TheSizeOfTheMeshDoesNotMatter) {
    for (char const *name : {"cube", "icosahedron", "quadGrid", "mixedPatch"}) {
        for (double tolerance : {5.0, 50.0, 80.0, 100.0}) {
            SCOPED_TRACE(testing::Message() << name << ", " << tolerance);
            Shape const &shape = GetShape(name);
            CoplanarOptions const options = makeOptions(2, tolerance);
            auto const expected = createRefiner(shape, ReferenceMask::Average, options);
            // Areas are still doubles, their squares are not.
            for (int exponent : {-400, 400}) {
                Shape scaled = shape;
                for (double &position : scaled.positions) {
                    position = std::ldexp(position, exponent);
                }
                auto const refiner = createRefiner(scaled, ReferenceMask::Average, options);
                EXPECT_EQ(counts(refiner->GetLevel(2)), counts(expected->GetLevel(2))) << exponent;
            }
        }
    }
}

TEST(Coplanar, RefinesAgain) {
    Shape const &box = GetFlatShapes()[1];
    auto const refiner = createRefiner(box, ReferenceMask::Average, makeOptions(3, 0.1));
    TopologyRefiner::UniformOptions uniformOptions(2);
    uniformOptions.fullTopologyInLastLevel = true;
    ASSERT_TRUE(refiner->RefineUniform(uniformOptions));
    EXPECT_TRUE(refiner->IsUniform());
    auto const uniform = CreateRefiner(box, ReferenceMask::Average, 2);
    ASSERT_NO_FATAL_FAILURE(expectSameFaces(*refiner, *uniform));
    ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
    // The gaps of an open refinement are gone.
    ASSERT_TRUE(refiner->RefineCoplanar(box.positions.data(), makeOptions(2, 0.1, false)));
    ASSERT_TRUE(refiner->RefineUniform(uniformOptions));
    for (int v = 0; v < refiner->GetLevel(1).GetNumVertices(); ++v) {
        ASSERT_FALSE(refiner->GetLevel(1).IsVertexNonManifold(v));
    }
    ASSERT_TRUE(refiner->RefineCoplanar(box.positions.data(), makeOptions(2, 100)));
    auto const coplanar = createRefiner(box, ReferenceMask::Average, makeOptions(2, 100));
    ASSERT_NO_FATAL_FAILURE(expectSameFaces(*refiner, *coplanar));
    ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
}

TEST(Coplanar, LastLevelNeedsFaceVerticesOnly) {
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    for (Shape const *shape : {&GetFlatShapes()[2], &GetShape("mixedPatch")}) {
        for (bool closeGaps : {true, false}) {
            SCOPED_TRACE(shape->name + (closeGaps ? ", closed" : ", open"));
            CoplanarOptions options = makeOptions(2, 10, closeGaps);
            auto const full = createRefiner(*shape, ReferenceMask::Cosine, options, sdcOptions);
            options.fullTopologyInLastLevel = false;
            auto const refiner = createRefiner(*shape, ReferenceMask::Cosine, options, sdcOptions);
            EXPECT_FALSE(refiner->GetLevel(2).HasFullTopology());
            FarExt::internal::Level const &faces = refiner->GetLevel(2).GetLevel();
            FarExt::internal::Level const &all = full->GetLevel(2).GetLevel();
            EXPECT_EQ(faces.numFreeBoundaries, all.numFreeBoundaries);
            EXPECT_EQ(faces.numSharpBoundariesA, all.numSharpBoundariesA);
            EXPECT_EQ(faces.numSharpBoundariesB, all.numSharpBoundariesB);
            ASSERT_NO_FATAL_FAILURE(expectSameFaces(*refiner, *full));
            ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
            ASSERT_NO_FATAL_FAILURE(ExpectNumbering(*refiner));
            EXPECT_EQ(FarExt::StencilTableFactory::Create(*refiner)->GetWeights(),
                      FarExt::StencilTableFactory::Create(*full)->GetWeights());
        }
    }
}

// A V-face of the value mesh may begin with another F-vertex than that of the mesh.
TEST(Coplanar, EveryFaceHasItsValues) {
    Shape shape;
    shape.name = "facesThatShareNoValue";
    shape.positions = {-1.859375, 1.140625,  0.78125,  1.09375,  1.40625,  1.234375, -1.53125,
                       -1.0625,   0.71875,   0.375,    -0.78125, -0.53125, -1.09375, -1.140625,
                       -1.859375, 0.390625,  0.0625,   1.578125, -1.03125, 0.890625, 1.65625,
                       -1.234375, -0.796875, -1.96875, -0.71875, 0.375,    1.296875};
    shape.faceSizes = {3, 3, 3, 4, 3, 3, 3, 3};
    shape.faceVertices = {0, 1, 5, 1, 2, 6, 2, 3, 7, 3, 0, 4, 7,
                          3, 2, 0, 4, 5, 6, 2, 4, 6, 2, 3, 8};
    FVarChannel channel;
    channel.values.assign(2 * shape.faceVertices.size(), 0.0);
    for (int corner = 0; corner < shape.GetNumCorners(); ++corner) {
        channel.valueIndices.push_back(corner);
    }
    shape.fvarChannels.push_back(channel);
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    CoplanarOptions options = makeOptions(6, 50, true);
    auto const refiner = createRefiner(shape, ReferenceMask::Average, options, sdcOptions);
    ASSERT_TRUE(refiner);
    for (FarExt::internal::FVarLevel const &level : refiner->GetHierarchy().channels[0].levels) {
        for (Far::Index valueFace : level.valueFaces) {
            ASSERT_GE(valueFace, 0);
            ASSERT_LT(valueFace, level.values->numFaces);
        }
    }
}

} // namespace OpenSubdivHex::Regression::coplanarTest

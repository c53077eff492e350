// SPDX-License-Identifier: Apache-2.0
//
// Bounds kept from view to view, against views that find all anew.
#include "surfaceFixture.h"

#include "bfr_ext/patchStream.h"
#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/view.h"
#include "bfr_ext/viewBounds.h"
#include "far_ext/executor.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <random>

namespace OpenSubdivHex::Regression::viewBoundsTest {

using BfrExt::Camera;
using BfrExt::CellForest;
using BfrExt::CellTree;
using BfrExt::Polyline;
using BfrExt::SurfaceFactory;
using BfrExt::View;
using BfrExt::ViewBounds;

namespace {

/// A mesh whose points are moved, and cameras around it.
struct Scene {
    explicit Scene(Shape const &shape)
        : refiner(MakeRefiner(shape)), factory(SurfaceFactory::Create(*refiner)),
          positions(shape.positions) {}

    static std::unique_ptr<FarExt::TopologyRefiner> MakeRefiner(Shape const &shape) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
        return CreateRefiner(shape, ReferenceMask::Smooth, 0, options);
    }

    Camera MakeCamera() {
        std::uniform_real_distribution<double> uniform(-1, 1);
        Camera camera;
        for (std::size_t k = 0; k < 3; ++k) {
            camera.eye[k] = (k == 2 ? 4 : 0) + uniform(random);
            camera.target[k] = uniform(random);
        }
        camera.width = 320;
        camera.height = 200;
        return camera;
    }

    void Move(std::size_t vertex) { positions[3 * vertex] += 0.1; }

    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<SurfaceFactory> factory;
    std::vector<double> positions;
    std::mt19937 random{7};
};

void expectSame(CellForest const &forest, CellForest const &other) {
    ASSERT_EQ(forest.GetNumFaces(), other.GetNumFaces());
    ASSERT_EQ(forest.GetNumBoundaryPoints(), other.GetNumBoundaryPoints());
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        CellTree const &tree = forest.GetTree(face);
        CellTree const &otherTree = other.GetTree(face);
        ASSERT_EQ(tree.GetNumCells(), otherTree.GetNumCells()) << "face " << face;
        for (int cell = 0; cell < tree.GetNumCells(); ++cell) {
            ASSERT_EQ(tree.GetFirstChild(cell), otherTree.GetFirstChild(cell)) << "face " << face;
        }
        std::vector<Polyline> const edges = forest.GetFacePolylines(face);
        std::vector<Polyline> const otherEdges = other.GetFacePolylines(face);
        for (std::size_t i = 0; i < edges.size(); ++i) {
            ASSERT_TRUE(edges[i].Contains(otherEdges[i]) && otherEdges[i].Contains(edges[i]));
        }
    }
}

std::vector<Shape> getShapes() {
    std::vector<Shape> shapes = {GetShape("icosahedron"), MakePrism(7), GetShape("torus")};
    for (char const *const name : {"mixedSharpnessQuads", "creasedBall"}) {
        shapes.push_back(GetFeatureShape(name));
    }
    return shapes;
}

} // namespace

// Whatever was asked of them before, by whatever views, and whatever they had room for.
TEST(ViewBounds, ForestsAreThoseMadeWithoutThem) {
    constexpr int kNumViews = 8;
    constexpr std::size_t kAmple = std::size_t(1) << 28;
    for (Shape const &shape : getShapes()) {
        SCOPED_TRACE(shape.name);
        for (std::size_t const maxMemory : {std::size_t(0), std::size_t(20000), kAmple}) {
            Scene scene(shape);
            ViewBounds bounds(*scene.factory, ViewBounds::Options().SetMaxMemory(maxMemory));
            CellForest previous(*scene.refiner);
            for (int i = 0; i < kNumViews; ++i) {
                if (i % 4 == 3) {
                    scene.Move(std::size_t(i) % (scene.positions.size() / 3));
                }
                View const view(scene.MakeCamera(), View::Options()
                                                        .SetFlatness(i % 3 == 2 ? 0 : 2.0 / (1 + i))
                                                        .SetEdgeLength(i % 3 == 0 ? 0 : 20)
                                                        .SetCulling(i % 2 == 1)
                                                        .SetMaxLevel(3));
                View::Counts counts;
                View::Counts expectedCounts;
                CellForest const expected = view.MakeForest(*scene.factory, scene.positions.data(),
                                                            3, &previous, &expectedCounts);
                FarExt::ExecutorScope const threads(nullptr, 1 + i % 2);
                CellForest const forest =
                    view.MakeForest(bounds, scene.positions.data(), 3, &previous, &counts);
                ASSERT_NO_FATAL_FAILURE(expectSame(forest, expected)) << "view " << i;
                EXPECT_EQ(counts.cellsByLevel, expectedCounts.cellsByLevel);
                EXPECT_EQ(counts.outside, expectedCounts.outside);
                EXPECT_EQ(counts.backFacing, expectedCounts.backFacing);
                EXPECT_LE(bounds.GetMemory(), maxMemory);
                previous = forest;
            }
            EXPECT_TRUE(bounds.GetMemory() > 0 || maxMemory < kAmple);
            bounds.Clear();
            EXPECT_EQ(bounds.GetMemory(), std::size_t(0));
        }
    }
}

// Streams of one forest after the other hand out, to the bit, what the surfaces of faces give.
TEST(ViewBounds, StreamsOfForestsAreThoseMadeWithoutThem) {
    struct Patches {
        std::map<int, std::vector<double>> points;
        std::map<int, std::vector<int>> facets;
    };
    for (Shape const &shape : getShapes()) {
        SCOPED_TRACE(shape.name);
        Scene scene(shape);
        // To the bit what the surface of a face gives, whichever faces were before.
        auto const evaluate = [&](int face, BfrExt::LevelTessellation const &tessellation) {
            BfrExt::Surface<double> surface;
            scene.factory->InitVertexSurface(face, &surface);
            std::vector<double> control(3 * std::size_t(surface.GetNumControlPoints()));
            surface.GatherControlPoints(scene.positions.data(), 3, control.data(), 3);
            std::vector<double> points(3 * std::size_t(tessellation.GetNumCoords()));
            surface.Evaluate(tessellation, control.data(), 3, points.data(), 3);
            return points;
        };
        auto const stream = [&](CellForest const &forest, int facetSize) {
            Patches patches;
            BfrExt::PatchStream<double>::Options options;
            options.SetTessellationOptions(
                BfrExt::LevelTessellation::Options().SetFacetSize(facetSize));
            FarExt::ExecutorScope const oneThread(nullptr, 1);
            BfrExt::PatchStream<double>(*scene.factory, forest, options)
                .Run(scene.positions.data(), 3, [&](auto const &patch) {
                    int const numCoords = patch.tessellation.GetNumCoords();
                    EXPECT_EQ(evaluate(patch.face, patch.tessellation),
                              std::vector<double>(patch.points, patch.points + 3 * numCoords));
                    patches.points[patch.face].assign(patch.points, patch.points + 3 * numCoords);
                    std::vector<int> &facets = patches.facets[patch.face];
                    facets.resize(std::size_t(patch.tessellation.GetNumFacetVertices()));
                    patch.tessellation.GetFacetSizes(facets.data());
                    facets.resize(std::size_t(patch.tessellation.GetNumFacetVertices() +
                                              patch.tessellation.GetNumFacets()));
                    patch.tessellation.GetFacets(facets.data() + patch.tessellation.GetNumFacets());
                    return true;
                });
            return patches;
        };
        ViewBounds bounds(*scene.factory);
        for (int i = 0; i < 6; ++i) {
            View const view(scene.MakeCamera(),
                            View::Options().SetFlatness(std::pow(6.0, i % 3)).SetMaxLevel(4));
            CellForest const expected = view.MakeForest(*scene.factory, scene.positions.data(), 3);
            CellForest const forest = view.MakeForest(bounds, scene.positions.data(), 3);
            int const facetSize = i % 2 == 0 ? 0 : 3;
            Patches const patches = stream(forest, facetSize);
            Patches const expectedPatches = stream(expected, facetSize);
            ASSERT_FALSE(patches.points.empty());
            EXPECT_EQ(patches.points, expectedPatches.points) << "view " << i;
            EXPECT_EQ(patches.facets, expectedPatches.facets) << "view " << i;
        }
    }
}

// Frame by frame, the patches of the faces that change make the picture that a whole stream makes.
TEST(ViewBounds, FacesThatChangeMakeTheNextPicture) {
    using Stream = BfrExt::PatchStream<double>;
    using Picture = std::map<int, std::pair<std::vector<double>, std::vector<int>>>;
    std::size_t numKept = 0;
    for (Shape const &shape : getShapes()) {
        SCOPED_TRACE(shape.name);
        Scene scene(shape);
        std::mutex mutex;
        auto const makeSink = [&](Picture &picture) {
            return [&](Stream::Patch const &patch) {
                std::lock_guard<std::mutex> const lock(mutex);
                auto &[points, facets] = picture[patch.face];
                points.assign(patch.points, patch.points + 3 * patch.tessellation.GetNumCoords());
                facets.resize(std::size_t(patch.tessellation.GetNumFacets() *
                                          patch.tessellation.GetFacetSize()));
                patch.tessellation.GetFacets(facets.data());
                return true;
            };
        };
        ViewBounds bounds(*scene.factory);
        CellForest last(*scene.refiner);
        last.MatchEdges();
        Picture picture;
        ASSERT_TRUE(Stream(*scene.factory, last).Run(scene.positions.data(), 3, makeSink(picture)));
        Camera camera;
        for (int i = 0; i < 6; ++i) {
            if (i % 2 == 0) { // every other camera stays where it is
                camera = scene.MakeCamera();
            }
            View const view(camera, View::Options().SetFlatness(6).SetMaxLevel(4));
            CellForest const forest = view.MakeForest(bounds, scene.positions.data(), 3);
            Stream const stream(*scene.factory, forest);
            std::vector<int> const changed = forest.FindChangedFaces(last);
            EXPECT_TRUE(i % 2 == 0 || changed.empty()) << "view " << i;
            EXPECT_TRUE(std::is_sorted(changed.begin(), changed.end()));
            numKept += std::size_t(forest.GetNumFaces()) - changed.size();
            ASSERT_TRUE(stream.Run(scene.positions.data(), 3, {}, changed, makeSink(picture)));
            Picture whole;
            ASSERT_TRUE(stream.Run(scene.positions.data(), 3, makeSink(whole)));
            EXPECT_EQ(picture, whole) << "view " << i;
            last = forest;
        }
    }
    EXPECT_GT(numKept, std::size_t(0));
}

// A neighbour changes with the edge that they share; other meshes share nothing.
TEST(ViewBounds, ANeighbourOfARefinedFaceChanges) {
    Scene const scene(GetShape("torus"));
    CellForest const coarse(*scene.refiner);
    CellForest refined = coarse;
    CellTree tree(scene.factory->GetFaces().GetShape(3));
    tree.Refine(tree.Refine(0) + 1); // the half cell at edge 0
    refined.SetTree(3, tree);
    refined.MatchEdges();
    FarExt::SurfaceFaces const faces = scene.factory->GetFaces();
    std::vector<int> expected = {3};
    FarExt::SurfaceFaces::Edge const edge = faces.GetEdge(3, 0);
    expected.push_back(faces.GetSide(edge.edge, edge.isReversed ? 0 : 1).face);
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(refined.FindChangedFaces(coarse), expected);
    EXPECT_EQ(coarse.FindChangedFaces(refined), expected);
    Scene const other(GetShape("cube"));
    EXPECT_EQ(int(refined.FindChangedFaces(CellForest(*other.refiner)).size()),
              refined.GetNumFaces());
}

// If one vertex of a mesh moves, faces elsewhere need nothing new.
TEST(ViewBounds, WhatDidNotMoveIsKept) {
    Scene scene(GetShape("torus"));
    ViewBounds bounds(*scene.factory);
    Camera const camera = scene.MakeCamera();
    View const fine(camera, View::Options().SetFlatness(0.5));
    View const coarse(camera, View::Options().SetMaxLevel(0)); // asks for nothing
    fine.MakeForest(bounds, scene.positions.data(), 3);
    std::size_t const all = bounds.GetMemory();
    fine.MakeForest(bounds, scene.positions.data(), 3);
    EXPECT_EQ(bounds.GetMemory(), all);
    scene.Move(0);
    coarse.MakeForest(bounds, scene.positions.data(), 3);
    std::size_t const kept = bounds.GetMemory();
    EXPECT_LT(kept, all);
    EXPECT_GT(kept, all / 4);
    fine.MakeForest(bounds, scene.positions.data(), 3);
    EXPECT_GT(bounds.GetMemory(), kept);
    std::vector<float> const rounded(scene.positions.begin(), scene.positions.end());
    coarse.MakeForest(bounds, rounded.data(), 3);
    EXPECT_LT(bounds.GetMemory(), kept);
}

} // namespace OpenSubdivHex::Regression::viewBoundsTest

// SPDX-License-Identifier: Apache-2.0
//
// Streams of patches, against surfaces evaluated one by one.
#include "cellFixture.h"
#include "streamFixture.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include "bfr_ext/view.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/flatShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <numeric>
#include <stdexcept>

namespace OpenSubdivHex::Regression::patchStreamTest {

using BfrExt::LevelTessellation;
using BfrExt::PatchLevels;
using BfrExt::PatchStream;
using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using FarExt::StatusCode;

namespace {

/// The output of a stream, by face and section.
template <typename REAL>
class Collection {
public:
    typename PatchStream<REAL>::Sink GetSink() {
        return [this](typename PatchStream<REAL>::Patch const &patch) {
            std::size_t const count =
                std::size_t(patch.tessellation.GetNumCoords()) * std::size_t(patch.pointSize);
            std::lock_guard<std::mutex> const lock(_mutex);
            EXPECT_TRUE(patches
                            .emplace(std::make_pair(patch.face, patch.tessellation.GetSection()),
                                     std::vector<REAL>(patch.points, patch.points + count))
                            .second)
                << "face " << patch.face << " comes twice";
            return true;
        };
    }

    std::map<std::pair<int, int>, std::vector<REAL>> patches;

private:
    std::mutex _mutex;
};

Sdc::Options getEdgeOnly() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return options;
}

template <typename REAL>
void expectSurfaces(Shape const &shape, ReferenceMask mask, int numLevels, double tolerance) {
    SCOPED_TRACE(shape.name);
    auto const refiner = CreateRefiner(shape, mask, 0, getEdgeOnly());
    auto const factory = SurfaceFactory::Create(*refiner);
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);
    std::vector<REAL> const positions(shape.positions.begin(), shape.positions.end());
    RandomPatchLevels const levels(base, numLevels, 5);
    PatchStream<REAL> const stream(*factory, levels.Get());
    Collection<REAL> collection;
    ASSERT_TRUE(stream.Run(positions.data(), 3, collection.GetSink()));
    std::size_t numPatches = 0;
    for (int face = 0; face < base.GetNumFaces(); ++face) {
        ASSERT_EQ(collection.patches.count({face, 0}), base.IsFaceHole(face) ? 0 : 1)
            << "face " << face;
        for (int section = 0; !base.IsFaceHole(face) && section < stream.GetNumSections(face);
             ++section) {
            std::vector<REAL> const &found = collection.patches.at({face, section});
            ++numPatches;
            Surface<REAL> surface;
            ASSERT_TRUE(factory->InitVertexSurface(face, &surface));
            std::vector<REAL> control(3 * std::size_t(surface.GetNumControlPoints()));
            surface.GatherControlPoints(positions.data(), 3, control.data(), 3);
            LevelTessellation const tessellation = stream.MakeTessellation(face, section);
            std::vector<REAL> points(3 * std::size_t(tessellation.GetNumCoords()));
            surface.Evaluate(tessellation, control.data(), 3, points.data(), 3);
            ASSERT_EQ(found.size(), points.size());
            auto const numBoundary = 3 * std::size_t(tessellation.GetNumBoundaryCoords());
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (i < numBoundary) {
                    ASSERT_EQ(found[i], points[i]) << "face " << face << ", number " << i;
                } else {
                    ASSERT_NEAR(found[i], points[i], tolerance)
                        << "face " << face << ", number " << i;
                }
            }
        }
    }
    EXPECT_EQ(numPatches, collection.patches.size());
}

/// Irregular triangles or their dual, with creases, holes, and a channel with seams: more rings than a thread remembers.
Shape makeLargeShape(bool isDual) {
    Shape shape = MakeTorus(36, 24, TorusFaces::IrregularTriangles);
    if (isDual) {
        shape = MakeDual("dual", shape);
    }
    std::vector<int> seams;
    int firstCorner = 0;
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        int const verts[2] = {shape.faceVertices[std::size_t(firstCorner)],
                              shape.faceVertices[std::size_t(firstCorner) + 1]};
        firstCorner += shape.faceSizes[std::size_t(face)];
        if (face % 90 < 4) {
            shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), verts, verts + 2);
            shape.creaseSharpness.push_back(face % 90 == 0 ? 1.5F : 10.0F);
        } else if (face % 90 < 8) {
            seams.insert(seams.end(), verts, verts + 2);
        } else if (face % 90 == 50) {
            shape.holeFaces.push_back(face);
        }
    }
    shape.fvarChannels = {MakeSeamChannel(shape, seams)};
    return shape;
}

/// Expects that patches of any levels have the bits of surfaces that are evaluated one by one, in any order on any number
/// of threads.
///
/// \param size  numbers of a point
template <typename REAL>
void expectBitsOfSurfaces(Shape const &shape, SurfaceCase const &surfaceCase, int size) {
    auto const refiner = CreateSurfaceRefiner(shape, surfaceCase, 0, getEdgeOnly());
    auto const factory = SurfaceFactory::Create(*refiner);
    FarExt::TopologyLevel const &base =
        refiner->GetLevel(refiner->GetHexSchemeOptions().GetSurfaceLevel());
    std::mt19937 random(5);
    auto const makeNumbers = [&](int count) {
        std::vector<REAL> numbers(static_cast<std::size_t>(size * count));
        std::generate(numbers.begin(), numbers.end(), [&] { return REAL(random() % 1000) / 7; });
        return numbers;
    };
    std::vector<REAL> const meshPoints = makeNumbers(base.GetNumVertices());
    std::vector<REAL> const others = makeNumbers(base.GetNumVertices());
    std::vector<REAL> const channel = makeNumbers(base.GetNumFVarValues(0));
    using Stream = PatchStream<REAL>;
    std::vector<typename Stream::Values> const values = {{others.data(), size},
                                                         {channel.data(), size, 0}};
    RandomPatchLevels const levels(base, 3, 5);
    Stream const stream(*factory, levels.Get(), typename Stream::Options().SetDerivatives(true));
    std::vector<int> faces(std::size_t(factory->GetNumFaces()));
    std::iota(faces.begin(), faces.end(), 0);
    std::mutex mutex;
    auto const expectEqual = [&](Surface<REAL> const &surface, std::vector<REAL> const &from,
                                 LevelTessellation const &tessellation,
                                 std::array<REAL const *, 3> const &found) {
        std::vector<REAL> control(std::size_t(size * surface.GetNumControlPoints()));
        surface.GatherControlPoints(from.data(), size, control.data(), size);
        std::vector<REAL> expected[3];
        for (std::vector<REAL> &numbers : expected) {
            numbers.resize(std::size_t(size * tessellation.GetNumCoords()));
        }
        surface.Evaluate(tessellation, control.data(), size, expected[0].data(), expected[1].data(),
                         expected[2].data(), size);
        std::lock_guard<std::mutex> const lock(mutex);
        for (std::size_t i = 0; i < 3 && found[i]; ++i) {
            EXPECT_TRUE(std::equal(expected[i].begin(), expected[i].end(), found[i]))
                << "kind " << i;
        }
    };
    for (int const numThreads : {1, 3}) {
        ThreadsScope const threads(numThreads);
        std::atomic<int> numPatches(0);
        ASSERT_TRUE(stream.Run(meshPoints.data(), size, values, faces,
                               [&](typename Stream::Patch const &patch) {
                                   ++numPatches;
                                   Surface<REAL> surface;
                                   factory->InitVertexSurface(patch.face, &surface);
                                   expectEqual(surface, meshPoints, patch.tessellation,
                                               {patch.points, patch.du, patch.dv});
                                   factory->InitVaryingSurface(patch.face, &surface);
                                   expectEqual(surface, others, patch.tessellation,
                                               {patch.values[0], nullptr, nullptr});
                                   factory->InitFaceVaryingSurface(patch.face, &surface);
                                   expectEqual(surface, channel, patch.tessellation,
                                               {patch.values[1], nullptr, nullptr});
                                   return !testing::Test::HasFailure();
                               }));
        EXPECT_GT(numPatches, 800);
        std::shuffle(faces.begin(), faces.end(), random);
    }
}

} // namespace

TEST(PatchStreamTest, SharesRingsWithoutLossOfBits) {
    expectBitsOfSurfaces<float>(makeLargeShape(false), kPlainCases[2], 3);
    expectBitsOfSurfaces<float>(makeLargeShape(true), kPlainCases[0], 5);
}

TEST(PatchStreamTest, SharesRingsOfFurtherCasesWithoutLossOfBits) {
    expectBitsOfSurfaces<double>(makeLargeShape(false), kPlainCases[0], 7);
    expectBitsOfSurfaces<double>(makeLargeShape(true), kPlainCases[2], 3);
    expectBitsOfSurfaces<float>(makeLargeShape(false), kTruncateCases[2], 3);
}

// More vertices than a thread remembers.
TEST(PatchStreamTest, HandsOutVerticesOfManyFaces) {
    ThreadsScope const threads(1);
    expectSurfaces<float>(MakeTorus(72, 72, TorusFaces::IrregularTriangles), ReferenceMask::Smooth,
                          1, 0);
}

TEST(PatchStreamTest, HandsOutWhatSurfacesAre) {
    for (char const *const name :
         {"mixedSharpnessQuads", "cornersTriangles", "creaseLoopClosed", "creasedBall"}) {
        expectSurfaces<double>(GetFeatureShape(name), ReferenceMask::Cosine, 6, 1e-12);
    }
    for (Shape const &shape : GetManifoldShapes()) {
        // Faces with vertices alone.
        expectSurfaces<float>(shape, ReferenceMask::Smooth, 1, 0);
        expectSurfaces<double>(shape, ReferenceMask::Average, 1, 0);
        if (shape.GetNumFaces() <= 30) {
            expectSurfaces<double>(shape, ReferenceMask::Smooth, 5, 1e-12);
            expectSurfaces<float>(shape, ReferenceMask::Average, 4, 1e-5);
        }
    }
    expectSurfaces<double>(GetShape("cube"), ReferenceMask::Smooth, 9, 1e-12);
}

TEST(PatchStreamTest, PatchesDoNotDependOnThreadsMemoryAndShares) {
    Shape const &shape = GetFeatureShape("mixedSharpnessQuads");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getEdgeOnly());
    RandomPatchLevels const levels(refiner->GetLevel(0), 7, 3);
    std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
    std::map<std::pair<int, int>, std::vector<float>> expected;
    for (int const numThreads : {1, 2, 3}) {
        ThreadsScope const threads(numThreads);
        for (std::size_t const memory :
             {std::size_t(0), std::size_t(1) << 16, std::size_t(1) << 28}) {
            for (int const numShares : {1, 4}) {
                // The types take some megabytes.
                BfrExt::SurfaceFactoryCache cache(memory == 0 ? 1 << 18 : 1 << 30);
                auto const factory = SurfaceFactory::Create(
                    *refiner, SurfaceFactory::Options().SetExternalCache(&cache));
                PatchStream<float>::Options options;
                options.SetMaxMemory(memory);
                PatchStream<float> const stream(*factory, levels.Get(), options);
                Collection<float> collection;
                int const numFaces = factory->GetNumFaces();
                for (int share = numShares - 1; share >= 0; --share) {
                    ASSERT_TRUE(stream.Run(positions.data(), 3, numFaces * share / numShares,
                                           numFaces * (share + 1) / numShares,
                                           collection.GetSink()));
                }
                std::vector<int> faces(static_cast<std::size_t>(numFaces));
                std::iota(faces.rbegin(), faces.rend(), 0);
                Collection<float> listed;
                ASSERT_TRUE(stream.Run(positions.data(), 3, {}, faces, listed.GetSink()));
                if (expected.empty()) {
                    expected = collection.patches;
                }
                ASSERT_EQ(listed.patches, expected) << numThreads << " threads, " << memory;
                ASSERT_EQ(collection.patches, expected)
                    << numThreads << " threads, " << memory << " bytes, " << numShares << " shares";
            }
        }
    }
    EXPECT_EQ(int(expected.size()), shape.GetNumFaces());
}

// Cells of trees, with derivatives, varying values and two channels' values, on any number of threads.
TEST(PatchStreamTest, HandsOutCellsOfTreesAndFurtherValues) {
    for (char const *const name : {"seamAcrossCrease", "seamsCross", "mixedSharpnessQuads"}) {
        SCOPED_TRACE(name);
        Shape const &shape = GetFeatureShape(name);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getEdgeOnly());
        auto const factory = SurfaceFactory::Create(*refiner);
        BfrExt::CellForest const forest = MakeRandomForest(*refiner, 17);
        FarExt::TopologyLevel const &base = refiner->GetLevel(0);
        using Stream = PatchStream<double>;
        Stream const stream(*factory, forest, Stream::Options().SetDerivatives(true));
        std::mt19937 random(7);
        auto const makeNumbers = [&](int count) {
            std::vector<double> numbers(std::size_t(count), 0.0);
            std::generate(numbers.begin(), numbers.end(), [&] { return double(random() % 1000); });
            return numbers;
        };
        std::vector<double> const varying = makeNumbers(4 * base.GetNumVertices());
        std::vector<Stream::Values> values = {
            {varying.data(), {2, 4}}, {varying.data() + 1, {1, 4}, Stream::Values::kVarying}};
        std::vector<double> channel;
        if (refiner->GetNumFVarChannels() > 0) {
            channel = makeNumbers(2 * base.GetNumFVarValues());
            values.push_back({channel.data(), 2, 0});
        }
        ASSERT_EQ(channel.empty(), std::string(name) == "mixedSharpnessQuads");
        for (int const numThreads : {1, 3}) {
            ThreadsScope const threads(numThreads);
            std::mutex mutex;
            int numPatches = 0;
            auto const expectEqual = [&](Surface<double> const &surface, double const *from,
                                         Surface<double>::PointDescriptor const &desc,
                                         LevelTessellation const &tessellation,
                                         std::array<double const *, 3> const &results) {
                auto const size = std::size_t(desc.size);
                std::vector<double> control(size * std::size_t(surface.GetNumControlPoints()));
                surface.GatherControlPoints(from, desc, control.data(), desc.size);
                std::vector<double> expected[3];
                for (std::vector<double> &numbers : expected) {
                    numbers.resize(size * std::size_t(tessellation.GetNumCoords()));
                }
                surface.Evaluate(tessellation, control.data(), desc.size, expected[0].data(),
                                 expected[1].data(), expected[2].data(), desc.size);
                for (std::size_t i = 0; i < 3 && results[i]; ++i) {
                    ASSERT_EQ(expected[i],
                              std::vector<double>(results[i], results[i] + expected[i].size()))
                        << "kind " << i;
                }
            };
            FarExt::CallStatus status;
            bool const isDone = stream.Run(
                shape.positions.data(), 3, values, 0, base.GetNumFaces(),
                [&](Stream::Patch const &patch) {
                    std::lock_guard<std::mutex> const lock(mutex);
                    ++numPatches;
                    LevelTessellation const tessellation = forest.GetTessellation(patch.face);
                    EXPECT_EQ(patch.tessellation.GetNumFacets(), tessellation.GetNumFacets());
                    EXPECT_EQ(patch.tessellation.GetNumCoords(), tessellation.GetNumCoords());
                    Surface<double> surface;
                    factory->InitVertexSurface(patch.face, &surface);
                    expectEqual(surface, shape.positions.data(), 3, tessellation,
                                {patch.points, patch.du, patch.dv});
                    factory->InitVaryingSurface(patch.face, &surface);
                    expectEqual(surface, varying.data(), {2, 4}, tessellation,
                                {patch.values[0], nullptr, nullptr});
                    expectEqual(surface, varying.data() + 1, {1, 4}, tessellation,
                                {patch.values[1], nullptr, nullptr});
                    if (!channel.empty()) {
                        factory->InitFaceVaryingSurface(patch.face, &surface);
                        expectEqual(surface, channel.data(), 2, tessellation,
                                    {patch.values[2], nullptr, nullptr});
                    }
                    return true;
                },
                &status);
            ASSERT_TRUE(isDone) << status.GetErrorMessage();
            EXPECT_EQ(numPatches, base.GetNumFaces());
        }
    }
}

// Few trees, which faces share, between edges that are refined alike on many faces and else on some.
TEST(PatchStreamTest, HandsOutTreesThatFacesShare) {
    Shape const &shape = GetShape("torus");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    auto const factory = SurfaceFactory::Create(*refiner);
    BfrExt::CellForest forest(*refiner);
    std::mt19937 random(3);
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        BfrExt::CellTree tree(forest.GetTree(face).GetFaceShape(), int(random() % 3));
        if (random() % 2 == 0) {
            tree.Refine(tree.GetNumCells() - 1);
        }
        forest.SetTree(face, tree);
    }
    forest.MatchEdges();
    for (std::size_t const memory : {std::size_t(1), std::size_t(100000), std::size_t(1) << 24}) {
        PatchStream<double> const stream(*factory, forest,
                                         PatchStream<double>::Options().SetMaxMemory(memory));
        std::mutex mutex;
        int numPatches = 0;
        ASSERT_TRUE(
            stream.Run(shape.positions.data(), 3, [&](PatchStream<double>::Patch const &patch) {
                std::lock_guard<std::mutex> const lock(mutex);
                ++numPatches;
                LevelTessellation const expected = forest.GetTessellation(patch.face);
                EXPECT_EQ(patch.tessellation.GetNumCoords(), expected.GetNumCoords());
                std::vector<double> coords[2];
                for (LevelTessellation const *t : {&patch.tessellation, &expected}) {
                    std::vector<double> &of = coords[t == &expected ? 1 : 0];
                    of.resize(2 * std::size_t(t->GetNumCoords()));
                    t->GetCoords(of.data());
                }
                EXPECT_EQ(coords[0], coords[1]) << "face " << patch.face;
                Surface<double> surface;
                factory->InitVertexSurface(patch.face, &surface);
                std::vector<double> control(3 * std::size_t(surface.GetNumControlPoints()));
                surface.GatherControlPoints(shape.positions.data(), 3, control.data(), 3);
                std::vector<double> points(3 * std::size_t(expected.GetNumCoords()));
                surface.Evaluate(expected, control.data(), 3, points.data(), 3);
                EXPECT_TRUE(std::equal(points.begin(), points.end(), patch.points));
                return true;
            }));
        EXPECT_EQ(numPatches, shape.GetNumFaces());
    }
}

TEST(PatchStreamTest, TakesPointsOfAnySize) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    auto const factory = SurfaceFactory::Create(*refiner);
    PatchStream<double> const stream(*factory, PatchLevels(5));
    Collection<double> positions;
    ASSERT_TRUE(stream.Run(shape.positions.data(), 3, positions.GetSink()));
    for (int const size : {1, 2, 5}) {
        // Each number is one of the three coordinates; what is between points is of no matter.
        int const stride = size + 2;
        std::vector<double> values(std::size_t(stride) * std::size_t(shape.GetNumVertices()), 1e9);
        for (std::size_t vert = 0; vert < std::size_t(shape.GetNumVertices()); ++vert) {
            for (std::size_t k = 0; k < std::size_t(size); ++k) {
                values[vert * std::size_t(stride) + k] = shape.positions[3 * vert + k % 3];
            }
        }
        Collection<double> collection;
        ASSERT_TRUE(stream.Run(values.data(), {size, stride}, collection.GetSink()));
        for (auto const &[face, points] : positions.patches) {
            std::vector<double> const &found = collection.patches.at(face);
            ASSERT_EQ(found.size() * 3, points.size() * std::size_t(size));
            for (std::size_t i = 0; i < found.size(); ++i) {
                ASSERT_EQ(found[i],
                          points[3 * (i / std::size_t(size)) + i % std::size_t(size) % 3]);
            }
        }
    }
}

TEST(PatchStreamTest, RefusesBeforeAnythingIsHandedOut) {
    Shape const &shape = GetShape("polygon4");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getEdgeOnly());
    auto const factory = SurfaceFactory::Create(*refiner);
    int numPatches = 0;
    PatchStream<double>::Sink const sink = [&](PatchStream<double>::Patch const &) {
        ++numPatches;
        return true;
    };
    FarExt::CallStatus status;
    auto const run = [&](PatchLevels const &levels, int begin, int end, int facetSize) {
        PatchStream<double>::Options options;
        options.SetTessellationOptions(LevelTessellation::Options().SetFacetSize(facetSize));
        return PatchStream<double>(*factory, levels, options)
            .Run(shape.positions.data(), 3, begin, end, sink, &status);
    };
    EXPECT_FALSE(run(PatchLevels(13), 0, 1, 3));
    EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
    EXPECT_EQ(status.GetErrorMessage(), "face 0 has level 13, which is not one of 0 to 12");
    EXPECT_FALSE(run(
        PatchLevels([](int) { return 1; }, [](int edge) { return edge == 2 ? -1 : 0; }), 0, 1, 3));
    EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Edge);
    EXPECT_EQ(status.GetComponentIndex(), 2);
    EXPECT_FALSE(run(PatchLevels(1), 0, 2, 3));
    EXPECT_EQ(status.GetErrorMessage(), "faces 0 to 2 are no range of the 1 of the mesh");
    EXPECT_FALSE(run(PatchLevels(1), 0, 1, 5));
    EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
    EXPECT_TRUE(run(PatchLevels(1), 0, 0, 3));
    EXPECT_EQ(numPatches, 0);
    PatchStream<double> const stream(*factory, PatchLevels(1));
    for (int const noFace : {-1, 1}) {
        EXPECT_FALSE(stream.Run(shape.positions.data(), 3, {}, {0, noFace}, sink, &status));
        EXPECT_EQ(status.GetErrorMessage(),
                  "face " + std::to_string(noFace) + " is none of the 1 of the mesh");
        EXPECT_EQ(status.GetComponentIndex(), noFace);
    }
    EXPECT_TRUE(stream.Run(shape.positions.data(), 3, {}, std::vector<int>(), sink, &status));
    EXPECT_EQ(numPatches, 0);

    auto const free = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    auto const freeFactory = SurfaceFactory::Create(*free);
    EXPECT_FALSE(PatchStream<double>(*freeFactory, PatchLevels(1))
                     .Run(shape.positions.data(), 3, sink, &status));
    EXPECT_EQ(status.GetCode(), StatusCode::Unsupported);
    EXPECT_EQ(numPatches, 0);
    EXPECT_TRUE(run(PatchLevels(1), 0, 1, 3));
    EXPECT_EQ(numPatches, 1);
}

// Threads look at faces in any order, and tell of the same one.
TEST(PatchStreamTest, TellsOfTheFirstFaceThatIsWrong) {
    Shape const shape = MakeBox(30, 30, 30);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getEdgeOnly());
    auto const factory = SurfaceFactory::Create(*refiner);
    constexpr int kFirst = 2500;
    PatchLevels const levels([](int face) { return face < kFirst ? 0 : face; },
                             [](int) { return 0; });
    for (int const numThreads : {1, 2, 3}) {
        ThreadsScope const threads(numThreads);
        FarExt::CallStatus status;
        EXPECT_FALSE(PatchStream<double>(*factory, levels)
                         .Run(
                             shape.positions.data(), 3,
                             [](PatchStream<double>::Patch const &) {
                                 ADD_FAILURE() << "a patch was handed out";
                                 return true;
                             },
                             &status));
        EXPECT_EQ(status.GetComponentIndex(), kFirst) << status.GetErrorMessage();
    }
}

namespace {

/// Counts the errors that Far's callback is told of, while it lives.
struct ErrorCounter {
    ErrorCounter() {
        numErrors = 0;
        FarExt::SetErrorCallback([](Far::ErrorType, char const *) { ++numErrors; });
    }
    ~ErrorCounter() { FarExt::SetErrorCallback(nullptr); }
    ErrorCounter(ErrorCounter const &) = delete;
    ErrorCounter &operator=(ErrorCounter const &) = delete;

    static inline std::atomic<int> numErrors;
};

} // namespace

// An error callback is told of each failure once, by the thread of the call; faces without a surface are
// none by themselves.
TEST(PatchStreamTest, ReportsEachFailureOnce) {
    using Stream = PatchStream<double>;
    Stream::Sink const sink = [](Stream::Patch const &) { return true; };
    auto const countErrors = [&](Shape const &shape, Sdc::Options options, bool isWell) {
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0, options);
        auto const factory = SurfaceFactory::Create(*refiner);
        ErrorCounter const counter;
        EXPECT_EQ(Stream(*factory, PatchLevels(1)).Run(shape.positions.data(), 3, sink), isWell);
        return int(ErrorCounter::numErrors);
    };
    Shape withHoles = GetShape("cube");
    withHoles.holeFaces = {2, 3};
    EXPECT_EQ(countErrors(withHoles, getEdgeOnly(), true), 0);
    // Before the first patch, at many faces.
    EXPECT_EQ(countErrors(GetShape("quadGrid"), Sdc::Options(), false), 1);
    // A single sharp edge ends among many faces, and no face at its end has a limit.
    constexpr int kNumSides = 140;
    Shape withoutLimit = MakeBipyramid(kNumSides);
    withoutLimit.creaseVertexPairs = {0, kNumSides};
    withoutLimit.creaseSharpness = {Sdc::Crease::SHARPNESS_INFINITE};
    EXPECT_EQ(countErrors(withoutLimit, getEdgeOnly(), false), 1);

    auto const refiner = CreateRefiner(withHoles, ReferenceMask::Smooth, 0, getEdgeOnly());
    auto const factory = SurfaceFactory::Create(*refiner);
    ErrorCounter const counter;
    FarExt::CallStatus status;
    EXPECT_FALSE(factory->FaceHasLimitSurface(2, &status));
    EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
    BfrExt::View(BfrExt::Camera()).MakeForest<double>(*factory, withHoles.positions.data(), 3);
    EXPECT_EQ(ErrorCounter::numErrors, 0);
    Surface<double> surface;
    EXPECT_FALSE(factory->InitVertexSurface(2, &surface));
    EXPECT_EQ(ErrorCounter::numErrors, 1);
}

TEST(PatchStreamTest, RefusesForestsThatDoNotFit) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getEdgeOnly());
    auto const factory = SurfaceFactory::Create(*refiner);
    using Stream = PatchStream<double>;
    auto const expectRefused = [&](BfrExt::CellForest const &forest,
                                   std::vector<Stream::Values> const &values,
                                   std::string const &cause) {
        FarExt::CallStatus status;
        Stream const stream(*factory, forest);
        EXPECT_FALSE(stream.Run(
            shape.positions.data(), 3, values, 0, 6,
            [](Stream::Patch const &) {
                ADD_FAILURE() << "a patch was handed out";
                return true;
            },
            &status));
        EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
        EXPECT_NE(status.GetErrorMessage().find(cause), std::string::npos)
            << status.GetErrorMessage();
    };
    BfrExt::CellForest forest(*refiner);
    EXPECT_TRUE(forest.IsMatched(3));
    expectRefused(forest, {{shape.positions.data(), 3, 0}}, "channel 0");
    expectRefused(forest, {{shape.positions.data(), 3, -2}}, "channel -2");
    BfrExt::CellTree tree(4);
    tree.Refine(tree.Refine(0) + 2);
    forest.SetTree(3, tree);
    EXPECT_FALSE(forest.IsMatched(3));
    expectRefused(forest, {}, "face 3");
    forest.MatchEdges();
    EXPECT_TRUE(forest.IsMatched(3));
    forest.SetTree(2, BfrExt::CellTree(5));
    expectRefused(forest, {}, "face 2");
    auto const other = CreateRefiner(GetShape("icosahedron"), ReferenceMask::Smooth, 0, {});
    expectRefused(BfrExt::CellForest(*other), {}, "20 trees");
    // A forest of another mesh with six faces, and one of an equal mesh.
    for (Shape const &ofOther : {MakeBipyramid(3), shape}) {
        auto const otherRefiner = CreateRefiner(ofOther, ReferenceMask::Smooth, 0, getEdgeOnly());
        BfrExt::CellForest ofOtherRefiner(*otherRefiner);
        ofOtherRefiner.MatchEdges();
        expectRefused(ofOtherRefiner, {}, "another refiner");
    }
}

TEST(PatchStreamTest, EndsWhenTheSinkSaysSo) {
    Shape const &shape = GetFeatureShape("mixedSharpnessQuads");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getEdgeOnly());
    auto const factory = SurfaceFactory::Create(*refiner);
    PatchStream<double> const stream(*factory, PatchLevels(1));
    ThreadsScope const threads(1);
    int numPatches = 0;
    FarExt::CallStatus status(StatusCode::TooLarge, FarExt::ComponentType::NoComponent, 0, "");
    EXPECT_FALSE(stream.Run(
        shape.positions.data(), 3,
        [&](PatchStream<double>::Patch const &) { return ++numPatches < 3; }, &status));
    EXPECT_TRUE(status.IsOk());
    EXPECT_EQ(numPatches, 3);
    EXPECT_THROW(stream.Run(shape.positions.data(), 3,
                            [](PatchStream<double>::Patch const &) -> bool {
                                throw std::runtime_error("the disk is full");
                            }),
                 std::runtime_error);
}

} // namespace OpenSubdivHex::Regression::patchStreamTest

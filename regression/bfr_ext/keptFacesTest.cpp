// SPDX-License-Identifier: Apache-2.0
//
// Data of faces that are kept from their second surface on, and surfaces made of them.
#include "surfaceFixture.h"

#include "bfr_ext/cell/keptFaces.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <numeric>
#include <thread>

namespace OpenSubdivHex::Regression::keptFacesTest {
namespace {

using BfrExt::internal::MemoryCount;
using Kept = BfrExt::internal::KeptFaces<int>;
using Indices = std::vector<Far::Index>;

constexpr std::size_t kEnough = 1 << 20;

MemoryCount makeCount() { return MemoryCount(std::make_shared<MemoryCount::Total>(0)); }

// Points of a triangle.
Indices makePoints(int first) { return {first, first + 1, first + 2, 0, 0, 1, 2, 3, 4}; }

/// Adds a face to those that are kept.
template <typename TYPE>
auto add(BfrExt::internal::KeptFaces<TYPE> &kept, std::size_t kind, int face, TYPE const &type,
         int size, Indices const &points) {
    std::vector<std::byte> bytes;
    BfrExt::internal::FacePoints<TYPE> own(bytes);
    own.resize(points.size());
    std::copy(points.begin(), points.end(), own.data());
    return kept.Add(kind, face, own.Make(type, size));
}

struct Found {
    Indices indices; // control points
    std::vector<double> point;

    bool operator==(Found const &other) const {
        return indices == other.indices && point == other.point;
    }
};

template <typename INIT>
Found find(BfrExt::Surface<double> &surface, Shape const &shape, INIT const &init) {
    EXPECT_TRUE(init(surface));
    Found found;
    found.indices.resize(std::size_t(surface.GetNumControlPoints()));
    EXPECT_EQ(surface.GetControlPointIndices(found.indices.data()), surface.GetNumControlPoints());
    // Values, too, whatever they stand for.
    std::vector<double> control;
    for (Far::Index const index : found.indices) {
        control.push_back(shape.positions[std::size_t(index) % shape.positions.size()]);
    }
    // At a vertex and on an edge, for what neighbours share.
    for (double const u : {0.0, 0.25}) {
        double const uv[2] = {u, 0};
        found.point.push_back(0);
        control.resize(std::size_t(surface.GetNumPatchPoints()));
        surface.ComputePatchPoints(control.data(), 1);
        surface.Evaluate(uv, control.data(), 1, &found.point.back());
    }
    return found;
}

/// Finds the data of surfaces of all faces and kinds of data, several times.
std::vector<Found> findAll(BfrExt::SurfaceFactory const &factory, Shape const &shape,
                           int numRounds) {
    std::vector<Found> result;
    BfrExt::Surface<double> surface;
    for (int round = 0; round < numRounds; ++round) {
        for (int face = 0; face < factory.GetNumFaces(); ++face) {
            result.push_back(find(surface, shape,
                                  [&](auto &of) { return factory.InitVertexSurface(face, &of); }));
            result.push_back(find(surface, shape,
                                  [&](auto &of) { return factory.InitVaryingSurface(face, &of); }));
            for (int channel = 0; channel < factory.GetNumFVarChannels(); ++channel) {
                result.push_back(find(surface, shape, [&](auto &of) {
                    return factory.InitFaceVaryingSurface(face, &of, channel);
                }));
            }
        }
    }
    return result;
}

} // namespace

TEST(KeptFacesTest, AreThoseThatWereAddedTwice) {
    MemoryCount count = makeCount();
    Kept kept(5, 2, kEnough, count);
    EXPECT_FALSE(kept.Find(1, 3));
    Indices const points = makePoints(10);
    EXPECT_FALSE(add(kept, 1, 3, 7, 3, points));
    EXPECT_FALSE(kept.Find(1, 3));
    Kept::Face const *const face = add(kept, 1, 3, 7, 3, points);
    ASSERT_TRUE(face);
    EXPECT_EQ(face->type, 7);
    EXPECT_EQ(face->size, 3);
    EXPECT_EQ(face->numPoints, 3);
    EXPECT_EQ(Indices(face->GetPoints(), face->GetPoints() + points.size()), points);
    EXPECT_EQ(add(kept, 1, 3, 8, 3, makePoints(20)), face);
    EXPECT_EQ(kept.Find(1, 3), face);
    EXPECT_FALSE(kept.Find(0, 3));
    for (int const none : {-1, 2, 4, 5}) {
        EXPECT_FALSE(kept.Find(1, none)) << none;
    }
}

TEST(KeptFacesTest, TakeNoMoreMemoryThanTheyMay) {
    constexpr int kNumFaces = 10000;
    for (std::size_t const memory : {std::size_t(0), std::size_t(1000), kEnough / 4}) {
        MemoryCount count = makeCount();
        Kept kept(kNumFaces, 1, memory, count);
        std::size_t numKept = 0;
        for (int face = 0; face < kNumFaces; ++face) {
            EXPECT_FALSE(add(kept, 0, face, face, 3, makePoints(face)));
            Kept::Face const *const added = add(kept, 0, face, face, 3, makePoints(face));
            ASSERT_EQ(kept.Find(0, face), added);
            numKept += added ? 1 : 0;
        }
        EXPECT_LE(numKept * (sizeof(Kept::Face) + 9 * sizeof(Far::Index)), count.Get());
        EXPECT_LE(count.Get(), memory);
        EXPECT_EQ(numKept > 0, memory > 1000);
        for (int face = 0; face < kNumFaces; ++face) {
            Kept::Face const *const found = kept.Find(0, face);
            ASSERT_TRUE(!found || found->GetPoints()[0] == face);
        }
    }
}

TEST(KeptFacesTest, OfOneKindAreKeptWhereAnotherHasNoMemory) {
    constexpr int kNumFaces = 20000;
    constexpr std::size_t kSlots = kNumFaces * sizeof(void *);
    MemoryCount count = makeCount();
    Kept kept(kNumFaces, 2, 2 * kSlots - 1, count);
    Indices const points = makePoints(7);
    add(kept, 0, 3, 1, 3, points);
    for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(add(kept, 1, 3, 1, 3, points), nullptr);
    }
    EXPECT_NE(add(kept, 0, 3, 1, 3, points), nullptr);
    EXPECT_NE(kept.Find(0, 3), nullptr);
}

TEST(KeptFacesTest, LieWhereTheirTypesMay) {
    using KeptPointers = BfrExt::internal::KeptFaces<int const *>;
    MemoryCount count = makeCount();
    KeptPointers kept(100, 1, kEnough, count);
    int const type = 1;
    // The largest takes more than a block.
    for (int face = 0; face < 100; ++face) {
        Indices points(std::size_t(face == 50 ? 30001 : 7 + face));
        std::iota(points.begin(), points.end(), face);
        add(kept, 0, face, &type, 3, points);
        KeptPointers::Face const *const added = add(kept, 0, face, &type, 3, points);
        ASSERT_TRUE(added);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(added) % alignof(KeptPointers::Face), 0u);
        EXPECT_EQ(added->type, &type);
        EXPECT_EQ(Indices(added->GetPoints(), added->GetPoints() + points.size()), points);
    }
}

TEST(KeptFacesTest, AreTheSameForAllThreads) {
    constexpr int kNumFaces = 20000;
    constexpr int kNumThreads = 2;
    MemoryCount count = makeCount();
    Kept kept(kNumFaces, 1, 8 * kEnough, count);
    std::vector<Kept::Face const *> added[kNumThreads];
    for (int face = 0; face < kNumFaces; ++face) {
        ASSERT_FALSE(add(kept, 0, face, face, 3, makePoints(face)));
    }
    // Each face is added by all at once.
    std::vector<std::atomic<int>> numReady(kNumFaces);
    std::vector<std::thread> threads;
    threads.reserve(kNumThreads);
    for (std::vector<Kept::Face const *> &ofThread : added) {
        threads.emplace_back([&] {
            for (int face = 0; face < kNumFaces; ++face) {
                Indices const points = makePoints(face);
                std::atomic<int> &ready = numReady[std::size_t(face)];
                ++ready;
                while (ready < kNumThreads) {
                    std::this_thread::yield();
                }
                ofThread.push_back(add(kept, 0, face, face, 3, points));
            }
        });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
    for (int face = 0; face < kNumFaces; ++face) {
        Kept::Face const *const found = kept.Find(0, face);
        ASSERT_TRUE(found);
        ASSERT_EQ(found->type, face);
        ASSERT_EQ(Indices(found->GetPoints(), found->GetPoints() + 9), makePoints(face));
        for (std::vector<Kept::Face const *> const &ofThread : added) {
            ASSERT_EQ(ofThread[std::size_t(face)], found) << face;
        }
    }
}

// As those that are not kept, also when the factory goes.
TEST(KeptFacesTest, MakeTheSameSurfaces) {
    constexpr int kNumRounds = 3;
    int numChannels = 0;
    for (char const *const name : {"texturedFin", "leftHanded", "dartsTriangles"}) {
        Shape const &shape = GetFeatureShape(name);
        SCOPED_TRACE(name);
        Sdc::Options sdcOptions;
        sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, sdcOptions);
        numChannels += refiner->GetNumFVarChannels();
        // Each face once: none is kept.
        std::vector<Found> const once =
            findAll(*BfrExt::SurfaceFactory::Create(*refiner), shape, 1);
        std::vector<Found> expected;
        for (int round = 0; round < kNumRounds; ++round) {
            expected.insert(expected.end(), once.begin(), once.end());
        }
        auto factory = BfrExt::SurfaceFactory::Create(*refiner);
        std::vector<Found> results[3];
        std::vector<std::thread> threads;
        threads.reserve(3);
        for (std::vector<Found> &result : results) {
            threads.emplace_back([&] { result = findAll(*factory, shape, kNumRounds); });
        }
        for (std::thread &thread : threads) {
            thread.join();
        }
        for (std::vector<Found> const &result : results) {
            EXPECT_TRUE(result == expected);
        }
        BfrExt::Surface<double> surface;
        ASSERT_TRUE(factory->InitVertexSurface(0, &surface));
        BfrExt::Surface<double> const copy = surface;
        surface.Clear();
        EXPECT_FALSE(surface.IsValid());
        factory.reset();
        surface = copy;
        EXPECT_TRUE(find(surface, shape, [](auto &) { return true; }) == expected[0]);
    }
    EXPECT_GT(numChannels, 0);
}

} // namespace OpenSubdivHex::Regression::keptFacesTest

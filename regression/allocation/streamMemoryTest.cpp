// SPDX-License-Identifier: Apache-2.0
//
// Streams keep to the memory that they were given.
#include "failingAllocations.h"

#include "bfr_ext/patchStream.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/bfr_ext/streamFixture.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <atomic>

namespace OpenSubdivHex::Regression::streamMemoryTest {

using BfrExt::LevelTessellation;
using BfrExt::PatchLevels;
using BfrExt::PatchStream;
using BfrExt::SurfaceFactory;

namespace {

struct Usage {
    long bytes; ///< at a time
    long numPoints;
    long maxPoints; ///< of a patch
};

/// A shape, of which all types of cells are known before anything is measured.
class Subject {
public:
    explicit Subject(Shape const &shape)
        : _positions(shape.positions.begin(), shape.positions.end()) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        auto const base = CreateFarRefiner(shape, options);
        _refiner = FarExt::TopologyRefinerFactory::Create(*base, {FarExt::HexSchemeOptions()});
        _factory = SurfaceFactory::Create(*_refiner);
    }

    FarExt::TopologyLevel const &GetBase() const { return _refiner->GetLevel(0); }

    FarExt::TopologyRefiner const &GetRefiner() const { return *_refiner; }

    /// Returns the memory of a new stream.
    ///
    /// \param source  PatchLevels, or a CellForest
    template <typename SOURCE>
    Usage Measure(SOURCE const &source, PatchStream<float>::Options const &options) const {
        std::atomic<long> count(0);
        std::atomic<long> maxCount(0);
        auto const run = [&] {
            PatchStream<float> const stream(*_factory, source, options);
            ResetPeakBytes();
            long const before = CountLiveBytes();
            EXPECT_TRUE(
                stream.Run(_positions.data(), 3, [&](PatchStream<float>::Patch const &patch) {
                    long const numPoints = patch.tessellation.GetNumCoords();
                    count += numPoints;
                    for (long known = maxCount;
                         known < numPoints && !maxCount.compare_exchange_weak(known, numPoints);) {
                    }
                    return true;
                }));
            return GetPeakBytes() - before;
        };
        run();
        count = 0;
        long const bytes = run();
        return {bytes, count, maxCount};
    }

private:
    std::vector<float> const _positions;
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::unique_ptr<SurfaceFactory> _factory;
};

} // namespace

TEST(StreamMemoryTest, IsWhatWasAskedFor) {
    Subject const subject(GetShape("icosahedron"));
    // So little that not all plans fit, and one with what it takes to make it does.
    struct Case {
        int numLevels;
        std::size_t kilobytes;
        long minNumPoints;
    };
    for (Case const &testCase : {Case{5, 512, 1000}, Case{6, 1024, 5000}, Case{7, 2560, 14000}}) {
        RandomPatchLevels const levels(subject.GetBase(), testCase.numLevels, 1);
        for (int const facetSize : {0, 3, 4}) {
            for (bool const hasDerivatives : {false, true}) {
                PatchStream<float>::Options options;
                options.SetTessellationOptions(
                    LevelTessellation::Options().SetFacetSize(facetSize));
                options.SetDerivatives(hasDerivatives);
                options.SetMaxMemory(testCase.kilobytes << 10);
                for (int const numThreads : {1, 2}) {
                    ThreadsScope const threads(numThreads);
                    Usage const usage = subject.Measure(levels.Get(), options);
                    EXPECT_GE(usage.numPoints, testCase.minNumPoints);
                    // Each thread has the points of a patch besides, and what faces share.
                    constexpr long kShared = 1200000;
                    long const numbers = (hasDerivatives ? 9 : 3) * usage.maxPoints;
                    EXPECT_LE(usage.bytes,
                              long(options.GetMaxMemory()) +
                                  numThreads * (numbers * long(sizeof(float)) + kShared))
                        << testCase.numLevels << " levels, facets of " << facetSize << ", "
                        << numThreads << " threads" << (hasDerivatives ? ", derivatives" : "");
                }
            }
        }
    }
}

// Faces that take many times as much memory as there is come in sections.
TEST(StreamMemoryTest, DoesNotDependOnTheSizeOfFaces) {
    Subject const subject(GetShape("polygon4"));
    struct Case {
        int level;
        bool hasTree;
        bool hasDerivatives;
        long minNumPoints;
    };
    for (Case const &testCase : {Case{9, false, false, 349525}, Case{9, true, false, 349525},
                                 Case{8, false, true, 87381}, Case{8, true, true, 87381}}) {
        BfrExt::CellForest forest(subject.GetRefiner());
        forest.SetTree(0, BfrExt::CellTree(4, testCase.level));
        forest.MatchEdges();
        PatchStream<float>::Options options;
        options.SetDerivatives(testCase.hasDerivatives);
        for (int const numThreads : {1, 2}) {
            ThreadsScope const threads(numThreads);
            Usage const usage = testCase.hasTree
                                    ? subject.Measure(forest, options)
                                    : subject.Measure(PatchLevels(testCase.level), options);
            EXPECT_GE(usage.numPoints, testCase.minNumPoints);
            long const numbers = (testCase.hasDerivatives ? 9 : 3) * usage.maxPoints;
            EXPECT_LE(usage.bytes,
                      long(options.GetMaxMemory()) + numThreads * numbers * long(sizeof(float)))
                << "level " << testCase.level << ", " << numThreads << " threads"
                << (testCase.hasDerivatives ? ", derivatives" : "")
                << (testCase.hasTree ? ", a tree" : "");
        }
    }
}

} // namespace OpenSubdivHex::Regression::streamMemoryTest

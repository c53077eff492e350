// SPDX-License-Identifier: Apache-2.0
//
// Numbers of what a stream makes, and the PLY files that are made with them.
#include "cellFixture.h"
#include "facets.h"
#include "streamFixture.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"
#include "tools/stream/plySink.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <string>

namespace OpenSubdivHex::Regression::patchNumberingTest {

using BfrExt::LevelTessellation;
using BfrExt::PatchLevels;
using BfrExt::PatchStream;
using BfrExt::SurfaceFactory;
using Tools::PatchNumbering;
using Tools::PlySink;

namespace {

using Number = PatchNumbering::Number;
using Point = std::array<double, 3>;

Sdc::Options getEdgeOnly() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return options;
}

PatchStream<double>::Options getOptions(int facetSize) {
    return PatchStream<double>::Options().SetTessellationOptions(
        LevelTessellation::Options().SetFacetSize(facetSize));
}

/// Sizes of the faces of a stream: as they come by chance, or with faces 0 and 1 so fine that they come in
/// sections.
enum class Size { Small, InSections };

RandomPatchLevels makeLevels(FarExt::TopologyLevel const &base, unsigned seed, Size size) {
    RandomPatchLevels levels(base, 4, seed);
    for (int face = 0; size == Size::InSections && face < 2; ++face) {
        levels.faces[std::size_t(face)] = 7;
        // Edges as fine as the face, coarser and finer.
        int const ofEdges[] = {7, 5, 9};
        for (int local = 0; local < 3; ++local) {
            int const edge = FarExt::SurfaceFaces(base.GetLevel()).GetEdge(face, local).edge;
            levels.edges[std::size_t(edge)] = ofEdges[local];
        }
    }
    return levels;
}

BfrExt::CellForest makeForest(FarExt::TopologyRefiner const &refiner, unsigned seed, Size size) {
    BfrExt::CellForest forest = MakeRandomForest(refiner, seed);
    for (int face = 0; size == Size::InSections && face < 2; ++face) {
        forest.SetTree(face, MakeLargeTree(forest.GetTree(face).GetFaceShape(), seed));
    }
    forest.MatchEdges();
    return forest;
}

/// A stream, joined by the numbers of its points.
struct Joined {
    Joined(Shape const &shape, unsigned seed, int facetSize, bool hasTrees = false,
           Size size = Size::Small, SurfaceCase const &surfaceCase = kPlainCases[2])
        : refiner(CreateSurfaceRefiner(shape, surfaceCase, 0, getEdgeOnly())),
          factory(SurfaceFactory::Create(*refiner)),
          levels(makeLevels(factory->GetLevel(), seed, size)),
          forest(makeForest(*refiner, seed, size)),
          stream(hasTrees ? PatchStream<double>(*factory, forest, getOptions(facetSize))
                          : PatchStream<double>(*factory, levels.Get(), getOptions(facetSize))),
          numbering(PatchNumbering::Create(stream)) {
        ThreadsScope const threads(1);
        EXPECT_TRUE(stream.Run(FindControlPoints(*refiner, shape.positions).data(), 3,
                               [&](PatchStream<double>::Patch const &patch) {
                                   Add(patch);
                                   return true;
                               }));
    }

    void Add(PatchStream<double>::Patch const &patch) {
        LevelTessellation const &tessellation = patch.tessellation;
        std::vector<Number> numbers(std::size_t(tessellation.GetNumCoords()));
        numbering->GetPoints(patch.face, tessellation, numbers.data());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            Point const point = {patch.points[3 * i], patch.points[3 * i + 1],
                                 patch.points[3 * i + 2]};
            auto const [found, isNew] = points.emplace(numbers[i], point);
            bool const isBaseVertex = numbers[i] < factory->GetLevel().GetNumVertices();
            if (!isBaseVertex || !factory->GetLevel().IsVertexNonManifold(int(numbers[i]))) {
                EXPECT_EQ(found->second, point) << "point " << numbers[i];
            }
        }
        std::vector<PatchNumbering::Run> runs;
        numbering->GetRuns(patch.face, tessellation, runs);
        int place = 0;
        for (PatchNumbering::Run const &run : runs) {
            EXPECT_EQ(run.place, place);
            for (int i = 0; i < run.count; ++i, ++place) {
                EXPECT_EQ(numbers[std::size_t(place)], run.point + Number(i) * run.step);
                if (run.isOwn) {
                    EXPECT_TRUE(owned.insert(numbers[std::size_t(place)]).second);
                }
            }
        }
        EXPECT_EQ(place, tessellation.GetNumCoords());
        std::vector<std::vector<int>> const facets = GetFacets(tessellation);
        int const section = tessellation.GetSection();
        EXPECT_EQ(tessellation.GetNumSections(), stream.GetNumSections(patch.face));
        numSections += tessellation.GetNumSections() == 1 ? 0 : 1;
        Number number = numbering->GetFirstFacet(patch.face, section);
        if (section + 1 == tessellation.GetNumSections()) {
            EXPECT_EQ(numbering->GetFirstFacet(patch.face + 1), number + Number(facets.size()));
        }
        for (std::vector<int> const &facet : facets) {
            EXPECT_EQ(polygons.count(number), 0);
            std::vector<Number> &polygon = polygons[number++];
            for (int const vert : facet) {
                polygon.push_back(numbers[std::size_t(vert)]);
            }
        }
    }

    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<SurfaceFactory> factory;
    RandomPatchLevels levels;
    BfrExt::CellForest forest;
    PatchStream<double> stream;
    std::unique_ptr<PatchNumbering> numbering;
    std::map<Number, Point> points;
    std::set<Number> owned;
    std::map<Number, std::vector<Number>> polygons;
    int numSections = 0;
};

/// A file in memory, of which every byte is written once.
struct MemoryFile {
    PlySink<double>::Write GetWrite() {
        return [this](std::uint64_t offset, char const *from, std::size_t size) {
            std::lock_guard<std::mutex> const lock(_mutex);
            if (offset + size > bytes.size()) {
                bytes.resize(std::size_t(offset) + size);
                counts.resize(bytes.size());
            }
            std::copy(from, from + size, bytes.begin() + std::ptrdiff_t(offset));
            for (std::size_t i = std::size_t(offset); i < offset + size; ++i) {
                ++counts[i];
            }
            return true;
        };
    }

    std::string bytes;
    std::vector<int> counts;

private:
    std::mutex _mutex;
};

template <typename T>
T take(std::string const &bytes, std::size_t &place) {
    T value;
    std::memcpy(&value, &bytes.at(place), sizeof value);
    place += sizeof value;
    return value;
}

/// The file has what was joined, in the order of numbers.
void expectFile(std::string const &bytes, Joined const &joined, bool hasLongSizes) {
    std::size_t place = bytes.find("end_header\n");
    ASSERT_NE(place, std::string::npos);
    place += std::strlen("end_header\n");
    std::ostringstream header;
    header << "ply\nformat binary_little_endian 1.0\nelement vertex " << joined.points.size()
           << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
           << joined.polygons.size() << "\nproperty list " << (hasLongSizes ? "int" : "uchar")
           << " int vertex_indices\nend_header\n";
    ASSERT_EQ(bytes.substr(0, place), header.str());
    int next = 0;
    for (auto const &[number, point] : joined.points) {
        ASSERT_EQ(number, next++);
        for (double const coordinate : point) {
            ASSERT_EQ(take<double>(bytes, place), coordinate) << "point " << number;
        }
    }
    for (auto const &[key, polygon] : joined.polygons) {
        ASSERT_EQ(hasLongSizes ? take<std::int32_t>(bytes, place)
                               : take<unsigned char>(bytes, place),
                  int(polygon.size()));
        for (Number const number : polygon) {
            ASSERT_EQ(take<std::int32_t>(bytes, place), number);
        }
    }
    ASSERT_EQ(place, bytes.size());
}

} // namespace

TEST(PatchNumberingTest, SharedPointsHaveOneNumberAndOneOwner) {
    std::vector<Shape const *> shapes;
    for (Shape const &shape : GetManifoldShapes()) {
        if (shape.GetNumFaces() <= 40) {
            shapes.push_back(&shape);
        }
    }
    for (char const *const name : {"mixedSharpnessQuads", "bowTieOfFans", "creasedBall"}) {
        shapes.push_back(&GetFeatureShape(name));
    }
    std::set<std::string> const shapesInSections = {"cube", "prism5", "bowTieOfFans",
                                                    "creasedBall"};
    int numInSections = 0;
    for (Shape const *const shape : shapes) {
        SCOPED_TRACE(shape->name);
        bool const isInSections = shapesInSections.count(shape->name) > 0;
        numInSections += isInSections ? 1 : 0;
        // The last round is behind a first step.
        std::vector<int> rounds = {0, 1, 4};
        if (isInSections) {
            rounds = {0, 1, 2, 3, 4};
        }
        for (int const round : rounds) {
            int const facetSize = std::array<int, 5>{0, 3, 3, 0, 0}[std::size_t(round)];
            bool const hasSections = round == 2 || round == 3;
            Joined const joined(*shape, 9, facetSize, round == 3,
                                hasSections ? Size::InSections : Size::Small,
                                round == 4 ? kTruncateCases[2] : kPlainCases[2]);
            ASSERT_EQ(joined.numSections > 4, hasSections);
            ASSERT_EQ(Number(joined.points.size()), joined.numbering->GetNumPoints());
            ASSERT_EQ(joined.points.begin()->first, 0);
            ASSERT_EQ(joined.points.rbegin()->first, joined.numbering->GetNumPoints() - 1);
            ASSERT_EQ(joined.owned.size(), joined.points.size());
            ASSERT_EQ(Number(joined.polygons.size()), joined.numbering->GetNumFacets());
            ASSERT_EQ(joined.polygons.rbegin()->first + 1, joined.numbering->GetNumFacets());
            // Neighbours fit: every side of a facet has another against it, but on borders.
            std::map<std::pair<Number, Number>, int> sides;
            for (auto const &[key, polygon] : joined.polygons) {
                for (std::size_t i = 0; i < polygon.size(); ++i) {
                    ++sides[{polygon[i], polygon[(i + 1) % polygon.size()]}];
                }
            }
            if (shape->closed) {
                for (auto const &[side, count] : sides) {
                    ASSERT_EQ(count, (sides[{side.second, side.first}]));
                }
            }
        }
    }
    EXPECT_EQ(numInSections, int(shapesInSections.size()));
}

TEST(PatchNumberingTest, HolesHaveNoPoints) {
    Shape shape = GetShape("cube");
    shape.holeFaces = {0, 1};
    Joined const joined(shape, 2, 3);
    EXPECT_EQ(joined.numbering->GetFirstFacet(2), 0);
    EXPECT_EQ(Number(joined.points.size()), joined.numbering->GetNumPoints());
    EXPECT_EQ(joined.owned.size(), joined.points.size());
}

TEST(PlySinkTest, AnyThreadsAndSharesWriteEveryByteOnce) {
    for (int const round : {0, 1, 2, 3, 4, 5}) {
        int const facetSize = std::array<int, 6>{0, 3, 4, 0, 3, 4}[std::size_t(round)];
        Shape const &shape = GetFeatureShape("mixedSharpnessQuads");
        Joined const joined(shape, 4, facetSize, round == 3 || round == 5,
                            round < 4 ? Size::Small : Size::InSections);
        ASSERT_EQ(joined.numSections > 4, round >= 4);
        std::string first;
        for (int const numShares : {1, 3}) {
            for (int const numThreads : {1, 2, 3}) {
                ThreadsScope const threads(numThreads);
                MemoryFile file;
                auto const sink = PlySink<double>::Create(*joined.numbering, file.GetWrite());
                ASSERT_TRUE(sink);
                int const numFaces = joined.factory->GetNumFaces();
                for (int share = numShares - 1; share >= 0; --share) {
                    ASSERT_TRUE(joined.stream.Run(shape.positions.data(), 3,
                                                  numFaces * share / numShares,
                                                  numFaces * (share + 1) / numShares, *sink));
                }
                ASSERT_TRUE(sink->Flush());
                ASSERT_TRUE(sink->WriteHeader());
                ASSERT_EQ(file.bytes.size(), sink->GetFileSize());
                ASSERT_EQ(file.counts, std::vector<int>(file.bytes.size(), 1));
                if (first.empty()) {
                    first = file.bytes;
                    ASSERT_NO_FATAL_FAILURE(expectFile(file.bytes, joined, false));
                }
                ASSERT_EQ(file.bytes, first);
            }
        }
    }
}

// A face of level 0 between edges of level 8 has 684 sides.
TEST(PlySinkTest, FacetsMayHaveManyCorners) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    auto const factory = SurfaceFactory::Create(*refiner);
    PatchStream<double> const stream(
        *factory, PatchLevels([](int) { return 0; }, [](int) { return 8; }), getOptions(0));
    auto const numbering = PatchNumbering::Create(stream);
    ASSERT_TRUE(numbering);
    EXPECT_EQ(numbering->GetMaxFacetSize(), 4 * 171);
    MemoryFile file;
    auto const sink = PlySink<double>::Create(*numbering, file.GetWrite());
    ASSERT_TRUE(sink->WriteHeader());
    ASSERT_TRUE(stream.Run(shape.positions.data(), 3, *sink) && sink->Flush());
    EXPECT_NE(file.bytes.find("property list int int"), std::string::npos);
    EXPECT_EQ(file.bytes.size(), sink->GetFileSize());
    std::size_t place = file.bytes.size() - std::size_t(6 * (4 * 171 + 1) * 4);
    EXPECT_EQ(take<std::int32_t>(file.bytes, place), 4 * 171);
}

TEST(PlySinkTest, EndsTheStreamWhenWritingFails) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    auto const factory = SurfaceFactory::Create(*refiner);
    // Each face has more than the sink gathers.
    PatchStream<double> const stream(*factory, PatchLevels(9));
    auto const numbering = PatchNumbering::Create(stream);
    int numWrites = 0;
    ThreadsScope const threads(1);
    auto const sink = PlySink<double>::Create(
        *numbering, [&](std::uint64_t, char const *, std::size_t) { return ++numWrites < 3; });
    EXPECT_FALSE(stream.Run(shape.positions.data(), 3, *sink));
    EXPECT_EQ(numWrites, 3);
    PatchStream<double> const wrong(*factory, PatchLevels(-1));
    FarExt::CallStatus status;
    EXPECT_FALSE(PatchNumbering::Create(wrong, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
}

// Whole faces, one behind the other: all points inside, and all facets, are one piece.
TEST(PlySinkTest, WritesWhatFollowsOneAnotherAtOnce) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    auto const factory = SurfaceFactory::Create(*refiner);
    PatchStream<double> const stream(*factory, PatchLevels(4));
    auto const numbering = PatchNumbering::Create(stream);
    MemoryFile file;
    int numWrites = 0;
    auto const write = file.GetWrite();
    auto const sink = PlySink<double>::Create(
        *numbering, [&](std::uint64_t offset, char const *bytes, std::size_t size) {
            ++numWrites;
            return write(offset, bytes, size);
        });
    ASSERT_TRUE(stream.Run(shape.positions.data(), 3, *sink));
    EXPECT_EQ(numWrites, 0);
    ASSERT_TRUE(sink->Flush());
    EXPECT_EQ(numWrites, 1);
    ASSERT_TRUE(sink->Flush() && sink->WriteHeader());
    EXPECT_EQ(numWrites, 2);
    EXPECT_EQ(file.counts, std::vector<int>(sink->GetFileSize(), 1));
}

TEST(PlySinkTest, TakesPointsOfThreeNumbersAlone) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    auto const factory = SurfaceFactory::Create(*refiner);
    PatchStream<double> const stream(*factory, PatchLevels(1));
    auto const numbering = PatchNumbering::Create(stream);
    std::atomic<int> numWrites(0);
    auto const sink =
        PlySink<double>::Create(*numbering, [&](std::uint64_t, char const *, std::size_t) {
            ++numWrites;
            return true;
        });
    std::vector<double> const points(4 * std::size_t(shape.GetNumVertices()));
    for (int const size : {2, 4}) {
        FarExt::CallStatus status;
        EXPECT_FALSE(stream.Run(points.data(), size, *sink, &status));
        EXPECT_TRUE(status.IsOk());
        EXPECT_EQ(numWrites, 0);
    }
    EXPECT_TRUE(stream.Run(points.data(), 3, *sink) && sink->Flush());
    EXPECT_GT(numWrites, 0);
}

} // namespace OpenSubdivHex::Regression::patchNumberingTest

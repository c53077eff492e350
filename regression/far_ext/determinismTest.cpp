// SPDX-License-Identifier: Apache-2.0
//
// Results have equal bits for any number of threads.
#include "referenceMatch.h"

#include "far_ext/executor.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/flatShapes.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression::determinismTest {

namespace {

template <typename ARRAY>
std::vector<typename ARRAY::value_type> copy(ARRAY const &array) {
    return {array.begin(), array.end()};
}

/// All that a level and the table of a shape consist of.
struct Result {
    std::vector<std::vector<int>> relations;
    std::vector<int> indices;
    std::vector<float> weights;

    bool operator==(Result const &other) const {
        return relations == other.relations && indices == other.indices && weights == other.weights;
    }
};

/// The arrays of a level and of the refinement to the next, if there is one.
struct Arrays {
    std::vector<std::vector<std::byte>> arrays;

    Arrays(FarExt::TopologyRefiner const &refiner, int depth) {
        FarExt::internal::MeshLevels const &mesh = refiner.GetHierarchy().mesh;
        FarExt::internal::Level const &level = mesh.levels[std::size_t(depth)];
        FarExt::internal::Level::ForEachRelation(
            level, [this](auto const &array, std::size_t) { add(array); });
        FarExt::internal::Level::ForEachTag(level, [this](auto const &array) { add(array); });
        add(level.faceSizes);
        if (depth < refiner.GetMaxLevel()) {
            FarExt::internal::Refinement::ForEachArray(mesh.refinements[std::size_t(depth)],
                                                       [this](auto const &array) { add(array); });
        }
    }
    bool operator==(Arrays const &other) const { return arrays == other.arrays; }

private:
    template <typename ARRAY>
    void add(ARRAY const &array) {
        auto const *const bytes = reinterpret_cast<std::byte const *>(array.data());
        arrays.emplace_back(bytes, bytes + array.size() * sizeof(*array.data()));
    }
};

Result gather(FarExt::TopologyRefiner const &refiner) {
    Result result;
    FarExt::TopologyLevel const &level = refiner.GetLevel(refiner.GetMaxLevel());
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        result.relations.push_back(copy(level.GetVertexFaces(v)));
        result.relations.push_back(copy(level.GetVertexEdges(v)));
    }
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        result.relations.push_back(copy(level.GetFaceVertices(f)));
        result.relations.push_back(copy(level.GetFaceEdges(f)));
    }
    auto const table = FarExt::StencilTableFactory::Create(refiner);
    result.indices = table->GetControlIndices();
    result.weights = table->GetWeights();
    return result;
}

/// A grid of up to \p size x \p size quads.
Shape makeGridWithHoles(int size) {
    Shape grid;
    grid.name = "grid";
    for (int i = 0; i < (size + 1) * (size + 1); ++i) {
        grid.positions.insert(grid.positions.end(), {double(i % size), double(i / size), 0});
    }
    for (int u = 0; u < size; ++u) {
        for (int v = 0; v < size; ++v) {
            int const corner = u * (size + 1) + v;
            if (u % 7 != 3 || v % 5 != 2) {
                grid.faceSizes.push_back(4);
                for (int step : {0, size + 1, size + 2, 1}) {
                    grid.faceVertices.push_back(corner + step);
                }
            }
        }
    }
    return grid;
}

/// create() gives a refined refiner.
template <typename CREATE>
void expectSameBits(CREATE const &create) {
    FarExt::SetNumThreads(1);
    Result const expected = gather(*create());
    for (int numThreads : {2, 3, 8}) {
        SCOPED_TRACE(std::to_string(numThreads) + " threads");
        FarExt::SetNumThreads(numThreads);
        ASSERT_TRUE(gather(*create()) == expected);
    }
}

} // namespace

// Level 5 of these has more than 20,000 faces, enough for many ranges of work.
TEST(Determinism, SameBitsForAnyNumberOfThreads) {
    for (char const *name : {"dodecahedron", "quadGrid"}) {
        SCOPED_TRACE(name);
        expectSameBits([&] {
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
            return CreateRefiner(GetShape(name), ReferenceMask::Smooth, 5, options);
        });
    }
}

namespace {

/// \p shape with a vertex in the middle of every edge, which has two faces.
Shape splitEdges(Shape shape) {
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    FarExt::TopologyLevel const &level = refiner->GetLevel(0);
    std::vector<int> faceVertices;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        for (int i = 0; i < level.GetFaceVertices(f).size(); ++i) {
            faceVertices.push_back(level.GetFaceVertices(f)[i]);
            faceVertices.push_back(level.GetNumVertices() + level.GetFaceEdges(f)[i]);
        }
        shape.faceSizes[f] *= 2;
    }
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        auto const vertices = level.GetEdgeVertices(e);
        for (int k = 0; k < 3; ++k) {
            shape.positions.push_back(
                (shape.positions[3 * vertices[0] + k] + shape.positions[3 * vertices[1] + k]) / 2);
        }
    }
    shape.faceVertices = std::move(faceVertices);
    return shape;
}

/// refine(refiner, fullTopology) makes the same levels of \p shape with any number of threads, of
/// which the last step has work for several, and the same faces without full topology.
template <typename REFINE>
void expectSameLevels(Shape const &shape, FarExt::HexSchemeOptions schemeOptions,
                      REFINE const &refine) {
    auto const create = [&](int numThreads, bool fullTopology) {
        FarExt::SetNumThreads(numThreads);
        auto refiner =
            CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options(), schemeOptions);
        EXPECT_TRUE(refine(*refiner, fullTopology));
        return refiner;
    };
    auto const expected = create(1, true);
    int const maxLevel = expected->GetMaxLevel();
    FarExt::TopologyLevel const &last = expected->GetLevel(maxLevel);
    EXPECT_TRUE(last.Validate());
    EXPECT_GT(expected->GetLevel(maxLevel - 1).GetNumFaces(), 16384);
    for (int numThreads : {1, 2, 3, 8}) {
        SCOPED_TRACE(std::to_string(numThreads) + " threads");
        auto const refiner = create(numThreads, true);
        for (int level = 0; level <= maxLevel; ++level) {
            ASSERT_TRUE(Arrays(*refiner, level) == Arrays(*expected, level));
        }
        auto const facesAlone = create(numThreads, false);
        FarExt::TopologyLevel const &faces = facesAlone->GetLevel(maxLevel);
        EXPECT_FALSE(faces.HasFullTopology());
        EXPECT_EQ(Arrays(*facesAlone, maxLevel).arrays[0], Arrays(*expected, maxLevel).arrays[0]);
        EXPECT_EQ(Arrays(*facesAlone, maxLevel).arrays[1], Arrays(*expected, maxLevel).arrays[1]);
        EXPECT_EQ(faces.GetNumEdges(), last.GetNumEdges());
        EXPECT_EQ(faces.GetNumBoundaryEdges(), last.GetNumBoundaryEdges());
        EXPECT_EQ(faces.GetLevel().faceSizes, last.GetLevel().faceSizes);
    }
}

} // namespace

TEST(Determinism, SameBitsOfOtherSchemes) {
    FarExt::HexSchemeOptions const schemes[] = {
        {FarExt::FaceMask::Smooth, FarExt::SchemeType::DooSabin, FarExt::FirstStep::Same},
        {FarExt::FaceMask::Smooth, FarExt::SchemeType::TriHex, FarExt::FirstStep::Same},
        {FarExt::FaceMask::Smooth, FarExt::SchemeType::Hexagonal, FarExt::FirstStep::TriHex},
        {FarExt::FaceMask::Smooth, FarExt::SchemeType::Hexagonal, FarExt::FirstStep::Truncate}};
    Shape const shapes[] = {MakeBox(54, 54, 54), splitEdges(MakeBox(54, 54, 54)),
                            makeGridWithHoles(140)};
    for (FarExt::HexSchemeOptions const &scheme : schemes) {
        SCOPED_TRACE(testing::Message()
                     << "scheme " << int(scheme.schemeType) << ", first " << int(scheme.firstStep));
        expectSameBits([&] {
            return CreateRefiner(GetShape("quadGrid"), ReferenceMask::Smooth, 5, Sdc::Options(),
                                 scheme);
        });
        for (Shape const &shape : shapes) {
            SCOPED_TRACE(shape.name + ", " + std::to_string(shape.GetNumFaces()) + " faces");
            expectSameLevels(shape, scheme,
                             [](FarExt::TopologyRefiner &refiner, bool fullTopology) {
                                 FarExt::TopologyRefiner::UniformOptions options(1);
                                 options.fullTopologyInLastLevel = fullTopology;
                                 return refiner.RefineUniform(options);
                             });
        }
    }
}

TEST(Determinism, SameBitsOfCoplanarRefinement) {
    Shape const box = MakeBox(3, 4, 5);
    Shape const shapes[] = {MakeBox(54, 54, 54), splitEdges(MakeBox(54, 54, 54)),
                            makeGridWithHoles(140)};
    for (bool closeGaps : {true, false}) {
        SCOPED_TRACE(closeGaps ? "closed" : "open");
        expectSameBits([&] {
            auto refiner = CreateRefiner(box, ReferenceMask::Smooth, 0);
            FarExt::TopologyRefiner::CoplanarOptions options(4);
            options.closeGaps = closeGaps;
            options.fullTopologyInLastLevel = true;
            EXPECT_TRUE(refiner->RefineCoplanar(box.positions.data(), options));
            return refiner;
        });
        for (Shape const &shape : shapes) {
            SCOPED_TRACE(shape.name + ", " + std::to_string(shape.GetNumFaces()) + " faces");
            expectSameLevels(shape, FarExt::HexSchemeOptions(),
                             [&](FarExt::TopologyRefiner &refiner, bool fullTopology) {
                                 FarExt::TopologyRefiner::CoplanarOptions options(1);
                                 options.closeGaps = closeGaps;
                                 options.fullTopologyInLastLevel = fullTopology;
                                 return refiner.RefineCoplanar(shape.positions.data(), options);
                             });
        }
    }
}

// Level 7 of these takes more than the 16 MB from which on levels are written past the caches.
TEST(Determinism, LargeLevelsAreValidAndTheSame) {
    for (char const *name : {"dodecahedron", "quadGrid"}) {
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY}) {
            SCOPED_TRACE(std::string(name) + ", boundary option " + std::to_string(boundary));
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(boundary);
            auto const refiner = CreateRefiner(GetShape(name), ReferenceMask::Smooth, 0, options);
            FarExt::TopologyRefiner::UniformOptions uniform(7);
            uniform.fullTopologyInLastLevel = true;
            FarExt::SetNumThreads(1);
            ASSERT_TRUE(refiner->RefineUniform(uniform));
            FarExt::TopologyLevel const &level = refiner->GetLevel(7);
            EXPECT_GT(level.GetLevel().memory.size(), std::size_t(16) << 20);
            FarExt::CallStatus status;
            EXPECT_TRUE(level.Validate(&status)) << status.GetErrorMessage();
            Arrays const expected(*refiner, 7);
            for (int numThreads : {2, 3, 8}) {
                SCOPED_TRACE(std::to_string(numThreads) + " threads");
                FarExt::SetNumThreads(numThreads);
                ASSERT_TRUE(refiner->RefineUniform(uniform));
                ASSERT_TRUE(Arrays(*refiner, 7) == expected);
                // Without the relations: the same faces, in the same memory.
                ASSERT_TRUE(refiner->RefineUniform(7));
                Arrays const faces(*refiner, 7);
                EXPECT_EQ(faces.arrays[0], expected.arrays[0]);
                EXPECT_EQ(faces.arrays[1], expected.arrays[1]);
                EXPECT_TRUE(faces.arrays[2].empty());
            }
        }
    }
}

TEST(Determinism, SameImportForAnyNumberOfThreads) {
    Shape const grid = makeGridWithHoles(160); // many ranges of work
    FarExt::SetNumThreads(1);
    auto const expected = CreateRefiner(grid, ReferenceMask::Smooth, 0);
    EXPECT_TRUE(expected->GetLevel(0).Validate());
    for (int numThreads : {2, 3, 8}) {
        FarExt::SetNumThreads(numThreads);
        auto const refiner = CreateRefiner(grid, ReferenceMask::Smooth, 0);
        EXPECT_TRUE(Arrays(*refiner, 0) == Arrays(*expected, 0)) << numThreads;
    }
}

// The last step is made of many ranges of work.
TEST(Determinism, SameStencilsForAnyNumberOfThreads) {
    Shape const grid = makeGridWithHoles(48);
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const refiner = CreateRefiner(grid, ReferenceMask::Smooth, 3, sdcOptions);
    ASSERT_GT(refiner->GetLevel(2).GetNumFaces(), 16384);
    std::vector<int> faces;
    for (int face = 0; face < grid.GetNumFaces(); ++face) {
        if (face % 5 != 0) {
            faces.push_back(face);
        }
    }
    FarExt::StencilTableFactory::Options options;
    for (bool isWhole : {true, false}) {
        for (bool hasAllLevels : {true, false}) {
            options.generateIntermediateLevels = hasAllLevels;
            auto const create = [&](int numThreads) {
                FarExt::SetNumThreads(numThreads);
                return isWhole ? FarExt::StencilTableFactory::Create(*refiner, options)
                               : FarExt::StencilTableFactory::CreateOfFaces(
                                     *refiner, {faces.data(), int(faces.size())}, options);
            };
            auto const expected = create(1);
            for (int numThreads : {2, 3, 8}) {
                SCOPED_TRACE(testing::Message() << numThreads << " threads, whole " << isWhole
                                                << ", all levels " << hasAllLevels);
                auto const table = create(numThreads);
                EXPECT_TRUE(table->GetSizes() == expected->GetSizes());
                EXPECT_TRUE(table->GetOffsets() == expected->GetOffsets());
                EXPECT_TRUE(table->GetControlIndices() == expected->GetControlIndices());
                EXPECT_TRUE(table->GetWeights() == expected->GetWeights());
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression::determinismTest

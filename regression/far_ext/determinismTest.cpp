// SPDX-License-Identifier: Apache-2.0
//
// The same bits for any number of threads.
#include "referenceMatch.h"

#include "far_ext/stencilTableFactory.h"
#include "regression/shapes/flatShapes.h"

#include <gtest/gtest.h>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace OpenSubdivHex::Regression {

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

void setNumThreads(int numThreads) {
#ifdef _OPENMP
    omp_set_num_threads(numThreads);
#else
    static_cast<void>(numThreads);
#endif
}

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

/// create() gives a refined refiner.
template <typename CREATE>
void expectSameBits(CREATE const &create) {
    setNumThreads(1);
    Result const expected = gather(*create());
    for (int numThreads : {2, 3, 8}) {
        SCOPED_TRACE(std::to_string(numThreads) + " threads");
        setNumThreads(numThreads);
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

TEST(Determinism, SameBitsOfOtherSchemes) {
    FarExt::SchemeOptions const schemes[] = {
        {FarExt::FaceMask::Smooth, FarExt::SchemeType::DooSabin, false},
        {FarExt::FaceMask::Smooth, FarExt::SchemeType::TriHex, false},
        {FarExt::FaceMask::Smooth, FarExt::SchemeType::Hexagonal, true}};
    for (FarExt::SchemeOptions const &scheme : schemes) {
        SCOPED_TRACE(testing::Message()
                     << "scheme " << int(scheme.schemeType) << ", first " << scheme.triHexFirst);
        expectSameBits([&] {
            return CreateRefiner(GetShape("quadGrid"), ReferenceMask::Smooth, 5, Sdc::Options(),
                                 scheme);
        });
    }
}

TEST(Determinism, SameBitsOfCoplanarRefinement) {
    Shape const box = MakeBox(3, 4, 5);
    for (bool closeGaps : {true, false}) {
        expectSameBits([&] {
            auto refiner = CreateRefiner(box, ReferenceMask::Smooth, 0);
            FarExt::TopologyRefiner::CoplanarOptions options(4);
            options.closeGaps = closeGaps;
            options.fullTopologyInLastLevel = true;
            EXPECT_TRUE(refiner->RefineCoplanar(box.positions.data(), options));
            return refiner;
        });
    }
}

} // namespace OpenSubdivHex::Regression

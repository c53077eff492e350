// SPDX-License-Identifier: Apache-2.0
//
// The same bits for any number of threads.
#include "referenceMatch.h"

#include "far_ext/stencilTableFactory.h"
#include "regression/shapes/featureShapes.h"

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

Result compute(Shape const &shape, int numThreads) {
#ifdef _OPENMP
    omp_set_num_threads(numThreads);
#else
    static_cast<void>(numThreads);
#endif
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 5, options);
    Result result;
    FarExt::TopologyLevel const &level = refiner->GetLevel(5);
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        result.relations.push_back(copy(level.GetVertexFaces(v)));
        result.relations.push_back(copy(level.GetVertexEdges(v)));
    }
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        result.relations.push_back(copy(level.GetFaceVertices(f)));
        result.relations.push_back(copy(level.GetFaceEdges(f)));
    }
    auto const table = FarExt::StencilTableFactory::Create(*refiner);
    result.indices = table->GetControlIndices();
    result.weights = table->GetWeights();
    return result;
}

} // namespace

// Level 5 of these has more than 20,000 faces, enough for many ranges of work.
TEST(Determinism, SameBitsForAnyNumberOfThreads) {
    for (char const *name : {"dodecahedron", "quadGrid"}) {
        SCOPED_TRACE(name);
        Shape const &shape = GetShape(name);
        Result const expected = compute(shape, 1);
        for (int numThreads : {2, 3, 8}) {
            SCOPED_TRACE(std::to_string(numThreads) + " threads");
            ASSERT_TRUE(compute(shape, numThreads) == expected);
        }
    }
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "evaluatorWorkspace.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/stencilTableFactory.h>

namespace OpenSubdivHex::Regression {

std::unique_ptr<Far::StencilTable const> MakeHexTable(std::string const &shape, int level) {
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(GetShape(shape)));
    EXPECT_TRUE(refiner->RefineUniform(level));
    return FarExt::StencilTableFactory::Create(*refiner);
}

std::unique_ptr<Far::StencilTable const> MakeCatmarkTable(std::string const &shape, int level) {
    auto const refiner = CreateFarRefiner(GetShape(shape));
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(level));
    return std::unique_ptr<Far::StencilTable const>(Far::StencilTableFactory::Create(*refiner));
}

TestTable MakeRandomTable(int numStencils) {
    int const numSources = 50;
    std::mt19937 random(3);
    auto const below = [&](int n) { return int(random() % unsigned(n)); };
    std::vector<int> sizes;
    std::vector<int> indices;
    while (int(sizes.size()) < numStencils) {
        std::vector<int> list(std::size_t(below(41)));
        std::generate(list.begin(), list.end(), [&] { return below(numSources); });
        int const numRows = std::min(1 + below(9), numStencils - int(sizes.size()));
        for (int row = 0; row < numRows; ++row) {
            if (!list.empty() && below(8) == 0) {
                list[std::size_t(below(int(list.size())))] = below(numSources);
            }
            sizes.push_back(int(list.size()));
            indices.insert(indices.end(), list.begin(), list.end());
        }
    }
    std::uniform_real_distribution<float> any(-1, 1);
    std::vector<float> weights(indices.size());
    std::generate(weights.begin(), weights.end(), [&] { return any(random); });
    return TestTable("random", numSources, sizes, indices, weights);
}

std::vector<TestTable const *> const &GetTestTables() {
    static TestTable const random = MakeRandomTable(600);
    static TestTable const hex("hex", *MakeHexTable("prism5", 2));
    static TestTable const hexOpen("hexOpen", *MakeHexTable("mixedPatch", 1));
    static TestTable const catmark("catmark", *MakeCatmarkTable("prism5", 3));
    static std::vector<TestTable const *> const tables = {&random, &hex, &hexOpen, &catmark};
    return tables;
}

std::vector<Layout> MakeLayouts(int length, int numSources) {
    int const wide = length + 2;
    return {
        {{0, length, length}, {0, length, length}, false, GuardedEnd::Last},
        {{0, length, length}, {0, length, length}, false, GuardedEnd::First},
        {{5, length, length + 3}, {2, length, length + 1}, false, GuardedEnd::Last},
        {{0, length, length}, {numSources * length, length, length}, true, GuardedEnd::Last},
        {{1, length, wide}, {numSources * wide + 2, length, wide}, true, GuardedEnd::First},
    };
}

std::size_t GetNumFloats(Descriptor const &desc, int numElements) {
    return numElements == 0
               ? std::size_t(desc.offset)
               : std::size_t(desc.offset + (numElements - 1) * desc.stride + desc.length);
}

float GetSourceValue(int element, int k) {
    return float((element * 7919 + k * 3571) % 1009) / 500 - 0.8f;
}

void FillSources(float *buffer, Descriptor const &desc, int numSources) {
    for (int i = 0; i < numSources; ++i) {
        for (int k = 0; k < desc.length; ++k) {
            buffer[desc.offset + i * desc.stride + k] = GetSourceValue(i, k);
        }
    }
}

Expected GetExpected(TestTable const &table, int output, int stencil, int k) {
    Expected result;
    std::size_t const first = std::size_t(table.offsets[std::size_t(stencil)]);
    std::size_t const size = std::size_t(table.sizes[std::size_t(stencil)]);
    for (std::size_t j = first; j < first + size; ++j) {
        double const term =
            double((*table.weights[std::size_t(output)])[j]) * GetSourceValue(table.indices[j], k);
        result.value += term;
        result.tolerance += std::abs(term) * 3e-6;
    }
    return result;
}

std::vector<Range> MakeRanges(int numStencils) {
    int const third = numStencils / 3;
    return {{0, numStencils},
            {0, 0},
            {third, third},
            {numStencils, numStencils},
            {0, 1},
            {third, third + 1},
            {third, 2 * third},
            {numStencils - 1, numStencils}};
}

} // namespace OpenSubdivHex::Regression

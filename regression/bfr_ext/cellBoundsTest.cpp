// SPDX-License-Identifier: Apache-2.0
//
// How much control points weigh at most, against their weights.
#include "surfaceFixture.h"

#include "bfr_ext/cell/cellBounds.h"
#include "far_ext/limit/cellPatch.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace OpenSubdivHex::Regression::cellBoundsTest {

using BfrExt::Surface;
using BfrExt::internal::CellBounds;
using BfrExt::internal::CellTypes;

// Where a cell has very many points, they are bounded by one step.
TEST(CellBounds, WeightsAreWithinTheirBoundsBesideLargeFaces) {
    constexpr int kNumSides = 70;
    Shape const shape = MakePrism(kNumSides);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    CellTypes types;
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> distribution(0, 1);
    std::set<int> sizes;
    for (int face = 0; face < refiner->GetLevel(0).GetNumFaces(); ++face) {
        Surface<double> const &surface = surfaces[face];
        if (!sizes.insert(surface.GetFaceSize()).second) {
            continue;
        }
        ASSERT_EQ(surface.GetNumControlPoints(), 2 * kNumSides);
        FarExt::internal::CellPatch cell;
        GatherBaseCell(refiner->GetHierarchy().mesh.levels[0], face, refiner->GetSchemeOptions(),
                       cell);
        CellBounds const bounds(types.Find(std::move(cell), {refiner->GetSchemeOptions(),
                                                             refiner->GetHexSchemeOptions(),
                                                             FarExt::Interpolation::Vertex}));
        std::vector<double> numbers(std::size_t(surface.GetNumControlPoints()));
        std::vector<double> limits;
        for (double &number : numbers) {
            number = 1;
            limits.push_back(bounds.GetMax(numbers, 0));
            number = 0;
        }
        double closest = 0;
        std::vector<double> weights(numbers.size());
        for (int i = 0; i < 200; ++i) {
            double uv[2] = {distribution(random), distribution(random)};
            if (i < surface.GetFaceSize()) {
                surface.GetParameterization().GetVertexCoord(i, uv);
            }
            surface.EvaluateStencil(uv, weights.data());
            for (std::size_t k = 0; k < weights.size(); ++k) {
                ASSERT_LE(weights[k], limits[k] + 1e-12) << "face " << face << ", point " << k;
                closest = std::max(closest, weights[k] / limits[k]);
            }
        }
        EXPECT_GT(closest, 0.5) << "face " << face;
    }
    EXPECT_EQ(sizes, (std::set<int>{4, kNumSides}));
}

} // namespace OpenSubdivHex::Regression::cellBoundsTest

// SPDX-License-Identifier: Apache-2.0
//
// The weights of a frame's limits, and how they lie in memory.
#include "osd_ext/refinement/limitRowWeights.h"
#include "osd_ext/refinement/preparedLimit.h"

#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "osd_ext/device/deviceLimit.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace OpenSubdivHex::Regression::limitKernelTest {

using Far::Index;
using FarExt::internal::LimitRow;
using OsdExt::internal::LimitRowWeights;

// Places of points are counted in floats.
TEST(PreparedLimit, RefusesLevelsWhosePlacesDoNotFit) {
    EXPECT_TRUE(OsdExt::internal::CheckLimitPlaces(0, 1431655765).IsOk());
    FarExt::CallStatus const status = OsdExt::internal::CheckLimitPlaces(2, 1431655766);
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::TooLarge);
    EXPECT_EQ(status.GetComponentIndex(), 2);
    EXPECT_EQ(
        status.GetErrorMessage(),
        "level 2 has 1431655766 vertices, more than the 1431655765 of a level from which limits "
        "can be evaluated");
}

TEST(LimitRowWeights, AreSharedByRowsThatHaveTheSame) {
    Index const sources[] = {5, 6};
    double const same[] = {0.5, 0.5, 1, -1, 2, 0};
    std::vector<double> const copy(std::begin(same), std::end(same));
    std::vector<double> const negative = {0.5, 0.5, 1, -1, 2, -0.0};
    auto const makeRow = [&](double const *weights) {
        return LimitRow{2, sources, weights, weights + 2, weights + 4};
    };
    LimitRowWeights weights;
    EXPECT_EQ(weights.Add(makeRow(same)), 0U);
    EXPECT_EQ(weights.Add(makeRow(copy.data())), 0U);
    EXPECT_EQ(weights.Add(makeRow(negative.data())), 6U);
    EXPECT_EQ(weights.Add(makeRow(same)), 0U);
    std::vector<float> const expected = {0.5, 1, 2, 0.5, -1, 0, 0.5, 1, 2, 0.5, -1, 0};
    EXPECT_EQ(weights.Get(), expected);
    EXPECT_TRUE(std::signbit(weights.Get().back()));
}

// Each thread finds masks for itself: what a device gets is the same for any number of threads.
TEST(DeviceLimit, DoesNotDependOnThreads) {
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask = FarExt::FaceMask::Cosine;
    Shape const torus = MakeTorus(40, 40, TorusFaces::IrregularTriangles);
    auto const refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(torus).Get(),
                                                                Sdc::Options(), options);
    FarExt::TopologyRefiner::UniformOptions uniform(1);
    uniform.fullTopologyInLastLevel = true;
    ASSERT_TRUE(refiner && refiner->RefineUniform(uniform));
    FarExt::internal::MeshLevels const &mesh = refiner->GetHierarchy().mesh;
    OsdExt::internal::DeviceLimit limits[2];
    for (OsdExt::internal::DeviceLimit &limit : limits) {
        FarExt::SetNumThreads(&limit == limits ? 1 : 4);
        FarExt::internal::LimitRows rows(mesh.levels[1], Sdc::Options(), options.hexSchemeOptions);
        ASSERT_TRUE(MakeDeviceLimit(mesh, options.hexSchemeOptions, rows, limit).IsOk());
    }
    FarExt::SetNumThreads(0);
    EXPECT_EQ(limits[0].weights, limits[1].weights);
    ASSERT_EQ(limits[0].vertices.size(), limits[1].vertices.size());
    EXPECT_FALSE(limits[0].vertices.empty());
    for (std::size_t i = 0; i < limits[0].vertices.size(); ++i) {
        ASSERT_EQ(limits[0].vertices[i].firstWeight, limits[1].vertices[i].firstWeight);
    }
}

} // namespace OpenSubdivHex::Regression::limitKernelTest

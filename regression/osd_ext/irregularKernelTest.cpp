// SPDX-License-Identifier: Apache-2.0
//
// That there are kernels for the irregular faces of the meshes that people have.
#include "osd_ext/refinement/preparedRefinement.h"

#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <vector>

namespace OpenSubdivHex::Regression::irregularKernelTest {

using OsdExt::internal::IrregularFaceMask;

namespace {

// The first patterns, which serve meshes of quads and of triangles.
constexpr int kNumOfTriangles = 2;
constexpr int kNumOfQuads = 8;

} // namespace

// Who changes weights changes the patterns, too: faces have those that are made for them, and not the last
// one, with which they are refined as well but more slowly.
TEST(IrregularKernel, KnowsQuadsAndTriangles) {
    constexpr int kLevel = 5;
    for (TorusFaces faces :
         {TorusFaces::Quads, TorusFaces::Triangles, TorusFaces::IrregularTriangles}) {
        int const numPatterns = faces == TorusFaces::Quads ? kNumOfQuads
                                : faces == TorusFaces::Triangles
                                    ? kNumOfTriangles
                                    : IrregularFaceMask::kNumPatterns - 1;
        Shape const torus = MakeTorus(7, 5, faces);
        FarExt::TopologyRefinerFactory::Options options;
        options.schemeOptions.faceMask = FarExt::FaceMask::Smooth;
        auto const refiner = FarExt::TopologyRefinerFactory::Create(
            ShapeDescriptor(torus).Get(), OpenSubdiv::Sdc::Options(), options);
        ASSERT_TRUE(refiner && refiner->RefineUniform(kLevel));
        FarExt::internal::MeshLevels const &mesh = refiner->GetHierarchy().mesh;
        OsdExt::internal::TileMap tileMap(mesh.levels[0], 1);
        std::vector<FarExt::internal::Refinement const *> refinements;
        for (std::size_t level = 0; level < mesh.refinements.size(); ++level) {
            SCOPED_TRACE(level);
            if (level > 0) {
                tileMap.Refine(*refinements[level - 1],
                               level > 1 ? refinements[level - 2] : nullptr);
            }
            refinements.push_back(&mesh.refinements[level]);
            OsdExt::internal::PreparedRefinement prepared;
            OsdExt::internal::PrepareRefinement(
                FarExt::internal::RefinementMask(mesh.levels[level], options.schemeOptions,
                                                 FarExt::Interpolation::Vertex),
                refinements, tileMap, prepared);
            EXPECT_EQ(prepared.masks.irregularFaces.empty(), level == 0);
            for (IrregularFaceMask const &mask : prepared.masks.irregularFaces) {
                EXPECT_LT(mask.pattern, numPatterns);
            }
            if (level > 0) {
                EXPECT_EQ(prepared.masks.faces[IrregularFaceMask::kSize].opposite, 0);
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression::irregularKernelTest

// SPDX-License-Identifier: Apache-2.0
//
// Plain cells of base faces, against the patches that they are short for.
#include "far_ext/limit/plainCell.h"
#include "far_ext/limit/cellPatch.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <map>

namespace OpenSubdivHex::Regression {

namespace {

/// The signatures of patches, by key.
using Signatures = std::map<std::string, std::vector<int>>;

/// \return  how many of the faces are plain
int expectPatches(Shape const &shape, Signatures &signatures) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, options);
    FarExt::internal::Level const &level = refiner->GetHierarchy().mesh.levels[0];
    auto const marks = FarExt::internal::MarkFeatures(level);
    FarExt::internal::PlainCellGatherer gatherer;
    FarExt::internal::PlainCell plain;
    int numPlain = 0;
    for (int face = 0; face < level.numFaces; ++face) {
        if (!gatherer.Gather(level, marks, face, plain)) {
            continue;
        }
        ++numPlain;
        FarExt::internal::CellPatch cell;
        FarExt::internal::GatherBaseCell(level, face, cell);
        EXPECT_EQ(plain.sources, cell.patch.sources) << "face " << face;
        auto const found = signatures.emplace(plain.key, cell.patch.signature).first;
        EXPECT_EQ(found->second, cell.patch.signature) << "face " << face;
    }
    return numPlain;
}

} // namespace

TEST(PlainCellTest, PatchesOfOneKeyAreTheSame) {
    Signatures signatures;
    for (Shape const &shape : GetShapes()) {
        SCOPED_TRACE(shape.name);
        expectPatches(shape, signatures);
    }
    for (char const *const name : {"mixedSharpnessQuads", "cornersTriangles", "creasedBall"}) {
        SCOPED_TRACE(name);
        expectPatches(GetFeatureShape(name), signatures);
    }
    EXPECT_GT(signatures.size(), 20u);
}

TEST(PlainCellTest, FacesOfClosedMeshesArePlainAndThoseBesideFeaturesAreNot) {
    Signatures signatures;
    EXPECT_EQ(expectPatches(MakeIcosahedron(), signatures), 20);
    EXPECT_EQ(signatures.size(), 1u);
    EXPECT_EQ(expectPatches(GetShape("polygon4"), signatures), 0);
    Shape shape = MakeIcosahedron();
    shape.cornerVertices = {0};
    shape.cornerSharpness = {1.5F};
    // All faces have a corner there or beside it, but those around the vertex across.
    EXPECT_EQ(expectPatches(shape, signatures), 5);
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
//
// Control points that are found on the ways of regular lattices, against the patches of any faces.
#include "bfr_ext/cell/latticeWalk.h"
#include "far_ext/limit/plainCell.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace OpenSubdivHex::Regression {

using BfrExt::internal::CellType;
using BfrExt::internal::CellTypes;
using BfrExt::internal::LatticeWalk;

namespace {

/// A torus whose faces begin at any corner.
Shape makeTurnedTorus(int numU, int numV, TorusFaces faces) {
    Shape shape = MakeTorus(numU, numV, faces);
    std::mt19937 random;
    auto first = shape.faceVertices.begin();
    for (int size : shape.faceSizes) {
        std::rotate(first, first + int(random() % unsigned(size)), first + size);
        first += size;
    }
    return shape;
}

/// \return  how many of the faces have the way of \p type, which has one
int expectPatches(Shape const &shape, CellTypes &types, CellType const &type) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, options);
    FarExt::internal::Level const &level = refiner->GetHierarchy().mesh.levels[0];
    auto const marks = FarExt::internal::MarkFeatures(level);
    LatticeWalk const walk(type);
    FarExt::internal::PlainCellGatherer gatherer;
    FarExt::internal::PlainCell plain;
    int numFound = 0;
    for (int face = 0; face < level.numFaces; ++face) {
        FarExt::internal::CellPatch cell;
        GatherBaseCell(level, face, cell);
        std::vector<int> const sources = cell.patch.sources;
        CellType const &ownType = types.Find(std::move(cell), {});
        std::vector<Far::Index> points(LatticeWalk::kMaxPoints);
        std::vector<int> turns(12);
        bool const isFound = walk.Gather(level, marks, face, points.data(), turns.data());
        // Faces at what is no feature after all are not looked for.
        bool const isPlain = gatherer.Gather(level, marks, face, plain);
        EXPECT_EQ(isFound, isPlain && &ownType == &type) << "face " << face;
        if (!isFound) {
            continue;
        }
        ++numFound;
        points.resize(std::size_t(walk.GetNumPoints()));
        EXPECT_EQ(points, sources) << "face " << face;
        std::vector<int> expectedTurns(12);
        FindBaseCellTurns(level, face, expectedTurns.data());
        EXPECT_EQ(turns, expectedTurns) << "face " << face;
    }
    return numFound;
}

/// The type of face 0.
CellType const &findType(Shape const &shape, CellTypes &types) {
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, {});
    FarExt::internal::CellPatch cell;
    GatherBaseCell(refiner->GetHierarchy().mesh.levels[0], 0, cell);
    return types.Find(std::move(cell), {});
}

} // namespace

TEST(LatticeWalkTest, FindsThePointsOfPatches) {
    Shape const quads = makeTurnedTorus(9, 7, TorusFaces::Quads);
    Shape const triangles = makeTurnedTorus(8, 9, TorusFaces::Triangles);
    Shape const hexagons = MakeDual("hexagons", triangles);
    CellTypes types;
    for (Shape const *const lattice : {&quads, &triangles, &hexagons}) {
        CellType const &type = findType(*lattice, types);
        ASSERT_TRUE(LatticeWalk::HasWalk(type));
        EXPECT_EQ(expectPatches(*lattice, types, type), lattice->GetNumFaces());
        // Where something is sharp, where other valences are near, and on small tori, whose patches have
        // a vertex in several places.
        Shape sharp = *lattice;
        sharp.cornerVertices = {0};
        sharp.cornerSharpness = {1.5F};
        int const numFound = expectPatches(sharp, types, type);
        EXPECT_GT(numFound, 0);
        EXPECT_LT(numFound, lattice->GetNumFaces());
        for (Shape const &shape : GetShapes()) {
            SCOPED_TRACE(shape.name);
            expectPatches(shape, types, type);
        }
        for (int size = 2; size <= 6; ++size) {
            SCOPED_TRACE(size);
            expectPatches(makeTurnedTorus(size, 9, TorusFaces::Quads), types, type);
            expectPatches(makeTurnedTorus(size, 7, TorusFaces::Triangles), types, type);
        }
        expectPatches(GetFeatureShape("creasedBall"), types, type);
    }
}

} // namespace OpenSubdivHex::Regression

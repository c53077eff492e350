// SPDX-License-Identifier: Apache-2.0
//
// Faces with equal neighbourhoods have equal limits; which faces make which vertices.
#include "far_ext/limit/plainFaces.h"
#include "regression/far_ext/expectedRows.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Regression::plainFacesTest {

using FarExt::TopologyRefiner;
using FarExt::internal::LimitRows;
using FarExt::internal::PlainFaces;
using FarExt::internal::SteppedRow;

namespace {

PlainFaces findFaces(TopologyRefiner const &refiner, std::vector<unsigned char> isMade = {}) {
    PlainFaces faces(refiner.GetHierarchy().mesh, refiner.GetMaxLevel(), std::move(isMade));
    LimitRows rows = MakeLimitRows(refiner);
    if (!faces.FindRows(refiner.GetHexSchemeOptions(), rows).IsOk()) {
        throw std::runtime_error("no rows");
    }
    return faces;
}

// Compares all rows, and sees that each vertex is made once, or is among the others.
void expectRows(TopologyRefiner const &refiner, PlainFaces const &faces) {
    ExpectedRows const expected(refiner, faces.GetLevel());
    std::vector<int> made(std::size_t(refiner.GetLevel(refiner.GetMaxLevel()).GetNumVertices()), 0);
    for (PlainFaces::Face const &face : faces.GetFaces()) {
        PlainFaces::Type const &type = faces.GetTypes()[std::size_t(face.type)];
        ASSERT_EQ(type.rows.size(), std::size_t(type.numOutputs));
        for (int output = 0; output < type.numOutputs; ++output) {
            Far::Index const vert = faces.GetOutputs(face)[output];
            if (vert == Far::INDEX_INVALID) {
                continue;
            }
            ++made[std::size_t(vert)];
            SteppedRow row;
            for (int i = 0; i < type.numSources; ++i) {
                row[faces.GetSources(face)[i]] = type.rows[std::size_t(output)][std::size_t(i)];
            }
            ASSERT_EQ(row.size(), std::size_t(type.numSources));
            ASSERT_NO_FATAL_FAILURE(expected.Expect(vert, row));
        }
    }
    for (Far::Index const vert : faces.GetOthers()) {
        ++made[std::size_t(vert)];
    }
    for (std::size_t vert = 0; vert < made.size(); ++vert) {
        ASSERT_EQ(made[vert], 1) << "vertex " << vert;
    }
}

} // namespace

TEST(PlainFaces, OfATypeHaveTheRowsOfTheLevel) {
    Shape const triangles = MakeTorus(9, 8, TorusFaces::IrregularTriangles);
    Shape quads = MakeTorus(9, 8, TorusFaces::Quads);
    quads.cornerVertices = {4 * 8 + 4};
    quads.cornerSharpness = {1.5f};
    for (Shape const &shape :
         {triangles, quads, MakeDual("dual", triangles), GetShape("hexGrid"), MakeIcosahedron()}) {
        for (auto mask : kMasks) {
            for (int level = 1; level <= 3; ++level) {
                SCOPED_TRACE(testing::Message()
                             << shape.name << ", mask " << int(mask) << ", level " << level);
                auto const refiner = CreateRefiner(shape, mask, level);
                PlainFaces const faces = findFaces(*refiner);
                EXPECT_EQ(faces.GetLevel(), level == 1 ? 0 : 1);
                ASSERT_NO_FATAL_FAILURE(expectRows(*refiner, faces));
            }
        }
    }
}

// All faces of level 1 are alike, but for being triangles or hexagons and the first of vertices or not.
TEST(PlainFaces, MakeAllWhereTypesAreShared) {
    auto const refiner =
        CreateRefiner(MakeTorus(12, 10, TorusFaces::Triangles), ReferenceMask::Average, 3);
    PlainFaces const faces = findFaces(*refiner);
    EXPECT_LE(faces.GetTypes().size(), 32u);
    EXPECT_GT(faces.GetFaces().size(), 0.9 * refiner->GetLevel(1).GetNumFaces());
    EXPECT_LT(faces.GetOthers().size(), 0.1 * refiner->GetLevel(3).GetNumVertices());
}

// Vertices that are made otherwise are made by no face.
TEST(PlainFaces, LeaveWhatIsMadeOtherwise) {
    auto const refiner =
        CreateRefiner(MakeTorus(9, 8, TorusFaces::Triangles), ReferenceMask::Average, 3);
    int const numVertices = refiner->GetLevel(3).GetNumVertices();
    std::vector<unsigned char> isMade(std::size_t(numVertices), 1);
    EXPECT_TRUE(findFaces(*refiner, isMade).GetFaces().empty());
    auto const isLeft = [](Far::Index vert) { return vert % 7 == 0; };
    for (Far::Index vert = 0; vert < numVertices; ++vert) {
        isMade[std::size_t(vert)] = !isLeft(vert);
    }
    PlainFaces const faces = findFaces(*refiner, isMade);
    ASSERT_FALSE(faces.GetFaces().empty());
    std::ptrdiff_t numMade = 0;
    for (PlainFaces::Face const &face : faces.GetFaces()) {
        int const numOutputs = faces.GetTypes()[std::size_t(face.type)].numOutputs;
        Far::Index const *const outputs = faces.GetOutputs(face);
        numMade += std::count_if(outputs, outputs + numOutputs, [&](Far::Index vert) {
            return vert != Far::INDEX_INVALID && isLeft(vert);
        });
        EXPECT_TRUE(std::all_of(outputs, outputs + numOutputs, [&](Far::Index vert) {
            return vert == Far::INDEX_INVALID || isLeft(vert);
        }));
    }
    EXPECT_EQ(numMade + std::ptrdiff_t(faces.GetOthers().size()), (numVertices + 6) / 7);
}

// Behind a step that is none of hexagons faces begin with the level that it makes.
TEST(PlainFaces, AreBehindAFirstStep) {
    FarExt::HexSchemeOptions options;
    options.firstStep = FarExt::FirstStep::Truncate;
    auto const refiner = CreateRefiner(MakeTorus(9, 8, TorusFaces::Triangles),
                                       ReferenceMask::Smooth, 2, Sdc::Options(), options);
    PlainFaces const faces = findFaces(*refiner);
    EXPECT_EQ(faces.GetLevel(), 1);
    EXPECT_FALSE(faces.GetFaces().empty());
    expectRows(*refiner, faces);
}

} // namespace OpenSubdivHex::Regression::plainFacesTest

// SPDX-License-Identifier: Apache-2.0
//
// Which vertices of a level have a limit that follows from regular faces of the levels before.
#include "far_ext/limit/regularFaces.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Regression::regularFacesTest {

using FarExt::TopologyRefiner;
using FarExt::internal::LimitRows;
using FarExt::internal::RegularFaces;

namespace {

RegularFaces findFaces(TopologyRefiner const &refiner) {
    auto const &mesh = refiner.GetHierarchy().mesh;
    int const level = refiner.GetMaxLevel();
    RegularFaces faces(mesh, level);
    LimitRows rows(mesh.levels[std::size_t(level)], refiner.GetSchemeOptions(),
                   refiner.GetHexSchemeOptions());
    if (!faces.FindMasks(refiner.GetHexSchemeOptions(), rows).IsOk()) {
        throw std::runtime_error("no masks");
    }
    return faces;
}

std::size_t countFaces(RegularFaces const &faces, int level) {
    return faces.GetLevels()[std::size_t(level)].fVertices.faces.size();
}

} // namespace

// All faces are regular there, and what they do not make are the vertices of level 0.
TEST(RegularFaces, AreAllOfATorusOfHexagons) {
    auto const refiner = CreateRefiner(GetShape("hexTorus"), ReferenceMask::Smooth, 3);
    RegularFaces const faces = findFaces(*refiner);
    for (int level = 0; level < 3; ++level) {
        EXPECT_EQ(countFaces(faces, level), std::size_t(refiner->GetLevel(level).GetNumFaces()));
    }
    std::vector<Far::Index> const &others = faces.GetOthers();
    EXPECT_EQ(others.size(), std::size_t(refiner->GetLevel(0).GetNumVertices()));
    EXPECT_EQ(others.back() + 1, refiner->GetLevel(0).GetNumVertices());
    EXPECT_TRUE(std::is_sorted(others.begin(), others.end()));
}

// A pentagon has five faces around it, and five further ones with a neighbour of one of its vertices:
// from level 2 on, where these are hexagons for each of twelve pentagons, all but they are regular.
TEST(RegularFaces, AreAllThatAreNotNearAPentagon) {
    auto const refiner = CreateRefiner(GetShape("dodecahedron"), ReferenceMask::Average, 5);
    RegularFaces const faces = findFaces(*refiner);
    EXPECT_EQ(countFaces(faces, 0), 0u);
    for (int level : {3, 4}) {
        EXPECT_EQ(countFaces(faces, level),
                  std::size_t(refiner->GetLevel(level).GetNumFaces() - 12 * 11))
            << "level " << level;
    }
}

// Where all vertices have three faces, every vertex is regular once hexagons are all around: all but those
// of level 0 and the corners of F-faces of pentagons.
TEST(RegularFaces, LeaveTheCornersOfPentagons) {
    for (ReferenceMask mask : {ReferenceMask::Average, ReferenceMask::Smooth}) {
        auto const refiner = CreateRefiner(GetShape("dodecahedron"), mask, 5);
        RegularFaces const faces = findFaces(*refiner);
        EXPECT_EQ(faces.GetOthers().size(), 20u + 5 * 60u);
    }
}

// Vertices with four faces leave one corner for each of them at every level, besides the triangles: two
// in the hexagons of level 1, one in those of further levels.
TEST(RegularFaces, GiveSomeOfTheirOwnVertices) {
    auto const refiner = CreateRefiner(GetShape("octahedron"), ReferenceMask::Average, 4);
    RegularFaces const faces = findFaces(*refiner);
    for (int level = 0; level < 2; ++level) {
        EXPECT_TRUE(faces.GetLevels()[std::size_t(level)].ownVertices.faces.empty());
    }
    std::vector<int> made(std::size_t(refiner->GetLevel(4).GetNumVertices()), 0);
    auto const ofFace = [&](RegularFaces::Set const &set,
                            FarExt::internal::RegularFace const &face) {
        return made.begin() + set.firstVertex + face.firstCorner;
    };
    for (int level = 2; level <= 4; ++level) {
        RegularFaces::Set const &set = faces.GetLevels()[std::size_t(level)].ownVertices;
        std::size_t numPartial = 0;
        for (auto const &face : set.faces) {
            int numCorners = 0;
            for (int corner = 0; corner < 6; ++corner) {
                bool const isMade = (face.corners >> corner & 1) != 0;
                numCorners += int(isMade);
                ofFace(set, face)[corner] += int(isMade);
            }
            EXPECT_GE(numCorners, level == 2 ? 4 : 5);
            numPartial += std::size_t(numCorners < 6);
        }
        EXPECT_EQ(numPartial, level == 2 ? 12u : 24u) << "level " << level;
        auto const &fVertices = faces.GetLevels()[std::size_t(level)].fVertices;
        for (auto const &face : fVertices.faces) {
            for (int corner = 0; corner < 6; ++corner) {
                ++ofFace(fVertices, face)[corner];
            }
        }
    }
    for (Far::Index const vert : faces.GetOthers()) {
        ++made[std::size_t(vert)];
    }
    EXPECT_EQ(faces.GetOthers().size(), 6u + 24u + 3 * 48u);
    EXPECT_EQ(std::count(made.begin(), made.end(), 1), std::ptrdiff_t(made.size()));
}

// Its masks weigh opposite vertices of hexagons more than others.
TEST(RegularFaces, AreNoneForTheCosineMask) {
    auto const refiner = CreateRefiner(GetShape("hexTorus"), ReferenceMask::Cosine, 2);
    RegularFaces const faces = findFaces(*refiner);
    EXPECT_EQ(countFaces(faces, 0) + countFaces(faces, 1), 0u);
    EXPECT_EQ(faces.GetOthers().size(), std::size_t(refiner->GetLevel(2).GetNumVertices()));
}

} // namespace OpenSubdivHex::Regression::regularFacesTest

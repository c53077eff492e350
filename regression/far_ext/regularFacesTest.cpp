// SPDX-License-Identifier: Apache-2.0
//
// Which vertices of a level have a limit that follows from regular faces, or from themselves, of the
// levels before.
#include "far_ext/limit/regularFaces.h"
#include "far_ext/limit/regularVertices.h"
#include "far_ext/limit/rowSteps.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Regression::regularFacesTest {

using FarExt::TopologyRefiner;
using FarExt::internal::LimitRows;
using FarExt::internal::RegularFaces;
using FarExt::internal::RegularVertices;
using FarExt::internal::SteppedRow;

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

// Those of all vertices of the last level, each of which must have the row in terms of level 0 that it
// has from the last level.
RegularVertices findVertices(TopologyRefiner const &refiner) {
    auto const &mesh = refiner.GetHierarchy().mesh;
    auto const &schemeOptions = refiner.GetHexSchemeOptions();
    int const last = refiner.GetMaxLevel();
    LimitRows rows(mesh.levels[std::size_t(last)], refiner.GetSchemeOptions(), schemeOptions);
    if (!rows.Find().IsOk()) {
        throw std::runtime_error("no masks");
    }
    std::vector<Far::Index> verts(std::size_t(mesh.levels[std::size_t(last)].numVertices));
    std::iota(verts.begin(), verts.end(), 0);
    RegularVertices vertices(mesh, schemeOptions, rows, verts);
    std::size_t numVertices = vertices.GetOthers().size();
    for (int level = 0; level < last; ++level) {
        numVertices += vertices.GetVertices(level).size();
        for (Far::Index const vert : vertices.GetVertices(level)) {
            Far::Index sources[FarExt::internal::PlainNeighborhoodGatherer::kNumRegular];
            SteppedRow row = FarExt::internal::StepRowBack(mesh, schemeOptions,
                                                           rows.GetRow(vert, 0, sources), last, 0);
            for (auto const &[source, weights] : FarExt::internal::StepRowBack(
                     mesh, schemeOptions, vertices.GetRow(level, vert, sources), level, 0)) {
                for (std::size_t i = 0; i < weights.size(); ++i) {
                    row[source][i] -= weights[i];
                }
            }
            for (auto const &[source, weights] : row) {
                for (double const weight : weights) {
                    EXPECT_NEAR(weight, 0, 1e-8) << "vertex " << vert << " of level " << level;
                }
            }
        }
    }
    EXPECT_EQ(numVertices, verts.size());
    return vertices;
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

// Whatever the mask, vertices among hexagons are regular where they come from.
TEST(RegularVertices, AreAllThatATorusOfHexagonsHadBefore) {
    for (ReferenceMask mask : {ReferenceMask::Smooth, ReferenceMask::Cosine}) {
        auto const refiner = CreateRefiner(GetShape("hexTorus"), mask, 2);
        RegularVertices const vertices = findVertices(*refiner);
        std::vector<Far::Index> const &ofBase = vertices.GetVertices(0);
        EXPECT_EQ(ofBase.size(), std::size_t(refiner->GetLevel(0).GetNumVertices()));
        EXPECT_EQ(vertices.GetOthers().front(), refiner->GetLevel(1).GetNumVertices());
    }
}

// The corners of a cube have three faces, and hexagons around all their neighbours from level 2 on; so
// have, one level later each, those of the quads of a level.
TEST(RegularVertices, AreOfTheFirstLevelInWhichTheyAreRegular) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Smooth, 4);
    RegularVertices const vertices = findVertices(*refiner);
    EXPECT_TRUE(vertices.GetVertices(0).empty());
    EXPECT_TRUE(vertices.GetVertices(1).empty());
    ASSERT_GE(vertices.GetVertices(2).size(), 8u);
    EXPECT_EQ(vertices.GetVertices(2)[7], 7);
    std::vector<Far::Index> const &ofLevel3 = vertices.GetVertices(3);
    EXPECT_EQ(std::count_if(ofLevel3.begin(), ofLevel3.end(),
                            [&](int vert) { return vert < refiner->GetLevel(1).GetNumVertices(); }),
              24);
}

// Its masks weigh opposite vertices of hexagons more than others.
TEST(RegularFaces, AreNoneForTheCosineMask) {
    auto const refiner = CreateRefiner(GetShape("hexTorus"), ReferenceMask::Cosine, 2);
    RegularFaces const faces = findFaces(*refiner);
    EXPECT_EQ(countFaces(faces, 0) + countFaces(faces, 1), 0u);
    EXPECT_EQ(faces.GetOthers().size(), std::size_t(refiner->GetLevel(2).GetNumVertices()));
}

} // namespace OpenSubdivHex::Regression::regularFacesTest

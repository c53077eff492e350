// SPDX-License-Identifier: Apache-2.0
//
// Which faces of level 0 lie in a regular lattice, and that what they make is the limit of all vertices
// in them.
#include "far_ext/limit/latticeFaces.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/expectedRows.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Regression::latticeFacesTest {

using FarExt::TopologyRefiner;
using FarExt::internal::LatticeFaces;
using FarExt::internal::LatticePatch;
using FarExt::internal::LimitRow;
using FarExt::internal::LimitRows;
using FarExt::internal::LimitWeights;
using FarExt::internal::SteppedRow;

namespace {

LatticeFaces findFaces(TopologyRefiner const &refiner) {
    LatticeFaces faces(refiner.GetHierarchy().mesh, refiner.GetMaxLevel());
    LimitRows rows = MakeLimitRows(refiner);
    if (!faces.FindMasks(refiner.GetHexSchemeOptions(), rows).IsOk()) {
        throw std::runtime_error("no masks");
    }
    return faces;
}

std::size_t countFaces(LatticeFaces const &faces) {
    std::size_t count = 0;
    for (LatticeFaces::Set const &set : faces.GetSets()) {
        count += set.faces.size();
    }
    return count;
}

/// The row of an output: number \p corner of an orbit, or of the mirror images in it.
SteppedRow makeRow(LatticePatch const &patch, LatticeFaces::Orbit const &orbit, int corner,
                   bool isImage, Far::Index const *sources) {
    SteppedRow row;
    for (int place = 0; place < patch.GetNumPlaces(); ++place) {
        LimitWeights const &from = orbit.weights[std::size_t(place)];
        LimitWeights weights = from;
        for (std::size_t i = 0; i < 2 && (isImage || !orbit.isPair); ++i) {
            weights[1 + i] = orbit.derivatives[i][0] * from[1] + orbit.derivatives[i][1] * from[2];
        }
        int const turned = patch.TurnPlace(isImage ? patch.MirrorPlace(place) : place, corner);
        row[sources[turned]] = weights;
    }
    return row;
}

// Compares all rows, and counts what makes each vertex.
void expectRows(TopologyRefiner const &refiner, LatticeFaces const &faces) {
    ExpectedRows const expected(refiner, 0);
    std::vector<int> made(std::size_t(refiner.GetLevel(refiner.GetMaxLevel()).GetNumVertices()), 0);
    for (LatticeFaces::Set const &set : faces.GetSets()) {
        int const faceSize = set.patch.GetFaceSize();
        ASSERT_TRUE(
            std::is_sorted(set.orbits.begin(), set.orbits.end(), [](auto const &a, auto const &b) {
                return int(a.isPair) > int(b.isPair);
            }));
        for (std::size_t face = 0; face < set.faces.size(); ++face) {
            Far::Index const *const sources =
                set.sources.data() + face * std::size_t(set.patch.GetNumPlaces());
            Far::Index const *const outputs =
                set.outputs.data() + face * std::size_t(set.numOutputs);
            Far::Index const inside = outputs[set.numOutputs - faceSize];
            Far::Index const *next = outputs;
            for (LatticeFaces::Orbit const &orbit : set.orbits) {
                for (bool const isImage : {false, true}) {
                    for (int corner = 0; corner < faceSize && (orbit.isPair || !isImage);
                         ++corner, ++next) {
                        bool const isFilling =
                            *next == inside && next != outputs + set.numOutputs - faceSize;
                        if (!isFilling) {
                            ++made[std::size_t(*next)];
                            ASSERT_NO_FATAL_FAILURE(expected.Expect(
                                *next, makeRow(set.patch, orbit, corner, isImage, sources)));
                        }
                    }
                }
            }
            ASSERT_EQ(next, outputs + set.numOutputs);
        }
    }
    for (Far::Index const vert : faces.GetVertices()) {
        ++made[std::size_t(vert)];
        Far::Index sources[LatticePatch::kMaxPlaces];
        LimitRow const of = faces.GetRow(vert, sources);
        SteppedRow row;
        for (int i = 0; i < of.size; ++i) {
            row[of.sources[i]] = {of.weights[i], of.du[i], of.dv[i]};
        }
        ASSERT_NO_FATAL_FAILURE(expected.Expect(vert, row));
        LatticeFaces::VertexPlace const place = faces.FindPlace(vert);
        ASSERT_NE(place.set, nullptr);
        LatticeFaces::Set const &set = *place.set;
        if (set.corners) {
            Far::Index const *const ofFace =
                set.sources.data() + place.face * std::size_t(set.patch.GetNumPlaces());
            ASSERT_EQ(ofFace[place.corner], vert);
            ASSERT_NO_FATAL_FAILURE(expected.Expect(
                vert, makeRow(set.patch, *set.corners, place.corner, false, ofFace)));
        }
    }
    ASSERT_EQ(faces.GetMarks().size(), made.size());
    for (std::size_t vert = 0; vert < made.size(); ++vert) {
        ASSERT_EQ(made[vert], int(faces.GetMarks()[vert])) << "vertex " << vert;
    }
}

Sdc::Options getEdgeOnly() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return options;
}

} // namespace

TEST(LatticePatch, HasOrbitsOfTheSymmetriesOfItsFace) {
    using FarExt::internal::LatticeOrbits;
    struct Expected {
        int faceSize;
        int numPlaces;
        int numAxes;
        int numPairs;
    };
    for (Expected const &expected :
         {Expected{3, 27, LatticeOrbits<3, false>::kNumAxes, LatticeOrbits<3, false>::kNumPairs},
          Expected{4, 32, LatticeOrbits<4, false>::kNumAxes, LatticeOrbits<4, false>::kNumPairs},
          Expected{6, 42, LatticeOrbits<6, false>::kNumAxes, LatticeOrbits<6, false>::kNumPairs}}) {
        int const faceSize = expected.faceSize;
        LatticePatch const patch(faceSize);
        EXPECT_EQ(patch.GetNumPlaces(), expected.numPlaces);
        EXPECT_EQ(patch.GetNumAxes(), expected.numAxes);
        EXPECT_EQ(patch.GetNumPairs(), expected.numPairs);
        auto const &points = patch.GetPoints();
        for (int place = 0; place < patch.GetNumPlaces(); ++place) {
            LatticePatch::Point const point = points[std::size_t(place)];
            EXPECT_NEAR(std::abs(points[std::size_t(patch.MirrorPlace(place))] - std::conj(point)),
                        0, 1e-12);
            for (int corners = 0; corners < faceSize; ++corners) {
                LatticePatch::Point const turned =
                    points[std::size_t(patch.TurnPlace(place, corners))];
                EXPECT_NEAR(std::abs(turned - patch.Turn(point, corners)), 0, 1e-12);
            }
        }
    }
}

// Every vertex of the level is made once, whatever the level and the mask.
TEST(LatticeFaces, MakeAllOfARegularTorus) {
    for (Shape const &shape :
         {MakeTorus(7, 6, TorusFaces::Quads), MakeTorus(7, 6, TorusFaces::Triangles),
          MakeDual("hexagons", MakeTorus(7, 6, TorusFaces::Triangles))}) {
        for (ReferenceMask const mask : kMasks) {
            for (int level = 1; level <= 4; ++level) {
                SCOPED_TRACE(testing::Message()
                             << shape.name << ", " << ToString(mask) << ", level " << level);
                auto const refiner = CreateRefiner(shape, mask, level);
                LatticeFaces const faces = findFaces(*refiner);
                EXPECT_EQ(countFaces(faces), std::size_t(shape.GetNumFaces()));
                ASSERT_NO_FATAL_FAILURE(expectRows(*refiner, faces));
                for (LatticeFaces::Set const &set : faces.GetSets()) {
                    EXPECT_TRUE(set.corners || set.patch.GetFaceSize() == 3);
                }
                std::vector<unsigned char> const &marks = faces.GetMarks();
                EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), std::ptrdiff_t(marks.size()));
            }
        }
    }
}

// Around a sharp vertex faces have other limits: of a lattice of quads those with the vertex among the
// 32 that they depend on, six by six but for the corners.
TEST(LatticeFaces, LeaveWhatIsNearAFeature) {
    Shape shape = MakeTorus(12, 11, TorusFaces::Quads);
    shape.cornerVertices = {5 * 11 + 4};
    shape.cornerSharpness = {1.5f};
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 2, getEdgeOnly());
    LatticeFaces const faces = findFaces(*refiner);
    EXPECT_EQ(countFaces(faces), 12u * 11 - 32);
    expectRows(*refiner, faces);
}

TEST(LatticeFaces, LeaveWhatIsNearAHole) {
    Shape shape = MakeTorus(14, 12, TorusFaces::Triangles);
    shape.faceSizes.pop_back();
    shape.faceVertices.resize(shape.faceVertices.size() - 3);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 2, getEdgeOnly());
    LatticeFaces const faces = findFaces(*refiner);
    EXPECT_GT(countFaces(faces), 100u);
    EXPECT_LT(countFaces(faces), 28u * 12 - 27);
    expectRows(*refiner, faces);
}

// Another mesh, lattices too small for what a face depends on, level 0 itself, and levels behind another
// step.
TEST(LatticeFaces, AreThereForNoOtherMesh) {
    ReferenceMask const mask = ReferenceMask::Average;
    Shape const hexagons = MakeDual("hexagons", MakeTorus(5, 4, TorusFaces::Triangles));
    EXPECT_EQ(countFaces(findFaces(*CreateRefiner(hexagons, mask, 2))), 0u);
    EXPECT_EQ(countFaces(findFaces(*CreateRefiner(GetShape("icosahedron"), mask, 2))), 0u);
    EXPECT_EQ(countFaces(findFaces(*CreateRefiner(MakeTorus(5, 9, TorusFaces::Quads), mask, 1))),
              0u);
    Shape const torus = MakeTorus(9, 8, TorusFaces::Triangles);
    EXPECT_EQ(countFaces(findFaces(*CreateRefiner(torus, mask, 0))), 0u);
    FarExt::HexSchemeOptions options;
    options.firstStep = FarExt::FirstStep::Truncate;
    EXPECT_EQ(countFaces(findFaces(*CreateRefiner(torus, mask, 2, {}, options))), 0u);
}

} // namespace OpenSubdivHex::Regression::latticeFacesTest

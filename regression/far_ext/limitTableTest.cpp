// SPDX-License-Identifier: Apache-2.0
//
// Limit tables that are not factorized and PrimvarRefiner::Limit, against the tables of control
// vertices.
#include "referenceMatch.h"

#include "far_ext/executor.h"
#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression::limitTableTest {

using FarExt::TopologyRefiner;
using Factory = FarExt::LimitStencilTableFactoryReal<double>;

namespace {

constexpr double kTolerance = 1e-11;

/// An element that sums up weights and products.
struct Element {
    void Clear() { *this = {}; }
    void AddWithWeight(Element const &other, double weight) {
        for (int i = 0; i < 3; ++i) {
            values[i] += weight * other.values[i];
        }
    }

    double values[3] = {};
};
using Elements = std::vector<Element>;

std::unique_ptr<Factory::Table const> createTable(TopologyRefiner const &refiner, int level,
                                                  bool isFactorized, bool hasFaceCenters = true) {
    Factory::Options options;
    options.level = level;
    options.generateFurtherSides = true;
    options.generateFaceCenters = hasFaceCenters;
    options.factorizeIntermediateLevels = isFactorized;
    FarExt::CallStatus status;
    auto table = Factory::Create(refiner, options, &status);
    EXPECT_TRUE(table) << status.GetErrorMessage();
    return table;
}

Elements apply(Factory::Table const &table, std::vector<double> const &weights,
               Elements const &values) {
    Elements result(std::size_t(table.GetNumStencils()));
    for (std::size_t i = 0; i < result.size(); ++i) {
        int const offset = table.GetOffsets()[i];
        for (int k = offset; k < offset + table.GetSizes()[i]; ++k) {
            result[i].AddWithWeight(
                values.at(std::size_t(table.GetControlIndices()[std::size_t(k)])),
                weights[std::size_t(k)]);
        }
    }
    return result;
}

void expectNear(Elements const &values, Elements const &expected, std::size_t count,
                std::string const &name) {
    ASSERT_LE(count, values.size());
    ASSERT_LE(count, expected.size());
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) {
            ASSERT_NEAR(values[i].values[k], expected[i].values[k], kTolerance)
                << name << " of row " << i;
        }
    }
}

Elements getPositions(Shape const &shape) {
    Elements result(std::size_t(shape.GetNumVertices()));
    for (std::size_t i = 0; i < result.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            result[i].values[k] = shape.positions[3 * i + k];
        }
    }
    return result;
}

/// A lattice but for a vertex.
Shape makeSharpTorus(TorusFaces kind) {
    Shape shape = MakeTorus(12, 11, kind);
    shape.cornerVertices = {5 * 11 + 4};
    shape.cornerSharpness = {1.5f};
    return shape;
}

/// Expects equal limits of control values by way of the level and straight.
void expectSameLimits(Shape const &shape, ReferenceMask mask, Sdc::Options const &options,
                      int maxLevel, bool hasFaceCenters = true) {
    auto const refiner = CreateRefiner(shape, mask, maxLevel, options);
    FarExt::PrimvarRefinerReal<double> const primvarRefiner(*refiner);
    Elements const base = getPositions(shape);
    Elements values = base;
    for (int level = 0; level <= maxLevel; ++level) {
        SCOPED_TRACE(testing::Message() << "level " << level);
        if (level > 0) {
            Elements const before = std::move(values);
            values.assign(std::size_t(refiner->GetLevel(level).GetNumVertices()), Element());
            primvarRefiner.Interpolate(level, before, values);
        }
        auto const factorized = createTable(*refiner, level, true, hasFaceCenters);
        auto const ofLevel = createTable(*refiner, level, false, hasFaceCenters);
        ASSERT_TRUE(factorized && ofLevel);
        ASSERT_EQ(ofLevel->GetNumControlVertices(), refiner->GetLevel(level).GetNumVertices());
        std::size_t const count = std::size_t(factorized->GetNumStencils());
        Elements const points = apply(*factorized, factorized->GetWeights(), base);
        Elements const du = apply(*factorized, factorized->GetDuWeights(), base);
        Elements const dv = apply(*factorized, factorized->GetDvWeights(), base);
        ASSERT_NO_FATAL_FAILURE(
            expectNear(apply(*ofLevel, ofLevel->GetWeights(), values), points, count, "point"));
        ASSERT_NO_FATAL_FAILURE(
            expectNear(apply(*ofLevel, ofLevel->GetDuWeights(), values), du, count, "du"));
        ASSERT_NO_FATAL_FAILURE(
            expectNear(apply(*ofLevel, ofLevel->GetDvWeights(), values), dv, count, "dv"));
        if (level < maxLevel) {
            continue;
        }
        Elements limit(values.size()), limitDu(values.size()), limitDv(values.size());
        ASSERT_TRUE(primvarRefiner.Limit(values, limit, limitDu, limitDv));
        ASSERT_NO_FATAL_FAILURE(expectNear(limit, points, values.size(), "Limit"));
        ASSERT_NO_FATAL_FAILURE(expectNear(limitDu, du, values.size(), "Limit, du"));
        ASSERT_NO_FATAL_FAILURE(expectNear(limitDv, dv, values.size(), "Limit, dv"));
        Elements pointsAlone(values.size());
        ASSERT_TRUE(primvarRefiner.Limit(values, pointsAlone));
        ASSERT_NO_FATAL_FAILURE(expectNear(pointsAlone, points, values.size(), "Limit alone"));
    }
}

} // namespace

TEST(LimitTable, OfTheLevelIsThatOfControlVertices) {
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumCorners() > 80) {
            continue;
        }
        for (auto boundary : kBoundaries) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(boundary);
            ASSERT_NO_FATAL_FAILURE(expectSameLimits(shape, ReferenceMask::Smooth, options, 2));
        }
    }
}

// Nearly all vertices of a deep level are regular, and share a mask; a few meshes are so small that
// their neighbourhoods meet themselves.
TEST(LimitTable, RegularVerticesShareAMaskAtDeepLevels) {
    for (char const *name : {"cube", "tetrahedron", "dodecahedron", "torus"}) {
        SCOPED_TRACE(name);
        Sdc::Options options;
        ASSERT_NO_FATAL_FAILURE(
            expectSameLimits(GetShape(name), ReferenceMask::Average, options, 4));
    }
}

// Where all faces are hexagons most rows come from the levels before, whichever the mask.
TEST(LimitTable, RowsOfHexagonsAreThoseOfTheLevel) {
    for (char const *name : {"hexTorus", "hexGrid"}) {
        for (auto mask : {ReferenceMask::Average, ReferenceMask::Cosine, ReferenceMask::Smooth}) {
            SCOPED_TRACE(testing::Message() << name << ", mask " << int(mask));
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
            ASSERT_NO_FATAL_FAILURE(expectSameLimits(GetShape(name), mask, options, 3));
        }
    }
}

// Most rows of a lattice follow from control vertices alone, those near a sharp vertex do not: without face
// centers, of which each depends on the last level, a part of that is enough for them.
TEST(LimitTable, RowsOfLatticeFacesAreThoseOfTheLevel) {
    for (TorusFaces const kind : {TorusFaces::Quads, TorusFaces::Triangles}) {
        Shape const torus = MakeTorus(7, 6, kind);
        Shape const sharp = makeSharpTorus(kind);
        for (auto mask : {ReferenceMask::Average, ReferenceMask::Cosine, ReferenceMask::Smooth}) {
            SCOPED_TRACE(testing::Message() << "faces " << int(kind) << ", mask " << int(mask));
            for (bool const hasFaceCenters : {false, true}) {
                ASSERT_NO_FATAL_FAILURE(
                    expectSameLimits(torus, mask, Sdc::Options(), 3, hasFaceCenters));
                ASSERT_NO_FATAL_FAILURE(
                    expectSameLimits(sharp, mask, Sdc::Options(), 3, hasFaceCenters));
            }
        }
    }
}

// As all others are, whatever they are made of.
TEST(LimitTable, StencilsOfLatticesAreSortedAndAsLargeAsTheyMustBe) {
    for (TorusFaces const kind : {TorusFaces::Quads, TorusFaces::Triangles}) {
        auto const refiner = CreateRefiner(makeSharpTorus(kind), ReferenceMask::Average, 3);
        auto const table = createTable(*refiner, 3, true);
        std::vector<int> const sizes(table->GetSizes().begin(), table->GetSizes().end());
        auto const &indices = table->GetControlIndices();
        ASSERT_EQ(indices.size(), std::accumulate(sizes.begin(), sizes.end(), std::size_t(0)));
        EXPECT_EQ(indices.capacity(), indices.size());
        EXPECT_EQ(table->GetWeights().capacity(), indices.size());
        for (std::size_t row = 0; row < sizes.size(); ++row) {
            auto const first = indices.begin() + table->GetOffsets()[row];
            ASSERT_TRUE(std::is_sorted(first, first + sizes[row], std::less_equal<int>()));
            for (int k = table->GetOffsets()[row]; k < table->GetOffsets()[row] + sizes[row]; ++k) {
                ASSERT_GT(table->GetWeights()[std::size_t(k)], 0) << "row " << row;
            }
        }
        Factory::Options options;
        options.level = 3;
        options.generate1stDerivatives = false;
        auto const points = Factory::Create(*refiner, options);
        ASSERT_TRUE(points);
        ASSERT_TRUE(
            std::equal(points->GetSizes().begin(), points->GetSizes().end(), sizes.begin()));
        ASSERT_TRUE(std::equal(points->GetWeights().begin(), points->GetWeights().end(),
                               table->GetWeights().begin()));
    }
}

TEST(LimitTable, SameBitsForAnyNumberOfThreads) {
    for (TorusFaces const kind : {TorusFaces::Quads, TorusFaces::IrregularTriangles}) {
        Shape shape = MakeTorus(40, 30, kind);
        shape.cornerVertices = {17};
        shape.cornerSharpness = {1.5f};
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 2);
        FarExt::SetNumThreads(1);
        auto const expected = createTable(*refiner, 2, true);
        for (int const numThreads : {2, 3, 5}) {
            SCOPED_TRACE(testing::Message() << numThreads << " threads");
            FarExt::SetNumThreads(numThreads);
            auto const table = createTable(*refiner, 2, true);
            EXPECT_TRUE(table->GetSizes() == expected->GetSizes());
            EXPECT_TRUE(table->GetControlIndices() == expected->GetControlIndices());
            EXPECT_TRUE(table->GetWeights() == expected->GetWeights());
            EXPECT_TRUE(table->GetDuWeights() == expected->GetDuWeights());
            EXPECT_TRUE(table->GetDvWeights() == expected->GetDvWeights());
        }
        FarExt::SetNumThreads(0);
    }
}

TEST(LimitTable, PrimvarRefinerRefusesWhatHasNoLimit) {
    ShapeDescriptor const descriptor(GetShape("cube"));
    auto const refiner = FarExt::TopologyRefinerFactory::Create(descriptor.Get());
    ASSERT_TRUE(refiner->RefineUniform(1)); // without full topology in its last level
    FarExt::PrimvarRefinerReal<double> const primvarRefiner(*refiner);
    Elements const values(std::size_t(refiner->GetLevel(1).GetNumVertices()));
    Elements points(values.size());
    points[0].values[0] = 7;
    FarExt::CallStatus status;
    EXPECT_FALSE(primvarRefiner.Limit(values, points, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    EXPECT_NE(status.GetErrorMessage().find("full topology"), std::string::npos)
        << status.GetErrorMessage();
    EXPECT_EQ(points[0].values[0], 7);
}

} // namespace OpenSubdivHex::Regression::limitTableTest

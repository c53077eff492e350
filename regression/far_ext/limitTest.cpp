// SPDX-License-Identifier: Apache-2.0
//
// Limit stencils: against refinement itself, which tends to the limit, and against each other.
#include "referenceMatch.h"
#include "sharpSector.h"
#include "valueLevels.h"

#include "far_ext/executor.h"
#include "far_ext/rules/mask.h"
#include "far_ext/stencilTableFactory.h"
#include "regression/reference/largestValue.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace OpenSubdivHex::Regression::limitTest {

using FarExt::LimitSides;
using FarExt::LimitStencilTableFactoryReal;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

struct LimitValues {
    ReferenceValues points, du, dv;
};

template <typename REAL>
LimitValues evaluate(TopologyRefiner const &refiner,
                     typename LimitStencilTableFactoryReal<REAL>::Options options,
                     ReferenceValues const &base) {
    FarExt::CallStatus status;
    auto const table = LimitStencilTableFactoryReal<REAL>::Create(refiner, options, &status);
    EXPECT_TRUE(table) << status.GetErrorMessage();
    LimitValues result;
    auto const sum = [&](std::vector<REAL> const &weights) {
        ReferenceValues values = ReferenceValues::Zero(table->GetNumStencils(), base.cols());
        for (int i = 0; i < table->GetNumStencils(); ++i) {
            int const offset = table->GetOffsets()[i];
            for (int k = offset; k < offset + table->GetSizes()[i]; ++k) {
                values.row(i) += double(weights[k]) * base.row(table->GetControlIndices()[k]);
            }
        }
        return values;
    };
    return {sum(table->GetWeights()), sum(table->GetDuWeights()), sum(table->GetDvWeights())};
}

Eigen::Vector3d normalOf(LimitValues const &values, Eigen::Index i) {
    Eigen::Vector3d const du = values.du.row(i);
    Eigen::Vector3d const dv = values.dv.row(i);
    return du.cross(dv).normalized();
}

Sdc::Options makeOptions(Sdc::Options::VtxBoundaryInterpolation boundary,
                         Sdc::Options::CreasingMethod creasing = Sdc::Options::CREASE_UNIFORM) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    options.SetCreasingMethod(creasing);
    return options;
}

/// Calls check(shape, options) for every shape of both catalogues with at most \p maxCorners, every
/// boundary rule and both creasing methods.
template <typename CHECK>
void forEachShape(int maxCorners, CHECK const &check) {
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumCorners() > maxCorners) {
            continue;
        }
        for (auto boundary : kBoundaries) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            ASSERT_NO_FATAL_FAILURE(check(shape, makeOptions(boundary)));
            if (!shape.creaseSharpness.empty()) {
                ASSERT_NO_FATAL_FAILURE(
                    check(shape, makeOptions(boundary, Sdc::Options::CREASE_CHAIKIN)));
            }
        }
    }
}

/// Whether a vertex lies on a boundary that follows the paper's rule: it has no limit of its own.
bool isFree(TopologyRefiner const &refiner, TopologyLevel const &level, int vert) {
    for (int edge : level.GetVertexEdges(vert)) {
        if (level.IsEdgeBoundary(edge) && !level.IsEdgeInfSharp(edge)) {
            return refiner.GetSchemeOptions().GetVtxBoundaryInterpolation() ==
                   Sdc::Options::VTX_BOUNDARY_NONE;
        }
    }
    return false;
}

/// Whether the tangents on a side of a vertex on infinitely sharp edges may be approximate: on wide
/// sides of corners and, with Average, narrow ones of creases.
bool isApproximate(TopologyLevel const &level, ReferenceMask mask, LimitSides const &sides,
                   int side) {
    SharpSector const sector(level, sides, side);
    bool const isNarrow = sector.size < 1.5 && mask == ReferenceMask::Average;
    return level.IsVertexNonManifold(sides.GetVertex(side)) ||
           (sector.numSharp >= 2 && (sector.isCorner ? sector.size >= 2 : isNarrow));
}

LimitValues evaluateAll(TopologyRefiner const &refiner, int level, ReferenceValues const &base) {
    LimitStencilTableFactoryReal<double>::Options options;
    options.level = level;
    options.generateFurtherSides = true;
    options.generateFaceCenters = true;
    return evaluate<double>(refiner, options, base);
}

} // namespace

// To the digits that the design prints, found there by other means.
TEST(Limit, MasksOfVVerticesAmongHexagons) {
    struct Expected {
        char const *shape;
        ReferenceMask mask;
        double vertex, neighbor, next, opposite;
    };
    for (Expected const &expected :
         {Expected{"cube", ReferenceMask::Average, .55607, .10689, .01446, .01180},
          Expected{"cube", ReferenceMask::Cosine, .45756, .11353, .02596, .01460},
          Expected{"cube", ReferenceMask::Smooth, .44736, .12069, .02228, .01811},
          Expected{"octahedron", ReferenceMask::Average, .54009, .08305, .01123, .00917},
          Expected{"octahedron", ReferenceMask::Cosine, .44159, .08765, .02004, .01127},
          Expected{"octahedron", ReferenceMask::Smooth, .391345, .126877, .012643, 0},
          Expected{"icosahedron", ReferenceMask::Smooth, .457419, .101238, .003639, 0}}) {
        SCOPED_TRACE(testing::Message() << expected.shape << " " << ToString(expected.mask));
        int const depth = FarExt::kNumStepsToConstantMasks;
        auto const refiner = CreateRefiner(GetShape(expected.shape), expected.mask, depth);
        LimitStencilTableFactoryReal<double>::Options options;
        options.level = depth;
        options.factorizeIntermediateLevels = false;
        auto const table = LimitStencilTableFactoryReal<double>::Create(*refiner, options);
        ASSERT_TRUE(table);
        TopologyLevel const &level = refiner->GetLevel(depth);
        std::vector<double> weights(level.GetNumVertices(), 0.0);
        Far::LimitStencilReal<double> const stencil = table->GetLimitStencil(0);
        for (int k = 0; k < stencil.GetSize(); ++k) {
            weights[stencil.GetVertexIndices()[k]] = stencil.GetWeights()[k];
        }
        constexpr double kDigits = 5.01e-6;
        EXPECT_NEAR(weights[0], expected.vertex, kDigits);
        for (int i = 0; i < level.GetVertexFaces(0).size(); ++i) {
            auto const verts = level.GetFaceVertices(level.GetVertexFaces(0)[i]);
            ASSERT_EQ(verts.size(), 6);
            int const local = level.GetVertexFaceLocalIndices(0)[i];
            double const byDistance[] = {expected.vertex,   expected.neighbor, expected.next,
                                         expected.opposite, expected.next,     expected.neighbor};
            for (int j = 0; j < 6; ++j) {
                EXPECT_NEAR(weights[verts[(local + j) % 6]], byDistance[j], kDigits);
            }
        }
    }
}

TEST(Limit, WeightsOfPointsSumToOneAndOfDerivativesToZero) {
    forEachShape(200, [](Shape const &shape, Sdc::Options options) {
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 1, options);
        for (int level : {0, 1}) {
            LimitValues const values =
                evaluateAll(*refiner, level, ReferenceValues::Ones(shape.GetNumVertices(), 1));
            ASSERT_LT(GetLargestValue(values.points.array() - 1), 1e-12);
            ASSERT_LT(GetLargestValue(values.du), 1e-10);
            ASSERT_LT(GetLargestValue(values.dv), 1e-10);
        }
    });
}

// A vertex and its V-vertex have the same limit and tangent planes, so has a face and its F-face.
TEST(Limit, IsTheSameFromEveryLevel) {
    forEachShape(200, [](Shape const &shape, Sdc::Options options) {
        if (shape.name == "dihedron5" || shape.name.find("degenerate") == 0) {
            return; // faces back to back or collapsed: folded, without tangent planes
        }
        ReferenceValues const positions = GetPositions(shape);
        for (ReferenceMask mask : kMasks) {
            SCOPED_TRACE(ToString(mask));
            auto const refiner = CreateRefiner(shape, mask, 2, options);
            LimitValues values = evaluateAll(*refiner, 0, positions);
            LimitSides sides(refiner->GetLevel(0));
            for (int level = 1; level <= 2; ++level) {
                TopologyLevel const &pLevel = refiner->GetLevel(level - 1);
                LimitValues const cValues = evaluateAll(*refiner, level, positions);
                LimitSides const cSides(refiner->GetLevel(level));
                // Chaikin's sharpness is a float that depends, in its last bit, on the edge that a
                // sum begins with.
                bool const isChaikin = options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN;
                double const allowed = (isChaikin ? 1e-6 : 1e-12) * GetSize(positions);
                // The planes of a side: some side of the V-vertex has the same.
                auto const expectPlane = [&](int i, int cBegin, int cEnd, double tolerance) {
                    Eigen::Vector3d const normal = normalOf(values, i);
                    double distance = 2;
                    for (int c = cBegin; c < cEnd; ++c) {
                        distance = std::min(distance, (normal - normalOf(cValues, c)).norm());
                    }
                    ASSERT_LT(distance, tolerance) << "level " << level << ", row " << i;
                };
                for (int i = 0; i < sides.GetNumSides(); ++i) {
                    int const vert = sides.GetVertex(i);
                    if (isFree(*refiner, pLevel, vert) || pLevel.GetVertexFaces(vert).empty()) {
                        continue;
                    }
                    ASSERT_LT((values.points.row(i) - cValues.points.row(vert)).norm(), allowed)
                        << "level " << level << ", vertex " << vert;
                    // Where faces collapse there is no plane.
                    double const area =
                        values.du.row(i).norm() * values.dv.row(i).norm() / GetSize(positions);
                    Eigen::Vector3d const du = values.du.row(i);
                    Eigen::Vector3d const dv = values.dv.row(i);
                    if (du.cross(dv).norm() < 1e-3 * area) {
                        continue;
                    }
                    double const tolerance = isApproximate(pLevel, mask, sides, i) ? 0.2
                                             : isChaikin                           ? 1e-3
                                                                                   : 1e-8;
                    int c = cSides.GetNumSides();
                    while (c > refiner->GetLevel(level).GetNumVertices() &&
                           cSides.GetVertex(c - 1) != vert) {
                        --c;
                    }
                    int begin = c;
                    while (begin > refiner->GetLevel(level).GetNumVertices() &&
                           cSides.GetVertex(begin - 1) == vert) {
                        --begin;
                    }
                    Eigen::Vector3d const own = normalOf(values, i);
                    if ((own - normalOf(cValues, vert)).norm() >= tolerance) {
                        ASSERT_NO_FATAL_FAILURE(expectPlane(i, begin, c, tolerance));
                    }
                }
                for (int face = 0; face < pLevel.GetNumFaces(); ++face) {
                    int const i = sides.GetNumSides() + face;
                    int const c =
                        cSides.GetNumSides() + pLevel.GetChildIndexing().GetFaceChildFace(face);
                    ASSERT_LT((values.points.row(i) - cValues.points.row(c)).norm(), allowed)
                        << "level " << level << ", face " << face;
                    Eigen::Vector3d const du = values.du.row(i);
                    Eigen::Vector3d const dv = values.dv.row(i);
                    if (du.cross(dv).norm() > 1e-3 * du.norm() * dv.norm()) {
                        ASSERT_NO_FATAL_FAILURE(expectPlane(i, c, c + 1, isChaikin ? 1e-3 : 1e-9));
                    }
                }
                values = cValues;
                sides = cSides;
            }
        }
    });
}

// Vertices come to their limit by a factor near 4 in each level, as the square of the edges; with Average and on borders
// by less, 2.39 at least in these; with Smooth by 2.14 at level 3 of quads, whose masks change there.
TEST(Limit, IsWhatRefinementTendsTo) {
    for (char const *name : {"cube", "icosahedron", "pyramid5", "quadGrid", "mixedPatch"}) {
        for (auto boundary : kBoundaries) {
            for (ReferenceMask mask : kMasks) {
                SCOPED_TRACE(testing::Message()
                             << name << ", boundary " << boundary << ", " << ToString(mask));
                Shape const &shape = GetShape(name);
                ReferenceValues const positions = GetPositions(shape);
                int const maxLevel = 6;
                auto const refiner = CreateRefiner(shape, mask, maxLevel, makeOptions(boundary));
                auto const levels = InterpolateLevels(*refiner, positions);
                LimitValues const limit = evaluateAll(*refiner, 1, positions);
                double previous = 0;
                for (int level = 1; level <= maxLevel; ++level) {
                    double error = 0;
                    for (int v = 0; v < refiner->GetLevel(1).GetNumVertices(); ++v) {
                        if (!isFree(*refiner, refiner->GetLevel(1), v)) {
                            error += (levels[level].row(v) - limit.points.row(v)).squaredNorm();
                        }
                    }
                    error = std::sqrt(error);
                    if (level > 2) {
                        EXPECT_LT(error, previous / (level == 3 ? 2.1 : 2.3)) << "level " << level;
                    }
                    previous = error;
                }
            }
        }
    }
}

// The faces around a vertex become flat: their normals at deep levels are those of its sides.
TEST(Limit, NormalsAreThoseOfTheDeepMesh) {
    for (char const *name : {"cube", "icosahedron", "quadGrid", "creaseLoopQuads", "dartsQuads",
                             "crossingQuads", "semiSharpLoopClosed", "wideSectors"}) {
        Shape const &shape = [&]() -> Shape const & {
            try {
                return GetShape(name);
            } catch (std::out_of_range const &) {
                return GetFeatureShape(name);
            }
        }();
        SCOPED_TRACE(name);
        ReferenceValues const positions = GetPositions(shape);
        int const maxLevel = std::max(GetTestLevel(shape, 7, 400000), 5);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, maxLevel,
                                           makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER));
        auto const deep = InterpolateLevels(*refiner, positions).back();
        LimitValues const limit = evaluateAll(*refiner, maxLevel, positions);
        TopologyLevel const &level = refiner->GetLevel(maxLevel);
        LimitSides const sides(level);
        // The surface at a sharp vertex with many faces becomes flat slowly.
        double const least = std::string(name) == "wideSectors" ? 0.7 : 0.95;
        int numSides = 0;
        for (int face = 0; face < level.GetNumFaces(); ++face) {
            auto const verts = level.GetFaceVertices(face);
            for (int half : {0, 1}) {
                bool const isCut = Sdc::Crease::IsInfinite(level.GetFaceDiagonalSharpness(face));
                std::vector<int> corners;
                if (isCut) {
                    int const end = level.GetFaceDiagonalEnd(face);
                    for (int i = 0; i < FarExt::GetHalfSize(half, verts.size(), end); ++i) {
                        corners.push_back(FarExt::GetPlaceInHalves(half, i, end));
                    }
                } else {
                    for (int i = 0; i < verts.size(); ++i) {
                        corners.push_back(i);
                    }
                }
                Eigen::Vector3d normal = Eigen::Vector3d::Zero();
                Eigen::Vector3d const origin = deep.row(verts[corners[0]]);
                for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
                    Eigen::Vector3d const a = deep.row(verts[corners[i]]).transpose() - origin;
                    Eigen::Vector3d const b = deep.row(verts[corners[i + 1]]).transpose() - origin;
                    normal += a.cross(b);
                }
                normal.normalize();
                for (int corner : corners) {
                    int const side = sides.FindSide(level, face, corner, half);
                    numSides += side >= level.GetNumVertices();
                    ASSERT_EQ(sides.GetVertex(side), verts[corner]);
                    ASSERT_GT(normal.dot(normalOf(limit, side)), least)
                        << "face " << face << ", corner " << corner;
                }
                ASSERT_GT(normal.dot(normalOf(limit, sides.GetNumSides() + face)),
                          isCut && half == 1 ? -1.1 : 0.99)
                    << "face " << face;
            }
        }
        bool const hasCreases = std::string(name).find("Quads") != std::string::npos ||
                                std::string(name) == "wideSectors";
        EXPECT_EQ(numSides > 0, hasCreases);
    }
}

TEST(Limit, PlanarMeshesHaveOneNormal) {
    for (Tiling tiling : {Tiling::Triangles, Tiling::Quads, Tiling::Hexagons}) {
        Shape shape = MakeTiling(tiling, 4, 4);
        for (int corner : {0, 2}) { // on the border, the second where it runs straight
            shape.cornerVertices.push_back(corner);
            shape.cornerSharpness.push_back(10);
        }
        ReferenceValues positions = GetPositions(shape);
        positions.col(2) = 0.25 * positions.col(0) - 0.5 * positions.col(1);
        Eigen::Vector3d const expected = Eigen::Vector3d(-0.25, 0.5, 1).normalized();
        for (auto boundary : kBoundaries) {
            for (ReferenceMask mask : kMasks) {
                SCOPED_TRACE(testing::Message()
                             << int(tiling) << ", boundary " << boundary << ", " << ToString(mask));
                auto const refiner = CreateRefiner(shape, mask, 2, makeOptions(boundary));
                for (int level = 0; level <= 2; ++level) {
                    LimitValues const values = evaluateAll(*refiner, level, positions);
                    for (int i = 0; i < values.points.rows(); ++i) {
                        if (boundary == Sdc::Options::VTX_BOUNDARY_NONE &&
                            level > (tiling == Tiling::Triangles ? 0 : 1)) {
                            continue; // faces on the border fold
                        }
                        ASSERT_LT((normalOf(values, i) - expected).norm(), 1e-9)
                            << "level " << level << ", row " << i;
                    }
                }
            }
        }
    }
}

// Where the faces around are regular hexagons, derivatives are by the length of an edge.
TEST(Limit, DerivativesOfRegularHexagonsHaveTheLengthOfAnEdge) {
    Shape const shape = MakeTiling(Tiling::Hexagons, 7, 7);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    LimitValues const values = evaluateAll(*refiner, 0, GetPositions(shape));
    TopologyLevel const &level = refiner->GetLevel(0);
    int numInner = 0;
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        bool isInner = true;
        for (int face : level.GetVertexFaces(v)) {
            for (int vert : level.GetFaceVertices(face)) {
                for (int other : level.GetVertexFaces(vert)) {
                    for (int outer : level.GetFaceVertices(other)) {
                        isInner = isInner && level.GetVertexFaces(outer).size() == 3;
                    }
                }
            }
        }
        if (isInner) {
            ++numInner;
            EXPECT_NEAR(values.du.row(v).norm(), 1, 0.15) << v;
            EXPECT_NEAR(values.du.row(v).norm(), values.dv.row(v).norm(), 1e-9) << v;
            EXPECT_NEAR(values.du.row(v).dot(values.dv.row(v)), 0, 1e-9) << v;
        }
    }
    EXPECT_GT(numInner, 5);
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        EXPECT_NEAR(values.du.row(level.GetNumVertices() + face).norm(), 1, 1e-9);
        EXPECT_NEAR(values.dv.row(level.GetNumVertices() + face).norm(), 1, 1e-9);
    }
}

TEST(Limit, OsdEvaluatesPointsAndDerivatives) {
    for (char const *name : {"cube", "quadGrid", "spot", "suzanne", "teapot"}) {
        auto const &shapes = GetShapes();
        auto const found = std::find_if(shapes.begin(), shapes.end(),
                                        [&](Shape const &shape) { return shape.name == name; });
        if (found == shapes.end()) {
            continue; // a real mesh that is not there
        }
        SCOPED_TRACE(name);
        auto const refiner = CreateRefiner(*found, ReferenceMask::Smooth, 1,
                                           makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        ReferenceValues const positions = GetPositions(*found);
        LimitValues const expected = evaluateAll(*refiner, 1, positions);

        FarExt::LimitStencilTableFactory::Options options;
        options.level = 1;
        options.generateFurtherSides = true;
        options.generateFaceCenters = true;
        std::unique_ptr<Far::LimitStencilTable const> const table =
            FarExt::LimitStencilTableFactory::Create(*refiner, options);
        ASSERT_TRUE(table);
        int const numStencils = table->GetNumStencils();
        ASSERT_EQ(numStencils, expected.points.rows());
        namespace Osd = OpenSubdiv::Osd;
        std::unique_ptr<Osd::CpuVertexBuffer> source(
            Osd::CpuVertexBuffer::Create(3, found->GetNumVertices()));
        std::vector<float> const base(found->positions.begin(), found->positions.end());
        source->UpdateData(base.data(), 0, found->GetNumVertices());
        std::unique_ptr<Osd::CpuVertexBuffer> buffers[3];
        for (auto &buffer : buffers) {
            buffer.reset(Osd::CpuVertexBuffer::Create(3, numStencils));
        }
        Osd::BufferDescriptor const desc(0, 3, 3);
        ASSERT_TRUE(Osd::CpuEvaluator::EvalStencils(source.get(), desc, buffers[0].get(), desc,
                                                    buffers[1].get(), desc, buffers[2].get(), desc,
                                                    table.get()));
        ReferenceValues const *const values[3] = {&expected.points, &expected.du, &expected.dv};
        for (int k = 0; k < 3; ++k) {
            ReferenceValues const actual =
                Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>>(
                    buffers[k]->BindCpuBuffer(), numStencils, 3)
                    .cast<double>();
            EXPECT_LT(GetLargestValue(actual - *values[k]), 1e-5 * GetSize(positions));
        }
    }
}

TEST(Limit, TablesAreWellFormed) {
    Shape const &shape = GetFeatureShape("crossingQuads");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 2);
    for (bool hasDerivatives : {false, true}) {
        FarExt::LimitStencilTableFactory::Options options;
        options.level = 2;
        options.generateFaceCenters = true;
        options.generate1stDerivatives = hasDerivatives;
        auto const table = FarExt::LimitStencilTableFactory::Create(*refiner, options);
        ASSERT_TRUE(table);
        TopologyLevel const &level = refiner->GetLevel(2);
        EXPECT_EQ(table->GetNumStencils(), level.GetNumVertices() + level.GetNumFaces());
        EXPECT_EQ(table->GetNumControlVertices(), shape.GetNumVertices());
        std::size_t offset = 0;
        for (int i = 0; i < table->GetNumStencils(); ++i) {
            ASSERT_EQ(std::size_t(table->GetOffsets()[i]), offset);
            int const size = table->GetSizes()[i];
            auto const begin = table->GetControlIndices().begin() + std::ptrdiff_t(offset);
            ASSERT_TRUE(std::is_sorted(begin, begin + size));
            ASSERT_TRUE(std::adjacent_find(begin, begin + size) == begin + size);
            offset += std::size_t(size);
        }
        EXPECT_EQ(table->GetControlIndices().size(), offset);
        EXPECT_EQ(table->GetWeights().size(), offset);
        EXPECT_EQ(table->GetDuWeights().size(), hasDerivatives ? offset : 0);
        EXPECT_EQ(table->GetDvWeights().size(), hasDerivatives ? offset : 0);
        EXPECT_TRUE(table->GetDuuWeights().empty());
    }
}

TEST(Limit, SameBitsForAnyNumberOfThreads) {
    for (char const *name : {"dodecahedron", "quadGrid"}) {
        SCOPED_TRACE(name);
        auto const refiner = CreateRefiner(GetShape(name), ReferenceMask::Smooth, 5,
                                           makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        auto const create = [&](int numThreads) {
            FarExt::SetNumThreads(numThreads);
            FarExt::LimitStencilTableFactory::Options options;
            options.level = 5;
            options.generateFaceCenters = true;
            return FarExt::LimitStencilTableFactory::Create(*refiner, options);
        };
        auto const expected = create(1);
        ASSERT_GT(expected->GetNumStencils(), 5 * 4096); // more than a thread's share
        for (int numThreads : {2, 3, 8}) {
            auto const table = create(numThreads);
            EXPECT_EQ(table->GetControlIndices(), expected->GetControlIndices());
            EXPECT_EQ(table->GetWeights(), expected->GetWeights());
            EXPECT_EQ(table->GetDuWeights(), expected->GetDuWeights());
            EXPECT_EQ(table->GetDvWeights(), expected->GetDvWeights());
        }
    }
}

TEST(Limit, IsOfTheLastLevelByDefault) {
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(GetShape("cube")).Get());
    FarExt::TopologyRefiner::UniformOptions uniformOptions(2);
    uniformOptions.fullTopologyInLastLevel = true;
    ASSERT_TRUE(refiner->RefineUniform(uniformOptions));
    FarExt::LimitStencilTableFactory::Options options;
    auto const byDefault = FarExt::LimitStencilTableFactory::Create(*refiner, options);
    ASSERT_TRUE(byDefault);
    options.level = 2;
    auto const ofLast = FarExt::LimitStencilTableFactory::Create(*refiner, options);
    EXPECT_EQ(byDefault->GetNumStencils(), refiner->GetLevel(2).GetNumVertices());
    EXPECT_EQ(byDefault->GetControlIndices(), ofLast->GetControlIndices());
    EXPECT_EQ(byDefault->GetWeights(), ofLast->GetWeights());
    EXPECT_EQ(byDefault->GetDuWeights(), ofLast->GetDuWeights());
    options.level = 0;
    auto const ofControlVertices = FarExt::LimitStencilTableFactory::Create(*refiner, options);
    EXPECT_EQ(ofControlVertices->GetNumStencils(), refiner->GetLevel(0).GetNumVertices());
}

TEST(Limit, RefusesBadOptions) {
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(GetShape("cube")).Get());
    ASSERT_TRUE(refiner->RefineUniform(2));
    auto const expectRefused = [&](FarExt::LimitStencilTableFactory::Options const &options,
                                   std::string const &cause) {
        FarExt::CallStatus status;
        EXPECT_FALSE(FarExt::LimitStencilTableFactory::Create(*refiner, options, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetComponentIndex(), options.level);
        EXPECT_NE(status.GetErrorMessage().find(cause), std::string::npos)
            << status.GetErrorMessage();
    };
    FarExt::LimitStencilTableFactory::Options options;
    options.level = -2;
    expectRefused(options, "level -2 is not one of the levels 0 to 2");
    options.level = 3;
    expectRefused(options, "level 3 is not one of the levels 0 to 2");
    options.level = 2;
    expectRefused(options, "level 2 has no full topology");
    options.level = 1;
    options.generateVertices = false;
    expectRefused(options, "neither vertices nor face centers");
    options.generateFaceCenters = true;
    options.generateFurtherSides = true;
    expectRefused(options, "without vertices");
}

TEST(Limit, IsOfHexagonalStepsAlone) {
    FarExt::TopologyRefinerFactory::Options refinerOptions;
    FarExt::HexSchemeOptions &scheme = refinerOptions.hexSchemeOptions;
    scheme.faceMask = FarExt::FaceMask::Smooth;
    auto const createRefiner = [&] {
        ShapeDescriptor const descriptor(GetShape("prism5"));
        auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(),
                                                              refinerOptions);
        FarExt::TopologyRefiner::UniformOptions uniformOptions(2);
        uniformOptions.fullTopologyInLastLevel = true;
        EXPECT_TRUE(refiner->RefineUniform(uniformOptions));
        return refiner;
    };
    using Factory = FarExt::LimitStencilTableFactoryReal<double>;
    Factory::Options options;
    FarExt::CallStatus status;
    for (FarExt::SchemeType type : {FarExt::SchemeType::DooSabin, FarExt::SchemeType::TriHex}) {
        scheme.schemeType = type;
        EXPECT_FALSE(Factory::Create(*createRefiner(), options, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
    }

    // After a first step the limit is that of the steps which follow, from every level.
    scheme.schemeType = FarExt::SchemeType::Hexagonal;
    for (FarExt::FirstStep firstStep : {FarExt::FirstStep::TriHex, FarExt::FirstStep::Truncate}) {
        scheme.firstStep = firstStep;
        auto const refiner = createRefiner();
        options.level = 0;
        EXPECT_FALSE(Factory::Create(*refiner, options, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
        ReferenceValues const positions = GetPositions(GetShape("prism5"));
        options.level = 1;
        LimitValues const fromFirst = evaluate<double>(*refiner, options, positions);
        options.level = 2;
        LimitValues const fromSecond = evaluate<double>(*refiner, options, positions);
        int const numVertices = refiner->GetLevel(1).GetNumVertices();
        EXPECT_LT(GetLargestValue(fromFirst.points.topRows(numVertices) -
                                  fromSecond.points.topRows(numVertices)),
                  1e-12);
    }
}

// Lines pass vertices, in faces that they cross from any place to any other.
TEST(Limit, BehindATruncationIsTheSameFromEveryLevel) {
    FarExt::HexSchemeOptions schemeOptions;
    schemeOptions.firstStep = FarExt::FirstStep::Truncate;
    forEachShape(60, [&](Shape const &shape, Sdc::Options options) {
        if (shape.creaseSharpness.empty() ||
            options.GetVtxBoundaryInterpolation() == Sdc::Options::VTX_BOUNDARY_NONE ||
            options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN) {
            return; // Chaikin's sharpness is a float
        }
        ReferenceValues const positions = GetPositions(shape);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 2, options, schemeOptions);
        TopologyLevel const &level = refiner->GetLevel(1);
        LimitValues const values = evaluateAll(*refiner, 1, positions);
        LimitValues const cValues = evaluateAll(*refiner, 2, positions);
        for (int vert = 0; vert < level.GetNumVertices(); ++vert) {
            if (!isFree(*refiner, level, vert)) {
                ASSERT_LT((values.points.row(vert) - cValues.points.row(vert)).norm(),
                          1e-12 * GetSize(positions))
                    << "vertex " << vert;
            }
        }
        int const numSides = LimitSides(level).GetNumSides();
        int const numChildSides = LimitSides(refiner->GetLevel(2)).GetNumSides();
        for (int face = 0; face < level.GetNumFaces(); ++face) {
            ASSERT_LT(
                (values.points.row(numSides + face) - cValues.points.row(numChildSides + face))
                    .norm(),
                1e-12 * GetSize(positions))
                << "face " << face;
        }
    });
}

} // namespace OpenSubdivHex::Regression::limitTest

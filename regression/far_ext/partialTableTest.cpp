// SPDX-License-Identifier: Apache-2.0
//
// Stencil tables of some base faces, and the sizes of tables before they are made.
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace OpenSubdivHex::Regression::partialTableTest {

namespace {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;
using IndexArray = Far::ConstIndexArray;

template <typename REAL>
using Factory = FarExt::StencilTableFactoryReal<REAL>;

/// Calls check(shape, refiner) for all shapes and all ways to refine them, to \p maxLevel at most
/// and while the last level has at most \p maxCorners.
template <typename CHECK>
void forEachRefiner(int maxLevel, double maxCorners, CHECK const &check) {
    for (Shape const &shape : GetAllShapes()) {
        int const level = GetTestLevel(shape, maxLevel, maxCorners);
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
            for (int kind = 0; kind < 7; ++kind) {
                SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary
                                                << ", kind of refinement " << kind);
                Sdc::Options sdcOptions;
                sdcOptions.SetVtxBoundaryInterpolation(boundary);
                sdcOptions.SetFVarLinearInterpolation(kind == 0 ? Sdc::Options::FVAR_LINEAR_ALL
                                                                : Sdc::Options::FVAR_LINEAR_NONE);
                FarExt::HexSchemeOptions scheme;
                scheme.schemeType = kind == 1   ? FarExt::SchemeType::DooSabin
                                    : kind == 2 ? FarExt::SchemeType::TriHex
                                                : FarExt::SchemeType::Hexagonal;
                scheme.firstStep = kind == 3   ? FarExt::FirstStep::TriHex
                                   : kind == 6 ? FarExt::FirstStep::Truncate
                                               : FarExt::FirstStep::Same;
                auto const refiner = FarExt::TopologyRefinerFactory::Create(
                    *CreateFarRefiner(shape, sdcOptions), {scheme});
                if (!refiner) {
                    ASSERT_TRUE(kind >= 1 && kind <= 3); // no features there
                    continue;
                }
                if (kind == 4) {
                    TopologyRefiner::CoplanarOptions options(level);
                    options.angleTolerance = 20;
                    ASSERT_TRUE(refiner->RefineCoplanar(shape.positions.data(), options));
                } else {
                    TopologyRefiner::UniformOptions options(level);
                    options.fullTopologyInLastLevel = kind == 5;
                    ASSERT_TRUE(refiner->RefineUniform(options));
                }
                check(shape, *refiner);
                if (testing::Test::HasFatalFailure()) {
                    return;
                }
            }
        }
    }
}

/// Calls check(options) for each mode and channel and each combination of the flags.
template <typename REAL, typename CHECK>
void forEachOptions(TopologyRefiner const &refiner, CHECK const &check) {
    for (int mode = 0; mode < 2 + refiner.GetNumFVarChannels(); ++mode) {
        for (int bits = 0; bits < 8; ++bits) {
            typename Factory<REAL>::Options options;
            options.interpolationMode = mode == 0   ? FarExt::INTERPOLATE_VERTEX
                                        : mode == 1 ? FarExt::INTERPOLATE_VARYING
                                                    : FarExt::INTERPOLATE_FACE_VARYING;
            options.fvarChannel = std::max(0, mode - 2);
            options.generateControlVerts = (bits & 1) != 0;
            options.generateIntermediateLevels = (bits & 2) != 0;
            options.factorizeIntermediateLevels = (bits & 4) != 0;
            SCOPED_TRACE(testing::Message() << "mode " << mode << ", flags " << bits);
            check(options);
            if (testing::Test::HasFatalFailure()) {
                return;
            }
        }
    }
}

/// By direct search through all faces of the level.
std::vector<int> findVertices(TopologyLevel const &level, std::vector<int> const &baseFaces,
                              int channel) {
    std::set<int> const wanted(baseFaces.begin(), baseFaces.end());
    std::set<int> verts;
    auto const add = [&](IndexArray more) { verts.insert(more.begin(), more.end()); };
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        auto const isWanted = [&](int half) {
            return wanted.count(level.GetFaceBaseFace(face, half)) > 0;
        };
        bool const isFVarSplit = channel >= 0 && level.IsFaceFVarSplit(face, channel);
        for (int half = 0; half < 2; ++half) {
            if (!isWanted(half)) {
                continue;
            }
            if (isFVarSplit) {
                add(level.GetFaceFVarValues(face, channel, half));
                continue;
            }
            IndexArray const all =
                channel < 0 ? level.GetFaceVertices(face) : level.GetFaceFVarValues(face, channel);
            if (isWanted(1 - half)) {
                add(all);
                continue;
            }
            int const end = level.GetFaceDiagonalEnd(face);
            for (int i = 0; i < FarExt::GetHalfSize(half, all.size(), end); ++i) {
                verts.insert(all[FarExt::GetPlaceInHalves(half, i, end)]);
            }
        }
    }
    return {verts.begin(), verts.end()};
}

IndexArray toArray(std::vector<int> const &faces) {
    return IndexArray(faces.data(), int(faces.size()));
}

template <typename REAL>
void expectRowsOfWhole(TopologyRefiner const &refiner, std::vector<int> const &baseFaces,
                       typename Factory<REAL>::Options const &options) {
    auto const whole = Factory<REAL>::Create(refiner, options);
    auto const part = Factory<REAL>::CreateOfFaces(refiner, toArray(baseFaces), options);
    ASSERT_TRUE(whole && part);
    ASSERT_EQ(part->GetNumControlVertices(), whole->GetNumControlVertices());
    bool const isFaceVarying = options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING;
    int const channel = isFaceVarying ? options.fvarChannel : -1;
    int wholeFirst = 0;
    int row = 0;
    int offset = 0;
    for (int depth = 0; depth <= refiner.GetMaxLevel(); ++depth) {
        TopologyLevel const &level = refiner.GetLevel(depth);
        bool const isStored =
            depth == 0 ? options.generateControlVerts
                       : options.generateIntermediateLevels || depth == refiner.GetMaxLevel();
        std::vector<int> const verts = findVertices(level, baseFaces, channel);
        ASSERT_EQ(Factory<REAL>::GetVerticesOfFaces(refiner, toArray(baseFaces), options, depth),
                  verts);
        if (!isStored) {
            continue;
        }
        for (int vert : verts) {
            auto const expected = whole->GetStencil(wholeFirst + vert);
            ASSERT_LT(row, part->GetNumStencils());
            int const size = part->GetSizes()[row];
            ASSERT_EQ(size, expected.GetSize()) << "level " << depth << " vertex " << vert;
            ASSERT_EQ(part->GetOffsets()[row], offset);
            for (int k = 0; k < size; ++k) {
                ASSERT_EQ(part->GetControlIndices()[offset + k], expected.GetVertexIndices()[k]);
                ASSERT_EQ(part->GetWeights()[offset + k], expected.GetWeights()[k]);
            }
            offset += size;
            ++row;
        }
        wholeFirst += isFaceVarying ? level.GetNumFVarValues(channel) : level.GetNumVertices();
    }
    ASSERT_EQ(row, part->GetNumStencils());
    ASSERT_EQ(part->GetWeights().size(), std::size_t(offset));
    ASSERT_EQ(part->GetControlIndices().size(), std::size_t(offset));
    ASSERT_EQ(part->GetWeights().capacity(), std::size_t(offset));
    ASSERT_EQ(part->GetControlIndices().capacity(), std::size_t(offset));
}

} // namespace

TEST(PartialTable, RowsAreThoseOfTheWhole) {
    forEachRefiner(3, 600, [](Shape const &shape, TopologyRefiner const &refiner) {
        std::vector<int> all(shape.GetNumFaces());
        std::iota(all.begin(), all.end(), 0);
        std::vector<int> some;
        for (int face = shape.GetNumFaces() - 1; face >= 0; face -= 3) {
            some.insert(some.end(), {face, face}); // neither ascending nor unique
        }
        for (std::vector<int> const &faces :
             {std::vector<int>{shape.GetNumFaces() / 2}, some, all, std::vector<int>()}) {
            SCOPED_TRACE(testing::Message() << faces.size() << " faces");
            forEachOptions<double>(refiner, [&](auto const &options) {
                if (options.factorizeIntermediateLevels) {
                    expectRowsOfWhole<double>(refiner, faces, options);
                }
            });
        }
        FarExt::StencilTableFactory::Options const options;
        expectRowsOfWhole<float>(refiner, some, options);
    });
}

TEST(PartialTable, SelectionsShareNoFaceAndLeaveNoneOut) {
    Shape const &shape = GetShape("truncatedIcosahedron");
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape));
    ASSERT_TRUE(refiner->RefineUniform(2));
    std::vector<int> faces[2];
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        faces[face % 3 == 0].push_back(face);
    }
    FarExt::StencilTableFactory::Options options;
    std::set<int> all;
    for (auto const &part : faces) {
        auto const verts =
            FarExt::StencilTableFactory::GetVerticesOfFaces(*refiner, toArray(part), options, 2);
        EXPECT_LT(int(verts.size()), refiner->GetLevel(2).GetNumVertices());
        all.insert(verts.begin(), verts.end());
    }
    EXPECT_EQ(int(all.size()), refiner->GetLevel(2).GetNumVertices());
}

TEST(PartialTable, RefusesWhatItCannotMake) {
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(GetShape("cube")));
    ASSERT_TRUE(refiner->RefineUniform(1));
    using Options = FarExt::StencilTableFactory::Options;
    FarExt::CallStatus status;
    for (int face : {-1, 6}) {
        std::vector<int> const faces = {0, face};
        EXPECT_FALSE(FarExt::StencilTableFactory::CreateOfFaces(*refiner, toArray(faces), Options(),
                                                                &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Face);
        EXPECT_EQ(status.GetComponentIndex(), face);
        EXPECT_TRUE(FarExt::StencilTableFactory::GetVerticesOfFaces(*refiner, toArray(faces),
                                                                    Options(), 1, &status)
                        .empty());
        EXPECT_EQ(status.GetComponentIndex(), face);
    }
    std::vector<int> const faces = {0};
    for (int level : {-1, 2}) {
        EXPECT_TRUE(FarExt::StencilTableFactory::GetVerticesOfFaces(*refiner, toArray(faces),
                                                                    Options(), level, &status)
                        .empty());
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Level);
    }
    Options options;
    options.factorizeIntermediateLevels = false;
    EXPECT_FALSE(
        FarExt::StencilTableFactory::CreateOfFaces(*refiner, toArray(faces), options, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
    options = Options();
    options.maxLevel = -1;
    EXPECT_FALSE(
        FarExt::StencilTableFactory::CreateOfFaces(*refiner, toArray(faces), options, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    EXPECT_TRUE(
        FarExt::StencilTableFactory::CreateOfFaces(*refiner, toArray(faces), Options(), &status));
    EXPECT_TRUE(status.IsOk());
}

namespace {

template <typename REAL>
void expectSize(TopologyRefiner const &refiner, typename Factory<REAL>::Options const &options) {
    FarExt::CallStatus status;
    auto const size = Factory<REAL>::GetSize(refiner, options, &status);
    ASSERT_TRUE(status.IsOk()) << status.GetErrorMessage();
    auto const table = Factory<REAL>::Create(refiner, options);
    ASSERT_TRUE(table);
    ASSERT_EQ(size.numStencils, table->GetNumStencils());
    ASSERT_EQ(size.numWeights, std::int64_t(table->GetWeights().size()));
    ASSERT_EQ(size.numBytes,
              8 * size.numStencils + std::int64_t(4 + sizeof(REAL)) * size.numWeights);
}

} // namespace

TEST(TableSize, IsThatOfTheTable) {
    forEachRefiner(3, 12000, [](Shape const &, TopologyRefiner const &refiner) {
        forEachOptions<float>(refiner,
                              [&](auto const &options) { expectSize<float>(refiner, options); });
        expectSize<double>(refiner, Factory<double>::Options());
    });
}

TEST(TableSize, TellsWhatIsTooLarge) {
    // A prism, whose two n-gons have n stencils of n weights each at level 1.
    constexpr int n = 40000;
    Shape shape;
    shape.positions.resize(6 * n);
    shape.faceSizes = {n, n};
    for (int i = 0; i < n; ++i) {
        shape.faceVertices.push_back(i);
    }
    for (int i = n; i-- > 0;) {
        shape.faceVertices.push_back(n + i);
    }
    for (int i = 0; i < n; ++i) {
        int const next = (i + 1) % n;
        shape.faceSizes.push_back(4);
        shape.faceVertices.insert(shape.faceVertices.end(), {next, i, n + i, n + next});
    }
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape));
    ASSERT_TRUE(refiner && refiner->RefineUniform(1));
    FarExt::StencilTableFactory::Options options;
    FarExt::CallStatus status;
    for (bool const factorize : {false, true}) {
        options.factorizeIntermediateLevels = factorize;
        EXPECT_FALSE(FarExt::StencilTableFactory::Create(*refiner, options, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::TooLarge);
        std::string const message = status.GetErrorMessage();
        auto const size = FarExt::StencilTableFactory::GetSize(*refiner, options, &status);
        EXPECT_EQ(size.numWeights, 0);
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::TooLarge);
        EXPECT_EQ(status.GetErrorMessage(), message);
    }
    options.maxLevel = -1;
    EXPECT_EQ(FarExt::StencilTableFactory::GetSize(*refiner, options, &status).numStencils, 0);
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
}

} // namespace OpenSubdivHex::Regression::partialTableTest

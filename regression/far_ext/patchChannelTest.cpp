// SPDX-License-Identifier: Apache-2.0
//
// Patches of face-varying channels: against those of meshes that are cut open at the seams, and through OpenSubdiv.
#include "patchFixture.h"
#include "referenceMatch.h"

#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "regression/shapes/featureShapes.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace OpenSubdivHex::Regression::patchChannelTest {

using Far::Index;
using FarExt::PatchMap;
using FarExt::PatchTableFactory;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;
using Interpolation = Sdc::Options::FVarLinearInterpolation;
namespace Osd = OpenSubdiv::Osd;

namespace {

constexpr int kMaxCorners = 64;

Sdc::Options makeOptions(Interpolation interpolation) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    options.SetFVarLinearInterpolation(interpolation);
    return options;
}

ReferenceValues getValues(FVarChannel const &channel) {
    return Eigen::Map<ReferenceValues const>(
        channel.values.data(), Eigen::Index(channel.values.size()) / channel.width, channel.width);
}

// The control points, and behind them those that stencils make.
template <typename REAL>
ReferenceValues applyStencils(Far::StencilTableReal<REAL> const &table,
                              ReferenceValues const &control) {
    EXPECT_EQ(table.GetNumControlVertices(), control.rows());
    ReferenceValues points(control.rows() + table.GetNumStencils(), control.cols());
    points.setZero();
    points.topRows(control.rows()) = control;
    for (int i = 0; i < table.GetNumStencils(); ++i) {
        int const offset = table.GetOffsets()[std::size_t(i)];
        for (int k = offset; k < offset + table.GetSizes()[std::size_t(i)]; ++k) {
            points.row(control.rows() + i) +=
                double(table.GetWeights()[std::size_t(k)]) *
                control.row(table.GetControlIndices()[std::size_t(k)]);
        }
    }
    return points;
}

PatchTableFactory::Options makePatchOptions(int level) {
    PatchTableFactory::Options options(level);
    options.SetPatchPrecision<double>();
    options.SetFVarPatchPrecision<double>();
    options.generateFVarTables = true;
    options.generateFVarLegacyLinearPatches = false;
    return options;
}

std::unique_ptr<Far::PatchTable const> createTable(TopologyRefiner const &refiner,
                                                   PatchTableFactory::Options const &options) {
    FarExt::CallStatus status;
    auto table = PatchTableFactory::Create(refiner, options, &status);
    EXPECT_TRUE(table) << status.GetErrorMessage();
    return table;
}

// A value of a smooth channel, by Far's own basis.
Eigen::RowVectorXd evaluateChannel(Far::PatchTable const &table, int channel,
                                   ReferenceValues const &points, PatchMap::Place const &place) {
    constexpr int kNumPoints = 20;
    double weights[kNumPoints];
    auto const handle = PatchMap::GetHandle(place.patch);
    table.EvaluateBasisFaceVarying(handle, place.s, place.t, weights, nullptr, nullptr, nullptr,
                                   nullptr, nullptr, channel);
    auto const values = table.GetPatchFVarValues(handle, channel);
    EXPECT_EQ(values.size(), kNumPoints);
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(points.cols());
    for (int i = 0; i < kNumPoints; ++i) {
        sum += weights[i] * points.row(values[i]);
    }
    return sum;
}

// Each face with vertices of its own, where the values of a channel are.
Shape cutOpen(Shape const &shape, FVarChannel const &channel) {
    Shape result;
    result.name = shape.name + " cut open";
    result.faceSizes = shape.faceSizes;
    result.faceVertices = channel.valueIndices;
    ReferenceValues const values = getValues(channel);
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
        result.positions.insert(result.positions.end(), {values(i, 0), values(i, 1), 0});
    }
    return result;
}

} // namespace

// Patches of a channel do not depend on the mesh beyond the seams.
TEST(PatchChannel, IsThatOfTheMeshCutOpen) {
    for (Shape shape : GetManifoldShapes()) {
        if (shape.GetNumCorners() > kMaxCorners) {
            continue;
        }
        for (auto const firstStep : {FarExt::FirstStep::Same, FarExt::FirstStep::Truncate}) {
            SCOPED_TRACE(testing::Message() << shape.name << ", first step " << int(firstStep));
            shape.fvarChannels = {MakeFaceChannel(shape)};
            FVarChannel const &channel = shape.fvarChannels[0];
            FarExt::HexSchemeOptions schemeOptions;
            schemeOptions.firstStep = firstStep;
            int const level = 1;
            Sdc::Options const options = makeOptions(Sdc::Options::FVAR_LINEAR_NONE);
            auto const refiner =
                CreateRefiner(shape, ReferenceMask::Smooth, level + 1, options, schemeOptions);
            auto const table = createTable(*refiner, makePatchOptions(level));
            ASSERT_TRUE(table);
            ASSERT_EQ(table->GetNumFVarChannels(), 1);
            EXPECT_EQ(table->GetFVarPatchDescriptor().GetType(),
                      Far::PatchDescriptor::GREGORY_BASIS);
            ReferenceValues const points = applyStencils(
                *table->GetLocalPointFaceVaryingStencilTable<double>(), getValues(channel));
            PatchMap const map(*refiner, level);

            Shape const open = cutOpen(shape, channel);
            auto const openRefiner =
                CreateRefiner(open, ReferenceMask::Smooth, level + 1, options, schemeOptions);
            PatchSurface const expected(*openRefiner, level, GetPositions(open));
            PatchMap const openMap(*openRefiner, level);
            for (int patch = 0; patch < map.GetNumPatches(); ++patch) {
                if (map.GetFace(patch) >= shape.GetNumFaces()) {
                    continue; // the polygons of vertices are numbered otherwise
                }
                for (double const s : {0.1, 0.6}) {
                    PatchMap::Place const place = {patch, s, 0.3};
                    double u = 0;
                    double v = 0;
                    map.GetFacePlace(place, &u, &v);
                    auto const other = openMap.FindPlace(map.GetFace(patch), u, v);
                    ASSERT_NE(other.patch, Far::INDEX_INVALID);
                    Eigen::RowVectorXd const actual = evaluateChannel(*table, 0, points, place);
                    PatchPoint const wanted = expected.Evaluate(other.patch, other.s, other.t);
                    ASSERT_LT((actual - wanted.p.head(2).transpose()).norm(), 1e-12)
                        << "patch " << patch;
                }
            }
        }
    }
}

// Without seams a channel is as the vertices are, bit for bit.
TEST(PatchChannel, WithoutSeamsHasThePointsOfTheSurface) {
    for (char const *const name : {"cube", "prism5", "creaseLoopClosed", "semiSharpLoopClosed"}) {
        for (int const minLevel : {-1, 0}) {
            SCOPED_TRACE(testing::Message() << name << " from level " << minLevel);
            Shape shape = *std::find_if(GetAllShapes().begin(), GetAllShapes().end(),
                                        [&](Shape const &other) { return other.name == name; });
            shape.fvarChannels = {MakeFaceChannel(shape), MakeVertexChannel(shape)};
            auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 3,
                                               makeOptions(Sdc::Options::FVAR_LINEAR_NONE));
            PatchTableFactory::Options options = makePatchOptions(2);
            options.minIsolationLevel = minLevel;
            int const channels[] = {1};
            options.numFVarChannels = 1;
            options.fvarChannelIndices = channels;
            auto const table = createTable(*refiner, options);
            ASSERT_TRUE(table);
            ASSERT_EQ(table->GetNumFVarChannels(), 1);
            auto const &ofSurface = *table->GetLocalPointStencilTable<double>();
            auto const &ofChannel = *table->GetLocalPointFaceVaryingStencilTable<double>();
            EXPECT_EQ(ofSurface.GetWeights(), ofChannel.GetWeights());
            EXPECT_EQ(ofSurface.GetControlIndices(), ofChannel.GetControlIndices());
            EXPECT_EQ(ofSurface.GetSizes(), ofChannel.GetSizes());
            ASSERT_EQ(table->GetFVarValues().size(), table->GetPatchArrayVertices(0).size());
            EXPECT_TRUE(std::equal(table->GetFVarValues().begin(), table->GetFVarValues().end(),
                                   table->GetPatchArrayVertices(0).begin()));
            for (int patch = 0; patch < table->GetNumPatchesTotal(); ++patch) {
                auto const handle = PatchMap::GetHandle(patch);
                Far::PatchParam const expected = table->GetPatchParam(handle);
                Far::PatchParam const param = table->GetPatchFVarPatchParam(handle);
                ASSERT_EQ(param.field0, expected.field0);
                ASSERT_EQ(param.field1, expected.field1);
            }
        }
    }
}

// Where two patches have two values of a side, one behind the other, they have all of its points.
TEST(PatchChannel, PatchesOfOneChartShareTheirSides) {
    int numShared = 0;
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumCorners() > kMaxCorners || shape.fvarChannels.empty() || !shape.manifold) {
            continue;
        }
        SCOPED_TRACE(shape.name);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 3,
                                           makeOptions(Sdc::Options::FVAR_LINEAR_CORNERS_ONLY));
        PatchTableFactory::Options options = makePatchOptions(2);
        options.minIsolationLevel = 0;
        auto const table = createTable(*refiner, options);
        ASSERT_TRUE(table);
        for (int channel = 0; channel < table->GetNumFVarChannels(); ++channel) {
            std::map<std::pair<Index, Index>, std::array<Index, 2>> sides;
            auto const values = table->GetFVarValues(channel);
            for (int patch = 0; patch < table->GetNumPatchesTotal(); ++patch) {
                for (int side = 0; side < 4; ++side) {
                    Index const *const start = &values[20 * patch + 5 * side];
                    Index const *const end = &values[20 * patch + 5 * ((side + 1) % 4)];
                    sides[{*start, *end}] = {start[1], end[2]};
                }
            }
            for (auto const &[ends, points] : sides) {
                auto const other = sides.find({ends.second, ends.first});
                if (other != sides.end()) {
                    EXPECT_EQ(points[0], other->second[1]);
                    EXPECT_EQ(points[1], other->second[0]);
                    ++numShared;
                }
            }
        }
    }
    EXPECT_GT(numShared, 1000);
}

// Linear patches have the values of the level, and means of them in faces of other sizes; so have all patches that
// are to be linear.
TEST(PatchChannel, LinearPatchesHaveTheValuesOfTheLevel) {
    for (auto const interpolation :
         {Sdc::Options::FVAR_LINEAR_ALL, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2}) {
        for (char const *const name : {"cubeOfCharts", "texturedFin", "seamLoop", "prism5"}) {
            for (int const depth : {0, 1}) {
                SCOPED_TRACE(testing::Message()
                             << name << ", level " << depth << ", rule " << interpolation);
                Shape shape = *std::find_if(GetAllShapes().begin(), GetAllShapes().end(),
                                            [&](Shape const &other) { return other.name == name; });
                if (shape.fvarChannels.empty()) {
                    shape.fvarChannels = {MakeFaceChannel(shape)};
                }
                auto const refiner =
                    CreateRefiner(shape, ReferenceMask::Smooth, 2, makeOptions(interpolation));
                PatchTableFactory::Options options(depth);
                options.generateFVarTables = true;
                auto const table = createTable(*refiner, options);
                ASSERT_TRUE(table);
                ASSERT_EQ(table->GetNumFVarChannels(), int(shape.fvarChannels.size()));
                TopologyLevel const &level = refiner->GetLevel(depth);
                for (int channel = 0; channel < table->GetNumFVarChannels(); ++channel) {
                    EXPECT_EQ(table->GetFVarPatchDescriptor(channel).GetType(),
                              Far::PatchDescriptor::QUADS);
                    ReferenceValues const control =
                        getValues(shape.fvarChannels[std::size_t(channel)]);
                    auto const stencils =
                        PatchTableFactory::CreateLocalPointFaceVaryingStencilTable(
                            *refiner, options, channel);
                    ASSERT_TRUE(stencils);
                    ReferenceValues const points = applyStencils<float>(*stencils, control);
                    FarExt::StencilTableFactory::Options ofLevel;
                    ofLevel.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
                    ofLevel.fvarChannel = channel;
                    ofLevel.generateIntermediateLevels = false;
                    ofLevel.maxLevel = depth;
                    auto const refined = FarExt::StencilTableFactory::Create(*refiner, ofLevel);
                    ReferenceValues const values =
                        depth == 0
                            ? control
                            : ReferenceValues(applyStencils<float>(*refined, control)
                                                  .bottomRows(level.GetNumFVarValues(channel)));
                    int patch = 0;
                    for (Index face = 0; face < level.GetNumFaces(); ++face) {
                        CellsOfFace const cells(level, face);
                        for (int half = 0; half < cells.GetNum(); ++half) {
                            int const size = cells.GetNumCorners(half);
                            bool const isSplit = level.IsFaceFVarSplit(face, channel);
                            auto const ofFace = isSplit
                                                    ? level.GetFaceFVarValues(face, channel, half)
                                                    : level.GetFaceFVarValues(face, channel);
                            auto const getLocal = [&](int corner) {
                                return isSplit ? corner : cells.GetLocal(half, corner);
                            };
                            if (cells.HasKites(half)) {
                                auto const mean = [&](std::vector<int> const &corners) {
                                    Eigen::RowVectorXd sum =
                                        Eigen::RowVectorXd::Zero(values.cols());
                                    for (int i : corners) {
                                        sum += values.row(ofFace[getLocal(i % size)]);
                                    }
                                    return Eigen::RowVectorXd(sum / double(corners.size()));
                                };
                                // The middle, or a third of the way from a long side to what is across.
                                std::vector<int> center;
                                for (int i = 0; i < size; ++i) {
                                    center.push_back(i);
                                }
                                if (cells.GetNum() == 2 || level.IsFaceHalf(face)) {
                                    center = {0, 0, 1, 1, (size + 1) / 2, size / 2 + 1};
                                }
                                for (int i = 0; i < size; ++i, ++patch) {
                                    auto const found = table->GetPatchFVarValues(0, patch, channel);
                                    ASSERT_EQ(found.size(), 4);
                                    Eigen::RowVectorXd const expected[] = {
                                        mean({i}), mean({i, i + 1}), mean(center),
                                        mean({i + size - 1, i})};
                                    for (int k = 0; k < 4; ++k) {
                                        ASSERT_LT((points.row(found[k]) - expected[k]).norm(),
                                                  1e-6);
                                    }
                                }
                                continue;
                            }
                            auto const found = table->GetPatchFVarValues(0, patch, channel);
                            ASSERT_EQ(found.size(), 4);
                            for (int k = 0; k < 4; ++k) {
                                ASSERT_LT(
                                    (points.row(found[k]) - values.row(ofFace[getLocal(k)])).norm(),
                                    1e-6)
                                    << "patch " << patch;
                            }
                            ++patch;
                        }
                    }
                    EXPECT_EQ(patch, table->GetNumPatchesTotal());
                }
            }
        }
    }
}

// A program that knows Far and Osd alone.
TEST(PatchChannel, ServesOpenSubdiv) {
    Shape const &shape = GetFeatureShape("cubeOfCharts");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 2,
                                       makeOptions(Sdc::Options::FVAR_LINEAR_CORNERS_ONLY));
    PatchTableFactory::Options options(1);
    options.generateFVarTables = true;
    options.generateFVarLegacyLinearPatches = false;
    auto const table = createTable(*refiner, options);
    ASSERT_TRUE(table);
    FVarChannel const &channel = shape.fvarChannels[0];
    ReferenceValues const points =
        applyStencils<float>(*table->GetLocalPointFaceVaryingStencilTable(), getValues(channel));
    std::vector<float> values;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        for (Eigen::Index k = 0; k < points.cols(); ++k) {
            values.push_back(float(points(i, k)));
        }
    }
    std::vector<Osd::PatchCoord> coords;
    for (int patch = 0; patch < table->GetNumPatchesTotal(); ++patch) {
        coords.emplace_back(PatchMap::GetHandle(patch), 0.25f, 0.75f);
    }
    std::unique_ptr<Osd::CpuPatchTable> const cpuTable(Osd::CpuPatchTable::Create(table.get()));
    int const width = channel.width;
    std::vector<float> results(coords.size() * std::size_t(width));
    Osd::BufferDescriptor const desc(0, width, width);
    ASSERT_TRUE(Osd::CpuEvaluator::EvalPatches(
        values.data(), desc, results.data(), desc, int(coords.size()), coords.data(),
        cpuTable->GetFVarPatchArrayBuffer(), cpuTable->GetFVarPatchIndexBuffer(),
        cpuTable->GetFVarPatchParamBuffer()));
    for (int patch = 0; patch < table->GetNumPatchesTotal(); ++patch) {
        Eigen::RowVectorXd const expected = evaluateChannel(*table, 0, points, {patch, 0.25, 0.75});
        for (int k = 0; k < width; ++k) {
            EXPECT_NEAR(results[std::size_t(patch * width + k)], expected[k], 1e-5);
        }
    }
}

TEST(PatchChannel, RefusesChannelsThatAreNotThere) {
    Shape const &shape = GetFeatureShape("cubeOfCharts");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 2);
    PatchTableFactory::Options options = makePatchOptions(1);
    int const channels[] = {0, int(shape.fvarChannels.size())};
    options.numFVarChannels = 2;
    FarExt::CallStatus status;
    EXPECT_FALSE(PatchTableFactory::Create(*refiner, options, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    EXPECT_NE(status.GetErrorMessage().find("fvarChannelIndices"), std::string::npos);
    options.fvarChannelIndices = channels;
    EXPECT_FALSE(PatchTableFactory::Create(*refiner, options, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    EXPECT_NE(status.GetErrorMessage().find("channel"), std::string::npos);
    EXPECT_FALSE(
        PatchTableFactory::CreateLocalPointFaceVaryingStencilTable(*refiner, options, -1, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    options.numFVarChannels = 0;
    auto const table = PatchTableFactory::Create(*refiner, options);
    ASSERT_TRUE(table);
    EXPECT_EQ(table->GetNumFVarChannels(), 0);
}

} // namespace OpenSubdivHex::Regression::patchChannelTest

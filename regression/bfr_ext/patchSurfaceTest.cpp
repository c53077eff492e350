// SPDX-License-Identifier: Apache-2.0
//
// Patches against surfaces, all over the faces, and those of face-varying channels, too.
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include "regression/far_ext/patchFixture.h"
#include "regression/shapes/featureShapes.h"

#include <cmath>
#include <string>

namespace OpenSubdivHex::Regression::patchSurfaceTest {

using FarExt::PatchMap;
using FarExt::PatchTableFactory;
using FarExt::TopologyRefiner;

namespace {

constexpr int kMaxCorners = 40;

// How far the patches of a shape are from its surface, in terms of its size.
struct Distances {
    double largestAtCorners = 0;
    double meanSquare = 0;
};

// Calls add(place, isCorner) for places of all patches: of vertices and centres of faces, and inside.
template <typename ADD>
void forEachPlace(Far::PatchTable const &table, PatchMap const &map,
                  FarExt::TopologyLevel const &surfaceLevel, ADD const &add) {
    for (int patch = 0; patch < table.GetNumPatchesTotal(); ++patch) {
        bool const isKite = table.GetPatchParam(PatchMap::GetHandle(patch)).NonQuadRoot();
        // Where kites meet in the centre of a face there is a limit, but not inside of a half.
        auto const [size, isHalf] =
            FarExt::SurfaceFaces(surfaceLevel.GetLevel()).GetShape(map.GetFace(patch));
        double const center[2] = {size == 3 ? 1.0 / 3 : 0.5,
                                  size == 3 ? 1.0 / 3 : 0.5 / std::tan(double(EIGEN_PI) / size)};
        auto const &coords = map.GetCoords(patch);
        bool const isAtCenter =
            !isHalf && std::hypot(coords[4] - center[0], coords[5] - center[1]) < 1e-9;
        for (int i = 0; i < (isKite && !isAtCenter ? 1 : 4); i += isKite ? 2 : 1) {
            add(PatchMap::Place{patch, i == 1 || i == 2 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0}, true);
        }
        for (double s : {0.0, 0.7}) {
            for (double t : {0.4, 1.0}) {
                add(PatchMap::Place{patch, s, t}, false);
            }
        }
    }
}

Distances measure(Shape const &shape, TopologyRefiner const &refiner, int depth) {
    ReferenceValues const positions = GetPositions(shape);
    double const size = GetSize(positions);
    PatchSurface const patches(refiner, depth, positions);
    Distances distances;
    if (!patches.IsValid()) {
        return distances;
    }
    PatchMap const map(refiner, depth);
    SurfaceSet<double> const surfaces(refiner, shape.positions);
    int number = 0;
    FarExt::TopologyLevel const &surfaceLevel =
        refiner.GetLevel(refiner.GetHexSchemeOptions().GetSurfaceLevel());
    forEachPlace(
        patches.GetTable(), map, surfaceLevel, [&](PatchMap::Place const &place, bool isCorner) {
            int const face = map.GetFace(place.patch);
            if (!surfaces[face].IsValid()) {
                return;
            }
            double uv[2];
            map.GetFacePlace(place, &uv[0], &uv[1]);
            SurfacePoint const expected = surfaces.Evaluate(face, uv);
            PatchPoint const point = patches.Evaluate(place.patch, place.s, place.t);
            Eigen::Vector3d const difference = point.p - Eigen::Vector3d(expected.p.data());
            if (isCorner) {
                distances.largestAtCorners =
                    std::max(distances.largestAtCorners, difference.norm() / size);
                return;
            }
            double const distance = difference.dot(point.GetNormal()) / size;
            distances.meanSquare += distance * distance;
            ++number;
        });
    distances.meanSquare = std::sqrt(distances.meanSquare / std::max(number, 1));
    return distances;
}

void expectValues(FVarChannel const &channel, TopologyRefiner const &refiner,
                  BfrExt::SurfaceFactory const &factory, Far::PatchTable const &table,
                  PatchMap const &map, int number, double largestMeanSquare) {
    using Value = Numbers<double, 1>;
    std::vector<Value> control(channel.values.size() / std::size_t(channel.width));
    double size = 1;
    for (std::size_t i = 0; i < control.size(); ++i) {
        control[i].values[0] = channel.values[std::size_t(channel.width) * i];
        size = std::max(size, std::abs(control[i].values[0]));
    }
    // The points of patches, behind the values.
    std::vector<Value> points(control.size() +
                              std::size_t(table.GetNumLocalPointsFaceVarying(number)));
    std::copy(control.begin(), control.end(), points.begin());
    Value *const local = points.data() + control.size();
    table.GetLocalPointFaceVaryingStencilTable<double>(number)->UpdateValues(control, local);
    std::vector<Value> ofSurfaces = control;
    if (factory.GetLevel().GetDepth() > 0) {
        ofSurfaces.resize(std::size_t(factory.GetLevel().GetNumFVarValues(number)));
        FarExt::PrimvarRefinerReal<double>(refiner).InterpolateFaceVarying(1, control, ofSurfaces,
                                                                           number);
    }
    double sum = 0;
    int numPlaces = 0;
    forEachPlace(table, map, factory.GetLevel(), [&](PatchMap::Place const &place, bool isCorner) {
        BfrExt::Surface<double> surface;
        ASSERT_TRUE(factory.InitFaceVaryingSurface(map.GetFace(place.patch), &surface, number));
        double uv[2];
        map.GetFacePlace(place, &uv[0], &uv[1]);
        std::vector<double> stencil(std::size_t(surface.GetNumControlPoints()));
        surface.EvaluateStencil(uv, stencil.data());
        double expected = 0;
        surface.ApplyStencilFromMesh(stencil.data(), &ofSurfaces[0].values[0], 1, &expected);
        double weights[20];
        auto const handle = PatchMap::GetHandle(place.patch);
        table.EvaluateBasisFaceVarying<double>(handle, place.s, place.t, weights, nullptr, nullptr,
                                               nullptr, nullptr, nullptr, number);
        double actual = 0;
        auto const values = table.GetPatchFVarValues(handle, number);
        for (int i = 0; i < values.size(); ++i) {
            actual += weights[i] * points[std::size_t(values[i])].values[0];
        }
        double const difference = (actual - expected) / size;
        if (isCorner) {
            EXPECT_LT(std::abs(difference), 1e-13) << "patch " << place.patch;
        } else {
            sum += difference * difference;
            ++numPlaces;
        }
    });
    EXPECT_LT(std::sqrt(sum / numPlaces), largestMeanSquare);
}

std::string getName(testing::TestParamInfo<SurfaceCase> const &info) {
    return info.param.GetName();
}

} // namespace

class PatchSurfaceTest : public testing::TestWithParam<SurfaceCase> {};

// Corners are points of the surface, and between them distances fall from level to level.
TEST_P(PatchSurfaceTest, PatchesAreCloseToSurfaces) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    // Root mean squares by level, of the size, that no shape exceeds.
    bool const hasFirstStep = GetParam().HasFirstStep();
    double const limits[] = {hasFirstStep ? 0.022 : 0.073, hasFirstStep ? 0.004 : 0.012, 0.0026};
    int const numLevels = GetParam().mask == ReferenceMask::Smooth && !hasFirstStep ? 3 : 2;
    for (Shape const &shape : GetParam().IsPlain() ? GetManifoldShapes() : GetAllShapes()) {
        if (shape.GetNumCorners() > kMaxCorners && shape.name != "leftHanded") {
            continue;
        }
        auto const refiner = CreateSurfaceRefiner(shape, GetParam(), numLevels, options);
        int const surfaceLevel = refiner->GetHexSchemeOptions().GetSurfaceLevel();
        for (int level = 0; level < numLevels; ++level) {
            SCOPED_TRACE(testing::Message() << shape.name << ", level " << level);
            Distances const distances = measure(shape, *refiner, surfaceLevel + level);
            EXPECT_LT(distances.largestAtCorners, 1e-13);
            EXPECT_LT(distances.meanSquare, limits[level]);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(, PatchSurfaceTest,
                         testing::Values(kPlainCases[0], kPlainCases[1], kPlainCases[2],
                                         kTruncateCases[2], kTriHexCases[2]),
                         getName);

// Values on both sides of seams, by patches of several levels.
TEST(PatchChannelSurfaceTest, PatchesAreCloseToSurfaces) {
    for (SurfaceCase const &surfaceCase : {kPlainCases[2], kTruncateCases[2]}) {
        for (Shape const &shape : GetFeatureShapes()) {
            if (shape.GetNumCorners() > 64 || shape.fvarChannels.empty()) {
                continue;
            }
            SCOPED_TRACE(testing::Message() << shape.name << ", " << surfaceCase.GetName());
            Sdc::Options sdcOptions;
            sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
            sdcOptions.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_ONLY);
            auto const refiner = CreateSurfaceRefiner(shape, surfaceCase, 3, sdcOptions);
            auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
            int const surfaceLevel = factory->GetLevel().GetDepth();
            for (int const numLevels : {1, 2}) {
                PatchTableFactory::Options options(surfaceLevel + 2 * (numLevels - 1));
                options.minIsolationLevel = surfaceLevel + numLevels - 1;
                options.SetFVarPatchPrecision<double>();
                options.generateFVarTables = true;
                options.generateFVarLegacyLinearPatches = false;
                auto const table = PatchTableFactory::Create(*refiner, options);
                ASSERT_TRUE(table);
                PatchMap const map(*refiner, options);
                for (int channel = 0; channel < table->GetNumFVarChannels(); ++channel) {
                    expectValues(shape.fvarChannels[std::size_t(channel)], *refiner, *factory,
                                 *table, map, channel, numLevels == 1 ? 0.1 : 0.01);
                }
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression::patchSurfaceTest

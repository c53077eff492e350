// SPDX-License-Identifier: Apache-2.0
//
// Patches of several levels: they meet as those of one level do, and come as close as they are asked to.
#include "patchFixture.h"
#include "referenceMatch.h"

#include "far_ext/stencilTableFactory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace OpenSubdivHex::Regression::adaptivePatchTest {

using Far::Index;
using FarExt::PatchTableFactory;

namespace {

// A table in double precision, evaluated for given positions.
class TablePatches {
public:
    TablePatches(FarExt::TopologyRefiner const &refiner, PatchTableFactory::Options options,
                 ReferenceValues const &positions)
        : _numControlVerts(int(positions.rows())) {
        options.SetPatchPrecision<double>();
        FarExt::CallStatus status;
        _table = PatchTableFactory::Create(refiner, options, &status);
        if (!_table) {
            ADD_FAILURE() << status.GetErrorMessage();
            return;
        }
        auto const &stencils = *_table->GetLocalPointStencilTable<double>();
        for (int i = 0; i < stencils.GetNumStencils(); ++i) {
            Eigen::Vector3d point = Eigen::Vector3d::Zero();
            double sum = 0;
            int const offset = stencils.GetOffsets()[std::size_t(i)];
            for (int k = offset; k < offset + stencils.GetSizes()[std::size_t(i)]; ++k) {
                double const weight = stencils.GetWeights()[std::size_t(k)];
                sum += weight;
                point += weight *
                         positions.row(stencils.GetControlIndices()[std::size_t(k)]).transpose();
            }
            EXPECT_NEAR(sum, 1, 1e-10);
            _points.push_back(point);
        }
    }

    bool IsValid() const { return bool(_table); }
    int GetNum() const { return _table->GetNumPatchesTotal(); }
    Index GetPoint(int patch, int i) const { return _table->GetPatchVertices(0, patch)[i]; }

    PatchPoint EvaluateSide(int patch, int side, double part) const {
        double const s[] = {part, 1, 1 - part, 0};
        double const t[] = {0, part, 1, 1 - part};
        return Evaluate(patch, s[side], t[side]);
    }
    PatchPoint Evaluate(int patch, double s, double t) const {
        return EvaluatePatch(*_table, patch, s, t, [&](int i) {
            return _points[std::size_t(GetPoint(patch, i) - _numControlVerts)];
        });
    }

private:
    int const _numControlVerts;
    std::unique_ptr<Far::PatchTable const> _table;
    std::vector<Eigen::Vector3d> _points;
};

double getAngle(Eigen::Vector3d const &a, Eigen::Vector3d const &b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / EIGEN_PI;
}

// All sides of a closed mesh of quads have a patch on either side, with the same points.
void expectToMeet(TablePatches const &patches, double size, bool isSmooth) {
    std::map<std::pair<Index, Index>, std::pair<int, int>> sides;
    for (int patch = 0; patch < patches.GetNum(); ++patch) {
        for (int side = 0; side < 4; ++side) {
            Index const start = patches.GetPoint(patch, 5 * side);
            Index const end = patches.GetPoint(patch, 5 * ((side + 1) % 4));
            ASSERT_TRUE(
                sides.emplace(std::make_pair(start, end), std::make_pair(patch, side)).second);
        }
    }
    for (auto const &entry : sides) {
        auto const other = sides.find({entry.first.second, entry.first.first});
        int const patch = entry.second.first;
        int const side = entry.second.second;
        ASSERT_NE(other, sides.end()) << "patch " << patch << ", side " << side;
        int const patch2 = other->second.first;
        int const side2 = other->second.second;
        EXPECT_EQ(patches.GetPoint(patch, 5 * side + 1),
                  patches.GetPoint(patch2, 5 * ((side2 + 1) % 4) + 2));
        for (double part : {0.1, 0.3, 0.5, 0.8}) {
            PatchPoint const a = patches.EvaluateSide(patch, side, part);
            PatchPoint const b = patches.EvaluateSide(patch2, side2, 1 - part);
            EXPECT_LT((a.p - b.p).norm(), 1e-12 * size);
            if (isSmooth) {
                EXPECT_LT(getAngle(a.GetNormal(), b.GetNormal()), 1e-6)
                    << "patch " << patch << ", side " << side;
            }
        }
    }
}

// The cube as it is, or with a sharp loop, a dart and a semi-sharp edge.
Shape makeCube(bool hasCreases) {
    Shape shape = GetShape("cube");
    if (hasCreases) {
        int const *const verts = shape.faceVertices.data(); // of the first face
        for (int i = 0; i < 4; ++i) {
            shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                           {verts[i], verts[(i + 1) % 4]});
            shape.creaseSharpness.push_back(10);
        }
        // An edge of another face, which is no neighbour of these.
        int const *const others = verts + 4;
        for (int i = 0; i < 4; ++i) {
            int const pair[2] = {others[i], others[(i + 1) % 4]};
            auto const isOfFirst = [&](int vert) {
                return std::find(verts, verts + 4, vert) != verts + 4;
            };
            if (isOfFirst(pair[0]) != isOfFirst(pair[1])) {
                shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), pair, pair + 2);
                shape.creaseSharpness.push_back(1.5f);
                break;
            }
        }
    }
    return shape;
}

Sdc::Options makeOptions() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return options;
}

} // namespace

TEST(AdaptivePatches, Meet) {
    for (bool hasCreases : {false, true}) {
        for (ReferenceMask mask : kMasks) {
            for (int minLevel : {0, 1}) {
                SCOPED_TRACE(testing::Message() << "creases " << hasCreases << ", "
                                                << ToString(mask) << ", from level " << minLevel);
                Shape const shape = makeCube(hasCreases);
                ReferenceValues const positions = GetPositions(shape);
                PatchTableFactory::Options options(3);
                options.minIsolationLevel = minLevel;
                auto const refiner = CreateRefiner(shape, mask, 4, makeOptions());
                TablePatches const patches(*refiner, options, positions);
                ASSERT_TRUE(patches.IsValid());
                ASSERT_NO_FATAL_FAILURE(expectToMeet(patches, GetSize(positions), !hasCreases));
                int const numUniform = PatchTableFactory::Create(*refiner, 3)->GetNumPatchesTotal();
                EXPECT_LT(patches.GetNum(), numUniform);
                FarExt::PatchMap const map(*refiner, options);
                ASSERT_EQ(map.GetNumPatches(), patches.GetNum());
                for (int patch = 0; patch < map.GetNumPatches(); ++patch) {
                    double u = 0;
                    double v = 0;
                    map.GetFacePlace({patch, 0.4, 0.3}, &u, &v);
                    EXPECT_EQ(map.FindPlace(map.GetFace(patch), u, v).patch, patch);
                }
            }
        }
    }
}

// Patches are no finer than they need to be, and close enough.
TEST(AdaptivePatches, KeepTheirTolerance) {
    Shape const &shape = GetShape("cube");
    ReferenceValues const positions = GetPositions(shape);
    double const size = GetSize(positions);
    int const maxLevel = 5;
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, maxLevel + 2, makeOptions());
    std::vector<float> control;
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
        for (int k = 0; k < 3; ++k) {
            control.push_back(float(positions(i, k)));
        }
    }
    FarExt::LimitStencilTableFactoryReal<double>::Options limitOptions;
    limitOptions.level = maxLevel + 1;
    auto const limit = FarExt::LimitStencilTableFactoryReal<double>::Create(*refiner, limitOptions);
    FarExt::TopologyLevel const &fine = refiner->GetLevel(maxLevel + 1);
    int previous = 0;
    for (double tolerance : {1e-2, 1e-3, 1e-4}) {
        PatchTableFactory::Options options(maxLevel);
        options.minIsolationLevel = 1;
        options.tolerance = tolerance * size;
        options.positions = control.data();
        TablePatches const patches(*refiner, options, positions);
        ASSERT_TRUE(patches.IsValid());
        ASSERT_NO_FATAL_FAILURE(expectToMeet(patches, size, true));
        EXPECT_GT(patches.GetNum(), previous);
        previous = patches.GetNum();
        FarExt::PatchMap const map(*refiner, options);
        double largest = 0;
        for (Index face = 0; face < fine.GetNumFaces(); ++face) {
            auto const verts = fine.GetFaceVertices(face);
            if (verts.size() != 6 ||
                fine.GetFaceSurfaceFace(face, 0) != fine.GetFaceSurfaceFace(face, 1)) {
                continue;
            }
            double uv[12];
            fine.GetFaceSurfaceCoords(face, 0, uv);
            for (int i = 0; i < 6; ++i) {
                auto const place =
                    map.FindPlace(fine.GetFaceSurfaceFace(face), uv[2 * i], uv[2 * i + 1]);
                PatchPoint const point = patches.Evaluate(place.patch, place.s, place.t);
                Eigen::Vector3d p = Eigen::Vector3d::Zero();
                int const offset = limit->GetOffsets()[std::size_t(verts[i])];
                for (int k = offset; k < offset + limit->GetSizes()[std::size_t(verts[i])]; ++k) {
                    p += limit->GetWeights()[std::size_t(k)] *
                         positions.row(limit->GetControlIndices()[std::size_t(k)]).transpose();
                }
                largest = std::max(largest, std::abs((p - point.p).dot(point.GetNormal())));
            }
        }
        // It is measured at more places here.
        EXPECT_LT(largest, 1.6 * tolerance * size);
    }
}

// Patches near the eye are refined more, with equal distances otherwise.
TEST(AdaptivePatches, AreFinerNearTheEye) {
    Shape const &shape = GetShape("cube");
    ReferenceValues const positions = GetPositions(shape);
    double const size = GetSize(positions);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 6, makeOptions());
    std::vector<float> const control(shape.positions.begin(), shape.positions.end());
    int numPatches[2][2] = {}; // by side of the eye, and by side of the patch
    for (int side = 0; side < 2; ++side) {
        float const eye[3] = {0, 0, float(side == 0 ? -1.1 * size : 1.1 * size)};
        PatchTableFactory::Options options(4);
        options.minIsolationLevel = 1;
        options.tolerance = 1e-3;
        options.positions = control.data();
        options.eye = eye;
        TablePatches const patches(*refiner, options, positions);
        ASSERT_TRUE(patches.IsValid());
        ASSERT_NO_FATAL_FAILURE(expectToMeet(patches, size, true));
        for (int patch = 0; patch < patches.GetNum(); ++patch) {
            ++numPatches[side][patches.Evaluate(patch, 0.5, 0.5).p[2] > 0 ? 1 : 0];
        }
    }
    EXPECT_GT(numPatches[0][0], 1.3 * numPatches[1][0]);
    EXPECT_GT(numPatches[1][1], 1.3 * numPatches[0][1]);
}

TEST(AdaptivePatches, RefuseWhatIsWrong) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Smooth, 3, makeOptions());
    auto const expect = [&](PatchTableFactory::Options const &options, std::string const &message) {
        FarExt::CallStatus status;
        EXPECT_FALSE(PatchTableFactory::Create(*refiner, options, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_NE(status.GetErrorMessage().find(message), std::string::npos)
            << status.GetErrorMessage();
    };
    PatchTableFactory::Options options(1);
    options.minIsolationLevel = 2;
    expect(options, "levels 2 to 1");
    options = PatchTableFactory::Options(2);
    options.minIsolationLevel = 1;
    options.tolerance = 0.1;
    expect(options, "without positions");
    options.tolerance = -1;
    expect(options, "negative");
    float const eye[3] = {0, 0, 0};
    options.tolerance = 0;
    options.eye = eye;
    expect(options, "eye");
}

} // namespace OpenSubdivHex::Regression::adaptivePatchTest

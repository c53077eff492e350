// SPDX-License-Identifier: Apache-2.0
//
// Patches: against the limit, against one another, and through OpenSubdiv.
#include "patchFixture.h"
#include "referenceMatch.h"
#include "sharpSector.h"

#include "far_ext/executor.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/surfaceFaces.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <string>

namespace OpenSubdivHex::Regression::patchTableTest {

using Far::Index;
using FarExt::LimitSides;
using FarExt::LimitStencilTableFactoryReal;
using FarExt::PatchTableFactory;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;
namespace Osd = OpenSubdiv::Osd;

namespace {

Sdc::Options makeOptions(Sdc::Options::VtxBoundaryInterpolation boundary) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    return options;
}

// Calls check(shape, refiner, mask, level) for small shapes, all masks and sharp boundary rules, at levels from
// that of the surface on.
template <typename CHECK>
void forEachCase(CHECK const &check) {
    constexpr int kMaxCorners = 60;
    auto const forEachLevel = [&](Shape const &shape, FarExt::FirstStep firstStep,
                                  Sdc::Options::VtxBoundaryInterpolation boundary,
                                  ReferenceMask mask, int numLabels = 1) {
        FarExt::HexSchemeOptions schemeOptions;
        schemeOptions.firstStep = firstStep;
        int const maxLevel = mask == ReferenceMask::Smooth ? 2 : 1;
        auto const refiner = CreateRefiner(shape, mask, 0, makeOptions(boundary), schemeOptions);
        TopologyRefiner::UniformOptions options =
            PatchTableFactory::Options(maxLevel).GetRefineUniformOptions();
        for (int face = 0; face < shape.GetNumFaces(); ++face) {
            options.faceLabels.push_back(face % numLabels);
        }
        ASSERT_TRUE(refiner->RefineUniform(options));
        for (int level = schemeOptions.GetSurfaceLevel(); level <= maxLevel; ++level) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary << ", "
                                            << ToString(mask) << ", first step " << int(firstStep)
                                            << ", labels " << numLabels << ", level " << level);
            ASSERT_NO_FATAL_FAILURE(check(shape, *refiner, mask, level));
        }
    };
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumCorners() > kMaxCorners && shape.name != "leftHanded") {
            continue;
        }
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
            for (ReferenceMask mask : kMasks) {
                for (auto firstStep : {FarExt::FirstStep::Same, FarExt::FirstStep::Truncate}) {
                    ASSERT_NO_FATAL_FAILURE(forEachLevel(shape, firstStep, boundary, mask));
                }
            }
        }
    }
    // The other first step knows no tags; labels cut the polygons of vertices in a truncation.
    for (Shape const &shape : GetManifoldShapes()) {
        if (shape.GetNumCorners() <= kMaxCorners) {
            ASSERT_NO_FATAL_FAILURE(forEachLevel(shape, FarExt::FirstStep::TriHex,
                                                 Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
                                                 ReferenceMask::Smooth));
            ASSERT_NO_FATAL_FAILURE(forEachLevel(shape, FarExt::FirstStep::Truncate,
                                                 Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
                                                 ReferenceMask::Smooth, 3));
        }
    }
}

struct LimitValues {
    ReferenceValues points, du, dv;
};

LimitValues evaluateLimit(TopologyRefiner const &refiner, int level,
                          ReferenceValues const &positions) {
    LimitStencilTableFactoryReal<double>::Options options;
    options.level = level;
    options.generateFurtherSides = true;
    auto const table = LimitStencilTableFactoryReal<double>::Create(refiner, options);
    auto const sum = [&](std::vector<double> const &weights) {
        ReferenceValues values = ReferenceValues::Zero(table->GetNumStencils(), positions.cols());
        for (int i = 0; i < table->GetNumStencils(); ++i) {
            int const offset = table->GetOffsets()[std::size_t(i)];
            for (int k = offset; k < offset + table->GetSizes()[std::size_t(i)]; ++k) {
                values.row(i) += weights[std::size_t(k)] *
                                 positions.row(table->GetControlIndices()[std::size_t(k)]);
            }
        }
        return values;
    };
    return {sum(table->GetWeights()), sum(table->GetDuWeights()), sum(table->GetDvWeights())};
}

double getAngle(Eigen::Vector3d const &a, Eigen::Vector3d const &b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / EIGEN_PI;
}

// Whether the faces on a side of a vertex tend to a plane: not so on the wide side of a corner, of two faces or
// more, nor all around one.
bool hasPlane(TopologyLevel const &level, LimitSides const &sides, Index side) {
    SharpSector const sector(level, sides, side);
    bool const isCorner = sector.isCorner || level.IsVertexNonManifold(sides.GetVertex(side));
    return !isCorner || sector.size < 2;
}

// Whether the tangent plane is that of two directions which are far enough apart.
bool isPlane(Eigen::Vector3d const &a, Eigen::Vector3d const &b, double size) {
    return a.cross(b).norm() > 1e-2 * a.norm() * b.norm() && a.norm() > 1e-4 * size &&
           b.norm() > 1e-4 * size;
}

// Calls function(face, half, corner, local) for the corners of all cells that have patches; kites have
// theirs, too.
template <typename FUNCTION>
void forEachCorner(PatchSurface const &surface, FUNCTION const &function) {
    TopologyLevel const &level = surface.GetLevel();
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        CellsOfFace const cells(level, face);
        for (int half = 0; half < cells.GetNum(); ++half) {
            if (surface.GetFirstPatch(face, half) == Far::INDEX_INVALID) {
                continue;
            }
            for (int corner = 0; corner < cells.GetNumCorners(half); ++corner) {
                function(face, half, corner, cells.GetLocal(half, corner));
            }
        }
    }
}

// The patches around the centre of a cell have the lines to it, and tangent planes there, in common.
void expectKitesToMeet(PatchSurface const &surface, double size) {
    TopologyLevel const &level = surface.GetLevel();
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        CellsOfFace const cells(level, face);
        for (int half = 0; half < cells.GetNum(); ++half) {
            Index const first = surface.GetFirstPatch(face, half);
            if (!cells.HasKites(half) || first == Far::INDEX_INVALID) {
                continue;
            }
            int const numCorners = cells.GetNumCorners(half);
            for (int i = 0; i < numCorners; ++i) {
                for (double const part : {0.2, 0.9}) {
                    PatchPoint const a = surface.Evaluate(first + i, 1, part);
                    PatchPoint const b = surface.Evaluate(first + (i + 1) % numCorners, part, 1);
                    EXPECT_LT((a.p - b.p).norm(), 1e-12 * size);
                    if (isPlane(a.ds, a.dt, size) && isPlane(b.ds, b.dt, size)) {
                        EXPECT_LT(getAngle(a.GetNormal(), b.GetNormal()), 1e-6)
                            << "face " << face << ", half " << half << ", kite " << i;
                    }
                }
            }
        }
    }
}

} // namespace

// Corners are limit points, and the tangent planes there are those of the limit, on the side of each patch.
TEST(PatchTable, CornersAreLimits) {
    forEachCase(
        [](Shape const &shape, TopologyRefiner const &refiner, ReferenceMask mask, int depth) {
            ReferenceValues const positions = GetPositions(shape);
            double const size = GetSize(positions);
            PatchSurface const surface(refiner, depth, positions);
            ASSERT_TRUE(surface.IsValid());
            LimitValues const limit = evaluateLimit(refiner, depth, positions);
            TopologyLevel const &level = surface.GetLevel();
            LimitSides const sides(level);
            forEachCorner(surface, [&](Index face, int half, int corner, int local) {
                bool const isKite = CellsOfFace(level, face).HasKites(half);
                Index const patch = surface.GetFirstPatch(face, half) + (isKite ? corner : 0);
                int const i = isKite ? 0 : corner;
                PatchPoint const point =
                    surface.Evaluate(patch, i == 1 || i == 2 ? 1 : 0, i >= 2 ? 1 : 0);
                int const side = sides.FindSide(level, face, local, half);
                Eigen::Vector3d const p = limit.points.row(side);
                EXPECT_LT((point.p - p).norm(), 1e-12 * size)
                    << "face " << face << ", corner " << local;
                Eigen::Vector3d const du = limit.du.row(side);
                Eigen::Vector3d const dv = limit.dv.row(side);
                // Tangents of Smooth are fitted to neighbours, too.
                bool const isFitted =
                    mask == ReferenceMask::Smooth && sides.GetLocalSide(side) == 0 &&
                    level.GetVertexRule(sides.GetVertex(side)) == Sdc::Crease::RULE_SMOOTH;
                if (isPlane(du, dv, size) && isPlane(point.ds, point.dt, size) &&
                    hasPlane(level, sides, side)) {
                    EXPECT_LT(getAngle(point.GetNormal(), du.cross(dv)), isFitted ? 20 : 1e-6)
                        << "face " << face << ", corner " << local;
                }
            });
        });
}

// Both patches of an edge or diagonal have the same four points there, but where one is half as long, and the
// same tangent planes where nothing is sharp.
TEST(PatchTable, PatchesMeet) {
    std::vector<double> const parts = {0.1, 0.25, 0.4, 0.6, 0.75, 0.9};
    forEachCase([&](Shape const &shape, TopologyRefiner const &refiner, ReferenceMask, int depth) {
        ReferenceValues const positions = GetPositions(shape);
        double const size = GetSize(positions);
        PatchSurface const surface(refiner, depth, positions);
        ASSERT_TRUE(surface.IsValid());
        TopologyLevel const &level = surface.GetLevel();
        auto const compare = [&](PatchPoint const &a, PatchPoint const &b, bool isSharp,
                                 std::string const &name) {
            EXPECT_LT((a.p - b.p).norm(), 1e-12 * size) << name;
            if (!isSharp && isPlane(a.ds, a.dt, size) && isPlane(b.ds, b.dt, size)) {
                EXPECT_LT(getAngle(a.GetNormal(), b.GetNormal()), 1e-6) << name;
            }
        };
        LimitSides const sides(level);
        auto const haveNoPlane = [&](Index face, int half, int local, int otherLocal) {
            return !hasPlane(level, sides, sides.FindSide(level, face, local, half)) ||
                   !hasPlane(level, sides, sides.FindSide(level, face, otherLocal, half));
        };
        expectKitesToMeet(surface, size);
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            if (!surface.HasSide(edge, 0) || !surface.HasSide(edge, 1)) {
                continue;
            }
            auto const faces = level.GetEdgeFaces(edge);
            auto const locals = level.GetEdgeFaceLocalIndices(edge);
            int const faceSize = level.GetFaceVertices(faces[0]).size();
            bool const isSharp =
                level.IsEdgeInfSharp(edge) ||
                haveNoPlane(faces[0], CellsOfFace(level, faces[0]).GetHalfOfEdge(locals[0]),
                            locals[0], (locals[0] + 1) % faceSize);
            for (double part : parts) {
                compare(surface.EvaluateSide(faces[0], locals[0], 0, part),
                        surface.EvaluateSide(faces[1], locals[1], 0, 1 - part), isSharp,
                        "edge " + std::to_string(edge));
            }
        }
        for (Index face = 0; face < level.GetNumFaces(); ++face) {
            CellsOfFace const cells(level, face);
            if (cells.GetNum() == 1 || surface.GetFirstPatch(face, 0) == Far::INDEX_INVALID ||
                surface.GetFirstPatch(face, 1) == Far::INDEX_INVALID) {
                continue;
            }
            bool const isSharp = Sdc::Crease::IsInfinite(level.GetFaceDiagonalSharpness(face)) ||
                                 haveNoPlane(face, 0, FarExt::kDiagonalStart, cells.end);
            for (double part : parts) {
                compare(surface.EvaluateSide(face, -1, 0, part),
                        surface.EvaluateSide(face, -1, 1, 1 - part), isSharp,
                        "diagonal of face " + std::to_string(face));
            }
            if (cells.HasKites(0) || cells.HasKites(1)) {
                continue;
            }
            Index const a = surface.GetFirstPatch(face, 0);
            Index const b = surface.GetFirstPatch(face, 1);
            EXPECT_EQ(surface.GetPoint(a, 0), surface.GetPoint(b, 5));
            EXPECT_EQ(surface.GetPoint(a, 1), surface.GetPoint(b, 7));
            EXPECT_EQ(surface.GetPoint(a, 7), surface.GetPoint(b, 1));
            EXPECT_EQ(surface.GetPoint(a, 5), surface.GetPoint(b, 0));
        }
    });
}

// Whatever is linear in the plane is so on patches: weights sum to 1, and a flat mesh has flat patches.
TEST(PatchTable, WeightsSumToOne) {
    forEachCase([](Shape const &, TopologyRefiner const &refiner, ReferenceMask, int depth) {
        PatchTableFactory::Options options(depth);
        options.SetPatchPrecision<double>();
        auto const table = PatchTableFactory::Create(refiner, options);
        ASSERT_TRUE(table);
        for (auto const *stencils : {table->GetLocalPointStencilTable<double>(),
                                     table->GetLocalPointVaryingStencilTable<double>()}) {
            ASSERT_TRUE(stencils);
            for (int i = 0; i < stencils->GetNumStencils(); ++i) {
                int const offset = stencils->GetOffsets()[std::size_t(i)];
                double sum = 0;
                int last = -1;
                for (int k = offset; k < offset + stencils->GetSizes()[std::size_t(i)]; ++k) {
                    sum += stencils->GetWeights()[std::size_t(k)];
                    ASSERT_GT(stencils->GetControlIndices()[std::size_t(k)], last);
                    last = stencils->GetControlIndices()[std::size_t(k)];
                }
                ASSERT_NEAR(sum, 1, 1e-11) << "point " << i;
            }
        }
    });
}

// Away from corners, too, patches are close to the limit, and come closer in each level, by a factor near 8 where nothing is sharp.
TEST(PatchTable, IsCloseToTheLimit) {
    for (char const *name : {"cube", "icosahedron", "quadGrid", "creaseLoopQuads"}) {
        Shape const &shape = [&]() -> Shape const & {
            for (Shape const &found : GetAllShapes()) {
                if (found.name == name) {
                    return found;
                }
            }
            throw std::out_of_range(name);
        }();
        SCOPED_TRACE(name);
        ReferenceValues const positions = GetPositions(shape);
        int const maxLevel = 3;
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, maxLevel + 1,
                                           makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        LimitValues const limit = evaluateLimit(*refiner, maxLevel + 1, positions);
        TopologyLevel const &fine = refiner->GetLevel(maxLevel + 1);
        std::vector<double> errors;
        for (int depth = 1; depth <= maxLevel; ++depth) {
            PatchSurface const surface(*refiner, depth, positions);
            ASSERT_TRUE(surface.IsValid());
            FarExt::PatchMap const map(*refiner, PatchTableFactory::Options(depth));
            double sum = 0;
            int number = 0;
            for (Index face = 0; face < fine.GetNumFaces(); ++face) {
                auto const verts = fine.GetFaceVertices(face);
                if (verts.size() != 6 ||
                    fine.GetFaceSurfaceFace(face, 0) != fine.GetFaceSurfaceFace(face, 1)) {
                    continue; // inside of base faces
                }
                double uv[12];
                fine.GetFaceSurfaceCoords(face, 0, uv);
                for (int i = 0; i < 6; ++i) {
                    auto const place =
                        map.FindPlace(fine.GetFaceSurfaceFace(face), uv[2 * i], uv[2 * i + 1]);
                    ASSERT_NE(place.patch, Far::INDEX_INVALID);
                    PatchPoint const point = surface.Evaluate(place.patch, place.s, place.t);
                    Eigen::Vector3d const p = limit.points.row(verts[i]);
                    double const distance = (p - point.p).dot(point.GetNormal());
                    sum += distance * distance;
                    ++number;
                }
            }
            errors.push_back(std::sqrt(sum / number) / GetSize(positions));
        }
        EXPECT_LT(errors[0], shape.name == "cube" ? 1.3e-2 : 4e-3);
        EXPECT_LT(errors[1], errors[0] / 3);
        EXPECT_LT(errors[2], errors[1] / 3);
    }
}

// A program that knows Far and Osd alone.
TEST(PatchTable, ServesOpenSubdiv) {
    Shape const &shape = GetShape("cube");
    ReferenceValues const positions = GetPositions(shape);
    PatchTableFactory::Options const options(2);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 3,
                                       makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
    PatchSurface const surface(*refiner, 2, positions);
    auto const table = PatchTableFactory::Create(*refiner, options);
    ASSERT_TRUE(table);
    int const numControl = int(positions.rows());
    ASSERT_EQ(table->GetNumPatchesTotal(), 21 * 6);
    int const numPoints = table->GetNumLocalPoints();
    EXPECT_EQ(table->GetLocalPointStencilTable()->GetNumControlVertices(), numControl);
    std::unique_ptr<Osd::CpuVertexBuffer> const buffer(
        Osd::CpuVertexBuffer::Create(3, numControl + numPoints));
    std::vector<float> control;
    for (int i = 0; i < numControl; ++i) {
        for (int k = 0; k < 3; ++k) {
            control.push_back(float(positions(i, k)));
        }
    }
    buffer->UpdateData(control.data(), 0, numControl);
    Osd::BufferDescriptor const src(0, 3, 3);
    Osd::BufferDescriptor const local(3 * numControl, 3, 3);
    ASSERT_TRUE(Osd::CpuEvaluator::EvalStencils(buffer.get(), src, buffer.get(), local,
                                                table->GetLocalPointStencilTable()));
    Far::PatchMap const map(*table);
    std::vector<Osd::PatchCoord> coords;
    for (int patch = 0; patch < table->GetNumPatchesTotal(); ++patch) {
        auto const *const handle = map.FindPatch(patch, 0.3, 0.6);
        ASSERT_TRUE(handle);
        EXPECT_EQ(handle->patchIndex, patch);
        EXPECT_EQ(handle->vertIndex, FarExt::PatchMap::GetHandle(patch).vertIndex);
        coords.emplace_back(*handle, 0.3f, 0.6f);
    }
    struct CoordBuffer {
        Osd::PatchCoord *BindCpuBuffer() { return coords.data(); }
        std::vector<Osd::PatchCoord> &coords;
    } coordBuffer{coords};
    std::unique_ptr<Osd::CpuPatchTable> const cpuTable(Osd::CpuPatchTable::Create(table.get()));
    std::unique_ptr<Osd::CpuVertexBuffer> const out(
        Osd::CpuVertexBuffer::Create(3, int(coords.size())));
    ASSERT_TRUE(Osd::CpuEvaluator::EvalPatches(buffer.get(), src, out.get(), src,
                                               int(coords.size()), &coordBuffer, cpuTable.get()));
    for (std::size_t i = 0; i < coords.size(); ++i) {
        float const *const p = out->BindCpuBuffer() + 3 * i;
        Eigen::Vector3d const point(p[0], p[1], p[2]);
        EXPECT_LT((point - surface.Evaluate(Index(i), 0.3, 0.6).p).norm(), 1e-5);
    }
    // Varying: the corners of a patch are vertices of the level, and weights those of bilinear functions.
    EXPECT_EQ(table->GetVaryingVertices().size(), 4 * table->GetNumPatchesTotal());
    EXPECT_EQ(table->GetLocalPointVaryingStencilTable()->GetNumStencils(),
              refiner->GetLevel(2).GetNumVertices());
}

// Behind the vertices of a level the points are the same.
TEST(PatchTable, LocalPointsCanBeAppended) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 2);
    FarExt::StencilTableFactory::Options levels;
    levels.maxLevel = 1;
    auto const base = FarExt::StencilTableFactory::Create(*refiner, levels);
    auto const local = PatchTableFactory::CreateLocalPointStencilTable(*refiner, 1);
    auto const table = PatchTableFactory::Create(*refiner, 1);
    ASSERT_TRUE(base && local && table);
    EXPECT_EQ(local->GetWeights(), table->GetLocalPointStencilTable()->GetWeights());
    EXPECT_EQ(local->GetControlIndices(), table->GetLocalPointStencilTable()->GetControlIndices());
    FarExt::CallStatus status;
    auto const joined =
        PatchTableFactory::AppendLocalPointStencilTable(base.get(), local.get(), &status);
    ASSERT_TRUE(joined) << status.GetErrorMessage();
    ASSERT_EQ(joined->GetNumStencils(), base->GetNumStencils() + local->GetNumStencils());
    for (int i = 0; i < local->GetNumStencils(); ++i) {
        auto const a = joined->GetStencil(base->GetNumStencils() + i);
        auto const b = local->GetStencil(i);
        ASSERT_EQ(a.GetSize(), b.GetSize());
        for (int k = 0; k < a.GetSize(); ++k) {
            ASSERT_EQ(a.GetVertexIndices()[k], b.GetVertexIndices()[k]);
            ASSERT_EQ(a.GetWeights()[k], b.GetWeights()[k]);
        }
    }
    EXPECT_FALSE(PatchTableFactory::AppendLocalPointStencilTable(nullptr, local.get(), &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
}

TEST(PatchTable, RefusesWhatHasNoPatches) {
    auto const expect = [](Shape const &shape, Sdc::Options sdcOptions, int numLevels, int level,
                           FarExt::StatusCode code, std::string const &message,
                           FarExt::HexSchemeOptions schemeOptions = {}) {
        auto const refiner =
            CreateRefiner(shape, ReferenceMask::Smooth, numLevels, sdcOptions, schemeOptions);
        ASSERT_TRUE(refiner);
        FarExt::CallStatus status;
        EXPECT_FALSE(PatchTableFactory::Create(*refiner, level, &status));
        EXPECT_EQ(status.GetCode(), code);
        EXPECT_NE(status.GetErrorMessage().find(message), std::string::npos)
            << status.GetErrorMessage();
        EXPECT_EQ(FarExt::PatchMap(*refiner, level, &status).GetNumPatches(), 0);
        EXPECT_EQ(status.GetCode(), code);
    };
    auto const smooth = makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    expect(GetShape("quadGrid"), makeOptions(Sdc::Options::VTX_BOUNDARY_NONE), 2, 1,
           FarExt::StatusCode::Unsupported, "VTX_BOUNDARY_NONE");
    expect(GetShape("cube"), smooth, 2, 2, FarExt::StatusCode::InvalidArgument, "level behind it");
    expect(GetShape("cube"), smooth, 2, -1, FarExt::StatusCode::InvalidArgument, "level -1");
    FarExt::HexSchemeOptions dooSabin;
    dooSabin.schemeType = FarExt::SchemeType::DooSabin;
    expect(GetShape("cube"), smooth, 2, 1, FarExt::StatusCode::Unsupported, "hexagonal", dooSabin);
    // A closed mesh has no such boundary.
    auto const closed = CreateRefiner(GetShape("cube"), ReferenceMask::Smooth, 2,
                                      makeOptions(Sdc::Options::VTX_BOUNDARY_NONE));
    EXPECT_TRUE(PatchTableFactory::Create(*closed, 1));
}

// Holes have no patches, halves of hexagons among them.
TEST(PatchTable, LeavesHolesOut) {
    Shape shape = GetShape("cube");
    shape.holeFaces = {0};
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 3);
    auto const table = PatchTableFactory::Create(*refiner, 2);
    ASSERT_TRUE(table);
    EXPECT_EQ(table->GetNumPatchesTotal(), 21 * 5);
    FarExt::PatchMap const map(*refiner, 2);
    EXPECT_EQ(map.FindPlace(0, 0.3, 0.3).patch, Far::INDEX_INVALID);
    for (int patch = 0; patch < map.GetNumPatches(); ++patch) {
        EXPECT_NE(map.GetBaseFace(patch), 0);
    }
}

// Places in faces lead to patches and back, and patches fill the faces.
TEST(PatchMap, FindsPlaces) {
    forEachCase(
        [](Shape const &shape, TopologyRefiner const &refiner, ReferenceMask mask, int depth) {
            if (mask != ReferenceMask::Smooth) {
                return;
            }
            FarExt::PatchMap const map(refiner, depth);
            FarExt::SurfaceFaces const faces(
                refiner.GetLevel(refiner.GetHexSchemeOptions().GetSurfaceLevel()).GetLevel());
            ASSERT_EQ(map.GetNumFaces(), faces.GetNumFaces());
            std::vector<double> areas(std::size_t(map.GetNumFaces()), 0);
            for (int patch = 0; patch < map.GetNumPatches(); ++patch) {
                auto const &q = map.GetCoords(patch);
                for (std::size_t i = 0; i < 4; ++i) {
                    std::size_t const next = (i + 1) % 4;
                    areas[std::size_t(map.GetFace(patch))] +=
                        (q[2 * i] * q[2 * next + 1] - q[2 * next] * q[2 * i + 1]) / 2;
                }
                for (double s : {0.125, 0.5, 0.8}) {
                    double u = 0;
                    double v = 0;
                    map.GetFacePlace({patch, s, 0.3}, &u, &v);
                    auto const place = map.FindPlace(map.GetFace(patch), u, v);
                    ASSERT_EQ(place.patch, patch);
                    EXPECT_NEAR(place.s, s, 1e-12);
                    EXPECT_NEAR(place.t, 0.3, 1e-12);
                }
            }
            for (int face = 0; face < map.GetNumFaces(); ++face) {
                int const size = faces.GetShape(face).size;
                double const area = size == 3 ? 0.5 : size / (4 * std::tan(EIGEN_PI / size));
                EXPECT_NEAR(areas[std::size_t(face)], faces.IsHole(face) ? 0 : area, 1e-12)
                    << shape.name << ", face " << face;
            }
            EXPECT_EQ(map.FindPlace(-1, 0, 0).patch, Far::INDEX_INVALID);
            EXPECT_EQ(map.FindPlace(map.GetNumFaces(), 0, 0).patch, Far::INDEX_INVALID);
        });
}

TEST(PatchTable, IsTheSameForAnyNumberOfThreads) {
    Shape const &shape = GetShape("icosahedron");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 4);
    int const before = FarExt::GetNumThreads();
    FarExt::SetNumThreads(1);
    auto const alone = PatchTableFactory::Create(*refiner, 3);
    FarExt::SetNumThreads(3);
    auto const together = PatchTableFactory::Create(*refiner, 3);
    FarExt::SetNumThreads(before);
    ASSERT_TRUE(alone && together);
    EXPECT_EQ(alone->GetLocalPointStencilTable()->GetWeights(),
              together->GetLocalPointStencilTable()->GetWeights());
    EXPECT_EQ(alone->GetPatchControlVerticesTable(), together->GetPatchControlVerticesTable());
}

} // namespace OpenSubdivHex::Regression::patchTableTest

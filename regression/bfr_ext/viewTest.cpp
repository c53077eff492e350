// SPDX-License-Identifier: Apache-2.0
//
// Trees of cells made for a view: how far facets are from the surface, and what is left out.
#include "picture.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"
#include "turnedFacets.h"

#include "bfr_ext/cell/cellGrid.h"
#include "bfr_ext/cell/cellValues.h"
#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/view.h"
#include "far_ext/executor.h"
#include "far_ext/limit/cellPatch.h"
#include "far_ext/limit/limitRows.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <numeric>
#include <random>

namespace OpenSubdivHex::Regression::viewTest {

using BfrExt::Camera;
using BfrExt::CellForest;
using BfrExt::CellTree;
using BfrExt::CellVisibility;
using BfrExt::Polyline;
using BfrExt::Surface;
using BfrExt::View;
using BfrExt::internal::BaseType;
using BfrExt::internal::CellFacing;
using BfrExt::internal::CellGrid;
using BfrExt::internal::CellMeasures;
using BfrExt::internal::CellRules;
using BfrExt::internal::CellValues;
using BfrExt::internal::RefinedCells;

namespace {

/// The cells of a surface, made apart from it.
struct BaseCells {
    /// \param meshPoints  of the surface level
    BaseCells(FarExt::TopologyRefiner const &refiner, std::vector<double> const &meshPoints)
        : _refiner(refiner), _meshPoints(meshPoints) {}

    CellValues Make(int face) {
        CellValues values;
        set(face, values);
        return values;
    }
    void Make(int face, RefinedCells &cells) { set(face, cells); }

private:
    template <typename CELLS>
    void set(int face, CELLS &cells) {
        FarExt::internal::CellPatch cell;
        int const level = _refiner.GetHexSchemeOptions().GetSurfaceLevel();
        GatherBaseCell(FarExt::SurfaceFaces(_refiner.GetLevel(level).GetLevel()), face,
                       _refiner.GetSchemeOptions(), cell);
        std::vector<double> points;
        for (Far::Index const vert : cell.patch.sources) {
            double const *const p = &_meshPoints[3 * std::size_t(vert)];
            points.insert(points.end(), p, p + 3);
        }
        CellRules const rules = {_refiner.GetSchemeOptions(),
                                 FarExt::internal::GetStepsToLimit(_refiner.GetHexSchemeOptions()),
                                 FarExt::Interpolation::Vertex};
        cells.SetBase(BaseType(_types.Find(cell, rules)), points.data(), 3);
    }

    FarExt::TopologyRefiner const &_refiner;
    std::vector<double> const &_meshPoints;
    BfrExt::internal::CellTypes _types;
};

Vector3 add(Vector3 const &a, Vector3 const &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

/// The least coordinates and the largest.
std::array<Vector3, 2> getBox(std::vector<double> const &positions) {
    Vector3 least = ToVector(positions.data());
    Vector3 largest = least;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        least[i % 3] = std::min(least[i % 3], positions[i]);
        largest[i % 3] = std::max(largest[i % 3], positions[i]);
    }
    return {least, largest};
}

/// Cameras around a shape that look at it, and some within it.
Camera makeRandomCamera(std::vector<double> const &positions, std::mt19937 &random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    auto const [least, largest] = getBox(positions);
    double const size = GetDistance(least, largest);
    double const distance = size * (0.2 + 1.2 * std::abs(uniform(random)));
    Vector3 const direction = Normalize({uniform(random), uniform(random), uniform(random)});
    Camera camera;
    for (std::size_t k = 0; k < 3; ++k) {
        camera.target[k] = (least[k] + largest[k]) / 2 + 0.2 * size * uniform(random);
        camera.eye[k] = camera.target[k] + distance * direction[k];
        camera.up[k] = uniform(random);
    }
    camera.fieldOfView = 45 + 30 * uniform(random);
    camera.width = 320;
    camera.height = 200;
    return camera;
}

std::unique_ptr<FarExt::TopologyRefiner> makeRefiner(Shape const &shape,
                                                     ReferenceMask mask = ReferenceMask::Smooth) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    return CreateRefiner(shape, mask, 0, options);
}

/// Calls function(cell, values) for all cells of a tree that are not refined.
template <typename FUNCTION>
void forLeaves(CellTree const &tree, int cell, CellValues const &values, FUNCTION const &function) {
    if (!tree.IsRefined(cell)) {
        function(cell, values);
        return;
    }
    for (int i = 0; i < tree.GetNumChildren(cell); ++i) {
        CellValues child;
        child.SetChild(values, i);
        forLeaves(tree, tree.GetFirstChild(cell) + i, child, function);
    }
}

/// Calls function(values) for all cells some steps on.
template <typename FUNCTION>
void forDescendants(CellValues const &values, int numSteps, FUNCTION const &function) {
    if (numSteps == 0) {
        function(values);
        return;
    }
    for (std::size_t i = 0; i < values.GetType().GetChildren().size(); ++i) {
        CellValues child;
        child.SetChild(values, int(i));
        forDescendants(child, numSteps - 1, function);
    }
}

std::vector<Vector3> getCorners(CellValues const &values) {
    std::vector<Vector3> corners(std::size_t(values.GetType().GetNumCorners()));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        values.EvaluateCorner(int(i), corners[i].data());
    }
    return corners;
}

/// The plane of the corners: a point, and the normal.
std::array<Vector3, 2> getPlane(std::vector<Vector3> const &corners) {
    Vector3 area = {};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        area = add(area,
                   Cross(Subtract(corners[i], corners[0]), Subtract(corners[i + 1], corners[0])));
    }
    return {corners[0], Normalize(area)};
}

std::vector<Shape> getShapes() {
    std::vector<Shape> shapes;
    for (char const *const name : {"cube", "icosahedron", "torus", "mixedPatch", "prism7"}) {
        for (Shape const &shape : GetManifoldShapes()) {
            if (shape.name == name) {
                shapes.push_back(shape);
            }
        }
    }
    for (char const *const name : {"mixedSharpnessQuads", "creasedBall", "cornersTriangles"}) {
        shapes.push_back(GetFeatureShape(name));
    }
    return shapes;
}

/// Shapes without tags, and with tags and flaws.
std::vector<Shape> const &getManyShapes() {
    static std::vector<Shape> const kShapes = [] {
        std::vector<Shape> shapes = GetManifoldShapes();
        shapes.insert(shapes.end(), GetFeatureShapes().begin(), GetFeatureShapes().end());
        return shapes;
    }();
    return kShapes;
}

} // namespace

TEST(View, IsInvalidForWrongArguments) {
    auto const isValid = [](auto change) {
        Camera camera;
        View::Options options;
        change(camera, options);
        return View(camera, options).IsValid();
    };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(isValid([](Camera &, View::Options &) {}));
    EXPECT_FALSE(isValid([](Camera &camera, View::Options &) { camera.eye[2] = 0; }));
    EXPECT_FALSE(isValid([&](Camera &camera, View::Options &) { camera.eye[2] = nan; }));
    EXPECT_FALSE(isValid([](Camera &camera, View::Options &) { camera.eye[2] = INFINITY; }));
    EXPECT_FALSE(isValid([](Camera &camera, View::Options &) { camera.up[1] = 0; }));
    EXPECT_FALSE(isValid([&](Camera &camera, View::Options &) { camera.up[0] = nan; }));
    EXPECT_FALSE(isValid([](Camera &camera, View::Options &) { camera.fieldOfView = 180; }));
    EXPECT_FALSE(isValid([](Camera &camera, View::Options &) { camera.fieldOfView = 0; }));
    EXPECT_FALSE(isValid([](Camera &camera, View::Options &) { camera.width = 0; }));
    EXPECT_FALSE(isValid([](Camera &camera, View::Options &) { camera.height = -5; }));
    EXPECT_FALSE(isValid([](Camera &, View::Options &options) { options.SetFlatness(0); }));
    EXPECT_FALSE(isValid([&](Camera &, View::Options &options) { options.SetFlatness(nan); }));
    EXPECT_FALSE(isValid([](Camera &, View::Options &options) { options.SetEdgeLength(-1); }));
    EXPECT_FALSE(isValid([](Camera &, View::Options &options) { options.SetMaxLevel(13); }));
    EXPECT_FALSE(isValid([](Camera &, View::Options &options) { options.SetMaxLevel(-1); }));
    EXPECT_FALSE(isValid([](Camera &, View::Options &options) { options.SetHysteresis(1.5); }));
    EXPECT_TRUE(
        isValid([](Camera &, View::Options &options) { options.SetFlatness(0).SetEdgeLength(3); }));
}

// Another direction is up where a camera looks along that, as in a view from the top.
TEST(View, LooksAlongWhatIsUp) {
    Shape const &shape = GetShape("cube");
    auto const refiner = makeRefiner(shape);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    struct Look {
        std::size_t axis;
        Vector3 up;
    };
    for (auto const &[axis, up] : {Look{0, {0, 0, -1}}, Look{1, {0, 0, -1}}, Look{2, {0, 1, 0}}}) {
        for (double const distance : {5.0, -5.0}) {
            Camera camera;
            std::fill_n(camera.eye, 3, 0.25);
            std::fill_n(camera.target, 3, 0.25);
            std::fill_n(camera.up, 3, 0.0);
            camera.eye[axis] += distance;
            camera.up[axis] = 2;
            View const view(camera);
            ASSERT_TRUE(view.IsValid());
            std::copy_n(up.data(), 3, camera.up);
            View const turned(camera);
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_EQ(view.GetCamera().up[k], up[k]);
                EXPECT_EQ(view.GetCamera().eye[k], camera.eye[k]);
                EXPECT_EQ(turned.GetCamera().up[k], up[k]);
            }
            View::Counts counts;
            View::Counts ofTurned;
            view.MakeForest<double>(*factory, shape.positions.data(), 3, nullptr, &counts);
            turned.MakeForest<double>(*factory, shape.positions.data(), 3, nullptr, &ofTurned);
            EXPECT_GT(counts.cellsByLevel.size(), 1u);
            EXPECT_EQ(counts.cellsByLevel, ofTurned.cellsByLevel);
        }
    }
}

TEST(View, RefinesNothingWhereItIsInvalid) {
    Shape const &shape = GetShape("cube");
    auto const refiner = makeRefiner(shape);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    Camera same;
    same.eye[2] = 0;
    Camera wide;
    wide.fieldOfView = 180;
    for (View const &view :
         {View(same), View(wide), View(Camera(), View::Options().SetMaxLevel(-1)),
          View(Camera(), View::Options().SetMaxLevel(1 << 30))}) {
        ASSERT_FALSE(view.IsValid());
        View::Counts counts;
        counts.outside = 7;
        FarExt::CallStatus status;
        CellForest const forest =
            view.MakeForest<double>(*factory, shape.positions.data(), 3, nullptr, &counts, &status);
        EXPECT_EQ(forest.GetNumBoundaryPoints(), 8);
        EXPECT_EQ(counts.cellsByLevel, std::vector<long>{6});
        EXPECT_EQ(counts.outside, 0);
        std::vector<CellVisibility> const visible = {CellVisibility::Visible};
        EXPECT_EQ(counts.visibilities, std::vector<std::vector<CellVisibility>>(6, visible));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    }
}

// A sheet of 16 squares, whose twelve at the free border have no surface, but for a hole.
TEST(View, NamesTheFirstFaceWithoutASurface) {
    constexpr int kSquares = 4;
    Shape shape;
    for (int y = 0; y <= kSquares; ++y) {
        for (int x = 0; x <= kSquares; ++x) {
            shape.positions.insert(shape.positions.end(), {double(x), double(y), 0.1 * x * y});
            if (x < kSquares && y < kSquares) {
                int const v = y * (kSquares + 1) + x;
                shape.faceVertices.insert(shape.faceVertices.end(),
                                          {v, v + 1, v + kSquares + 2, v + kSquares + 1});
                shape.faceSizes.push_back(4);
            }
        }
    }
    shape.holeFaces = {0};
    Camera camera;
    camera.eye[2] = 20;
    View const view(camera);
    for (bool const isFree : {true, false}) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(isFree ? Sdc::Options::VTX_BOUNDARY_NONE
                                                   : Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, options);
        auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
        BfrExt::ViewBounds bounds(*factory);
        FarExt::CallStatus found[3];
        CellForest const forest =
            view.MakeForest(*factory, shape.positions.data(), 3, nullptr, nullptr, &found[0]);
        for (int i = 1; i < 3; ++i) {
            view.MakeForest(bounds, shape.positions.data(), 3, nullptr, nullptr, &found[i]);
        }
        for (FarExt::CallStatus const &status : found) {
            EXPECT_EQ(status.GetCode(),
                      isFree ? FarExt::StatusCode::Unsupported : FarExt::StatusCode::Ok);
            EXPECT_EQ(status.GetComponentIndex(), isFree ? 1 : Far::INDEX_INVALID);
        }
        EXPECT_GT(forest.GetTree(5).GetNumCells(), 1);
        EXPECT_EQ(forest.GetTree(1).GetNumCells() == 1, isFree);
    }
}

TEST(View, IgnoresForestsOfOtherMeshes) {
    Shape const &shape = GetShape("cube");
    auto const refiner = makeRefiner(shape);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    Camera camera;
    camera.eye[2] = 5;
    View const view(camera);
    auto const count = [&](CellForest const *previous) {
        View::Counts counts;
        view.MakeForest<double>(*factory, shape.positions.data(), 3, previous, &counts);
        return counts.cellsByLevel;
    };
    std::vector<long> const expected = count(nullptr);
    for (char const *const name : {"polygon4", "icosahedron"}) {
        auto const other = makeRefiner(GetShape(name));
        CellForest forest(*other);
        for (int face = 0; face < forest.GetNumFaces(); ++face) {
            forest.SetTree(face, CellTree(forest.GetTree(face).GetFaceSize(), 3));
        }
        EXPECT_EQ(count(&forest), expected);
    }
    // As many trees, but of triangles.
    CellForest forest(*refiner);
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        forest.SetTree(face, CellTree(3, 3));
    }
    EXPECT_EQ(count(&forest), expected);
}

TEST(View, FacetsAreCloseToTheSurfaceInThePicture) {
    constexpr int kMaxLevel = 6;
    constexpr double kPixels = 1;
    std::mt19937 random(3);
    for (Shape const &shape : getShapes()) {
        SCOPED_TRACE(shape.name);
        for (auto const mask : {ReferenceMask::Smooth, ReferenceMask::Average}) {
            auto const refiner = makeRefiner(shape, mask);
            BaseCells cells(*refiner, shape.positions);
            auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
            Camera const camera = makeRandomCamera(shape.positions, random);
            Picture const picture(camera);
            View const view(camera, View::Options().SetFlatness(kPixels).SetMaxLevel(kMaxLevel));
            CellForest const forest = view.MakeForest<double>(*factory, shape.positions.data(), 3);
            for (int face = 0; face < refiner->GetLevel(0).GetNumFaces(); ++face) {
                CellTree const &tree = forest.GetTree(face);
                forLeaves(tree, 0, cells.Make(face), [&](int cell, CellValues const &values) {
                    if (tree.GetLevel(cell) == kMaxLevel) {
                        return;
                    }
                    std::array<Vector3, 2> const plane = getPlane(getCorners(values));
                    forDescendants(values, 2, [&](CellValues const &part) {
                        for (Vector3 const &p : getCorners(part)) {
                            double const height = Dot(plane[1], Subtract(p, plane[0]));
                            Vector3 const foot = Subtract(p, Scale(plane[1], height));
                            if (picture.HasPoint(p)) {
                                ASSERT_LE(picture.GetDistance(p, foot), kPixels)
                                    << "face " << face << ", cell " << cell;
                            }
                        }
                    });
                });
            }
        }
    }
}

TEST(View, SidesAreAsShortAsIsAskedFor) {
    Shape const &shape = GetShape("cube");
    auto const refiner = makeRefiner(shape);
    BaseCells cells(*refiner, shape.positions);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    std::mt19937 random(8);
    Camera const camera = makeRandomCamera(shape.positions, random);
    Picture const picture(camera);
    View const view(camera, View::Options().SetFlatness(0).SetEdgeLength(20).SetMaxLevel(9));
    CellForest const forest = view.MakeForest<double>(*factory, shape.positions.data(), 3);
    for (int face = 0; face < 6; ++face) {
        CellTree const &tree = forest.GetTree(face);
        ASSERT_LT(tree.GetMaxLevel(), 9);
        forLeaves(tree, 0, cells.Make(face), [&](int, CellValues const &values) {
            std::vector<Vector3> const corners = getCorners(values);
            for (std::size_t i = 0; i < corners.size(); ++i) {
                Vector3 const &end = corners[(i + 1) % corners.size()];
                if (picture.HasPoint(corners[i]) && picture.HasPoint(end)) {
                    ASSERT_LE(picture.GetDistance(corners[i], end), 20);
                }
            }
        });
    }
}

namespace {

/// In the plane z = 0, with a border and creases that bend there.
Shape makeFlatShape() {
    Shape shape = GetFeatureShape("mixedSharpnessQuads");
    for (std::size_t i = 2; i < shape.positions.size(); i += 3) {
        shape.positions[i] = 0;
    }
    return shape;
}

} // namespace

namespace {

/// Expects that facets are no further than \p pixels from the curves of sharp edges and borders, of all faces
/// that have a surface.
void expectCloseEdges(FarExt::TopologyRefiner const &mesh, Shape const &shape, Camera const &camera,
                      double pixels) {
    auto const factory = BfrExt::SurfaceFactory::Create(mesh);
    SurfaceSet<double> const surfaces(mesh, shape.positions);
    FarExt::TopologyLevel const &base = mesh.GetLevel(0);
    Picture const picture(camera);
    View const view(camera, View::Options().SetFlatness(pixels).SetMaxLevel(10));
    CellForest const forest = view.MakeForest<double>(*factory, shape.positions.data(), 3);
    int numPoints = 0;
    for (int face = 0; face < base.GetNumFaces(); ++face) {
        if (!surfaces[face].IsValid()) {
            continue;
        }
        auto const tessellation = forest.GetTessellation(face);
        ASSERT_TRUE(tessellation.IsValid());
        auto const edges = base.GetFaceEdges(face);
        for (int local = 0; local < edges.size(); ++local) {
            if (!base.IsEdgeInfSharp(edges[local])) {
                continue;
            }
            int const numInner = tessellation.GetNumEdgeCoords(local);
            std::vector<double> coords(2 * std::size_t(numInner + 2));
            tessellation.GetVertexCoord(local, coords.data());
            tessellation.GetEdgeCoords(local, coords.data() + 2);
            tessellation.GetVertexCoord((local + 1) % edges.size(),
                                        &coords[2 * std::size_t(numInner + 1)]);
            numPoints += numInner;
            for (int i = 0; i <= numInner; ++i) {
                auto const evaluate = [&](double t) {
                    double const *const uv = &coords[2 * std::size_t(i)];
                    double const place[2] = {uv[0] + t * (uv[2] - uv[0]),
                                             uv[1] + t * (uv[3] - uv[1])};
                    return surfaces.Evaluate(face, place).p;
                };
                Vector3 const start = evaluate(0);
                Vector3 const along = Normalize(Subtract(evaluate(1), start));
                for (int k = 1; k < 8; ++k) {
                    Vector3 const p = evaluate(k / 8.0);
                    Vector3 const d = Subtract(p, start);
                    Vector3 const foot = add(start, Scale(along, Dot(along, d)));
                    if (picture.HasPoint(p) && picture.HasPoint(foot)) {
                        ASSERT_LE(picture.GetDistance(p, foot), pixels);
                    }
                }
            }
        }
    }
    EXPECT_GT(numPoints, 20);
}

/// Just over a vertex of a shape in the plane z = 0, with the rest of it in the distance.
Camera makeNearCamera(Shape const &shape, int vertex) {
    auto const [least, largest] = getBox(shape.positions);
    Camera camera;
    for (std::size_t k = 0; k < 3; ++k) {
        camera.target[k] = (least[k] + largest[k]) / 2;
        camera.eye[k] = shape.positions[3 * std::size_t(vertex) + k];
    }
    camera.eye[2] = 0.02 * GetDistance(least, largest);
    camera.fieldOfView = 120;
    return camera;
}

} // namespace

// A border that bends in the plane of flat cells, from above and with one end much closer than the other.
TEST(View, SharpEdgesAreCloseToTheirCurves) {
    Shape const shape = makeFlatShape();
    auto const refiner = makeRefiner(shape);
    Camera fromAbove;
    fromAbove.eye[2] = 30;
    fromAbove.fieldOfView = 30;
    ASSERT_NO_FATAL_FAILURE(expectCloseEdges(*refiner, shape, fromAbove, 0.005));
    ASSERT_NO_FATAL_FAILURE(expectCloseEdges(*refiner, shape, makeNearCamera(shape, 0), 0.05));
}

// A crease that bends between faces of which those on one side have no surface, whichever are the first.
TEST(View, SharpEdgesOfHolesAreCloseToTheirCurves) {
    constexpr int kNumColumns = 6;
    Shape shape;
    shape.name = "bent crease";
    for (int row = 0; row < 3; ++row) {
        for (int i = 0; i <= kNumColumns; ++i) {
            double const bend = row == 1 ? (i % 2 == 0 ? 0.6 : -0.6) : 0;
            shape.positions.insert(shape.positions.end(), {double(i), row + bend, 0});
        }
    }
    constexpr int kSecondRow = kNumColumns + 1; // of vertices
    for (int row = 0; row < 2; ++row) {
        for (int i = 0; i < kNumColumns; ++i) {
            int const first = row * kSecondRow + i;
            shape.faceSizes.push_back(4);
            shape.faceVertices.insert(
                shape.faceVertices.end(),
                {first, first + 1, first + kSecondRow + 1, first + kSecondRow});
            if (row == 0) {
                shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                               {kSecondRow + i, kSecondRow + i + 1});
                shape.creaseSharpness.push_back(Sdc::Crease::SHARPNESS_INFINITE);
            }
        }
    }
    Camera camera;
    std::copy_n(std::array<double, 3>{3, 1, 8}.data(), 3, camera.eye);
    std::copy_n(std::array<double, 3>{3, 1, 0}.data(), 3, camera.target);
    for (int const firstHole : {0, kNumColumns}) {
        shape.holeFaces.resize(kNumColumns);
        std::iota(shape.holeFaces.begin(), shape.holeFaces.end(), firstHole);
        ASSERT_NO_FATAL_FAILURE(expectCloseEdges(*makeRefiner(shape), shape, camera, 0.5));
    }
}

namespace {

/// A point of the surface, and the cells that have it: from child to child, from a base face on.
struct PointInCells {
    static constexpr int kNumSteps = 6;

    int face;
    std::array<int, kNumSteps> children;
    SurfacePoint surface;

    /// The last of these cells that a tree has.
    int FindLeaf(CellTree const &tree) const {
        int cell = 0;
        for (int step = 0; tree.IsRefined(cell); ++step) {
            cell = tree.GetFirstChild(cell) + children[std::size_t(step)];
        }
        return cell;
    }
};

/// Appends corners of cells of a face that are some random steps on.
void addRandomPoints(CellValues const &base, int face, int numCells, std::mt19937 &random,
                     std::vector<PointInCells> &points) {
    std::array<CellValues, PointInCells::kNumSteps> cells;
    for (int i = 0; i < numCells; ++i) {
        PointInCells point = {face, {}, {}};
        CellValues const *parent = &base;
        for (std::size_t step = 0; step < cells.size(); ++step) {
            auto const numChildren = unsigned(parent->GetType().GetChildren().size());
            point.children[step] = int(random() % numChildren);
            cells[step].SetChild(*parent, point.children[step]);
            parent = &cells[step];
        }
        for (int corner = 0; corner < parent->GetType().GetNumCorners(); ++corner) {
            SurfacePoint &surface = point.surface;
            parent->EvaluateCorner(corner, surface.p.data());
            parent->EvaluateCorner(corner, surface.du.data(), surface.dv.data());
            points.push_back(point);
        }
    }
}

/// A sharp edge or boundary of a face, with points of its curve.
struct CurveOfEdge {
    /// The points of the surface at places of a polyline, in the direction of the edge.
    CurveOfEdge(Surface<double> const &surface, std::vector<double> const &positions, int local,
                FarExt::SurfaceFaces::Edge const &ofEdge)
        : edge(ofEdge.edge), places(Polyline(kLevel).GetPlaces()) {
        for (Polyline::Place const place : places) {
            double const end = double(place) / Polyline::kLength;
            double uv[2];
            surface.GetParameterization().GetEdgeCoord(local, ofEdge.isReversed ? 1 - end : end,
                                                       uv);
            points.push_back(EvaluateSurface(surface, positions, uv).p);
        }
    }

    static constexpr int kLevel = 6;

    int edge;
    std::vector<Polyline::Place> places;
    std::vector<Vector3> points;
};

/// Expects that no point is in the picture where a polyline has fewer points than it has without culling.
void expectNoneIsSeen(CurveOfEdge const &curve, Polyline const &culled, Polyline const &all,
                      Picture const &picture, long &numCulled) {
    ASSERT_TRUE(all.Contains(culled));
    std::vector<Polyline::Place> ends = culled.GetPlaces();
    ends.insert(ends.begin(), 0);
    ends.push_back(Polyline::kLength);
    for (std::size_t i = 0; i < curve.places.size(); ++i) {
        auto const end = std::lower_bound(ends.begin() + 1, ends.end(), curve.places[i]);
        auto const isInside = [&](Polyline::Place place) {
            return end[-1] < place && place < *end;
        };
        if (std::any_of(all.GetPlaces().begin(), all.GetPlaces().end(), isInside)) {
            ++numCulled;
            ASSERT_FALSE(picture.HasPoint(curve.points[i])) << "at place " << curve.places[i];
        }
    }
}

struct CullingCounts {
    void Report() const {
        std::cout << cells[0] << " cells are not culled, " << cells[1] << " outside, " << cells[2]
                  << " facing away, with " << points << " points; " << ofEdges
                  << " points of sharp edges are culled\n";
    }

    std::array<long, 3> cells = {}; ///< by what is known of them
    long points = 0;                ///< of cells that face away
    long ofEdges = 0;
};

/// Looks at some faces of a shape from many sides.
class CullingCheck {
public:
    static constexpr int kCellsOfFace = 40;

    CullingCheck(Shape const &shape, int numFaces, SurfaceCase const &surfaceCase,
                 Sdc::Options::VtxBoundaryInterpolation boundary, std::mt19937 &random,
                 BfrExt::SurfaceFactoryCache &cache)
        : _random(random) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(boundary);
        auto const factoryOptions = BfrExt::SurfaceFactory::Options().SetExternalCache(&cache);
        auto const whole = CreateSurfaceRefiner(shape, surfaceCase, 0, options);
        auto const factory = BfrExt::SurfaceFactory::Create(*whole, factoryOptions);
        FarExt::TopologyLevel const level = factory->GetLevel();
        _positions = FindControlPoints(*whole, shape.positions);
        BaseCells cells(*whole, _positions);
        for (int i = 0; i < numFaces; ++i) {
            int const face = int(random() % unsigned(level.GetNumFaces()));
            Surface<double> surface;
            if (_faces.count(face) > 0 || !factory->InitVertexSurface(face, &surface)) {
                continue;
            }
            Face &made = _faces[face];
            addRandomPoints(cells.Make(face), face, kCellsOfFace, random, made.points);
            for (int local = 0; local < surface.GetFaceSize(); ++local) {
                if (level.IsEdgeInfSharp(level.GetFaceEdges(face)[local])) {
                    made.edges.emplace_back(surface, _positions, local,
                                            factory->GetFaces().GetEdge(face, local));
                }
            }
        }
        // Views need no trees of other faces, which are holes; a first step would take other ways around these.
        Shape withHoles = shape;
        if (!surfaceCase.HasFirstStep()) {
            withHoles.holeFaces.clear();
            for (int face = 0; face < shape.GetNumFaces(); ++face) {
                if (_faces.count(face) == 0) {
                    withHoles.holeFaces.push_back(face);
                }
            }
        }
        _refiner = CreateSurfaceRefiner(withHoles, surfaceCase, 0, options);
        _factory = BfrExt::SurfaceFactory::Create(*_refiner, factoryOptions);
        _bounds = std::make_unique<BfrExt::ViewBounds>(*_factory);
    }

    void Look(int numViews, CullingCounts &counts) {
        for (int round = 0; round < numViews; ++round) {
            SCOPED_TRACE(testing::Message() << "view " << round);
            Camera const camera = makeRandomCamera(_positions, _random);
            View::Counts ofCells;
            CellForest const culled = makeForest(camera, true, &ofCells);
            CellForest const all = makeForest(camera, false, nullptr);
            for (auto const &[number, face] : _faces) {
                SCOPED_TRACE(testing::Message() << "face " << number);
                std::vector<CellVisibility> const &visibility =
                    ofCells.visibilities[std::size_t(number)];
                ASSERT_NO_FATAL_FAILURE(
                    lookAtCells(camera, face, culled.GetTree(number), visibility, counts));
                for (CurveOfEdge const &curve : face.edges) {
                    lookAtEdge(camera, curve, culled, all, counts);
                    // Where a face is outside, so are its edges.
                    ASSERT_TRUE(visibility[0] != CellVisibility::Outside ||
                                culled.GetEdge(curve.edge) == Polyline());
                    lookNear(camera, curve, counts);
                }
                ASSERT_NO_FATAL_FAILURE(lookNear(camera, number, face, counts));
            }
        }
    }

private:
    struct Face {
        std::vector<PointInCells> points;
        std::vector<CurveOfEdge> edges;
    };

    CellForest makeForest(Camera const &camera, bool isCulling, View::Counts *counts) {
        return View(camera, View::Options().SetFlatness(2).SetMaxLevel(3).SetCulling(isCulling))
            .MakeForest<double>(*_bounds, _positions.data(), 3, nullptr, counts);
    }

    static void lookAtCells(Camera const &camera, Face const &face, CellTree const &tree,
                            std::vector<CellVisibility> const &visibility, CullingCounts &counts) {
        Picture const picture(camera);
        ASSERT_EQ(int(visibility.size()), tree.GetNumCells());
        for (int cell = 0; cell < tree.GetNumCells(); ++cell) {
            counts.cells[std::size_t(visibility[std::size_t(cell)])] += !tree.IsRefined(cell);
        }
        for (PointInCells const &point : face.points) {
            int const cell = point.FindLeaf(tree);
            if (visibility[std::size_t(cell)] == CellVisibility::Visible) {
                continue;
            }
            SurfacePoint const &surface = point.surface;
            Vector3 const toEye = Subtract(ToVector(camera.eye), surface.p);
            bool const isInPicture = picture.HasPoint(surface.p);
            if (visibility[std::size_t(cell)] == CellVisibility::Outside) {
                ASSERT_FALSE(isInPicture) << "cell " << cell;
                continue;
            }
            ++counts.points;
            // Beside a needle, as at a corner of a half turn, the surface may be folded.
            constexpr double kLeastSine = 0.03;
            Vector3 const normal = Cross(surface.du, surface.dv);
            bool const hasNormal =
                GetLength(normal) > kLeastSine * GetLength(surface.du) * GetLength(surface.dv);
            ASSERT_FALSE(hasNormal && Dot(normal, toEye) > 0 && isInPicture) << "cell " << cell;
        }
    }

    // A point of the surface is in the middle of the picture, without the corners of most cells that have it.
    void lookNear(Camera camera, int number, Face const &face, CullingCounts &counts) {
        Vector3 const &point = face.points[_random() % face.points.size()].surface.p;
        std::copy(point.begin(), point.end(), camera.target);
        camera.fieldOfView = 1 + double(_random() % 5);
        View::Counts ofCells;
        CellForest const culled = makeForest(camera, true, &ofCells);
        lookAtCells(camera, face, culled.GetTree(number), ofCells.visibilities[std::size_t(number)],
                    counts);
    }

    // A piece of the curve fills the picture, without the ends of the edge.
    void lookNear(Camera camera, CurveOfEdge const &curve, CullingCounts &counts) {
        Vector3 const &point = curve.points[_random() % curve.points.size()];
        std::copy(point.begin(), point.end(), camera.target);
        camera.fieldOfView = 1 + double(_random() % 5);
        lookAtEdge(camera, curve, makeForest(camera, true, nullptr),
                   makeForest(camera, false, nullptr), counts);
    }

    static void lookAtEdge(Camera const &camera, CurveOfEdge const &curve, CellForest const &culled,
                           CellForest const &all, CullingCounts &counts) {
        expectNoneIsSeen(curve, culled.GetEdge(curve.edge), all.GetEdge(curve.edge),
                         Picture(camera), counts.ofEdges);
    }

    std::mt19937 &_random;
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::unique_ptr<BfrExt::SurfaceFactory> _factory;
    std::unique_ptr<BfrExt::ViewBounds> _bounds;
    std::vector<double> _positions;
    std::map<int, Face> _faces;
};

} // namespace

TEST(View, NothingThatIsSeenIsCulled) {
    std::mt19937 random(5);
    BfrExt::SurfaceFactoryCache cache;
    CullingCounts counts;
    for (Shape const &shape : getManyShapes()) {
        SCOPED_TRACE(shape.name);
        CullingCheck check(shape, 2, kPlainCases[2], Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER,
                           random, cache);
        ASSERT_NO_FATAL_FAILURE(check.Look(100, counts));
    }
    counts.Report();
    EXPECT_GT(counts.cells[1], 10000);
    EXPECT_GT(counts.cells[2], 10000);
    EXPECT_GT(counts.ofEdges, 1000);
}

namespace {

/// A unit square alone, whose border is smooth.
struct RoundedSquare {
    RoundedSquare() : shape(MakeTiling(Tiling::Quads, 1, 1)) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, options);
        factory = BfrExt::SurfaceFactory::Create(*refiner);
    }

    /// The polyline of an edge, in the direction of the edge.
    Polyline MakeEdge(View const &view, int edge) const {
        return view.MakeForest<double>(*factory, shape.positions.data(), 3).GetEdge(edge);
    }

    Shape const shape;
    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<BfrExt::SurfaceFactory> factory;
};

} // namespace

TEST(View, EdgesAreReversedInAMirror) {
    RoundedSquare const square;
    auto const make = [&](double x) {
        Camera camera;
        std::copy_n(std::array<double, 3>{x, -0.3, 0.1}.data(), 3, camera.eye);
        std::copy_n(std::array<double, 3>{0.5, 0.5, 0}.data(), 3, camera.target);
        std::copy_n(std::array<double, 3>{0, 0, 1}.data(), 3, camera.up);
        return square.MakeEdge(View(camera, View::Options().SetFlatness(0.1)),
                               square.factory->GetFaces().GetEdge(0, 0).edge);
    };
    EXPECT_GT(make(0.125).GetNumPoints(), 10);
    EXPECT_NE(make(0.125), make(0.875));
    EXPECT_EQ(make(0.125), make(0.875).GetReversed());
}

// The ends of an edge, and all places between them, lie outside of what shows a part of its curve.
TEST(View, EdgesThatBendIntoThePictureAreSeen) {
    RoundedSquare const square;
    Surface<double> surface;
    ASSERT_TRUE(square.factory->InitVertexSurface(0, &surface));
    for (int local = 0; local < 4; ++local) {
        CurveOfEdge const curve(surface, square.shape.positions, local,
                                square.factory->GetFaces().GetEdge(0, local));
        Camera camera;
        std::copy_n(curve.points[curve.points.size() / 2].data(), 3, camera.target);
        std::copy_n(camera.target, 3, camera.eye);
        camera.eye[2] += 5;
        camera.fieldOfView = 0.1;
        camera.height = camera.width;
        auto const make = [&](bool isCulling) {
            return square.MakeEdge(
                View(camera, View::Options().SetMaxLevel(6).SetCulling(isCulling)), curve.edge);
        };
        long numCulled = 0;
        ASSERT_NO_FATAL_FAILURE(
            expectNoneIsSeen(curve, make(true), make(false), Picture(camera), numCulled));
        EXPECT_GT(make(true).GetNumPoints(), 2);
        EXPECT_GT(numCulled, 2);
    }
}

// The shapes have these surfaces in turn, and a face each, since what is made for types of cells takes its time.
TEST(View, NothingThatIsSeenIsCulledOfOtherSurfaces) {
    std::mt19937 random(6);
    BfrExt::SurfaceFactoryCache cache;
    SurfaceCase const cases[] = {kPlainCases[1], kTruncateCases[2], kPlainCases[0],
                                 kTruncateCases[1], kTruncateCases[0]};
    CullingCounts counts[std::size(cases)];
    std::size_t next = 0;
    for (Shape const &shape : getManyShapes()) {
        SCOPED_TRACE(shape.name);
        std::size_t const i = next % std::size(cases);
        // Behind a first step all of a shape is refined.
        constexpr int kMostFaces = 100;
        // Truncated, this shape is no more than a point.
        bool const isPoint = shape.name == "dihedron5";
        if (cases[i].HasFirstStep() && (isPoint || shape.GetNumFaces() > kMostFaces)) {
            continue;
        }
        auto const boundary = next++ % 2 == 0 ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                              : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;
        CullingCheck check(shape, 1, cases[i], boundary, random, cache);
        ASSERT_NO_FATAL_FAILURE(check.Look(20, counts[i]));
    }
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        std::cout << cases[i].GetName() << ": ";
        counts[i].Report();
        EXPECT_GT(counts[i].cells[1], 100);
        EXPECT_GT(counts[i].cells[2], 500);
        EXPECT_GT(counts[i].ofEdges, 100);
    }
}

TEST(View, WhatWasRefinedStaysSo) {
    Shape const &shape = GetShape("cube");
    auto const refiner = makeRefiner(shape);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    std::mt19937 random(12);
    Camera const camera = makeRandomCamera(shape.positions, random);
    auto const make = [&](double pixels, CellForest const *previous) {
        View const view(camera, View::Options().SetFlatness(pixels).SetHysteresis(0.5));
        return view.MakeForest<double>(*factory, shape.positions.data(), 3, previous);
    };
    auto const getNumLeaves = [](CellForest const &forest) {
        int sum = 0;
        for (int face = 0; face < forest.GetNumFaces(); ++face) {
            sum += forest.GetTree(face).GetNumLeaves();
        }
        return sum;
    };
    CellForest const fine = make(0.5, nullptr);
    CellForest const coarse = make(1, nullptr);
    CellForest const kept = make(1, &fine);
    CellForest const dropped = make(2.5, &fine);
    EXPECT_LT(getNumLeaves(coarse), getNumLeaves(fine));
    EXPECT_EQ(getNumLeaves(kept), getNumLeaves(fine));
    EXPECT_LT(getNumLeaves(dropped), getNumLeaves(fine));
    EXPECT_GT(getNumLeaves(dropped), getNumLeaves(make(2.5, nullptr)));
}

// In flat cells edges alone are divided, near the camera more than far from it.
TEST(View, SharpEdgesThatWereDividedStaySo) {
    Shape const shape = makeFlatShape();
    auto const refiner = makeRefiner(shape);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    Camera camera = makeNearCamera(shape, 0);
    auto const makeView = [&](double pixels) {
        return View(camera,
                    View::Options().SetFlatness(0.02 * pixels).SetMaxLevel(10).SetHysteresis(0.5));
    };
    auto const make = [&](double pixels, CellForest const *previous) {
        BfrExt::ViewBounds bounds(*factory);
        CellForest forest =
            makeView(pixels).MakeForest<double>(bounds, shape.positions.data(), 3, previous);
        CellForest const other =
            makeView(pixels).MakeForest<double>(*factory, shape.positions.data(), 3, previous);
        for (int edge = 0; edge < refiner->GetLevel(0).GetNumEdges(); ++edge) {
            EXPECT_EQ(forest.GetPolyline(edge), other.GetPolyline(edge));
        }
        return forest;
    };
    CellForest const fine = make(0.5, nullptr);
    CellForest const kept = make(1, &fine);
    CellForest const dropped = make(2.5, &fine);
    EXPECT_LT(make(1, nullptr).GetNumBoundaryPoints(), fine.GetNumBoundaryPoints());
    EXPECT_EQ(kept.GetNumBoundaryPoints(), fine.GetNumBoundaryPoints());
    EXPECT_LT(dropped.GetNumBoundaryPoints(), fine.GetNumBoundaryPoints());
    EXPECT_GT(dropped.GetNumBoundaryPoints(), make(2.5, nullptr).GetNumBoundaryPoints());

    // Where the first face of a crease is a hole, the other one makes the same of it, and knows the last frame.
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);
    int numOneSided = 0;
    for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
        if (!base.IsEdgeInfSharp(edge) || base.GetEdgeFaces(edge).size() != 2) {
            continue;
        }
        camera = makeNearCamera(shape, base.GetEdgeVertices(edge)[0]);
        Shape withHole = shape;
        withHole.holeFaces.push_back(factory->GetFaces().GetSide(edge, 0).face);
        auto const ofHole = makeRefiner(withHole);
        auto const other = BfrExt::SurfaceFactory::Create(*ofHole);
        auto const makeForest = [&](BfrExt::SurfaceFactory const &of, CellForest const *last) {
            return makeView(last ? 0.04 : 0.02)
                .MakeForest<double>(of, shape.positions.data(), 3, last);
        };
        CellForest const last = makeForest(*factory, nullptr);
        CellForest const ofOther = makeForest(*other, nullptr);
        EXPECT_EQ(ofOther.GetEdge(edge), last.GetEdge(edge));
        EXPECT_EQ(makeForest(*factory, &last).GetEdge(edge), last.GetEdge(edge));
        EXPECT_EQ(makeForest(*other, &ofOther).GetEdge(edge), last.GetEdge(edge));
        numOneSided += last.GetEdge(edge) != last.GetEdge(edge).GetReversed();
    }
    EXPECT_GT(numOneSided, 0);
}

// As many faces, but other edges, all of which were divided.
TEST(View, IgnoresEdgesOfOtherMeshes) {
    Shape const shape = MakeTiling(Tiling::Quads, 2, 3);
    auto const refiner = makeRefiner(shape);
    auto const other = makeRefiner(MakeTiling(Tiling::Quads, 6, 1));
    ASSERT_EQ(refiner->GetLevel(0).GetNumFaces(), other->GetLevel(0).GetNumFaces());
    ASSERT_NE(refiner->GetLevel(0).GetNumEdges(), other->GetLevel(0).GetNumEdges());
    CellForest previous(*other);
    for (int edge = 0; edge < other->GetLevel(0).GetNumEdges(); ++edge) {
        previous.SetEdge(edge, Polyline(6));
    }
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    Camera camera;
    camera.eye[2] = 9;
    View const view(camera, View::Options().SetFlatness(20).SetHysteresis(0));
    auto const count = [&](CellForest const *last) {
        return view.MakeForest<double>(*factory, shape.positions.data(), 3, last)
            .GetNumBoundaryPoints();
    };
    EXPECT_EQ(count(&previous), count(nullptr));
    CellForest own(*refiner);
    for (int edge = 0; edge < refiner->GetLevel(0).GetNumEdges(); ++edge) {
        own.SetEdge(edge, Polyline(6));
    }
    EXPECT_GT(count(&own), count(nullptr));
}

TEST(View, ForestsAreTheSameForAnyThreadsAndTypes) {
    Shape const &shape = GetFeatureShape("mixedSharpnessQuads");
    auto const refiner = makeRefiner(shape);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
    std::vector<double> const rounded(positions.begin(), positions.end());
    std::mt19937 random(21);
    Camera const camera = makeRandomCamera(shape.positions, random);
    View const view(camera, View::Options().SetFlatness(0.5));
    View::Counts counts;
    CellForest const forest =
        view.MakeForest<double>(*factory, rounded.data(), 3, nullptr, &counts);
    FarExt::ExecutorScope const alone(nullptr, 1);
    CellForest const other = view.MakeForest<float>(*factory, positions.data(), 3);
    long numLeaves = 0;
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        CellTree const &tree = forest.GetTree(face);
        ASSERT_EQ(tree.GetNumCells(), other.GetTree(face).GetNumCells());
        for (int cell = 0; cell < tree.GetNumCells(); ++cell) {
            ASSERT_EQ(tree.GetFirstChild(cell), other.GetTree(face).GetFirstChild(cell));
        }
        numLeaves += refiner->GetLevel(0).IsFaceHole(face) ? 0 : tree.GetNumLeaves();
    }
    long sum = 0;
    for (long const count : counts.cellsByLevel) {
        sum += count;
    }
    EXPECT_EQ(sum, numLeaves);
}

// More faces than a thread remembers rings of; faces do not share rings of points in double precision.
TEST(View, FacesThatShareRingsHaveTheTreesThatTheyHaveAlone) {
    Shape const shape = MakeTorus(48, 48, TorusFaces::IrregularTriangles);
    auto const refiner = makeRefiner(shape);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
    std::vector<double> const rounded(positions.begin(), positions.end());
    std::mt19937 random(4);
    View const view(makeRandomCamera(shape.positions, random), View::Options().SetFlatness(0.05));
    CellForest const forest = view.MakeForest(*factory, positions.data(), 3);
    CellForest const other = view.MakeForest(*factory, rounded.data(), 3);
    std::map<int, int> numFaces; // by number of cells
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        CellTree const &alone = other.GetTree(face);
        CellTree const &tree = forest.GetTree(face);
        ASSERT_EQ(tree.GetNumCells(), alone.GetNumCells()) << "face " << face;
        for (int cell = 0; cell < tree.GetNumCells(); ++cell) {
            ASSERT_EQ(tree.GetFirstChild(cell), alone.GetFirstChild(cell)) << "face " << face;
        }
        ++numFaces[tree.GetNumCells()];
    }
    EXPECT_GT(numFaces.size(), 5U);
}

/// The surface's heights over the plane of a cell's corners, at the corners of cells some steps on.
std::array<double, 2> sampleHeights(CellValues const &values, int numSteps) {
    std::array<Vector3, 2> const plane = getPlane(getCorners(values));
    std::array<double, 2> range = {0, 0};
    forDescendants(values, numSteps, [&](CellValues const &part) {
        for (Vector3 const &p : getCorners(part)) {
            double const height = Dot(plane[1], Subtract(p, plane[0]));
            range = {std::min(range[0], height), std::max(range[1], height)};
        }
    });
    return range;
}

/// Calls function(cell, measures, facing) for cells of a base face up to level 3, which are measured as for a view.
template <typename FUNCTION>
void forMeasuredCells(RefinedCells &refined, FUNCTION const &function) {
    std::vector<double> samples;
    auto const measure = [&](std::size_t cell) {
        CellGrid &grid = CellGrid::Get(refined[cell].GetType().GetShape());
        grid.Sample(refined[cell], samples);
        CellMeasures own;
        std::vector<CellMeasures> children(std::size_t(grid.GetNumChildren()));
        grid.Measure(samples, own);
        grid.MeasureChildren(samples, own, false, children.data());
        auto const visit = [&](std::size_t part, int number, CellMeasures const &measures) {
            std::vector<Vector3> normals(std::size_t(refined[part].GetType().GetNumCorners()));
            for (std::size_t i = 0; i < normals.size(); ++i) {
                Vector3 du;
                Vector3 dv;
                refined.EvaluateCorner(part, int(i), du.data(), dv.data());
                normals[i] = Cross(du, dv);
            }
            function(part, measures, grid.FindFacing(samples, number, std::move(normals)));
        };
        visit(cell, 0, own);
        std::size_t const first = refined.GetFirstChild(cell);
        for (std::size_t i = 0; i < children.size(); ++i) {
            visit(first + i, int(i) + 1, children[i]);
        }
    };
    measure(RefinedCells::kBase);
    std::size_t const first = refined.GetFirstChild(RefinedCells::kBase);
    for (int i = 0; i < refined.GetNumChildren(RefinedCells::kBase); ++i) {
        std::size_t const child = first + std::size_t(i);
        std::size_t const next = refined.GetFirstChild(child);
        for (int k = 0; k < refined.GetNumChildren(child); ++k) {
            measure(next + std::size_t(k));
        }
    }
}

// Estimates are close to the surface's thickness, and seldom less.
TEST(View, ThicknessIsCloseToThatOfTheSurface) {
    std::mt19937 random(31);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> ratios;
    for (Shape shape : getShapes()) {
        SCOPED_TRACE(shape.name);
        for (double &number : shape.positions) {
            number += 0.1 * uniform(random);
        }
        for (auto const mask :
             {ReferenceMask::Smooth, ReferenceMask::Cosine, ReferenceMask::Average}) {
            auto const refiner = makeRefiner(shape, mask);
            BaseCells cells(*refiner, shape.positions);
            int const numFaces = std::min(refiner->GetLevel(0).GetNumFaces(), 4);
            for (int face = 0; face < numFaces; ++face) {
                RefinedCells refined;
                cells.Make(face, refined);
                forMeasuredCells(refined, [&](std::size_t cell, CellMeasures const &measures,
                                              CellFacing const &) {
                    std::array<double, 2> const sampled = sampleHeights(refined[cell], 3);
                    double const size = sampled[1] - sampled[0];
                    if (size > 1e-6) {
                        ratios.push_back(measures.thickness / size);
                    }
                });
            }
        }
    }
    std::sort(ratios.begin(), ratios.end());
    std::cout << "the thickness is " << ratios.front() << " times what is sampled at least, "
              << ratios[ratios.size() / 100] << " for a hundredth of " << ratios.size()
              << " cells, " << ratios[ratios.size() / 2] << " for a half, "
              << ratios[ratios.size() - ratios.size() / 100] << " for all but a hundredth, and "
              << ratios.back() << " at most\n";
    EXPECT_GT(ratios.front(), 0.4);
    EXPECT_GT(ratios[ratios.size() / 100], 0.8);
    EXPECT_LT(ratios[ratios.size() / 2], 1.25);
    EXPECT_LT(ratios[ratios.size() - ratios.size() / 100], 1.6);
}

// Sides of long cells bend in their plane.
TEST(View, BallsHoldTheSurface) {
    constexpr int kLargestFace = 8;
    std::mt19937 random(32);
    double largest = 0; // how far points are from the center, by the radius
    for (char const *const name : {"prism8", "annulus", "prism64", "bipyramid64"}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (double const stretch : {1.0, 20.0, 0.05}) {
                SCOPED_TRACE(testing::Message() << name << ", axis " << axis << " by " << stretch);
                Shape shape = GetShape(name);
                for (std::size_t i = axis; i < shape.positions.size(); i += 3) {
                    shape.positions[i] *= stretch;
                }
                auto const refiner = makeRefiner(shape);
                int const face = int(random() % unsigned(shape.GetNumFaces()));
                if (shape.faceSizes[std::size_t(face)] > kLargestFace) {
                    continue;
                }
                BaseCells cells(*refiner, shape.positions);
                RefinedCells refined;
                cells.Make(face, refined);
                forMeasuredCells(refined, [&](std::size_t cell, CellMeasures const &measures,
                                              CellFacing const &) {
                    BfrExt::internal::Ball const ball = measures.GetOuterBall();
                    forDescendants(refined[cell], 3, [&](CellValues const &part) {
                        for (Vector3 const &p : getCorners(part)) {
                            largest = std::max(largest, GetDistance(p, ball.center) / ball.radius);
                        }
                    });
                });
                ASSERT_LT(largest, 1) << "face " << face;
            }
        }
    }
    std::cout << "points are up to " << largest << " radii from the centers of balls\n";
    EXPECT_GT(largest, 0.8);
}

// Surfaces that are folded, by flaws of the meshes and where they are not smooth.
TEST(View, NormalsAreWhereCellsFace) {
    double largest = 0; // tangent of an angle to the cell's normal, by what it may be
    for (char const *const name : {"bowTieOfFans", "closedBowTie", "degenerateTriangle",
                                   "finWithCrease", "tetrahedraOnEdge", "texturedFin"}) {
        for (auto const mask :
             {ReferenceMask::Smooth, ReferenceMask::Cosine, ReferenceMask::Average}) {
            SCOPED_TRACE(testing::Message() << name << ", " << ToString(mask));
            Shape const &shape = GetFeatureShape(name);
            auto const refiner = makeRefiner(shape, mask);
            BaseCells cells(*refiner, shape.positions);
            for (int face = 0; face < shape.GetNumFaces(); ++face) {
                RefinedCells refined;
                cells.Make(face, refined);
                forMeasuredCells(refined, [&](std::size_t cell, CellMeasures const &,
                                              CellFacing const &facing) {
                    if (cell == RefinedCells::kBase || !std::isfinite(facing.spread)) {
                        return;
                    }
                    forDescendants(refined[cell], 3, [&](CellValues const &part) {
                        for (int i = 0; i < part.GetType().GetNumCorners(); ++i) {
                            Vector3 du;
                            Vector3 dv;
                            part.EvaluateCorner(i, du.data(), dv.data());
                            Vector3 const normal = Cross(du, dv);
                            if (GetLength(normal) <= 1e-6 * GetLength(du) * GetLength(dv)) {
                                continue; // a needle
                            }
                            double const height = Dot(normal, facing.normal);
                            ASSERT_GT(height, 0) << "face " << face << ", cell " << cell;
                            double const across =
                                GetLength(Subtract(normal, Scale(facing.normal, height)));
                            constexpr double kRounding = 1e-4;
                            largest =
                                std::max(largest, across / height / (facing.spread + kRounding));
                        }
                    });
                });
                ASSERT_LT(largest, 1) << "face " << face;
            }
        }
    }
    std::cout << "normals lean over by up to " << largest << " times what they may\n";
    EXPECT_GT(largest, 0.5);
}

namespace {

struct NumPolygons {
    double ofView;
    double
        ofUniform; ///< of the first level of which no cell is seen to be farther from the surface
};

/// Polygons that a view of the whole shape needs for a quarter of a pixel.
NumPolygons countPolygons(Shape const &shape) {
    constexpr double kPixels = 0.25;
    auto const refiner = makeRefiner(shape);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    Camera camera; // from the front and above
    std::array<Vector3, 2> const box = getBox(shape.positions);
    double const size = GetDistance(box[0], box[1]);
    for (std::size_t k = 0; k < 3; ++k) {
        camera.target[k] = (box[0][k] + box[1][k]) / 2;
        camera.eye[k] = camera.target[k] + size * std::array<double, 3>{0.2, 0.5, 1.2}[k];
    }
    View const view(camera, View::Options().SetFlatness(kPixels));
    CellForest const forest = view.MakeForest<double>(*factory, shape.positions.data(), 3);
    double numPolygons = 0;
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        auto const options = BfrExt::LevelTessellation::Options().SetFacetSize(0);
        numPolygons += forest.GetTessellation(face, options).GetNumFacets();
    }
    BaseCells cells(*refiner, shape.positions);
    Picture const picture(camera);
    int uniformLevel = 0;
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        auto const visit = [&](auto const &self, CellValues const &values) -> void {
            Vector3 const corner = getCorners(values)[0];
            Vector3 const toEye = Subtract(ToVector(camera.eye), corner);
            Vector3 const across = Normalize(Cross(toEye, {0, 1, 0}));
            std::array<double, 2> const heights = sampleHeights(values, 2);
            if (picture.GetDistance(corner, add(corner, Scale(across, heights[1] - heights[0]))) <=
                kPixels) {
                return;
            }
            uniformLevel = std::max(uniformLevel, values.GetLevel() + 1);
            for (std::size_t i = 0; i < values.GetType().GetChildren().size(); ++i) {
                CellValues child;
                child.SetChild(values, int(i));
                self(self, child);
            }
        };
        visit(visit, cells.Make(face));
    }
    // F' = F + E and E' = 4 E, but for borders.
    double const numEdges = refiner->GetLevel(0).GetNumEdges();
    double const numUniform = forest.GetNumFaces() + numEdges * (std::pow(4, uniformLevel) - 1) / 3;
    std::cout << shape.name << ": " << numPolygons << " polygons, " << numUniform << " at level "
              << uniformLevel << "\n";
    return {numPolygons, numUniform};
}

} // namespace

// Uniform refinement needs the level that the most difficult cell has, everywhere.
TEST(View, TakesFarFewerPolygonsThanUniformLevels) {
    std::vector<Shape const *> shapes = {&GetShape("pyramid12"), &GetFeatureShape("creasedPrism")};
    for (Shape const &shape : GetShapes()) {
        if (shape.name == "suzanne") { // a real mesh, where its folder is there
            shapes.push_back(&shape);
        }
    }
    for (Shape const *const shape : shapes) {
        SCOPED_TRACE(shape->name);
        NumPolygons const numPolygons = countPolygons(*shape);
        EXPECT_GT(numPolygons.ofView, shape->GetNumFaces());
        EXPECT_LT(10 * numPolygons.ofView, numPolygons.ofUniform);
    }
}

// Alone and behind a truncation, shapes have all masks in turn.  Behind a truncation faces at borders have corners
// of a half turn, where triangles may be slivers on either side.
TEST(View, HardlyAFacetIsTurnedOver) {
    constexpr int kNumViews = 4;
    std::mt19937 random(41);
    struct Facets {
        TurnedFacets polygons;
        TurnedFacets triangles;
    } facets[2]; // alone and truncated
    std::size_t next = 0;
    std::vector<Shape> shapes = getShapes();
    shapes.push_back(GetShape("annulus")); // its inner border is concave
    for (Shape const &shape : shapes) {
        for (bool const isTruncated : {false, true}) {
            // Counted here: with GCC's UndefinedBehaviorSanitizer the index of a conditional array counts twice.
            std::size_t const number = next++ % std::size(kPlainCases);
            SurfaceCase const &surfaceCase = (isTruncated ? kTruncateCases : kPlainCases)[number];
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
            auto const refiner = CreateSurfaceRefiner(shape, surfaceCase, 0, options);
            auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
            std::vector<double> const positions = FindControlPoints(*refiner, shape.positions);
            for (int round = 0; round < kNumViews; ++round) {
                View const view(makeRandomCamera(positions, random),
                                View::Options().SetMaxLevel(5).SetCulling(round % 2 == 1));
                CellForest const forest = view.MakeForest<double>(*factory, positions.data(), 3);
                for (int face = 0; face < forest.GetNumFaces(); ++face) {
                    Surface<double> surface;
                    if (!factory->InitVertexSurface(face, &surface)) {
                        continue;
                    }
                    std::vector<double> control(3 * std::size_t(surface.GetNumControlPoints()));
                    surface.GatherControlPoints(positions.data(), 3, control.data(), 3);
                    auto const add = [&](int facetSize, TurnedFacets &counted) {
                        auto const ofSize =
                            BfrExt::LevelTessellation::Options().SetFacetSize(facetSize);
                        counted.Add(surface, forest.GetTessellation(face, ofSize), control);
                    };
                    add(0, facets[isTruncated].polygons);
                    add(3, facets[isTruncated].triangles);
                }
            }
        }
    }
    for (Facets const &found : facets) {
        found.polygons.Report("polygons");
        found.triangles.Report("triangles");
        EXPECT_GT(found.polygons.GetNumFacets(), 10000);
    }
    EXPECT_LT(facets[0].polygons.GetShare(), 0.001);
    EXPECT_LT(facets[0].triangles.GetShare(), 0.002);
    EXPECT_LT(facets[1].polygons.GetShare(), 0.001);
    EXPECT_LT(facets[1].triangles.GetShare(), 0.02);
}

} // namespace OpenSubdivHex::Regression::viewTest

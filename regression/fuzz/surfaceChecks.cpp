// SPDX-License-Identifier: Apache-2.0
#include "meshSurfaces.h"

#include "far_ext/indexing.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace OpenSubdivHex::Regression {

using BfrExt::CellForest;
using BfrExt::CellTree;
using BfrExt::LevelTessellation;
using BfrExt::PatchLevels;
using BfrExt::Polyline;
using BfrExt::Surface;
using FarExt::CallStatus;
using FarExt::TopologyLevel;

namespace {

/// Evaluates values of two numbers, or three, with derivatives.
constexpr int kMaxPointSize = 3;

/// A hole has no surface, and no face at a boundary of the paper's rule has one.
bool isToHaveSurface(OracleLevels const &levels, BfrExt::SurfaceFactory const &factory, int face) {
    TopologyLevel const &base = factory.GetLevel();
    auto const verts = base.GetFaceVertices(factory.GetFaces().GetLevelFace(face).face);
    return !factory.GetFaces().IsHole(face) &&
           std::none_of(verts.begin(), verts.end(),
                        [&](int vert) { return IsOnFreeBoundary(levels.refiner, base, vert); });
}

/// The limits of the vertices of the last level.
ReferenceValues findLimits(OracleLevels const &levels) {
    using Row = ValueRow<double>;
    ReferenceValues const &last = levels.values[0].levels.back();
    std::vector<Row> src(std::size_t(last.rows()));
    for (Eigen::Index i = 0; i < last.rows(); ++i) {
        src[std::size_t(i)].value = last.row(i).array();
    }
    std::vector<Row> dst = src;
    CallStatus status;
    if (!FarExt::PrimvarRefinerReal<double>(levels.refiner).Limit(src, dst, &status)) {
        Fail("no limits: ", status.GetErrorMessage());
    }
    ReferenceValues limits = last;
    for (Eigen::Index i = 0; i < last.rows(); ++i) {
        limits.row(i) = dst[std::size_t(i)].value.matrix();
    }
    return limits;
}

template <typename REAL>
std::string describe(char const *what, int face, REAL const uv[2]) {
    std::ostringstream text;
    text.precision(17);
    text << what << " of face " << face << " at " << uv[0] << ", " << uv[1];
    return text.str();
}

/// Surfaces have the limits of vertices of the last level.
template <typename REAL>
void checkLimitsOfVertices(MeshSurfaces<REAL> const &mesh, OracleLevels const &levels, Dice &dice) {
    constexpr int kNumFaces = 60; // about so many are looked at
    ReferenceValues const limits = findLimits(levels);
    TopologyLevel const &level = levels.refiner.GetLevel(levels.refiner.GetMaxLevel());
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        if (dice.Roll(level.GetNumFaces()) > kNumFaces) {
            continue;
        }
        auto const verts = level.GetFaceVertices(face);
        bool const isSplit = level.GetFaceSurfaceFace(face, 0) != level.GetFaceSurfaceFace(face, 1);
        for (int half = 0; half < 2; ++half) {
            int const baseFace = level.GetFaceSurfaceFace(face, half);
            if (!mesh.Has(baseFace)) {
                continue;
            }
            std::vector<REAL> coords(2 * std::size_t(verts.size()));
            level.GetFaceSurfaceCoords(face, half, coords.data());
            int const end = level.GetFaceDiagonalEnd(face);
            int const count = isSplit ? FarExt::GetHalfSize(half, verts.size(), end) : verts.size();
            for (int i = 0; i < count; ++i) {
                int const vert = verts[isSplit ? FarExt::GetPlaceInHalves(half, i, end) : i];
                REAL const *const uv = &coords[2 * std::size_t(i)];
                Eigen::RowVectorXd const point = mesh.Evaluate(baseFace, uv).row(0);
                if (!(GetDifference(point, limits.row(vert)) <= mesh.GetTolerance())) {
                    Fail(describe("the point", baseFace, uv), " is ", point,
                         ", and the limit of vertex ", vert, ' ', limits.row(vert));
                }
            }
        }
    }
}

/// Points and weights at places in and outside of a face, and at none.
template <typename REAL>
void checkPlace(MeshSurfaces<REAL> const &mesh, int face, Dice &dice) {
    REAL const none = std::numeric_limits<REAL>::quiet_NaN();
    REAL const far = std::numeric_limits<REAL>::max();
    auto const roll = [&] {
        return dice.IsOneOf(16) ? (dice.IsOneOf(2) ? none : far)
                                : REAL(dice.Roll(1 << 20)) / REAL(1 << 19) - REAL(0.5);
    };
    REAL const uv[2] = {roll(), roll()};
    Surface<REAL> const &surface = mesh.surfaces[std::size_t(face)];
    int const numPoints = surface.GetNumControlPoints();
    std::vector<REAL> weights[3];
    for (std::vector<REAL> &ofOne : weights) {
        ofOne.resize(std::size_t(numPoints));
    }
    surface.EvaluateStencil(uv, weights[0].data(), weights[1].data(), weights[2].data());
    ReferenceValues const values = mesh.Evaluate(face, uv);
    if (std::isnan(uv[0]) || std::isnan(uv[1])) {
        if (!values.array().isNaN().all()) {
            Fail(describe("what is", face, uv), " is ", values);
        }
        return;
    }
    for (int which = 0; which < 3; ++which) {
        double sum = 0;
        double size = 1;
        std::vector<REAL> point(std::size_t(mesh.pointSize));
        surface.ApplyStencil(weights[which].data(), mesh.GetControlPoints(face), mesh.pointSize,
                             point.data());
        for (REAL const weight : weights[which]) {
            sum += double(weight);
            size += std::abs(double(weight));
            if (which == 0 && !(weight >= REAL(-1e-6))) {
                Fail(describe("a weight", face, uv), " is ", weight);
            }
        }
        double const allowed = sizeof(REAL) == sizeof(double) ? 1e-12 : 1e-6;
        if (!(std::abs(sum - (which == 0 ? 1 : 0)) <= allowed * size)) {
            Fail(describe("the sum of weights", face, uv), " is ", sum);
        }
        for (int k = 0; k < mesh.pointSize; ++k) {
            double const difference = double(point[std::size_t(k)]) - values(which, k);
            // On an edge the point comes from the cells of that: both are a millionth away at most.
            double const approximation = which == 0 ? 1e-6 * GetSize(mesh.values.levels[0]) : 0;
            if (!(std::abs(difference) <= mesh.GetTolerance() * size + approximation)) {
                Fail(describe("the weighted sum", face, uv), " is ", point[std::size_t(k)],
                     ", and the point or derivative ", values(which, k));
            }
        }
    }
}

/// The planes that du and dv span, where they span one.
bool haveSamePlane(ReferenceValues const &a, ReferenceValues const &b) {
    using Eigen::Vector3d;
    Vector3d const normal = Vector3d(a.row(1)).cross(Vector3d(a.row(2)));
    Vector3d const other = Vector3d(b.row(1)).cross(Vector3d(b.row(2)));
    double const area = a.row(1).norm() * a.row(2).norm();
    return area < 1e-6 || normal.norm() < 0.03 * area ||
           (normal.normalized() - other.normalized()).norm() < 1e-3;
}

/// Facets cover the face: each side of one is that of another, turned, or on the boundary.
void checkFacets(LevelTessellation const &tessellation, int face) {
    std::vector<int> sizes(std::size_t(tessellation.GetNumFacets()));
    tessellation.GetFacetSizes(sizes.data());
    std::vector<int> indices(std::size_t(tessellation.GetNumFacetVertices()));
    tessellation.GetFacets(indices.data());
    std::set<std::pair<int, int>> sides;
    int const *facet = indices.data();
    for (int const size : sizes) {
        for (int i = 0; i < size; ++i) {
            if (!sides.emplace(facet[i], facet[(i + 1) % size]).second) {
                Fail("two facets of face ", face, " have side ", facet[i]);
            }
        }
        facet += size;
    }
    int const numBoundary = tessellation.GetNumBoundaryCoords();
    int numOnBoundary = 0;
    for (auto const &[start, end] : sides) {
        if (sides.count({end, start}) == 0) {
            ++numOnBoundary;
            if (start >= numBoundary || end != (start + 1) % numBoundary) {
                Fail("the facets of face ", face, " have a gap at place ", start);
            }
        }
    }
    if (numOnBoundary != numBoundary) {
        Fail("the facets of face ", face, " have ", numOnBoundary, " sides on the boundary, not ",
             numBoundary);
    }
}

/// The points of a tessellation, with and without derivatives, and those of single places.
template <typename REAL>
std::vector<REAL> checkTessellation(MeshSurfaces<REAL> const &mesh,
                                    LevelTessellation const &tessellation, int face, Dice &dice) {
    constexpr int kNumPlaces = 40; // about so many are looked at
    REAL const untouched = REAL(-12345.678);
    int const count = tessellation.GetNumCoords();
    int const size = mesh.pointSize;
    typename Surface<REAL>::PointDescriptor const desc(size, size + dice.Roll(3));
    std::vector<REAL> results[4];
    for (std::vector<REAL> &result : results) {
        result.assign(std::size_t(count) * std::size_t(desc.stride), untouched);
    }
    Surface<REAL> const &surface = mesh.surfaces[std::size_t(face)];
    REAL const *const control = mesh.GetControlPoints(face);
    surface.Evaluate(tessellation, control, size, results[0].data(), results[1].data(),
                     results[2].data(), desc);
    surface.Evaluate(tessellation, control, size, results[3].data(), desc);
    if (results[3] != results[0]) {
        Fail("the points of face ", face, " depend on whether derivatives are evaluated");
    }
    std::vector<REAL> coords(2 * std::size_t(count));
    tessellation.GetCoords(coords.data());
    std::vector<REAL> points;
    for (int i = 0; i < count; ++i) {
        std::size_t const first = std::size_t(i) * std::size_t(desc.stride);
        points.insert(points.end(), &results[0][first], &results[0][first] + size);
        ReferenceValues values(3, size);
        for (int which = 0; which < 3; ++which) {
            for (int k = 0; k < desc.stride; ++k) {
                REAL const value = results[which][first + std::size_t(k)];
                if (k < size) {
                    values(which, k) = double(value);
                } else if (value != untouched) {
                    Fail("a number behind place ", i, " of face ", face, " is written");
                }
            }
        }
        REAL const *const uv = &coords[2 * std::size_t(i)];
        if (!values.allFinite()) {
            Fail(describe("place", face, uv), ", number ", i, ", has ", values);
        }
        if (dice.Roll(count) > kNumPlaces) {
            continue;
        }
        ReferenceValues const expected = mesh.Evaluate(face, uv);
        if (!(GetDifference(values.row(0), expected.row(0)) <= mesh.GetTolerance())) {
            Fail(describe("place", face, uv), ", number ", i, " of ", count, ", has ",
                 values.row(0), ", not ", expected.row(0));
        }
        bool const isSmooth = mesh.values.mode == FarExt::INTERPOLATE_VERTEX;
        if (isSmooth && sizeof(REAL) == sizeof(double) && !haveSamePlane(values, expected)) {
            Fail(describe("place", face, uv), ", number ", i, " of ", count, ", has derivatives\n",
                 values, "\nnot\n", expected);
        }
    }
    return points;
}

/// A tree of a few cells anywhere, or those of levels.
CellTree makeTree(FarExt::FaceShape shape, Dice &dice) {
    constexpr int kNumLevels = 4;
    if (dice.IsOneOf(2)) {
        std::vector<int> levels;
        for (int edge = 0; edge < shape.size; ++edge) {
            levels.push_back(dice.Roll(kNumLevels));
        }
        return CellTree(shape, levels.data(), dice.Roll(kNumLevels));
    }
    CellTree tree(shape);
    for (int i = dice.Roll(10); i > 0; --i) {
        tree.Refine(dice.Roll(tree.GetNumCells()));
    }
    return tree;
}

template <typename REAL>
void checkSurfaces(OracleLevels const &levels, OracleLevels::Values const &values, Dice &dice) {
    MeshSurfaces<REAL> const mesh(levels, values);
    FarExt::SurfaceFaces const &faces = mesh.factory->GetFaces();
    if (values.mode == FarExt::INTERPOLATE_VERTEX) {
        checkLimitsOfVertices(mesh, levels, dice);
    }
    for (int i = 0; i < 4; ++i) {
        int const face = dice.Roll(mesh.factory->GetNumFaces());
        if (mesh.Has(face)) {
            checkPlace(mesh, face, dice);
        }
    }
    CellForest forest(levels.refiner);
    bool const isUniform = dice.IsOneOf(4);
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        FarExt::FaceShape const shape = faces.GetShape(face);
        forest.SetTree(face, isUniform ? CellTree(shape, 2) : makeTree(shape, dice));
    }
    for (int i = dice.Roll(3); i > 0; --i) {
        forest.SetEdge(dice.Roll(faces.GetNumEdges()), Polyline(dice.Roll(7)));
    }
    forest.MatchEdges();
    CheckForest(mesh, forest, dice);
    CheckRates(mesh, dice);
    CheckPlaces(mesh, dice);
    if (values.mode != FarExt::INTERPOLATE_VERTEX) {
        return;
    }
    CheckStreams(mesh, forest, dice);
    unsigned const seed = unsigned(dice.Roll(1 << 16));
    auto const rollLevel = [seed](int i) { return Dice(seed + 17 * unsigned(i)).Roll(4); };
    // So fine that it comes in sections where there is little memory.
    int const fineFace = dice.IsOneOf(8) ? dice.Roll(faces.GetNumFaces()) : -1;
    auto const rollFaceLevel = [=](int face) { return face == fineFace ? 7 : rollLevel(face); };
    CheckStreams(mesh, PatchLevels(rollFaceLevel, rollLevel), dice);
    if constexpr (sizeof(REAL) == sizeof(double)) {
        CheckViews(mesh, dice);
    }
}

} // namespace

template <typename REAL>
MeshSurfaces<REAL>::MeshSurfaces(OracleLevels const &levels,
                                 OracleLevels::Values const &valuesOfCase)
    : oracleCase(levels.oracleCase), values(valuesOfCase), pointSize(int(values.levels[0].cols())) {
    CallStatus status;
    factory = BfrExt::SurfaceFactory::Create(levels.refiner, &status);
    if (!factory) {
        Fail("no SurfaceFactory: ", status.GetErrorMessage());
    }
    TopologyLevel const &base = factory->GetLevel();
    ReferenceValues const &control = values.levels[std::size_t(base.GetDepth())];
    for (Eigen::Index i = 0; i < control.size(); ++i) {
        points.push_back(REAL(control(i / pointSize, i % pointSize)));
    }
    surfaces.resize(std::size_t(factory->GetNumFaces()));
    controlPoints.resize(surfaces.size());
    for (int face = 0; face < factory->GetNumFaces(); ++face) {
        Surface<REAL> &surface = surfaces[std::size_t(face)];
        bool const isMade = InitSurface(*factory, face, values, &surface, &status);
        bool const isToHave = isToHaveSurface(levels, *factory, face);
        // Of a vertex that comes apart, fans of values may lie inside where others are at the boundary.
        bool const mayHave = values.mode == FarExt::INTERPOLATE_FACE_VARYING && isMade;
        if (isMade != surface.IsValid() || factory->FaceHasLimitSurface(face) != isToHave ||
            (isMade != isToHave && !mayHave)) {
            Fail("the surface of face ", face, " is ", isMade ? "made" : status.GetErrorMessage());
        }
        std::vector<REAL> &ofFace = controlPoints[std::size_t(face)];
        ofFace.resize(std::size_t(surface.GetNumControlPoints()) * std::size_t(pointSize));
        surface.GatherControlPoints(points.data(), pointSize, ofFace.data(), pointSize);
    }
}

template <typename REAL>
bool MeshSurfaces<REAL>::IsJoined(int face) const {
    if (values.mode == FarExt::INTERPOLATE_FACE_VARYING) {
        return false; // there may be seams
    }
    TopologyLevel const &base = factory->GetLevel();
    for (int const vert : base.GetFaceVertices(factory->GetFaces().GetLevelFace(face).face)) {
        for (int const beside : base.GetVertexFaces(vert)) {
            for (int const around : base.GetFaceVertices(beside)) {
                if (base.IsVertexNonManifold(around)) {
                    return false;
                }
            }
        }
    }
    return true;
}

template <typename REAL>
ReferenceValues MeshSurfaces<REAL>::Evaluate(int face, REAL const uv[2]) const {
    REAL results[3][kMaxPointSize];
    Surface<REAL> const &surface = surfaces[std::size_t(face)];
    std::vector<REAL> weights[3];
    for (std::vector<REAL> &row : weights) {
        row.resize(std::size_t(surface.GetNumControlPoints()));
    }
    surface.EvaluateStencil(uv, weights[0].data(), weights[1].data(), weights[2].data());
    for (std::size_t i = 0; i < 3; ++i) {
        surface.ApplyStencil(weights[i].data(), GetControlPoints(face), pointSize, results[i]);
    }
    ReferenceValues evaluated(3, pointSize);
    for (int which = 0; which < 3; ++which) {
        for (int k = 0; k < pointSize; ++k) {
            evaluated(which, k) = double(results[which][k]);
        }
    }
    return evaluated;
}

template <typename REAL>
double MeshSurfaces<REAL>::GetTolerance() const {
    return oracleCase.GetTolerance(sizeof(REAL) == sizeof(double) ? 4e-9 : 1e-4) *
           std::max(1.0, GetSize(values.levels[0]));
}

template <typename REAL>
void CheckForest(MeshSurfaces<REAL> const &mesh, CellForest const &forest, Dice &dice) {
    constexpr int kMaxCoords = 20000;
    std::size_t const size = std::size_t(mesh.pointSize);
    int const facetSize = dice.IsOneOf(2) ? 3 : 0;
    std::map<int, std::vector<REAL>> pointsByNumber;
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        LevelTessellation const tessellation =
            forest.GetTessellation(face, LevelTessellation::Options().SetFacetSize(facetSize));
        if (!tessellation.IsValid() || !forest.IsMatched(face)) {
            Fail("the tessellation of face ", face, " is not valid");
        }
        if (tessellation.GetNumCoords() > kMaxCoords) {
            continue;
        }
        checkFacets(tessellation, face);
        if (!mesh.Has(face)) {
            continue;
        }
        std::vector<REAL> const points = checkTessellation(mesh, tessellation, face, dice);
        std::vector<int> numbers(std::size_t(tessellation.GetNumBoundaryCoords()));
        forest.GetBoundaryPoints(face, numbers.data());
        for (std::size_t i = 0; i < numbers.size() && mesh.IsJoined(face); ++i) {
            std::vector<REAL> const point(&points[i * size], &points[i * size] + size);
            if (pointsByNumber.emplace(numbers[i], point).first->second != point) {
                Fail("place ", i, " of face ", face, " has other bits than in another face");
            }
        }
    }
}

void CheckSurfaces(OracleLevels const &levels, Dice &dice) {
    // Mostly vertex data, which have most rules.
    std::size_t const which =
        dice.IsOneOf(2) ? 0 : std::size_t(dice.Roll(int(levels.values.size())));
    if (dice.IsOneOf(3)) {
        checkSurfaces<float>(levels, levels.values[which], dice);
    } else {
        checkSurfaces<double>(levels, levels.values[which], dice);
    }
}

template struct MeshSurfaces<float>;
template struct MeshSurfaces<double>;
template void CheckForest(MeshSurfaces<float> const &, CellForest const &, Dice &);
template void CheckForest(MeshSurfaces<double> const &, CellForest const &, Dice &);

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "meshSurfaces.h"

#include "bfr_ext/levelTessellation.h"
#include "bfr_ext/surfacePlaces.h"
#include "far_ext/executor.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace OpenSubdivHex::Regression {

using BfrExt::LevelTessellation;
using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using FarExt::SurfaceFaces;

namespace {

constexpr int kNumRows = 6; // point, du, dv, duu, duv, dvv

/// Whether two planes of first derivatives are the same, where both span one.
bool haveSameNormal(ReferenceValues const &a, ReferenceValues const &b, double allowed) {
    using Eigen::Vector3d;
    auto const getNormal = [](ReferenceValues const &values) {
        return Vector3d(Vector3d(values.row(1)).cross(Vector3d(values.row(2))));
    };
    auto const isPlane = [&](ReferenceValues const &values) {
        double const area = values.row(1).norm() * values.row(2).norm();
        return area > 1e-4 && getNormal(values).norm() > 0.1 * area;
    };
    return !isPlane(a) || !isPlane(b) ||
           (getNormal(a).normalized() - getNormal(b).normalized()).norm() < allowed;
}

/// The surfaces of a mesh with patches of some level, evaluated at (u, v).
template <typename REAL>
class PlacesChecker {
public:
    PlacesChecker(MeshSurfaces<REAL> const &mesh, Dice &dice)
        : _mesh(mesh), _faces(mesh.factory->GetFaces()), _dice(dice), _smooth(2 + dice.Roll(4)),
          _sharp(dice.IsOneOf(2) ? _smooth : 2 + dice.Roll(4)), _size(mesh.pointSize),
          _cache(dice.IsOneOf(2) ? 4096 : std::size_t(1) << 30) {
        _factory = createFactory(_cache);
        _surfaces.resize(std::size_t(_faces.GetNumFaces()));
        _points.resize(_surfaces.size());
        for (int face = 0; face < _faces.GetNumFaces(); ++face) {
            if (mesh.Has(face)) {
                prepare(face);
            }
        }
    }

    void Check() {
        constexpr int kNumFaces = 12; // about so many are looked at
        for (int face = 0; face < _faces.GetNumFaces(); ++face) {
            if (_mesh.Has(face) && _dice.Roll(_faces.GetNumFaces()) <= kNumFaces) {
                checkCorners(face);
                for (int i = 0; i < 8; ++i) {
                    checkPlace(face);
                    checkOutside(face);
                }
            }
        }
        for (int edge = 0; edge < _faces.GetNumEdges(); ++edge) {
            checkEdge(edge);
        }
        checkPlaces();
    }

private:
    std::unique_ptr<SurfaceFactory> createFactory(BfrExt::SurfaceFactoryCache &cache) const {
        return SurfaceFactory::Create(_mesh.factory->GetMesh(), SurfaceFactory::Options()
                                                                    .SetExternalCache(&cache)
                                                                    .SetApproxLevelSmooth(_smooth)
                                                                    .SetApproxLevelSharp(_sharp));
    }
    bool isVertexData() const { return _mesh.values.mode == FarExt::INTERPOLATE_VERTEX; }
    double getScale() const { return std::max(1.0, GetSize(_mesh.values.levels[0])); }

    void prepare(int face) {
        Surface<REAL> &surface = _surfaces[std::size_t(face)];
        FarExt::CallStatus status;
        if (!InitSurface(*_factory, face, _mesh.values, &surface, &status)) {
            Fail("face ", face, " has no surface: ", status.GetErrorMessage());
        }
        std::vector<REAL> &points = _points[std::size_t(face)];
        REAL const untouched = REAL(-12345.678);
        int const stride = _size + 1;
        points.assign(std::size_t(surface.GetNumPatchPoints() * stride), untouched);
        surface.PreparePatchPoints(_mesh.points.data(), _size, points.data(), {_size, stride});
        double const largest =
            GetSize(_mesh.values.levels[std::size_t(_factory->GetLevel().GetDepth())]);
        for (std::size_t i = 0; i < points.size(); ++i) {
            bool const isGap = i % std::size_t(stride) == std::size_t(_size);
            if (isGap ? points[i] != untouched
                      : !(std::abs(double(points[i])) <= largest * (1 + 1e-4) + 1e-6)) {
                Fail("number ", i, " of the patch points of face ", face, " is ", points[i]);
            }
        }
    }

    ReferenceValues evaluate(int face, REAL const uv[2], int numRows = 3) const {
        REAL results[kNumRows][3];
        Surface<REAL> const &surface = _surfaces[std::size_t(face)];
        REAL const *const points = _points[std::size_t(face)].data();
        typename Surface<REAL>::PointDescriptor const desc(_size, _size + 1);
        if (numRows == 1) {
            surface.Evaluate(uv, points, desc, results[0]);
        } else if (numRows == 3) {
            surface.Evaluate(uv, points, desc, results[0], results[1], results[2]);
        } else {
            surface.Evaluate(uv, points, desc, results[0], results[1], results[2], results[3],
                             results[4], results[5]);
        }
        ReferenceValues values(numRows, _size);
        for (int row = 0; row < numRows; ++row) {
            for (int k = 0; k < _size; ++k) {
                values(row, k) = double(results[row][k]);
            }
        }
        return values;
    }

    template <typename... PARTS>
    [[noreturn]] void fail(int face, REAL const *uv, PARTS const &...parts) const {
        Fail("patches of levels ", _smooth, " and ", _sharp, ": face ", face, " at ", uv[0], ", ",
             uv[1], parts...);
    }

    /// Whether the surface may have no tangent plane at a vertex of the face.
    bool hasSharpVertex(int face) const {
        FarExt::TopologyLevel const &level = _factory->GetLevel();
        auto const verts = level.GetFaceVertices(_faces.GetLevelFace(face).face);
        return std::any_of(verts.begin(), verts.end(), [&](int vert) {
            auto const edges = level.GetVertexEdges(vert);
            return level.IsVertexNonManifold(vert) || level.GetVertexSharpness(vert) > 0 ||
                   std::any_of(edges.begin(), edges.end(),
                               [&](int edge) { return level.GetEdgeSharpness(edge) > 0; });
        });
    }

    /// Corners of cells have the limit points and the tangent planes of the surface.
    void checkCorners(int face) {
        // The coarser of the levels: corners of its cells are corners of finer ones.
        LevelTessellation const corners(_surfaces[std::size_t(face)].GetParameterization(),
                                        std::min(_smooth, _sharp));
        std::vector<REAL> coords(2 * std::size_t(corners.GetNumCoords()));
        corners.GetCoords(coords.data());
        constexpr int kNumCorners = 30; // about so many are looked at
        for (int i = 0; i < corners.GetNumCoords(); ++i) {
            if (_dice.Roll(corners.GetNumCoords()) > kNumCorners) {
                continue;
            }
            REAL const *const uv = &coords[2 * std::size_t(i)];
            ReferenceValues const values = evaluate(face, uv);
            ReferenceValues const expected = _mesh.Evaluate(face, uv);
            if (!(GetDifference(values.row(0), expected.row(0)) <= 10 * _mesh.GetTolerance())) {
                fail(face, uv, ", a corner of cells, have the point ", values.row(0), ", not ",
                     expected.row(0));
            }
            if (isVertexData() && !hasSharpVertex(face) &&
                !haveSameNormal(values, expected, isDouble() ? 1e-4 : 0.03)) {
                fail(face, uv, ", a corner of cells, have derivatives\n", values, "\nnot\n",
                     expected);
            }
        }
    }

    static constexpr bool isDouble() { return sizeof(REAL) == sizeof(double); }

    /// A place inside of a face.
    void rollInside(int face, REAL uv[2]) {
        BfrExt::Parameterization const ofFace = _surfaces[std::size_t(face)].GetParameterization();
        bool const hasSubFaces = ofFace.HasSubFaces();
        REAL place[2];
        do {
            for (REAL &number : place) {
                number = REAL(1 + _dice.Roll((1 << 20) - 2)) / REAL(1 << (hasSubFaces ? 21 : 20));
            }
        } while (ofFace.GetFaceSize() == 3 && place[0] + place[1] >= 1);
        uv[0] = uv[1] = 0;
        if (hasSubFaces) {
            ofFace.GetVertexCoord(_dice.Roll(ofFace.GetFaceSize()), uv);
        }
        uv[0] += place[0];
        uv[1] += place[1];
    }

    /// A place anywhere: close to the surface, with derivatives that are those of its points.
    void checkPlace(int face) {
        REAL uv[2];
        rollInside(face, uv);
        ReferenceValues const values = evaluate(face, uv, kNumRows);
        if (!values.allFinite()) {
            fail(face, uv, " have ", values);
        }
        if (values.topRows(3) != evaluate(face, uv) || values.topRows(1) != evaluate(face, uv, 1)) {
            fail(face, uv, " depend on how many derivatives are asked for");
        }
        ReferenceValues const expected = _mesh.Evaluate(face, uv);
        double const distance = (values.row(0) - expected.row(0)).norm();
        if (!(distance <= (!isVertexData() || hasSharpVertex(face) ? 0.5 : 0.1) * getScale())) {
            fail(face, uv, " have the point ", values.row(0), ", not ", expected.row(0));
        }
        if (isDouble() && std::min(_smooth, _sharp) > 2) {
            checkDifferences(face, uv, values);
        }
    }

    /// (u, v) outside of the face have a point of the surface, and what is no number has none.
    void checkOutside(int face) {
        REAL const choices[] = {std::numeric_limits<REAL>::quiet_NaN(),
                                std::numeric_limits<REAL>::infinity(),
                                std::numeric_limits<REAL>::max(),
                                -std::numeric_limits<REAL>::max(),
                                std::numeric_limits<REAL>::denorm_min(),
                                -std::numeric_limits<REAL>::denorm_min(),
                                REAL(1e9),
                                REAL(-1),
                                REAL(0),
                                REAL(0.5),
                                REAL(1),
                                REAL(3)};
        REAL const uv[2] = {choices[_dice.Roll(int(std::size(choices)))],
                            choices[_dice.Roll(int(std::size(choices)))]};
        ReferenceValues const values = evaluate(face, uv, kNumRows);
        if (std::isnan(uv[0]) || std::isnan(uv[1])) {
            if (!values.array().isNaN().all()) {
                fail(face, uv, " have ", values);
            }
        } else if (std::isfinite(uv[0]) && std::isfinite(uv[1]) && !values.allFinite()) {
            fail(face, uv, " have ", values);
        }
    }

    /// Derivatives against differences, where there is no line between patches.
    void checkDifferences(int face, REAL const uv[2], ReferenceValues const &values) {
        constexpr double kStep = 1e-5;
        ReferenceValues beside[2][2];
        for (int k = 0; k < 2; ++k) {
            for (int side = 0; side < 2; ++side) {
                REAL place[2] = {uv[0], uv[1]};
                place[k] += REAL(side == 0 ? -kStep : kStep);
                beside[k][side] = evaluate(face, place, kNumRows);
            }
        }
        double const scale = getScale();
        for (int k = 0; k < 2; ++k) {
            ReferenceValues const back = (values - beside[k][0]) / kStep;
            ReferenceValues const ahead = (beside[k][1] - values) / kStep;
            // A line between patches, or the boundary, is near where the changes of derivatives differ.
            double const bend = (back - ahead).cwiseAbs().maxCoeff();
            double const size = values.cwiseAbs().maxCoeff() + scale;
            if (bend > 0.05 * size) {
                continue;
            }
            Eigen::RowVectorXd const difference = (back.row(0) + ahead.row(0)) / 2;
            // Derivatives leave out how the two points inside of a corner are blended.
            if (!((difference - values.row(1 + k)).norm() <= 0.05 * bend + 0.05 * size)) {
                fail(face, uv, " have derivative ", values.row(1 + k), " by ", k,
                     ", and differences ", difference);
            }
        }
    }

    /// Both faces beside an edge have the same points there, except for rounding.
    void checkEdge(int edge) {
        SurfaceFaces::Side const sides[2] = {_faces.GetSide(edge, 0), _faces.GetSide(edge, 1)};
        if (_smooth != _sharp ||
            !std::all_of(sides, sides + 2, [this](SurfaceFaces::Side const &side) {
                return side.face >= 0 && _mesh.Has(side.face) && _mesh.IsJoined(side.face);
            })) {
            return;
        }
        constexpr int kNumSegments = 1 << 12;
        for (int i = 0; i < 3; ++i) {
            int const at = _dice.Roll(kNumSegments + 1);
            ReferenceValues values[2];
            REAL uvs[2][2];
            for (int side = 0; side < 2; ++side) {
                auto const &[face, local] = sides[side];
                bool const isReversed = _faces.GetEdge(face, local).isReversed;
                REAL const along = REAL(isReversed ? kNumSegments - at : at) / REAL(kNumSegments);
                _surfaces[std::size_t(face)].GetParameterization().GetEdgeCoord(local, along,
                                                                                uvs[side]);
                values[side] = evaluate(face, uvs[side]);
            }
            double const allowed = (isDouble() ? 1e-11 : 1e-5) * getScale();
            if (!(GetDifference(values[0].row(0), values[1].row(0)) <= allowed)) {
                fail(sides[0].face, uvs[0], ", on edge ", edge, ", have the point ",
                     values[0].row(0), ", and face ", sides[1].face, ' ', values[1].row(0));
            }
        }
    }

    /// SurfacePlaces: the bits of surfaces, for any number of threads.
    void checkPlaces() {
        std::vector<int> ofMesh;
        for (int face = 0; face < _faces.GetNumFaces(); ++face) {
            if (_mesh.Has(face)) {
                ofMesh.push_back(face);
            }
        }
        if (ofMesh.empty()) {
            return;
        }
        int const count = 1 + _dice.Roll(200);
        std::vector<int> faces;
        std::vector<REAL> uvs;
        for (int i = 0; i < count; ++i) {
            faces.push_back(ofMesh[std::size_t(_dice.Roll(int(ofMesh.size())))]);
            uvs.push_back(REAL(_dice.Roll(1 << 20)) / REAL(1 << 19) - REAL(0.5));
            uvs.push_back(REAL(_dice.Roll(1 << 20)) / REAL(1 << 19) - REAL(0.5));
        }
        typename BfrExt::SurfacePlaces<REAL>::Options options;
        options.interpolationMode = _mesh.values.mode;
        options.fvarChannel = _mesh.values.channel;
        auto const numNumbers = std::size_t(count * _size);
        for (int const numThreads : {1, 8}) {
            // Threads find weights at once.
            BfrExt::SurfaceFactoryCache cache;
            auto const places = BfrExt::SurfacePlaces<REAL>::Create(
                *createFactory(cache), count, faces.data(), uvs.data(), options);
            if (!places) {
                Fail("no places");
            }
            FarExt::ExecutorScope const threads(nullptr, numThreads);
            std::vector<REAL> p(numNumbers), du(numNumbers), dv(numNumbers);
            places->Evaluate(_mesh.points.data(), _size, p.data(), du.data(), dv.data(), _size);
            for (int i = 0; i < count; ++i) {
                ReferenceValues const expected =
                    evaluate(faces[std::size_t(i)], &uvs[2 * std::size_t(i)]);
                for (int k = 0; k < _size; ++k) {
                    auto const at = std::size_t(i * _size + k);
                    if (double(p[at]) != expected(0, k) || double(du[at]) != expected(1, k) ||
                        double(dv[at]) != expected(2, k)) {
                        fail(faces[std::size_t(i)], &uvs[2 * std::size_t(i)],
                             " have other bits among places, with threads ", numThreads);
                    }
                }
            }
        }
    }

    MeshSurfaces<REAL> const &_mesh;
    SurfaceFaces const &_faces;
    Dice &_dice;
    int const _smooth; // levels of patches
    int const _sharp;
    int const _size;                    // numbers of a point
    BfrExt::SurfaceFactoryCache _cache; // which holds all types, or hardly any
    std::unique_ptr<SurfaceFactory> _factory;
    std::vector<Surface<REAL>> _surfaces;
    std::vector<std::vector<REAL>> _points; // of patches, by face
};

} // namespace

template <typename REAL>
void CheckPlaces(MeshSurfaces<REAL> const &mesh, Dice &dice) {
    PlacesChecker<REAL>(mesh, dice).Check();
}

template void CheckPlaces(MeshSurfaces<float> const &, Dice &);
template void CheckPlaces(MeshSurfaces<double> const &, Dice &);

} // namespace OpenSubdivHex::Regression

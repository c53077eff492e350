// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_SURFACE_FIXTURE_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_SURFACE_FIXTURE_H

#include "bfr_ext/surfaceFactory.h"
#include "far_ext/primvarRefiner.h"

#include <array>
#include <cmath>
#include <vector>

namespace OpenSubdivHex::Regression {

using Vector3 = std::array<double, 3>;

inline Vector3 Scale(Vector3 const &a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline Vector3 Subtract(Vector3 const &a, Vector3 const &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double Dot(Vector3 const &a, Vector3 const &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector3 ToVector(double const *p) { return {p[0], p[1], p[2]}; }
inline double GetLength(Vector3 const &a) { return std::hypot(a[0], a[1], a[2]); }
inline double GetDistance(Vector3 const &a, Vector3 const &b) { return GetLength(Subtract(a, b)); }
inline Vector3 Cross(Vector3 const &a, Vector3 const &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector3 Normalize(Vector3 const &a) { return Scale(a, 1 / GetLength(a)); }

/// A point of a surface, with first derivatives.
struct SurfacePoint {
    Vector3 p;
    Vector3 du;
    Vector3 dv;
};

inline Vector3 GetNormal(SurfacePoint const &point) { return Normalize(Cross(point.du, point.dv)); }

/// A number for PrimvarRefiner, or several.
template <typename REAL, std::size_t LENGTH>
struct Numbers {
    void Clear() { values = {}; }
    void AddWithWeight(Numbers const &other, REAL weight) {
        for (std::size_t i = 0; i < LENGTH; ++i) {
            values[i] += weight * other.values[i];
        }
    }

    std::array<REAL, LENGTH> values{};
};

template <typename REAL>
std::vector<Numbers<REAL, 3>> ToPoints(std::vector<REAL> const &positions) {
    std::vector<Numbers<REAL, 3>> points(positions.size() / 3);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        points[i / 3].values[i % 3] = positions[i];
    }
    return points;
}

/// The positions of the surface level, which surfaces take, from those of level 0.
template <typename REAL>
std::vector<REAL> FindControlPoints(FarExt::TopologyRefiner const &refiner,
                                    std::vector<REAL> const &positions) {
    int const level = refiner.GetHexSchemeOptions().GetSurfaceLevel();
    if (level == 0) {
        return positions;
    }
    using Point = Numbers<REAL, 3>;
    std::vector<Point> next(std::size_t(refiner.GetLevel(level).GetNumVertices()));
    FarExt::PrimvarRefinerReal<REAL>(refiner).Interpolate(level, ToPoints(positions), next);
    std::vector<REAL> result;
    for (Point const &point : next) {
        result.insert(result.end(), point.values.begin(), point.values.end());
    }
    return result;
}

/// By stencils, which are exact; SurfacePlaces.* test what patches make of places.
template <typename REAL>
SurfacePoint EvaluateSurface(BfrExt::Surface<REAL> const &surface,
                             std::vector<REAL> const &positions, REAL const uv[2]) {
    std::vector<REAL> weights[3];
    for (std::vector<REAL> &row : weights) {
        row.resize(std::size_t(surface.GetNumControlPoints()));
    }
    surface.EvaluateStencil(uv, weights[0].data(), weights[1].data(), weights[2].data());
    REAL values[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        surface.ApplyStencilFromMesh(weights[i].data(), positions.data(), 3, values[i]);
    }
    SurfacePoint result;
    for (std::size_t k = 0; k < 3; ++k) {
        result.p[k] = double(values[0][k]);
        result.du[k] = double(values[1][k]);
        result.dv[k] = double(values[2][k]);
    }
    return result;
}

/// The surfaces of all base faces, as far as they have any.
template <typename REAL>
class SurfaceSet {
public:
    /// \brief Makes the surfaces of a refiner, which has the surface level.
    ///
    /// \param positions  of level 0
    /// \param cache      of the types, or null
    SurfaceSet(FarExt::TopologyRefiner const &refiner, std::vector<REAL> const &positions,
               BfrExt::SurfaceFactoryCache *cache = nullptr)
        : _positions(FindControlPoints(refiner, positions)) {
        auto const factory = BfrExt::SurfaceFactory::Create(
            refiner, BfrExt::SurfaceFactory::Options().SetExternalCache(cache));
        _surfaces.resize(std::size_t(factory->GetNumFaces()));
        for (int face = 0; face < factory->GetNumFaces(); ++face) {
            factory->InitVertexSurface(face, &_surfaces[std::size_t(face)]);
        }
    }

    BfrExt::Surface<REAL> const &operator[](int face) const { return _surfaces[std::size_t(face)]; }

    SurfacePoint Evaluate(int face, REAL const uv[2]) const {
        return EvaluateSurface((*this)[face], _positions, uv);
    }
    /// The second derivatives: by u twice, by u and v, by v twice.
    std::array<Vector3, 3> EvaluateSecond(int face, REAL const uv[2]) const {
        BfrExt::Surface<REAL> const &surface = (*this)[face];
        std::vector<REAL> weights[6];
        for (std::vector<REAL> &row : weights) {
            row.resize(std::size_t(surface.GetNumControlPoints()));
        }
        surface.EvaluateStencil(uv, weights[0].data(), weights[1].data(), weights[2].data(),
                                weights[3].data(), weights[4].data(), weights[5].data());
        std::array<Vector3, 3> result;
        for (std::size_t i = 0; i < 3; ++i) {
            REAL value[3];
            surface.ApplyStencilFromMesh(weights[3 + i].data(), _positions.data(), 3, value);
            result[i] = ToVector(value);
        }
        return result;
    }
    /// Without derivatives, which take most of the time.
    Vector3 EvaluatePosition(int face, REAL const uv[2]) const {
        BfrExt::Surface<REAL> const &surface = (*this)[face];
        std::vector<REAL> weights(std::size_t(surface.GetNumControlPoints()));
        surface.EvaluateStencil(uv, weights.data());
        REAL p[3];
        surface.ApplyStencilFromMesh(weights.data(), _positions.data(), 3, p);
        return {double(p[0]), double(p[1]), double(p[2])};
    }

    /// Positions of the surface level.
    std::vector<REAL> const &GetPositions() const { return _positions; }

private:
    std::vector<REAL> const _positions;
    std::vector<BfrExt::Surface<REAL>> _surfaces;
};

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_POLYGON_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_POLYGON_H

#include "pi.h"

#include "far_ext/indexing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace OpenSubdivHex::FarExt::internal {

/// \brief A point of the triangle of a base face's centre with the start, a, and the end, b, of one
/// of its edges, the *sector* of the edge: centre + a (start - centre) + b (end - centre).  All such
/// coordinates of vertices are multiples of powers of 1/2, and so exact.
struct SectorPoint {
    double a = 0;
    double b = 0;
};

/// \brief A base face in its plane, counter-clockwise, edge 0 from (0, 0) to (1, 0): a triangle has its third corner
/// at (0, 1), a quad is the unit square, others are regular polygons.  Half a polygon differs in its centre alone.
class BasePolygon {
public:
    using Pair = std::array<double, 2>;

    explicit BasePolygon(FaceShape shape)
        : _shape(shape), _size(shape.size), _radius(0.5 / std::sin(kPi / shape.size)),
          _regularCenter(shape.size == 3   ? Pair{kThird, kThird}
                         : shape.size == 4 ? Pair{0.5, 0.5}
                                           : Pair{0.5, 0.5 / std::tan(kPi / shape.size)}),
          _center(shape.isHalf ? Pair{0.5, 0} : _regularCenter) {}

    FaceShape GetShape() const { return _shape; }
    int GetSize() const { return _size; }

    template <typename REAL>
    void Write(int sector, SectorPoint point, REAL *uv) const {
        if (_size == 3 && !_shape.isHalf) {
            // Without rounding on the border.
            double const ofAll = (1 - point.a - point.b) * kThird;
            double weights[3] = {ofAll, ofAll, ofAll};
            weights[sector] += point.a;
            weights[(sector + 1) % 3] += point.b;
            uv[0] = REAL(weights[1]);
            uv[1] = REAL(weights[2]);
            return;
        }
        Pair const start = GetCorner(sector);
        Pair const end = GetCorner((sector + 1) % _size);
        uv[0] = REAL(_center[0] + (point.a * start[0] + point.b * end[0]));
        uv[1] = REAL(_center[1] + (point.a * start[1] + point.b * end[1]));
    }

    Pair GetCenter() const { return _center; }

    /// The linear map from the plane, relative to the centre, to a and b in a sector: by row.
    std::array<Pair, 2> GetSectorMap(int sector) const {
        Pair const start = GetCorner(sector);
        Pair const end = GetCorner((sector + 1) % _size);
        double const determinant = start[0] * end[1] - start[1] * end[0];
        return {Pair{end[1] / determinant, -end[0] / determinant},
                Pair{-start[1] / determinant, start[0] / determinant}};
    }

    /// Corner number i, from the centre.
    Pair GetCorner(int i) const {
        if (_shape.isHalf) {
            Pair const corner = getRegularCorner(i);
            return _size == 3 ? Pair{i == 1 ? 0.5 : -0.5, i == 2 ? 1.0 : 0.0}
                              : Pair{corner[0], corner[1] + _regularCenter[1]};
        }
        return getRegularCorner(i);
    }

    /// The sector that has a point of the plane, or is nearest to it, and the point there.
    SectorPoint FindSector(Pair const &point, int &sector) const {
        double const x = point[0] - _center[0];
        double const y = point[1] - _center[1];
        SectorPoint best;
        for (int i = _shape.GetFirstSector(); i < _size; ++i) {
            Pair const start = GetCorner(i);
            Pair const end = GetCorner((i + 1) % _size);
            double const determinant = start[0] * end[1] - start[1] * end[0];
            SectorPoint const found = {(x * end[1] - y * end[0]) / determinant,
                                       (start[0] * y - start[1] * x) / determinant};
            if (i == _shape.GetFirstSector() ||
                std::min(found.a, found.b) > std::min(best.a, best.b)) {
                best = found;
                sector = i;
            }
        }
        return best;
    }

private:
    Pair getRegularCorner(int i) const {
        if (_size == 3) {
            return {i == 1 ? 2 * kThird : -kThird, i == 2 ? 2 * kThird : -kThird};
        }
        if (i <= 1) {
            return {i - 0.5, -_regularCenter[1]};
        }
        if (_size == 4) {
            return {i == 2 ? 0.5 : -0.5, 0.5};
        }
        double const angle = kPi * ((2.0 * i - 1) / _size - 0.5);
        return {_radius * std::cos(angle), _radius * std::sin(angle)};
    }

    static constexpr double kThird = 1.0 / 3;

    FaceShape const _shape;
    int const _size;
    double const _radius;
    Pair const _regularCenter;
    Pair const _center;
};

/// A BasePolygon of a common size, prepared once: places are found in it by the million.
class KnownPolygon {
public:
    using Pair = BasePolygon::Pair;

    /// Returns the polygon of a shape; null where it is not common.
    static KnownPolygon const *Find(FaceShape shape) {
        int const size = shape.size;
        static KnownPolygon const *const kAll = makeAll();
        bool const isKnown = kMinSize <= size && size <= kMaxSize && !shape.isHalf;
        return isKnown ? &kAll[size - kMinSize] : nullptr;
    }

    Pair const &GetCenter() const { return _center; }
    Pair const &GetCorner(int i) const { return _corners[i]; }
    std::array<Pair, 2> const &GetSectorMap(int sector) const { return _sectorMaps[sector]; }

private:
    static constexpr int kMinSize = 3;
    static constexpr int kMaxSize = 8;

    static KnownPolygon const *makeAll() {
        static KnownPolygon const kAll[] = {KnownPolygon(kMinSize), KnownPolygon(4),
                                            KnownPolygon(5),        KnownPolygon(6),
                                            KnownPolygon(7),        KnownPolygon(kMaxSize)};
        return kAll;
    }

    explicit KnownPolygon(int size) : _center(BasePolygon(size).GetCenter()) {
        for (int i = 0; i < size; ++i) {
            _corners[i] = BasePolygon(size).GetCorner(i);
            _sectorMaps[i] = BasePolygon(size).GetSectorMap(i);
        }
    }

    Pair _center;
    Pair _corners[kMaxSize] = {};
    std::array<Pair, 2> _sectorMaps[kMaxSize] = {};
};

/// Calls function(polygon) with the KnownPolygon of a shape, or else with its BasePolygon.
template <typename FUNCTION>
auto UsePolygon(FaceShape shape, FUNCTION const &function) {
    KnownPolygon const *const known = KnownPolygon::Find(shape);
    return known ? function(*known) : function(BasePolygon(shape));
}

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_POLYGON_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_POLYGON_H

#include "pi.h"

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
/// at (0, 1), a quad is the unit square, others are regular polygons.
///
/// Its *centre*, from which sectors are seen, is that of the polygon; that of a half face is the middle of its edge 0, whose
/// sector is empty.
class BasePolygon {
public:
    using Pair = std::array<double, 2>;

    explicit BasePolygon(int size, bool isHalf = false)
        : _size(size), _radius(0.5 / std::sin(kPi / size)), _isHalf(isHalf),
          _center(size == 3   ? Pair{kThird, kThird}
                  : size == 4 ? Pair{0.5, 0.5}
                              : Pair{0.5, 0.5 / std::tan(kPi / size)}) {
        if (isHalf) {
            Pair const start = getRegularCorner(0);
            Pair const end = getRegularCorner(1);
            for (std::size_t i = 0; i < 2; ++i) {
                _moved[i] = 0.5 * (start[i] + end[i]);
                _center[i] += _moved[i];
            }
        }
    }

    int GetSize() const { return _size; }

    template <typename REAL>
    void Write(int sector, SectorPoint point, REAL *uv) const {
        if (_size == 3) {
            // Without rounding on the border.
            double const ofCenter = 1 - point.a - point.b;
            double weights[3] = {ofCenter * kThird, ofCenter * kThird, ofCenter * kThird};
            if (_isHalf) {
                weights[0] = weights[1] = 0.5 * ofCenter;
                weights[2] = 0;
            }
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

    /// The sector that has a place, which is relative to the centre, or is nearest; and where it is there.
    SectorPoint FindSectorPoint(Pair const &place, int &sector) const {
        auto const cross = [](Pair const &a, Pair const &b) { return a[0] * b[1] - a[1] * b[0]; };
        SectorPoint best;
        int const first = _isHalf ? 1 : 0;
        for (int i = first; i < _size; ++i) {
            Pair const start = GetCorner(i);
            Pair const end = GetCorner((i + 1) % _size);
            double const determinant = cross(start, end);
            SectorPoint const point = {cross(place, end) / determinant,
                                       cross(start, place) / determinant};
            if (i == first || std::min(point.a, point.b) > std::min(best.a, best.b)) {
                best = point;
                sector = i;
            }
        }
        return best;
    }

    /// Corner number i, from the centre.
    Pair GetCorner(int i) const {
        Pair const corner = getRegularCorner(i);
        return _isHalf ? Pair{corner[0] - _moved[0], corner[1] - _moved[1]} : corner;
    }

private:
    static constexpr double kThird = 1.0 / 3;

    // From the centre of the polygon.
    Pair getRegularCorner(int i) const {
        if (_size == 3) {
            return {i == 1 ? 2 * kThird : -kThird, i == 2 ? 2 * kThird : -kThird};
        }
        if (i <= 1) {
            return {i - 0.5, _size == 4 ? -0.5 : -0.5 / std::tan(kPi / _size)};
        }
        if (_size == 4) {
            return {i == 2 ? 0.5 : -0.5, 0.5};
        }
        double const angle = kPi * ((2.0 * i - 1) / _size - 0.5);
        return {_radius * std::cos(angle), _radius * std::sin(angle)};
    }

    int const _size;
    double const _radius;
    bool const _isHalf;
    Pair _center;
    Pair _moved = {0, 0}; // from the centre of the polygon
};

/// What a BasePolygon of a common size says, found once: places are found in it by the million.
class KnownPolygon {
public:
    using Pair = BasePolygon::Pair;

    /// That of \p size vertices; null where this is not common.
    static KnownPolygon const *Find(int size) {
        static KnownPolygon const kAll[] = {KnownPolygon(kMinSize), KnownPolygon(4),
                                            KnownPolygon(5),        KnownPolygon(6),
                                            KnownPolygon(7),        KnownPolygon(kMaxSize)};
        return kMinSize <= size && size <= kMaxSize ? &kAll[size - kMinSize] : nullptr;
    }

    Pair const &GetCenter() const { return _center; }
    Pair const &GetCorner(int i) const { return _corners[i]; }
    std::array<Pair, 2> const &GetSectorMap(int sector) const { return _sectorMaps[sector]; }

private:
    static constexpr int kMinSize = 3;
    static constexpr int kMaxSize = 8;

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

/// Calls function(polygon) with the KnownPolygon of a size, or else with its BasePolygon.
template <typename FUNCTION>
auto UsePolygon(int size, FUNCTION const &function) {
    KnownPolygon const *const known = KnownPolygon::Find(size);
    return known ? function(*known) : function(BasePolygon(size));
}

} // namespace OpenSubdivHex::FarExt::internal

#endif

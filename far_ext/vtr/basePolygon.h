// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_POLYGON_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_POLYGON_H

#include "pi.h"

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

/// \brief A base face in its parameter plane: a regular polygon with sides 1 long, counter-clockwise,
/// edge 0 from (0, 0) to (1, 0).
class BasePolygon {
public:
    explicit BasePolygon(int size)
        : _size(size), _radius(0.5 / std::sin(kPi / size)),
          _centerY(size == 4 ? 0.5 : 0.5 / std::tan(kPi / size)) {}

    int GetSize() const { return _size; }

    template <typename REAL>
    void Write(int sector, SectorPoint point, REAL *uv) const {
        std::array<double, 2> const start = GetCorner(sector);
        std::array<double, 2> const end = GetCorner((sector + 1) % _size);
        uv[0] = REAL(0.5 + (point.a * start[0] + point.b * end[0]));
        uv[1] = REAL(_centerY + (point.a * start[1] + point.b * end[1]));
    }

    std::array<double, 2> GetCenter() const { return {0.5, _centerY}; }

    /// Corner number i, from the centre.
    std::array<double, 2> GetCorner(int i) const {
        if (i <= 1) {
            return {i - 0.5, -_centerY};
        }
        if (_size == 4) {
            return {i == 2 ? 0.5 : -0.5, 0.5};
        }
        double const angle = kPi * ((2.0 * i - 1) / _size - 0.5);
        return {_radius * std::cos(angle), _radius * std::sin(angle)};
    }

private:
    int const _size;
    double const _radius;
    double const _centerY;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

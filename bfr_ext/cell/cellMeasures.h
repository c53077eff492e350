// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MEASURES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MEASURES_H

#include "vector3.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// A ball that encloses some points.
struct Ball {
    Vector3 center = {};
    double radius = 0;
};

/// \brief Measures of a cell that do not depend on the camera, as far as views have asked for them.
struct CellMeasures {
    Ball ball;               ///< around the surface, estimated
    double longestSide = -1; ///< between corners; -1: not measured
    double thickness =
        -1; ///< range of the heights over the plane of the corners, estimated; -1: not measured
    double childThickness =
        0;              ///< what is expected of its children, where these are not measured with it
    int firstChild = 0; ///< in the same face; 0: none were asked for
    int facing = -1;    ///< in the same face; -1: not found
};

/// \brief Where a cell faces, estimated from the polygons of the corners of the cells that one or two steps make of it, and
/// from the normals of the surface at its own corners.
///
/// With m the unit normal of all, others are m + s w, with w of length 1 at most in the plane across from it.  With c the
/// mean of the places and r how far they are from it, (m + s w) . (eye - p) is at most m . (eye - c) - m . (p - c) +
/// s (|part of eye - c in the plane| + r).
struct CellFacing {
    class Maker;

    bool IsBackFacing(Vector3 const &eye) const {
        Vector3 const toEye = Subtract(eye, center);
        double const height = Dot(normal, toEye);
        double const across = GetLength(Subtract(toEye, Scale(normal, height)));
        return height + depth + spread * (across + radius) < 0;
    }

    Vector3 normal = {};
    double spread = std::numeric_limits<double>::infinity(); ///< s; infinite where nothing is known
    Vector3 center = {};
    double radius = 0; ///< r
    double depth = 0;  ///< of places below the center, along the normal
};

/// Makes it of polygons.
class CellFacing::Maker {
public:
    /// \param corners  three numbers each
    void Add(std::vector<double> const &corners) {
        Vector3 const area = FindArea(corners);
        _areas.push_back(area);
        _sum = internal::Add(_sum, area);
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            _places.push_back(ToVector3(&corners[i]));
            _sumOfPlaces = internal::Add(_sumOfPlaces, _places.back());
        }
    }
    /// Adds a normal of the surface, of any length.
    void AddNormal(Vector3 const &ofSurface) { _areas.push_back(ofSurface); }
    CellFacing Make() const {
        // A margin for angles between the polygons, and for angles of normals within each.
        constexpr double kFactor = 3;
        CellFacing facing;
        double const length = GetLength(_sum);
        if (!(length > 0)) {
            return facing;
        }
        facing.normal = Scale(_sum, 1 / length);
        facing.center = Scale(_sumOfPlaces, 1 / double(_places.size()));
        double largest = 0; // tangent of an angle to the normal
        for (Vector3 const &area : _areas) {
            double const height = Dot(facing.normal, area);
            if (!(height > 0)) {
                return facing;
            }
            largest =
                std::max(largest, GetLength(Subtract(area, Scale(facing.normal, height))) / height);
        }
        facing.spread = kFactor * largest;
        for (Vector3 const &place : _places) {
            Vector3 const d = Subtract(place, facing.center);
            facing.radius = std::max(facing.radius, kFactor * GetLength(d));
            facing.depth = std::max(facing.depth, -kFactor * Dot(facing.normal, d));
        }
        return facing;
    }

private:
    std::vector<Vector3> _areas; // and normals
    Vector3 _sum = {};
    std::vector<Vector3> _places;
    Vector3 _sumOfPlaces = {};
};

/// \brief Measures of the cells of a base face that views have asked for: first the face itself; the
/// children of a cell are consecutive.
struct FaceMeasures {
    void Clear() {
        cells.clear();
        facings.clear();
    }
    /// Memory, in bytes.
    std::size_t GetMemory() const {
        return cells.capacity() * sizeof(CellMeasures) + facings.capacity() * sizeof(CellFacing);
    }

    std::vector<CellMeasures> cells;
    std::vector<CellFacing> facings;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_POLYLINE_H
#define OPENSUBDIVHEX_BFR_EXT_POLYLINE_H

#include "far_ext/export.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::BfrExt {

/// \brief The segments of an edge of a base face between refined cells: the positions of its inner points.
///
/// A polyline begins as one segment.  Refinement cuts a segment at a quarter and at three quarters of its length, then
/// those segments again: a polyline is a tree.  Merge() makes the polyline that has the points of two and no others.  Two
/// faces that take the merged polyline of their edge fit, however their own cells are refined.
///
/// Positions describe a polyline completely, and may be sent to another process.
///
/// \code
///     polyline.Merge(neighbours.GetReversed()); // the points of both faces
/// \endcode
///
/// Objects are values: several threads may read one.  std::bad_alloc passes through.
class OPENSUBDIVHEX_API Polyline {
public:
    /// The last level that cells and edges can have.
    static constexpr int kLastLevel = 12;
    /// A place: how far a point is from the start of the edge, which is 0, with its end at kLength.
    using Place = std::uint16_t;
    /// The place of the end.  The long edge of half a polygon is divided once more than others.
    static constexpr int kLength = 2 << kLastLevel;

    /// One segment.
    Polyline() = default;
    /// The polyline of an edge with cells of level 0 ... kLastLevel all along it: 1, 1, 3, 5, 11, 21, 43 ...
    /// segments.
    explicit Polyline(int level);
    /// \brief The polyline with the given positions.
    ///
    /// \param places    ascending, without the ends
    /// \param polyline  is not changed if the places are not those of a polyline
    /// \return          whether they are
    static bool FromPlaces(std::vector<Place> const &places, Polyline *polyline);

    /// Inner points.
    int GetNumPoints() const { return int(_places.size()); }
    /// GetNumPoints() + 1.
    int GetNumSegments() const { return GetNumPoints() + 1; }
    /// The places of all inner points, ascending.
    std::vector<Place> const &GetPlaces() const { return _places; }
    /// Where inner point \p point is on the edge, from 0 at the start to 1 at the end.
    double GetParameter(int point) const {
        return double(_places[std::size_t(point)]) / double(kLength);
    }

    /// The polyline from the end of the edge to its start.
    Polyline GetReversed() const;
    /// Takes the points of another polyline of the same edge and direction, too.
    void Merge(Polyline const &other);
    /// Whether all points of \p other are points of this one.
    bool Contains(Polyline const &other) const;

    /// Whether the points are the same.
    friend bool operator==(Polyline const &a, Polyline const &b) { return a._places == b._places; }
    /// Whether they are not.
    friend bool operator!=(Polyline const &a, Polyline const &b) { return !(a == b); }

private:
    friend class CellTree;

    std::vector<Place> _places;
};

} // namespace OpenSubdivHex::BfrExt

#endif

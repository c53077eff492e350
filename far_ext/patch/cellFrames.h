// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_CELL_FRAMES_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_CELL_FRAMES_H

#include "far_ext/limit/limitRows.h"
#include "far_ext/vtr/indexSet.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The part of the tangent plane at a vertex that a corner of a cell fills: between two
/// directions, in terms of du and dv of the limit there.
struct CornerFrame {
    Far::Index vert;
    int side;     ///< of the vertex, as FindVertexSides numbers them
    double begin; ///< angle of the edge, or diagonal, to the next vertex of the cell
    double end;   ///< of that to the vertex before
    /// Where du and dv make no plane with the sharp edge at the end: the side that begins with this edge, whose du is
    /// along it; else -1.
    int sideOfEnd = -1;
};

/// \brief At which angles the edges and diagonals of a level leave its vertices.
///
/// At a smooth vertex of k faces edges are 2 pi/k apart, and the diagonal of a hexagon lies halfway.
/// On a side of a sharp vertex all faces have the same part of the side, half faces half of it: of pi
/// or, at a corner, of as much as they would fill in the lattice.  The first sharp edge is at 0.
/// Without one, du lies in the direction of some edge or halfway between two, which a layout of
/// the faces around in the plane tells.
class CellFrames {
public:
    using Index = Far::Index;

    /// \param level  with full topology; is referred to
    /// \param rows   of the level, of \p verts at least
    CellFrames(Level const &level, LimitRows const &rows, std::vector<Index> const &verts);

    /// \param half  of a face that is cut, as in FaceCells; of no matter for others
    CornerFrame Get(Index face, int local, int half) const;

    /// Whether a sharp edge or diagonal is at 0, or the vertex has several fans.
    bool HasBeginning(Index vert) const { return _turns[std::size_t(vert)] == kIsSharp; }
    /// Where edge \p i, before face i, of a vertex lies that has none of these.
    double GetEdgeAngle(Index vert, int i) const;

    /// How unsure the least sure of all turns is: 0 for one that is right, 1 for one between two.
    double GetLargestDoubt() const { return _largestDoubt; }

private:
    // A corner at a vertex whose sides have a beginning.
    struct SharpCorner {
        Index corner;
        int half; // -1: both
        int side;
        double begin;
        double end;
        int sideOfEnd;
    };
    static constexpr Index kIsSharp = -1;

    double findTurn(Index vert, LimitRow const &row, IndexMap &places, double &doubt) const;
    void addSides(Index vert, std::vector<SharpCorner> &corners) const;

    Level const &_level;
    // By vertex, half of the angle between two edges being 1; kIsSharp for those with corners below.
    std::vector<int> _turns;
    std::vector<SharpCorner> _sharpCorners; // ascending
    double _largestDoubt = 0;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_GREGORY_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_GREGORY_MASK_H

#include <array>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief How the points of Gregory patches follow from the limit: the one derivation of them.
///
/// A patch has its corners on the limit surface.  At each corner the limit has a point P and the
/// derivatives U and V: t(a) = cos(a) U + sin(a) V is the derivative in the direction a, where an edge
/// of the level is about 1 long.
///
/// - A *curve* is the cubic from one corner to another, which leaves both along t.  Half the sides of
///   a patch are curves that it shares with another patch; the points on them are shared.
/// - *Across* a curve both patches have the same derivative D, a quadratic: at the ends it is t at
///   right angles to the curve, and in the middle that of the limit, M.
/// - The *inner points* of a patch beside the curve c are those with which its derivative inwards is
///   a D + b c', where a and b are linear and, at the ends, what the corners ask for.  So tangent
///   planes agree across all curves, whatever the lengths.
///
/// All is linear in P, U, V and M, with factors that depend on topology alone: a *mask*.
///
/// Rows of weights, three for each row of the limit: of its point, its du and its dv.  Rows 0 and 1 are
/// those of the corners of a curve, row 2 has M as its du, and row 3 the centre of a face.
struct GregoryMask {
    static constexpr int kNumRows = 4;
    static constexpr int kNumTerms = 3 * kNumRows;
    using Point = std::array<double, kNumTerms>;

    std::vector<Point> points;
};

/// One end of a curve, seen from a patch that lies to the left of it.
struct CurveEnd {
    double angle;    ///< of the curve as it leaves the corner
    double length;   ///< of its derivative there, in terms of t
    double unit = 1; ///< of the derivative across, in terms of t
};

/// A curve.
struct CurveShape {
    CurveEnd ends[2];
    double blend;    ///< as PatchQuantity::Blend
    double unit = 1; ///< of the derivative across in the middle, in terms of M
};

/// \brief The other side of a patch, which meets a curve at one of the curve's ends.
struct CurveNeighbor {
    double angle;  ///< of the corner, between both
    double length; ///< as of a CurveEnd
};

/// The points of a curve beside its ends: 2.
void AddCurvePoints(CurveShape const &shape, GregoryMask &mask);

/// \brief The inner points of the patch to the left of a curve: 2, the first beside end 0.
///
/// \param signOfM    -1 where M is the derivative to the right
/// \param isReverse  whether the patch has end 1 first: shape and neighbours are in its order, rows 0 and
///                   1 are those of the curve
void AddInnerPoints(CurveShape const &shape, CurveNeighbor const neighbors[2], double signOfM,
                    bool isReverse, GregoryMask &mask);

/// The lines from the middles of sides to the centre, in cells with kites.
struct SpokeShape {
    double lengths
        [2]; ///< of the derivatives at both ends, in terms of the lines of a regular polygon, or half of one
    double blend; ///< how much more than the mean of its ends the derivative across has
};

/// \brief How a side of a cell with kites lies in its plane, where sides are 1 long, but for the first one of half a polygon;
/// and the line from its middle to the centre.
struct KiteSide {
    double length;     ///< of the side
    double unit;       ///< of the derivatives that the row of the centre has
    double spoke;      ///< length of the line
    double along;      ///< direction of the line at the middle: in that of the side,
    double across;     ///< and to the left of it
    double direction;  ///< angle of the line as it leaves the centre, from U there
    double angles[2];  ///< at the centre, between it and the lines of the sides before and behind
    double besides[2]; ///< length of these
};

/// Side number \p side of a regular polygon, in whose centre corner 0 lies in the direction of U.
KiteSide MakeKiteSide(int numSides, int side);
/// \brief Side number \p side of half a regular polygon, which has \p numCorners and the first side across.
///
/// Its centre lies at a third of the line from the middle of the first side to the corner across, or the middle of the
/// side across; U is the direction of the first side, V that of the line.
KiteSide MakeHalfKiteSide(int numCorners, int side);

/// \brief The row of the centre of half a polygon as sums of other rows: its point, U and V.
///
/// First the three rows of the curve that the first side is, then those of what is across: of the vertex, or the three of
/// the curve.
struct HalfCenter {
    GregoryMask::Point sums[2][3];
};
/// \param angle  of the line to the centre as it leaves the vertex
HalfCenter MakeHalfCenter(int numCorners, CurveShape const &longSide, double signOfM, double angle);
/// \param across  the curve across
HalfCenter MakeHalfCenter(int numCorners, CurveShape const &longSide, double signOfM,
                          CurveShape const &across, double signOfMAcross);
/// The weights of the corners of half a polygon for its derivative to the left of the middle of the first side.
std::vector<double> FindWeightsAcross(int numCorners);

/// The first points of a side of a face with kites: those in its halves, and its middle.
inline constexpr int kNumHalfPoints = 5;

/// \brief The points that a cell which is made of a patch for each of its corners has beside one of its sides and on
/// the line from its middle to the centre.
///
/// Such a patch, a *kite*, has a corner of the cell, the middle of the next side, the centre and the
/// middle of the side before.  In this order: the two points in the first half of the side, its
/// middle, the two points in its second half; two inner points in each of the kites beside these
/// halves; on the line from the middle to the centre two points, two inner points of the kite of the
/// first half, and two of that of the second half, all from the middle on.
///
/// \param shape      of the side, counter-clockwise
/// \param neighbors  the sides before and behind
/// \param spoke      the lines from middles to the centre
/// \param signOfM    -1 where M is the derivative away from the cell
void AddKitePoints(CurveShape const &shape, CurveNeighbor const neighbors[2],
                   SpokeShape const &spoke, KiteSide const &side, double signOfM,
                   GregoryMask &mask);

} // namespace OpenSubdivHex::FarExt::internal

#endif

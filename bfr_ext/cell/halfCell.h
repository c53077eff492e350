// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_HALF_CELL_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_HALF_CELL_H

#include "sectors.h"

#include "far_ext/vtr/basePolygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// Two coordinates in a cell, or derivatives of these.
using Pair = std::array<double, 2>;

/// Writes the product of two matrices, which may be one of them.
inline void Multiply(Pair const (&a)[2], Pair const (&b)[2], Pair (&result)[2]) {
    Pair const rows[2] = {
        {a[0][0] * b[0][0] + a[0][1] * b[1][0], a[0][0] * b[0][1] + a[0][1] * b[1][1]},
        {a[1][0] * b[0][0] + a[1][1] * b[1][0], a[1][0] * b[0][1] + a[1][1] * b[1][1]}};
    std::copy_n(rows, 2, result);
}

/// \brief Turns derivatives by two coordinates into those by two others, number by number; in place, or not.
///
/// \param toCoords  by coordinate, the derivatives of it by the two others
template <typename FROM, typename REAL>
void TurnDerivatives(Pair const (&toCoords)[2], std::size_t size, FROM const *byFirst,
                     FROM const *bySecond, REAL *du, REAL *dv) {
    FROM const u[2] = {FROM(toCoords[0][0]), FROM(toCoords[1][0])};
    FROM const v[2] = {FROM(toCoords[0][1]), FROM(toCoords[1][1])};
    for (std::size_t k = 0; k < size; ++k) {
        FROM const first = byFirst[k];
        FROM const second = bySecond[k];
        du[k] = REAL(u[0] * first + u[1] * second);
        dv[k] = REAL(v[0] * first + v[1] * second);
    }
}

/// \brief As TurnDerivatives(), of second derivatives: by the first twice, by both, and by the second twice.
template <typename REAL>
void TurnSecondDerivatives(Pair const (&toCoords)[2], std::size_t size, REAL *const by[3]) {
    auto const &[first, second] = toCoords;
    constexpr std::size_t kPairs[3][2] = {{0, 0}, {0, 1}, {1, 1}};
    for (std::size_t k = 0; k < size; ++k) {
        double const twice[3] = {double(by[0][k]), double(by[1][k]), double(by[2][k])};
        for (std::size_t row = 0; row < 3; ++row) {
            auto const [i, j] = kPairs[row];
            by[row][k] = REAL(first[i] * first[j] * twice[0] +
                              (first[i] * second[j] + second[i] * first[j]) * twice[1] +
                              second[i] * second[j] * twice[2]);
        }
    }
}

/// \brief Map of coordinates in one cell to those in another: linear, and a shift.
struct CellMap {
    Pair Apply(Pair const &p) const {
        return {shift[0] + (rows[0][0] * p[0] + rows[0][1] * p[1]),
                shift[1] + (rows[1][0] * p[0] + rows[1][1] * p[1])};
    }

    /// Turns derivatives by the coordinates of the other cell into those by the coordinates of the one.
    void TurnDerivatives(std::vector<double> (&by)[2]) const {
        internal::TurnDerivatives(rows, by[0].size(), by[0].data(), by[1].data(), by[0].data(),
                                  by[1].data());
    }

    Pair rows[2];
    Pair shift;
};

/// The coordinates in a sector of the F-face of a whole cell, from those in the sector of the cell.
inline constexpr CellMap kToFFace = {{{2, 0}, {0, 2}}, {0, 0}};

/// first, then second.
inline CellMap Concatenate(CellMap const &first, CellMap const &second) {
    CellMap result;
    Multiply(second.rows, first.rows, result.rows);
    result.shift = second.Apply(first.shift);
    return result;
}

/// \brief The coordinates of half cells, which all are affine images of one trapezoid.
///
/// Its corners are those of a CellPatch: the long edge from (0, 0) to (1, 0), the short one from
/// (3/4, 1/2) to (1/4, 1/2).  A point of it is in the child that FindChild says: 0 is the same half of
/// the F-face, half as large and around the middle of the long edge, and 1 to 3 the half cells that
/// the edges behind corners 1 to 3 make.
class HalfCell {
public:
    static constexpr Pair kCorners[4] = {{0, 0}, {1, 0}, {0.75, 0.5}, {0.25, 0.5}};

    /// The coordinates in the children.
    static constexpr CellMap kChildren[4] = {{{{2, 0}, {0, 2}}, {-0.5, 0}},
                                             {{{-1, 1.5}, {-2, -1}}, {1, 2}},
                                             {{{-2, 0}, {0, -2}}, {1.5, 1}},
                                             {{{-1, -1.5}, {2, -1}}, {1, 0}}};

    static int FindChild(Pair const &point) {
        double const x = 2 * point[0] - 1;
        double const h = point[1];
        // Without branches: places come in any order.
        int const edge = 2 - int(x > h) + int(-x > h);
        return edge * int(h + std::max(h, std::abs(x)) > 0.5);
    }

    /// The child that has a corner, and which corner of that it is.
    static constexpr int kCornerChildren[4] = {3, 1, 2, 3};
    static constexpr int kCornersOfChildren[4] = {1, 0, 0, 0};

    /// How much the corners weigh in the bilinear interpolation between them.
    static std::array<double, 4> GetCornerWeights(Pair const &point) {
        double const t = 2 * point[1];
        double const s = (point[0] - 0.5 * point[1]) / (1 - point[1]);
        return {(1 - t) * (1 - s), (1 - t) * s, t * s, t * (1 - s)};
    }

    /// The coordinates in the half cell of an edge of a whole cell, from those in the sector of the
    /// edge.
    static constexpr CellMap kFromSector = {{{-0.5, 0.5}, {-1, -1}}, {0.5, 1}};
};

/// \brief Where a cell lies in its base face: the corners of a half cell in a sector, or how far those of a whole cell are
/// from the centre.
template <typename PLACE>
struct CellOutline {
    using Number = typename PLACE::value_type;

    /// A half cell.
    static CellOutline MakeHalf(int sectorOfCell, std::array<PLACE, 4> const &cornersOfCell) {
        return {false, sectorOfCell, 0, cornersOfCell};
    }
    /// A whole cell.
    static CellOutline MakeWhole(Number scaleOfCell) { return {true, 0, scaleOfCell, {}}; }
    /// A cell in its own coordinates: a whole one, or of size 0 a half cell.
    static CellOutline MakeRoot(FaceShape shape) {
        constexpr auto &kCorners = HalfCell::kCorners;
        return shape.size > 0 ? MakeWhole(1)
                              : MakeHalf(0, {kCorners[0], kCorners[1], kCorners[2], kCorners[3]});
    }

    /// How many children it has.
    int GetNumChildren(FaceShape face) const { return isWhole ? face.GetNumSectors() + 1 : 4; }
    /// A child, in the order of RefineCell().
    CellOutline GetChild(FaceShape face, int child) const {
        Number const half = scale / 2;
        if (isWhole) {
            return child == 0 ? MakeWhole(half)
                              : MakeHalf(child - 1 + face.GetFirstSector(),
                                         {{{scale, 0}, {0, scale}, {0, half}, {half, 0}}});
        }
        auto const getMiddle = [](PLACE const &p, PLACE const &q) {
            return PLACE{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
        };
        PLACE const middle = getMiddle(corners[0], corners[1]);
        auto const getInner = [&](std::size_t i) { return getMiddle(corners[i], middle); };
        if (child == 0) {
            return MakeHalf(sector, {{getInner(0), getInner(1), getInner(2), getInner(3)}});
        }
        auto const start = std::size_t(child);
        std::size_t const end = (start + 1) % 4;
        return MakeHalf(sector, {{corners[start], corners[end], getInner(end), getInner(start)}});
    }
    int GetNumCorners(FaceShape face) const { return isWhole ? face.size : 4; }
    SectorPlace<PLACE> GetCorner(FaceShape face, int corner) const {
        return isWhole ? PlaceOnEdge<PLACE>(face, corner, scale, Number(0))
                       : SectorPlace<PLACE>{sector, corners[std::size_t(corner)]};
    }

    bool isWhole;
    int sector;                   ///< of a half cell
    Number scale;                 ///< of a whole one
    std::array<PLACE, 4> corners; ///< of a half cell
};

/// The child of a cell that has one of its corners, in the order of RefineCell().
struct CornerChild {
    std::size_t child;
    int corner; ///< which of the child's it is
    CellMap const
        *map; ///< from the cell's coordinates, of a whole cell those of GetSectorOfCorner()
};
/// \param shape  of a whole cell; of size 0: of half cells
inline CornerChild FindCornerChild(FaceShape shape, int corner) {
    if (shape.size == 0) {
        int const child = HalfCell::kCornerChildren[corner];
        return {std::size_t(child), HalfCell::kCornersOfChildren[corner],
                &HalfCell::kChildren[child]};
    }
    int const sector = shape.GetSectorOfCorner(corner);
    return {std::size_t(sector + 1 - shape.GetFirstSector()), sector == corner ? 0 : 1,
            &HalfCell::kFromSector};
}

} // namespace OpenSubdivHex::BfrExt::internal

#endif

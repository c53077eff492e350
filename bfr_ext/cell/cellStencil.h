// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_STENCIL_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_STENCIL_H

#include "basePoint.h"
#include "cellType.h"
#include "halfCell.h"
#include "secondDerivatives.h"

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Which child of a cell has a point, and how coordinates become those in the child.
struct CellStep {
    /// Coordinates in the child, which are inside.
    Pair Apply(Pair const &coords) const;

    std::size_t child; ///< in the order of RefineCell()
    CellMap const *map;
    bool isChildWhole;
};
/// \param shape           of a whole cell; of size 0: of half cells
/// \param sector, coords  of the point in the cell; the sector of a whole cell alone matters
CellStep FindCellStep(FaceShape shape, int sector, Pair const &coords);

/// \brief Which corner of a cell a point is, or -1.
///
/// \param shape  of a whole cell; of size 0: of half cells
int FindCellCorner(FaceShape shape, int sector, Pair const &coords);

/// \brief The stencils of points of a base face and of their derivatives by u and v, which are the coordinates of its
/// plane here.
///
/// The cells that have a point are followed until it is a corner of one, or they are so small that
/// the surface between their corners is bilinear as far as anyone sees.
///
/// Second derivatives are those of SecondDerivatives where such cells have the point, and between their
/// corners.  Elsewhere they are those of the first derivatives from corner to corner of a cell.
class CellStencil {
public:
    /// Stencils of a type of base faces.
    explicit CellStencil(CellType const &root, StencilOf of = StencilOf::Points)
        : _root(root), _of(of) {}

    void Find(BasePoint const &point, bool hasDerivatives);
    /// Finds those of the second derivatives, as sums of points; behind Find() of the same point.
    void FindSecond(BasePoint const &point);

    /// Weights by what they are sums of, as far as they were found: 0 of the surface's point; 1 and 2 of its derivatives by
    /// u, by v; from 3 on by u twice, by u and v, by v twice.
    std::vector<double> const &GetWeights(std::size_t kind) const { return _weights[kind]; }

private:
    // Where a point is in the cells that have it, from the root on.
    struct Place {
        // Which corner of the cell it is, or -1.
        int FindCorner() const;
        // Finds how much the corners weigh between which it is.
        void FindCornerWeights(std::vector<double> &weights) const;
        // The corners in the plane of the face, from the mean of all.
        std::vector<Pair> FindCornersInPlane() const;
        // Adds the derivatives by u and v at a corner, from those by its coordinates.
        void AddDerivatives(std::size_t corner, double weight,
                            std::vector<double> const (&derivatives)[2],
                            std::vector<double> *byUv) const;

        CellType const *type;
        int depth;
        int sector; // of a whole cell
        Pair coords;
        Pair toCoords[2];
    };

    Place begin(BasePoint const &point);
    void takeStep(Place &place);
    bool isLast(Place const &place) const;
    void addCorner(Place const &place, std::size_t corner, double weight, bool hasDerivatives);
    void addSecondAtCorners(Place const &place);
    void addSecondBetweenCorners(Place const &place);
    void finish(std::size_t firstKind, std::size_t endKind);

    CellType const &_root;
    StencilOf const _of;
    std::vector<ChildStep const *> _steps;
    std::vector<double> _weights[6];
    std::vector<double> _cornerWeights;
    std::vector<double> _scratch;
};

/// \brief The stencil of a point of an edge or a vertex of base faces.
///
/// \param point  of an edge, from its start, 0, to its end, 1; of no matter for a vertex
std::vector<double> FindBorderStencil(CellType const &root, double point, StencilOf of);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

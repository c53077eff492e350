// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_TREE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_TREE_H

#include "polyline.h"

#include "far_ext/export.h"
#include "far_ext/indexing.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt {

namespace internal {
class FaceSections;
}

/// \brief Says which parts of a base face are refined: a tree of cells.
///
/// \code
///     BfrExt::CellTree tree(4);                  // of a quad
///     int const firstChild = tree.Refine(0);     // its F-face; then a half cell at each edge
///     tree.Refine(firstChild + 1);               // the half cell at edge 0
/// \endcode
///
/// The *cell* of level 0 is the base face.  Refining a whole cell makes its F-face, which is a whole cell, and half a
/// hexagon at each edge.  Refining such a *half cell*, which has a long edge and three others, makes the same half of the
/// hexagon's F-face, and half cells at the three edges.  The cells that are not refined cover the base face without gaps
/// and overlaps: any tree is a tessellation (LevelTessellation), and needs no balance.
///
/// Corners of half cells are counter-clockwise from the start of the long edge, which is side 0.
///
/// A face that is half a polygon (FaceShape) has no half cell at its long edge, edge 0.  Cells of level 1 divide that edge, as
/// those of level 2 divide others.
///
/// Cells have numbers: 0 is the face, and others are numbered as they are made, children of one cell
/// one behind the other.
///
/// Other arguments than those of Refine() are not checked.  Several threads may read one tree; std::bad_alloc passes through.
class OPENSUBDIVHEX_API CellTree {
public:
    /// The last level that cells can have.
    static constexpr int kLastLevel = Polyline::kLastLevel;

    /// A face of 3 vertices at least that is not refined.
    explicit CellTree(FarExt::FaceShape shape);
    /// Cells of one level, 0 ... kLastLevel, everywhere, as far as there are numbers: to 2^31 - 1.
    CellTree(FarExt::FaceShape shape, int level);
    /// \brief Cells of one level, but for those whose refinement would give an edge of the face more
    /// points than it has with cells of another level.
    ///
    /// \param shape       that of the face
    /// \param edgeLevels  by edge, edge i being from vertex i to the next
    /// \param level       of the inside
    CellTree(FarExt::FaceShape shape, int const edgeLevels[], int level);

    /// The shape of the face.
    FarExt::FaceShape GetFaceShape() const { return _shape; }
    /// Vertices of the face.
    int GetFaceSize() const { return _shape.size; }
    /// All cells, with those that are refined.
    int GetNumCells() const { return _cells.empty() ? 1 : int(_cells.size()); }
    /// Cells that are not refined.
    int GetNumLeaves() const { return _numLeaves; }
    /// The highest level that a cell has.
    int GetMaxLevel() const;

    /// Whether a cell is the face, or its F-face at a later level, and not half a hexagon.
    bool IsWhole(int cell) const { return getCell(cell).sector < 0; }
    /// The level of a cell.
    int GetLevel(int cell) const { return getCell(cell).level; }
    /// The edge of the face that a half cell lies at, in the triangle with the centre; -1 of a whole
    /// cell.
    int GetEdge(int cell) const { return getCell(cell).sector; }
    /// The side of a half cell that lies on that edge: 0, 1 or 3, or -1 if none does.
    int GetBorderSide(int cell) const { return getCell(cell).borderSides[0]; }
    /// \brief The side of a cell that lies on the long edge of half a polygon: 0, 1 or 3, or -1 if none does.
    ///
    /// The face and its F-faces have side 0 there.
    int GetLongEdgeSide(int cell) const { return getCell(cell).borderSides[1]; }

    /// Whether a cell has children.
    bool IsRefined(int cell) const { return getCell(cell).firstChild > 0; }
    /// How many children a cell has, or would have: 4 of half cells, 1 more than the face has sectors of whole ones.
    int GetNumChildren(int cell) const { return IsWhole(cell) ? _shape.GetNumSectors() + 1 : 4; }
    /// The first of them, 0 if it has none.  It is the F-face, or half of it; then come those at the
    /// edges, from edge 0 of whole cells and side 1 of half cells on.
    int GetFirstChild(int cell) const { return getCell(cell).firstChild; }
    /// \brief Refines a cell.
    /// \return  its first child, also if it is refined already; 0, with nothing changed, if it is of the
    ///          last level, if there is no such cell, and if the tree would have more than 2^31 - 1
    int Refine(int cell);

    /// \brief The polyline that the cells make of an edge of the face, in the direction of the face.
    ///
    /// A neighbour has the edge in the other direction: Polyline::GetReversed().
    Polyline GetEdgePolyline(int edge) const;

private:
    struct Cell {
        int firstChild;
        int sector;
        short level;
        signed char
            borderSides[2]; // on the edge of the sector, and on the long edge of half a polygon
    };
    friend class internal::FaceSections;

    Cell getFace() const {
        return {0, -1, 0, {-1, static_cast<signed char>(_shape.isHalf ? 0 : -1)}};
    }
    Cell getCell(int cell) const { return _cells.empty() ? getFace() : _cells[std::size_t(cell)]; }
    bool isToRefine(int cell, int const edgeLevels[], int level) const;
    void addPoints(int cell, std::size_t edge, int start, int end,
                   std::vector<Polyline::Place> &places) const;

    FarExt::FaceShape _shape;
    int _numLeaves = 1;
    std::vector<Cell> _cells; // none of a face that is not refined, as most of a forest
};

} // namespace OpenSubdivHex::BfrExt

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_REFINED_CELLS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_REFINED_CELLS_H

#include "cellValues.h"

#include <deque>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The cells of a base face with the values of their points, each made when it is first asked for,
/// with its siblings.
///
/// Whoever looks at a cell asks for those in it some steps on; and when the cell is refined, these are there.  Cells
/// have numbers in the order in which they were made, and the last ones can be dropped: their memory is
/// kept for the next.
class RefinedCells {
public:
    /// The base face.
    static constexpr std::size_t kBase = 0;
    /// Drops all cells, and makes that of a base face, as CellValues::SetBase().
    void SetBase(BaseType const &type, double const *controlPoints, int length) {
        _size = 0;
        add(1);
        _cells[kBase].values.SetBase(type, controlPoints, length);
        _firstCommonLevel = type.IsInLattice() ? 0 : kFirstCommonLevel;
    }

    CellValues const &operator[](std::size_t cell) const { return _cells[cell].values; }
    int GetNumChildren(std::size_t cell) const { return _cells[cell].values.GetNumChildren(); }
    /// Whether its children are made.
    bool HasChildren(std::size_t cell) const { return _cells[cell].firstChild > 0; }
    /// The first child; others follow it.
    std::size_t GetFirstChild(std::size_t cell) {
        return _cells[cell].firstChild > 0 ? _cells[cell].firstChild : makeChildren(cell);
    }
    /// \brief Writes derivatives at a corner, which span the tangent plane as those by u and v do.
    ///
    /// Cells of rare types take them from their children, so that few limit masks are needed.
    void EvaluateCorner(std::size_t cell, int corner, double *du, double *dv) {
        findCorner(cell, corner).EvaluateCorner(corner, du, dv);
    }

    /// How many cells there are.
    std::size_t GetSize() const { return _size; }
    /// Drops all cells but so many.  Those that are left are not asked for children that are dropped.
    void Drop(std::size_t size) { _size = size; }

    /// The first level whose cells are of few types, that of a lattice apart: irregular meshes have about as many
    /// types of base faces and of their children as there are of these.
    static constexpr int kFirstCommonLevel = 2;

private:
    // The values of the cell that the corner is evaluated from, and its number there.
    CellValues const &findCorner(std::size_t cell, int &corner);

    struct Cell {
        CellValues values;
        std::size_t firstChild = 0; // 0: not made
    };

    std::size_t add(std::size_t number);
    std::size_t makeChildren(std::size_t cell);
    bool hasCommonType(std::size_t cell) const {
        return _cells[cell].values.GetLevel() >= _firstCommonLevel;
    }

    std::deque<Cell> _cells;
    std::size_t _size = 0;
    int _firstCommonLevel = 0;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

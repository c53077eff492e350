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
    template <typename TYPE>
    void SetBase(TYPE const &type, double const *controlPoints, int length) {
        _size = 0;
        add(1);
        _cells[kBase].values.SetBase(type, controlPoints, length);
    }

    CellValues const &operator[](std::size_t cell) const { return _cells[cell].values; }
    int GetNumChildren(std::size_t cell) const { return _cells[cell].values.GetNumChildren(); }
    /// Whether its children are made.
    bool HasChildren(std::size_t cell) const { return _cells[cell].firstChild > 0; }
    /// The first child; others follow it.
    std::size_t GetFirstChild(std::size_t cell) {
        return _cells[cell].firstChild > 0 ? _cells[cell].firstChild : makeChildren(cell);
    }
    /// How many cells there are.
    std::size_t GetSize() const { return _size; }
    /// Drops all cells but so many.  Those that are left are not asked for children that are dropped.
    void Drop(std::size_t size) { _size = size; }

private:
    struct Cell {
        CellValues values;
        std::size_t firstChild = 0; // 0: not made
    };

    std::size_t add(std::size_t number);
    std::size_t makeChildren(std::size_t cell);

    std::deque<Cell> _cells;
    std::size_t _size = 0;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

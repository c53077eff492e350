// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_VALUES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_VALUES_H

#include "cellStencil.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A cell of a base face with the values of its patch, which are refined from cell to cell.
///
/// CellStencil and CellPattern have what a place is in terms of the control points, once for all faces
/// of a type.  Trees hardly have places in common, and their cells are met in the order of refinement:
/// there it is less work to refine values.
class CellValues {
public:
    /// That of a base face, whose control points are \p length numbers each, without gaps.
    void SetBase(CellType const &root, double const *controlPoints, int length);
    /// \brief A child, in the order of RefineCell().
    ///
    /// \param parent  another object
    void SetChild(CellValues const &parent, int child);

    CellType const &GetType() const { return *_type; }
    int GetLevel() const { return _level; }
    /// Of the patch's vertices, one behind the other.
    std::vector<double> const &GetValues() const { return _values; }

    /// Writes the surface at a corner.
    void EvaluateCorner(int corner, double *p) const;
    /// Writes the derivatives by u and v there.
    void EvaluateCorner(int corner, double *du, double *dv) const;

private:
    void sum(std::vector<double> const &weights, double *result) const;

    CellType const *_type = nullptr;
    int _level = 0;
    int _length = 0;
    Pair _toCoords[2] = {}; // of u and v in a half cell: the derivatives of its coordinates by them
    std::vector<double> _values;
    mutable std::vector<double> _scratch;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

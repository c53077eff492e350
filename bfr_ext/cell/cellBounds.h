// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_BOUNDS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_BOUNDS_H

#include "cellType.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief How much each point weighs at most, anywhere in a cell of a type.
///
/// A place of a cell is a sum of the points, with weights that are not negative and add up to 1.  A step
/// makes points of a child of them with such weights, too, and so do some steps: a place in the cell is a
/// sum of the points of the cell two steps on that has it.  So no weight of a place is larger than the
/// largest that these points have.  Where a cell has very many points, one step has to do.
class CellBounds {
public:
    explicit CellBounds(CellType const &type);

    /// Those of a type, which are found once.
    static CellBounds const &Find(CellType const &type);

    /// These, by point.
    std::vector<double> const &GetWeights() const { return _weights; }
    /// \brief A bound of the largest sum of some numbers of the points, with such weights, that a place of
    /// the cell may have; or \p atLeast if that is larger.
    double GetMax(std::vector<double> const &numbers, double atLeast) const {
        return atLeast + getExcess(numbers, atLeast, 1);
    }
    /// The least, or \p atMost if that is less.
    double GetMin(std::vector<double> const &numbers, double atMost) const {
        return atMost - getExcess(numbers, atMost, -1);
    }

private:
    void boundByStep(StepMatrix const &step);
    double getExcess(std::vector<double> const &numbers, double limit, double sign) const;

    std::vector<double> _weights; // by point
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

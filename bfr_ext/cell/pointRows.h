// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_POINT_ROWS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_POINT_ROWS_H

#include "cellType.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Points of a cell in terms of those of another that it lies in, the *ancestor*: a dense row of
/// weights for each.
class PointRows {
public:
    /// The rows of the ancestor itself.
    explicit PointRows(CellType const &type)
        : PointRows(std::size_t(type.GetNumPoints()), std::size_t(type.GetNumPoints())) {
        for (std::size_t i = 0; i < _numRows; ++i) {
            _weights[i * _paddedSize + i] = 1;
        }
    }
    /// The points that a step makes of a cell of some type, for all children together.
    PointRows(CellType const &type, PointRows const &parent)
        : PointRows(type.GetStep().GetNumRows(), parent._size) {
        type.GetStep().Apply(parent._weights.data(), _paddedSize, _weights.data());
    }
    /// The rows of one child.
    PointRows(CellType::Child const &child, PointRows const &ofStep)
        : PointRows(child.step.GetNumRows(), ofStep._size) {
        child.step.CopyPoints(ofStep._weights.data(), _paddedSize, _weights.data());
    }

    std::size_t GetNumRows() const { return _numRows; }
    /// How many points the ancestor has.
    std::size_t GetSize() const { return _size; }
    double const *GetRow(std::size_t row) const { return &_weights[row * _paddedSize]; }

    /// The sums of the rows with some factors: what a sum of the cell's points is of the ancestor's.
    std::vector<double> Sum(std::vector<double> const &factors) const {
        std::vector<double> result(_size);
        for (std::size_t i = 0; i < _numRows; ++i) {
            double const *const row = GetRow(i);
            for (std::size_t k = 0; k < _size; ++k) {
                result[k] += factors[i] * row[k];
            }
        }
        return result;
    }

private:
    PointRows(std::size_t numRows, std::size_t size)
        : _numRows(numRows), _size(size), _paddedSize(StepMatrix::GetPaddedSize(size)),
          _weights(numRows * _paddedSize) {}

    std::size_t _numRows;
    std::size_t _size;
    std::size_t _paddedSize;
    std::vector<double> _weights;
};

/// Calls function(type, rows) for all cells some steps on from one with some rows.
template <typename FUNCTION>
void ForDescendants(CellType const &type, PointRows const &rows, int numSteps,
                    FUNCTION const &function) {
    if (numSteps == 0) {
        function(type, rows);
        return;
    }
    PointRows const ofStep(type, rows);
    for (CellType::Child const &child : type.GetChildren()) {
        ForDescendants(*child.type, PointRows(child, ofStep), numSteps - 1, function);
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

#endif

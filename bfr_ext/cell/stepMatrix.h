// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_STEP_MATRIX_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_STEP_MATRIX_H

#include "far_ext/limit/limitPatch.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The points that a step makes of those of a cell, a row for each, in little memory, since there
/// are many types of cells.
///
/// Few weights differ from each other, and most patches are small: entries are mostly two bytes.
class StepMatrix {
public:
    /// Of no points.
    StepMatrix() = default;
    explicit StepMatrix(FarExt::internal::PatchRefinement const &step);

    std::size_t GetNumRows() const { return _firsts.size() - 1; }

    /// Calls function(point of the parent, weight) for the entries of a row, in their order.
    template <typename FUNCTION>
    void ForEachEntry(std::size_t row, FUNCTION const &function) const {
        if (!_bytes.empty()) {
            forEachEntry(_bytes, row, function);
        } else if (!_shorts.empty()) {
            forEachEntry(_shorts, row, function);
        } else {
            forEachEntry(_longs, row, function);
        }
    }

    /// \brief Numbers of a point that Apply() computes with at once: points have a multiple of it, the
    /// last ones being of no matter.
    static constexpr std::size_t kPadding = 4;
    static std::size_t GetPaddedSize(std::size_t size) {
        return (size + kPadding - 1) / kPadding * kPadding;
    }
    /// Writes the points that the step makes, \p paddedSize numbers each as those of the parent.
    template <typename REAL>
    void Apply(REAL const *points, std::size_t paddedSize, REAL *result) const {
        if (!_bytes.empty()) {
            apply(_bytes, points, paddedSize, result);
        } else if (!_shorts.empty()) {
            apply(_shorts, points, paddedSize, result);
        } else {
            apply(_longs, points, paddedSize, result);
        }
    }

    std::size_t GetNumParentPoints() const { return _numParentPoints; }

private:
    template <typename NUMBER>
    struct Entry {
        NUMBER point;
        NUMBER weight; // in _weights
    };
    template <typename NUMBER>
    using Entries = std::vector<Entry<NUMBER>>;

    template <typename NUMBER, typename FUNCTION>
    void forEachEntry(Entries<NUMBER> const &entries, std::size_t row,
                      FUNCTION const &function) const {
        Entry<NUMBER> const *const end = entries.data() + _firsts[row + 1];
        for (Entry<NUMBER> const *entry = entries.data() + _firsts[row]; entry != end; ++entry) {
            function(std::size_t(entry->point), _weights[entry->weight]);
        }
    }

    template <typename NUMBER, typename REAL>
    void apply(Entries<NUMBER> const &entries, REAL const *points, std::size_t paddedSize,
               REAL *result) const {
        REAL const *const weights = getWeights(REAL());
        std::size_t const numRows = GetNumRows();
        for (std::size_t row = 0; row < numRows; ++row) {
            Entry<NUMBER> const *const begin = entries.data() + _firsts[row];
            Entry<NUMBER> const *const end = entries.data() + _firsts[row + 1];
            for (std::size_t first = 0; first < paddedSize; first += kPadding, result += kPadding) {
                REAL sums[kPadding] = {};
                for (Entry<NUMBER> const *entry = begin; entry != end; ++entry) {
                    REAL const *const point = points + entry->point * paddedSize + first;
                    REAL const weight = weights[entry->weight];
                    for (std::size_t i = 0; i < kPadding; ++i) {
                        sums[i] += weight * point[i];
                    }
                }
                std::copy(sums, sums + kPadding, result);
            }
        }
    }

    double const *getWeights(double /*precision*/) const { return _weights.data(); }
    float const *getWeights(float /*precision*/) const { return _floatWeights.data(); }

    std::size_t _numParentPoints = 0;
    std::vector<std::uint32_t> _firsts = {0}; // by row, then the end
    std::vector<double> _weights;             // those that differ
    std::vector<float> _floatWeights;         // the same
    // One of these, as large as numbers are.
    Entries<std::uint8_t> _bytes;
    Entries<std::uint16_t> _shorts;
    Entries<std::uint32_t> _longs;
};

/// \brief The points of one of the cells that a step makes, in terms of the parent's: the children of a
/// cell share points, so that their rows are among those of one matrix.
class ChildStep {
public:
    /// \param matrix  of the step, which must live as long
    /// \param rows    by point of the child
    ChildStep(StepMatrix const &matrix, std::vector<int> rows)
        : _matrix(&matrix), _rows(std::move(rows)) {}

    std::size_t GetNumRows() const { return _rows.size(); }
    /// Which rows of the matrix are those of the child's points.
    int const *GetMatrixRows() const { return _rows.data(); }

    /// As StepMatrix::ForEachEntry(), of a point of the child.
    template <typename FUNCTION>
    void ForEachEntry(std::size_t row, FUNCTION const &function) const {
        _matrix->ForEachEntry(std::size_t(_rows[row]), function);
    }

    /// result = left A: what the points of the child weigh, in terms of the parent's.
    void ApplyLeft(std::vector<double> const &left, std::vector<double> &result) const;

private:
    StepMatrix const *_matrix;
    std::vector<int> _rows;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

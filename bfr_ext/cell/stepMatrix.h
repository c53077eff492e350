// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_STEP_MATRIX_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_STEP_MATRIX_H

#include "far_ext/limit/limitPatch.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The points of a child in terms of its parent's, a row for each, in little memory, since there
/// are many types of cells.
///
/// Few weights differ from each other, and most patches are small: entries are mostly two bytes.
class StepMatrix {
public:
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
    /// Writes the points of the child from those of the parent, \p paddedSize numbers each.
    template <typename REAL>
    void Apply(REAL const *points, std::size_t paddedSize, REAL *result) const {
        std::size_t const numRows = GetNumRows();
        for (std::size_t row = 0; row < numRows; ++row) {
            for (std::size_t first = 0; first < paddedSize; first += kPadding, result += kPadding) {
                REAL sums[kPadding] = {};
                ForEachEntry(row, [&](std::size_t parentPoint, double doubleWeight) {
                    REAL const *const point = points + parentPoint * paddedSize + first;
                    auto const weight = REAL(doubleWeight);
                    for (std::size_t i = 0; i < kPadding; ++i) {
                        sums[i] += weight * point[i];
                    }
                });
                std::copy(sums, sums + kPadding, result);
            }
        }
    }

    /// result = left A: what the points of the child weigh, in terms of the parent's.
    void ApplyLeft(std::vector<double> const &left, std::vector<double> &result) const;

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

    std::size_t _numParentPoints;
    std::vector<std::uint32_t> _firsts; // by row, then the end
    std::vector<double> _weights;       // those that differ
    // One of these, as large as numbers are.
    Entries<std::uint8_t> _bytes;
    Entries<std::uint16_t> _shorts;
    Entries<std::uint32_t> _longs;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

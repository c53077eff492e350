// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_STEP_MATRIX_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_STEP_MATRIX_H

#include "lanes.h"
#include "memoryCount.h"

#include "far_ext/limit/limitPatch.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The points that a step makes of those of a cell, a row for each, in little memory, since there
/// are many types of cells.
///
/// Few weights differ from each other, and most patches are small: entries are mostly two bytes.
///
/// All lies in one block: what a face needs is read from end to end, and is mostly not in the cache.
class StepMatrix {
public:
    /// A matrix of no points.
    StepMatrix() = default;
    explicit StepMatrix(FarExt::internal::PatchRefinement const &step);

    std::size_t GetNumRows() const { return _numRows; }
    std::size_t GetNumParentPoints() const { return _numParentPoints; }
    std::size_t GetHeapSize() const { return internal::GetHeapSize(_block); }

    /// Calls function(point of the parent, weight) for the entries of a row, in their order.
    template <typename FUNCTION>
    void ForEachEntry(std::size_t row, FUNCTION const &function) const {
        use([&](auto const &arrays) {
            auto const *const end = arrays.entries + arrays.ends[row];
            for (auto const *entry = arrays.entries + (row == 0 ? 0 : arrays.ends[row - 1]);
                 entry != end; ++entry) {
                function(std::size_t(entry->point), arrays.weights[entry->weight]);
            }
        });
    }

    /// \brief SIMD width of Apply(); points are padded to a multiple of it.
    static constexpr std::size_t kPadding = Lanes<float>::kCount;
    static std::size_t GetPaddedSize(std::size_t size) {
        return (size + kPadding - 1) / kPadding * kPadding;
    }
    /// Copies a point of \p size numbers to where it is computed with.
    template <typename REAL>
    static void Pad(REAL const *point, std::size_t size, REAL *result) {
        if (size == 3) { // by far the most
            result[0] = point[0];
            result[1] = point[1];
            result[2] = point[2];
        } else {
            std::copy_n(point, size, result);
        }
    }
    /// Copies a point of \p paddedSize numbers.
    /// \return  the end of the copy
    template <typename REAL>
    static REAL *CopyPadded(REAL const *point, std::size_t paddedSize, REAL *result) {
        for (std::size_t k = 0; k < paddedSize; k += kPadding) {
            result = std::copy_n(point + k, kPadding, result);
        }
        return result;
    }
    /// Writes the points that the step makes, \p paddedSize numbers each as those of the parent.
    template <typename REAL>
    void Apply(REAL const *points, std::size_t paddedSize, REAL *result) const {
        use([&](auto const &arrays) {
            auto const *const weights = arrays.GetWeights(REAL());
            auto const *begin = arrays.entries;
            for (std::size_t row = 0; row < _numRows; ++row) {
                auto const *const end = arrays.entries + arrays.ends[row];
                for (std::size_t first = 0; first < paddedSize;
                     first += kPadding, result += kPadding) {
                    Lanes<REAL> sum = {};
                    for (auto const *entry = begin; entry != end; ++entry) {
                        sum = sum + Lanes<REAL>::Load(points + entry->point * paddedSize + first) *
                                        weights[entry->weight];
                    }
                    sum.Store(result);
                }
                begin = end;
            }
        });
    }

private:
    // How large numbers are.
    enum class Width { Bytes, Shorts, Longs };

    template <typename NUMBER>
    struct Entry {
        NUMBER point;
        NUMBER weight;
    };
    // Arrays of a block, one behind the other; END: a number of entries.
    template <typename NUMBER, typename END>
    struct Arrays {
        Arrays(std::byte const *block, std::size_t numWeights, std::size_t numRows)
            : weights(reinterpret_cast<double const *>(block)),
              floatWeights(reinterpret_cast<float const *>(weights + numWeights)),
              ends(reinterpret_cast<END const *>(floatWeights + numWeights)),
              entries(reinterpret_cast<Entry<NUMBER> const *>(ends + numRows)) {}

        double const *GetWeights(double /*precision*/) const { return weights; }
        float const *GetWeights(float /*precision*/) const { return floatWeights; }

        double const *weights; // those that differ
        float const *floatWeights;
        END const *ends; // by row, in the entries
        Entry<NUMBER> const *entries;
    };

    // Calls function(arrays).
    template <typename FUNCTION>
    void use(FUNCTION const &function) const {
        switch (_width) {
        case Width::Bytes:
            function(Arrays<std::uint8_t, std::uint16_t>(_block.data(), _numWeights, _numRows));
            break;
        case Width::Shorts:
            function(Arrays<std::uint16_t, std::uint32_t>(_block.data(), _numWeights, _numRows));
            break;
        case Width::Longs:
            function(Arrays<std::uint32_t, std::uint32_t>(_block.data(), _numWeights, _numRows));
            break;
        }
    }
    template <typename NUMBER, typename END>
    void fill(FarExt::internal::PatchRefinement const &step, std::vector<double> const &weights,
              std::vector<std::uint32_t> const &numbers);

    std::uint32_t _numParentPoints = 0;
    std::uint32_t _numRows = 0;
    std::uint32_t _numWeights = 0;
    Width _width = Width::Bytes;
    std::vector<std::byte> _block; // bytes alone may become objects of other types
};

/// \brief The points of one of the cells that a step makes, in terms of the parent's: the children of a
/// cell share points, so that their rows are among those of one matrix.
class ChildStep {
public:
    /// \param matrix  of the step, which must live as long
    /// \param rows    by point of the child
    ChildStep(StepMatrix const &matrix, std::vector<int> const &rows);

    std::size_t GetNumRows() const { return _bytes.size() + _longs.size(); }
    std::size_t GetHeapSize() const { return GetHeapSizes(_bytes, _longs); }
    /// Which row of the matrix a point of the child is.
    std::size_t GetMatrixRow(std::size_t row) const {
        return _longs.empty() ? _bytes[row] : _longs[row];
    }
    /// Copies the points of the child from those that the matrix made.
    template <typename REAL>
    void CopyPoints(REAL const *points, std::size_t paddedSize, REAL *result) const {
        std::size_t const numRows = GetNumRows();
        for (std::size_t i = 0; i < numRows; ++i) {
            result =
                StepMatrix::CopyPadded(points + GetMatrixRow(i) * paddedSize, paddedSize, result);
        }
    }

    /// As StepMatrix::ForEachEntry(), of a point of the child.
    template <typename FUNCTION>
    void ForEachEntry(std::size_t row, FUNCTION const &function) const {
        _matrix->ForEachEntry(GetMatrixRow(row), function);
    }

    /// result = left A: what the points of the child weigh, in terms of the parent's.
    void ApplyLeft(std::vector<double> const &left, std::vector<double> &result) const;
    /// Their weights in terms of the points that the matrix makes, by row.
    void Spread(std::vector<double> const &left, std::vector<double> &result) const;

private:
    StepMatrix const *_matrix;
    // One of these, as large as numbers are.
    std::vector<std::uint8_t> _bytes;
    std::vector<std::uint32_t> _longs;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

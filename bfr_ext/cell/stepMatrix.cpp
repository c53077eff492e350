// SPDX-License-Identifier: Apache-2.0
#include "stepMatrix.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Weights are the same if their bits are.
std::uint64_t getBits(double weight) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &weight, sizeof(bits));
    return bits;
}

// The different weights of some, in the order in which they come.
struct DifferentWeights {
    explicit DifferentWeights(std::vector<double> const &all) {
        numbers.reserve(all.size());
        for (double const weight : all) {
            if (2 * weights.size() >= _table.size()) {
                grow();
            }
            std::uint32_t &number = _table[findPlace(weight)];
            if (number == kNone) {
                number = std::uint32_t(weights.size());
                weights.push_back(weight);
            }
            numbers.push_back(number);
        }
    }

    std::vector<double> weights;
    std::vector<std::uint32_t> numbers; // of all, in weights

private:
    static constexpr std::size_t kLeastSize = 64; // a power of two, as all sizes
    static constexpr std::uint32_t kNone = ~std::uint32_t(0);

    // Where a weight is in the table, or would be.
    std::size_t findPlace(double weight) const {
        std::uint64_t const bits = getBits(weight);
        std::size_t const mask = _table.size() - 1;
        auto place = std::size_t(bits * std::uint64_t(0x9e3779b97f4a7c15) >> 32) & mask;
        while (_table[place] != kNone && getBits(weights[_table[place]]) != bits) {
            place = (place + 1) & mask;
        }
        return place;
    }
    void grow() {
        _table.assign(std::max(kLeastSize, 2 * _table.size()), kNone);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            _table[findPlace(weights[i])] = std::uint32_t(i);
        }
    }

    std::vector<std::uint32_t> _table;
};

template <typename NUMBER>
bool fits(std::size_t largest) {
    return largest <= std::size_t(std::numeric_limits<NUMBER>::max());
}

} // namespace

StepMatrix::StepMatrix(FarExt::internal::PatchRefinement const &step)
    : _numParentPoints(std::uint32_t(step.numParentVerts)),
      _numRows(std::uint32_t(step.firsts.size() - 1)) {
    DifferentWeights const different(step.weights);
    _numWeights = std::uint32_t(different.weights.size());
    std::uint32_t const last = std::max({_numParentPoints, _numWeights, std::uint32_t(1)}) - 1;
    if (fits<std::uint8_t>(last) && fits<std::uint16_t>(step.verts.size())) {
        _width = Width::Bytes;
        fill<std::uint8_t, std::uint16_t>(step, different.weights, different.numbers);
    } else if (fits<std::uint16_t>(last)) {
        _width = Width::Shorts;
        fill<std::uint16_t, std::uint32_t>(step, different.weights, different.numbers);
    } else {
        _width = Width::Longs;
        fill<std::uint32_t, std::uint32_t>(step, different.weights, different.numbers);
    }
}

template <typename NUMBER, typename END>
void StepMatrix::fill(FarExt::internal::PatchRefinement const &step,
                      std::vector<double> const &weights,
                      std::vector<std::uint32_t> const &numbers) {
    std::vector<float> const floatWeights(weights.begin(), weights.end());
    std::vector<END> const ends(step.firsts.begin() + 1, step.firsts.end());
    std::vector<Entry<NUMBER>> entries;
    entries.reserve(step.verts.size());
    for (std::size_t i = 0; i < step.verts.size(); ++i) {
        entries.push_back({NUMBER(step.verts[i]), NUMBER(numbers[i])});
    }
    auto const getSize = [](auto const &array) { return array.size() * sizeof(array[0]); };
    _block.resize(getSize(weights) + getSize(floatWeights) + getSize(ends) + getSize(entries));
    std::byte *to = _block.data();
    auto const append = [&](auto const &array) {
        if (!array.empty()) {
            std::memcpy(to, array.data(), getSize(array));
        }
        to += getSize(array);
    };
    append(weights);
    append(floatWeights);
    append(ends);
    append(entries);
}

ChildStep::ChildStep(StepMatrix const &matrix, std::vector<int> const &rows) : _matrix(&matrix) {
    if (rows.empty() ||
        fits<std::uint8_t>(std::size_t(*std::max_element(rows.begin(), rows.end())))) {
        _bytes.assign(rows.begin(), rows.end());
    } else {
        _longs.assign(rows.begin(), rows.end());
    }
}

void ChildStep::Spread(std::vector<double> const &left, std::vector<double> &result) const {
    result.assign(_matrix->GetNumRows(), 0.0);
    for (std::size_t row = 0; row < left.size(); ++row) {
        result[GetMatrixRow(row)] += left[row];
    }
}

void ChildStep::ApplyLeft(std::vector<double> const &left, std::vector<double> &result) const {
    result.assign(_matrix->GetNumParentPoints(), 0.0);
    for (std::size_t row = 0; row < left.size(); ++row) {
        double const factor = left[row];
        if (factor != 0) {
            ForEachEntry(
                row, [&](std::size_t point, double weight) { result[point] += factor * weight; });
        }
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

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
bool isBefore(double a, double b) { return getBits(a) < getBits(b); }
bool isSame(double a, double b) { return getBits(a) == getBits(b); }

template <typename NUMBER>
bool fits(std::size_t largest) {
    return largest <= std::size_t(std::numeric_limits<NUMBER>::max());
}

} // namespace

StepMatrix::StepMatrix(FarExt::internal::PatchRefinement const &step)
    : _numParentPoints(std::uint32_t(step.numParentVerts)),
      _numRows(std::uint32_t(step.firsts.size() - 1)) {
    std::vector<double> weights = step.weights;
    std::sort(weights.begin(), weights.end(), isBefore);
    weights.erase(std::unique(weights.begin(), weights.end(), isSame), weights.end());
    _numWeights = std::uint32_t(weights.size());
    std::uint32_t const last = std::max({_numParentPoints, _numWeights, std::uint32_t(1)}) - 1;
    if (fits<std::uint8_t>(last) && fits<std::uint16_t>(step.verts.size())) {
        _width = Width::Bytes;
        fill<std::uint8_t, std::uint16_t>(step, weights);
    } else if (fits<std::uint16_t>(last)) {
        _width = Width::Shorts;
        fill<std::uint16_t, std::uint32_t>(step, weights);
    } else {
        _width = Width::Longs;
        fill<std::uint32_t, std::uint32_t>(step, weights);
    }
}

template <typename NUMBER, typename END>
void StepMatrix::fill(FarExt::internal::PatchRefinement const &step,
                      std::vector<double> const &weights) {
    std::vector<float> const floatWeights(weights.begin(), weights.end());
    std::vector<END> const ends(step.firsts.begin() + 1, step.firsts.end());
    std::vector<Entry<NUMBER>> entries;
    entries.reserve(step.verts.size());
    for (std::size_t i = 0; i < step.verts.size(); ++i) {
        auto const weight =
            std::lower_bound(weights.begin(), weights.end(), step.weights[i], isBefore);
        entries.push_back({NUMBER(step.verts[i]), NUMBER(weight - weights.begin())});
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
        result[getMatrixRow(row)] += left[row];
    }
}

void ChildStep::ApplyLeft(std::vector<double> const &left, std::vector<double> &result) const {
    result.assign(_matrix->GetNumParentPoints(), 0.0);
    for (std::size_t row = 0; row < left.size(); ++row) {
        ForEachEntry(row, [&, factor = left[row]](std::size_t point, double weight) {
            result[point] += factor * weight;
        });
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

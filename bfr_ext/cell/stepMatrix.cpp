// SPDX-License-Identifier: Apache-2.0
#include "stepMatrix.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace OpenSubdivHex::BfrExt::internal {

StepMatrix::StepMatrix(FarExt::internal::PatchRefinement const &step)
    : _numParentPoints(std::size_t(step.numParentVerts)),
      _firsts(step.firsts.begin(), step.firsts.end()), _weights(step.weights) {
    // Weights are the same if their bits are.
    auto const getBits = [](double weight) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &weight, sizeof(bits));
        return bits;
    };
    auto const isBefore = [&](double a, double b) { return getBits(a) < getBits(b); };
    std::sort(_weights.begin(), _weights.end(), isBefore);
    auto const isSame = [&](double a, double b) { return getBits(a) == getBits(b); };
    _weights.erase(std::unique(_weights.begin(), _weights.end(), isSame), _weights.end());
    _weights.shrink_to_fit();
    _floatWeights.assign(_weights.begin(), _weights.end());

    auto const fill = [&](auto &entries) {
        using Number = decltype(entries.front().point);
        entries.reserve(step.verts.size());
        for (std::size_t i = 0; i < step.verts.size(); ++i) {
            auto const weight =
                std::lower_bound(_weights.begin(), _weights.end(), step.weights[i], isBefore);
            entries.push_back({Number(step.verts[i]), Number(weight - _weights.begin())});
        }
    };
    std::size_t const size = std::max(_numParentPoints, _weights.size());
    if (size <= std::size_t(std::numeric_limits<std::uint8_t>::max()) + 1) {
        fill(_bytes);
    } else if (size <= std::size_t(std::numeric_limits<std::uint16_t>::max()) + 1) {
        fill(_shorts);
    } else {
        fill(_longs);
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

// SPDX-License-Identifier: Apache-2.0
#include "limitRowWeights.h"

#include <cstring>
#include <utility>

namespace OpenSubdivHex::OsdExt::internal {

std::size_t LimitRowWeights::Add(FarExt::internal::LimitRow const &row) {
    auto const [ofMask, isNew] = _firstOfMask.try_emplace(row.du, _weights.size());
    if (!isNew) {
        return ofMask->second;
    }
    std::vector<float> weights;
    row.ForEachPart([&](int i) {
        weights.insert(weights.end(), {float(row.weights[i]), float(row.du[i]), float(row.dv[i])});
    });
    std::string bytes(weights.size() * sizeof(weights[0]), '\0');
    if (!weights.empty()) {
        std::memcpy(bytes.data(), weights.data(), bytes.size());
    }
    auto const [found, areNew] = _firsts.try_emplace(std::move(bytes), _weights.size());
    if (areNew) {
        _weights.insert(_weights.end(), weights.begin(), weights.end());
    }
    ofMask->second = found->second;
    return found->second;
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "results.h"

#include <algorithm>
#include <utility>

namespace OpenSubdivHex::Regression {

std::string GetName(Memory memory) {
    switch (memory) {
    case Memory::Default:
        return "default";
    case Memory::Warm:
        return "warm";
    case Memory::Resident:
        break;
    }
    return "resident";
}

void Results::Add(Setting const &setting, std::vector<Cost> costs,
                  std::vector<Pairing> const &pairings) {
    for (Pairing const &pairing : pairings) {
        std::size_t const peer = *std::min_element(
            pairing.peers.begin(), pairing.peers.end(), [&](std::size_t a, std::size_t b) {
                return costs[a].GetMedian() < costs[b].GetMedian();
            });
        figures.push_back(
            {&GetRow(pairing.row), setting, GetRatio(costs[pairing.own], costs[peer]), 0});
    }
    contests.push_back({setting, std::move(costs)});
}

} // namespace OpenSubdivHex::Regression

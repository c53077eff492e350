// SPDX-License-Identifier: Apache-2.0
#include "measured.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <stdexcept>
#include <utility>

namespace OpenSubdivHex::Regression {
namespace {

using Json = nlohmann::ordered_json;

Memory readMemory(std::string const &name) {
    for (Memory memory : {Memory::Default, Memory::Warm, Memory::Resident}) {
        if (name == GetName(memory)) {
            return memory;
        }
    }
    throw std::invalid_argument("no memory is called " + name);
}

Setting readSetting(Json const &contest) {
    BenchMesh const mesh = {nullptr, contest.at("mesh"), contest.at("size"), contest.at("level")};
    return {contest.at("work"), contest.at("item"), mesh, readMemory(contest.at("memory"))};
}

Cost readCost(Json const &contestant) {
    Cost cost;
    cost.name = contestant.at("who");
    cost.numThreads = contestant.at("threads");
    double const numItems = contestant.at("items");
    for (double const seconds : contestant.at("seconds")) {
        cost.nanoseconds.push_back(seconds / numItems * 1e9);
    }
    return cost;
}

/// Contestants take as many turns as one another.
std::vector<Cost> readCosts(Json const &contest) {
    std::vector<Cost> costs;
    for (Json const &contestant : contest.at("contestants")) {
        costs.push_back(readCost(contestant));
        std::size_t const numTurns = costs.back().nanoseconds.size();
        if (numTurns == 0 || numTurns != costs.front().nanoseconds.size()) {
            throw std::invalid_argument("numbers of turns differ, or are 0");
        }
    }
    return costs;
}

void read(Json const &json, Results &results, Environment &environment) {
    results.conditions = json.at("conditions");
    for (auto const &[name, value] : json.at("environment").items()) {
        environment.emplace_back(name, value);
    }
    for (Json const &contest : json.at("contests")) {
        std::vector<Cost> const costs = readCosts(contest);
        std::vector<Pairing> pairings;
        for (Json const &pairing : contest.at("pairings")) {
            pairings.push_back({pairing.at("row"), pairing.at("own"), {pairing.at("peer")}});
            if (pairings.back().own >= costs.size() || pairings.back().peers[0] >= costs.size()) {
                throw std::out_of_range("a contestant that is not there");
            }
        }
        results.Add(readSetting(contest), costs, pairings);
    }
}

} // namespace

Results ReadMeasured(std::string const &path, Environment &environment) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw std::runtime_error(path + ": cannot be read");
    }
    Results results = {"Results of the benchmarks from Python", &GetPythonRows(), ""};
    try {
        read(Json::parse(file), results, environment);
    } catch (std::exception const &exception) {
        throw std::runtime_error(path + ": " + exception.what());
    }
    return results;
}

} // namespace OpenSubdivHex::Regression

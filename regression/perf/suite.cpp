// SPDX-License-Identifier: Apache-2.0
#include "suite.h"

#include "memory.h"
#include "meshes.h"

#include <algorithm>
#include <exception>
#include <iostream>
#include <regex>
#include <utility>

namespace OpenSubdivHex::Regression {
namespace {

constexpr char kSmall[] = "small";
constexpr char kLarge[] = "large";

std::shared_ptr<Shape const> share(Shape shape) {
    return std::make_shared<Shape const>(std::move(shape));
}

} // namespace

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

Suite::Suite(Options options) : _options(std::move(options)) {
    auto const quad = share(MakeQuadMesh());
    auto const triangle = share(MakeTriangleMesh());
    auto const hexagon = share(MakeHexMesh());
    // About 100,000 and 1 to 2 million vertices.
    int const small = _options.isQuick ? 0 : 2;
    int const large = small + (_options.isQuick ? 1 : 2);
    _meshes = {{quad, "quad", kSmall, small + 1},     {quad, "quad", kLarge, large + 1},
               {triangle, "triangle", kSmall, small}, {triangle, "triangle", kLarge, large},
               {hexagon, "hexagon", kSmall, small},   {hexagon, "hexagon", kLarge, large}};
    for (BenchMesh &mesh : _meshes) {
        mesh.level = std::max(mesh.level, 1);
    }
    auto const largeQuad = _options.isQuick ? quad : share(MakeLargeMesh(false));
    auto const largeTriangle = _options.isQuick ? triangle : share(MakeLargeMesh(true));
    _baseMeshes = {{quad, "quad", kSmall, 0},
                   {largeQuad, "quad", kLarge, 0},
                   {triangle, "triangle", kSmall, 0},
                   {largeTriangle, "triangle", kLarge, 0}};
    auto const smallQuad = share(MakeSmallQuadMesh());
    for (int level = 1; level <= (_options.isQuick ? 2 : 6); ++level) {
        _growthMeshes.push_back({smallQuad, "quad", "level " + std::to_string(level), level});
    }
}

void Suite::add(Setting const &setting, int numTurns, std::function<void(benchmark::State &)> run) {
    std::string name = setting.work + "/" + setting.mesh.name + "/" + setting.mesh.size + "/" +
                       GetName(setting.memory);
    if (std::regex_search(name, std::regex(_options.filter))) {
        _benchmarks.push_back({std::move(name), setting.memory, numTurns, std::move(run)});
    }
}

void Suite::AddContest(Setting const &setting, std::function<Contest()> const &makeContest) {
    bool const isSmall = setting.mesh.size == kSmall;
    int const numTurns = _options.isQuick ? 1 : isSmall ? 3 * _options.numTurns : _options.numTurns;
    add(setting, numTurns, [this, setting, makeContest](benchmark::State &state) {
        Contest const contest = makeContest();
        std::vector<Cost> costs =
            RunContest(state, contest.contestants, setting.memory == Memory::Default);
        for (Pairing const &pairing : contest.pairings) {
            std::size_t const peer = *std::min_element(
                pairing.peers.begin(), pairing.peers.end(), [&](std::size_t a, std::size_t b) {
                    return costs[a].GetMedian() < costs[b].GetMedian();
                });
            _figures.push_back(
                {&GetRow(pairing.row), setting, GetRatio(costs[pairing.own], costs[peer]), 0});
        }
        _results.push_back({setting, std::move(costs)});
    });
}

void Suite::AddMeasurement(Setting const &setting, std::string const &row,
                           std::function<std::pair<double, double>()> const &measure) {
    add(setting, 1, [this, setting, row, measure](benchmark::State &state) {
        for ([[maybe_unused]] auto const &iteration : state) {
            auto const [own, peer] = measure();
            _figures.push_back({&GetRow(row), setting, own, peer});
            state.SetIterationTime(0);
        }
    });
}

void Suite::run(Memory memory) {
    benchmark::ClearRegisteredBenchmarks();
    bool isAny = false;
    for (Benchmark const &entry : _benchmarks) {
        if (entry.memory != memory) {
            continue;
        }
        isAny = true;
        benchmark::RegisterBenchmark(entry.name.c_str(),
                                     [this, &entry](benchmark::State &state) {
                                         try {
                                             entry.run(state);
                                         } catch (std::exception const &exception) {
                                             _isComplete = false;
                                             state.SkipWithError(exception.what());
                                         }
                                     })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond)
            ->Iterations(entry.numTurns);
    }
    if (isAny) {
        benchmark::ConsoleReporter log(benchmark::ConsoleReporter::OO_None);
        log.SetOutputStream(&std::cerr);
        benchmark::RunSpecifiedBenchmarks(&log);
    }
}

bool Suite::Run() {
    run(Memory::Default);
    run(Memory::Resident);
    if (KeepFreedMemory()) {
        run(Memory::Warm);
    }
    return _isComplete;
}

} // namespace OpenSubdivHex::Regression

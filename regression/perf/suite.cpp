// SPDX-License-Identifier: Apache-2.0
#include "suite.h"

#include "memory.h"
#include "meshes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <iostream>
#include <regex>
#include <utility>

namespace OpenSubdivHex::Regression {
namespace {

constexpr char kSmall[] = "small";
constexpr char kLarge[] = "large";

constexpr char kConditions[] =
    R"(Sizes: small is about 100,000 vertices at the last level, large 1 to 2 million. Memory:
*default* is malloc as it is: arrays beyond 32 MiB get fresh pages in each turn. Each contestant
then runs twice and the second time counts, so that its pages are those it has just given back: a
virtual machine hands free pages to its host, and who comes behind a peer that used more of them
would wait for them. *warm* is a heap that keeps what was freed (no mmap, no trimming), so that
pages have been touched before. *resident* means that the work takes no memory: sources, tables and
results have been touched before. Each turn has a new object, for own and peer alike.)";

/// "1,536".
std::string formatCount(double count) {
    std::string text = std::to_string(std::llround(count));
    for (std::size_t end = text.size(); end > 3; end -= 3) {
        text.insert(end - 3, ",");
    }
    return text;
}

std::shared_ptr<Shape const> share(Shape shape) {
    return std::make_shared<Shape const>(std::move(shape));
}

} // namespace

Suite::Suite(Options options)
    : _options(std::move(options)),
      _rows(*_options.rows), _results{_options.title, &_rows, kConditions} {
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
    _irregularMeshes = {{share(MakeIrregularMesh()), "irregular", kLarge, large}};
    if (!_options.isQuick) {
        for (Shape const &shape : GetShapes()) {
            if (shape.name == "spot") {
                _irregularMeshes.push_back({share(shape), "spot", kLarge, large});
            }
        }
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
    _frameMesh = _options.isQuick ? BenchMesh{quad, "quad", "frame", 1}
                                  : BenchMesh{share(MakeFrameMesh()), "quad", "frame", 4};
    nameFrameMesh();
}

// Says what frames are of where there are rows of them.
void Suite::nameFrameMesh() {
    std::string const level = " at level " + std::to_string(_frameMesh.level);
    bool hasFrames = false;
    for (Row &row : _rows) {
        std::size_t const place = row.work.find(kFrameMesh);
        if (place != std::string::npos) {
            hasFrames = true;
            row.work.replace(place, std::strlen(kFrameMesh),
                             formatCount(_frameMesh.shape->GetNumVertices()) + " control vertices" +
                                 level);
        }
    }
    if (hasFrames) {
        _results.conditions += " *frame* is a\ncontrol mesh of " +
                               formatCount(_frameMesh.shape->GetNumFaces()) + " quads, which has " +
                               formatCount(CountHexVertices(*_frameMesh.shape, _frameMesh.level)) +
                               " vertices" + level + "; *huge* is that mesh one level further.";
    }
}

BenchMesh Suite::GetHugeMesh() const {
    BenchMesh mesh = _frameMesh;
    mesh.size = "huge";
    ++mesh.level;
    return mesh;
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
        _results.Add(setting, std::move(costs), contest.pairings);
    });
}

void Suite::AddMeasurement(Setting const &setting, std::string const &row,
                           std::function<std::pair<double, double>()> const &measure) {
    add(setting, 1, [this, setting, row, measure](benchmark::State &state) {
        for ([[maybe_unused]] auto const &iteration : state) {
            auto const [own, peer] = measure();
            _results.figures.push_back({&GetRow(row), setting, own, peer});
            state.SetIterationTime(0);
        }
    });
}

void AddFrameBenchmark(Suite &suite, std::string const &row,
                       std::function<std::function<void()>(BenchMesh const &)> const &makeFrame) {
    BenchMesh const &mesh = suite.GetFrameMesh();
    suite.AddMeasurement({row, "", mesh, Memory::Resident}, row, [=] {
        constexpr int kNumFrames = 5;
        std::function<void()> const frame = makeFrame(mesh);
        frame(); // compiles, and touches what the others use
        std::vector<double> milliseconds;
        for (int i = 0; i < kNumFrames; ++i) {
            auto const start = std::chrono::steady_clock::now();
            frame();
            milliseconds.push_back(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                    .count());
        }
        return std::pair(GetMedian(milliseconds), 0.0);
    });
}

void Suite::run(Memory memory, std::function<void()> const &afterEach) {
    benchmark::ClearRegisteredBenchmarks();
    bool isAny = false;
    for (Benchmark const &entry : _benchmarks) {
        if (entry.memory != memory) {
            continue;
        }
        isAny = true;
        benchmark::RegisterBenchmark(entry.name.c_str(),
                                     [this, &entry, &afterEach](benchmark::State &state) {
                                         try {
                                             entry.run(state);
                                         } catch (std::exception const &exception) {
                                             _isComplete = false;
                                             state.SkipWithError(exception.what());
                                         }
                                         afterEach();
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

bool Suite::Run(std::function<void()> const &afterEach) {
    run(Memory::Default, afterEach);
    run(Memory::Resident, afterEach);
    if (KeepFreedMemory()) {
        run(Memory::Warm, afterEach);
    }
    return _isComplete;
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "statistics.h"

#include <nlohmann/json.hpp>

#include <cstdio>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

namespace OpenSubdivHex::Tutorials {

std::vector<LevelStatistics> CountLevels(FarExt::TopologyRefiner const &refiner) {
    std::vector<LevelStatistics> levels;
    for (int i = 0; i < refiner.GetNumLevels(); ++i) {
        FarExt::TopologyLevel const &level = refiner.GetLevel(i);
        std::map<int, int> facesBySize;
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            ++facesBySize[level.GetFaceVertices(f).size()];
        }
        levels.push_back({level.GetNumVertices(), level.GetNumEdges(), level.GetNumFaces(),
                          level.GetNumFaceVertices(), level.GetNumBoundaryEdges(), facesBySize});
    }
    return levels;
}

std::int64_t GetPeakMemoryBytes() {
#if defined(__unix__) || defined(__APPLE__)
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return usage.ru_maxrss;
#else
    return std::int64_t(usage.ru_maxrss) * 1024;
#endif
#else
    return 0;
#endif
}

std::string FormatJson(Statistics const &statistics) {
    using Json = nlohmann::ordered_json;

    Json levels = Json::array();
    for (LevelStatistics const &level : statistics.levels) {
        Json facesBySize = Json::object();
        for (auto const &[size, numFaces] : level.facesBySize) {
            facesBySize[std::to_string(size)] = numFaces;
        }
        levels.push_back({{"level", levels.size()},
                          {"vertices", level.vertices},
                          {"edges", level.edges},
                          {"faces", level.faces},
                          {"corners", level.corners},
                          {"boundaryEdges", level.boundaryEdges},
                          {"facesBySize", facesBySize}});
    }
    auto const &milliseconds = statistics.milliseconds;
    Json const json = {{"scheme", statistics.scheme},
                       {"mask", statistics.mask},
                       {"boundary", statistics.boundary},
                       {"evaluator", statistics.evaluator},
                       {"input", statistics.input},
                       {"levels", levels},
                       {"milliseconds",
                        {{"read", milliseconds.read},
                         {"validate", milliseconds.validate},
                         {"refine", milliseconds.refine},
                         {"stencils", milliseconds.stencils},
                         {"evaluate", milliseconds.evaluate},
                         {"write", milliseconds.write}}},
                       {"stencils", statistics.stencils},
                       {"weights", statistics.weights},
                       {"peakMemoryBytes", GetPeakMemoryBytes()}};
    // A path need not be UTF-8, JSON must be.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

template <typename... ARGS>
std::string format(char const *pattern, ARGS... args) {
    char line[256];
    std::snprintf(line, sizeof line, pattern, args...);
    return line;
}

} // namespace

std::string FormatSummary(Statistics const &statistics) {
    std::string summary = statistics.input + ": scheme " + statistics.scheme + ", mask " +
                          statistics.mask + ", boundary " + statistics.boundary + ", evaluator " +
                          statistics.evaluator + "\n\n" +
                          "level    vertices       edges       faces    boundary  faces by size\n";
    for (std::size_t i = 0; i < statistics.levels.size(); ++i) {
        LevelStatistics const &level = statistics.levels[i];
        summary += format("%5d %11d %11d %11d %11d ", int(i), level.vertices, level.edges,
                          level.faces, level.boundaryEdges);
        for (auto const &[size, numFaces] : level.facesBySize) {
            summary += format(" %d:%d", size, numFaces);
        }
        summary += "\n";
    }
    summary += "\n";
    if (statistics.stencils > 0) {
        summary += format("%d stencils, %lld weights\n", statistics.stencils,
                          static_cast<long long>(statistics.weights));
    }
    auto const &ms = statistics.milliseconds;
    summary += format("ms: read %.1f, validate %.1f, refine %.1f, stencils %.1f, evaluate %.1f, "
                      "write %.1f\n",
                      ms.read, ms.validate, ms.refine, ms.stencils, ms.evaluate, ms.write);
    if (std::int64_t const bytes = GetPeakMemoryBytes()) {
        summary += format("peak memory %.1f MiB\n", double(bytes) / (1024 * 1024));
    }
    return summary;
}

} // namespace OpenSubdivHex::Tutorials

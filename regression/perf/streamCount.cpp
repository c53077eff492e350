// SPDX-License-Identifier: Apache-2.0
//
// A mesh streamed to a sink that only counts and hashes: with 1, 2 and 3 threads, and by 2 processes
// that share its faces.  The hash of a stream is the sum of those of its patches, so that it does not
// depend on their order, and those of shares add up to that of the whole.
#include "memory.h"

#include "bfr_ext/patchStream.h"
#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/program.h"
#include "tools/mesh/ruleNames.h"
#include "tools/mesh/topologyDescriptor.h"

#include <atomic>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <sstream>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

struct Arguments {
    std::string input;
    int level = 5;
    FarExt::FaceMask mask = FarExt::FaceMask::Smooth;
    double megabytes = 4;
    double cacheMegabytes = 1000;
    std::vector<int> share; // of a process: which one, of how many
};

struct Count {
    std::uint64_t points = 0;
    std::uint64_t facets = 0;
    std::uint64_t hash = 0;
};

bool operator==(Count const &a, Count const &b) {
    return a.points == b.points && a.facets == b.facets && a.hash == b.hash;
}

// By FNV-1a, in words of 4 bytes, and mixed so that sums of hashes tell faces apart.
std::uint64_t hashPatch(BfrExt::PatchStream<float>::Patch const &patch) {
    std::uint64_t hash = 0xcbf29ce484222325 ^ std::uint64_t(patch.face);
    auto const count =
        std::size_t(patch.tessellation.GetNumCoords()) * std::size_t(patch.pointSize);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, patch.points + i, sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3;
    }
    hash = (hash ^ (hash >> 31)) * 0x9e3779b97f4a7c15;
    return hash ^ (hash >> 29);
}

Count countStream(BfrExt::PatchStream<float> const &stream, std::vector<float> const &positions,
                  int beginFace, int endFace) {
    std::atomic<std::uint64_t> points(0);
    std::atomic<std::uint64_t> facets(0);
    std::atomic<std::uint64_t> hash(0);
    FarExt::CallStatus status;
    bool const isDone = stream.Run(
        positions.data(), 3, beginFace, endFace,
        [&](BfrExt::PatchStream<float>::Patch const &patch) {
            points += std::uint64_t(patch.tessellation.GetNumCoords());
            facets += std::uint64_t(patch.tessellation.GetNumFacets());
            hash += hashPatch(patch);
            return true;
        },
        &status);
    if (!isDone) {
        throw std::runtime_error(status.GetErrorMessage());
    }
    return {points, facets, hash};
}

// Reads the output of a process that was started for a share.
Count parseCount(std::string const &line) {
    Count count;
    std::istringstream words(line);
    if (!(words >> count.points >> count.facets >> std::hex >> count.hash)) {
        throw std::runtime_error("a process gave no hash, but '" + line + "'");
    }
    return count;
}

// Runs \p numProcesses of this program, each with its share of faces, and adds up what they print.
Count countByProcesses(std::string const &command, int numProcesses) {
    std::vector<std::FILE *> pipes;
    for (int i = 0; i < numProcesses; ++i) {
        std::string const share =
            " --share " + std::to_string(i) + "," + std::to_string(numProcesses);
        pipes.push_back(popen((command + share).c_str(), "r"));
        if (!pipes.back()) {
            throw std::runtime_error("no process can be started");
        }
    }
    Count sum;
    for (std::FILE *const pipe : pipes) {
        char line[256] = "";
        static_cast<void>(std::fgets(line, sizeof line, pipe));
        if (pclose(pipe) != 0) {
            throw std::runtime_error("a process with a share of the faces failed");
        }
        Count const count = parseCount(line);
        sum = {sum.points + count.points, sum.facets + count.facets, sum.hash + count.hash};
    }
    return sum;
}

double getSeconds(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void printRow(char const *by, Count const &count, double seconds, double peakBytes) {
    std::printf("%-12s %15" PRIu64 " points %15" PRIu64 " facets  hash %016" PRIx64
                "  %8.2f s  %6.2f ns a point",
                by, count.points, count.facets, count.hash, seconds,
                1e9 * seconds / double(count.points));
    if (std::isfinite(peakBytes)) {
        std::printf("  %7.1f MB", peakBytes / 1e6);
    }
    std::printf("\n");
    std::fflush(stdout);
}

// In single quotes, for the shell.
std::string quote(std::string const &word) {
    std::string result = "'";
    for (char const c : word) {
        result += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return result + "'";
}

void run(Arguments const &arguments, std::string const &program) {
    Tools::Mesh const mesh = Tools::ReadInput("streamCount", arguments.input);
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask = arguments.mask;
    FarExt::CallStatus status;
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(mesh),
                                                                sdcOptions, options, &status);
    if (!refiner) {
        throw Tools::FileError(arguments.input, status.GetErrorMessage());
    }
    // Each count begins with an empty cache.
    auto const count = [&](int beginFace, int endFace) {
        BfrExt::SurfaceFactoryCache cache(std::size_t(arguments.cacheMegabytes * 1e6));
        auto const factory = BfrExt::SurfaceFactory::Create(
            *refiner, BfrExt::SurfaceFactory::Options().SetExternalCache(&cache), &status);
        if (!factory) {
            throw Tools::FileError(arguments.input, status.GetErrorMessage());
        }
        BfrExt::PatchStream<float> const stream(*factory, BfrExt::PatchLevels(arguments.level),
                                                BfrExt::PatchStream<float>::Options().SetMaxMemory(
                                                    std::size_t(arguments.megabytes * 1e6)));
        return countStream(stream, mesh.positions, beginFace, endFace);
    };
    int const numFaces = refiner->GetLevel(0).GetNumFaces();
    if (!arguments.share.empty()) {
        FarExt::SetNumThreads(1);
        auto const getFace = [&](int share) {
            return int(std::int64_t(numFaces) * share / arguments.share[1]);
        };
        Count const part = count(getFace(arguments.share[0]), getFace(arguments.share[0] + 1));
        std::printf("%" PRIu64 " %" PRIu64 " %" PRIx64 "\n", part.points, part.facets, part.hash);
        return;
    }
    Count first;
    bool areEqual = true;
    for (int const numThreads : {1, 2, 3}) {
        FarExt::SetNumThreads(numThreads);
        Count result;
        double seconds = 0;
        double const peak = MeasurePeakBytes([&] {
            auto const start = std::chrono::steady_clock::now();
            result = count(0, numFaces);
            seconds = getSeconds(start);
        });
        printRow((std::to_string(numThreads) + " threads").c_str(), result, seconds, peak);
        first = numThreads == 1 ? result : first;
        areEqual = areEqual && result == first;
    }
    std::string const &mask = Tools::kMaskNames[std::size_t(arguments.mask)];
    auto const start = std::chrono::steady_clock::now();
    Count const result =
        countByProcesses(quote(program) + " " + quote(arguments.input) + " --level " +
                             std::to_string(arguments.level) + " --mask " + mask + " --memory " +
                             std::to_string(arguments.megabytes) + " --cache " +
                             std::to_string(arguments.cacheMegabytes),
                         2);
    printRow("2 processes", result, getSeconds(start), std::nan(""));
    if (!areEqual || !(result == first)) {
        throw std::runtime_error("the hashes differ");
    }
    std::printf("all are equal\n");
}

} // namespace

} // namespace OpenSubdivHex::Regression

int main(int argc, char **argv) {
    using namespace OpenSubdivHex;
    Regression::Arguments arguments;
    CLI::App app(
        "Streams the surface of a mesh to a sink that counts and hashes, with 1, 2 and 3 "
        "threads and by 2 processes: time, memory beyond the input, and whether all hashes "
        "are equal.",
        "streamCount");
    app.add_option("INPUT", arguments.input, "Control mesh: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option("-l,--level", arguments.level, "Level of all faces and edges")
        ->check(CLI::Range(0, BfrExt::LevelTessellation::kLastLevel))
        ->capture_default_str();
    app.add_option("--mask", arguments.mask, "Mask of the face points: average, cosine or smooth")
        ->transform(CLI::Transformer(Tools::MapRules<FarExt::FaceMask>(Tools::kMaskNames)))
        ->type_name("NAME")
        ->default_str("smooth");
    app.add_option("--memory", arguments.megabytes, "Megabytes that tessellations may take")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--cache", arguments.cacheMegabytes,
                   "Megabytes that types of faces and cells may take")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--share", arguments.share,
                   "Print counts and hash of one share of the faces alone")
        ->delimiter(',')
        ->expected(2)
        ->allow_extra_args(false)
        ->type_name("SHARE,SHARES");
    app.footer("Exit status: 0 all hashes are equal, 1 bad input or other hashes, 2 bad usage.");
    return Tools::RunProgram(app, argc, argv, [&] { Regression::run(arguments, argv[0]); });
}

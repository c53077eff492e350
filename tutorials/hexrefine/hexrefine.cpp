// SPDX-License-Identifier: Apache-2.0
//
// hexrefine: refines a polygon mesh with the hexagonal scheme and writes the result.
//
// Mesh file -> Far::TopologyDescriptor -> FarExt::TopologyRefiner -> Far::StencilTable -> Osd
// evaluator -> mesh file.
#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "progress.h"
#include "statistics.h"
#include "tutorials/common/fileError.h"
#include "tutorials/common/meshFormat.h"
#include "tutorials/common/meshReader.h"
#include "tutorials/common/meshText.h"
#include "tutorials/common/meshWriter.h"
#include "tutorials/common/outputFile.h"
#include "tutorials/common/point.h"
#include "tutorials/common/topologyDescriptor.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#ifdef HEXREFINE_HAS_OPENMP
#include <opensubdiv/osd/ompEvaluator.h>
#endif

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <new>

namespace OpenSubdivHex::Tutorials {

namespace {

namespace Osd = OpenSubdiv::Osd;

enum ExitCode { kSuccess = 0, kFailure = 1, kBadUsage = 2 };

struct Arguments {
    std::string input;
    int level = 1;
    std::string output;
    std::string mask = "average";
    std::string scheme = "hex";
    std::string boundary = "none";
    std::string evaluator = "stencil-cpu";
    std::string stats;
    bool isQuiet = false;
};

/// Runs \p work and gives the milliseconds it took.
template <typename WORK>
double measure(Progress &progress, std::string const &phase, WORK &&work) {
    progress.SetPhase(phase);
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

void addOptions(CLI::App &app, Arguments *arguments) {
    app.add_option("INPUT", arguments->input, "Mesh to refine: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option("-l,--level", arguments->level, "Number of refinement steps")
        ->check([](std::string const &word) {
            int level = 0;
            return std::string(ParseInt(word, &level) && level >= 0
                                   ? ""
                                   : "'" + word + "' is not a number of steps, 0 or more");
        })
        ->capture_default_str();
    app.add_option("-o,--output", arguments->output,
                   "File for the last level: .obj, .off or .ply (binary); none: nothing is written")
        ->check([](std::string const &path) {
            return FindMeshFormat(path) ? std::string()
                                        : "'" + path + "' is not a " + kMeshExtensions + " file";
        })
        ->type_name("FILE");
    app.add_option("--mask", arguments->mask,
                   "Mask of the face points: average is the paper's, smooth is the smoothest")
        ->check(CLI::IsMember({"average", "cosine", "smooth"}))
        ->capture_default_str();
    app.add_option("--scheme", arguments->scheme, "Subdivision scheme")
        ->check(CLI::IsMember({"hex"}))
        ->capture_default_str();
    app.add_option("--boundary", arguments->boundary,
                   "Rule for boundaries: none is the paper's, the border moves inward")
        ->check(CLI::IsMember({"none"}))
        ->capture_default_str();
    app.add_option("--evaluator", arguments->evaluator,
                   "How positions are computed: from a stencil table with one thread or with "
                   "OpenMP, or level by level without a table")
        ->check(CLI::IsMember({"stencil-cpu", "stencil-omp", "primvar"}))
        ->check([](std::string const &evaluator) {
#ifdef HEXREFINE_HAS_OPENMP
            static_cast<void>(evaluator);
            return std::string();
#else
            return std::string(evaluator == "stencil-omp"
                                   ? "stencil-omp is not in this program, built without OpenMP"
                                   : "");
#endif
        })
        ->capture_default_str();
    app.add_option("--stats", arguments->stats, "File for statistics as JSON; - is standard output")
        ->type_name("FILE|-");
    app.add_flag("--quiet", arguments->isQuiet, "Print no summary and show no progress");
    app.set_version_flag("--version", "hexrefine " HEXREFINE_VERSION);
    app.footer("Exit status: 0 success, 1 bad input or failed output, 2 bad usage.");
}

FarExt::FaceMask findMask(std::string const &name) {
    return name == "cosine"   ? FarExt::FaceMask::Cosine
           : name == "smooth" ? FarExt::FaceMask::Smooth
                              : FarExt::FaceMask::Average;
}

/// The base mesh as the library takes it, validated.
std::unique_ptr<FarExt::TopologyRefiner> createRefiner(Arguments const &arguments,
                                                       Mesh const &mesh) {
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
    FarExt::TopologyRefinerFactory::Options options;
    options.schemeOptions.faceMask = findMask(arguments.mask);
    FarExt::Status status;
    auto refiner = FarExt::TopologyRefinerFactory::Create(DescribeTopology(mesh), sdcOptions,
                                                          options, &status);
    if (!refiner) {
        throw FileError(arguments.input, status.GetMessage());
    }
    return refiner;
}

static_assert(sizeof(Point) == 3 * sizeof(float), "read as an array of floats");

/// Positions of the last level, level by level.
std::vector<float> evaluateLevels(FarExt::TopologyRefiner const &refiner,
                                  std::vector<float> const &basePositions) {
    FarExt::PrimvarRefiner const primvarRefiner(refiner);
    std::vector<float> source = basePositions;
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        std::vector<float> positions(3 * std::size_t(refiner.GetLevel(level).GetNumVertices()));
        auto *const destination = reinterpret_cast<Point *>(positions.data());
        primvarRefiner.Interpolate(level, reinterpret_cast<Point const *>(source.data()),
                                   destination);
        source = std::move(positions);
    }
    return source;
}

/// Positions of the last level from a table that holds that level alone.
std::vector<float> evaluateStencils(Far::StencilTable const &table, std::string const &evaluator,
                                    std::vector<float> const &basePositions) {
    std::vector<float> positions(3 * std::size_t(table.GetNumStencils()));
    Osd::BufferDescriptor const desc(0, 3, 3);
    auto evaluate = [&](auto const &evaluateRange) {
        evaluateRange(basePositions.data(), desc, positions.data(), desc, table.GetSizes().data(),
                      table.GetOffsets().data(), table.GetControlIndices().data(),
                      table.GetWeights().data(), 0, table.GetNumStencils());
    };
#ifdef HEXREFINE_HAS_OPENMP
    if (evaluator == "stencil-omp") {
        evaluate([](auto... args) { return Osd::OmpEvaluator::EvalStencils(args...); });
        return positions;
    }
#else
    static_cast<void>(evaluator);
#endif
    evaluate([](auto... args) { return Osd::CpuEvaluator::EvalStencils(args...); });
    return positions;
}

void copyFaces(FarExt::TopologyLevel const &level, Mesh *mesh) {
    mesh->faceSizes.clear();
    mesh->faceSizes.reserve(level.GetNumFaces());
    mesh->faceVertices.clear();
    mesh->faceVertices.reserve(level.GetNumFaceVertices());
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        Far::ConstIndexArray const vertices = level.GetFaceVertices(f);
        mesh->faceSizes.push_back(vertices.size());
        mesh->faceVertices.insert(mesh->faceVertices.end(), vertices.begin(), vertices.end());
    }
}

void print(std::string const &text) {
    if (!(std::cout << text << std::flush)) {
        throw FileError("standard output", "cannot be written");
    }
}

void writeStatistics(Statistics const &statistics, std::string const &path) {
    if (path == "-") {
        print(FormatJson(statistics));
        return;
    }
    OutputFile file(path);
    file.Write(FormatJson(statistics));
    file.Commit();
}

/// Throws FileError and std::bad_alloc.
void run(Arguments const &arguments) {
    Statistics statistics;
    statistics.scheme = arguments.scheme;
    statistics.mask = arguments.mask;
    statistics.boundary = arguments.boundary;
    statistics.evaluator = arguments.evaluator;
    statistics.input = arguments.input;
    auto &milliseconds = statistics.milliseconds;
    {
        Progress progress(!arguments.isQuiet && Progress::IsTerminal());

        Mesh mesh;
        milliseconds.read = measure(progress, "reading", [&] { mesh = ReadMesh(arguments.input); });

        std::unique_ptr<FarExt::TopologyRefiner> refiner;
        milliseconds.validate =
            measure(progress, "validating", [&] { refiner = createRefiner(arguments, mesh); });

        milliseconds.refine = measure(progress, "refining", [&] {
            FarExt::Status status;
            if (!refiner->RefineUniform(arguments.level, &status)) {
                throw FileError(arguments.input, status.GetMessage());
            }
        });
        statistics.levels = CountLevels(*refiner);

        if (arguments.evaluator == "primvar") {
            milliseconds.evaluate = measure(progress, "evaluating", [&] {
                mesh.positions = evaluateLevels(*refiner, mesh.positions);
            });
        } else if (arguments.level > 0) {
            std::unique_ptr<Far::StencilTable const> table;
            milliseconds.stencils = measure(progress, "building stencils", [&] {
                FarExt::StencilTableFactory::Options options;
                options.generateIntermediateLevels = false;
                FarExt::Status status;
                table = FarExt::StencilTableFactory::Create(*refiner, options, &status);
                if (!table) {
                    throw FileError(arguments.input, status.GetMessage());
                }
            });
            statistics.stencils = table->GetNumStencils();
            statistics.weights = std::int64_t(table->GetWeights().size());
            milliseconds.evaluate = measure(progress, "evaluating", [&] {
                mesh.positions = evaluateStencils(*table, arguments.evaluator, mesh.positions);
            });
        }

        if (!arguments.output.empty()) {
            milliseconds.write = measure(progress, "writing", [&] {
                copyFaces(refiner->GetLevel(arguments.level), &mesh);
                WriteMesh(mesh, arguments.output);
            });
        }
    }

    if (!arguments.stats.empty()) {
        writeStatistics(statistics, arguments.stats);
    }
    if (!arguments.isQuiet && arguments.stats != "-") {
        print(FormatSummary(statistics) +
              (arguments.output.empty() ? "" : "wrote " + arguments.output + "\n"));
    }
}

} // namespace

} // namespace OpenSubdivHex::Tutorials

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Tutorials;

    Arguments arguments;
    CLI::App app("Refines a polygon mesh with the hexagonal vertex-to-vertex subdivision scheme.",
                 "hexrefine");
    addOptions(app, &arguments);
    try {
        app.parse(argc, argv);
    } catch (CLI::ParseError const &error) {
        return app.exit(error) == 0 ? kSuccess : kBadUsage;
    }
    try {
        run(arguments);
    } catch (FileError const &error) {
        std::cerr << "hexrefine: " << error.what() << "\n";
        return kFailure;
    } catch (std::bad_alloc const &) {
        std::cerr << "hexrefine: " << arguments.input << ": not enough memory for level "
                  << arguments.level << "\n";
        return kFailure;
    }
    return kSuccess;
}

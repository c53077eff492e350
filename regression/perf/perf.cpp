// SPDX-License-Identifier: Apache-2.0
//
// perf: this library against its peers, in the same run.
#include "measured.h"
#include "report.h"
#include "suite.h"

#include "tools/mesh/program.h"

#ifdef PERF_HAS_GL
#include "regression/gl/glContext.h"
#endif

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <regex>
#include <stdexcept>

namespace OpenSubdivHex::Regression {
namespace {

void writeFile(std::string const &path, std::string const &text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) {
        throw std::runtime_error(path + ": cannot be written");
    }
}

/// Where results go, besides to standard output; nowhere else if empty.
struct Paths {
    std::string json;
    std::string markdown;
};

void writeFiles(Results const &results, Environment const &environment, Paths const &paths) {
    if (!paths.markdown.empty()) {
        writeFile(paths.markdown, FormatMarkdown(results, environment));
    }
    if (!paths.json.empty()) {
        writeFile(paths.json, FormatJson(results, environment));
    }
}

void write(Results const &results, Environment const &environment, Paths const &paths) {
    std::cout << FormatMarkdown(results, environment) << std::flush;
    writeFiles(results, environment, paths);
}

Environment describeRun(std::string const &command) {
    Environment environment = DescribeEnvironment();
    environment.emplace_back("command", "`" + command + "`");
    return environment;
}

void report(std::string const &measuredPath, std::string const &command, Paths const &paths) {
    Environment environment = describeRun(command);
    Results const results = ReadMeasured(measuredPath, environment);
    write(results, environment, paths);
}

void runSuite(Suite &suite, Environment const &environment, Paths const &paths) {
    // The files have what was measured so far, in case the run is ended.
    bool const isComplete = suite.Run([&] { writeFiles(suite.GetResults(), environment, paths); });
    write(suite.GetResults(), environment, paths);
    if (!isComplete) {
        throw std::runtime_error("not complete, see above");
    }
}

void run(Suite::Options const &options, std::string const &command, Paths const &paths) {
    Environment const environment = describeRun(command);
    Suite suite(options);
    AddTablePeakBenchmarks(suite);
    AddCopyBenchmarks(suite);
    AddPhaseBenchmarks(suite);
    AddTopologyBenchmarks(suite);
    AddPositionBenchmarks(suite);
    AddStencilTableBenchmarks(suite);
    AddEvaluationBenchmarks(suite);
    AddTableFreeBenchmarks(suite);
    AddMaskBenchmarks(suite);
    AddLimitBenchmarks(suite);
    AddPatchBenchmarks(suite);
    AddSurfaceBenchmarks(suite);
    AddViewBenchmarks(suite);
    AddDrawingBenchmarks(suite);
    AddGrowthBenchmarks(suite);
    AddBusyBenchmarks(suite);
    runSuite(suite, environment, paths);
}

#ifdef PERF_HAS_GL
void runDevice(Suite::Options options, std::string const &command, Paths const &paths) {
    GlContext const context;
    bool const hasGl = context.GetError().empty();
    Environment environment = describeRun(command);
    // If something needed is missing, the run fails once all else is measured.
    std::string failure;
    auto const describeMissing = [&](std::string const &reason, char const *needed) {
        if (std::getenv(needed)) {
            failure += (failure.empty() ? "" : "; ") + reason;
        }
        return reason + ": not measured";
    };
    std::string const renderer =
        hasGl ? context.GetRenderer()
              : describeMissing(context.GetError(), "OPENSUBDIVHEX_NEEDS_GL");
    bool const isProcessor = renderer.find("llvmpipe") != std::string::npos ||
                             renderer.find("softpipe") != std::string::npos;
    environment.emplace_back("OpenGL",
                             renderer + (isProcessor ? ", on the processor: no GPU" : ""));
#ifdef PERF_HAS_CUDA
    std::string reason;
    std::string const cuda = GetCudaDevice(reason);
    environment.emplace_back(
        "CUDA", cuda.empty() ? describeMissing(reason, "OPENSUBDIVHEX_NEEDS_CUDA") : cuda);
#else
    environment.emplace_back("CUDA", "not built: not measured");
#endif
    options.title = "Results of the benchmarks of devices";
    options.rows = &GetDeviceRows();
    Suite suite(std::move(options));
#ifdef PERF_HAS_CUDA
    if (!cuda.empty()) {
        AddCudaBenchmarks(suite);
    }
#endif
    if (hasGl) {
        AddDeviceBenchmarks(suite, context);
    }
    runSuite(suite, environment, paths);
    if (!failure.empty()) {
        throw std::runtime_error(failure);
    }
}
#else
void runDevice(Suite::Options const &, std::string const &, Paths const &) {
    throw std::runtime_error("--device: this program was built without OPENSUBDIVHEX_GL");
}
#endif

} // namespace
} // namespace OpenSubdivHex::Regression

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Regression;

    Suite::Options options;
    Paths paths;
    std::string measuredPath;
    std::string command = "perf";
    CLI::App app("Compares OpenSubdivHex with Far, Osd, OpenMesh and CGAL.", "perf");
    bool isOfDevice = false;
    app.add_flag(
        "--device", isOfDevice,
        "Instead of the processor, measure evaluators of CUDA, where there is a device, and "
        "of OpenGL, where there is a context without a window");
    app.add_flag("--quick", options.isQuick, "Tiny sizes and one turn: to see that all runs");
    app.add_option(
           "--filter", options.filter,
           "Regular expression: only benchmarks whose names, WORK/MESH/SIZE/MEMORY, have it")
        ->check([](std::string const &word) {
            try {
                static_cast<void>(std::regex(word));
            } catch (std::regex_error const &) {
                return "'" + word + "' is not a regular expression";
            }
            return std::string();
        });
    app.add_option("--turns", options.numTurns, "Turns of large sizes; small ones have three times")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--json", paths.json, "File for the results as JSON")->type_name("FILE");
    app.add_option("--markdown", paths.markdown, "File for the printed text")->type_name("FILE");
    app.add_option("--measured", measuredPath,
                   "Instead of measuring, report what pythonBenchmark.py wrote to this file")
        ->type_name("FILE");
    app.add_option("--command", command, "Command to name in the results")->group("");
    return OpenSubdivHex::Tools::RunProgram(app, argc, argv, [&] {
        if (!measuredPath.empty()) {
            report(measuredPath, command, paths);
        } else if (isOfDevice) {
            runDevice(options, command, paths);
        } else {
            run(options, command, paths);
        }
    });
}

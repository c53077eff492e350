// SPDX-License-Identifier: Apache-2.0
//
// perf: this library against its peers, in the same run.
#include "report.h"
#include "suite.h"

#include "tools/mesh/program.h"

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

void run(Suite::Options const &options, std::string const &command, std::string const &jsonPath,
         std::string const &markdownPath) {
    Environment environment = DescribeEnvironment();
    environment.emplace_back("command", "`" + command + "`");
    Suite suite(options);
    AddTablePeakBenchmarks(suite);
    AddCopyBenchmarks(suite);
    AddPhaseBenchmarks(suite);
    AddTopologyBenchmarks(suite);
    AddPositionBenchmarks(suite);
    AddStencilTableBenchmarks(suite);
    AddEvaluationBenchmarks(suite);
    AddTableFreeBenchmarks(suite);
    AddLimitBenchmarks(suite);
    AddGrowthBenchmarks(suite);
    AddBusyBenchmarks(suite);
    bool const isComplete = suite.Run();

    std::string const markdown = FormatMarkdown(suite, environment);
    std::cout << markdown << std::flush;
    if (!markdownPath.empty()) {
        writeFile(markdownPath, markdown);
    }
    if (!jsonPath.empty()) {
        writeFile(jsonPath, FormatJson(suite, environment));
    }
    if (!isComplete) {
        throw std::runtime_error("not complete, see above");
    }
}

} // namespace
} // namespace OpenSubdivHex::Regression

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Regression;

    Suite::Options options;
    std::string jsonPath;
    std::string markdownPath;
    std::string command = "perf";
    CLI::App app("Compares OpenSubdivHex with Far, Osd, OpenMesh and CGAL.", "perf");
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
    app.add_option("--json", jsonPath, "File for the results as JSON")->type_name("FILE");
    app.add_option("--markdown", markdownPath, "File for the printed text")->type_name("FILE");
    app.add_option("--command", command, "Command to name in the results")->group("");
    return OpenSubdivHex::Tools::RunProgram(app, argc, argv,
                                            [&] { run(options, command, jsonPath, markdownPath); });
}

// SPDX-License-Identifier: Apache-2.0
//
// hexrefine: refines a polygon mesh with the hexagonal scheme and writes the result.
//
// Mesh file -> Far::TopologyDescriptor -> FarExt::TopologyRefiner -> OsdExt::RefinementEvaluator,
// or Far::StencilTable and an evaluator -> mesh file.
#include "arguments.h"
#include "job.h"
#include "progress.h"
#include "statistics.h"

#include "far_ext/executor.h"
#include "osd_ext/simdLevel.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshText.h"
#include "tools/mesh/outputFile.h"
#include "tools/mesh/program.h"

#ifdef _OPENMP
#include <omp.h>
#endif

#include <iostream>
#include <new>
#include <optional>

namespace OpenSubdivHex::Tools {

namespace {

void print(std::string const &text) {
    std::cout << text;
    FlushOutput();
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

/// Sets the level that --simd names, which is checked.
void setSimdLevel(std::string const &name) {
    OsdExt::SimdLevel level = OsdExt::GetSimdLevel();
    OsdExt::FindSimdLevel(name, &level);
    OsdExt::SetSimdLevel(level);
}

/// Prints what is asked for and the hints, and writes the statistics.
void report(Arguments const &arguments, Job const &job) {
    Statistics const &statistics = job.GetStatistics();
    if (arguments.printsTags) {
        print(job.GetTagText());
    }
    if (!arguments.stats.empty()) {
        writeStatistics(statistics, arguments.stats);
    }
    if (!arguments.isQuiet && arguments.stats != "-") {
        std::string summary = FormatSummary(statistics);
        for (std::string const &path : {arguments.output, arguments.png}) {
            summary += path.empty() ? "" : "wrote " + EscapeControls(path) + "\n";
        }
        print(summary);
    }
    for (std::string const &hint : job.GetHints()) {
        if (!arguments.isQuiet) {
            PrintHint("hexrefine", arguments.input, hint);
        }
    }
}

/// Calls a function; lack of memory is an error of the input, with what the memory was for.
template <typename FUNCTION>
void withMemoryFor(std::string const &what, Arguments const &arguments, FUNCTION const &function) {
    try {
        function();
    } catch (std::bad_alloc const &) {
        throw FileError(arguments.input, "not enough memory for " + what);
    }
}

std::string nameLevel(Arguments const &arguments) {
    return arguments.adaptive.isAdaptive
               ? "--adaptive up to level " + std::to_string(arguments.adaptive.maxLevel)
               : "level " + std::to_string(arguments.level);
}

/// Does one step behind the other; what a file is to have is in its place before anything is printed.
void refine(Arguments const &arguments) {
    std::optional<Progress> progress(std::in_place, !arguments.isQuiet && Progress::IsTerminal());
    Job job(arguments, *progress);
    withMemoryFor("what the file has", arguments, [&] { job.Read(); });
    withMemoryFor(nameLevel(arguments), arguments, [&] {
        job.Validate();
        job.Refine();
        job.Evaluate();
        job.Draw();
        job.Write();
    });
    progress.reset(); // its line is removed
    report(arguments, job);
}

} // namespace

} // namespace OpenSubdivHex::Tools

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Tools;

    Arguments arguments;
    CLI::App app("Refines a polygon mesh with the hexagonal vertex-to-vertex subdivision scheme.",
                 "hexrefine");
    AddOptions(app, &arguments);
    return RunProgram(app, argc, argv, [&] {
        if (arguments.numThreads) {
            OpenSubdivHex::FarExt::SetNumThreads(*arguments.numThreads);
#ifdef _OPENMP
            omp_set_num_threads(*arguments.numThreads); // of Osd's evaluator
#endif
        }
        if (arguments.simd) {
            setSimdLevel(*arguments.simd);
        }
        refine(arguments);
    });
}

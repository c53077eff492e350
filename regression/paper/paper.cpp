// SPDX-License-Identifier: Apache-2.0
//
// Computes the figures and numbers of the paper (Ghaleb and Abd El-Latif 2005) and writes them as
// one self-contained HTML page.
#include "page.h"
#include "sections.h"
#include "settings.h"

#include "tools/mesh/outputFile.h"
#include "tools/mesh/program.h"

#include <chrono>
#include <cstdio>

namespace OpenSubdivHex::Regression {

namespace {

void addOptions(CLI::App &app, std::string *output, Settings *settings) {
    auto const addNumber = [&](char const *option, int *value, int low, int high,
                               char const *text) {
        app.add_option(option, *value, text)->check(CLI::Range(low, high))->capture_default_str();
    };
    app.add_option("-o,--output", *output, "Page to write")->type_name("FILE")->required();
    addNumber("--width", &settings->pictureWidth, 8, 4000, "Width of each picture in pixels");
    addNumber("--samples", &settings->numSamples, 1, 4096, "Samples per pixel");
    addNumber("--solid-level", &settings->solidLevel, 1, 8, "Levels of the pentagonal solid");
    addNumber("--mask-level", &settings->maskLevel, 1, 8, "Level of the pictures of the masks");
    addNumber("--smoothness-level", &settings->smoothnessLevel, 2, 8, "Levels measured on meshes");
    addNumber("--curvature-level", &settings->curvatureLevel, 2, 9,
              "Levels measured at irregular vertices");
    addNumber("--timing-level", &settings->timingLevel, 1, 9, "Levels that are timed");
    addNumber("--rounds", &settings->numRounds, 1, 1000, "Rounds of each timing");
}

std::string makePage(Settings const &settings) {
    Page page(
        "Hexagonal vertex-to-vertex subdivision: the paper, recomputed",
        "Ghaleb and Abd El-Latif (2005) propose a subdivision scheme that keeps every vertex, "
        "makes a smaller copy of every face and a hexagon of every edge.  This page recomputes "
        "their figures and numbers, measures what they claim, and sets the scheme beside "
        "Doo-Sabin, tri-hex corner cutting, Catmull-Clark and Loop.  Everything below was "
        "computed in one run.");
    struct Section {
        char const *name;
        void (*add)(Page *, Settings const &);
    };
    for (auto const &[name, add] :
         {Section{"pentagonal solid", AddSolidSection}, Section{"control meshes", AddMeshSection},
          Section{"factors", AddFactorSection}, Section{"counts", AddCountSection},
          Section{"eigenvalues", AddEigenvalueSection}, Section{"smoothness", AddSmoothnessSection},
          Section{"irregular vertices", AddTipSection}, Section{"evenness", AddEvennessSection},
          Section{"models", AddModelSection}, Section{"masks", AddMaskSection},
          Section{"running time", AddTimingSection}, Section{"stage 3", AddCoplanarSection}}) {
        auto const start = std::chrono::steady_clock::now();
        add(&page, settings);
        std::chrono::duration<double> const seconds = std::chrono::steady_clock::now() - start;
        std::printf("%-20s %6.1f s\n", name, seconds.count());
        std::fflush(stdout);
    }
    return page.Finish();
}

} // namespace

} // namespace OpenSubdivHex::Regression

int main(int argc, char **argv) {
    using namespace OpenSubdivHex;

    std::string output;
    Regression::Settings settings;
    CLI::App app("Writes the report on the paper.", "paper");
    Regression::addOptions(app, &output, &settings);
    return Tools::RunProgram(app, argc, argv, [&] {
        Tools::OutputFile file(output); // fails before the work, not after it
        file.Write(Regression::makePage(settings));
        file.Commit();
    });
}

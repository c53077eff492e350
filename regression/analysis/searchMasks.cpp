// SPDX-License-Identifier: Apache-2.0
//
// Finds the tables of FaceMask::Smooth that were fitted again, each from its conditions, and prints them beside what the
// library has.
//
// A search finds a local optimum.  Where the library's table is another one, the weights are far apart, and the
// measures tell how good each is.
#include "leastSquares.h"
#include "lineMaskSearch.h"
#include "maskSearch.h"
#include "quadLineSearch.h"
#include "quadMaskSearch.h"
#include "searchPatchConstants.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

using namespace OpenSubdivHex::Regression;

namespace {

struct Effort {
    int quadLevel;
    int maxQuadSteps;
    int maskLevel;
    int maxMaskSteps;
    int lineLevel;
    int maxLineSteps;
    int maxPatchRounds;
};
constexpr Effort kWhole = {6, 60, 5, 30, 5, 40, 8};
constexpr Effort kQuick = {5, 2, 3, 1, 4, 1, 0};

using Weights = Eigen::VectorXd;
using Entries = std::vector<std::pair<std::string, double>>;

/// A table in the forms that all have.
struct TableFit {
    Weights shipped;
    Weights start;
    int maxSteps;
    std::function<Weights(Weights const &)> measure;
    std::function<Weights(Weights const &)> round;
    std::function<Entries(Weights const &)> judge;
    std::function<void(Weights const &)> print;
};

void run(TableFit const &fit) {
    auto const show = [&fit](char const *title, Weights const &weights) {
        std::printf("%-24s %.5f", title, fit.measure(weights).norm());
        for (auto const &[name, value] : fit.judge(weights)) {
            std::printf("; %s %.4f", name.c_str(), value);
        }
        std::printf("\n");
        std::fflush(stdout);
    };
    show("in the library", fit.shipped);
    show("where the search begins", fit.start);
    Weights const found = FindLeastSquares(fit.start, fit.maxSteps, fit.measure);
    show("found", found);
    if (!(fit.measure(found).norm() < fit.measure(fit.start).norm())) {
        throw std::runtime_error("the search finds nothing better than where it begins");
    }
    Weights const rounded = fit.round(found);
    show("rounded", rounded);
    Weights const apart = rounded - fit.shipped;
    std::printf("apart from the library's by %.4f, the root of the mean square, and %.4f at most\n",
                std::sqrt(apart.squaredNorm() / double(apart.size())), apart.cwiseAbs().maxCoeff());
    fit.print(rounded);
}

void searchTable(TableSearch const &search, int maxSteps) {
    run({search.GetShipped(), search.GetStart(), maxSteps,
         [&](Weights const &weights) { return search.Measure(weights); },
         [&](Weights const &weights) { return search.Round(weights); },
         [&](Weights const &weights) {
             Entries entries;
             for (TableSearch::Entry const &entry : search.Judge(weights)) {
                 entries.emplace_back(entry.name, entry.unevenness);
             }
             return entries;
         },
         [&](Weights const &weights) { search.Print(weights); }});
}

void searchMasks(SearchedMasks const &searched, Effort const &effort) {
    MaskJudge judge(searched, effort.maskLevel);
    run({GetShippedWeights(searched), GetPlainWeights(searched), effort.maxMaskSteps,
         [&](Weights const &weights) { return judge.Measure(weights); },
         [&](Weights const &weights) { return RoundWeights(weights, effort.maxMaskSteps, judge); },
         [&](Weights const &weights) {
             judge.Measure(weights);
             Entries entries;
             for (MaskJudge::Entry const &entry : judge.GetEntries()) {
                 entries.emplace_back(entry.name, entry.unevenness);
             }
             return entries;
         },
         [&](Weights const &weights) { PrintMasks(searched, weights); }});
}

struct Table {
    std::string name;
    std::string where;
    std::function<void(Effort const &)> search;
};

std::vector<Table> makeTables() {
    using OpenSubdivHex::FarExt::FacesAround;
    std::vector<Table> tables;
    for (int numFaces : {4, 3, 5, 6}) {
        tables.push_back(
            {"quads-" + std::to_string(numFaces),
             "far_ext/rules/quadRows.inl: by the paths of flags of vertices with so many quads",
             [=](Effort const &effort) {
                 searchTable(QuadMaskSearch(numFaces, effort.quadLevel), effort.maxQuadSteps);
             }});
    }
    auto const add = [&tables](std::string const &name, char const *where,
                               SearchedMasks const &searched) {
        tables.push_back({name, std::string("far_ext/rules/mask.cpp: ") + where,
                          [=](Effort const &effort) { searchMasks(searched, effort); }});
    };
    add("beside-quads", "where paths tell none", {4, FacesAround::Quads});
    for (int numFaces = 4; numFaces <= 8; ++numFaces) {
        add("vertices-" + std::to_string(numFaces), "around vertices with so many faces",
            {numFaces, FacesAround::Others});
    }
    for (int numFaces = 5; numFaces <= 8; ++numFaces) {
        add("triangles-" + std::to_string(numFaces), "around vertices with so many triangles",
            {numFaces, FacesAround::Triangles});
    }
    tables.push_back({"lines", "far_ext/rules/lineRows.inl: beside lines of truncated meshes",
                      [](Effort const &effort) {
                          searchTable(LineMaskSearch(effort.lineLevel), effort.maxLineSteps);
                      }});
    for (int numQuads = 2; numQuads <= 4; ++numQuads) {
        tables.push_back(
            {"quads-beside-lines-" + std::to_string(numQuads),
             "far_ext/rules/quadLineRows.inl: beside vertices of lines with so many quads",
             [=](Effort const &effort) {
                 searchTable(QuadLineSearch(numQuads, effort.lineLevel), effort.maxLineSteps);
             }});
    }
    for (int steps = 0; steps <= 2; ++steps) {
        tables.push_back(
            {"patches-" + std::to_string(steps),
             "far_ext/patch/patchConstants.inl: so many steps behind the surface level",
             [=](Effort const &effort) { SearchPatchConstants(steps, effort.maxPatchRounds); }});
    }
    return tables;
}

} // namespace

int main(int argc, char **argv) {
    std::vector<Table> const tables = makeTables();
    std::vector<std::string> wanted(argv + 1, argv + argc);
    bool const isQuick = !wanted.empty() && wanted[0] == "--quick";
    if (isQuick) {
        wanted.erase(wanted.begin());
    }
    if (wanted.empty()) {
        std::printf("usage: searchMasks [--quick] all | TABLE...\n\n");
        for (Table const &table : tables) {
            std::printf("  %-20s %s\n", table.name.c_str(), table.where.c_str());
        }
        std::printf("\nAll take some minutes; --quick ends each search after a few steps.\n");
        return 2;
    }
    for (std::string const &name : wanted) {
        bool isKnown = false;
        for (Table const &table : tables) {
            if (name == "all" || name == table.name) {
                isKnown = true;
                std::printf("\n%s, in %s\n", table.name.c_str(), table.where.c_str());
                std::fflush(stdout);
                try {
                    table.search(isQuick ? kQuick : kWhole);
                } catch (std::exception const &error) {
                    std::fprintf(stderr, "searchMasks: %s: %s\n", table.name.c_str(), error.what());
                    return 1;
                }
            }
        }
        if (!isKnown) {
            std::fprintf(stderr, "searchMasks: there is no table %s\n", name.c_str());
            return 2;
        }
    }
    return 0;
}

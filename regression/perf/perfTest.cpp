// SPDX-License-Identifier: Apache-2.0
//
// Runs all benchmarks at tiny sizes and looks for every figure in the results; speed is not tested.
#include "rows.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression::perfTest {
namespace {

using Json = nlohmann::json;

std::string readFile(std::string const &path) {
    std::ostringstream content;
    content << std::ifstream(path).rdbuf();
    return content.str();
}

bool isMeasurable(std::string const &row) {
    bool const needsCgal = row == "positions-cgal";
#ifdef PERF_HAS_CGAL
    bool const hasCgal = true;
#else
    bool const hasCgal = false;
#endif
#if defined(OPENSUBDIV_HAS_OPENMP) && defined(_OPENMP)
    bool const hasOmpEvaluator = true;
#else
    bool const hasOmpEvaluator = row.rfind("evaluation-2-length", 0) != 0;
#endif
    return (!needsCgal || hasCgal) && hasOmpEvaluator;
}

TEST(Perf, VerdictsFollowTheBounds) {
    Row const ratio{"ratio", "", "", 5, 10};
    EXPECT_EQ(GetVerdict(ratio, 4.99), "below");
    EXPECT_EQ(GetVerdict(ratio, 5), "at least");
    EXPECT_EQ(GetVerdict(ratio, 9.99), "at least");
    EXPECT_EQ(GetVerdict(ratio, 10), "aim");
    EXPECT_EQ(GetVerdict(ratio, std::nan("")), "below");
    Row const limit{"limit", "", "", 1.4, 1.15, true};
    EXPECT_EQ(GetVerdict(limit, 1.41), "below");
    EXPECT_EQ(GetVerdict(limit, 1.4), "at least");
    EXPECT_EQ(GetVerdict(limit, 1.15), "aim");
    EXPECT_EQ(GetVerdict(limit, std::nan("")), "below");
}

TEST(Perf, RowsHaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (std::vector<Row> const *rows : {&GetRows(), &GetDeviceRows(), &GetPythonRows()}) {
        for (Row const &row : *rows) {
            EXPECT_TRUE(names.insert(row.name).second) << row.name;
            EXPECT_TRUE(row.isUpperBound ? row.aim <= row.atLeast : row.aim >= row.atLeast)
                << row.name;
        }
    }
    EXPECT_THROW(GetRow("topology"), std::out_of_range);
}

TEST(Perf, QuickRunHasEveryFigure) {
    std::string const folder = testing::TempDir() + "perfTest";
    std::filesystem::create_directories(folder);
    std::string const jsonPath = folder + "/results.json";
    std::string const markdownPath = folder + "/results.md";
    ASSERT_EQ(
        std::system(("\"" PERF_PROGRAM "\" --quick --json \"" + jsonPath + "\" --markdown \"" +
                     markdownPath + "\" >\"" + folder + "/out\" 2>\"" + folder + "/log\"")
                        .c_str()),
        0)
        << readFile(folder + "/log");
    std::string const markdown = readFile(markdownPath);
    EXPECT_EQ(markdown, readFile(folder + "/out"));
    Json const json = Json::parse(readFile(jsonPath));

    ASSERT_EQ(json["rows"].size(), GetRows().size());
    for (std::size_t i = 0; i < GetRows().size(); ++i) {
        Row const &row = GetRows()[i];
        Json const &entry = json["rows"][i];
        EXPECT_EQ(entry["name"], row.name);
        EXPECT_EQ(entry["atLeast"], row.atLeast);
        EXPECT_EQ(entry["aim"], row.aim);
        EXPECT_NE(markdown.find("| " + row.work + " "), std::string::npos) << row.name;
        if (!isMeasurable(row.name)) {
            EXPECT_TRUE(entry["figures"].empty()) << row.name;
            continue;
        }
        std::set<std::string> settings;
        for (Json const &figure : entry["figures"]) {
            settings.insert(figure["mesh"].get<std::string>() + " " +
                            figure["size"].get<std::string>() + " " +
                            figure["memory"].get<std::string>());
            // A tiny table may lie on pages that were there before, and not all systems tell.
            bool const isPeak = row.name == "table-peak";
            bool const isMeasured = figure["figure"].is_number();
            ASSERT_TRUE(isMeasured || isPeak) << row.name << figure;
            if (isMeasured) {
                EXPECT_TRUE(figure["figure"] > 0 || isPeak) << row.name << figure;
                EXPECT_EQ(figure["verdict"], GetVerdict(row, figure["figure"])) << row.name;
            }
        }
        if (row.name == "view-pole") {
            EXPECT_EQ(settings, std::set<std::string>{"pole small default"});
            continue;
        }
        bool const isResident = settings.count("quad small resident") > 0;
        bool const isOfBase = row.name == "busy-base" ||
                              (row.name.rfind("base-", 0) == 0 && row.name != "base-face-map");
        for (std::string const mesh : {"quad", "triangle", "hexagon"}) {
            if (isOfBase && mesh == "hexagon") {
                continue; // people have meshes of quads and of triangles
            }
            for (std::string const size : {"small", "large"}) {
                std::string const meshSize = std::string(mesh).append(" ").append(size);
                if (isResident) {
                    EXPECT_EQ(settings.count(meshSize + " resident"), 1u) << row.name;
                } else {
                    EXPECT_EQ(settings.count(meshSize + " default"), 1u) << row.name;
#ifdef __GLIBC__
                    EXPECT_EQ(settings.count(meshSize + " warm"), row.isUpperBound ? 0u : 1u)
                        << row.name;
#endif
                }
            }
        }
    }

    std::set<std::string> growths;
    bool isCopyMeasured = false;
    for (Json const &cost : json["costs"]) {
        EXPECT_GT(cost["nanoseconds"], 0) << cost;
        // The bytes that surfaces move are not counted.
        if (cost["work"].get<std::string>().find("surfaces") == std::string::npos) {
            EXPECT_GT(cost["shareOfCopyBandwidth"], 0) << cost;
        }
        isCopyMeasured = isCopyMeasured || cost["work"] == "copy";
        std::string const size = cost["size"];
        if (size.rfind("level", 0) == 0) {
            growths.insert(cost["work"].get<std::string>() + " " + size);
        }
    }
    EXPECT_TRUE(isCopyMeasured);
    EXPECT_EQ(growths.size(), 8u);
}

#ifdef PERF_PYTHON
/// Rows of Blender are measured inside Blender alone.
TEST(Perf, QuickRunOfPythonHasEveryFigure) {
    std::string const folder = testing::TempDir() + "perfTest";
    std::filesystem::create_directories(folder);
    std::string const measured = folder + "/measured.json";
    std::string const json = folder + "/python.json";
    ASSERT_EQ(std::system(("\"" PERF_PYTHON "\" \"" PERF_PYTHON_BENCHMARK
                           "\" --quick --modules \"" PERF_MODULES_DIR
                           "\" --native \"" PERF_NATIVE_PEER "\" --json \"" +
                           measured + "\" 2>\"" + folder + "/log\"")
                              .c_str()),
              0)
        << readFile(folder + "/log");
    std::string const report = "\"" PERF_PROGRAM "\" --json \"" + json + "\" --measured ";
    ASSERT_EQ(std::system((report + "\"" + measured + "\" >\"" + folder + "/out\"").c_str()), 0);
    std::string const markdown = readFile(folder + "/out");
    Json const results = Json::parse(readFile(json));
    ASSERT_EQ(results["rows"].size(), GetPythonRows().size());
    for (std::size_t i = 0; i < GetPythonRows().size(); ++i) {
        Row const &row = GetPythonRows()[i];
        Json const &entry = results["rows"][i];
        EXPECT_EQ(entry["name"], row.name);
        EXPECT_NE(markdown.find("| " + row.work + " "), std::string::npos) << row.name;
        bool const isOfBlender = row.peer == "Blender's subdivision";
        EXPECT_EQ(entry["figures"].size(), isOfBlender ? 0u : 2u) << row.name;
        for (Json const &figure : entry["figures"]) {
            EXPECT_GT(figure["figure"], 0) << row.name;
        }
    }

    // Files that are not of this form.
    std::ofstream(measured) << R"({"environment": {}, "conditions": "", "contests": [{}]})";
    EXPECT_NE(std::system((report + "\"" + measured + "\" >/dev/null 2>&1").c_str()), 0);
    EXPECT_NE(std::system((report + "\"" + folder + "/none\" >/dev/null 2>&1").c_str()), 0);
}

TEST(Perf, FiguresAreMediansOfTheRatiosOfTurns) {
    std::string const folder = testing::TempDir() + "perfTest";
    std::filesystem::create_directories(folder);
    std::string const measured = folder + "/turns.json";
    std::string const json = folder + "/turns.results.json";
    std::ofstream(measured)
        << R"({"environment": {"Python": "3"}, "conditions": "none", "contests": [
        {"work": "table", "item": "weight", "mesh": "quad", "size": "small", "level": 3,
         "memory": "default", "pairings": [{"row": "python-table", "own": 0, "peer": 1}],
         "contestants": [{"who": "Python", "threads": 1, "items": 4, "seconds": [1, 2, 8]},
                         {"who": "C++", "threads": 1, "items": 4, "seconds": [3, 3, 4]}]}]})";
    ASSERT_EQ(std::system(("\"" PERF_PROGRAM "\" --json \"" + json + "\" --measured \"" + measured +
                           "\" >/dev/null")
                              .c_str()),
              0);
    Json const results = Json::parse(readFile(json));
    EXPECT_EQ(results["environment"]["Python"], "3");
    EXPECT_EQ(results["rows"][1]["figures"][0]["figure"], 1.5);
    EXPECT_EQ(results["costs"][0]["nanoseconds"], 0.5e9);
    EXPECT_EQ(results["costs"][1]["nanoseconds"], 0.75e9);
}
#endif

TEST(Perf, RefusesBadUsage) {
    for (std::string const arguments : {"--turns 0", "--turns x", "--unknown", "--filter '('"}) {
        EXPECT_NE(
            std::system(("\"" PERF_PROGRAM "\" --quick " + arguments + " >/dev/null 2>&1").c_str()),
            0)
            << arguments;
    }
}

} // namespace
} // namespace OpenSubdivHex::Regression::perfTest

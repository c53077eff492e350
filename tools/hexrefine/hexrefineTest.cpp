// SPDX-License-Identifier: Apache-2.0
//
// Runs the program hexrefine as its users do.
#include "programFixture.h"

#include "far_ext/version.h"
#include "osd_ext/simdLevel.h"

#include <algorithm>
#include <sstream>

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define HAS_ADDRESS_SANITIZER
#endif
#endif

namespace OpenSubdivHex::Tools::hexrefineTest {

TEST_F(Hexrefine, PrintsHelpAndVersion) {
    Result const help = run("--help");
    EXPECT_EQ(help.status, 0);
    for (char const *option :
         {"INPUT", "-l,--level", "-o,--output", "--mask", "--scheme", "--first-step", "--coplanar",
          "--tolerance", "--open-gaps", "--boundary", "--crease-angle", "--fvar-interpolation",
          "--tags", "--evaluator", "--threads", "--simd", "--stats", "--quiet", "--version"}) {
        EXPECT_NE(help.out.find(option), std::string::npos) << option;
    }
    EXPECT_EQ(run("--version").out, "hexrefine " OPENSUBDIVHEX_VERSION "\n");
}

TEST_F(Hexrefine, HelpHasGroupsExamplesAndLinesOfAHundredCharacters) {
    std::string const help = run("--help").out;
    std::size_t last = 0;
    for (char const *group : {"\nFiles:\n", "\nRefinement:\n", "\nRefinement for a camera:\n",
                              "\nSurface:\n", "\nComputation:\n", "\nReport:\n", "\nExamples:\n"}) {
        std::size_t const place = help.find(group);
        ASSERT_NE(place, std::string::npos) << group;
        EXPECT_GT(place, last) << group;
        last = place;
    }
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LT(line.size(), 100u) << line;
    }
}

TEST_F(Hexrefine, IsLikeRenderers) {
    std::string const cube = makeCubeFile();
    auto const getRules = [&](std::string const &arguments) {
        Json const json = Json::parse(run(arguments + " --quiet --stats -").out);
        return json["mask"].get<std::string>() + " " + json["boundary"].get<std::string>() + " " +
               json["firstStep"].get<std::string>() + " " +
               json["fvarInterpolation"].get<std::string>();
    };
    EXPECT_EQ(getRules(cube), "average none none all");
    EXPECT_EQ(getRules(cube + " --like paper"), "average none none all");
    EXPECT_EQ(getRules(cube + " --like renderer"), "smooth edge-and-corner none boundaries");
    std::string const triangles = makeFile("triangles.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                                            "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    EXPECT_EQ(getRules(triangles), "average none none all");
    EXPECT_EQ(getRules(triangles + " --like renderer"),
              "smooth edge-and-corner truncate boundaries");
    // Options, and the rules in the file, take precedence over --like.
    EXPECT_EQ(getRules(triangles + " --like renderer --mask cosine --first-step none --boundary "
                                   "edge-only --fvar-interpolation corners-only"),
              "cosine edge-only none corners-only");
    std::string const tagged =
        makeFile("tagged.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
                               "t interpolateboundary 1/0/0 2\n"
                               "t facevaryinginterpolateboundary 1/0/0 1\n");
    EXPECT_EQ(getRules(tagged + " --like renderer"), "smooth edge-only none corners-only");
    expectBadUsage(cube + " --like renderer --scheme doo-sabin",
                   "--like: renderer is not for --scheme doo-sabin");
    expectBadUsage(cube + " --like renderer --coplanar", "--like: renderer is not for --coplanar");
    expectBadUsage(cube + " --like film", "--like");
}

TEST_F(Hexrefine, HintsAtWhatIsLikelyWrong) {
    std::string const begin = "hexrefine: ";
    auto const getHints = [&](std::string const &path, std::string const &arguments) {
        Result const result = run(path + " " + arguments);
        EXPECT_EQ(result.status, 0);
        std::string const prefix = begin + path + ": hint: ";
        std::vector<std::string> hints;
        std::istringstream lines(result.error);
        for (std::string line; std::getline(lines, line);) {
            EXPECT_EQ(line.rfind(prefix, 0), 0u) << line;
            hints.push_back(line.substr(std::min(line.size(), prefix.size())));
        }
        return hints;
    };
    auto const expectHint = [&](std::string const &path, std::string const &arguments,
                                std::string const &hint) {
        std::vector<std::string> const hints = getHints(path, arguments);
        ASSERT_EQ(hints.size(), 1u) << arguments;
        EXPECT_EQ(hints[0].rfind(hint, 0), 0u) << hints[0];
    };
    std::string const cube = makeCubeFile();
    EXPECT_TRUE(getHints(cube, "-l 3").empty());
    expectHint(cube, "-l 4", "with --mask average curvature grows from level to level");
    for (char const *silent : {"--mask average", "--mask smooth", "--like renderer", "--quiet"}) {
        EXPECT_TRUE(getHints(cube, std::string("-l 4 ") + silent).empty()) << silent;
    }
    std::string const triangles = makeFile("triangles.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                                            "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    EXPECT_TRUE(getHints(triangles, "-l 0").empty());
    expectHint(triangles, "-l 1", "the faces are triangles");
    EXPECT_TRUE(getHints(triangles, "--first-step none").empty());
    EXPECT_TRUE(getHints(triangles, "--like renderer").empty());
    // Two quads beside each other, with four vertices each; with six there is nothing to weld.
    std::string const apart =
        makeFile("apart.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\n"
                              "v 1 1 0\nf 1 2 3 4\nf 5 6 7 8\n");
    expectHint(apart, "", "8 of 8 edges are open, and 8 vertices lie at 6 places: weld");
    std::string const welded =
        makeFile("welded.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                               "f 1 2 3 4\nf 2 5 6 3\n");
    EXPECT_TRUE(getHints(welded, "").empty());
    // Two quads that meet in vertex 2.
    std::string const bow =
        makeFile("bow.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\n"
                            "f 1 2 3 4\nf 3 5 6 7\n");
    expectHint(bow, "", "vertex 2 (counted from 0) is non-manifold");
}

TEST_F(Hexrefine, RefinesCube) {
    makeCubeFile();
    Result const result = run(getPath("cube.obj") + " -l 3 -o " + getPath("out.off"));
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.error, "");
    EXPECT_NE(result.out.find("512         768         258"), std::string::npos) << result.out;
    Mesh const mesh = ReadMesh(getPath("out.off"));
    EXPECT_EQ(mesh.GetNumVertices(), 512);
    EXPECT_EQ(mesh.GetNumFaces(), 258);
    expectClosed(mesh);
}

TEST_F(Hexrefine, PrintsStatisticsAsPromised) {
    std::string const input = makeCubeFile();
    Result const result = run(input + " -l 2 --mask cosine --evaluator stencil --stats -");
    EXPECT_EQ(result.status, 0);
    Json const json = Json::parse(result.out);
    std::vector<std::string> keys;
    for (auto const &item : json.items()) {
        keys.push_back(item.key());
    }
    EXPECT_EQ(keys, (std::vector<std::string>{"scheme",
                                              "mask",
                                              "boundary",
                                              "evaluator",
                                              "input",
                                              "levels",
                                              "milliseconds",
                                              "stencils",
                                              "weights",
                                              "peakMemoryBytes",
                                              "creasingMethod",
                                              "creases",
                                              "corners",
                                              "holes",
                                              "fvarInterpolation",
                                              "fvarChannels",
                                              "fvarChannelsLeftOut",
                                              "firstStep",
                                              "coplanar",
                                              "adaptive",
                                              "vertexProperties",
                                              "faceProperties",
                                              "objects",
                                              "groups",
                                              "materials",
                                              "smoothingGroups",
                                              "materialLibraries",
                                              "notRead",
                                              "notWritten"}));
    EXPECT_EQ(json["scheme"], "hex");
    EXPECT_EQ(json["firstStep"], "none");
    EXPECT_TRUE(json["coplanar"].is_null());
    EXPECT_EQ(json["mask"], "cosine");
    EXPECT_EQ(json["boundary"], "none");
    EXPECT_EQ(json["evaluator"], "stencil");
    EXPECT_EQ(json["input"], input);
    EXPECT_EQ(json["levels"].dump(),
              R"([{"level":0,"vertices":8,"edges":12,"faces":6,"corners":24,"boundaryEdges":0,)"
              R"("facesBySize":{"4":6}},)"
              R"({"level":1,"vertices":32,"edges":48,"faces":18,"corners":96,"boundaryEdges":0,)"
              R"("facesBySize":{"4":6,"6":12}},)"
              R"({"level":2,"vertices":128,"edges":192,"faces":66,"corners":384,)"
              R"("boundaryEdges":0,"facesBySize":{"4":6,"6":60}}])");
    for (char const *phase :
         {"read", "validate", "refine", "stencils", "evaluate", "write", "render"}) {
        EXPECT_GE(json["milliseconds"][phase].get<double>(), 0) << phase;
    }
    EXPECT_EQ(json["stencils"], 128);
    EXPECT_GT(json["weights"].get<int>(), 128);
    EXPECT_GT(json["peakMemoryBytes"].get<double>(), 1e6);
    EXPECT_EQ(json["creasingMethod"], "uniform");
    EXPECT_EQ(json["creases"], 0);
    EXPECT_EQ(json["corners"], 0);
    EXPECT_EQ(json["holes"].dump(), "[0,0,0]");
    EXPECT_EQ(json["fvarInterpolation"], "all");
    EXPECT_EQ(json["fvarChannels"].dump(), "[]");
    EXPECT_EQ(json["fvarChannelsLeftOut"].dump(), "[]");
    for (char const *key : {"vertexProperties", "faceProperties", "objects", "groups", "materials",
                            "smoothingGroups", "materialLibraries", "notRead", "notWritten"}) {
        EXPECT_EQ(json[key].dump(), "[]") << key;
    }
    EXPECT_EQ(listFiles(), std::vector<std::string>{"cube.obj"});

    Json const byDefault = Json::parse(run(input + " --stats -").out);
    EXPECT_EQ(byDefault["evaluator"], "refinement");
    EXPECT_EQ(byDefault["stencils"], 0);
    EXPECT_EQ(byDefault["weights"], 0);
}

TEST_F(Hexrefine, RefinesByOtherSchemes) {
    std::string const input = makeCubeFile();
    struct Case {
        char const *arguments;
        int numVertices, numFaces; ///< at level 2, of 8 vertices, 12 edges, 6 faces
    };
    for (Case const &expected : {Case{"--scheme hexagonal", 128, 66},
                                 {"--scheme hex", 128, 66},
                                 {"--scheme doo-sabin", 96, 98},
                                 {"--scheme tri-hex", 72, 38},
                                 {"--first-step tri-hex", 96, 50},
                                 {"--scheme doo-sabin --first-step tri-hex", 72, 74}}) {
        SCOPED_TRACE(expected.arguments);
        std::vector<float> positions;
        for (char const *evaluator : {"refinement", "stencil", "primvar"}) {
            Result const result = run(input + " -l 2 " + expected.arguments + " --evaluator " +
                                      evaluator + " -o " + getPath("out.ply"));
            EXPECT_EQ(result.status, 0) << result.error;
            Mesh const mesh = ReadMesh(getPath("out.ply"));
            EXPECT_EQ(mesh.GetNumVertices(), expected.numVertices);
            EXPECT_EQ(mesh.GetNumFaces(), expected.numFaces);
            expectClosed(mesh);
            positions = positions.empty() ? mesh.positions : positions;
            ASSERT_EQ(mesh.positions.size(), positions.size());
            for (std::size_t i = 0; i < positions.size(); ++i) {
                ASSERT_NEAR(mesh.positions[i], positions[i], 1e-6);
            }
        }
    }
    Json const json =
        Json::parse(run(input + " --scheme tri-hex --first-step tri-hex --stats -").out);
    EXPECT_EQ(json["scheme"], "tri-hex");
    EXPECT_EQ(json["firstStep"], "tri-hex");
    EXPECT_NE(run(input + " --scheme doo-sabin").out.find("scheme doo-sabin, mask"),
              std::string::npos);
}

TEST_F(Hexrefine, RefinesCoplanarFaces) {
    // A quad of the cube cut in four; all else as it was.
    std::string const input =
        makeFile("cut.obj", "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\n"
                            "v -1 1 1\nv 1 1 1\nv 0 0 1\nv 0 -1 1\nv 1 0 1\nv 0 1 1\nv -1 0 1\n"
                            "f 1 3 4 2\nf 1 2 6 10 5\nf 2 4 8 11 6\nf 4 3 7 12 8\nf 3 1 5 13 7\n"
                            "f 5 10 9 13\nf 10 6 11 9\nf 9 11 8 12\nf 13 9 12 7\n");
    // V = 13, E = 20, F = 9 and C = 40: 4 edges are flat, all of which meet in the middle, and end
    // in a vertex with one run each.
    std::string const output = getPath("out.off");
    EXPECT_EQ(run(input + " --coplanar -o " + output).status, 0);
    Mesh mesh = ReadMesh(output);
    EXPECT_EQ(mesh.GetNumVertices(), 13 - 1 + 40);
    EXPECT_EQ(mesh.GetNumFaces(), 9 + 20 + 4 + 1);
    expectClosed(mesh);
    Result const open = run(input + " --coplanar --open-gaps --tolerance 1.5 -o " + output);
    EXPECT_EQ(open.status, 0);
    EXPECT_NE(open.out.find("scheme hex, coplanar within 1.5 degrees, gaps open, mask"),
              std::string::npos)
        << open.out;
    EXPECT_EQ(ReadMesh(output).GetNumFaces(), 9 + 20);
    // All edges: Doo-Sabin.
    EXPECT_EQ(run(input + " --coplanar --tolerance 91 -o " + output).status, 0);
    mesh = ReadMesh(output);
    EXPECT_EQ(run(input + " --scheme doo-sabin -o " + output).status, 0);
    EXPECT_EQ(mesh.positions, ReadMesh(output).positions);
    EXPECT_EQ(mesh.faceVertices, ReadMesh(output).faceVertices);
    Json const json = Json::parse(run(input + " --coplanar --stats -").out);
    EXPECT_EQ(json["coplanar"].dump(), R"({"tolerance":0.1,"openGaps":false})");
    EXPECT_EQ(json["levels"][1]["faces"], 34);
}

TEST_F(Hexrefine, OtherSchemesRefuseFeatures) {
    std::string const cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    std::string path = makeFile("uv.obj", cube + "vt 0 0\nf 1/1 2/1 3/1 4/1\n");
    expectFailure(path + " --scheme doo-sabin", path, "face-varying");
    // Without them where the output has no place for them.
    EXPECT_EQ(run(path + " --scheme doo-sabin -o " + getPath("out.ply")).status, 0);
    path = makeFile("crease.obj", cube + "v 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n"
                                         "t crease 2/1/0 1 2 3\n");
    expectFailure(path + " --scheme tri-hex", path, "is a crease");
    expectFailure(path + " --first-step tri-hex", path, "is a crease");
    EXPECT_EQ(run(path).status, 0);
}

TEST_F(Hexrefine, WritesStatisticsToFile) {
    std::string const input = makeCubeFile();
    Result const result = run(input + " -l 1 --quiet --stats " + getPath("stats.json"));
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out + result.error, "");
    EXPECT_EQ(Json::parse(getContent(getPath("stats.json")))["levels"].size(), 2u);
    EXPECT_EQ(listFiles(), (std::vector<std::string>{"cube.obj", "stats.json"}));
}

TEST_F(Hexrefine, LevelZeroCopies) {
    for (char const *evaluator : {"refinement", "stencil", "stencil-cpu", "primvar"}) {
        Result const result = run(std::string(LANTERN_FILE) + " -l 0 --quiet --evaluator " +
                                  evaluator + " -o " + getPath("copy.ply"));
        EXPECT_EQ(result.status, 0) << result.error;
        Mesh const input = ReadMesh(LANTERN_FILE);
        Mesh const copy = ReadMesh(getPath("copy.ply"));
        EXPECT_EQ(copy.positions, input.positions);
        EXPECT_EQ(copy.faceSizes, input.faceSizes);
        EXPECT_EQ(copy.faceVertices, input.faceVertices);
    }
}

/// The names of --evaluator in this program.
std::vector<std::string> getEvaluators() {
    return {"refinement", "stencil", "stencil-cpu",
#ifdef HEXREFINE_HAS_OPENMP
            "stencil-omp",
#endif
            "primvar"};
}

TEST_F(Hexrefine, EvaluatorsAgree) {
    for (char const *mask : {"average", "cosine", "smooth"}) {
        std::vector<Mesh> meshes;
        for (std::string const &evaluator : getEvaluators()) {
            Result const result = run(std::string(LANTERN_FILE) + " -l 3 --quiet --mask " + mask +
                                      " --evaluator " + evaluator + " -o " + getPath("out.ply"));
            ASSERT_EQ(result.status, 0) << result.error;
            meshes.push_back(ReadMesh(getPath("out.ply")));
            EXPECT_EQ(meshes.back().faceVertices, meshes[0].faceVertices);
            ASSERT_EQ(meshes.back().positions.size(), meshes[0].positions.size());
            for (std::size_t i = 0; i < meshes[0].positions.size(); ++i) {
                ASSERT_NEAR(meshes.back().positions[i], meshes[0].positions[i], 1e-5) << evaluator;
            }
        }
        expectClosed(meshes[0]);
    }
}

TEST_F(Hexrefine, ThreadsDoNotChangeTheOutput) {
    std::string const input = std::string(LANTERN_FILE) + " -l 4 --quiet";
    for (char const *name : {"out.obj", "out.off", "out.ply"}) {
        std::string const output = " -o " + getPath(name);
        ASSERT_EQ(run(input + output).status, 0);
        std::string const expected = getContent(getPath(name));
        for (std::string const number : {"1", "2", "3"}) {
            Result const result = run(input + output + " --threads " + number);
            ASSERT_EQ(result.status, 0) << result.error;
            EXPECT_TRUE(getContent(getPath(name)) == expected) << name << number;
        }
    }
    for (std::string const &evaluator : getEvaluators()) {
        std::string const options = " --evaluator " + evaluator + " -o " + getPath("out.ply");
        ASSERT_EQ(run(input + options + " --threads 1").status, 0);
        std::string const expected = getContent(getPath("out.ply"));
        for (std::string const number : {"1", "2", "3"}) {
            ASSERT_EQ(run(input + options + " --threads " + number).status, 0);
            EXPECT_TRUE(getContent(getPath("out.ply")) == expected) << evaluator << number;
        }
    }
}

TEST_F(Hexrefine, SimdChoosesTheKernel) {
    std::string const output = " -l 3 --quiet -o " + getPath("out.ply");
    auto const refine = [&](std::string const &options, std::string const &before = "") {
        Result const result = run(LANTERN_FILE + output + options, before);
        EXPECT_EQ(result.status, 0) << result.error;
        return getContent(getPath("out.ply"));
    };
    using OsdExt::SimdLevel;
    SimdLevel const max = OsdExt::GetMaxSimdLevel();
    std::string const stencil = " --evaluator stencil";
    std::string const highest = refine(stencil);
    for (SimdLevel const level : {SimdLevel::Portable, SimdLevel::Avx2, SimdLevel::Avx512}) {
        std::string const name = OsdExt::GetSimdLevelName(level);
        std::string const option = " --simd " + name;
        std::string const variable = "OPENSUBDIVHEX_SIMD=" + name + " ";
        if (level > max) {
            expectBadUsage(LANTERN_FILE + output + option, "there is no " + name + " here");
            continue;
        }
        std::string const chosen = refine(stencil + option);
        if (level == max || level == SimdLevel::Portable) {
            // Above portable, products are fused with sums.
            EXPECT_EQ(chosen == highest, level == max) << name;
        }
        EXPECT_TRUE(refine(stencil, variable) == chosen) << name;
        EXPECT_TRUE(refine(stencil + option, "OPENSUBDIVHEX_SIMD=portable ") == chosen) << name;
    }
    Result const result = run(LANTERN_FILE + output, "OPENSUBDIVHEX_SIMD=sse ");
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.error.find("OPENSUBDIVHEX_SIMD"), std::string::npos) << result.error;
    EXPECT_NE(result.error.find("'sse' is not portable, avx2 or avx512"), std::string::npos);
    expectBadUsage(LANTERN_FILE + output + " --simd AVX2", "'AVX2' is not portable");
    std::string const portable = " --simd portable";
    for (char const *evaluator : {"refinement", "primvar", "stencil-cpu"}) {
        expectBadUsage(LANTERN_FILE + output + portable + " --evaluator " + evaluator,
                       "--simd: has no effect on --evaluator " + std::string(evaluator));
    }
    expectBadUsage(LANTERN_FILE + output + portable, "refinement without --limit");
    expectBadUsage(LANTERN_FILE + output + portable + " --limit --evaluator stencil-cpu",
                   "--simd: has no effect");
    refine(portable + " --limit");
    refine(portable + " --limit --evaluator stencil");
}

TEST_F(Hexrefine, LanternIsClosedAndOfFourFaceSizes) {
    Mesh const lantern = ReadMesh(LANTERN_FILE);
    expectClosed(lantern);
    Json const json = Json::parse(run(std::string(LANTERN_FILE) + " -l 4 --stats -").out);
    EXPECT_EQ(json["levels"][0]["facesBySize"].size(), 4u);
    EXPECT_GT(json["levels"][4]["vertices"].get<int>(), 100000);
}

TEST_F(Hexrefine, RefusesBadUsage) {
    std::string const input = makeCubeFile();
    expectBadUsage("", "INPUT");
    expectBadUsage(input + " --level -1", "not a number of steps");
    expectBadUsage(input + " -l two", "not a number of steps");
    expectBadUsage(input + " -l 2.5", "not a number of steps");
    expectBadUsage(input + " -l 99999999999", "not a number of steps");
    expectBadUsage(input + " -o out.stl", "out.stl");
    expectBadUsage(input + " -o out", "out");
    expectBadUsage(input + " --mask best", "best");
    expectBadUsage(input + " --mask smooth --scheme tri-hex", "--mask: has no effect");
    expectBadUsage(input + " --scheme loop", "loop");
    expectBadUsage(input + " --scheme doo-sabin --coplanar", "hexagonal");
    expectBadUsage(input + " --first-step tri-hex --coplanar", "hexagonal");
    expectBadUsage(input + " --tolerance 1", "--coplanar");
    expectBadUsage(input + " --open-gaps", "--coplanar");
    for (char const *angle : {"-1", "181", "nan", "1x"}) {
        expectBadUsage(input + " --coplanar --tolerance " + angle, "is not an angle from 0 to 180");
    }
    expectBadUsage(input + " --boundary edge", "edge");
    for (char const *angle : {"-1", "181", "nan", "right", "90x"}) {
        expectBadUsage(input + " --crease-angle " + angle, "is not an angle from 0 to 180");
    }
    expectBadUsage(input + " --fvar-interpolation linear", "linear");
    expectBadUsage(input + " --tags --stats -", "standard output is taken");
    expectBadUsage(input + " --evaluator gpu", "gpu");
    for (char const *number : {"0", "-1", "1025", "2.5", "two", "99999999999"}) {
        expectBadUsage(input + " --threads " + number, "is not a number of threads, 1 to 1024");
    }
    expectBadUsage(input + " --unknown", "--unknown");
    expectBadUsage(input + " " + input, "");
#ifndef HEXREFINE_HAS_OPENMP
    expectBadUsage(input + " --evaluator stencil-omp", "without OpenMP");
#endif
    EXPECT_EQ(listFiles(), std::vector<std::string>{"cube.obj"});
}

TEST_F(Hexrefine, RefusesBadInput) {
    std::string const output = " -o " + getPath("out.obj");
    expectFailure(getPath("missing.obj") + output, getPath("missing.obj"), "No such file");
    std::string const vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    std::string path = makeFile("index.obj", vertices + "f 1 2 9\n");
    expectFailure(path + output, path, "line 5: vertex index 9");
    path = makeFile("tag.obj", vertices + "f 1 2 3\nt crease 2/1/0 0 3 1\n");
    expectFailure(path + output, path, "line 6: no face has an edge");
    path = makeFile("uv.obj", vertices + "vt 0 0\nf 1/1 2/1 3/1\nf 1 3 4\n");
    expectFailure(path + output, path, "line 7: a corner has no texture coordinate");
    path = makeFile("mesh.stl", "solid\n");
    expectFailure(path + output, path, "is not a");
    path = makeCubeFile();
    expectFailure(path + output + " -l 20", path, "level 14");
    EXPECT_FALSE(std::filesystem::exists(getPath("out.obj")));
}

TEST_F(Hexrefine, WarnsOfInconsistentOrientation) {
    std::string const path = makeFile("flipped.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                                     "f 1 2 3\nf 1 2 4\nf 2 3 4\n");
    Result const result = run(path + " -l 2 --quiet -o " + getPath("out.obj"));
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.error.rfind("hexrefine: " + path + ": warning: ", 0), 0u) << result.error;
    EXPECT_NE(result.error.find("between vertices 0 and 1, of faces 0 and 1"), std::string::npos)
        << result.error;
    EXPECT_EQ(result.error.find('\n'), result.error.size() - 1) << result.error;
    EXPECT_EQ(run(makeCubeFile() + " -o " + getPath("out.obj")).error, "");
    expectFailure(path + " --scheme doo-sabin", path, "non-manifold");
}

TEST_F(Hexrefine, WarnsOfWhatComesApart) {
    std::string const vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 0 -1\n";
    auto const getWarning = [&](std::string const &faces) {
        std::string const path = makeFile("apart.obj", vertices + faces);
        Result const result = run(path + " -l 1");
        EXPECT_EQ(result.status, 0);
        std::string const begin = "hexrefine: " + path + ": warning: ";
        return result.error.substr(result.error.rfind(begin, 0) == 0 ? begin.size() : 0);
    };
    EXPECT_EQ(getWarning("f 1 2 3 4\nf 2 1 5\n"), "");
    // A fin.
    EXPECT_EQ(getWarning("f 1 2 3 4\nf 2 1 5\nf 2 1 6\n"),
              "1 non-manifold edge comes apart, first edge 0 between vertices 0 and 1\n");
    // A face twice, on an edge of another: its own edges are those of two faces in one direction.
    std::string const twice = getWarning("f 2 1 5\nf 1 2 3 4\nf 1 2 3 4\n");
    EXPECT_NE(twice.find("1 non-manifold edge comes apart, first edge 0 between vertices 1 and 0"),
              std::string::npos)
        << twice;
    std::string const degenerate = getWarning("f 1 2 3 4\nf 2 1 5 1\n");
    EXPECT_NE(degenerate.find("1 face has a vertex several times, first face 1\n"),
              std::string::npos)
        << degenerate;
    std::string const flipped = getWarning("f 1 2 3 4\nf 1 2 5\n");
    EXPECT_EQ(flipped.rfind("inconsistent orientation", 0), 0u);
    EXPECT_EQ(flipped.find("come"), std::string::npos);
}

TEST_F(Hexrefine, FailedOutputLeavesNothing) {
    std::string const input = makeCubeFile();
    expectFailure(input + " -o " + getPath("missing/out.obj"), getPath("missing/out.obj"), "");
    expectFailure(input + " --stats " + getPath("missing/stats"), getPath("missing/stats"), "");
#ifdef __unix__
    // A full disk; ulimit counts in blocks of 512 bytes.
    expectFailure(input + " -l 6 -o " + getPath("out.obj"), getPath("out.obj"), "cannot be written",
                  "ulimit -f 8; trap '' XFSZ; ");
#endif
#ifdef __linux__
    EXPECT_EQ(run(input + " --stats /dev/full").status, 1);
#endif
    EXPECT_EQ(listFiles(), std::vector<std::string>{"cube.obj"});
}

#ifdef HEXREFINE_HAS_RENDERER
TEST_F(Hexrefine, MakesAPicture) {
    std::string const path = getPath("cube.png");
    Result const result = run(makeCubeFile() + " -l 2 --png " + path);
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_NE(result.out.find("wrote " + path), std::string::npos) << result.out;
    // The signature, and the width and height in the header, which comes first.
    std::string const content = getContent(path);
    EXPECT_EQ(content.substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(content.substr(16, 8), std::string("\0\0\x03\x20\0\0\x02\x58", 8));
    // A picture of nothing would be a smooth background, and compress to much less.
    EXPECT_GT(content.size(), 50000u);

    expectFailure(makeCubeFile() + " --png " + getPath("none/cube.png"), getPath("none/cube.png"),
                  "");

    EXPECT_EQ(run(makeCubeFile() + " -l 2 --png " + path + " --png-colors base-faces").status, 0);
    EXPECT_NE(getContent(path), content);
    std::string const cube = makeCubeFile();
    expectFailure(cube + " --png " + getPath("none.png") + " --png-colors materials", cube,
                  "has no materials to colour");
    EXPECT_FALSE(std::filesystem::exists(getPath("none.png")));
    expectBadUsage(cube + " --png-colors base-faces", "--png");
    expectBadUsage(cube + " --png " + path + " --png-colors red", "red");
}

// Vertices that no face has, and those of holes alone, have no place in a picture, however far they are.
TEST_F(Hexrefine, PicturesShowWhatFacesHave) {
    std::string const cube = getContent(makeCubeFile());
    std::string const path = getPath("out.png");
    for (std::string const options :
         {" -l 1", " --adaptive --resolution 80x60 --pixel-error 4 --camera 3,4,5,0,0,0"}) {
        std::vector<std::string> contents;
        for (char const *const more :
             {"", "v 200 0 0\nv 1e30 0 0\nv 0 1e30 0\nv 1e30 2 9\nf 10 11 12\nt hole 1/0/0 6\n"}) {
            EXPECT_EQ(run(makeFile("a.obj", cube + more) + options + " --png " + path).status, 0);
            contents.push_back(getContent(path));
        }
        EXPECT_TRUE(contents[0] == contents[1]) << options;
    }
}
#else
TEST_F(Hexrefine, RefusesPicturesWithoutTheRenderer) {
    expectBadUsage(makeCubeFile() + " --png " + getPath("cube.png"), "without Embree");
}
#endif

// AddressSanitizer reserves more memory than the limit before the program begins.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(HAS_ADDRESS_SANITIZER)
TEST_F(Hexrefine, NamesLackOfMemory) {
    std::string const input = makeCubeFile();
    expectFailure(input + " -l 11 -o " + getPath("out.obj"), input,
                  "not enough memory for level 11", "ulimit -v 500000; ");
    EXPECT_EQ(listFiles(), std::vector<std::string>{"cube.obj"});
}

TEST_F(Hexrefine, NamesLackOfMemoryForFilesWithoutEnd) {
    std::string const input = getPath("endless.obj");
    std::filesystem::create_symlink("/dev/zero", input);
    expectFailure(input, input, "not enough memory for what the file has", "ulimit -v 200000; ");
}
#endif

} // namespace OpenSubdivHex::Tools::hexrefineTest

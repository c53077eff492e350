// SPDX-License-Identifier: Apache-2.0
//
// hexrefine --adaptive.
#include "programFixture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace OpenSubdivHex::Tools::adaptiveTest {

namespace {

class HexrefineAdaptive : public Hexrefine {
protected:
    Mesh refine(std::string const &input, std::string const &arguments,
                std::string const &output) const {
        Result const result =
            run("\"" + input + "\" --adaptive --quiet " + arguments + " -o " + getPath(output));
        EXPECT_EQ(result.status, 0) << result.error;
        return ReadMesh(getPath(output));
    }

    /// A strip of two quads of two materials, with texture coordinates that have a seam between them.
    std::string makeStrip(std::string const &more = "") const {
        return makeFile("strip.obj",
                        "v 0 0 0\nv 1 0 0\nv 2 0 1\nv 0 1 0\nv 1 1 0\nv 2 1 1\n"
                        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 5 5\nvt 6 5\nvt 6 6\nvt 5 6\n"
                        "usemtl blue\nf 1/1 2/2 5/3 4/4\n"
                        "usemtl red\nf 2/5 3/6 6/7 5/8\n" +
                            more);
    }
};

/// The areas of faces by material, of fans around their vertices' mean.
std::map<std::string, double> measureMaterials(Mesh const &mesh) {
    std::map<std::string, double> areas;
    auto corner = mesh.faceVertices.begin();
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        int const size = mesh.faceSizes[std::size_t(face)];
        double mean[3] = {};
        for (int i = 0; i < size; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                mean[k] += double(mesh.positions[3 * std::size_t(corner[i]) + k]) / size;
            }
        }
        double area = 0;
        for (int i = 0; i < size; ++i) {
            float const *const p = &mesh.positions[3 * std::size_t(corner[i])];
            float const *const q = &mesh.positions[3 * std::size_t(corner[(i + 1) % size])];
            double cross[3];
            for (int k = 0; k < 3; ++k) {
                int const l = (k + 1) % 3;
                int const m = (k + 2) % 3;
                cross[k] = (double(p[l]) - mean[l]) * (double(q[m]) - mean[m]) -
                           (double(p[m]) - mean[m]) * (double(q[l]) - mean[l]);
            }
            area += std::hypot(cross[0], cross[1], cross[2]) / 2;
        }
        corner += size;
        areas[mesh.labels[std::size_t(mesh.faceLabels[std::size_t(face)])].material] += area;
    }
    return areas;
}

} // namespace

TEST_F(HexrefineAdaptive, MakesClosedMeshesInEachFormat) {
    std::string const cube = makeCubeFile();
    std::size_t numFaces = 0;
    for (char const *const output : {"out.obj", "out.off", "out.ply"}) {
        Mesh const mesh = refine(cube, "--mask smooth", output);
        ASSERT_NO_FATAL_FAILURE(expectClosed(mesh));
        EXPECT_GT(mesh.GetNumFaces(), 100);
        EXPECT_TRUE(numFaces == 0 || numFaces == mesh.faceSizes.size());
        numFaces = mesh.faceSizes.size();
    }
    Mesh const coarse = refine(cube, "--pixel-error 20", "coarse.obj");
    EXPECT_LT(coarse.GetNumFaces(), int(numFaces) / 4);
    ASSERT_NO_FATAL_FAILURE(expectClosed(coarse));
    EXPECT_EQ(refine(cube, "--max-level 0", "base.obj").GetNumFaces(), 6);
    EXPECT_LT(refine(cube, "--resolution 100x100", "small.obj").GetNumFaces(), int(numFaces));
}

TEST_F(HexrefineAdaptive, CameraSeesWhatFacesHave) {
    std::string const cube = getContent(makeCubeFile());
    Mesh const alone = refine(makeFile("alone.obj", cube), "--mask smooth", "alone-out.obj");
    Mesh const beside =
        refine(makeFile("beside.obj", cube + "v 1e6 0 0\n"), "--mask smooth", "beside-out.obj");
    EXPECT_EQ(beside.positions, alone.positions);
    EXPECT_EQ(beside.faceVertices, alone.faceVertices);
}

TEST_F(HexrefineAdaptive, WarnsOfFacesThatCannotBeReadAgain) {
    constexpr int kNumSides = 400;
    std::string text;
    std::string face = "f";
    for (int i = 0; i < kNumSides; ++i) {
        double const angle = 2 * std::acos(-1.0) * i / kNumSides;
        text +=
            "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    std::string const input = makeFile("polygon.obj", text + face + "\n");
    std::string const arguments = input + " --adaptive --boundary edge-only --mask smooth -o " +
                                  getPath("out.ply") + " --pixel-error ";
    Result const result = run(arguments + "1e-8 --max-level 10");
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.error.find("1 face of the output with more than 65535 vertices, which "
                                "hexrefine does not read again, the first in face 0 with "),
              std::string::npos)
        << result.error;
    expectFailure(getPath("out.ply"), getPath("out.ply"), "more than the 65535");
    EXPECT_EQ(run(arguments + "1").error, "");
}

// Near cells are fine; cells outside the picture may stay coarse.
TEST_F(HexrefineAdaptive, CameraDecidesWhatIsFine) {
    std::string const cube = makeCubeFile();
    std::string const camera =
        "--mask smooth --fov 20 --pixel-error 0.7 --camera 2.4,0.2,0.4,1,0.2,0.4 ";
    Mesh const all = refine(cube, camera, "all.obj");
    auto const count = [](Mesh const &mesh, float side) {
        int result = 0;
        for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
            result += mesh.positions[i] * side > 0.2F;
        }
        return result;
    };
    EXPECT_GT(count(all, 1), 2 * count(all, -1));
    Mesh const culled = refine(cube, camera + "--cull", "culled.obj");
    EXPECT_LT(culled.GetNumFaces(), all.GetNumFaces());
    ASSERT_NO_FATAL_FAILURE(expectClosed(culled));
}

TEST_F(HexrefineAdaptive, KeepsMaterialsAndSeams) {
    std::string const strip = makeStrip();
    Mesh const mesh = refine(strip, "--boundary edge-and-corner --mask smooth", "out.obj");
    ASSERT_EQ(mesh.labels.size(), 2u);
    EXPECT_EQ(mesh.labels[0].material, "blue");
    ASSERT_EQ(mesh.channels.size(), 1u);
    FVarChannel const &uv = mesh.channels[0];
    std::size_t corner = 0;
    std::set<int> blue;
    std::set<int> red;
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        bool const isBlue =
            mesh.labels[std::size_t(mesh.faceLabels[std::size_t(face)])].material == "blue";
        for (int i = 0; i < mesh.faceSizes[std::size_t(face)]; ++i, ++corner) {
            int const value = uv.faceValues[corner];
            float const u = uv.values[2 * std::size_t(value)];
            EXPECT_TRUE(isBlue ? -1e-5F <= u && u <= 1.00001F : 4.99999F <= u && u <= 6.00001F);
            (isBlue ? blue : red).insert(mesh.faceVertices[corner]);
        }
    }
    std::vector<int> both;
    std::set_intersection(blue.begin(), blue.end(), red.begin(), red.end(),
                          std::back_inserter(both));
    // The seam has the same vertices on both sides, with values of their own.
    EXPECT_GT(both.size(), 2u);
    EXPECT_EQ(uv.GetNumValues(), mesh.GetNumVertices() + int(both.size()));
    Result const result =
        run("\"" + strip + "\" --adaptive --boundary edge-and-corner -o " + getPath("out.off"));
    EXPECT_NE(result.out.find("materials"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("channel uv"), std::string::npos) << result.out;
    Result const kept =
        run("\"" + strip + "\" --adaptive --boundary edge-and-corner --mask smooth -o " +
            getPath("kept.obj"));
    std::string const values = std::to_string(uv.GetNumValues()) + " in the cells";
    EXPECT_NE(kept.out.find(values), std::string::npos) << kept.out;
}

// Each label is a piece of its own, of a mesh that is the same.
TEST_F(HexrefineAdaptive, PiecesAreThoseOfTheWhole) {
    std::string const corners = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\n"
                                "v 1 -1 1\nv 1 1 1\nv -1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    char const *const faces[] = {"4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"};
    auto const makeCube = [&](std::string const &name, bool hasLabels) {
        std::string text = corners;
        for (std::string const face : faces) {
            text += hasLabels ? "usemtl of" + std::to_string(face[0] - '0') + face[2] + "\n" : "";
            text += "f";
            for (std::size_t i = 0; i < 4; ++i) {
                text += std::string(" ") + face[2 * i] + "/" + std::to_string(i + 1);
            }
            text += "\n";
        }
        return makeFile(name, text);
    };
    Mesh const whole = refine(makeCube("whole.obj", false), "--mask smooth", "one.obj");
    Mesh const pieces = refine(makeCube("pieces.obj", true), "--mask smooth", "many.obj");
    EXPECT_EQ(pieces.labels.size(), 6u);
    EXPECT_EQ(pieces.positions, whole.positions);
    EXPECT_EQ(pieces.faceSizes, whole.faceSizes);
    EXPECT_EQ(pieces.faceVertices, whole.faceVertices);
    ASSERT_EQ(pieces.channels.size(), 1u);
    EXPECT_EQ(pieces.channels[0].values, whole.channels[0].values);
    EXPECT_EQ(pieces.channels[0].faceValues, whole.channels[0].faceValues);
}

TEST_F(HexrefineAdaptive, TellsWhereTheLastLevelEnds) {
    std::string const cube = makeCubeFile() + " --adaptive --mask smooth ";
    std::string const note = "may be further than 0.5 pixels";
    Result const coarse = run(cube + "--resolution 60000x60000 --max-level 3");
    EXPECT_NE(coarse.out.find("faces are of level 3, the last: they " + note), std::string::npos)
        << coarse.out;
    Result const fine = run(cube + "--resolution 64x64");
    EXPECT_EQ(fine.out.find(note), std::string::npos) << fine.out;
    Result const json = run(cube + "--resolution 60000x60000 --max-level 3 --quiet --stats -");
    Json const cells = Json::parse(json.out);
    EXPECT_EQ(cells["evaluator"], "surface");
    EXPECT_EQ(cells["adaptive"]["maxLevel"], 3);
    EXPECT_EQ(cells["adaptive"]["facesOfMaxLevel"], cells["adaptive"]["facesByLevel"][3]);
    EXPECT_GT(cells["adaptive"]["facesOfMaxLevel"], 0);
}

TEST_F(HexrefineAdaptive, StatisticsTellWhatWasMade) {
    Result const result = run(makeCubeFile() +
                              " --adaptive --cull --mask smooth --quiet --camera "
                              "0.6,0.6,0.6,0,0,0 --fov 30 --stats - -o " +
                              getPath("out.ply"));
    ASSERT_EQ(result.status, 0) << result.error;
    Json const json = Json::parse(result.out)["adaptive"];
    Mesh const mesh = ReadMesh(getPath("out.ply"));
    EXPECT_EQ(json["faces"], mesh.GetNumFaces());
    EXPECT_EQ(json["points"], mesh.GetNumVertices());
    int sum = 0;
    for (Json const &count : json["facesByLevel"]) {
        sum += int(count);
    }
    EXPECT_EQ(sum, mesh.GetNumFaces());
    EXPECT_EQ(json["types"], 1);
    EXPECT_EQ(json["hits"], 5);
    EXPECT_GT(json["culled"]["outside"], 0);
    EXPECT_EQ(json["bytes"],
              12 * mesh.GetNumVertices() + 4 * mesh.GetNumFaces() + 4 * mesh.faceVertices.size());
    Result const uniform = run(makeCubeFile() + " --stats - --quiet");
    EXPECT_TRUE(Json::parse(uniform.out)["adaptive"].is_null());
    Result const summary = run(makeCubeFile() + " --adaptive");
    EXPECT_NE(summary.out.find("by level"), std::string::npos) << summary.out;
}

TEST_F(HexrefineAdaptive, BadArgumentsAreNamed) {
    std::string const cube = makeCubeFile();
    expectBadUsage(cube + " --camera 0,0,5,0,0,0", "--adaptive");
    expectBadUsage(cube + " --adaptive --camera 0,0,5,0,0", "--camera");
    expectBadUsage(cube + " --adaptive --camera 0,0,5,0,0,x", "--camera");
    expectBadUsage(cube + " --adaptive --fov 180", "--fov");
    expectBadUsage(cube + " --adaptive --resolution 10", "--resolution");
    expectBadUsage(cube + " --adaptive --resolution 0x10", "--resolution");
    expectBadUsage(cube + " --adaptive --resolution 65537x10", "65536");
    expectBadUsage(cube + " --adaptive --pixel-error 0", "--pixel-error");
    expectBadUsage(cube + " --adaptive --max-level 13", "--max-level");
    expectBadUsage(cube + " --adaptive -l 3",
                   "--level: is not for --adaptive, which refines up to --max-level");
    expectBadUsage(cube + " --adaptive --limit",
                   "--limit: is not for --adaptive, whose vertices are limit points already");
    Result const help = run("--help");
    for (std::string const option :
         {"--evaluator primvar", "--simd portable", "--coplanar", "--separate-vertices -o x.ply"}) {
        std::string const name = option.substr(0, option.find(' '));
        expectBadUsage(cube + " --adaptive " + option, name + ": is not for --adaptive\n");
        std::size_t const list = help.out.find("without gaps; not");
        EXPECT_LT(help.out.find(name, list), help.out.find("--camera", list)) << help.out;
    }
    expectBadUsage(cube + " --png a.png --png-colors levels", "--adaptive");
    expectFailure(cube + " --adaptive --camera 1,2,3,1,2,3", cube, "camera");
    expectBadUsage(cube + " --adaptive --scheme doo-sabin", "--scheme: doo-sabin is not for --");
    expectBadUsage(cube + " --adaptive --fov 179.999999", "'179.999999' is 180 as a float");
    expectBadUsage(cube + " --adaptive --fov 1e-300", "'1e-300' is 0 as a float");
    expectBadUsage(cube + " --adaptive --pixel-error 1e300", "out of the range of floats");
    expectBadUsage(cube + " --adaptive --pixel-error 1e-300", "'1e-300' is 0 as a float");
    std::string const strip = makeStrip();
    expectFailure(strip + " --adaptive", strip,
                  "--adaptive needs --boundary edge-only or edge-and-corner: the mesh has boundary "
                  "edges, one at vertex 0 (counted from 0)");
    EXPECT_EQ(run(cube + " --adaptive --camera 0,9,0,0,0,0").status, 0);
    EXPECT_EQ(run("--adaptive --camera 0,0,5,0,0,0 " + cube + " --fov 30").status, 0);
}

#ifdef HEXREFINE_HAS_RENDERER
TEST_F(HexrefineAdaptive, MakesPicturesOfWhatItsCameraSees) {
    std::string const path = getPath("cube.png");
    std::string const arguments =
        makeCubeFile() + " --adaptive --pixel-error 3 --resolution 120x90 --png " + path;
    std::vector<std::string> contents;
    for (char const *const more :
         {"", " --png-colors levels", " --png-colors base-faces", " --camera 3,1,0,0,0,0"}) {
        EXPECT_EQ(run(arguments + more).status, 0) << more;
        contents.push_back(getContent(path));
        EXPECT_EQ(contents.back().substr(0, 8), "\x89PNG\r\n\x1a\n");
        EXPECT_EQ(contents.back().substr(16, 8), std::string("\0\0\0\x78\0\0\0\x5a", 8));
        EXPECT_EQ(std::count(contents.begin(), contents.end(), contents.back()), 1);
    }
}

// A cube with infinitely sharp edges looks as six faces that share no vertices.
TEST_F(HexrefineAdaptive, MakesPicturesWithSharpCreases) {
    std::vector<std::array<int, 3>> const corners = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1},
                                                     {1, 1, -1},   {-1, -1, 1}, {1, -1, 1},
                                                     {-1, 1, 1},   {1, 1, 1}};
    std::vector<std::array<int, 4>> const faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                   {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
    auto const addVertex = [&](int corner, std::string &text) {
        text += "v";
        for (int const number : corners[std::size_t(corner)]) {
            text += " " + std::to_string(number);
        }
        text += "\n";
    };
    std::string shared;
    std::string separate;
    for (int corner = 0; corner < 8; ++corner) {
        addVertex(corner, shared);
    }
    int numSeparate = 0;
    for (std::array<int, 4> const &face : faces) {
        std::string line = "f";
        std::string separateLine = "f";
        for (int const corner : face) {
            addVertex(corner, separate);
            line += " " + std::to_string(corner + 1);
            separateLine += " " + std::to_string(++numSeparate);
        }
        shared += line + "\n";
        separate += separateLine + "\n";
    }
    std::string const path = getPath("cube.png");
    std::vector<std::string> contents;
    for (std::string const &arguments :
         {makeFile("shared.obj", shared) + " --crease-angle 30",
          makeFile("separate.obj", separate) + " --boundary edge-and-corner"}) {
        EXPECT_EQ(run(arguments +
                      " --adaptive --max-level 0 --camera 3,3,5,0,0,0"
                      " --resolution 120x90 --png " +
                      path)
                      .status,
                  0);
        contents.push_back(getContent(path));
    }
    EXPECT_TRUE(contents[0] == contents[1]);
}

// The camera is farther away than a float can say.
TEST_F(HexrefineAdaptive, MakesPicturesOfHugeMeshes) {
    std::vector<std::string> contents;
    for (char const *const number : {"1", "1.7014118346046923e38"}) { // 2^127
        std::string text;
        for (char const *const corner : {"n 0 0", "0 n 0", "0 0 n", "-n -n -n"}) {
            text += std::string("v ") + corner + "\n";
            for (std::size_t at = text.find('n'); at != std::string::npos; at = text.find('n')) {
                text.replace(at, 1, number);
            }
        }
        std::string const input =
            makeFile("huge.obj", text + "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
        std::string const path = getPath("huge.png");
        EXPECT_EQ(run(input + " --adaptive --resolution 120x90 --png " + path).status, 0);
        contents.push_back(getContent(path));
    }
    EXPECT_TRUE(contents[0] == contents[1]);
}
#endif

// Cells begin with the faces of level 1, whose base faces have the materials and holes.
TEST_F(HexrefineAdaptive, BeginsBehindAFirstStep) {
    std::string const cube = makeCubeFile();
    EXPECT_EQ(refine(cube, "--first-step tri-hex --max-level 0", "base.obj").GetNumFaces(), 14);
    for (char const *const firstStep : {"truncate", "tri-hex"}) {
        Mesh const mesh =
            refine(cube, std::string("--mask smooth --first-step ") + firstStep, "closed.obj");
        ASSERT_NO_FATAL_FAILURE(expectClosed(mesh));
        EXPECT_GT(mesh.GetNumFaces(), 100);
    }
    std::string const octahedron =
        makeFile("octahedron.obj",
                 "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                 "vt 0 0\nvt 1 0\nvt 0 1\n"
                 "usemtl blue\nf 1/1 2/2 5/3\nf 2/1 3/2 5/3\nf 3/1 4/2 5/3\nf 4/1 1/2 5/3\n"
                 "usemtl red\nf 2/1 1/2 6/3\nf 3/1 2/2 6/3\nf 4/1 3/2 6/3\nf 1/1 4/2 6/3\n"
                 "t hole 1/0/0 7\n");
    std::string const options = "--mask smooth --first-step truncate ";
    Mesh const mesh = refine(octahedron, options + "--pixel-error 0.2", "cells.obj");
    Result const result =
        run(octahedron + " --level 5 --limit --quiet " + options + " -o " + getPath("uniform.obj"));
    ASSERT_EQ(result.status, 0) << result.error;
    std::map<std::string, double> const areas = measureMaterials(mesh);
    std::map<std::string, double> const expected =
        measureMaterials(ReadMesh(getPath("uniform.obj")));
    ASSERT_EQ(areas.size(), 2u);
    EXPECT_NEAR(areas.at("blue"), expected.at("blue"), 0.01 * expected.at("blue"));
    EXPECT_NEAR(areas.at("red"), expected.at("red"), 0.01 * expected.at("red"));
    EXPECT_NEAR(areas.at("red"), 0.75 * areas.at("blue"), 0.02 * areas.at("blue"));
    ASSERT_EQ(mesh.channels.size(), 1u);
    EXPECT_EQ(mesh.channels[0].faceValues.size(), mesh.faceVertices.size());
    for (float const number : mesh.channels[0].values) {
        EXPECT_TRUE(-1e-5F <= number && number <= 1.00001F);
    }
    // Around the hole alone it is open.
    std::set<std::pair<int, int>> sides;
    auto corner = mesh.faceVertices.begin();
    for (int const size : mesh.faceSizes) {
        for (int i = 0; i < size; ++i) {
            EXPECT_TRUE(sides.emplace(corner[i], corner[(i + 1) % size]).second);
        }
        corner += size;
    }
    int numOpen = 0;
    for (auto const &[start, end] : sides) {
        if (sides.count({end, start}) == 0) {
            ++numOpen;
            float const *const point = &mesh.positions[3 * std::size_t(start)];
            EXPECT_TRUE(point[0] > -1e-5F && point[1] < 1e-5F && point[2] < 1e-5F);
            EXPECT_LT(std::min({point[0], -point[1], -point[2]}), 1e-5F);
        }
    }
    EXPECT_GT(numOpen, 2);
    Result const json = run(octahedron + " --adaptive --quiet --stats - " + options);
    EXPECT_EQ(Json::parse(json.out)["firstStep"], "truncate");
}

// Creases and borders, too, which have points of their own.
TEST_F(HexrefineAdaptive, CullsSharpEdges) {
    constexpr int kNumSides = 8; // of a prism whose ends are bent
    std::string text;
    std::string ends[2] = {"f", "f"};
    for (int i = 0; i < kNumSides; ++i) {
        double const angle = 2 * std::acos(-1.0) * i / kNumSides;
        for (double const z : {-1.0, 1.0}) {
            text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) +
                    " " + std::to_string(z + 0.5 * std::sin(2 * angle)) + "\n";
        }
        ends[1] += " " + std::to_string(2 * i + 2);
        ends[0].insert(1, " " + std::to_string(2 * i + 1));
    }
    for (int i = 0; i < kNumSides; ++i) {
        int const next = (i + 1) % kNumSides;
        text += "f " + std::to_string(2 * i + 1) + " " + std::to_string(2 * next + 1) + " " +
                std::to_string(2 * next + 2) + " " + std::to_string(2 * i + 2) + "\n";
    }
    std::string const prism = makeFile("prism.obj", text + ends[0] + "\n" + ends[1] + "\n");
    std::string const behind = " --crease-angle 30 --camera 5,0,0,10,0,0";
    EXPECT_GT(refine(prism, behind, "all.ply").GetNumVertices(), 100);
    Mesh const culled = refine(prism, behind + " --cull", "culled.ply");
    EXPECT_EQ(culled.GetNumVertices(), 2 * kNumSides);
    EXPECT_EQ(culled.GetNumFaces(), kNumSides + 2);
    // Half of the prism is in the picture.
    std::string const beside = " --crease-angle 30 --camera 6,0,0,6,6,4 --fov 90";
    Mesh const half = refine(prism, beside + " --cull", "half.ply");
    EXPECT_LT(half.GetNumVertices(), refine(prism, beside, "all.ply").GetNumVertices());
    ASSERT_NO_FATAL_FAILURE(expectClosed(half));
}

// Normals of a file say how the control mesh is to look, not where the surface faces.
TEST_F(HexrefineAdaptive, LeavesNormalsOut) {
    std::string const corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    std::string const obj =
        makeFile("normals.obj", corners + "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\n"
                                          "f 1/1/1 2/2/1 3/3/1\nf 1/1/2 3/3/1 4/2/2\n");
    std::string const ply =
        makeFile("normals.ply",
                 "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                 "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                 "property float w\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n"
                 "0 0 0 0 0 1 2\n1 0 0 0 0 1 2\n1 1 0 0 1 0 2\n0 1 0 0 1 0 2\n4 0 1 2 3\n");
    for (std::string const &input : {obj, ply}) {
        for (char const *const output : {"out.obj", "out.ply"}) {
            Result const result =
                run(input + " --adaptive --boundary edge-only -o " + getPath(output));
            EXPECT_EQ(result.status, 0) << result.error;
            EXPECT_NE(result.out.find("not read: normals, which are not those of the surface\n"),
                      std::string::npos)
                << result.out;
            Mesh const mesh = ReadMesh(getPath(output));
            for (FVarChannel const &channel : mesh.channels) {
                EXPECT_EQ(channel.kind, FVarKind::Uv);
            }
            EXPECT_EQ(FindProperty(mesh.vertexProperties, "nx"), nullptr);
            EXPECT_EQ(FindProperty(mesh.vertexProperties, "w") != nullptr, input == ply);
        }
    }
}

TEST_F(HexrefineAdaptive, LeavesHolesOut) {
    std::string const strip = makeStrip("t hole 1/0/0 1\nt interpolateboundary 1/0/0 1\n");
    Mesh const mesh = refine(strip, "--boundary edge-only", "out.obj");
    for (FaceLabel const &label : mesh.labels) {
        EXPECT_EQ(label.material, "blue");
    }
    EXPECT_GT(mesh.GetNumFaces(), 1);
}

} // namespace OpenSubdivHex::Tools::adaptiveTest

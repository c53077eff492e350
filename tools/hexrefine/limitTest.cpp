// SPDX-License-Identifier: Apache-2.0
//
// hexrefine --limit.
#include "programFixture.h"
#include "tools/mesh/meshReader.h"

#include <cmath>
#include <cstring>
#include <sstream>

namespace OpenSubdivHex::Tools::limitTest {

namespace {

class HexrefineLimit : public Hexrefine {
protected:
    Mesh refine(std::string const &input, std::string const &arguments,
                std::string const &output) const {
        Result const result =
            run("\"" + input + "\" --limit --quiet " + arguments + " -o " + getPath(output));
        EXPECT_EQ(result.status, 0) << result.error;
        return ReadMesh(getPath(output));
    }

    /// A cube whose upper face has sharp edges.
    std::string makeCreasedCube() const {
        std::string const content = getContent(makeCubeFile());
        std::string tags;
        Mesh const cube = ReadMesh(getPath("cube.obj"));
        for (int i = 0; i < 4; ++i) {
            tags += "t crease 2/1/0 " + std::to_string(cube.faceVertices[i]) + " " +
                    std::to_string(cube.faceVertices[(i + 1) % 4]) + " 10\n";
        }
        return makeFile("creased.obj", content + tags);
    }
};

double dot(float const *a, float const *b) {
    return double(a[0]) * b[0] + double(a[1]) * b[1] + double(a[2]) * b[2];
}

} // namespace

// The limit of a vertex is the same from every level, and its normal points outward from the cube.
TEST_F(HexrefineLimit, PushesVerticesToTheLimitAndWritesNormals) {
    std::string const cube = makeCubeFile();
    Mesh const coarse = refine(cube, "-l 0", "coarse.obj");
    Mesh const fine = refine(cube, "-l 3", "fine.obj");
    ASSERT_EQ(coarse.GetNumVertices(), 8);
    ASSERT_EQ(fine.GetNumVertices(), 512);
    for (int i = 0; i < 24; ++i) {
        EXPECT_NEAR(coarse.positions[i], fine.positions[i], 1e-6);
    }
    ASSERT_EQ(fine.channels.size(), 1u);
    FVarChannel const &normals = fine.channels[0];
    EXPECT_EQ(normals.kind, FVarKind::Normal);
    EXPECT_EQ(normals.GetNumValues(), 512);
    for (std::size_t i = 0; i < fine.faceVertices.size(); ++i) {
        float const *point = &fine.positions[3 * std::size_t(fine.faceVertices[i])];
        float const *normal = &normals.values[3 * std::size_t(normals.faceValues[i])];
        EXPECT_NEAR(dot(normal, normal), 1, 1e-5);
        EXPECT_GT(dot(normal, point), 0.8 * std::sqrt(dot(point, point)));
    }
}

TEST_F(HexrefineLimit, WritesANormalForEachSideOfACrease) {
    std::string const path = makeCreasedCube();
    Mesh const base = ReadMesh(path);
    Mesh const mesh = refine(path, "-l 2", "out.obj");
    FVarChannel const &normals = mesh.channels.at(0);
    EXPECT_GT(normals.GetNumValues(), mesh.GetNumVertices());
    // The flat side: the normals in the F-face of the upper face, also beside the crease.
    int numFlat = 0;
    int numOther = 0;
    float const *const flat = &normals.values[3 * std::size_t(normals.faceValues[0])];
    std::vector<bool> isOnFlat(std::size_t(mesh.GetNumVertices()));
    for (std::size_t i = 0; i < mesh.faceVertices.size(); ++i) {
        float const *normal = &normals.values[3 * std::size_t(normals.faceValues[i])];
        if (dot(normal, flat) > 0.9999) {
            ++numFlat;
            isOnFlat[std::size_t(mesh.faceVertices[i])] = true;
        }
    }
    for (std::size_t i = 0; i < mesh.faceVertices.size(); ++i) {
        float const *normal = &normals.values[3 * std::size_t(normals.faceValues[i])];
        numOther += isOnFlat[std::size_t(mesh.faceVertices[i])] && dot(normal, flat) < 0.9;
    }
    EXPECT_GT(numFlat, 50);
    EXPECT_GT(numOther, 10);
}

TEST_F(HexrefineLimit, PlyFilesHaveNormalsOfVertices) {
    Mesh const mesh = refine(makeCubeFile(), "-l 1", "out.ply");
    EXPECT_EQ(mesh.GetNumVertices(), 32);
    std::string const content = getContent(getPath("out.ply"));
    EXPECT_NE(content.find("property float nz\nelement face"), std::string::npos);
    Mesh const obj = refine(makeCubeFile(), "-l 1", "out.obj");
    std::size_t const data = content.find("end_header\n") + 11;
    for (std::size_t v = 0; v < 32; ++v) {
        float values[6];
        std::memcpy(values, content.data() + data + sizeof values * v, sizeof values);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(values[k], obj.positions[3 * v + k], 1e-6);
            EXPECT_NEAR(values[3 + k], obj.channels.at(0).values[3 * v + k], 1e-6);
        }
    }
}

// As normals of vertices in PLY files do, those of corners make room in OBJ files, whatever is written.
TEST_F(HexrefineLimit, ReplacesNormals) {
    std::string const cube = getContent(makeCubeFile());
    std::string withNormals = cube.substr(0, cube.find("f ")) + "vt 0 0\nvn 0 0 5\nvn 0 3 4\n";
    std::istringstream faces(cube.substr(cube.find("f ")));
    int numWords = 0;
    for (std::string word; faces >> word;) {
        withNormals +=
            word == "f" ? "\nf" : " " + word + "/1/" + std::to_string(1 + ++numWords % 2);
    }
    std::string const input = makeFile("normals.obj", withNormals + "\n");
    for (char const *const output : {"out.obj", "out.ply", "out.off"}) {
        SCOPED_TRACE(output);
        Mesh const expected = refine(makeCubeFile(), "-l 2", output);
        Result const result = run(input + " --limit -l 2 -o " + getPath(output));
        EXPECT_EQ(result.status, 0) << result.error;
        EXPECT_NE(result.out.find("not read: normals, those of --limit replace them\n"),
                  std::string::npos)
            << result.out;
        EXPECT_EQ(result.out.find("channel normal"), std::string::npos) << result.out;
        Mesh const mesh = ReadMesh(getPath(output));
        EXPECT_EQ(mesh.positions, expected.positions);
        ASSERT_EQ(mesh.vertexProperties.size(), expected.vertexProperties.size());
        for (std::size_t i = 0; i < mesh.vertexProperties.size(); ++i) {
            EXPECT_EQ(mesh.vertexProperties[i].values, expected.vertexProperties[i].values);
        }
        if (!expected.channels.empty()) {
            ASSERT_EQ(mesh.channels.size(), 2u);
            EXPECT_EQ(mesh.channels[0].kind, FVarKind::Uv);
            EXPECT_EQ(mesh.channels[1].kind, FVarKind::Normal);
            EXPECT_EQ(mesh.channels[1].values, expected.channels.at(0).values);
            EXPECT_EQ(mesh.channels[1].faceValues, expected.channels.at(0).faceValues);
        }
    }
}

TEST_F(HexrefineLimit, IsTheSameByAllEvaluators) {
    struct {
        std::string path;
        bool hasFurtherSides;
    } const inputs[] = {{makeCubeFile(), false}, {makeCreasedCube(), true}};
    for (auto const &input : inputs) {
        Mesh const expected = refine(input.path, "-l 3 --evaluator stencil-cpu", "expected.obj");
        for (std::string const evaluator : {"refinement", "primvar", "stencil"}) {
            SCOPED_TRACE(evaluator);
            std::string const arguments = "-l 3 --evaluator " + evaluator;
            Mesh const mesh = refine(input.path, arguments, "out.obj");
            ASSERT_EQ(mesh.positions.size(), expected.positions.size());
            for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
                ASSERT_NEAR(mesh.positions[i], expected.positions[i], 2e-6);
            }
            std::vector<float> const &normals = mesh.channels.at(0).values;
            ASSERT_EQ(normals.size(), expected.channels.at(0).values.size());
            for (std::size_t i = 0; i < normals.size(); ++i) {
                ASSERT_NEAR(normals[i], expected.channels[0].values[i], 1e-4);
            }
            // Tables are made for those who need one.
            Json const json = Json::parse(run(input.path + " --limit --stats - " + arguments).out);
            EXPECT_EQ(json["evaluator"], evaluator);
            EXPECT_EQ(json["stencils"] > 0, evaluator == "stencil" || input.hasFurtherSides);
        }
    }
}

} // namespace OpenSubdivHex::Tools::limitTest

// SPDX-License-Identifier: Apache-2.0
//
// Colours and other numbers, objects, groups and materials through hexrefine.
#include "far_ext/primvarRefiner.h"
#include "pictureColors.h"
#include "programFixture.h"
#include "tools/mesh/fileError.h"

namespace OpenSubdivHex::Tools::attributeTest {

namespace {

using Names = std::vector<std::string>;

/// A number that varying data are made of.
struct Number {
    void Clear() { value = 0; }
    void AddWithWeight(Number const &other, float weight) { value += weight * other.value; }

    float value;
};

/// \p values of the vertices of \p base as the library refines them: varying data.
std::vector<float> refineVarying(Mesh const &base, int maxLevel, std::vector<float> const &values) {
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(DescribeTopology(base), Sdc::Options());
    refiner->RefineUniform(maxLevel);
    std::vector<Number> numbers;
    for (float value : values) {
        numbers.push_back({value});
    }
    for (int level = 1; level <= maxLevel; ++level) {
        std::vector<Number> refined(std::size_t(refiner->GetLevel(level).GetNumVertices()));
        FarExt::PrimvarRefiner(*refiner).InterpolateVarying(level, numbers, refined);
        numbers = refined;
    }
    std::vector<float> result;
    for (Number const &number : numbers) {
        result.push_back(number.value);
    }
    return result;
}

class HexrefineAttribute : public Hexrefine {
protected:
    Mesh refine(std::string const &arguments, std::string const &output) const {
        Result const result = run(arguments + " --quiet -o " + getPath(output));
        EXPECT_EQ(result.status, 0) << result.error;
        return ReadMesh(getPath(output));
    }

    /// A cube with colours and other numbers of vertices and faces.
    Mesh makeColoredCube() const {
        Mesh cube = MakeCube();
        cube.vertexProperties = {
            {"red", NumberType::UChar, {0, 255, 0, 255, 10, 20, 30, 40}},
            {"green", NumberType::UChar, {0, 0, 255, 255, 1, 2, 3, 4}},
            {"blue", NumberType::UChar, {255, 254, 253, 252, 251, 250, 249, 248}},
            {"quality", NumberType::Float, {0, .1f, .2f, .3f, .4f, .5f, .6f, -1e6f}},
            {"charge", NumberType::Short, {-32768, 32767, 0, 1, 2, 3, 4, 5}}};
        cube.faceProperties = {{"red", NumberType::UChar, {0, 50, 100, 150, 200, 250}},
                               {"id", NumberType::UInt, {4294967295.0, 1, 2, 3, 4, 5}},
                               {"weight", NumberType::Double, {.1, .2, .3, .4, .5, .6}}};
        return cube;
    }
    std::string makeColoredFile() const {
        WriteMesh(makeColoredCube(), getPath("colored.ply"));
        return getPath("colored.ply");
    }

    /// Expects that the values of \p property are \p values but for \p tolerance.
    static void expectValues(VertexProperty const *property, std::vector<float> const &values,
                             float tolerance) {
        ASSERT_TRUE(property);
        ASSERT_EQ(property->values.size(), values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_NEAR(property->values[i], values[i], tolerance) << property->name << i;
        }
    }

    /// A cube of side 2, each face of another material, in two objects.
    std::string makeMaterialCube() const {
        Mesh cube = MakeCube();
        for (int face = 0; face < 6; ++face) {
            cube.labels.push_back({face < 4 ? "ring" : "caps", "", "m" + std::to_string(face), ""});
            cube.faceLabels.push_back(face);
        }
        cube.materialLibraries = {"six.mtl"};
        WriteMesh(cube, getPath("materials.obj"));
        return getPath("materials.obj");
    }

    /// Expects that each face of \p mesh lies in the plane of the face of the cube that
    /// getNumber(face) says, and that there are faces in all six.
    template <typename GET_NUMBER>
    static void expectInPlanes(Mesh const &mesh, GET_NUMBER getNumber) {
        constexpr int kNormals[6][3] = {{0, 0, 1},  {0, 1, 0}, {0, 0, -1},
                                        {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}};
        std::vector<int> numFaces(6);
        int const *vertices = mesh.faceVertices.data();
        for (int face = 0; face < mesh.GetNumFaces(); ++face) {
            int const number = getNumber(face);
            ++numFaces.at(std::size_t(number));
            for (int i = 0; i < mesh.faceSizes[std::size_t(face)]; ++i) {
                float const *point = &mesh.positions[3 * std::size_t(*vertices++)];
                float height = 0;
                for (int k = 0; k < 3; ++k) {
                    height += float(kNormals[number][k]) * point[k];
                }
                ASSERT_NEAR(height, 1, 1e-6) << "face " << face << " of " << number;
            }
        }
        EXPECT_GT(*std::min_element(numFaces.begin(), numFaces.end()), 0);
    }
};

/// How often \p word begins a line of \p text.
int countLines(std::string const &text, std::string const &word) {
    int count = 0;
    for (std::size_t i = 0; i != std::string::npos; i = text.find('\n', i + 1)) {
        count += text.compare(i + (i > 0 ? 1 : 0), word.size(), word) == 0 ? 1 : 0;
    }
    return count;
}

} // namespace

TEST_F(HexrefineAttribute, NumbersOfVerticesAreVarying) {
    Mesh const cube = makeColoredCube();
    for (char const *evaluator : {"refinement", "stencil", "stencil-cpu", "primvar"}) {
        SCOPED_TRACE(evaluator);
        Mesh const mesh = refine(makeColoredFile() + " -l 3 --evaluator " + evaluator, "out.ply");
        ASSERT_EQ(mesh.vertexProperties.size(), cube.vertexProperties.size());
        for (std::size_t i = 0; i < cube.vertexProperties.size(); ++i) {
            VertexProperty const &from = cube.vertexProperties[i];
            VertexProperty const &to = mesh.vertexProperties[i];
            EXPECT_EQ(to.name, from.name);
            EXPECT_EQ(to.type, from.type);
            // Integers are rounded to the nearest.
            float const tolerance = from.name == "quality" ? 1 : .51f;
            expectValues(&to, refineVarying(cube, 3, from.values), tolerance);
            // At the vertices of the cube they stay.
            for (std::size_t v = 0; v < 8; ++v) {
                EXPECT_EQ(to.values[v], from.values[v]);
            }
        }
    }
}

TEST_F(HexrefineAttribute, LevelZeroKeepsAll) {
    Mesh const cube = makeColoredCube();
    Mesh const mesh = refine(makeColoredFile() + " -l 0", "out.ply");
    ASSERT_EQ(mesh.vertexProperties.size(), cube.vertexProperties.size());
    for (std::size_t i = 0; i < cube.vertexProperties.size(); ++i) {
        EXPECT_EQ(mesh.vertexProperties[i].values, cube.vertexProperties[i].values);
    }
    ASSERT_EQ(mesh.faceProperties.size(), cube.faceProperties.size());
    for (std::size_t i = 0; i < cube.faceProperties.size(); ++i) {
        EXPECT_EQ(mesh.faceProperties[i].name, cube.faceProperties[i].name);
        EXPECT_EQ(mesh.faceProperties[i].type, cube.faceProperties[i].type);
        EXPECT_EQ(mesh.faceProperties[i].values, cube.faceProperties[i].values);
    }
}

TEST_F(HexrefineAttribute, FacePropertiesCutWhereTheyDiffer) {
    Mesh cube = MakeCube();
    for (std::vector<double> const &values :
         {std::vector<double>(6, 7), {1, 1, 1, 1, 1, 2}, {0, 1, 2, 3, 4, 5}}) {
        cube.faceProperties = {{"first", NumberType::Int, {0, 0, 0, 0, 0, 0}},
                               {"id", NumberType::Int, values}};
        WriteMesh(cube, getPath("cube.ply"));
        Mesh const mesh = refine(getPath("cube.ply") + " -l 3", "out.ply");
        std::vector<double> const &ids = mesh.faceProperties[1].values;
        // 258 faces, and each edge between two numbers cuts 3 hexagons.
        int const numCut = values[5] == 7 ? 0 : values[5] == 2 ? 12 : 36;
        ASSERT_EQ(mesh.GetNumFaces(), 258 + numCut);
        if (values[5] == 5) {
            for (int id = 0; id < 6; ++id) {
                EXPECT_EQ(std::count(ids.begin(), ids.end(), id), 49);
            }
        }
        if (values[5] == 2) {
            EXPECT_EQ(std::count(ids.begin(), ids.end(), 2), 49);
        }
    }
}

TEST_F(HexrefineAttribute, ColorsGoWhereFormatsHaveThem) {
    Mesh const cube = makeColoredCube();
    std::vector<float> const red = refineVarying(cube, 2, cube.vertexProperties[0].values);
    Mesh const off = refine(makeColoredFile() + " -l 2", "out.off");
    ASSERT_EQ(off.vertexProperties.size(), 3u);
    EXPECT_EQ(off.vertexProperties[0].type, NumberType::UChar);
    expectValues(FindProperty(off.vertexProperties, "red"), red, .501f);
    Mesh const obj = refine(makeColoredFile() + " -l 2", "out.obj");
    ASSERT_EQ(obj.vertexProperties.size(), 3u);
    std::vector<float> scaled = red;
    for (float &value : scaled) {
        value /= 255;
    }
    expectValues(FindProperty(obj.vertexProperties, "red"), scaled, 1e-6f);
    // From OBJ they are floats, and w goes with them.
    Mesh const ply = refine(getPath("out.obj") + " -l 0", "out.ply");
    ASSERT_EQ(ply.vertexProperties.size(), 3u);
    EXPECT_EQ(ply.vertexProperties[0].type, NumberType::Float);
    EXPECT_EQ(ply.vertexProperties[0].values, obj.vertexProperties[0].values);
    makeFile("w.obj", "v 0 0 0 4\nv 1 0 0 0\nv 0 1 0 1\nf 1 2 3\n");
    Mesh const weighted = refine(getPath("w.obj") + " -l 1", "out.obj");
    Mesh const triangle = ReadMesh(getPath("w.obj"));
    expectValues(FindProperty(weighted.vertexProperties, "w"),
                 refineVarying(triangle, 1, {4, 0, 1}), 1e-6f);
}

TEST_F(HexrefineAttribute, SaysWhatIsKeptAndWhatIsNot) {
    std::string const input = makeColoredFile() + " -l 1";
    Result result = run(input + " -o " + getPath("out.ply"));
    EXPECT_NE(result.out.find("of vertices, interpolated linearly: uchar red, uchar green, uchar "
                              "blue, float quality, short charge\n"
                              "of faces: uchar red, uint id, double weight\n"),
              std::string::npos)
        << result.out;
    EXPECT_EQ(result.out.find("not "), std::string::npos) << result.out;
    result = run(input + " -o " + getPath("out.obj"));
    EXPECT_NE(result.out.find("not written, .obj files have no place for it: vertex property "
                              "quality, vertex property charge, face property red, face property "
                              "id, face property weight\n"),
              std::string::npos)
        << result.out;
    Json json = Json::parse(run(input + " --stats - -o " + getPath("out.off")).out);
    EXPECT_EQ(json["vertexProperties"].dump(),
              R"([{"name":"red","type":"uchar"},{"name":"green","type":"uchar"},)"
              R"({"name":"blue","type":"uchar"}])");
    EXPECT_EQ(json["faceProperties"].dump(), "[]");
    EXPECT_EQ(json["notWritten"].size(), 5u);

    std::string const obj =
        makeFile("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\no cube\ng a b\n"
                          "usemtl m\ns 1\nf 1 2 3\ng b\ns off\nf 3 2 1\n"
                          "t smoothtriangles 0/0/1 smooth\n");
    result = run(obj + " -l 0 -o " + getPath("out.ply"));
    EXPECT_NE(result.out.find("not read: statement l, tag smoothtriangles\n"
                              "not written, .ply files have no place for it: objects, groups, "
                              "materials, smoothing groups, material libraries\n"),
              std::string::npos)
        << result.out;
    result = run(obj + " -l 0");
    EXPECT_NE(result.out.find("1 object, 2 groups, 1 material, 2 smoothing groups\n"),
              std::string::npos)
        << result.out;
    json = Json::parse(run(obj + " -l 0 --stats - -o " + getPath("out.obj")).out);
    EXPECT_EQ(json["objects"].dump(), R"(["cube"])");
    EXPECT_EQ(json["groups"].dump(), R"(["a","b"])");
    EXPECT_EQ(json["materials"].dump(), R"(["m"])");
    EXPECT_EQ(json["smoothingGroups"].dump(), R"(["1","off"])");
    EXPECT_EQ(json["materialLibraries"].dump(), R"(["a.mtl"])");
    EXPECT_EQ(json["notRead"].dump(), R"(["statement l","tag smoothtriangles"])");
    EXPECT_EQ(json["notWritten"].dump(), "[]");
}

TEST_F(HexrefineAttribute, LimitLeavesNumbersAsTheyAre) {
    for (char const *output : {"out.ply", "out.off"}) {
        Mesh const plain = refine(makeColoredFile() + " -l 2", output);
        Mesh const limit = refine(makeColoredFile() + " -l 2 --limit", output);
        EXPECT_NE(limit.positions, plain.positions);
        EXPECT_EQ(limit.vertexProperties.size(), plain.vertexProperties.size() + 3);
        for (VertexProperty const &property : plain.vertexProperties) {
            expectValues(FindProperty(limit.vertexProperties, property.name), property.values, 0);
        }
        for (std::size_t v = 0; v < limit.positions.size() / 3; ++v) {
            double sum = 0;
            for (char const *name : {"nx", "ny", "nz"}) {
                VertexProperty const *const normal = FindProperty(limit.vertexProperties, name);
                ASSERT_TRUE(normal && normal->type == NumberType::Float);
                sum += double(normal->values[v]) * double(normal->values[v]);
            }
            EXPECT_NEAR(sum, 1, 1e-5);
        }
    }
    // Normals of the file make room for those of the limit, and are 1 long without --limit.
    Mesh cube = MakeCube();
    for (char const *name : {"nz", "nx", "ny"}) {
        cube.vertexProperties.push_back({name, NumberType::Float, {3, 1, 2, -1, 1, -2, 3, 5}});
    }
    WriteMesh(cube, getPath("normals.ply"));
    Mesh const mesh = refine(getPath("normals.ply") + " -l 2", "out.ply");
    ASSERT_EQ(mesh.vertexProperties.size(), 3u);
    EXPECT_EQ(mesh.vertexProperties[0].name, "nz");
    for (float value : mesh.vertexProperties[0].values) {
        EXPECT_NEAR(std::abs(value), std::sqrt(1.0 / 3), 1e-6);
    }
    Result const result = run(getPath("normals.ply") + " -l 2 --limit -o " + getPath("limit.ply"));
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.out.find("not read: normals, those of --limit replace them\n"),
              std::string::npos)
        << result.out;
    EXPECT_EQ(ReadMesh(getPath("limit.ply")).vertexProperties.size(), 3u);
}

// The materials of refined faces are those of the plane in which they lie, at every level.
TEST_F(HexrefineAttribute, MaterialsStayInTheirFaces) {
    std::string const input = makeMaterialCube() + " --crease-angle 1 -l ";
    int const numFaces[] = {6, 18, 66, 258, 1026, 4098, 16386};
    int const numDiagonals[] = {0, 1, 1, 3, 5, 11, 21}; // of each edge
    for (int level = 0; level <= 6; ++level) {
        SCOPED_TRACE(level);
        Mesh const mesh = refine(input + std::to_string(level), "out.obj");
        ASSERT_EQ(mesh.GetNumFaces(), numFaces[level] + 12 * numDiagonals[level]);
        ASSERT_EQ(mesh.labels.size(), 6u);
        expectInPlanes(mesh, [&](int face) {
            return mesh.labels[std::size_t(mesh.faceLabels[std::size_t(face)])].material[1] - '0';
        });
        // One after the other, whatever the order of the refined faces is.
        std::string const content = getContent(getPath("out.obj"));
        EXPECT_EQ(countLines(content, "usemtl "), 6);
        EXPECT_EQ(countLines(content, "o "), 2);
        EXPECT_EQ(countLines(content, "mtllib six.mtl"), 1);
    }
}

TEST_F(HexrefineAttribute, MaterialsComeBack) {
    // With all that goes along the corners of faces.
    Mesh cube = ReadMesh(makeMaterialCube());
    cube.channels = {{FVarKind::Uv, 2, {0, 0, 1, 0, 1, 1, 0, 1}, {}}};
    for (int i = 0; i < 24; ++i) {
        cube.channels[0].faceValues.push_back(i % 4);
    }
    for (FaceLabel &label : cube.labels) {
        label.groups = "group " + label.material;
        label.smoothing = label.object == "ring" ? "1" : "off";
    }
    WriteMesh(cube, getPath("uv.obj"));
    for (char const *options : {"", " --limit", " --crease-angle 1", " --limit --crease-angle 1"}) {
        SCOPED_TRACE(options);
        Mesh const mesh = refine(getPath("uv.obj") + " -l 2" + options, "out.obj");
        EXPECT_TRUE(mesh.labels == cube.labels);
        EXPECT_EQ(mesh.materialLibraries, cube.materialLibraries);
        ASSERT_GE(mesh.channels.size(), 1u);
        EXPECT_EQ(mesh.channels[0].faceValues.size(), mesh.faceVertices.size());
        // Opened again it is the same.
        std::string const content = getContent(getPath("out.obj"));
        refine(getPath("out.obj") + " -l 0", "again.obj");
        EXPECT_TRUE(getContent(getPath("again.obj")) == content);
        // All faces are there, in other order.
        std::size_t numUncut = 0;
        Mesh const plain = refine(makeCubeFile() + " -l 2", "plain.obj");
        for (int size : mesh.faceSizes) {
            numUncut += size == 6 ? 2 : 1;
        }
        EXPECT_GE(numUncut, plain.faceSizes.size());
        EXPECT_EQ(mesh.GetNumVertices(), plain.GetNumVertices());
    }
}

// Values go with their corners where faces change places.
TEST_F(HexrefineAttribute, ChannelsFollowTheOrderOfMaterials) {
    Mesh cube = ReadMesh(makeMaterialCube());
    cube.channels = {{FVarKind::Uv, 2, std::vector<float>(16, 0.5f), cube.faceVertices}};
    WriteMesh(cube, getPath("uv.obj"));
    Mesh const mesh = refine(getPath("uv.obj") + " -l 3", "out.obj");
    ASSERT_EQ(mesh.channels.size(), 1u);
    EXPECT_EQ(mesh.channels[0].faceValues, mesh.faceVertices);
    EXPECT_GT(mesh.GetNumFaces(), 258);
}

TEST_F(HexrefineAttribute, OnlyBordersOfMaterialsAreCut) {
    // Two quads beside each other, and two of the other material above.
    std::string const vertices = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
                                 "v 0 2 0\nv 1 2 0\nv 2 2 0\n";
    std::string const input =
        makeFile("grid.obj", vertices + "usemtl a\nf 1 2 5 4\nusemtl b\nf 4 5 8 7\nusemtl a\n"
                                        "f 2 3 6 5\nusemtl b\nf 5 6 9 8\n");
    Mesh mesh = refine(input + " -l 1 --boundary edge-and-corner", "out.obj");
    EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 6), 2);
    EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 4), 4 + 8 + 2 * 2);
    EXPECT_EQ(countLines(getContent(getPath("out.obj")), "usemtl "), 2);
    for (int level : {1, 2, 3}) {
        mesh = refine(input + " --boundary edge-and-corner -l " + std::to_string(level), "out.obj");
        int const *vertex = mesh.faceVertices.data();
        double areas[2] = {0, 0};
        for (int face = 0; face < mesh.GetNumFaces(); ++face) {
            int const label = mesh.faceLabels[std::size_t(face)];
            int const size = mesh.faceSizes[std::size_t(face)];
            for (int i = 0; i < size; ++i) {
                float const *point = &mesh.positions[3 * std::size_t(vertex[i])];
                float const *next = &mesh.positions[3 * std::size_t(vertex[(i + 1) % size])];
                // By symmetry the border stays where it is.
                EXPECT_TRUE(label == 0 ? point[1] <= 1 + 1e-6 : point[1] >= 1 - 1e-6);
                areas[label] +=
                    0.5 * (double(point[0]) * double(next[1]) - double(next[0]) * double(point[1]));
            }
            vertex += size;
        }
        EXPECT_NEAR(areas[0], areas[1], 1e-6);
    }
    // A label that all faces share cuts nothing.
    std::string const one = makeFile(
        "one.obj", vertices + "o x\nusemtl a\nf 1 2 5 4\nf 4 5 8 7\nf 2 3 6 5\nf 5 6 9 8\n");
    mesh = refine(one + " -l 1 --boundary edge-and-corner", "out.obj");
    EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 6), 4);
    ASSERT_EQ(mesh.labels.size(), 1u);
    // A hole is left out with its half of the hexagons.
    std::string const hole = makeFile("hole.obj", getContent(input) + "t hole 1/0/0 1\n");
    mesh = refine(hole + " -l 1 --boundary edge-and-corner", "out.obj");
    ASSERT_EQ(mesh.labels.size(), 2u);
    for (int vertex : mesh.faceVertices) {
        float const *point = &mesh.positions[3 * std::size_t(vertex)];
        EXPECT_FALSE(point[0] < 1 - 1e-6 && point[1] > 1 + 1e-6);
    }
}

TEST_F(HexrefineAttribute, NumbersOfFacesStayInThem) {
    for (char const *name : {"out.ply", "out.off"}) {
        Mesh cube = MakeCube();
        cube.faceProperties = {{"red", NumberType::UChar, {0, 50, 100, 150, 200, 250}},
                               {"green", NumberType::UChar, {7, 7, 7, 7, 7, 7}},
                               {"blue", NumberType::UChar, {1, 2, 1, 2, 1, 2}}};
        WriteMesh(cube, getPath("faces.ply"));
        for (int level : {1, 3}) {
            Mesh const mesh = refine(
                getPath("faces.ply") + " --crease-angle 1 -l " + std::to_string(level), name);
            ASSERT_EQ(mesh.faceProperties.size(), 3u);
            expectInPlanes(mesh, [&](int face) {
                return int(mesh.faceProperties[0].values[std::size_t(face)]) / 50;
            });
            for (int face = 0; face < mesh.GetNumFaces(); ++face) {
                auto const i = std::size_t(face);
                EXPECT_EQ(mesh.faceProperties[1].values[i], 7);
                EXPECT_EQ(mesh.faceProperties[2].values[i],
                          int(mesh.faceProperties[0].values[i]) / 50 % 2 + 1);
            }
        }
    }
}

TEST_F(HexrefineAttribute, OtherSchemesKeepMaterials) {
    for (char const *scheme : {"--scheme doo-sabin", "--scheme tri-hex", "--first-step tri-hex",
                               "--coplanar", "--coplanar --open-gaps --tolerance 100"}) {
        SCOPED_TRACE(scheme);
        Mesh const mesh = refine(makeMaterialCube() + " -l 2 " + scheme, "out.obj");
        EXPECT_EQ(mesh.labels.size(), 6u);
        EXPECT_EQ(mesh.faceLabels.size(), mesh.faceSizes.size());
    }
}

TEST_F(HexrefineAttribute, MaterialLibrariesAreFoundFromOtherFolders) {
    std::filesystem::create_directories(getPath("in/colors"));
    std::filesystem::create_directories(getPath("out"));
    makeFile("in/my colors.mtl", "newmtl a\n");
    std::string const faces = "usemtl a\nf 1 2 3\n";
    std::string const input =
        makeFile("in/a.obj", "mtllib my colors.mtl\nmtllib colors/b.mtl /c.mtl missing.mtl\n"
                             "v 0 0 0\nv 1 0 0\nv 0 1 0\n" +
                                 faces);
    EXPECT_EQ(refine(input + " -l 1", "out/a.obj").materialLibraries,
              (Names{"../in/my colors.mtl", "../in/colors/b.mtl /c.mtl ../in/missing.mtl"}));
    EXPECT_EQ(refine(input + " -l 1", "in/b.obj").materialLibraries,
              (Names{"my colors.mtl", "colors/b.mtl /c.mtl missing.mtl"}));
    EXPECT_EQ(refine(input + " -l 1", "in/colors/b.obj").materialLibraries,
              (Names{"../my colors.mtl", "b.mtl /c.mtl ../missing.mtl"}));
}

TEST_F(HexrefineAttribute, PropertyNamedAsTheVerticesOfFacesIsNotWritten) {
    std::string const input = makeFile(
        "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty list uchar int vertex_index\n"
                 "property float vertex_indices\nproperty float quality\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 .5 .25\n");
    Result const result = run(input + " -l 1 -o " + getPath("out.ply"));
    ASSERT_EQ(result.status, 0) << result.error;
    EXPECT_NE(result.out.find("no place for it: face property vertex_indices\n"), std::string::npos)
        << result.out;
    EXPECT_EQ(ReadMesh(getPath("out.ply")).faceProperties.size(), 1u);
}

TEST_F(HexrefineAttribute, MaterialLibrariesOfOneStatementMayHaveAnyExtension) {
    std::filesystem::create_directories(getPath("in/my"));
    std::filesystem::create_directories(getPath("out"));
    makeFile("in/wood.mat", "newmtl a\n");
    std::string const input =
        makeFile("in/a.obj", "mtllib wood.mat metal.mtl my colors.mtl\n"
                             "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    EXPECT_EQ(refine(input + " -l 1", "out/a.obj").materialLibraries,
              (Names{"../in/wood.mat ../in/metal.mtl ../in/my colors.mtl"}));
}

TEST_F(HexrefineAttribute, MissingMaterialLibrariesAreNamedFromOtherFolders) {
    std::filesystem::create_directories(getPath("in"));
    std::filesystem::create_directories(getPath("out"));
    std::string const input = makeFile(
        "in/a.obj", "mtllib my file.mtl other.MTL\nmtllib \"my file.mtl\" C:\\tmp\\b.mtl last\n"
                    "mtllib one two\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    EXPECT_EQ(refine(input + " -l 1", "out/a.obj").materialLibraries,
              (Names{"../in/my file.mtl ../in/other.MTL",
                     "\"../in/my file.mtl\" C:\\tmp\\b.mtl ../in/last", "../in/one ../in/two"}));
}

TEST(PictureColors, AreThoseOfLabels) {
    Mesh mesh;
    mesh.faceSizes.assign(5, 3);
    mesh.labels = {{"o", "g", "red"}, {"o", "h", "red"}, {"p", "g", ""}};
    mesh.faceLabels = {0, 1, 2, 0, 2};
    using Regions = std::vector<int>;
    EXPECT_EQ(FindRegions("", mesh, "file"), Regions());
    EXPECT_EQ(FindRegions("base-faces", mesh, "file"), (Regions{0, 1, 2, 3, 4}));
    EXPECT_EQ(FindRegions("materials", mesh, "file"), (Regions{0, 0, 1, 0, 1}));
    EXPECT_EQ(FindRegions("groups", mesh, "file"), (Regions{0, 1, 0, 0, 0}));
    EXPECT_EQ(FindRegions("objects", mesh, "file"), (Regions{0, 0, 1, 0, 1}));
    // One for all is one colour; none is a mistake.
    mesh.faceLabels.assign(5, 0);
    EXPECT_EQ(FindRegions("materials", mesh, "file"), Regions(5, 0));
    mesh.faceLabels.assign(5, 2);
    EXPECT_THROW(FindRegions("materials", mesh, "file"), FileError);
    mesh.faceLabels.clear();
    EXPECT_THROW(FindRegions("groups", mesh, "file"), FileError);
}

} // namespace OpenSubdivHex::Tools::attributeTest

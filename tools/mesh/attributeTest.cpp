// SPDX-License-Identifier: Apache-2.0
//
// Data of vertices and faces of mesh files beside positions: colours and other numbers, objects,
// groups and materials.  They are read, and written where the format holds them, or named.
#include "meshContent.h"
#include "meshFileFixture.h"
#include "meshWriter.h"
#include "shapes.h"

#include <cstdint>
#include <cstring>

namespace OpenSubdivHex::Tools::attributeTest {

namespace {

using Names = std::vector<std::string>;

template <typename PROPERTY>
Names getNames(std::vector<PROPERTY> const &properties) {
    Names names;
    for (PROPERTY const &property : properties) {
        names.push_back(std::string(GetName(property.type)) + " " + property.name);
    }
    return names;
}

template <typename T>
void put(T value, bool isBigEndian, std::string *out) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    *out += isBigEndian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

/// A cube with the extreme numbers of every type at its vertices and on its faces.
Mesh makeManyTypes() {
    Mesh mesh = MakeCube();
    for (int i = 0; i < 8; ++i) {
        auto const type = NumberType(i);
        double const low = IsInteger(type) ? GetMin(type) : -0.5;
        // Floats do not hold the largest integers.
        double const high = IsInteger(type) && GetSize(type) < 4 ? GetMax(type) : 16777216;
        VertexProperty vertex{std::string("v") + GetName(type), type, {}};
        FaceProperty face{std::string("f") + GetName(type), type, {}};
        for (int k = 0; k < 8; ++k) {
            vertex.values.push_back(float(k == 0 ? low : k == 1 ? high : k));
        }
        for (int k = 0; k < 6; ++k) {
            double const exact = IsInteger(type)             ? GetMax(type)
                                 : type == NumberType::Float ? 0.5
                                                             : 0.1;
            face.values.push_back(k == 0 ? low : k == 1 ? exact : k);
        }
        mesh.vertexProperties.push_back(vertex);
        mesh.faceProperties.push_back(face);
    }
    return mesh;
}

std::string const kVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\n";

} // namespace

using Attributes = MeshFile;

TEST_F(Attributes, PlyKeepsNamesTypesAndBits) {
    Mesh const mesh = makeManyTypes();
    WriteMesh(mesh, getPath("a.ply"));
    Mesh const copy = ReadMesh(getPath("a.ply"));
    expectEqual(copy, mesh);
    EXPECT_TRUE(copy.notRead.empty());
    EXPECT_EQ(getNames(copy.vertexProperties),
              (Names{"char vchar", "uchar vuchar", "short vshort", "ushort vushort", "int vint",
                     "uint vuint", "float vfloat", "double vdouble"}));
}

TEST_F(Attributes, PlyOfEitherOrderOfBytes) {
    for (bool isBigEndian : {false, true}) {
        std::string content =
            std::string("ply\nformat binary_") + (isBigEndian ? "big" : "little") +
            "_endian 1.0\nelement vertex 3\nproperty char a\nproperty int16 x\n"
            "property list uchar short l\nproperty uint8 y\nproperty int z\nproperty uint32 b\n"
            "property double c\nelement face 1\nproperty ushort d\n"
            "property list int8 uint32 vertex_index\nproperty list uint8 float uv\n"
            "property float64 e\nend_header\n";
        for (int i = 0; i < 3; ++i) {
            put(std::int8_t(-i), isBigEndian, &content);
            put(std::int16_t(-1000 * i), isBigEndian, &content);
            put(std::uint8_t(i), isBigEndian, &content);
            for (int k = 0; k < i; ++k) {
                put(std::int16_t(k), isBigEndian, &content);
            }
            put(std::uint8_t(i == 0 ? 0 : 255), isBigEndian, &content);
            put(std::int32_t(100000 * i), isBigEndian, &content);
            put(std::uint32_t(4000000000u), isBigEndian, &content);
            put(0.25 * i, isBigEndian, &content);
        }
        put(std::uint16_t(65535), isBigEndian, &content);
        put(std::int8_t(3), isBigEndian, &content);
        for (std::uint32_t vertex : {2u, 0u, 1u}) {
            put(vertex, isBigEndian, &content);
        }
        put(std::uint8_t(0), isBigEndian, &content);
        put(0.1, isBigEndian, &content);
        Mesh const mesh = ReadMesh(makeFile("a.ply", content));
        EXPECT_EQ(mesh.positions,
                  (std::vector<float>{0, 0, 0, -1000, 255, 100000, -2000, 255, 200000}));
        EXPECT_EQ(mesh.faceVertices, (std::vector<int>{2, 0, 1}));
        EXPECT_EQ(getNames(mesh.vertexProperties), (Names{"char a", "uint b", "double c"}));
        EXPECT_EQ(mesh.vertexProperties[0].values, (std::vector<float>{0, -1, -2}));
        EXPECT_EQ(mesh.vertexProperties[1].values, std::vector<float>(3, 4e9f));
        EXPECT_EQ(mesh.vertexProperties[2].values, (std::vector<float>{0, 0.25f, 0.5f}));
        EXPECT_EQ(getNames(mesh.faceProperties), (Names{"ushort d", "double e"}));
        EXPECT_EQ(mesh.faceProperties[0].values, std::vector<double>{65535});
        EXPECT_EQ(mesh.faceProperties[1].values, std::vector<double>{0.1});
        EXPECT_EQ(mesh.notRead, (Names{"list l of vertices", "list uv of faces"}));
        for (std::size_t size = 1; size < content.size(); ++size) {
            EXPECT_THROW(ReadMesh(makeFile("b.ply", content.substr(0, size))), FileError) << size;
        }
    }
}

TEST_F(Attributes, PlyElementsInAnyOrder) {
    std::string const path = makeFile(
        "a.ply", "ply\nformat ascii 1.0\ncomment TextureFile wood and steel.png\nelement camera 1\n"
                 "property list uchar float m\nelement face 2\nproperty uchar red\n"
                 "property list uchar int vertex_indices\nelement none 0\nproperty int n\n"
                 "element vertex 4\nproperty int x\nproperty int y\nproperty int z\n"
                 "property float quality\nproperty double time\nelement edge 1\nproperty int a\n"
                 "property int b\nend_header\n\n"
                 "2 .5 1\n7 3 0 1 2\n255 3 0 2 3\n0 0 0 .5 0.1\n+1 0 0 1 0.1\n"
                 "16777217 1 0 1e-3 0.1\n0 -1 0 -1 0.1\n0 1\n");
    Mesh const mesh = ReadMesh(path);
    EXPECT_EQ(mesh.positions, (std::vector<float>{0, 0, 0, 1, 0, 0, 16777216, 1, 0, 0, -1, 0}));
    EXPECT_EQ(mesh.faceVertices, (std::vector<int>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(getNames(mesh.faceProperties), Names{"uchar red"});
    EXPECT_EQ(mesh.faceProperties[0].values, (std::vector<double>{7, 255}));
    ASSERT_EQ(getNames(mesh.vertexProperties), (Names{"float quality", "double time"}));
    EXPECT_EQ(mesh.vertexProperties[0].values, (std::vector<float>{.5f, 1, 1e-3f, -1}));
    EXPECT_EQ(mesh.notRead, (Names{"texture file wood and steel.png", "element camera",
                                   "digits of x that floats do not have",
                                   "digits of time that floats do not have", "element edge"}));
}

TEST_F(Attributes, PlyFilesHaveNoFacePropertyNamedAsTheListOfVertices) {
    Mesh mesh;
    mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    mesh.faceSizes = {3};
    mesh.faceVertices = {0, 1, 2};
    mesh.faceProperties = {{"vertex_indices", NumberType::Int, {7}},
                           {"quality", NumberType::Float, {.25}}};
    WriteMesh(mesh, getPath("a.ply"));
    Mesh const read = ReadMesh(getPath("a.ply"));
    EXPECT_EQ(read.faceVertices, mesh.faceVertices);
    EXPECT_EQ(getNames(read.faceProperties), Names{"float quality"});
    EXPECT_EQ(read.faceProperties[0].values, std::vector<double>{.25});
}

TEST_F(Attributes, RefusesBadPlyProperties) {
    std::string const header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty list uchar float l\nproperty double d\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty float f\nend_header\n";
    std::string const vertex = "0 0 0 1 0 0\n";
    auto const refuse = [&](std::string const &lines, std::string const &cause) {
        expectRefused("a.ply", header + lines, cause);
    };
    EXPECT_NO_THROW(ReadMesh(makeFile("a.ply", header + vertex + vertex + vertex + "3 0 1 2 .5")));
    refuse("0 0 0 256 0 0\n", "line 14: '256' is not a number of type uchar");
    refuse("0 0 0 -1 0 0\n", "line 14: '-1' is not a number of type uchar");
    refuse("0 0 0 1.0 0 0\n", "line 14: '1.0' is not a number of type uchar");
    refuse("0 0 0 1 0 inf\n", "line 14: 'inf' is not a finite number of type double");
    refuse("0 0 0 1 0 1e300\n", "line 14: vertex 0 has a d that is out of the range of floats");
    refuse("0 1e39 0 1 0 0\n", "line 14: '1e39' is out of the range of floats");
    refuse("0 0 0 1 1 x 0\n", "line 14: 'x' is not a finite number of type float");
    refuse("0 0 0 1 2 .25 0\n", "line 14: the line of vertex 0 ends too early");
    refuse("0 0 0 1 55 1 0\n", "line 14: vertex 0 has a list 'l' of 55 numbers, which are");
    refuse("0 0 0 1 1 1 0 7\n", "line 14: the line of vertex 0 has too many values");
    refuse(vertex + vertex + vertex + "3 0 1 2\n", "line 17: the line of face 0 ends too early");
    refuse(vertex + vertex + vertex + "3 0 1 2 nan\n", "line 17: 'nan' is not a finite number");
}

TEST_F(Attributes, ObjKeepsColorsAndWeights) {
    std::string const faces = "f 1 2 3\n";
    Mesh mesh =
        ReadMesh(makeFile("a.obj", "v 0 0 0 1 0 0.1\nv 1 0 0 .5 .25 1\nv 1 1 0 0 0 2\n" + faces));
    ASSERT_EQ(getNames(mesh.vertexProperties), (Names{"float red", "float green", "float blue"}));
    EXPECT_EQ(mesh.vertexProperties[0].values, (std::vector<float>{1, .5f, 0}));
    EXPECT_EQ(mesh.vertexProperties[2].values, (std::vector<float>{.1f, 1, 2}));
    WriteMesh(mesh, getPath("b.obj"));
    EXPECT_EQ(getContent(getPath("b.obj")),
              "v 0 0 0 1 0 0.1\nv 1 0 0 0.5 0.25 1\nv 1 1 0 0 0 2\nf 1 2 3\n");
    expectEqual(ReadMesh(getPath("b.obj")), mesh);

    mesh = ReadMesh(makeFile("a.obj", "v 0 0 0\nv 1 0 0 2\nv 1 1 0 0.5\n" + faces));
    ASSERT_EQ(getNames(mesh.vertexProperties), Names{"float w"});
    EXPECT_EQ(mesh.vertexProperties[0].values, (std::vector<float>{1, 2, .5f}));
    WriteMesh(mesh, getPath("b.obj"));
    EXPECT_EQ(getContent(getPath("b.obj")), "v 0 0 0 1\nv 1 0 0 2\nv 1 1 0 0.5\nf 1 2 3\n");

    // A weight of 1 says nothing.
    mesh = ReadMesh(makeFile("a.obj", "v 0 0 0 1\nv 1 0 0 1.0\nv 1 1 0\n" + faces));
    EXPECT_TRUE(mesh.vertexProperties.empty());
    EXPECT_TRUE(mesh.notRead.empty());

    mesh = ReadMesh(makeFile("a.obj", "v 0 0 0\nv 1 0 0 2\nv 1 1 0 0 .5 1\n" + faces));
    EXPECT_EQ(getNames(mesh.vertexProperties),
              (Names{"float w", "float red", "float green", "float blue"}));
    EXPECT_EQ(mesh.vertexProperties[2].values, (std::vector<float>{1, 1, .5f}));
    EXPECT_EQ(mesh.notRead, Names{"lack of colour at 2 vertices (white)"});
    EXPECT_EQ(RemoveWhatIsNotHeld("c.obj", &mesh), Names{"vertex property w"});

    for (char const *numbers : {"1 2", "1 2 3 4", "1 2 3 4 5"}) {
        expectRefused("a.obj", std::string("v 0 0 0 ") + numbers + "\n",
                      "line 1: a vertex has three numbers, four with its w or six with its colour");
    }
    expectRefused("a.obj", "v 0 0 0 1 0 x\n", "line 1: 'x' is not a finite number");
    expectRefused("a.obj", "v 0 0 0 nan\n", "line 1: 'nan' is not a finite number");
    expectRefused("a.obj", "v 0 0 -1e300\n", "line 1: '-1e300' is out of the range of floats");
}

TEST_F(Attributes, ObjKeepsLabels) {
    std::string const faces = "o the cube\ng a b\nusemtl Material #25\ns off\nf 1 2 3\n"
                              "usemtl steel\ns 1\nf 1 3 4\no other\nf 2 3 5\n";
    Mesh const mesh =
        ReadMesh(makeFile("a.obj", "mtllib my colours.mtl\nmtllib b.mtl\n" + kVertices + faces));
    EXPECT_EQ(mesh.materialLibraries, (Names{"my colours.mtl", "b.mtl"}));
    ASSERT_EQ(mesh.labels.size(), 3u);
    EXPECT_TRUE(mesh.labels[0] == (FaceLabel{"the cube", "a b", "Material #25", "off"}));
    EXPECT_TRUE(mesh.labels[1] == (FaceLabel{"the cube", "a b", "steel", "1"}));
    EXPECT_TRUE(mesh.labels[2] == (FaceLabel{"other", "a b", "steel", "1"}));
    EXPECT_EQ(mesh.faceLabels, (std::vector<int>{0, 1, 2}));
    EXPECT_TRUE(mesh.notRead.empty());
    WriteMesh(mesh, getPath("b.obj"));
    EXPECT_EQ(getContent(getPath("b.obj")),
              "mtllib my colours.mtl\nmtllib b.mtl\n" + kVertices + faces);
    expectEqual(ReadMesh(getPath("b.obj")), mesh);
}

TEST_F(Attributes, ObjLabelsComeAndGo) {
    // A label that comes again is the same; a keyword alone ends what it began; a name may end in
    // what joins lines.
    Mesh mesh =
        ReadMesh(makeFile("a.obj", kVertices + "f 1 2 3\nusemtl a\nusemtl b\\ \nf 1 2 3\n"
                                               "usemtl\nf 1 3 4\n  usemtl\tb\\ \ns\nf 2 3 5"));
    ASSERT_EQ(mesh.labels.size(), 2u);
    EXPECT_EQ(mesh.labels[1].material, "b\\");
    EXPECT_EQ(mesh.faceLabels, (std::vector<int>{0, 1, 0, 1}));
    WriteMesh(mesh, getPath("b.obj"));
    expectEqual(ReadMesh(getPath("b.obj")), mesh);
    // Nothing is said of any face.
    mesh = ReadMesh(makeFile("a.obj", kVertices + "o\nf 1 2 3\nusemtl a\n"));
    EXPECT_TRUE(mesh.labels.empty());
    EXPECT_TRUE(mesh.faceLabels.empty());
    // Faces of a refined mesh have the labels of their base faces.
    mesh = ReadMesh(makeFile("a.obj", kVertices + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n"));
    mesh.baseFaces = {1, 0};
    WriteMesh(mesh, getPath("b.obj"));
    EXPECT_EQ(getContent(getPath("b.obj")), kVertices + "usemtl b\nf 1 2 3\nusemtl a\nf 1 3 4\n");
}

TEST_F(Attributes, ObjNamesWhatItLeavesOut) {
    Mesh const mesh =
        ReadMesh(makeFile("a.obj", kVertices + "vp 0 1\nl 1 2\nl 2 3\np 1\nvt 0 0\nf 1 2 3\n"
                                               "maplib x\nlod 3\n"));
    EXPECT_EQ(mesh.notRead, (Names{"statement vp", "statement l", "statement p", "statement maplib",
                                   "statement lod", "texture coordinates that no face has"}));
}

TEST_F(Attributes, OffKeepsColors) {
    auto const expectKept = [&](std::string const &content, Names const &vertexNames,
                                Names const &faceNames) {
        SCOPED_TRACE(content);
        Mesh const mesh = ReadMesh(makeFile("a.off", content));
        EXPECT_EQ(getNames(mesh.vertexProperties), vertexNames);
        EXPECT_EQ(getNames(mesh.faceProperties), faceNames);
        EXPECT_TRUE(mesh.notRead.empty());
        WriteMesh(mesh, getPath("b.off"));
        EXPECT_EQ(getContent(getPath("b.off")), content);
        expectEqual(ReadMesh(getPath("b.off")), mesh);
    };
    expectKept("COFF\n3 1 0\n0 0 0 255 0 7\n1 0 0 0 1 2\n1 1 0 9 9 9\n3 0 1 2\n",
               {"uchar red", "uchar green", "uchar blue"}, {});
    expectKept("COFF\n3 1 0\n0 0 0 1.0 0.5 0.0 0.1\n1 0 0 0.0 1.0 1.0 1.0\n1 1 0 1e+10 -1.0 0.0 "
               "0.0\n3 0 1 2 1.0 0.5 0.25\n",
               {"float red", "float green", "float blue", "float alpha"},
               {"float red", "float green", "float blue"});
    expectKept("STCNOFF\n3 2 0\n0 0 0 0.0 0.0 1.0 1 2 3 0.5 1.0\n"
               "1 0 0 0.0 1.0 0.0 4 5 6 0.25 0.0\n1 1 0 -1.0 0.0 0.0 7 8 9 1.0 1.0\n"
               "3 0 1 2 0 0 0 255\n3 2 1 0 255 0 128 1\n",
               {"float nx", "float ny", "float nz", "uchar red", "uchar green", "uchar blue",
                "float s", "float t"},
               {"uchar red", "uchar green", "uchar blue", "uchar alpha"});
    EXPECT_EQ(ReadMesh(getPath("a.off")).vertexProperties[4].values, (std::vector<float>{2, 5, 8}));
    EXPECT_EQ(ReadMesh(getPath("a.off")).faceProperties[2].values, (std::vector<double>{0, 128}));
}

TEST_F(Attributes, OffNamesColorsThatDiffer) {
    std::string const vertices = "0 0 0\n1 0 0 1 0 0\n1 1 0\n";
    Names const ofVertices{"colours of vertices, not all of which have one alike"};
    Names const ofFaces{"colours of faces, not all of which have one alike"};
    auto const read = [&](std::string const &content) {
        Mesh const mesh = ReadMesh(makeFile("a.off", content));
        EXPECT_TRUE(mesh.vertexProperties.empty());
        EXPECT_TRUE(mesh.faceProperties.empty());
        return mesh.notRead;
    };
    EXPECT_EQ(read("OFF\n3 1\n0 0 0\n1 0 0 1 0 0\n1 1 0\n3 0 1 2\n"), ofVertices);
    EXPECT_EQ(read("OFF\n3 1\n0 0 0 1 0 0\n1 0 0 1 0 0 1\n1 1 0 1 0 0\n3 0 1 2\n"), ofVertices);
    EXPECT_EQ(read("OFF\n3 1\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2 7\n"), ofFaces);
    EXPECT_EQ(read("OFF\n3 2\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2 0 0 0\n3 0 2 1\n"), ofFaces);
    std::string const begin = "OFF\n3 1\n0 0 0 ";
    expectRefused("a.off", begin + "x 0 0\n", "line 3: the line of vertex 0 has 'x', which is not");
    expectRefused("a.off", begin + "1 2 3 4 5\n", "line 3: the line of vertex 0 has too many");
    expectRefused("a.off", "NOFF\n3 1\n0 0 0 1 0\n", "line 3: the line of vertex 0 has too few");
    expectRefused("a.off", "NOFF\n3 1\n0 0 0 1 0 nan\n", "line 3: the line of vertex 0 has 'nan'");
    expectRefused("a.off", "OFF\n3 1\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2 1 y 0\n",
                  "line 6: the line of face 0 has 'y', which is not");
}

TEST_F(Attributes, NumbersAreRoundedToTheirType) {
    Mesh mesh = MakeCube();
    std::vector<float> const values = {-3, 0.49f, 0.5f, 127.5f, 254.6f, 255.4f, 300, 1e30f};
    mesh.vertexProperties = {{"a", NumberType::UChar, values}, {"b", NumberType::Int, values}};
    WriteMesh(mesh, getPath("a.ply"));
    Mesh const copy = ReadMesh(getPath("a.ply"));
    EXPECT_EQ(copy.vertexProperties[0].values,
              (std::vector<float>{0, 0, 1, 128, 255, 255, 255, 255}));
    EXPECT_EQ(copy.vertexProperties[1].values,
              (std::vector<float>{-3, 0, 1, 128, 255, 255, 300, 2147483648.0f}));
}

TEST_F(Attributes, FormatsTakeColorsFromEachOther) {
    Mesh mesh = MakeCube();
    mesh.vertexProperties = {{"quality", NumberType::Float, std::vector<float>(8, 3)},
                             {"blue", NumberType::UChar, std::vector<float>(8, 51)},
                             {"red", NumberType::UChar, std::vector<float>(8, 255)},
                             {"green", NumberType::UChar, std::vector<float>(8, 0)},
                             {"alpha", NumberType::UChar, std::vector<float>(8, 128)}};
    mesh.faceProperties = {{"flags", NumberType::Int, std::vector<double>(6, 3)}};
    mesh.channels = {{FVarKind::Uv, 2, {0, 0}, std::vector<int>(24, 0)}};
    mesh.labels = {{"a", "", "b", ""}};
    mesh.faceLabels.assign(6, 0);
    mesh.materialLibraries = {"c.mtl"};

    Mesh copy = mesh;
    EXPECT_EQ(RemoveWhatIsNotHeld("a.ply", &copy),
              (Names{"channel uv", "objects", "materials", "material libraries"}));
    WriteMesh(mesh, getPath("a.ply"));
    expectEqual(ReadMesh(getPath("a.ply")), copy);

    copy = mesh;
    EXPECT_EQ(RemoveWhatIsNotHeld("a.off", &copy),
              (Names{"channel uv", "vertex property quality", "face property flags", "objects",
                     "materials", "material libraries"}));
    WriteMesh(mesh, getPath("a.off"));
    EXPECT_EQ(getContent(getPath("a.off")).substr(0, 36),
              "COFF\n8 6 0\n-1 -1 1 255 0 51 128\n1 -1");

    copy = mesh;
    EXPECT_EQ(RemoveWhatIsNotHeld("a.obj", &copy),
              (Names{"vertex property quality", "vertex property alpha", "face property flags"}));
    WriteMesh(mesh, getPath("a.obj"));
    Mesh const obj = ReadMesh(getPath("a.obj"));
    EXPECT_EQ(getNames(obj.vertexProperties), (Names{"float red", "float green", "float blue"}));
    EXPECT_EQ(obj.vertexProperties[2].values, std::vector<float>(8, 0.2f));
    EXPECT_TRUE(obj.labels == mesh.labels);

    // Not of a type that has a largest number, or not of one type.
    mesh.vertexProperties[1].type = NumberType::UShort;
    copy = mesh;
    EXPECT_EQ(RemoveWhatIsNotHeld("a.obj", &copy).size(), 6u);
    EXPECT_TRUE(copy.vertexProperties.empty());
    EXPECT_TRUE(RemoveWhatIsNotHeld("a.stl", &mesh).empty());
}

} // namespace OpenSubdivHex::Tools::attributeTest

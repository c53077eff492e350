// SPDX-License-Identifier: Apache-2.0
//
// Mesh files: what is written is what is read, and what cannot be read as it stands is refused.
#include "meshFileFixture.h"
#include "meshWriter.h"
#include "shapes.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

namespace OpenSubdivHex::Tools::meshFileTest {

namespace {

/// One triangle, one quad, one pentagon, one hexagon and one face of \p size corners, over
/// vertices whose coordinates use all bits of a float.  Edges with many faces, repeated faces and
/// unused vertices are there on purpose: a reader has no business with them.
Mesh makeSoup(int size) {
    Mesh mesh;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> mantissa(-1, 1);
    std::uniform_int_distribution<int> exponent(-30, 30);
    for (int i = 0; i < 3 * (size + 1); ++i) {
        mesh.positions.push_back(std::ldexp(mantissa(random), exponent(random)));
    }
    mesh.positions[0] = -0.0f;
    mesh.positions[1] = std::numeric_limits<float>::max();
    mesh.positions[2] = std::numeric_limits<float>::denorm_min();
    mesh.positions[3] = -0x1.babe48p+36f; // tinyobj rounds its decimals to the wrong side
    for (int faceSize : {3, 3, 3, 4, 5, 6, size}) {
        mesh.faceSizes.push_back(faceSize);
        for (int i = 0; i < faceSize; ++i) {
            mesh.faceVertices.push_back(i);
        }
    }
    return mesh;
}

/// A PLY file of one triangle in binary, the parts of which can be replaced.
struct BinaryPly {
    std::string format = "binary_little_endian 1.0";
    std::string headerEnd; ///< lines before end_header
    std::string coordinateTypes = "float";
    std::string countType = "uchar";
    std::string indexType = "int";
    std::string vertices;
    std::string faces;

    std::string Print() const {
        return "ply\nformat " + format + "\nelement vertex 3\nproperty " + coordinateTypes +
               " x\nproperty " + coordinateTypes + " y\nproperty " + coordinateTypes +
               " z\nelement face 1\nproperty list " + countType + " " + indexType +
               " vertex_indices\n" + headerEnd + "end_header\n" + vertices + faces;
    }
};

template <typename T>
std::string bytes(std::vector<T> const &values, bool isBigEndian = false) {
    std::string result;
    for (T value : values) {
        std::string one(sizeof value, '\0');
        std::memcpy(one.data(), &value, sizeof value);
        result += isBigEndian ? std::string(one.rbegin(), one.rend()) : one;
    }
    return result;
}

std::vector<float> const kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

BinaryPly makeBinaryPly() {
    BinaryPly ply;
    ply.vertices = bytes(kTriangle);
    ply.faces = bytes<unsigned char>({3}) + bytes<int>({0, 1, 2});
    return ply;
}

std::string const kTextPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
std::string const kFourVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

} // namespace

TEST_F(MeshFile, RoundTripKeepsEveryBit) {
    for (char const *name : {"soup.obj", "soup.off", "soup.ply", "SOUP.PLY"}) {
        SCOPED_TRACE(name);
        for (int size : {6, 255, 256, 360, 70000}) {
            Mesh const mesh = makeSoup(size);
            WriteMesh(mesh, getPath(name));
            expectEqual(ReadMesh(getPath(name)), mesh);
        }
    }
}

/// More faces and vertices than the writer prints at a time, faces of 3 to 9 corners.
TEST_F(MeshFile, RoundTripOfManyFaces) {
    Mesh mesh;
    constexpr int kNumVertices = 140001;
    for (int i = 0; i < 3 * kNumVertices; ++i) {
        mesh.positions.push_back(float(i) / 7);
    }
    for (int i = 0; i < 139999; ++i) {
        mesh.faceSizes.push_back(3 + i % 7);
        for (int k = 0; k < mesh.faceSizes.back(); ++k) {
            mesh.faceVertices.push_back((i + k) % kNumVertices);
        }
    }
    for (char const *name : {"many.obj", "many.off", "many.ply"}) {
        SCOPED_TRACE(name);
        WriteMesh(mesh, getPath(name));
        expectEqual(ReadMesh(getPath(name)), mesh);
    }
}

TEST_F(MeshFile, WritesWhatItSays) {
    Mesh const mesh{{0, 0.5f, -1, 1e-7f, 2, 3, 4, 5, 6}, {3}, {2, 0, 1}};
    WriteMesh(mesh, getPath("a.obj"));
    EXPECT_EQ(getContent(getPath("a.obj")), "v 0 0.5 -1\nv 1e-07 2 3\nv 4 5 6\nf 3 1 2\n");
    WriteMesh(mesh, getPath("a.off"));
    EXPECT_EQ(getContent(getPath("a.off")), "OFF\n3 1 0\n0 0.5 -1\n1e-07 2 3\n4 5 6\n3 2 0 1\n");
    WriteMesh(mesh, getPath("a.ply"));
    EXPECT_EQ(getContent(getPath("a.ply")),
              "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
              "property float y\nproperty float z\nelement face 1\n"
              "property list uchar int vertex_indices\nend_header\n" +
                  bytes(mesh.positions) + bytes<unsigned char>({3}) + bytes<int>({2, 0, 1}));
}

TEST_F(MeshFile, ReadsObj) {
    std::string const vertices = "v 0 0 0\nv 1 0 0 1\nv +1.5e0 1 0\nv .5 1. 0 1 0 0\n";
    expectFaces("a.obj", vertices + "f 1 2 3 4\n", 4, {4}, {0, 1, 2, 3});
    expectFaces("a.obj", "vt 0 0\nvn 0 0 1\n" + vertices + "f 1/1/1 2/1/1 3/-1/-1 4/1/1", 4, {4},
                {0, 1, 2, 3});
    expectFaces("a.obj", vertices + "f -4 -3 -1\nf 1 2 -2\n", 4, {3, 3}, {0, 1, 3, 0, 1, 2});
    expectFaces("a.obj", "v 1e-50 -1e-300 0\nf 1 1 1\n", 1, {3}, {0, 0, 0});
    expectFaces("a.obj", "f 1 2 3\n" + vertices, 4, {3}, {0, 1, 2});
    expectFaces("a.obj", vertices + "g x\ns off\nusemtl y\nl 1 2\nvt 0 0\nvn 0 0 1\n\tf 1 2 3 # z",
                4, {3}, {0, 1, 2});
    expectFaces("a.obj", "\xEF\xBB\xBF" + vertices + "f 1 \\\n 2 \\\r\n 3\r\nf 2 3 4\r\n", 4,
                {3, 3}, {0, 1, 2, 1, 2, 3});
    // Repeated vertices and repeated faces are what the file says.
    expectFaces("a.obj", vertices + "f 1 1 2 3\nf 1 2 3\nf 1 2 3\n", 4, {4, 3, 3},
                {0, 0, 1, 2, 0, 1, 2, 0, 1, 2});
}

TEST_F(MeshFile, FormFeedsAreSpaces) {
    std::string const vertices = "v 0 0 0\nv\f1 0\v0\nv 1 1 0\nv 0 1 0\n";
    expectFaces("a.obj", vertices + "f 1 2 3\f4\nf\v1 2 \f3\n", 4, {4, 3}, {0, 1, 2, 3, 0, 1, 2});
    expectFaces("a.off", "OFF\f4 1\n0 0\v0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2\f3\n", 4, {4},
                {0, 1, 2, 3});
}

// Every end of lines, a byte order mark or none, in each format.
TEST_F(MeshFile, ReadsAllEndsOfLines) {
    Mesh const mesh = makeSoup(7);
    auto const replaceAll = [](std::string text, std::string const &from, std::string const &to) {
        for (std::size_t i = text.find(from); i != std::string::npos;
             i = text.find(from, i + to.size())) {
            text.replace(i, from.size(), to);
        }
        return text;
    };
    WriteMesh(mesh, getPath("a.obj"));
    WriteMesh(mesh, getPath("a.off"));
    std::string ply =
        "ply\nformat ascii 1.0\ncomment end_header\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    std::vector<float> const positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    for (std::string const mark : {"", "\xEF\xBB\xBF"}) {
        for (char const *const end : {"\n", "\r", "\r\n"}) {
            SCOPED_TRACE(::testing::PrintToString(mark + end));
            for (char const *const name : {"a.obj", "a.off"}) {
                std::string const content = getContent(getPath(name));
                expectEqual(ReadMesh(makeFile(std::string("b.") + (name + 2),
                                              mark + replaceAll(content, "\n", end))),
                            mesh);
            }
            std::string const text = ply + kFourVertices + "4 0 1 2 3\n";
            expectFaces("b.ply", mark + replaceAll(text, "\n", end), 4, {4}, {0, 1, 2, 3});
            // The first number of the body begins with the byte of a line feed, or of a carriage return.
            for (bool const isBig : {false, true}) {
                for (std::uint32_t const byte : {0x0a, 0x0d}) {
                    std::uint32_t const bits = isBig ? byte << 24 : byte;
                    std::vector<float> numbers = positions;
                    std::memcpy(&numbers[0], &bits, sizeof bits);
                    std::string const header = replaceAll(
                        ply, "ascii", isBig ? "binary_big_endian" : "binary_little_endian");
                    std::string const body = bytes(numbers, isBig) + bytes<unsigned char>({4}) +
                                             bytes<int>({0, 1, 2, 3}, isBig);
                    expectFaces("b.ply", mark + replaceAll(header, "\n", end) + body, 4, {4},
                                {0, 1, 2, 3});
                    EXPECT_EQ(ReadMesh(getPath("b.ply")).positions, numbers);
                }
            }
        }
    }
    expectFaces("a.ply", "ply \t\n" + ply.substr(4) + kFourVertices + "3 0 1 2", 4, {3}, {0, 1, 2});
    expectRefused("a.ply", "ply 1\n" + ply.substr(4) + kFourVertices + "3 0 1 2",
                  "does not begin with 'ply'");
    expectRefused("a.ply", "ply\rformat ascii 2.0\r", "line 2: format 'ascii 2.0'");
}

/// Reads a file of the four corners of a square, in lines 1 to 4, and \p rest; gives its warnings.
class ObjBackslash : public MeshFile {
protected:
    std::vector<std::string> read(std::string const &rest, std::vector<int> const &faceSizes,
                                  std::string const &material = "") const {
        SCOPED_TRACE(rest);
        Mesh const mesh =
            ReadMesh(makeFile("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + rest));
        EXPECT_EQ(mesh.faceSizes, faceSizes);
        EXPECT_EQ(mesh.labels.empty() ? "" : mesh.labels.back().material, material);
        WriteMesh(mesh, getPath("b.obj"));
        expectEqual(ReadMesh(getPath("b.obj")), mesh);
        EXPECT_TRUE(ReadMesh(getPath("b.obj")).warnings.empty());
        return mesh.warnings;
    }
};

TEST_F(ObjBackslash, JoinsLines) {
    EXPECT_TRUE(
        read("f 1 2 \\\n 3 4\nusemtl wood \\\noak\\\n\nf 1 2 3\n", {4, 3}, "wood  oak").empty());
    // A line may begin with a keyword, and be no statement.
    EXPECT_TRUE(read("usemtl wood\\\nf\nf 1 2 3\n", {3}, "wood f").empty());
    EXPECT_TRUE(read("usemtl wood\\\nl x 1\nf 1 2 3\n", {3}, "wood l x 1").empty());
    EXPECT_TRUE(read("\\\nf 1 2 3\n \\\n\\\nf 1 2 3\\", {3, 3}).empty());
}

TEST_F(ObjBackslash, LosesNoStatement) {
    std::string const cause = " does not join it with the next, which begins with a statement, '";
    using Warnings = std::vector<std::string>;
    EXPECT_EQ(read("usemtl wood\\\nf 1 3 4 2\nf 1 2 3\n", {4, 3}, "wood\\"),
              Warnings{"the backslash at the end of line 5" + cause + "f'"});
    for (char const *const statement :
         {"o", "g", "s", "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj"}) {
        EXPECT_EQ(read(statement + std::string(" C:\\models\\\nf 1 3 4 2\nf 1 2 3\n"), {4, 3}),
                  Warnings{"the backslash at the end of line 5" + cause + "f'"});
    }
    EXPECT_EQ(read("l 1 2 \\\nf -1 -2 -3\n", {3}),
              Warnings{"the backslash at the end of line 5" + cause + "f'"});
    for (char const *const next : {"v -1 0 0",     "vt .5 0",     "vn 0 0 1",
                                   "vp 0 1",       "l 1 2",       "p 1",
                                   "s 1",          "s off",       "mg 1 2",
                                   "lod 3",        "bevel on",    "c_interp off",
                                   "d_interp off", "o a",         "g a",
                                   "mtllib a",     "usemap a",    "maplib a",
                                   "shadow_obj a", "trace_obj a", "t crease 2/1/0 0 1 2"}) {
        std::string const keyword = std::string(next).substr(0, std::string(next).find(' '));
        EXPECT_EQ(read(std::string("usemtl wood\\\n") + next + "\nf 1 2 3\n", {3}, "wood\\"),
                  Warnings{"the backslash at the end of line 5" + cause + keyword + "'"});
    }
    EXPECT_EQ(
        read("f 1 2 3\ng a \\\nb\\\nf 1 2 3\nusemtl wood\\\ng c\\\nf 1 2 3\n", {3, 3, 3}, "wood\\"),
        Warnings{"the backslash at the end of line 7" + cause + "f', the first of 3 such lines"});
    expectRefused("a.obj", "v 0 0 0\\\nv 1 0 0\n", "line 1: '0\\' is not a finite number");
    // Within a comment, a backslash is text.
    EXPECT_TRUE(read("# C:\\models\\\nf 1 2 3\n", {3}).empty());
}

TEST_F(MeshFile, RefusesBadObj) {
    std::string const vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    expectRefused("a.obj", vertices + "f 1 2 4\n",
                  "line 4: vertex index 4 is out of range: the file has 3 of them");
    expectRefused("a.obj", vertices + "f 1 2 2147483648\n",
                  "line 4: vertex index 2147483648 is out of range");
    expectRefused("a.obj", vertices + "f 1 2 -99999999999\n",
                  "line 4: vertex index -99999999999 is out of range");
    expectRefused("a.obj", vertices + "f 1 2 -\n", "line 4: '-' is not a vertex of a face");
    expectRefused("a.obj", vertices + "vt 0 0\nf 1/ 2/ 3/\n",
                  "line 5: '1/' has no index after '/'");
    expectRefused("a.obj", vertices + "vt 0 0\nf 1/1/ 2/1/ 3/1/\n",
                  "line 5: '1/1/' has no index after '/'");
    expectRefused("a.obj", vertices + "f 1 2 0\n", "line 4: vertex index 0 is out of range");
    expectRefused("a.obj", vertices + "f 1 2 -4\n", "line 4: vertex index -4 is out of range");
    expectRefused("a.obj", vertices + "f 1 2 99999999999\n",
                  "line 4: vertex index 99999999999 is out of range");
    expectRefused("a.obj", vertices + "f 1 2 3x\n", "line 4: '3x'");
    expectRefused("a.obj", vertices + "f 1 2 3/\n", "line 4: '3/'");
    expectRefused("a.obj", vertices + "f 1 2\n", "line 4: a face needs three corners");
    expectRefused("a.obj", vertices + "f\n", "line 4: a face needs three corners");
    expectRefused("a.obj", vertices, "has no faces");
    expectRefused("a.obj", "v 0 0 abc\n", "line 1: 'abc' is not a finite number");
    expectRefused("a.obj", "v 0 0 1.5abc\n", "line 1: '1.5abc'");
    expectRefused("a.obj", "v 0 0 nan\n", "line 1: 'nan'");
    expectRefused("a.obj", "v 0 inf 0\n", "line 1: 'inf'");
    expectRefused("a.obj", "v 0 1e39 0\n", "line 1: '1e39'");
    expectRefused("a.obj", "v 0 1e999 0\n", "line 1: '1e999'");
    expectRefused("a.obj", "\r\n\\\nv 0 0\n", "line 2: a vertex needs three coordinates");
    expectRefused("a.obj", vertices + "curv 0 1 2\n", "line 4: statement 'curv'");
    expectRefused("a.obj", std::string("v 0 0 0\0\n", 9), "is not text");
    expectRefused("a.obj", "\x7f\x45LF \x01\x02 garbage", "statement");
    expectRefused("a.obj", vertices + "f 1 2 3\nf 1", "line 5: a face needs three corners");
}

TEST_F(MeshFile, ReadsOff) {
    expectFaces("a.off", "OFF\n4 2 0\n" + kFourVertices + "3 0 1 2\n4 0 1 2 3\n", 4, {3, 4},
                {0, 1, 2, 0, 1, 2, 3});
    // Comments, empty lines, counts on the first line or without edges, no line end at the end.
    expectFaces("a.off",
                "# made by hand\nOFF 4 1 # counts\n\n" + kFourVertices + "\n# face\n3 0 1 2", 4,
                {3}, {0, 1, 2});
    // The number of vertices right behind the word.
    expectFaces("a.off", "OFF4 1 0\n" + kFourVertices + "3 0 1 2\n", 4, {3}, {0, 1, 2});
    expectFaces("a.off", "COFF4\n1 0\n" + kFourVertices + "3 0 1 2\n", 4, {3}, {0, 1, 2});
    // Comments say nothing.
    expectFaces("a.off", "OFF # no BINARY\r4 1\r" + kFourVertices + "3 0 1 2 # BINARY", 4, {3},
                {0, 1, 2});
    expectFaces("a.off", "# BINARY or not\nOFF\n4 1\n" + kFourVertices + "3 0 1 2", 4, {3},
                {0, 1, 2});
    // Colours are allowed in any OFF file.
    expectFaces("a.off", "OFF\r\n4 2 0\r\n" + kFourVertices + "3 0 1 2 255 0 0\r\n3 0 2 3 1\r\n", 4,
                {3, 3}, {0, 1, 2, 0, 2, 3});
    expectFaces("a.off",
                "CNOFF\n3 1 0\n0 0 0 0 0 1 1 0 0 1\n1 0 0 0 0 1 1 0 0 1\n1 1 0 0 0 1 1 0 0 1\n"
                "3 0 1 2\n",
                3, {3}, {0, 1, 2});
}

TEST_F(MeshFile, RefusesBadOff) {
    std::string const begin = "OFF\n4 2 0\n" + kFourVertices;
    expectRefused("a.off", begin + "3 0 1 2\n3 0 1 4\n", "line 8: face 1 has the vertex index 4");
    expectRefused("a.off", begin + "3 0 1 -1\n3 0 1 2\n", "line 7: face 0 has the vertex index -1");
    expectRefused("a.off", begin + "2 0 1\n3 0 1 2\n", "line 7: face 0 has 2 corners");
    expectRefused("a.off", begin + "0\n3 0 1 2\n", "line 7: face 0 has 0 corners");
    expectRefused("a.off", begin + "4 0 1 2\n3 0 1 2\n", "line 7: the line of face 0");
    expectRefused("a.off", begin + "3 0 1 2 3 1 2 3 0\n3 0 1 2\n", "line 7: the line of face 0");
    expectRefused("a.off", begin + "3 0 1 x\n3 0 1 2\n", "line 7: a number is expected");
    expectRefused("a.off", begin + "3 0 1 2\n", "4 of 4 vertices and 1 of 2 faces");
    expectRefused("a.off", begin, "4 of 4 vertices and 0 of 2 faces");
    expectRefused("a.off", begin + "-1 0 1 2\n3 0 1 2\n", "ends too early");
    expectRefused("a.off", begin + "99999999999 0 1 2\n", "line 7: a number is expected");
    expectRefused("a.off", begin + "3 0 1 2\n3 0 2 3\n3 0 1 3\n",
                  "more content behind its 2 faces");
    expectRefused("a.off", "OFF\n2 1 0\n0 0\n1 0 0\n3 0 1 2\n", "line 3: the line of vertex 0");
    expectRefused("a.off", "OFF\n1 1 0\n0 0 nan\n3 0 0 0\n", "line 3: a number is expected");
    expectRefused("a.off", "OFF\n1 1 0\n0 0 1e39\n3 0 0 0\n", "line 3: a number is expected");
    for (char const *line : {"0 0 1.x", "0 0 1x", "0 0.5.5", "0 1.5.5 2", "1-2 3"}) {
        expectRefused("a.off", std::string("OFF\n1 1 0\n") + line + "\n3 0 0 0\n", "line 3: ");
    }
    expectRefused("a.off", "OFF\n4 -2 0\n" + kFourVertices, "line 2: -2 is not a number of faces");
    expectRefused("a.off", "OFF\n-4 2 0\n", "line 2: -4 is not a number of vertices");
    expectRefused("a.off", "OFF\n4 x 0\n" + kFourVertices, "line 2: the numbers of vertices");
    expectRefused("a.off", "OFF\n", "the numbers of vertices");
    expectRefused("a.off", "OFF\n4 0 0\n" + kFourVertices, "has no faces");
    expectRefused("a.off", "4OFF\n1 0 0\n0 0 0 1\n", "does not begin with OFF");
    expectRefused("a.off", kFourVertices, "does not begin with OFF");
    expectRefused("a.off", "OFFx 4 1 0\n" + kFourVertices, "does not begin with OFF");
    expectRefused("a.off", "OFF4x 1 0\n" + kFourVertices, "line 1: the numbers of vertices");
    expectRefused("a.off", "OFF4 1 0 0 0\n" + kFourVertices, "line 1: the numbers of vertices");
    expectRefused("a.off", std::string("OFF BINARY\n\0\0\0\1", 15), "binary OFF");
    expectRefused("a.off", std::string("\x89\0\x01garbage", 10), "is not text");
}

TEST_F(MeshFile, ReadsTextPly) {
    expectFaces("a.ply", kTextPlyHeader + kFourVertices + "3 0 1 2\n4 0 1 2 3\n", 4, {3, 4},
                {0, 1, 2, 0, 1, 2, 3});
    expectFaces("a.ply",
                "ply\r\ncomment hand made\r\nformat ascii 1.0\r\nelement vertex 3\r\n"
                "property double x\r\nproperty float64 y\r\nproperty float32 z\r\n"
                "property uchar red\r\nelement face 1\r\n"
                "property list uint32 uint vertex_index\r\nproperty int flags\r\n"
                "element edge 1\r\nproperty int vertex1\r\nproperty int vertex2\r\nend_header\r\n"
                "0 0 0 255\r\n1 0 0 0\r\n0 1 0 0\r\n3 2 1 0 77\r\n0 1\r\n",
                3, {3}, {2, 1, 0});
}

TEST_F(MeshFile, ReadsBinaryPly) {
    BinaryPly ply = makeBinaryPly();
    expectFaces("a.ply", ply.Print(), 3, {3}, {0, 1, 2});
    ply.headerEnd = "comment the end\n";
    expectFaces("a.ply", ply.Print(), 3, {3}, {0, 1, 2});
    EXPECT_EQ(ReadMesh(getPath("a.ply")).positions, kTriangle);

    ply = makeBinaryPly();
    ply.headerEnd = "property double red\nproperty uchar green\n";
    ply.faces += std::string(9, 'x');
    expectFaces("a.ply", ply.Print(), 3, {3}, {0, 1, 2});

    ply = makeBinaryPly();
    ply.countType = "uint";
    ply.indexType = "ushort";
    ply.faces = bytes<std::uint32_t>({3}) + bytes<std::uint16_t>({2, 1, 0});
    expectFaces("a.ply", ply.Print(), 3, {3}, {2, 1, 0});

    ply = makeBinaryPly();
    ply.format = "binary_big_endian 1.0";
    ply.coordinateTypes = "double";
    ply.vertices = bytes(std::vector<double>(kTriangle.begin(), kTriangle.end()), true);
    ply.faces = bytes<unsigned char>({3}) + bytes<int>({0, 1, 2}, true);
    expectFaces("a.ply", ply.Print(), 3, {3}, {0, 1, 2});
    EXPECT_EQ(ReadMesh(getPath("a.ply")).positions, kTriangle);
}

TEST_F(MeshFile, RefusesBadTextPly) {
    std::string const begin = kTextPlyHeader + kFourVertices;
    expectRefused("a.ply", begin + "3 0 1 2\n3 0 1 4\n", "line 15: face 1 has the vertex index 4");
    expectRefused("a.ply", begin + "3 0 1 2\n3 0 1 -2\n",
                  "line 15: face 1 has the vertex index -2");
    expectRefused("a.ply", begin + "2 0 1\n3 0 1 2\n", "line 14: face 0 has 2 corners");
    expectRefused("a.ply", begin + "4 0 1 2\n3 0 1 2\n", "line 14: the line of face 0 ends");
    expectRefused("a.ply", begin + "3 0 1 2 3\n3 0 1 2\n", "line 14: the line of face 0 has too");
    expectRefused("a.ply", begin + "3 0 1 2\n", "it has 1 of 2 items 'face'");
    expectRefused("a.ply", begin + "3 0 1 2\n3 0 1 2\n3 0 1 2\n",
                  "more content behind its 2 items 'face'");
    expectRefused("a.ply", begin + "3 0 1 ?\n3 0 1 2\n",
                  "line 14: '?' is not a number of type int");
    expectRefused("a.ply", begin + "3 0 1 2.\n3 0 1 2\n", "line 14: '2.' is not a number of type");
    expectRefused("a.ply", begin + "256 0 1 2\n3 0 1 2\n",
                  "line 14: '256' is not a number of type uchar");
    expectRefused("a.ply", kTextPlyHeader + "0 0 nan\n",
                  "line 10: 'nan' is not a finite number of type float");
    expectRefused("a.ply", kTextPlyHeader + "0 0\n" + kFourVertices, "line 10: the line of vertex");
    expectRefused("a.ply", kTextPlyHeader + "0 1.5.5 0\n" + kFourVertices, "line 10: '1.5.5'");
    expectRefused("a.ply", kTextPlyHeader, "it has 0 of 4 items 'vertex'");
    expectRefused("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\n", "the header has no end");
    expectRefused("a.ply", "ply\nformat text 1.0\nend_header\n", "format 'text 1.0'");
    expectRefused("a.ply", "ply\nformat ascii 1.0\nend_header\n", "has no faces");
    expectRefused("a.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", "line 3: '-1'");
    expectRefused("a.ply", "ply\nformat ascii 1.0\nelement face 1\nelement face 1\n",
                  "line 4: there is an element 'face' already");
    expectRefused("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n",
                  "line 4: 'half' is not a type of numbers");
    expectRefused("a.ply",
                  "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty int x\n",
                  "line 5: element 'vertex' has a property 'x' already");
    expectRefused("a.ply", "ply\nformat ascii 1.0\nproperty float x\n",
                  "line 3: a property needs an element");
    expectRefused("a.ply", "ply\nelement vertex 1\nend_header\n", "lacks the format");
    expectRefused(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0\n3 0 0 0",
        "lacks vertices with x, y and z");
    expectRefused("a.ply",
                  "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                  "property float z\nelement face 1\nproperty int flags\nend_header\n0 0 0\n3\n",
                  "lacks faces with vertex_indices");
    expectRefused("a.ply", "garbage\n", "does not begin with 'ply'");
}

TEST_F(MeshFile, RefusesBadBinaryPly) {
    std::string const good = makeBinaryPly().Print();
    for (std::size_t size = 1; size < good.size(); ++size) {
        EXPECT_THROW(ReadMesh(makeFile("a.ply", good.substr(0, size))), FileError) << size;
    }
    expectRefused("a.ply", good + "x", "more content behind its 1 items 'face'");

    BinaryPly ply = makeBinaryPly();
    ply.vertices = bytes<float>({0, 0, 0, 1, 0, std::nanf(""), 0, 1, 0});
    expectRefused("a.ply", ply.Print(), "vertex 1 has a coordinate that is not a finite number");
    ply = makeBinaryPly();
    ply.coordinateTypes = "double";
    ply.vertices = bytes<double>({0, 0, 0, 1, 0, 1e300, 0, 1, 0});
    expectRefused("a.ply", ply.Print(),
                  "vertex 1 has a coordinate that is out of the range of floats");
    ply = makeBinaryPly();
    ply.faces = bytes<unsigned char>({3}) + bytes<int>({0, 1, 3});
    expectRefused("a.ply", ply.Print(), "face 0 has the vertex index 3");
    ply.faces = bytes<unsigned char>({3}) + bytes<int>({0, 1, -1});
    expectRefused("a.ply", ply.Print(), "face 0 has the vertex index -1");
    ply.faces = bytes<unsigned char>({2}) + bytes<int>({0, 1});
    expectRefused("a.ply", ply.Print(), "face 0 has 2 corners");
    ply.faces = bytes<unsigned char>({4}) + bytes<int>({0, 1, 2});
    expectRefused("a.ply", ply.Print(), "ends too early, in face 0");
    ply.countType = "int";
    for (int count : {-1, 1 << 20}) {
        ply.faces = bytes<int>({count, 0, 1, 2});
        expectRefused("a.ply", ply.Print(),
                      "face 0 has a list 'vertex_indices' of " + std::to_string(count) +
                          " numbers");
    }
    ply = makeBinaryPly();
    ply.indexType = "float";
    expectRefused("a.ply", ply.Print(), "the vertices of faces need an integer type, not float");
    ply = makeBinaryPly();
    ply.countType = "float";
    expectRefused("a.ply", ply.Print(), "line 8: the lengths of lists need an integer type");
}

TEST_F(MeshFile, RefusesWhatIsNoMeshFile) {
    expectRefused(getPath("missing.obj"), "cannot be opened");
    std::filesystem::create_directory(getPath("folder.obj"));
    expectRefused(getPath("folder.obj"), "is a folder");
    for (char const *name : {"a.obj", "a.off", "a.ply"}) {
        expectRefused(name, "", "is empty");
    }
    expectRefused("a.stl", "solid", "is not a .obj, .off or .ply file");
    expectRefused("obj", "v 0 0 0", "is not a .obj, .off or .ply file");
    expectRefused("/dev/zero", "is not a .obj, .off or .ply file");
    EXPECT_THROW(WriteMesh(MakeCube(), getPath("a.stl.gz")), FileError);
}

TEST_F(MeshFile, WritesNothingThatItWouldNotRead) {
    auto const expectRefusedMesh = [&](Mesh const &mesh, std::string const &cause) {
        for (char const *name : {"a.obj", "a.off", "a.ply"}) {
            try {
                WriteMesh(mesh, getPath(name));
                ADD_FAILURE() << name << " was written";
            } catch (FileError const &error) {
                EXPECT_EQ(error.what(), getPath(name) + ": " + cause);
            }
        }
    };
    for (float number : {std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity(), std::nanf("")}) {
        Mesh mesh = MakeCube();
        mesh.positions[7] = number;
        expectRefusedMesh(mesh, "vertex 2 has a coordinate that is not a finite number");
        mesh = MakeCube();
        mesh.vertexProperties = {{"quality", NumberType::Double, std::vector<float>(8, 1)}};
        mesh.vertexProperties[0].values.back() = number;
        expectRefusedMesh(mesh, "vertex 7 has a quality that is not a finite number");
        mesh = MakeCube();
        mesh.channels.push_back({FVarKind::Uv, 2, {0, 0, 1, number}, {}});
        mesh.channels[0].faceValues.assign(mesh.faceVertices.size(), 1);
        expectRefusedMesh(mesh, "texture coordinate 1 has a part that is not a finite number");
    }
    Mesh empty = MakeCube();
    empty.faceSizes.clear();
    empty.faceVertices.clear();
    expectRefusedMesh(empty, "has no faces");
    EXPECT_EQ(listFiles(), std::vector<std::string>());
}

TEST_F(MeshFile, RefusesEveryDamagedFile) {
    // Any byte changed: either the file is refused or it still says something that can be read.
    std::mt19937 random(1);
    Mesh const cube = MakeCube();
    for (char const *name : {"a.obj", "a.off", "a.ply"}) {
        WriteMesh(cube, getPath(name));
        std::string const good = getContent(getPath(name));
        for (int i = 0; i < 500; ++i) {
            std::string damaged = good;
            damaged[random() % damaged.size()] = char(random());
            if (i % 4 == 0) {
                damaged.resize(random() % damaged.size());
            }
            try {
                Mesh const mesh = ReadMesh(makeFile(name, damaged));
                EXPECT_EQ(
                    mesh.faceVertices.size(),
                    std::size_t(std::accumulate(mesh.faceSizes.begin(), mesh.faceSizes.end(), 0)));
                for (int vertex : mesh.faceVertices) {
                    EXPECT_TRUE(vertex >= 0 && vertex < mesh.GetNumVertices());
                }
            } catch (FileError const &) {
                // Refused, as it may be.
            }
        }
    }
}

} // namespace OpenSubdivHex::Tools::meshFileTest

// SPDX-License-Identifier: Apache-2.0
//
// Texture coordinates and normals of OBJ files.
#include "meshFileFixture.h"
#include "meshWriter.h"
#include "shapes.h"

#include <cmath>
#include <random>

namespace OpenSubdivHex::Tools::objChannelTest {

namespace {

class ObjChannel : public MeshFile {
protected:
    Mesh read(std::string const &faces) const {
        return ReadMesh(makeFile("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + faces));
    }
    void expectRefused(std::string const &faces, std::string const &cause) const {
        MeshFile::expectRefused("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + faces, cause);
    }
};

FVarChannel makeChannel(FVarKind kind, int width, std::size_t numCorners) {
    FVarChannel channel;
    channel.kind = kind;
    channel.width = width;
    std::mt19937 random(std::mt19937::result_type(width) + (kind == FVarKind::Uv ? 0 : 10));
    std::uniform_real_distribution<float> mantissa(-1, 1);
    std::uniform_int_distribution<int> exponent(-30, 30);
    for (std::size_t i = 0; i < numCorners * std::size_t(width); ++i) {
        channel.values.push_back(std::ldexp(mantissa(random), exponent(random)));
    }
    for (std::size_t i = 0; i < numCorners; ++i) {
        channel.faceValues.push_back(int(random() % numCorners));
    }
    return channel;
}

} // namespace

TEST_F(ObjChannel, RoundTripKeepsEveryBit) {
    Mesh const cube = MakeCube();
    FVarChannel const uvs = makeChannel(FVarKind::Uv, 2, 24);
    FVarChannel const wideUvs = makeChannel(FVarKind::Uv, 3, 24);
    FVarChannel const normals = makeChannel(FVarKind::Normal, 3, 24);
    for (std::vector<FVarChannel> const &channels :
         {std::vector<FVarChannel>{uvs}, {wideUvs}, {normals}, {uvs, normals}}) {
        Mesh mesh = cube;
        mesh.channels = channels;
        WriteMesh(mesh, getPath("a.obj"));
        expectEqual(ReadMesh(getPath("a.obj")), mesh);
        // The other formats hold positions and faces alone.
        for (char const *name : {"a.off", "a.ply"}) {
            WriteMesh(mesh, getPath(name));
            expectEqual(ReadMesh(getPath(name)), cube);
        }
    }
}

TEST_F(ObjChannel, WritesWhatItSays) {
    Mesh mesh{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {3}, {2, 0, 1}, {}, {}};
    FVarChannel const uvs{FVarKind::Uv, 2, {0.5f, 1, 0.25f, 0}, {1, 0, 0}};
    FVarChannel const normals{FVarKind::Normal, 3, {0, 0, 1}, {0, 0, 0}};
    std::string const vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    mesh.channels = {uvs};
    WriteMesh(mesh, getPath("a.obj"));
    EXPECT_EQ(getContent(getPath("a.obj")), vertices + "vt 0.5 1\nvt 0.25 0\nf 3/2 1/1 2/1\n");
    mesh.channels = {normals};
    WriteMesh(mesh, getPath("a.obj"));
    EXPECT_EQ(getContent(getPath("a.obj")), vertices + "vn 0 0 1\nf 3//1 1//1 2//1\n");
    mesh.channels = {uvs, normals};
    WriteMesh(mesh, getPath("a.obj"));
    EXPECT_EQ(getContent(getPath("a.obj")),
              vertices + "vt 0.5 1\nvt 0.25 0\nvn 0 0 1\nf 3/2/1 1/1/1 2/1/1\n");
}

TEST_F(ObjChannel, ReadsIndices) {
    Mesh mesh = read("vt 1 2\nvt 3 4\nvn 0 0 1\nf 1/1/1 2/-1/-1 3/2/1\nvt 5 6\nf 1/-1/1 2/-2/1 "
                     "4/-3/1\n");
    ASSERT_EQ(mesh.channels.size(), 2u);
    EXPECT_EQ(mesh.channels[0].kind, FVarKind::Uv);
    EXPECT_EQ(mesh.channels[0].width, 2);
    EXPECT_EQ(mesh.channels[0].values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(mesh.channels[0].faceValues, (std::vector<int>{0, 1, 1, 2, 1, 0}));
    EXPECT_EQ(mesh.channels[1].kind, FVarKind::Normal);
    EXPECT_EQ(mesh.channels[1].values, (std::vector<float>{0, 0, 1}));
    EXPECT_EQ(mesh.channels[1].faceValues, std::vector<int>(6, 0));

    mesh = read("f 1//1 2//2 3//1\nvn 0 0 1\nvn 1 0 0\n");
    ASSERT_EQ(mesh.channels.size(), 1u);
    EXPECT_EQ(mesh.channels[0].kind, FVarKind::Normal);
    EXPECT_EQ(mesh.channels[0].faceValues, (std::vector<int>{0, 1, 0}));

    EXPECT_TRUE(read("vt 1 2\nvn 0 0 1\nf 1 2 3\n").channels.empty());
}

TEST_F(ObjChannel, KeepsThirdTextureCoordinateWhereItIsUsed) {
    std::string const face = "f 1/1 2/2 3/2\n";
    FVarChannel channel = read("vt 1\nvt 3 4 0\n" + face).channels.at(0);
    EXPECT_EQ(channel.width, 2);
    EXPECT_EQ(channel.values, (std::vector<float>{1, 0, 3, 4}));
    channel = read("vt 1\nvt 3 4 0.5\n" + face).channels.at(0);
    EXPECT_EQ(channel.width, 3);
    EXPECT_EQ(channel.values, (std::vector<float>{1, 0, 0, 3, 4, 0.5f}));
}

TEST_F(ObjChannel, RefusesHalfOfAChannel) {
    std::string const values = "vt 0 0\nvn 0 0 1\n";
    expectRefused(values + "f 1/1 2/1 3\n",
                  "line 7: a corner has no texture coordinate, one in line 7 has one");
    expectRefused(values + "f 1/1 2/1 3/1\nf 1 2 3\n",
                  "line 8: a corner has no texture coordinate, one in line 7 has one");
    expectRefused(values + "f 1 2 3\nf 1/1 2/1 3/1\n",
                  "line 8: a corner has a texture coordinate, one in line 7 has none");
    expectRefused(values + "f 1//1 2//1 3//1\nf 1/1 2/1 3/1\n",
                  "line 8: a corner has a texture coordinate, one in line 7 has none");
    expectRefused(values + "f 1/1/1 2/1/1 3/1/1\nf 1/1 2/1 3/1\n",
                  "line 8: a corner has no normal, one in line 7 has one");
}

TEST_F(ObjChannel, RefusesBadValues) {
    expectRefused("vt\n", "line 5: a texture coordinate needs one to three numbers");
    expectRefused("vt 0 0 0 0\n", "line 5: a texture coordinate needs one to three numbers");
    expectRefused("vt 0 x\n", "line 5: 'x' is not a finite number");
    expectRefused("vt 0 nan\n", "line 5: 'nan' is not a finite number");
    expectRefused("vn 0 0\n", "line 5: a normal needs three numbers");
    expectRefused("vn 0 0 1 0\n", "line 5: a normal needs three numbers");
    expectRefused("vn 0 0 1e99\n", "line 5: '1e99' is out of the range of floats");
    std::string const values = "vt 0 0\nvn 0 0 1\n";
    expectRefused(values + "f 1/1 2/1 3/2\n", "line 7: texture coordinate index 2 is out of range");
    expectRefused(values + "f 1/1 2/1 3/0\n", "line 7: texture coordinate index 0 is out of range");
    expectRefused(values + "f 1/1 2/1 3/-2\n", "line 7: texture coordinate index -2 is out of");
    expectRefused(values + "f 1//1 2//1 3//2\n", "line 7: normal index 2 is out of range");
    expectRefused(values + "f 1//1 2//1 3//0\n", "line 7: normal index 0 is out of range");
    for (char const *corner : {"3/1/1/1", "/1", "3/x", "3//x", "3/1/x"}) {
        expectRefused(values + "f 1/1 2/1 " + corner + "\n",
                      std::string("line 7: '") + corner + "' is not a vertex of a face");
    }
    for (char const *corner : {"3/", "3//", "3/1/"}) {
        expectRefused(values + "f 1/1 2/1 " + corner + "\n",
                      std::string("line 7: '") + corner + "' has no index after '/'");
    }
}

} // namespace OpenSubdivHex::Tools::objChannelTest

// SPDX-License-Identifier: Apache-2.0
//
// The tag lines of OpenSubdiv's shape files, in OBJ files.
#include "meshFileFixture.h"

namespace OpenSubdivHex::Tools::objTagTest {

namespace {

using Options = MeshTags::Options;

/// Six vertices and, up to line 8, two quads with a common edge between vertices 1 and 4.
std::string const kFaces = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
                           "f 1 2 5 4\nf 2 3 6 5\n";

class ObjTag : public MeshFile {
protected:
    /// The tags of a file of kFaces and \p tags.
    MeshTags read(std::string const &tags) const {
        return ReadMesh(makeFile("a.obj", kFaces + tags)).tags;
    }
    void expectRefused(std::string const &tag, std::string const &cause) const {
        MeshFile::expectRefused("a.obj", kFaces + "t " + tag + "\n", "line 9: " + cause);
    }
};

} // namespace

TEST_F(ObjTag, NoTags) {
    MeshTags const tags = read("");
    EXPECT_EQ(tags.GetNumCreases() + tags.GetNumCorners() + tags.GetNumHoles(), 0);
    EXPECT_FALSE(tags.boundary || tags.fvarInterpolation || tags.creasingMethod);
}

TEST_F(ObjTag, Creases) {
    MeshTags tags = read("t crease 2/1/0 1 4 2.5\nt crease 2/1/0   0 1  10\n");
    EXPECT_EQ(tags.creaseVertices, (std::vector<int>{0, 1, 1, 4}));
    EXPECT_EQ(tags.creaseSharpness, (std::vector<float>{10, 2.5f}));
    // Pairs, not a chain; one sharpness for all or one for each.
    tags = read("t crease 4/1/0 4 1 3 4 3\n");
    EXPECT_EQ(tags.creaseVertices, (std::vector<int>{1, 4, 3, 4}));
    EXPECT_EQ(tags.creaseSharpness, (std::vector<float>{3, 3}));
    tags = read("t crease 4/2/0 4 1 3 4 1 2\n");
    EXPECT_EQ(tags.creaseSharpness, (std::vector<float>{1, 2}));
    // The last holds, whatever its direction; nothing is left of one that is not sharp.
    tags = read("t crease 2/1/0 1 4 2\nt crease 2/1/0 4 1 3\n");
    EXPECT_EQ(tags.creaseVertices, (std::vector<int>{1, 4}));
    EXPECT_EQ(tags.creaseSharpness, (std::vector<float>{3}));
    EXPECT_EQ(read("t crease 2/1/0 1 4 2\nt crease 2/1/0 1 4 0\n").GetNumCreases(), 0);
    EXPECT_EQ(read("t crease 2/1/0 1 4 -0\n").GetNumCreases(), 0);
}

TEST_F(ObjTag, CornersAndHoles) {
    MeshTags tags = read("t corner 1/1/0 4 2\nt corner 2/2/0 0 4 1 3\nt corner 2/1/0 1 2 5\n");
    EXPECT_EQ(tags.cornerVertices, (std::vector<int>{0, 1, 2, 4}));
    EXPECT_EQ(tags.cornerSharpness, (std::vector<float>{1, 5, 5, 3}));
    tags = read("t hole 1/0/0 1\nt hole 2/0/0 1 0\n");
    EXPECT_EQ(tags.holes, (std::vector<int>{0, 1}));
}

TEST_F(ObjTag, Rules) {
    EXPECT_EQ(read("t interpolateboundary 1/0/0 0\n").boundary, Options::VTX_BOUNDARY_NONE);
    EXPECT_EQ(read("t interpolateboundary 1/0/0 1\n").boundary,
              Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    EXPECT_EQ(read("t interpolateboundary 1/0/0 2 \n").boundary, Options::VTX_BOUNDARY_EDGE_ONLY);
    for (int value = 0; value <= 5; ++value) {
        std::string const tag =
            "t facevaryinginterpolateboundary 1/0/0 " + std::to_string(value) + "\n";
        auto const rule = Options::FVarLinearInterpolation(value);
        EXPECT_EQ(read(tag).fvarInterpolation, rule);
        EXPECT_EQ(read(tag + "t facevaryingpropagatecorners 1/0/0 0\n").fvarInterpolation, rule);
        EXPECT_EQ(read("t facevaryingpropagatecorners 1/0/0 1\n" + tag).fvarInterpolation,
                  rule == Options::FVAR_LINEAR_CORNERS_PLUS1 ? Options::FVAR_LINEAR_CORNERS_PLUS2
                                                             : rule);
    }
    EXPECT_FALSE(read("t facevaryingpropagatecorners 1/0/0 1\n").fvarInterpolation);
    EXPECT_EQ(read("t creasemethod 0/0/1 normal\n").creasingMethod, Options::CREASE_UNIFORM);
    EXPECT_EQ(read("t creasemethod 0/0/1 chaikin\n").creasingMethod, Options::CREASE_CHAIKIN);
}

TEST_F(ObjTag, MayComeBeforeFaces) {
    Mesh const mesh =
        ReadMesh(makeFile("a.obj", "t crease 2/1/0 1 4 2\nt hole 1/0/0 1\n" + kFaces));
    EXPECT_EQ(mesh.tags.creaseVertices, (std::vector<int>{1, 4}));
    EXPECT_EQ(mesh.tags.holes, std::vector<int>{1});
}

TEST_F(ObjTag, RefusesWhatNeedsToBeKnown) {
    expectRefused("vertexedit 1/0/0 1", "tag 'vertexedit' is not supported");
    expectRefused("Crease 2/1/0 1 4 2", "tag 'Crease' is not supported");
}

TEST_F(ObjTag, NotesWhatIsAboutOtherSchemes) {
    for (char const *tag : {"0/0/1 smooth", "0/0/1 normal", "1/0/0 1"}) {
        Mesh const mesh = ReadMesh(makeFile("a.obj", kFaces + "t smoothtriangles " + tag +
                                                         "\nt smoothtriangles 0/0/1 x\n"));
        EXPECT_EQ(mesh.notRead, std::vector<std::string>{"tag smoothtriangles"});
    }
    EXPECT_TRUE(ReadMesh(makeFile("a.obj", kFaces)).notRead.empty());
    expectRefused("smoothtriangles 0/0/2 x", "tag 'smoothtriangles' has 1 arguments");
}

TEST_F(ObjTag, RefusesMalformedTags) {
    for (char const *tag : {"", "hole", "hole 1/0 1", "hole 1 1", "hole 1/0/0/0 1", "hole 1/0/x 1",
                            "hole -1/0/0", "hole 1//0 1", "hole /0/0 1"}) {
        expectRefused(tag, "a tag needs a name and three counts");
    }
    expectRefused("hole 1/0/0", "tag 'hole' has 0 arguments where '1/0/0' are announced");
    expectRefused("hole 1/0/0 1 2", "tag 'hole' has 2 arguments");
    expectRefused("hole 2147483647/2147483647/2 1", "tag 'hole' has 1 arguments");
    expectRefused("hole 1/0/0 x", "'x' is not an integer");
    expectRefused("hole 1/0/0 1.5", "'1.5' is not an integer");
    expectRefused("crease 2/1/0 1 4 x", "'x' is not a finite number");
    expectRefused("crease 2/1/0 1 4 nan", "'nan' is not a finite number");
    expectRefused("crease 2/1/0 1 4 inf", "'inf' is not a finite number");
    expectRefused("crease 2/1/0 1 4 -5", "sharpness -5 is negative");
    expectRefused("crease 4/2/0 1 4 3 4 2 -.5", "sharpness -0.5 is negative");
    expectRefused("corner 1/1/0 4 -1e-9", "sharpness -1e-09 is negative");
}

TEST_F(ObjTag, RefusesWrongArguments) {
    for (char const *tag : {"crease 0/0/0", "crease 0/1/0 2", "crease 1/1/0 1 2",
                            "crease 3/1/0 1 4 3 2", "crease 2/0/0 1 4", "crease 2/2/0 1 4 2 2",
                            "crease 4/3/0 1 4 3 4 1 2 3", "crease 2/1/1 1 4 2 x"}) {
        expectRefused(tag, "tag 'crease' needs pairs of vertices");
    }
    for (char const *tag : {"corner 0/0/0", "corner 0/1/0 2", "corner 1/0/0 1",
                            "corner 1/2/0 1 2 3", "corner 3/2/0 0 1 2 1 2", "corner 1/1/1 1 2 x"}) {
        expectRefused(tag, "tag 'corner' needs vertices");
    }
    for (char const *tag : {"hole 0/0/0", "hole 1/1/0 1 2", "hole 1/0/1 1 x"}) {
        expectRefused(tag, "tag 'hole' needs faces");
    }
    for (char const *arguments : {"0/0/0", "2/0/0 1 1", "1/1/0 1 1", "1/0/1 1 x", "1/0/0 -1"}) {
        for (char const *name : {"interpolateboundary", "facevaryinginterpolateboundary",
                                 "facevaryingpropagatecorners"}) {
            expectRefused(std::string(name) + " " + arguments,
                          std::string("tag '") + name + "' needs one integer");
        }
    }
    expectRefused("interpolateboundary 1/0/0 3", "tag 'interpolateboundary' needs one integer");
    expectRefused("facevaryinginterpolateboundary 1/0/0 6", "tag 'facevaryinginterpolateboundary'");
    expectRefused("facevaryingpropagatecorners 1/0/0 2", "tag 'facevaryingpropagatecorners' needs");
    for (char const *arguments : {"0/0/0", "1/0/0 1", "0/0/1 smooth", "0/0/2 normal normal",
                                  "1/0/1 1 normal", "0/1/1 1 normal"}) {
        expectRefused(std::string("creasemethod ") + arguments,
                      "tag 'creasemethod' needs one word");
    }
}

TEST_F(ObjTag, RefusesWhatIsNotInTheMesh) {
    expectRefused("crease 2/1/0 0 4 2", "no face has an edge between vertices 0 and 4");
    expectRefused("crease 2/1/0 4 6 2", "no face has an edge between vertices 4 and 6");
    expectRefused("crease 2/1/0 -1 0 2", "no face has an edge between vertices -1 and 0");
    expectRefused("crease 2/1/0 0 4 0", "no face has an edge between vertices 0 and 4");
    expectRefused("corner 1/1/0 6 2", "vertex 6 is out of range");
    expectRefused("corner 1/1/0 -1 2", "vertex -1 is out of range");
    expectRefused("hole 1/0/0 2", "face 2 is out of range");
    expectRefused("hole 1/0/0 -1", "face -1 is out of range");
}

} // namespace OpenSubdivHex::Tools::objTagTest

// SPDX-License-Identifier: Apache-2.0
//
// The files of hexrefine: which it takes, and what it writes to them.
#include "programFixture.h"

namespace OpenSubdivHex::Tools::fileTest {

namespace {

std::string quote(std::string const &path) { return "'" + path + "'"; }

} // namespace

TEST_F(Hexrefine, RefusesLinksInALoop) {
    std::filesystem::create_symlink("b.obj", getPath("a.obj"));
    std::filesystem::create_symlink("a.obj", getPath("b.obj"));
    std::string const input = makeCubeFile();
    expectFailure(input + " -o " + getPath("a.obj"), getPath("a.obj"), "links");
    expectFailure(input + " --stats " + getPath("a.obj"), getPath("a.obj"), "links");
    expectFailure(getPath("a.obj"), getPath("a.obj"), "links");
    EXPECT_EQ(listFiles(), (std::vector<std::string>{"a.obj", "b.obj", "cube.obj"}));
}

TEST_F(Hexrefine, WritesNoFileTwice) {
    std::string const input = makeCubeFile();
    std::string const content = getContent(input);
    std::string const output = getPath("out.obj");
    std::filesystem::create_directory(getPath("folder"));
    std::filesystem::create_symlink("out.obj", getPath("link"));
    for (std::string const &spelling :
         {output, getPath("folder/../out.obj"), getPath("./out.obj"), getPath("link")}) {
        expectBadUsage(input + " -o " + output + " --stats " + spelling, "is the file of --output");
    }
#ifdef HEXREFINE_HAS_RENDERER
    std::string const picture = getPath("out.png");
    std::filesystem::create_symlink("out.png", getPath("link.obj"));
    for (std::string const &spelling : {picture, getPath("folder/../out.png")}) {
        expectBadUsage(input + " --png " + picture + " --stats " + spelling,
                       "is the file of --png");
    }
    expectBadUsage(input + " -o " + getPath("link.obj") + " --png " + picture,
                   "is the file of --output");
    expectBadUsage(input + " --png " + output, "is not a .png file");
    std::filesystem::remove(getPath("link.obj"));
#endif
    // Anything but a mesh in the place of the mesh that is refined.
    expectBadUsage(input + " --stats " + input, "is the file of INPUT");
    expectBadUsage(getPath("folder/../cube.obj") + " --stats " + input, "is the file of INPUT");
    EXPECT_EQ(getContent(input), content);
    EXPECT_EQ(listFiles(), (std::vector<std::string>{"cube.obj", "folder", "link"}));

    EXPECT_EQ(run(input + " -o " + input).status, 0);
    EXPECT_EQ(ReadMesh(input).GetNumVertices(), 32);
#ifdef __linux__
    EXPECT_EQ(run(input + " --stats /dev/null -o " + output).status, 0);
#endif
}

TEST_F(Hexrefine, ErrorsAreOneLineWhateverTheName) {
    std::string const path = makeFile("a\nb\x1b[31m.obj", "v 0 0 0\nf 1 2 \x1b"
                                                          "3\n");
    Result result = run(quote(path));
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.error.find('\n'), result.error.size() - 1) << result.error;
    EXPECT_EQ(result.error.find('\x1b'), std::string::npos) << result.error;
    EXPECT_NE(result.error.find("a\\nb\\x1b[31m.obj: line 2: '\\x1b3'"), std::string::npos)
        << result.error;

    std::string const input = makeCubeFile();
    result = run(input + " -o " + quote(getPath("missing\n/out.obj")));
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.error.find('\n'), result.error.size() - 1) << result.error;
    // Bad usage has a second line, which points to --help.
    result = run(input + " -o " + quote("a\nb"));
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 2) << result.error;

    result = run(input + " -o " + quote(getPath("line\nbreak.obj")));
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.out.find("line\\nbreak.obj\n"), std::string::npos) << result.out;
}

TEST_F(Hexrefine, RefinesTheLargestNumbers) {
    // A tetrahedron as large as floats go: sums of its coordinates are too large, their means not.
    std::string const path =
        makeFile("large.obj", "v 3e38 3e38 3e38\nv -3e38 -3e38 3e38\nv -3e38 3e38 -3e38\n"
                              "v 3e38 -3e38 -3e38\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
    std::vector<float> positions;
    for (char const *evaluator : {"stencil", "refinement", "primvar", "stencil-cpu"}) {
        SCOPED_TRACE(evaluator);
        for (char const *name : {"out.obj", "out.off", "out.ply"}) {
            Result const result =
                run(path + " -l 3 --mask smooth --evaluator " + evaluator + " -o " + getPath(name));
            ASSERT_EQ(result.status, 0) << result.error;
            Mesh const mesh = ReadMesh(getPath(name));
            ASSERT_EQ(mesh.GetNumVertices(), 256);
            positions = positions.empty() ? mesh.positions : positions;
            for (std::size_t i = 0; i < positions.size(); ++i) {
                ASSERT_NEAR(mesh.positions[i], positions[i], 3e32);
            }
        }
    }
    // Right angles stay creases at any size.
    for (char const *size : {"1", "3e38", "1e-42"}) {
        std::string const s = size;
        std::string const fold =
            makeFile("fold.obj", "v 0 0 0\nv " + s + " 0 0\nv 0 " + s + " 0\nv 0 0 " + s +
                                     "\nf 1 2 3\nf 2 1 4\n");
        EXPECT_EQ(Json::parse(run(fold + " --crease-angle 80 --stats -").out)["creases"], 1) << s;
        EXPECT_EQ(Json::parse(run(fold + " --crease-angle 100 --stats -").out)["creases"], 0) << s;
    }
}

TEST_F(Hexrefine, RefusesWhatNoFloatHolds) {
    // The limit derivatives are differences across the whole tetrahedron.
    std::string const path =
        makeFile("large.obj", "v 3e38 3e38 3e38\nv -3e38 -3e38 3e38\nv -3e38 3e38 -3e38\n"
                              "v 3e38 -3e38 -3e38\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
    for (char const *name : {"out.obj", "out.ply"}) {
        Result const result = run(path + " -l 1 --limit -o " + getPath(name));
        if (result.status == 0) {
            EXPECT_NO_THROW(ReadMesh(getPath(name)));
        } else {
            EXPECT_NE(result.error.find("too large for a float"), std::string::npos)
                << result.error;
            EXPECT_FALSE(std::filesystem::exists(getPath(name)));
        }
    }
}

TEST_F(Hexrefine, LimitNormalsHaveAnySize) {
    for (char const *size : {"1e-30", "1", "1e30"}) {
        SCOPED_TRACE(size);
        std::string const s = size;
        std::string const path =
            makeFile("tetrahedron.obj", "v " + s + " 0 0\nv 0 " + s + " 0\nv 0 0 " + s +
                                            "\nv 0 0 0\n" + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
        ASSERT_EQ(run(path + " -l 1 --limit -o " + getPath("out.obj")).status, 0);
        Mesh const mesh = ReadMesh(getPath("out.obj"));
        ASSERT_EQ(mesh.channels.size(), 1u);
        std::vector<float> const &normals = mesh.channels[0].values;
        for (std::size_t i = 0; i < normals.size(); i += 3) {
            ASSERT_NEAR(std::hypot(normals[i], normals[i + 1], normals[i + 2]), 1, 1e-6);
        }
    }
}

TEST_F(Hexrefine, WarnsOfLinesThatAreNotJoined) {
    std::string const path =
        makeFile("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl wood\\\nf 1 2 3\nf 1 3 4\n");
    Result const result = run(path + " -l 0 -o " + getPath("out.obj"));
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.error, "hexrefine: " + path +
                                ": warning: the backslash at the end of line 5 does not join it "
                                "with the next, which begins with a statement, 'f'\n");
    EXPECT_EQ(ReadMesh(getPath("out.obj")).GetNumFaces(), 2);
    EXPECT_EQ(run(getPath("out.obj") + " --quiet").error, ""); // which has a blank behind the name
}

TEST_F(Hexrefine, RefusesToWriteNothing) {
    std::string const path =
        makeFile("holes.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt hole 1/0/0 0\n");
    for (char const *const more : {"", " --adaptive --boundary edge-only"}) {
        expectFailure(path + " -o " + getPath("out.obj") + more, path,
                      "all faces are holes, none is left to write");
#ifdef HEXREFINE_HAS_RENDERER
        expectFailure(path + " --png " + getPath("out.png") + more, path,
                      "all faces are holes, none is left to draw");
#endif
    }
    EXPECT_EQ(run(path).status, 0);
    EXPECT_EQ(listFiles(), std::vector<std::string>{"holes.obj"});
}

TEST_F(Hexrefine, RefusesLevelsWithoutEndAtOnce) {
    std::string const path = makeFile("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (char const *scheme :
         {"doo-sabin", "tri-hex", "hexagonal", "doo-sabin --first-step tri-hex",
          "hexagonal --coplanar", "hexagonal --coplanar --open-gaps"}) {
        expectFailure(path + " -l 2147483647 --scheme " + scheme, path, "level");
    }
    EXPECT_EQ(run(path + " -l 100 --scheme doo-sabin").status, 0);
}

} // namespace OpenSubdivHex::Tools::fileTest

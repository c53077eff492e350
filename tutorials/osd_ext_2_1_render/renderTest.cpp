// SPDX-License-Identifier: Apache-2.0
//
// Runs the program osd_ext_2_1_render as its users do, and looks at its pictures.
#include "tools/mesh/meshReader.h"
#include "tools/mesh/meshWriter.h"
#include "tools/mesh/testFolder.h"
#include "tools/render/image.h"

#include <png.h>

#include <array>
#include <cmath>
#include <set>
#include <sstream>

namespace OpenSubdivHex::Tools::renderTest {

namespace {

using Color = std::array<int, 3>;

Image readPng(std::string const &path) {
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&png, path.c_str())) {
        ADD_FAILURE() << path << ": " << png.message;
        return Image(0, 0);
    }
    EXPECT_EQ(png.format, png_uint_32(PNG_FORMAT_RGB));
    Image image(int(png.width), int(png.height));
    EXPECT_TRUE(png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr))
        << png.message;
    return image;
}

Color getColor(Image const &image, int x, int y) {
    std::uint8_t const *pixel = image.pixels.data() + 3 * (y * image.width + x);
    return {pixel[0], pixel[1], pixel[2]};
}

/// Whether a colour is the surface's: clearly more red than blue, be it lit or in the shadow.
bool isSurface(Color color) { return color[0] > color[2] + 20; }

/// The part of the picture, or of its columns from \p left on, that shows the surface.
double measureSurface(Image const &image, int left, int right) {
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = left; x < right; ++x) {
            count += isSurface(getColor(image, x, y));
        }
    }
    return double(count) / (image.height * (right - left));
}
double measureSurface(Image const &image) { return measureSurface(image, 0, image.width); }

class Render : public TestFolder {
protected:
    int run(std::string const &arguments) const { return runProgram(RENDER_PROGRAM, arguments); }

    Image draw(std::string const &mesh, std::string const &arguments) const {
        std::string const path = getPath("picture.png");
        EXPECT_EQ(
            run(std::string("\"" MESHES_DIR "/") + mesh + "\" -o \"" + path + "\" " + arguments), 0)
            << arguments << getContent(getPath("stderr"));
        return readPng(path);
    }

    void expectBadUsage(std::string const &arguments, std::string const &cause) const {
        EXPECT_EQ(run(arguments), 2) << arguments;
        std::string const message = getContent(getPath("stderr"));
        EXPECT_NE(message.find(cause), std::string::npos) << message;
    }
};

} // namespace

TEST_F(Render, DrawsLanternInTheMiddle) {
    Image const image = draw("lantern.obj", "-l 3 --size 120x90");
    ASSERT_EQ(image.width, 120);
    ASSERT_EQ(image.height, 90);

    Color const background = getColor(image, 0, 0);
    EXPECT_GT(background[0], 200);
    EXPECT_EQ(getColor(image, 119, 0), background);
    EXPECT_EQ(getColor(image, 0, 89), background);
    EXPECT_EQ(getColor(image, 119, 89), background);

    EXPECT_GT(measureSurface(image), 0.1);
    EXPECT_LT(measureSurface(image), 0.5);
    EXPECT_GT(measureSurface(image, 40, 80), 0.3);
    EXPECT_EQ(measureSurface(image, 0, 20) + measureSurface(image, 100, 120), 0);

    // Light and shade on the surface, and shadows on the ground.
    int darkest = 255;
    int lightest = 0;
    int numShadows = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            Color const color = getColor(image, x, y);
            if (isSurface(color)) {
                darkest = std::min(darkest, color[0]);
                lightest = std::max(lightest, color[0]);
            } else {
                bool const isGray = std::abs(color[0] - color[2]) < 3;
                numShadows += isGray && color[0] < background[0] - 10 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(darkest, 0);
    EXPECT_LT(darkest, 160);
    EXPECT_GT(lightest, 220);
    EXPECT_GT(numShadows, 50);
}

TEST_F(Render, DrawsTheSameAgain) {
    std::string const arguments = "-l 3 --size 80x60 --wireframe --cage --samples 7";
    Image const image = draw("lantern.obj", arguments);
    std::string const first = getContent(getPath("picture.png"));
    draw("lantern.obj", arguments);
    EXPECT_EQ(getContent(getPath("picture.png")), first);
}

TEST_F(Render, FillsPictureOfAnyShape) {
    for (char const *size : {"100x50", "50x100"}) {
        Image const image =
            draw("ring.obj", std::string("-l 0 --hide-surface --cage --size ") + size);
        int left = image.width, right = 0, top = image.height, bottom = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                Color const color = getColor(image, x, y);
                if (color[2] > color[0] + 20) { // rods are blue
                    left = std::min(left, x);
                    right = std::max(right, x + 1);
                    top = std::min(top, y);
                    bottom = std::max(bottom, y + 1);
                }
            }
        }
        double const filled =
            std::max(double(right - left) / image.width, double(bottom - top) / image.height);
        EXPECT_NEAR(filled, 0.87, 0.06) << size;
        EXPECT_NEAR(left + right, image.width, 5) << size;
        EXPECT_NEAR(top + bottom, image.height, 5) << size;
    }
}

TEST_F(Render, OptionsChangeThePicture) {
    std::set<std::vector<std::uint8_t>> pictures;
    std::vector<std::string> const arguments = {"",
                                                "--mask average",
                                                "--mask cosine",
                                                "--wireframe",
                                                "--flat",
                                                "--zebra",
                                                "--cage",
                                                "--tint",
                                                "--camera 0,10",
                                                "--camera 30,20,2",
                                                "--no-ground",
                                                "--level 0",
                                                "--wireframe --line-width 4"};
    for (std::string const &options : arguments) {
        std::string const level = options == "--level 0" ? "" : " -l 2";
        pictures.insert(draw("ring.obj", "--size 60x45 --samples 4 " + options + level).pixels);
    }
    EXPECT_EQ(pictures.size(), arguments.size());
}

TEST_F(Render, BoundaryRuleKeepsTheBorder) {
    std::string const options = "-l 3 --size 60x45 --no-ground --boundary ";
    EXPECT_GT(measureSurface(draw("sail.obj", options + "edge-and-corner")),
              1.05 * measureSurface(draw("sail.obj", options + "none")));
}

TEST_F(Render, PanelsAreTheirOwnPictures) {
    Image const left = draw("ring.obj", "-l 2 --size 60x45 --wireframe");
    Image const right = draw("ring.obj", "-l 3 --size 60x45 --mask cosine");
    Image both(120, 45);
    PasteImage(left, 0, 0, &both);
    PasteImage(right, 60, 0, &both);
    std::string const panels = " --panel level=2,wireframe --panel level=3,mask=cosine ";
    EXPECT_EQ(draw("ring.obj", panels + "--size 120x45").pixels, both.pixels);

    Image stacked(60, 90);
    PasteImage(left, 0, 0, &stacked);
    PasteImage(right, 0, 45, &stacked);
    EXPECT_EQ(draw("ring.obj", panels + "--size 60x90 --columns 1").pixels, stacked.pixels);
}

TEST_F(Render, Animates) {
    std::string const still = "-l 2 --size 60x45 --samples 4 ";
    std::string const input = std::string("\"" MESHES_DIR "/ring.obj\" ");
    for (char const *animation : {"turntable", "twist"}) {
        ASSERT_EQ(run(input + still + "--frames 3 --animate " + animation + " -o \"" +
                      getPath("out.png") + "\""),
                  0);
        EXPECT_EQ(listFiles(), (std::vector<std::string>{"out_0001.png", "out_0002.png",
                                                         "out_0003.png", "stderr", "stdout"}));
        std::set<std::string> frames;
        for (char const *name : {"out_0001.png", "out_0002.png", "out_0003.png"}) {
            EXPECT_GT(measureSurface(readPng(getPath(name))), 0.1) << animation << " " << name;
            frames.insert(getContent(getPath(name)));
        }
        EXPECT_EQ(frames.size(), 3u) << animation;
    }
}

namespace {

/// The share of numbers that differ from those of another picture.
double countOthers(Image const &image, Image const &other) {
    int count = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        count += std::abs(image.pixels[i] - other.pixels[i]) > 12;
    }
    return double(count) / double(image.pixels.size());
}

} // namespace

// The cube has creases, whose normals differ from side to side.
TEST_F(Render, AdaptiveIsAsAFineLevel) {
    for (std::string const mesh : {"cube.obj", "ring.obj"}) {
        std::string const options = "--size 120x90 --samples 9 --no-ground ";
        Image const level = draw(mesh, options + "-l 4");
        Image const adaptive = draw(mesh, options + "--adaptive --pixel-error 0.1");
        Image const coarse = draw(mesh, options + "--adaptive --pixel-error 4");
        EXPECT_LT(countOthers(adaptive, level), 0.01) << mesh;
        if (mesh != "cube.obj") { // which is flat
            EXPECT_GT(countOthers(coarse, level), 2 * countOthers(adaptive, level));
        }
    }
    // Behind a first step, cells begin with the faces of level 1.
    std::string const truncated = "--size 120x90 --samples 9 --no-ground --first-step truncate ";
    Image const level = draw("triangles.obj", truncated + "-l 5");
    Image const cells = draw("triangles.obj", truncated + "--adaptive --pixel-error 0.1");
    EXPECT_LT(countOthers(cells, level), 0.01);
    EXPECT_NE(draw("ring.obj", "--size 60x45 --adaptive --flat --pixel-error 2").pixels,
              draw("ring.obj", "--size 60x45 --adaptive --pixel-error 2").pixels);
    EXPECT_NE(draw("cube.obj", "--size 60x45 --adaptive --regions").pixels,
              draw("cube.obj", "--size 60x45 --adaptive").pixels);
}

TEST_F(Render, AdaptiveFollowsTheCamera) {
    std::string const input = std::string("\"" MESHES_DIR "/ring.obj\" ");
    ASSERT_EQ(run(input + "--size 60x45 --samples 1 --adaptive --frames 2 --camera 30,20,3 -o \"" +
                  getPath("out.png") + "\""),
              0);
    std::istringstream lines(getContent(getPath("stdout")));
    std::set<std::string> counts;
    for (std::string line; std::getline(lines, line);) {
        if (line.find(" polygons") != std::string::npos) {
            counts.insert(line);
        }
    }
    EXPECT_EQ(counts.size(), 2u);
}

TEST_F(Render, TheSizeOfTheMeshDoesNotMatter) {
    std::string const options = "-l 2 --size 60x45 --samples 4 --cage";
    Mesh const mesh = ReadMesh(MESHES_DIR "/ring.obj");
    Image const expected = draw("ring.obj", options);
    for (int exponent : {-100, 120}) {
        Mesh scaled = mesh;
        for (float &position : scaled.positions) {
            position = std::ldexp(position, exponent);
        }
        std::string const output = getPath("out.png");
        WriteMesh(scaled, getPath("scaled.obj"));
        ASSERT_EQ(run("\"" + getPath("scaled.obj") + "\" " + options + " -o \"" + output + "\""),
                  0);
        EXPECT_EQ(readPng(output).pixels, expected.pixels) << exponent;
    }
}

TEST_F(Render, ShowsWhatFacesHave) {
    std::string const ring = getContent(MESHES_DIR "/ring.obj");
    int const numVertices = ReadMesh(MESHES_DIR "/ring.obj").GetNumVertices();
    int const numFaces = ReadMesh(MESHES_DIR "/ring.obj").GetNumFaces();
    std::string const far = "\nv 200 -9 0\nv 1e30 0 0\nv 0 1e30 -1e30\n";
    std::string hole = far + "f";
    for (int i = 1; i <= 3; ++i) {
        hole += " " + std::to_string(numVertices + i);
    }
    hole += "\nt hole 1/0/0 " + std::to_string(numFaces) + "\n";
    std::string const output = getPath("out.png");
    std::string const last = getPath("out_0003.png");
    for (std::string const &options :
         {"-l 2 --size 60x45 --samples 4 --wireframe --frames 3 --animate twist -o \"" + output,
          "--adaptive --boundary edge-only --size 60x45 --samples 4 --frames 3 -o \"" + output}) {
        std::vector<std::vector<std::uint8_t>> pictures;
        for (std::string const &more : {std::string(), far, hole}) {
            ASSERT_EQ(run("\"" + makeFile("more.obj", ring + more) + "\" " + options + "\""), 0)
                << getContent(getPath("stderr"));
            pictures.push_back(readPng(last).pixels);
        }
        EXPECT_GT(std::set<std::uint8_t>(pictures[0].begin(), pictures[0].end()).size(), 9u);
        EXPECT_EQ(pictures[1], pictures[0]) << options;
        EXPECT_EQ(pictures[2], pictures[0]) << options;
    }
}

TEST_F(Render, DrawsNothingOfHoles) {
    std::string const mesh =
        makeFile("holes.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt hole 1/0/0 0\n");
    std::string const output = getPath("out.png");
    for (char const *const settings :
         {"level=0", "level=2,zebra", "adaptive,boundary=edge-only", "hide-surface"}) {
        ASSERT_EQ(
            run("\"" + mesh + "\" --size 20x15 --panel " + settings + " -o \"" + output + "\""), 0)
            << getContent(getPath("stderr"));
        Image const image = readPng(output);
        std::set<std::uint8_t> const colors(image.pixels.begin(), image.pixels.end());
        EXPECT_EQ(colors.size(), 1u) << settings;
        EXPECT_GT(*colors.begin(), 200) << settings;
    }
    ASSERT_EQ(run("\"" + mesh + "\" --size 20x15 --cage -o \"" + output + "\""), 0);
    Image const cage = readPng(output);
    EXPECT_GT(std::set<std::uint8_t>(cage.pixels.begin(), cage.pixels.end()).size(), 9u);
}

TEST_F(Render, RefusesBadInput) {
    std::string const output = getPath("out.png");
    EXPECT_EQ(run("no.obj -o \"" + output + "\""), 1);
    std::string const message = getContent(getPath("stderr"));
    EXPECT_EQ(message.rfind("osd_ext_2_1_render: no.obj: ", 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), message.size() - 1) << message;

    std::string const broken =
        makeFile("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n");
    EXPECT_EQ(run("\"" + broken + "\" -o \"" + output + "\""), 1);
    EXPECT_EQ(getContent(getPath("stderr")).rfind("osd_ext_2_1_render: " + broken + ": ", 0), 0u);
    EXPECT_FALSE(std::filesystem::exists(output));

    std::string const mesh = std::string("\"" MESHES_DIR "/ring.obj\" ");
    std::string const unwritable = getPath("none/out.png");
    EXPECT_EQ(run(mesh + "-l 0 --size 8x8 -o \"" + unwritable + "\""), 1);
    EXPECT_NE(getContent(getPath("stderr")).find(unwritable), std::string::npos);
    EXPECT_EQ(run(std::string("\"" MESHES_DIR "/sail.obj\" --adaptive -o \"") + output + "\""), 1);
    EXPECT_NE(getContent(getPath("stderr")).find("--adaptive needs --boundary edge-only"),
              std::string::npos);
    std::filesystem::create_symlink("loop.png", getPath("loop.png"));
    EXPECT_EQ(run(mesh + "-l 0 --size 8x8 -o \"" + getPath("loop.png") + "\""), 1);
    EXPECT_NE(getContent(getPath("stderr")).find("loop.png: cannot be written"), std::string::npos);
}

TEST_F(Render, RefusesBadUsage) {
    expectBadUsage("", "INPUT");
    expectBadUsage("a.obj", "--output");
    expectBadUsage("a.obj -o a.jpg", "a.jpg");
    expectBadUsage("a.obj -o a.png --size 100", "100");
    expectBadUsage("a.obj -o a.png --size 0x10", "0x10");
    expectBadUsage("a.obj -o a.png --mask round", "round");
    expectBadUsage("a.obj -o a.png --boundary round", "round");
    expectBadUsage("a.obj -o a.png --level -1", "level");
    expectBadUsage("a.obj -o a.png --adaptive --pixel-error 0", "pixel-error");
    expectBadUsage("a.obj -o a.png --adaptive --pixel-error nan", "--pixel-error: 'nan'");
    expectBadUsage("a.obj -o a.png --panel pixel-error=nan", "--pixel-error: 'nan'");
    expectBadUsage("a.obj -o a.png --line-width nan", "--line-width: 'nan'");
    expectBadUsage("a.obj -o a.png --line-width 0", "--line-width: '0' is not a number above 0");
    expectBadUsage("a.obj -o a.png --zebra --flat", "zebra");
    expectBadUsage("a.obj -o a.png --samples 0", "samples");
    expectBadUsage("a.obj -o a.png --camera 1", "camera");
    expectBadUsage("a.obj -o a.png --camera 1,95", "--camera: 95");
    expectBadUsage("a.obj -o a.png --camera 1,2,0", "--camera: the zoom factor is not positive");
    expectBadUsage("a.obj -o a.png --columns 0", "not in range 1 to 2147483647");
    expectBadUsage("a.obj -o a.png --animate jump", "jump");
    expectBadUsage("a.obj -o a.png --panel level=x", "level");
    expectBadUsage("a.obj -o a.png --panel size=1x1", "size");
    expectBadUsage("a.obj -o a.png --size 2x2 --panel cage --panel flat --panel tint", "2x2");
}

} // namespace OpenSubdivHex::Tools::renderTest

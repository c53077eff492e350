// SPDX-License-Identifier: Apache-2.0
//
// Texture coordinates and normals through hexrefine.
#include "far_ext/primvarRefiner.h"
#include "programFixture.h"
#include "tools/mesh/point.h"

#include <array>
#include <set>

namespace OpenSubdivHex::Tools::channelTest {

namespace {

using Options = Sdc::Options;

/// A cube whose texture is laid out as a cross, with seams along 7 of its 12 edges.
std::string makeCrossContent() {
    return "v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 -1\nv 1 -1 -1\n"
           "vt 1 0\nvt 2 0\nvt 1 1\nvt 2 1\nvt 1 2\nvt 2 2\nvt 1 3\nvt 2 3\nvt 1 4\nvt 2 4\n"
           "vt 3 0\nvt 3 1\nvt 0 0\nvt 0 1\n"
           "f 1/1 2/2 4/4 3/3\nf 3/3 4/4 6/6 5/5\nf 5/5 6/6 8/8 7/7\nf 7/7 8/8 2/10 1/9\n"
           "f 2/2 8/11 6/12 4/4\nf 7/13 1/1 3/3 5/14\n";
}

struct Uv {
    float numbers[2];

    void Clear() { numbers[0] = numbers[1] = 0; }
    void AddWithWeight(Uv const &value, float weight) {
        numbers[0] += weight * value.numbers[0];
        numbers[1] += weight * value.numbers[1];
    }
};

class HexrefineChannel : public Hexrefine {
protected:
    std::string makeCross(std::string const &more = "") const {
        return makeFile("cross.obj", makeCrossContent() + more);
    }

    Mesh refine(std::string const &arguments) const {
        Result const result = run(arguments + " --quiet -o " + getPath("out.obj"));
        EXPECT_EQ(result.status, 0) << result.error;
        return ReadMesh(getPath("out.obj"));
    }

    /// Expects the cross refined as the library does it with \p rule, to more faces than one
    /// thread copies at a time.
    void expectRefined(std::string const &arguments, Options::FVarLinearInterpolation rule,
                       std::vector<int> const &holes = {}) const {
        SCOPED_TRACE(arguments);
        constexpr int kLevel = 6;
        Mesh const mesh = refine(arguments + " -l " + std::to_string(kLevel));
        Mesh const cross = ReadMesh(makeFile("plain.obj", makeCrossContent()));
        Far::TopologyDescriptor descriptor = DescribeTopology(cross);
        Far::TopologyDescriptor::FVarChannel channel;
        channel.numValues = 14;
        channel.valueIndices = cross.channels[0].faceValues.data();
        descriptor.numFVarChannels = 1;
        descriptor.fvarChannels = &channel;
        descriptor.numHoles = int(holes.size());
        descriptor.holeIndices = holes.data();
        Options options;
        options.SetFVarLinearInterpolation(rule);
        auto const refiner = FarExt::TopologyRefinerFactory::Create(descriptor, options);
        ASSERT_TRUE(refiner);
        refiner->RefineUniform(kLevel);
        std::vector<Uv> uvs(14);
        std::copy(cross.channels[0].values.begin(), cross.channels[0].values.end(),
                  &uvs[0].numbers[0]);
        for (int level = 1; level <= kLevel; ++level) {
            std::vector<Uv> refined(refiner->GetLevel(level).GetNumFVarValues());
            FarExt::PrimvarRefiner(*refiner).InterpolateFaceVarying(level, uvs, refined);
            uvs = refined;
        }
        ASSERT_EQ(mesh.channels.size(), 1u);
        std::vector<float> const &values = mesh.channels[0].values;
        ASSERT_EQ(values.size(), 2 * uvs.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_NEAR(values[i], uvs[i / 2].numbers[i % 2], 1e-5) << i;
        }

        // Every corner of every face, a face that a seam crosses being its two halves.
        FarExt::TopologyLevel const &level = refiner->GetLevel(kLevel);
        std::vector<int> faceValues;
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            auto const whole = level.GetFaceFVarValues(f);
            bool const isSplit = level.IsFaceFVarSplit(f);
            if (!isSplit && level.IsFaceHole(f, 0) == level.IsFaceHole(f, 1)) {
                if (!level.IsFaceHole(f)) {
                    faceValues.insert(faceValues.end(), whole.begin(), whole.end());
                }
                continue;
            }
            for (int half = 0; half < 2; ++half) {
                for (int i = 0; i < 4 && !level.IsFaceHole(f, half); ++i) {
                    int const corner = FarExt::kHexagonHalves[half][i];
                    faceValues.push_back(isSplit ? level.GetFaceFVarValues(f, 0, half)[i]
                                                 : whole[corner]);
                }
            }
        }
        EXPECT_EQ(mesh.channels[0].faceValues, faceValues);
    }
};

struct Rule {
    char const *name;
    Options::FVarLinearInterpolation value;
};
constexpr Rule kRules[] = {{"none", Options::FVAR_LINEAR_NONE},
                           {"corners-only", Options::FVAR_LINEAR_CORNERS_ONLY},
                           {"corners-plus1", Options::FVAR_LINEAR_CORNERS_PLUS1},
                           {"corners-plus2", Options::FVAR_LINEAR_CORNERS_PLUS2},
                           {"boundaries", Options::FVAR_LINEAR_BOUNDARIES},
                           {"all", Options::FVAR_LINEAR_ALL}};

} // namespace

TEST_F(HexrefineChannel, LinearInterpolationRules) {
    std::set<std::vector<float>> results;
    for (Rule const &rule : kRules) {
        std::string const option = std::string(" --fvar-interpolation ") + rule.name;
        std::string const tag =
            "t facevaryinginterpolateboundary 1/0/0 " + std::to_string(rule.value) + "\n";
        expectRefined(makeCross() + option, rule.value);
        for (char const *evaluator : {"primvar", "stencil", "stencil-cpu"}) {
            expectRefined(makeCross() + option + " --evaluator " + evaluator, rule.value);
        }
        expectRefined(makeCross(tag), rule.value);
        // The command line comes before the file.
        expectRefined(makeCross("t facevaryinginterpolateboundary 1/0/0 4\n") + option, rule.value);
        Result const result = run(makeCross(tag) + " --stats -");
        EXPECT_EQ(Json::parse(result.out)["fvarInterpolation"], rule.name);
        results.insert(refine(makeCross() + option).channels.at(0).values);
    }
    EXPECT_GE(results.size(), 3u);
    expectRefined(makeCross(), Options::FVAR_LINEAR_ALL);
    expectRefined(makeCross("t facevaryinginterpolateboundary 1/0/0 2\n"
                            "t facevaryingpropagatecorners 1/0/0 1\n"),
                  Options::FVAR_LINEAR_CORNERS_PLUS2);
}

TEST_F(HexrefineChannel, OnlySeamsSplitHexagons) {
    Mesh mesh = refine(makeCross() + " -l 1");
    EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 4), 6 + 2 * 7);
    EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 6), 5);
    EXPECT_EQ(mesh.GetNumVertices(), 32);
    expectClosed(mesh);

    WriteMesh(MakeCube(), getPath("smooth.obj"));
    makeFile("smooth.obj", "v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\nv -1 1 -1\nv 1 1 -1\n"
                           "v -1 -1 -1\nv 1 -1 -1\nvn -1 -1 1\nvn 1 -1 1\nvn -1 1 1\nvn 1 1 1\n"
                           "vn -1 1 -1\nvn 1 1 -1\nvn -1 -1 -1\nvn 1 -1 -1\n"
                           "f 1//1 2//2 4//4 3//3\nf 3//3 4//4 6//6 5//5\nf 5//5 6//6 8//8 7//7\n"
                           "f 7//7 8//8 2//2 1//1\nf 2//2 8//8 6//6 4//4\nf 7//7 1//1 3//3 5//5\n");
    mesh = refine(getPath("smooth.obj") + " -l 1");
    EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 6), 12);
    ASSERT_EQ(mesh.channels.size(), 1u);
    EXPECT_EQ(mesh.channels[0].kind, FVarKind::Normal);
    EXPECT_EQ(mesh.channels[0].faceValues, mesh.faceVertices);
}

TEST_F(HexrefineChannel, NormalsAreOneLong) {
    // A cube with one normal per face, some of them long: each face keeps its own, to the seam.
    std::string content = makeCrossContent();
    content.replace(content.find("vt"), std::string::npos, "");
    std::string const input = makeFile(
        "hard.obj", content + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                              "vn 0 0 5\nvn 0 1 0\nvn 0 0 -1\nvn 0 -1 0\nvn 0.1 0 0\nvn -1 0 0\n"
                              "f 1/1/1 2/2/1 4/3/1 3/4/1\nf 3/1/2 4/2/2 6/3/2 5/4/2\n"
                              "f 5/1/3 6/2/3 8/3/3 7/4/3\nf 7/1/4 8/2/4 2/3/4 1/4/4\n"
                              "f 2/1/5 8/2/5 6/3/5 4/4/5\nf 7/1/6 1/2/6 3/3/6 5/4/6\n");
    Mesh const mesh = refine(input + " -l 2");
    ASSERT_EQ(mesh.channels.size(), 2u);
    EXPECT_EQ(mesh.channels[0].faceValues.size(), mesh.faceVertices.size());
    FVarChannel const &normals = mesh.channels[1];
    EXPECT_EQ(normals.faceValues.size(), mesh.faceVertices.size());
    std::set<int> directions;
    for (int value : normals.faceValues) {
        float const *normal = &normals.values[3 * std::size_t(value)];
        float const sum = normal[0] + normal[1] + normal[2];
        EXPECT_NEAR(std::abs(sum), 1, 1e-6);
        EXPECT_NEAR(std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]), 1, 1e-6);
        directions.insert(int(std::lround(normal[0] + 2 * normal[1] + 3 * normal[2])));
    }
    EXPECT_EQ(directions, (std::set<int>{-3, -2, -1, 1, 2, 3}));
    // At level 0 values stay as they are.
    EXPECT_EQ(refine(input + " -l 0").channels[1].values, ReadMesh(input).channels[1].values);
}

TEST_F(HexrefineChannel, LevelZeroCopies) {
    Mesh const mesh = refine(makeCross() + " -l 0");
    Mesh const cross = ReadMesh(makeCross());
    ASSERT_EQ(mesh.channels.size(), 1u);
    EXPECT_EQ(mesh.faceVertices, cross.faceVertices);
    EXPECT_EQ(mesh.channels[0].values, cross.channels[0].values);
    EXPECT_EQ(mesh.channels[0].faceValues, cross.channels[0].faceValues);
}

TEST_F(HexrefineChannel, HolesAreLeftOut) {
    Mesh const mesh = refine(makeCross("t hole 2/0/0 0 1\n") + " -l 1");
    // 4 of 6 F-faces are left.  One of 5 hexagons lies in holes, 3 are halves beside holes, and one is
    // whole; 3 of 7 split hexagons are halves beside holes.
    EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 4), 4 + 3 + 3 + 2 * 4);
    EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 6), 1);
    EXPECT_EQ(mesh.channels.at(0).faceValues.size(), mesh.faceVertices.size());
    expectRefined(makeCross("t hole 2/0/0 0 1\n"), Options::FVAR_LINEAR_ALL, {0, 1});
}

TEST_F(HexrefineChannel, OtherFormatsSayWhatTheyLeaveOut) {
    for (char const *name : {"out.ply", "out.off"}) {
        std::string const arguments = makeCross() + " -l 1 -o " + getPath(name);
        Result const result = run(arguments);
        EXPECT_EQ(result.status, 0) << result.error;
        EXPECT_NE(result.out.find("files have no place for it: channel uv\n"), std::string::npos)
            << result.out;
        Mesh const mesh = ReadMesh(getPath(name));
        EXPECT_EQ(std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 6), 12);
        Json const json = Json::parse(run(arguments + " --stats -").out);
        EXPECT_EQ(json["fvarChannels"].dump(), "[]");
        EXPECT_EQ(json["fvarChannelsLeftOut"].dump(), R"(["uv"])");
        EXPECT_EQ(json["notWritten"].dump(), R"(["channel uv"])");
    }
    Result const result = run(makeCross() + " -l 1 --tags --stats " + getPath("stats"));
    EXPECT_NE(result.out.find("# channel uv: 14 values of 2 numbers"), std::string::npos);
    EXPECT_NE(result.out.find("channel uv: 14 values, 38 in the last level"), std::string::npos)
        << result.out;
    EXPECT_EQ(Json::parse(getContent(getPath("stats")))["fvarChannels"].dump(),
              R"([{"name":"uv","width":2,"values":[14,38]}])");
}

// A file with one record for each vertex has at each corner what an OBJ file has there, and no more
// vertices than that takes.
TEST_F(HexrefineChannel, SeparatesVertices) {
    std::string const cross = makeCross("t crease 2/1/0 0 1 10\nt crease 2/1/0 1 3 10\n"
                                        "t crease 2/1/0 3 2 10\nt crease 2/1/0 2 0 10\n");
    Mesh const mesh = refine("\"" + cross + "\" -l 3 --limit");
    ASSERT_EQ(mesh.channels.size(), 2u);
    using Corner = std::array<float, 8>; // position, s and t, normal
    std::vector<Corner> expected;
    std::set<std::array<int, 3>> vertices;
    for (std::size_t i = 0; i < mesh.faceVertices.size(); ++i) {
        Corner corner{};
        std::array<int, 3> const found = {mesh.faceVertices[i], mesh.channels[0].faceValues[i],
                                          mesh.channels[1].faceValues[i]};
        auto const copy = [](std::vector<float> const &from, int index, int width, float *to) {
            std::copy_n(from.begin() + std::ptrdiff_t(index) * width, width, to);
        };
        copy(mesh.positions, found[0], 3, corner.data());
        copy(mesh.channels[0].values, found[1], 2, corner.data() + 3);
        copy(mesh.channels[1].values, found[2], 3, corner.data() + 5);
        expected.push_back(corner);
        vertices.insert(found);
    }
    for (char const *name : {"out.ply", "out.off"}) {
        SCOPED_TRACE(name);
        Result const result =
            run("\"" + cross + "\" -l 3 --limit --separate-vertices -o " + getPath(name));
        ASSERT_EQ(result.status, 0) << result.error;
        EXPECT_EQ(result.out.find("not written"), std::string::npos) << result.out;
        Mesh const separate = ReadMesh(getPath(name));
        EXPECT_EQ(separate.GetNumVertices(), int(vertices.size()));
        EXPECT_GT(separate.GetNumVertices(), mesh.GetNumVertices());
        EXPECT_EQ(separate.faceSizes, mesh.faceSizes);
        ASSERT_EQ(separate.faceVertices.size(), expected.size());
        char const *const names[] = {"s", "t", "nx", "ny", "nz"};
        for (std::size_t i = 0; i < expected.size(); ++i) {
            auto const vert = std::size_t(separate.faceVertices[i]);
            Corner corner{};
            std::copy_n(separate.positions.begin() + std::ptrdiff_t(3 * vert), 3, corner.begin());
            for (std::size_t k = 0; k < std::size(names); ++k) {
                VertexProperty const *const property =
                    FindProperty(separate.vertexProperties, names[k]);
                ASSERT_TRUE(property) << names[k];
                corner[3 + k] = property->values[vert];
            }
            ASSERT_EQ(corner, expected[i]) << "corner " << i;
        }
    }
    std::string const cause = "is for an --output that is a .ply or .off file";
    expectBadUsage("\"" + cross + "\" --separate-vertices -o " + getPath("out.obj"), cause);
    expectBadUsage("\"" + cross + "\" --separate-vertices", cause);
}

TEST_F(HexrefineChannel, SeparateVerticesHaveThirdTextureCoordinates) {
    std::string const input = makeFile(
        "a.obj", "vt 0 0 .5\nvt 1 0 0\nvt 1 1 0\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/3\n");
    Result result = run(input + " -l 1 --separate-vertices -o " + getPath("out.ply"));
    ASSERT_EQ(result.status, 0) << result.error;
    EXPECT_EQ(result.out.find("not written"), std::string::npos) << result.out;
    Mesh const mesh = ReadMesh(getPath("out.ply"));
    VertexProperty const *const third = FindProperty(mesh.vertexProperties, "r");
    ASSERT_TRUE(third);
    EXPECT_EQ(third->values[0], 0.5f);
    result = run(input + " -l 1 --separate-vertices -o " + getPath("out.off"));
    ASSERT_EQ(result.status, 0) << result.error;
    EXPECT_NE(result.out.find("not written, .off files have no place for it: vertex property r"),
              std::string::npos)
        << result.out;
}

} // namespace OpenSubdivHex::Tools::channelTest

// SPDX-License-Identifier: Apache-2.0
//
// Boundaries, creases, corners and holes: hexrefine gives what the library gives.
#include "far_ext/primvarRefiner.h"
#include "osd_ext/polygonIndices.h"
#include "programFixture.h"
#include "tools/mesh/shownVertices.h"

#include "tools/mesh/point.h"
#include <set>

namespace OpenSubdivHex::Tools::tagTest {

namespace {

using Options = Sdc::Options;

/// 4 x 4 vertices, vertex 4 y + x at (x, y, height), and the 9 quads between them.
Mesh makeGrid(std::vector<float> const &heights) {
    Mesh mesh;
    for (int i = 0; i < 16; ++i) {
        int const x = i % 4;
        int const y = i / 4;
        mesh.positions.insert(mesh.positions.end(), {float(x), float(y), heights[std::size_t(i)]});
        if (x < 3 && y < 3) {
            mesh.faceSizes.push_back(4);
            mesh.faceVertices.insert(mesh.faceVertices.end(), {i, i + 1, i + 5, i + 4});
        }
    }
    return mesh;
}

class HexrefineTag : public Hexrefine {
protected:
    HexrefineTag() : _grid(makeGrid({0, 1, 0, 2, 1, 3, 2, 0, 0, 1, 4, 1, 1, 0, 1, 2})) {
        WriteMesh(_grid, getPath("grid.obj"));
    }

    Far::TopologyDescriptor describeGrid() const { return DescribeTopology(_grid); }

    /// The grid and \p tags.
    std::string makeGridFile(std::string const &tags) const {
        return makeFile("tagged.obj", getContent(getPath("grid.obj")) + tags);
    }

    Mesh refine(std::string const &arguments) const {
        Result const result = run(arguments + " -l 3 --quiet -o " + getPath("out.obj"));
        EXPECT_EQ(result.status, 0) << result.error;
        EXPECT_EQ(result.out + result.error, "");
        return ReadMesh(getPath("out.obj"));
    }

    /// Expects that hexrefine makes level 3 of the grid, as the library does from \p descriptor.
    void expectRefined(std::string const &arguments, Far::TopologyDescriptor const &descriptor,
                       Options options) const {
        SCOPED_TRACE(arguments);
        Mesh const mesh = refine(arguments);
        auto const refiner = FarExt::TopologyRefinerFactory::Create(descriptor, options);
        ASSERT_TRUE(refiner);
        refiner->RefineUniform(3);
        std::vector<Point> points = CopyPoints(_grid);
        for (int level = 1; level <= 3; ++level) {
            std::vector<Point> refined(refiner->GetLevel(level).GetNumVertices());
            FarExt::PrimvarRefiner(*refiner).Interpolate(level, points, refined);
            points = refined;
        }
        std::vector<Point> const printed = CopyPoints(mesh);
        ASSERT_EQ(printed.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_LT(ComputeDistance(printed[i], points[i]), 1e-5f) << i;
        }
        FarExt::TopologyLevel const &level = refiner->GetLevel(3);
        std::vector<int> vertices;
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            auto const faceVertices = level.GetFaceVertices(f);
            bool const isHole[] = {level.IsFaceHole(f, 0), level.IsFaceHole(f, 1)};
            if (!isHole[0] && !isHole[1]) {
                vertices.insert(vertices.end(), faceVertices.begin(), faceVertices.end());
                continue;
            }
            for (int half = 0; half < 2; ++half) {
                for (int i = 0; i < 4 && !isHole[half]; ++i) {
                    vertices.push_back(faceVertices[FarExt::kHexagonHalves[half][i]]);
                }
            }
        }
        EXPECT_EQ(mesh.faceVertices, vertices);
    }

    Json getStatistics(std::string const &arguments) const {
        Result const result = run(arguments + " -l 2 --stats -");
        EXPECT_EQ(result.status, 0) << result.error;
        return Json::parse(result.out);
    }

    Mesh const _grid;
};

Options makeOptions(Options::VtxBoundaryInterpolation boundary,
                    Options::CreasingMethod creasingMethod = Options::CREASE_UNIFORM) {
    Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    options.SetCreasingMethod(creasingMethod);
    return options;
}

} // namespace

// The vertices that pictures show are those of the polygons that are drawn, halves of hexagons among them.
TEST(ShownVertices, AreThoseOfDrawnPolygons) {
    Mesh mesh = MakeCube();
    mesh.positions.insert(mesh.positions.end(), 3, 0); // a vertex without faces
    mesh.tags.holes = {1, 4};
    auto const refiner = FarExt::TopologyRefinerFactory::Create(DescribeTopology(mesh));
    FarExt::TopologyRefiner::UniformOptions options(3);
    options.fullTopologyInLastLevel = true;
    ASSERT_TRUE(refiner->RefineUniform(options));
    for (int depth = 0; depth <= 3; ++depth) {
        FarExt::TopologyLevel const &level = refiner->GetLevel(depth);
        std::vector<int> const drawn = OsdExt::CreatePolygonIndices(level).vertices;
        std::set<int> const expected(drawn.begin(), drawn.end());
        EXPECT_LT(int(expected.size()), level.GetNumVertices()) << depth;
        EXPECT_EQ(FindShownVertices(level), std::vector<int>(expected.begin(), expected.end()))
            << depth;
    }
    EXPECT_EQ(FindShownVertices(mesh), FindShownVertices(refiner->GetLevel(0)));
    mesh.tags.holes = {0, 1, 2, 3, 4, 5};
    EXPECT_EQ(FindShownVertices(mesh), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(HexrefineTag, BoundaryRules) {
    struct {
        char const *name;
        char const *tag;
        Options::VtxBoundaryInterpolation rule;
    } const rules[] = {
        {"none", "t interpolateboundary 1/0/0 0\n", Options::VTX_BOUNDARY_NONE},
        {"edge-only", "t interpolateboundary 1/0/0 2\n", Options::VTX_BOUNDARY_EDGE_ONLY},
        {"edge-and-corner", "t interpolateboundary 1/0/0 1\n",
         Options::VTX_BOUNDARY_EDGE_AND_CORNER}};
    std::vector<std::vector<float>> positions;
    for (auto const &rule : rules) {
        std::string const option = std::string(" --boundary ") + rule.name;
        expectRefined(getPath("grid.obj") + option, describeGrid(), makeOptions(rule.rule));
        expectRefined(makeGridFile(rule.tag), describeGrid(), makeOptions(rule.rule));
        EXPECT_EQ(getStatistics(getPath("tagged.obj"))["boundary"], rule.name);
        // The command line comes before the file.
        for (auto const &other : rules) {
            makeGridFile(other.tag);
            expectRefined(getPath("tagged.obj") + option, describeGrid(), makeOptions(rule.rule));
            EXPECT_EQ(getStatistics(getPath("tagged.obj") + option)["boundary"], rule.name);
        }
        positions.push_back(refine(getPath("grid.obj") + option).positions);
    }
    EXPECT_NE(positions[0], positions[1]);
    EXPECT_NE(positions[1], positions[2]);
    EXPECT_EQ(getStatistics(getPath("grid.obj"))["boundary"], "none");
}

TEST_F(HexrefineTag, CreasesAndCorners) {
    Far::TopologyDescriptor descriptor = describeGrid();
    std::vector<float> const smooth = refine(getPath("grid.obj")).positions;
    int const creases[] = {4, 5, 5, 6, 6, 7, 6, 10};
    float const sharpness[] = {2.5f, 2.5f, 2.5f, 1.5f};
    descriptor.numCreases = 4;
    descriptor.creaseVertexIndexPairs = creases;
    descriptor.creaseWeights = sharpness;
    std::string const creaseTags = "t crease 6/1/0 4 5 5 6 7 6 2.5\nt crease 2/1/0 6 10 1.5\n";
    expectRefined(makeGridFile(creaseTags + "t creasemethod 0/0/1 normal\n"), descriptor,
                  makeOptions(Options::VTX_BOUNDARY_NONE));
    std::vector<float> const uniform = refine(getPath("tagged.obj")).positions;
    EXPECT_NE(uniform, smooth);
    expectRefined(makeGridFile(creaseTags + "t creasemethod 0/0/1 chaikin\n"), descriptor,
                  makeOptions(Options::VTX_BOUNDARY_NONE, Options::CREASE_CHAIKIN));
    EXPECT_NE(refine(getPath("tagged.obj")).positions, uniform);

    int const corners[] = {9, 5};
    float const cornerSharpness[] = {2.5f, 10};
    descriptor.numCorners = 2;
    descriptor.cornerVertexIndices = corners;
    descriptor.cornerWeights = cornerSharpness;
    std::string const cornerTags = "t corner 2/2/0 9 5 2.5 10\nt interpolateboundary 1/0/0 2\n";
    expectRefined(makeGridFile(creaseTags + cornerTags), descriptor,
                  makeOptions(Options::VTX_BOUNDARY_EDGE_ONLY));
    Json const json = getStatistics(getPath("tagged.obj"));
    EXPECT_EQ(json["creases"], 4);
    EXPECT_EQ(json["corners"], 2);
    EXPECT_EQ(json["creasingMethod"], "uniform");
    Mesh const mesh = refine(getPath("tagged.obj"));
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(mesh.positions[3 * 5 + k], _grid.positions[3 * 5 + k]);
    }
}

TEST_F(HexrefineTag, HolesAreLeftOut) {
    Far::TopologyDescriptor descriptor = describeGrid();
    int const holes[] = {4, 5};
    descriptor.numHoles = 2;
    descriptor.holeIndices = holes;
    std::string const input = makeGridFile("t hole 2/0/0 5 4\n");
    for (auto rule : {Options::VTX_BOUNDARY_NONE, Options::VTX_BOUNDARY_EDGE_ONLY}) {
        std::string const option =
            rule == Options::VTX_BOUNDARY_NONE ? "" : " --boundary edge-only";
        expectRefined(input + option, descriptor, makeOptions(rule));
    }
    // Two faces, the E-face between them and, at a free boundary, that of the boundary edge.
    Json const json = getStatistics(input);
    EXPECT_EQ(json["holes"][0], 2);
    EXPECT_EQ(json["holes"][1], 4);
    Result const result = run(input + " -l 1");
    EXPECT_NE(result.out.find("2 holes; without them the last level has 29 faces"),
              std::string::npos)
        << result.out;
    EXPECT_NE(run(makeGridFile("t hole 1/0/0 4\n") + " -l 1")
                  .out.find("1 hole; without it the last level has 32 faces"),
              std::string::npos);
    makeGridFile("t hole 2/0/0 5 4\n");
    run(input + " -l 0 --quiet -o " + getPath("copy.off"));
    EXPECT_EQ(ReadMesh(getPath("copy.off")).GetNumFaces(), 7);
    EXPECT_EQ(ReadMesh(getPath("copy.off")).GetNumVertices(), 16);
}

TEST_F(HexrefineTag, CreaseAngle) {
    std::string const cube = makeCubeFile();
    EXPECT_EQ(getStatistics(cube + " --crease-angle 89.9")["creases"], 12);
    EXPECT_EQ(getStatistics(cube + " --crease-angle 90")["creases"], 0);
    EXPECT_EQ(getStatistics(cube)["creases"], 0);
    // All vertices of the cube are corners where three creases meet.
    Result const result = run(cube + " -l 3 --quiet --crease-angle 45 -o " + getPath("sharp.ply"));
    EXPECT_EQ(result.status, 0) << result.error;
    std::vector<float> positions = ReadMesh(getPath("sharp.ply")).positions;
    positions.resize(24);
    EXPECT_EQ(positions, MakeCube().positions);

    // In a flat grid no edge is sharp; with a ridge, the three edges along it are.
    WriteMesh(makeGrid(std::vector<float>(16, 0.3f)), getPath("flat.obj"));
    EXPECT_EQ(getStatistics(getPath("flat.obj") + " --crease-angle 0")["creases"], 0);
    WriteMesh(makeGrid({0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0}), getPath("ridge.obj"));
    EXPECT_EQ(getStatistics(getPath("ridge.obj") + " --crease-angle 89")["creases"], 3);
    EXPECT_EQ(getStatistics(getPath("ridge.obj") + " --crease-angle 44")["creases"], 6);
    EXPECT_EQ(getStatistics(getPath("ridge.obj") + " --crease-angle 46")["creases"], 3);
    EXPECT_EQ(getStatistics(getPath("grid.obj") + " --crease-angle 180")["creases"], 0);
}

TEST_F(HexrefineTag, CreaseAngleOfOddFaces) {
    // An L of six corners that turns the other way at its second.
    std::string const vertices = "v 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 -1 0\n";
    makeFile("l.obj", vertices + "f 6 1 2 3 4 5\nf 5 4 7\n");
    EXPECT_EQ(getStatistics(getPath("l.obj") + " --crease-angle 1")["creases"], 0);
    makeFile("l.obj", vertices + "f 6 1 2 3 4 5\nf 5 4 8\nv 1 0 1\n");
    EXPECT_EQ(getStatistics(getPath("l.obj") + " --crease-angle 89")["creases"], 1);
    // A face without area has no angle to others, an edge with three faces none between two.
    makeFile("line.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 2 1 4\n");
    EXPECT_EQ(getStatistics(getPath("line.obj") + " --crease-angle 0")["creases"], 0);
    makeFile("fin.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\n"
                        "f 1 2 3\nf 2 1 5\nf 1 2 4\n");
    EXPECT_EQ(getStatistics(getPath("fin.obj") + " --crease-angle 0")["creases"], 0);
}

TEST_F(HexrefineTag, CreaseAngleAddsToTheFile) {
    WriteMesh(makeGrid({0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0}), getPath("ridge.obj"));
    std::string const input =
        makeFile("tagged.obj", getContent(getPath("ridge.obj")) +
                                   "t crease 2/1/0 5 4 1.5\nt crease 2/1/0 5 9 0.5\n");
    Result const result = run(input + " --crease-angle 89 --tags --quiet");
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_NE(result.out.find("t crease 2/1/0 4 5 10\nt crease 2/1/0 5 6 10\n"
                              "t crease 2/1/0 5 9 0.5\nt crease 2/1/0 6 7 10\n"),
              std::string::npos)
        << result.out;
}

TEST_F(HexrefineTag, PrintsTagsThatSayTheSame) {
    std::string const input =
        makeGridFile("t corner 1/1/0 9 2.7\nt crease 2/1/0 6 5 0.1\nt hole 1/0/0 4\n"
                     "t creasemethod 0/0/1 chaikin\nt interpolateboundary 1/0/0 1\n"
                     "t facevaryinginterpolateboundary 1/0/0 3\n");
    std::string const expected = "# 1 creases, 1 corners, 1 holes\n"
                                 "# boundary edge-and-corner, creases chaikin, face-varying "
                                 "corners-plus2\n"
                                 "t interpolateboundary 1/0/0 1\n"
                                 "t facevaryinginterpolateboundary 1/0/0 3\n"
                                 "t creasemethod 0/0/1 chaikin\n"
                                 "t crease 2/1/0 5 6 0.1\n"
                                 "t corner 1/1/0 9 2.7\n"
                                 "t hole 1/0/0 4\n";
    EXPECT_EQ(run(input + " --tags --quiet").out, expected);
    EXPECT_EQ(run(input + " --tags").out.rfind(expected, 0), 0u);
    Mesh const mesh = refine(input);
    makeGridFile(expected);
    EXPECT_EQ(refine(input).positions, mesh.positions);
    EXPECT_EQ(run(input + " --tags --quiet").out, expected);

    for (char const *boundary : {"none", "edge-only", "edge-and-corner"}) {
        std::string const option = std::string(" --boundary ") + boundary;
        std::vector<float> const positions = refine(getPath("grid.obj") + option).positions;
        makeGridFile(run(getPath("grid.obj") + option + " --tags --quiet").out);
        EXPECT_EQ(refine(getPath("tagged.obj")).positions, positions) << boundary;
    }
}

} // namespace OpenSubdivHex::Tools::tagTest

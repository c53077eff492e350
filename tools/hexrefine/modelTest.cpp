// SPDX-License-Identifier: Apache-2.0
//
// Models through hexrefine: tori with seams, borders and flaws, and the meshes of
// OPENSUBDIVHEX_MESHES_DIR where it is there.
#include "programFixture.h"

#include "regression/shapes/featureShapes.h"
#include "regression/shapes/torus.h"

#include <filesystem>
#include <map>
#include <numeric>

namespace OpenSubdivHex::Tools::modelTest {

namespace {

using Regression::Shape;
using Regression::TorusFaces;

constexpr int kNumU = 16; ///< around the axis of a torus
constexpr int kNumV = 6;  ///< around its tube

/// A file, and how many there are of what a test is about.
struct Model {
    std::string path;
    int count;
};

Mesh toMesh(Shape const &shape) {
    Mesh mesh;
    mesh.positions.assign(shape.positions.begin(), shape.positions.end());
    mesh.faceSizes = shape.faceSizes;
    mesh.faceVertices = shape.faceVertices;
    return mesh;
}

/// A torus of triangles, whose texture is cut along two circles around the tube into two charts.
Mesh makeTorusOfCharts() {
    Shape const torus = Regression::MakeTorus(kNumU, kNumV, TorusFaces::IrregularTriangles);
    std::vector<int> cuts;
    for (int u : {0, kNumU / 2}) {
        for (int v = 0; v < kNumV; ++v) {
            cuts.insert(cuts.end(), {kNumV * u + v, kNumV * u + (v + 1) % kNumV});
        }
    }
    Regression::FVarChannel const charts = Regression::MakeSeamChannel(torus, cuts);
    Mesh mesh = toMesh(torus);
    mesh.channels.resize(1);
    mesh.channels[0].values.assign(charts.values.begin(), charts.values.end());
    mesh.channels[0].faceValues = charts.valueIndices;
    return mesh;
}

/// A torus of quads without those that \p isLeftOut(u, v) names.
template <typename IS_LEFT_OUT>
Mesh makeOpenTorus(IS_LEFT_OUT const &isLeftOut) {
    Mesh mesh = toMesh(Regression::MakeTorus(kNumU, kNumV, TorusFaces::Quads));
    std::vector<int> faceVertices;
    for (int u = 0; u < kNumU; ++u) {
        for (int v = 0; v < kNumV; ++v) {
            if (!isLeftOut(u, v)) {
                auto const corner = mesh.faceVertices.begin() + 4 * (kNumV * u + v);
                faceVertices.insert(faceVertices.end(), corner, corner + 4);
            }
        }
    }
    mesh.faceVertices = faceVertices;
    mesh.faceSizes.assign(faceVertices.size() / 4, 4);
    return mesh;
}

class HexrefineModel : public Hexrefine {
protected:
    /// \p mesh as a file, and behind it the real mesh \p name where it is there.
    std::vector<Model> makeModels(Mesh const &mesh, int count, std::string const &name,
                                  int countOfReal) const {
        WriteMesh(mesh, getPath("torus.obj"));
        std::vector<Model> models = {{getPath("torus.obj"), count}};
        std::string const real = std::string(OPENSUBDIVHEX_MESHES_DIR) + "/" + name;
        if (std::filesystem::exists(real)) {
            models.push_back({real, countOfReal});
        }
        return models;
    }

    std::vector<Model> makeModelsWithCharts() const {
        return makeModels(makeTorusOfCharts(), 2 * kNumV, "spot.obj", 288);
    }

    /// Refines to out.obj and gives the statistics.
    Json refine(std::string const &arguments) const {
        Result const result = run(arguments + " --stats - -o " + getPath("out.obj"));
        EXPECT_EQ(result.status, 0) << result.error;
        return Json::parse(result.out);
    }

    /// Expects that the file that refine() wrote is a valid mesh, finite and of the sizes in
    /// \p json, with as many boundary edges.
    void expectValid(Json const &json) const {
        Json const last = json["levels"].back();
        Mesh const mesh = ReadMesh(getPath("out.obj"));
        EXPECT_EQ(mesh.GetNumVertices(), last["vertices"]);
        EXPECT_EQ(mesh.GetNumFaces(), last["faces"]);
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        FarExt::CallStatus status;
        auto const refiner =
            FarExt::TopologyRefinerFactory::Create(DescribeTopology(mesh), options, &status);
        ASSERT_TRUE(refiner) << status.GetErrorMessage();
        EXPECT_TRUE(refiner->GetLevel(0).Validate(&status)) << status.GetErrorMessage();
        EXPECT_EQ(refiner->GetLevel(0).GetNumBoundaryEdges(), last["boundaryEdges"]);
    }
};

/// The connected parts of the texture, by value: values of one face are connected.
std::vector<int> findCharts(Mesh const &mesh) {
    FVarChannel const &uvs = mesh.channels.at(0);
    std::vector<int> chart(std::size_t(uvs.GetNumValues()));
    std::iota(chart.begin(), chart.end(), 0);
    auto const find = [&](int value) {
        while (chart[value] != value) {
            value = chart[value] = chart[chart[value]];
        }
        return value;
    };
    int const *values = uvs.faceValues.data();
    for (int size : mesh.faceSizes) {
        for (int i = 1; i < size; ++i) {
            chart[find(values[i])] = find(values[0]);
        }
        values += size;
    }
    for (int value = 0; value < uvs.GetNumValues(); ++value) {
        chart[value] = find(value);
    }
    return chart;
}

/// Edges with different values to both sides.
int countSeams(Mesh const &mesh) {
    std::map<std::pair<int, int>, std::pair<int, int>> values; // of edges, by direction
    std::size_t first = 0;
    for (int size : mesh.faceSizes) {
        for (int i = 0; i < size; ++i) {
            std::size_t const corner = first + std::size_t(i);
            std::size_t const next = first + std::size_t((i + 1) % size);
            values[{mesh.faceVertices[corner], mesh.faceVertices[next]}] = {
                mesh.channels[0].faceValues[corner], mesh.channels[0].faceValues[next]};
        }
        first += std::size_t(size);
    }
    int numSeams = 0;
    for (auto const &[edge, value] : values) {
        if (edge.first < edge.second) {
            auto const other = values.at({edge.second, edge.first});
            numSeams += value != std::make_pair(other.second, other.first) ? 1 : 0;
        }
    }
    return numSeams;
}

/// Twice the area of all faces in the texture, those that are turned over counted as negative.
double computeTextureArea(Mesh const &mesh) {
    FVarChannel const &uvs = mesh.channels.at(0);
    double area = 0;
    int const *values = uvs.faceValues.data();
    for (int size : mesh.faceSizes) {
        for (int i = 0; i < size; ++i) {
            float const *a = &uvs.values[2 * std::size_t(values[i])];
            float const *b = &uvs.values[2 * std::size_t(values[(i + 1) % size])];
            area += double(a[0]) * double(b[1]) - double(a[1]) * double(b[0]);
        }
        values += size;
    }
    return area;
}

} // namespace

TEST_F(HexrefineModel, SeamsStayWhereTheyAre) {
    for (auto const &[path, numSeams] : makeModelsWithCharts()) {
        SCOPED_TRACE(path);
        Mesh const input = ReadMesh(path);
        ASSERT_EQ(countSeams(input), numSeams);
        Json const json = refine(path + " -l 3");
        Json const last = json["levels"][3];
        int const numEdges = input.GetNumFaces() / 2 * 3;
        EXPECT_EQ(last["vertices"], input.GetNumVertices() + 2 * numEdges * 21);
        EXPECT_EQ(last["faces"], input.GetNumFaces() + numEdges * 21);
        EXPECT_EQ(last["boundaryEdges"], 0);
        Mesh const mesh = ReadMesh(getPath("out.obj"));
        EXPECT_EQ(mesh.GetNumVertices(), last["vertices"]);
        expectClosed(mesh);
        // A seam crosses one hexagon of level 1 for each of its edges, and three of level 3.
        EXPECT_EQ(mesh.GetNumFaces(), last["faces"].get<int>() + 3 * numSeams);
        EXPECT_EQ(mesh.channels.at(0).GetNumValues(), json["fvarChannels"][0]["values"][3]);
        // Each chart keeps its outline.
        EXPECT_NEAR(computeTextureArea(mesh), computeTextureArea(input), 1e-4);
    }
}

TEST_F(HexrefineModel, ChartsAreUnmixed) {
    for (auto const &[path, numSeams] : makeModelsWithCharts()) {
        SCOPED_TRACE(path);
        Mesh mesh = ReadMesh(path);
        std::vector<int> const charts = findCharts(mesh);
        // Each chart shrinks to a point of a parabola: no mixture of two lies on it.
        std::map<int, int> numbers;
        for (int chart : charts) {
            numbers.emplace(chart, int(numbers.size()));
        }
        EXPECT_GT(numbers.size(), 1u);
        for (std::size_t value = 0; value < charts.size(); ++value) {
            auto const number = float(numbers.at(charts[value]));
            mesh.channels[0].values[2 * value] = number;
            mesh.channels[0].values[2 * value + 1] = number * number;
        }
        WriteMesh(mesh, getPath("charts.obj"));
        for (char const *rule : {"all", "boundaries", "corners-only", "none"}) {
            refine(getPath("charts.obj") + " -l 3 --fvar-interpolation " + rule);
            FVarChannel const uvs = ReadMesh(getPath("out.obj")).channels.at(0);
            for (int value : uvs.faceValues) {
                float const u = uvs.values[2 * std::size_t(value)];
                float const v = uvs.values[2 * std::size_t(value) + 1];
                ASSERT_NEAR(u, std::round(u), 1e-4) << rule;
                ASSERT_NEAR(v, std::round(u) * std::round(u), 1e-3) << rule;
            }
        }
    }
}

TEST_F(HexrefineModel, NormalsStayNormalsAlongBorders) {
    // A slit of two by one quads.
    Mesh torus = makeOpenTorus([](int u, int v) { return u < 2 && v == 0; });
    torus.channels.resize(1);
    FVarChannel &normals = torus.channels[0];
    normals.kind = FVarKind::Normal;
    normals.width = 3;
    normals.faceValues = torus.faceVertices;
    for (std::size_t i = 0; i < torus.positions.size(); i += 3) {
        float const *const p = &torus.positions[i];
        float const outward = 1 - float(Regression::kTorusRadius) / std::hypot(p[0], p[1]);
        normals.values.insert(normals.values.end(), {outward * p[0], outward * p[1], p[2]});
    }
    for (auto const &[path, numBoundaryEdges] : makeModels(torus, 6, "suzanne.obj", 42)) {
        SCOPED_TRACE(path);
        Json const json = refine(path + " --boundary edge-and-corner -l 4");
        EXPECT_EQ(json["boundary"], "edge-and-corner");
        EXPECT_EQ(json["levels"][0]["boundaryEdges"], numBoundaryEdges);
        EXPECT_EQ(json["fvarChannels"][0]["name"], "normal");
        expectValid(json);
        // Without seams the normals go with the vertices.
        Mesh const mesh = ReadMesh(getPath("out.obj"));
        ASSERT_EQ(mesh.channels.size(), 1u);
        EXPECT_EQ(mesh.channels[0].faceValues, mesh.faceVertices);
        for (std::size_t i = 0; i < mesh.channels[0].values.size(); i += 3) {
            float const *n = &mesh.channels[0].values[i];
            ASSERT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-5);
        }
    }
}

TEST_F(HexrefineModel, VerticesMayJoinFans) {
    // Pairs of quads that meet in a corner alone: the other two there do, too.
    Mesh const torus = makeOpenTorus(
        [](int u, int v) { return (u % 4 == 0 && v == 0) || (u % 4 == 1 && v == 1); });
    for (auto const &[path, numJoining] : makeModels(torus, kNumU / 4, "teapot.obj", 38)) {
        SCOPED_TRACE(path);
        Mesh const input = ReadMesh(path);
        auto const refiner = FarExt::TopologyRefinerFactory::Create(DescribeTopology(input));
        ASSERT_TRUE(refiner);
        int numNonManifold = 0;
        for (int vertex = 0; vertex < input.GetNumVertices(); ++vertex) {
            numNonManifold += refiner->GetLevel(0).IsVertexNonManifold(vertex) ? 1 : 0;
        }
        EXPECT_EQ(numNonManifold, numJoining);
        for (char const *boundary : {"none", "edge-only", "edge-and-corner"}) {
            SCOPED_TRACE(boundary);
            Json const json = refine(path + " -l 2 --boundary " + std::string(boundary));
            EXPECT_EQ(json["levels"][0]["faces"], input.GetNumFaces());
            expectValid(json);
        }
        Json const json = refine(path + " -l 3 --crease-angle 40");
        EXPECT_GT(json["creases"], 0);
        expectValid(json);
    }
}

} // namespace OpenSubdivHex::Tools::modelTest

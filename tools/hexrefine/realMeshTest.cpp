// SPDX-License-Identifier: Apache-2.0
//
// The meshes of OPENSUBDIVHEX_MESHES_DIR through hexrefine.
#include "programFixture.h"

#include <map>
#include <numeric>

namespace OpenSubdivHex::Tools::realMeshTest {

namespace {

class HexrefineRealMesh : public Hexrefine {
protected:
    void SetUp() override {
        if (std::string(OPENSUBDIVHEX_MESHES_DIR).empty()) {
            GTEST_SKIP() << "OPENSUBDIVHEX_MESHES_DIR is not set";
        }
    }

    static std::string getMesh(std::string const &name) {
        return std::string(OPENSUBDIVHEX_MESHES_DIR) + "/" + name;
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

TEST_F(HexrefineRealMesh, Spot) {
    Mesh const input = ReadMesh(getMesh("spot.obj"));
    ASSERT_EQ(input.channels.at(0).GetNumValues(), 3225);
    Json const json = refine(getMesh("spot.obj") + " -l 3");
    Json const last = json["levels"][3];
    EXPECT_EQ(last["vertices"], 2930 + 2 * 8784 * 21);
    EXPECT_EQ(last["faces"], 5856 + 8784 * 21);
    EXPECT_EQ(last["boundaryEdges"], 0);
    Mesh const mesh = ReadMesh(getPath("out.obj"));
    EXPECT_EQ(mesh.GetNumVertices(), 371858);
    expectClosed(mesh);
    // A seam crosses one hexagon of level 1 for each of its edges, and three of level 3.
    EXPECT_EQ(mesh.GetNumFaces(), 190320 + 3 * countSeams(input));
    EXPECT_GT(countSeams(input), 200);
    EXPECT_EQ(mesh.channels.at(0).GetNumValues(), json["fvarChannels"][0]["values"][3]);
    // Seams stay where they are, so that each chart keeps its outline.
    EXPECT_NEAR(computeTextureArea(mesh), computeTextureArea(input), 1e-4);
}

TEST_F(HexrefineRealMesh, SpotChartsAreUnmixed) {
    Mesh mesh = ReadMesh(getMesh("spot.obj"));
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

TEST_F(HexrefineRealMesh, Suzanne) {
    Json const json = refine(getMesh("suzanne.obj") + " --boundary edge-and-corner -l 4");
    EXPECT_EQ(json["boundary"], "edge-and-corner");
    EXPECT_EQ(json["levels"][0]["boundaryEdges"], 42);
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

TEST_F(HexrefineRealMesh, Teapot) {
    // 38 vertices join two fans of faces each.
    for (char const *boundary : {"none", "edge-only", "edge-and-corner"}) {
        SCOPED_TRACE(boundary);
        Json const json =
            refine(getMesh("teapot.obj") + " -l 2 --boundary " + std::string(boundary));
        EXPECT_EQ(json["levels"][0]["faces"], 6320);
        expectValid(json);
    }
    Json const json = refine(getMesh("teapot.obj") + " -l 3 --crease-angle 40");
    EXPECT_GT(json["creases"], 0);
    expectValid(json);
}

} // namespace OpenSubdivHex::Tools::realMeshTest

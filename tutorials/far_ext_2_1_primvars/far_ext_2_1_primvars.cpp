// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     Primvar data of any kind, refined level by level without tables.
//
//     The program's own types take part in the refinement when they have Clear() and
//     AddWithWeight(), as with Far::PrimvarRefiner.  Positions follow the masks of the scheme
//     (Interpolate), colours are interpolated linearly (InterpolateVarying), and materials, which
//     cannot be averaged, are handed from face to face (InterpolateFaceUniform).
//
#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace OpenSubdivHex;

namespace {

struct Point {
    void Clear() { x = y = z = 0; }
    void AddWithWeight(Point const &source, float weight) {
        x += weight * source.x;
        y += weight * source.y;
        z += weight * source.z;
    }
    float x, y, z;
};

struct Color {
    void Clear() { red = 0; }
    void AddWithWeight(Color const &source, float weight) { red += weight * source.red; }
    float red;
};

// The data of one level.
struct LevelData {
    std::vector<Point> points;  // by vertex
    std::vector<Color> colors;  // by vertex
    std::vector<int> materials; // by face
};

} // namespace

int main() {
    Tools::Mesh const cube = Tools::MakeCube();
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube));
    if (!refiner || !refiner->RefineUniform(4)) {
        return 1;
    }

    std::vector<LevelData> data(refiner->GetNumLevels());
    for (int v = 0; v < cube.GetNumVertices(); ++v) {
        float const *position = &cube.positions[3 * std::size_t(v)];
        data[0].points.push_back({position[0], position[1], position[2]});
        data[0].colors.push_back({v % 2 == 0 ? 0.0f : 1.0f});
    }
    data[0].materials = {0, 1, 2, 3, 4, 5};

    FarExt::PrimvarRefiner const primvarRefiner(*refiner);
    for (int i = 1; i < refiner->GetNumLevels(); ++i) {
        data[i].points.resize(refiner->GetLevel(i).GetNumVertices());
        data[i].colors.resize(refiner->GetLevel(i).GetNumVertices());
        data[i].materials.resize(refiner->GetLevel(i).GetNumFaces());
        primvarRefiner.Interpolate(i, data[i - 1].points, data[i].points);
        primvarRefiner.InterpolateVarying(i, data[i - 1].colors, data[i].colors);
        primvarRefiner.InterpolateFaceUniform(i, data[i - 1].materials, data[i].materials);
    }

    // The cube shrinks to a rounded body, linear data keeps its values at the old vertices, and
    // every face knows its material.
    FarExt::TopologyLevel const &last = refiner->GetLevel(refiner->GetMaxLevel());
    LevelData const &result = data[refiner->GetMaxLevel()];
    float radius = 0;
    for (Point const &point : result.points) {
        radius = std::max(radius, std::hypot(point.x, point.y, point.z));
    }
    int numFacesOfMaterial5 = 0;
    bool isRight = radius < std::sqrt(3.0f);
    for (int face = 0; face < last.GetNumFaces(); ++face) {
        numFacesOfMaterial5 += result.materials[face] == 5;
        isRight = isRight && result.materials[face] == last.GetFaceBaseFace(face);
    }
    for (int v = 0; v < cube.GetNumVertices(); ++v) {
        isRight = isRight && result.colors[v].red == data[0].colors[v].red;
    }
    std::printf("level %d: %zu points within a sphere of radius %.4f, %d faces of material 5\n",
                refiner->GetMaxLevel(), result.points.size(), radius, numFacesOfMaterial5);
    return isRight ? 0 : 1;
}

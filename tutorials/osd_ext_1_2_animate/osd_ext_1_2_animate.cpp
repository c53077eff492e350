// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     One table, many frames.
//
//     An animation moves the control vertices and keeps the topology, so refiner and table are
//     made once, before the first frame.  Each frame writes its control positions to the front of
//     one buffer and evaluates the table in place: the refined vertices stand right behind them,
//     ready to be drawn through one index buffer, which does not change either.
//
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/polygonIndices.h"
#include "osd_ext/stencilEvaluator.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace OpenSubdivHex;

namespace {

constexpr int kNumFrames = 24;

// The control mesh of a frame: the cube, stretched along z and flattened to keep its volume.
std::vector<float> deform(std::vector<float> const &positions, int frame) {
    float const stretch = 1 + 0.5f * std::sin(6.2831853f * float(frame) / kNumFrames);
    std::vector<float> deformed = positions;
    for (std::size_t i = 0; i < deformed.size(); i += 3) {
        deformed[i] /= std::sqrt(stretch);
        deformed[i + 1] /= std::sqrt(stretch);
        deformed[i + 2] *= stretch;
    }
    return deformed;
}

// Six times the volume inside the triangles.
double sumVolumes(OsdExt::TriangleIndices const &triangles, float const *positions) {
    double sum = 0;
    for (std::size_t i = 0; i < triangles.vertices.size(); i += 3) {
        float const *a = positions + std::size_t(3) * triangles.vertices[i];
        float const *b = positions + std::size_t(3) * triangles.vertices[i + 1];
        float const *c = positions + std::size_t(3) * triangles.vertices[i + 2];
        sum += double(a[0]) * (b[1] * c[2] - b[2] * c[1]) +
               double(a[1]) * (b[2] * c[0] - b[0] * c[2]) +
               double(a[2]) * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum;
}

} // namespace

int main() {
    // Once: topology, table, buffers.
    Tools::Mesh const cube = Tools::MakeCube();
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube));
    if (!refiner || !refiner->RefineUniform(4)) {
        return 1;
    }
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    auto const table = FarExt::StencilTableFactory::Create(*refiner, options);
    if (!table) {
        return 1;
    }
    auto const buffer = OsdExt::CreateInPlaceBuffer<Osd::CpuVertexBuffer>(*table, 3);
    OsdExt::TriangleIndices const triangles = OsdExt::CreateTriangleIndices(
        refiner->GetLevel(refiner->GetMaxLevel()), {table->GetNumControlVertices()});
    std::printf("%d control vertices, %d refined vertices, %d triangles\n",
                table->GetNumControlVertices(), table->GetNumStencils(),
                triangles.GetNumTriangles());

    // Each frame: new control positions, the same table.
    double smallest = 1e30;
    double largest = 0;
    for (int frame = 0; frame < kNumFrames; ++frame) {
        std::vector<float> const positions = deform(cube.positions, frame);
        buffer->UpdateData(positions.data(), 0, cube.GetNumVertices());
        if (!OsdExt::EvalStencilsInPlace<Osd::CpuEvaluator>(*table, buffer.get())) {
            return 1;
        }
        double const volume = sumVolumes(triangles, buffer->BindCpuBuffer()) / 6;
        smallest = std::min(smallest, volume);
        largest = std::max(largest, volume);
    }

    // Refinement commutes with affine maps.  These keep the volume, so all frames have the same.
    std::printf("%d frames, volume between %.3f and %.3f\n", kNumFrames, smallest, largest);
    return smallest > 0 && largest - smallest < 1e-4 * largest ? 0 : 1;
}

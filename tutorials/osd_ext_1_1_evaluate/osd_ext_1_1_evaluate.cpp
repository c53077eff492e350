// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     An existing OpenSubdiv program, changed to the hexagonal scheme.
//
//     The program was written for Catmull-Clark: a Far::TopologyRefiner from the application's
//     mesh, a Far::StencilTable, Osd buffers and an Osd evaluator.  Three lines changed, each
//     marked with what was there before:
//
//         1. the refiner is made from the Far::TopologyRefiner that was there,
//         2. the options of the table
//         3. and the table come from FarExt.
//
//     Refinement, buffers and evaluation stay as they are.
//
#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/point.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <algorithm>
#include <cstdio>

using namespace OpenSubdiv;
namespace FarExt = OpenSubdivHex::FarExt;
namespace Tools = OpenSubdivHex::Tools;
using Tools::Mesh;
using Tools::Point;

namespace {

constexpr int kLevel = 3;

// The application's mesh, however its Far::TopologyRefiner is made.
std::unique_ptr<Far::TopologyRefiner> createBase(Mesh const &mesh) {
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    return std::unique_ptr<Far::TopologyRefiner>(Factory::Create(
        Tools::DescribeTopology(mesh), Factory::Options(Sdc::SCHEME_CATMARK, Sdc::Options())));
}

std::unique_ptr<Osd::CpuVertexBuffer> evaluate(Mesh const &mesh) {
    // 1. was: auto const refiner = createBase(mesh);
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*createBase(mesh));

    refiner->RefineUniform(kLevel);

    // 2. was: Far::StencilTableFactory::Options options;
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;

    std::unique_ptr<Far::StencilTable const> const table(
        // 3. was: Far::StencilTableFactory::Create(*refiner, options));
        FarExt::StencilTableFactory::Create(*refiner, options));

    int const numControlVertices = table->GetNumControlVertices();
    int const numRefinedVertices = table->GetNumStencils();
    using Buffer = std::unique_ptr<Osd::CpuVertexBuffer>;
    Buffer const source(Osd::CpuVertexBuffer::Create(3, numControlVertices));
    source->UpdateData(mesh.positions.data(), 0, numControlVertices);
    Buffer result(Osd::CpuVertexBuffer::Create(3, numRefinedVertices));

    Osd::BufferDescriptor const description(0, 3, 3);
    Osd::CpuEvaluator::EvalStencils(source.get(), description, result.get(), description,
                                    table.get());
    return result;
}

// Refines without table and evaluator, to compare with: see far_ext_2_1_primvars.
std::vector<Point> refineLevelByLevel(Mesh const &mesh) {
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*createBase(mesh));
    refiner->RefineUniform(kLevel);
    std::vector<Point> points = Tools::CopyPoints(mesh);
    for (int level = 1; level <= kLevel; ++level) {
        std::vector<Point> const parents = points;
        points.resize(refiner->GetLevel(level).GetNumVertices());
        FarExt::PrimvarRefiner(*refiner).Interpolate(level, parents, points);
    }
    return points;
}

} // namespace

int main() {
    Mesh const cube = Tools::MakeCube();
    std::unique_ptr<Osd::CpuVertexBuffer> const result = evaluate(cube);
    std::vector<Point> const points = refineLevelByLevel(cube);

    if (result->GetNumVertices() != int(points.size())) {
        return 1;
    }

    float difference = 0;
    float const *position = result->BindCpuBuffer();
    for (Point const &point : points) {
        Point const evaluated = {position[0], position[1], position[2]};
        difference = std::max(difference, Tools::ComputeDistance(evaluated, point));
        position += 3;
    }
    std::printf("evaluated %d vertices, largest difference from level by level refinement: %g\n",
                result->GetNumVertices(), double(difference));
    return difference < 1e-5f ? 0 : 1;
}

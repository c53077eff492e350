// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     A stencil table: every refined vertex as a weighted sum of control vertices.
//
//     The table is a Far::StencilTable, so whatever takes one takes this one.  It depends on
//     topology alone: built once, it refines any positions of the control vertices, here with
//     Far's own UpdateValues().  The result equals that of the PrimvarRefiner (see
//     far_ext_2_1_primvars), which goes through all levels for every new set of positions.
//
#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/point.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace OpenSubdivHex;
using Tools::Point;

int main() {
    Tools::Mesh const cube = Tools::MakeCube();
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube));
    if (!refiner || !refiner->RefineUniform(3)) {
        return 1;
    }

    // One stencil per vertex of the last level; by default there would be those of all levels.
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    std::unique_ptr<Far::StencilTable const> const table =
        FarExt::StencilTableFactory::Create(*refiner, options);
    if (!table) {
        return 1;
    }
    std::printf("%d stencils, %zu weights\n", table->GetNumStencils(), table->GetWeights().size());

    // The first stencil: the corner of the cube, pulled inward by its neighbours.
    Far::Stencil const stencil = table->GetStencil(0);
    float sum = 0;
    for (int i = 0; i < stencil.GetSize(); ++i) {
        std::printf("  control vertex %d with weight %.4f\n", stencil.GetVertexIndices()[i],
                    stencil.GetWeights()[i]);
        sum += stencil.GetWeights()[i];
    }

    // Evaluate the table, and compare with refinement level by level.
    std::vector<std::vector<Point>> levels(refiner->GetNumLevels());
    levels[0] = Tools::CopyPoints(cube);
    std::vector<Point> points(table->GetNumStencils());
    table->UpdateValues(levels[0].data(), points.data());

    FarExt::PrimvarRefiner const primvarRefiner(*refiner);
    for (int i = 1; i < refiner->GetNumLevels(); ++i) {
        levels[i].resize(refiner->GetLevel(i).GetNumVertices());
        primvarRefiner.Interpolate(i, levels[i - 1], levels[i]);
    }
    float difference = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        difference = std::max(difference, Tools::ComputeDistance(points[i], levels.back()[i]));
    }
    std::printf("largest difference from level by level refinement: %g\n", double(difference));
    return points.size() == levels.back().size() && difference < 1e-5f && std::fabs(sum - 1) < 1e-5f
               ? 0
               : 1;
}

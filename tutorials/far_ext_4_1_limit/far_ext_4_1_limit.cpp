// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     Limit stencils: points of the smooth surface itself, and its normals.
//
//     A refined mesh lies near the surface that more and more refinement tends to.  A limit stencil
//     table gives points of that surface, one for each vertex and each face of a level, and the two
//     derivatives there, whose cross product is the normal.  It is a Far::LimitStencilTable, which
//     Osd's evaluators take.
//
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <cmath>
#include <cstdio>
#include <memory>

using namespace OpenSubdivHex;
namespace Osd = OpenSubdiv::Osd;

int main() {
    Tools::Mesh const cube = Tools::MakeCube();
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube));
    // Limits need the neighborhoods of vertices: the last level needs its full topology, too.
    FarExt::TopologyRefiner::UniformOptions refineOptions(1);
    refineOptions.fullTopologyInLastLevel = true;
    if (!refiner || !refiner->RefineUniform(refineOptions)) {
        return 1;
    }

    FarExt::LimitStencilTableFactory::Options options;
    options.level = 1;
    options.generateFaceCenters = true; // behind the vertices
    std::unique_ptr<Far::LimitStencilTable const> const table =
        FarExt::LimitStencilTableFactory::Create(*refiner, options);
    if (!table) {
        return 1;
    }
    int const numPoints = table->GetNumStencils();

    std::unique_ptr<Osd::CpuVertexBuffer> const control(
        Osd::CpuVertexBuffer::Create(3, cube.GetNumVertices()));
    control->UpdateData(cube.positions.data(), 0, cube.GetNumVertices());
    std::unique_ptr<Osd::CpuVertexBuffer> const points(Osd::CpuVertexBuffer::Create(3, numPoints));
    std::unique_ptr<Osd::CpuVertexBuffer> const du(Osd::CpuVertexBuffer::Create(3, numPoints));
    std::unique_ptr<Osd::CpuVertexBuffer> const dv(Osd::CpuVertexBuffer::Create(3, numPoints));
    Osd::BufferDescriptor const desc(0, 3, 3);
    Osd::CpuEvaluator::EvalStencils(control.get(), desc, points.get(), desc, du.get(), desc,
                                    dv.get(), desc, table.get());

    // The normals of this surface point away from its centre, the origin.
    int numOutward = 0;
    for (int i = 0; i < numPoints; ++i) {
        float const *p = points->BindCpuBuffer() + 3 * i;
        float const *u = du->BindCpuBuffer() + 3 * i;
        float const *v = dv->BindCpuBuffer() + 3 * i;
        float const normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                 u[0] * v[1] - u[1] * v[0]};
        float const length = std::hypot(normal[0], normal[1], normal[2]);
        numOutward += p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2] > 0;
        if (i == 0) {
            std::printf("vertex 0: %.4f %.4f %.4f, normal %.4f %.4f %.4f\n", double(p[0]),
                        double(p[1]), double(p[2]), double(normal[0] / length),
                        double(normal[1] / length), double(normal[2] / length));
        }
    }
    std::printf("%d points of the surface, %d normals point outward\n", numPoints, numOutward);
    return numOutward == numPoints ? 0 : 1;
}

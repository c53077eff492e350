// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     Patches: a Far::PatchTable of the hexagonal surface, for programs that evaluate patches.
//
//     FarExt::PatchTableFactory makes a genuine Far::PatchTable.  From there on the program is one for
//     OpenSubdiv: the table's stencils make the points of patches, Osd::CpuPatchTable takes the table, and
//     EvalPatches gives points and derivatives at any places, here at hairs that are strewn over the
//     surface.  Two things are of this library: FarExt::PatchMap finds the patch of a place in a face of the
//     mesh, and OsdExt::CpuEvaluator evaluates faster than Osd::CpuEvaluator.
//
#include "far_ext/patchTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <vector>

using namespace OpenSubdivHex;
namespace Osd = OpenSubdiv::Osd;

namespace {

// An argument of EvalPatches: a buffer of places.
struct CoordBuffer {
    Osd::PatchCoord *BindCpuBuffer() { return coords.data(); }
    std::vector<Osd::PatchCoord> coords;
};

} // namespace

int main() {
    Tools::Mesh const cube = Tools::MakeCube();
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask =
        FarExt::FaceMask::Smooth; // patches are closest to this surface
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube),
                                                                Sdc::Options(), options);
    // The faces of level 2 become patches.
    FarExt::PatchTableFactory::Options const patchOptions(2);
    if (!refiner || !refiner->RefineUniform(patchOptions.GetRefineUniformOptions())) {
        return 1;
    }
    std::unique_ptr<Far::PatchTable const> const table =
        FarExt::PatchTableFactory::Create(*refiner, patchOptions);
    if (!table) {
        return 1;
    }
    std::printf("%d patches with %d points\n", table->GetNumPatchesTotal(),
                table->GetNumLocalPoints());

    // One buffer: the control vertices, and behind them the points of patches.  Only these two lines are run
    // again when the mesh moves.
    int const numControl = cube.GetNumVertices();
    std::unique_ptr<Osd::CpuVertexBuffer> const points(
        Osd::CpuVertexBuffer::Create(3, numControl + table->GetNumLocalPoints()));
    Osd::BufferDescriptor const desc(0, 3, 3);
    Osd::BufferDescriptor const local(3 * numControl, 3, 3);
    points->UpdateData(cube.positions.data(), 0, numControl);
    OsdExt::CpuEvaluator::EvalStencils(points.get(), desc, points.get(), local,
                                       table->GetLocalPointStencilTable());

    // Hairs at random places of random faces; sorted by patch, they are evaluated fastest.
    FarExt::PatchMap const map(*refiner, patchOptions);
    std::mt19937 random(1);
    std::uniform_int_distribution<int> face(0, map.GetNumFaces() - 1);
    std::uniform_real_distribution<double> coordinate(0, 1);
    CoordBuffer hairs;
    for (int i = 0; i < 10000; ++i) {
        int const ofFace = face(random);
        double const u = coordinate(random);
        double const v = coordinate(random);
        FarExt::PatchMap::Place const place = map.FindPlace(ofFace, u, v);
        hairs.coords.emplace_back(FarExt::PatchMap::GetHandle(place.patch), float(place.s),
                                  float(place.t));
    }
    std::sort(hairs.coords.begin(), hairs.coords.end(),
              [](Osd::PatchCoord const &a, Osd::PatchCoord const &b) {
                  return a.handle.patchIndex < b.handle.patchIndex;
              });

    // Points and derivatives, by OpenSubdiv's evaluator and by this one.
    int const numHairs = int(hairs.coords.size());
    std::unique_ptr<Osd::CpuPatchTable> const cpuTable(Osd::CpuPatchTable::Create(table.get()));
    std::unique_ptr<Osd::CpuVertexBuffer> results[2][3];
    for (auto &ofEvaluator : results) {
        for (auto &buffer : ofEvaluator) {
            buffer.reset(Osd::CpuVertexBuffer::Create(3, numHairs));
        }
    }
    Osd::CpuEvaluator::EvalPatches(points.get(), desc, results[0][0].get(), desc,
                                   results[0][1].get(), desc, results[0][2].get(), desc, numHairs,
                                   &hairs, cpuTable.get());
    OsdExt::CpuEvaluator::EvalPatches(points.get(), desc, results[1][0].get(), desc,
                                      results[1][1].get(), desc, results[1][2].get(), desc,
                                      numHairs, &hairs, cpuTable.get());

    // The normals of this surface point away from its centre, the origin.
    double difference = 0;
    int numOutward = 0;
    for (int i = 0; i < numHairs; ++i) {
        float const *const p = results[1][0]->BindCpuBuffer() + 3 * i;
        float const *const u = results[1][1]->BindCpuBuffer() + 3 * i;
        float const *const v = results[1][2]->BindCpuBuffer() + 3 * i;
        float const *const q = results[0][0]->BindCpuBuffer() + 3 * i;
        float const normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                 u[0] * v[1] - u[1] * v[0]};
        numOutward += p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2] > 0;
        for (int k = 0; k < 3; ++k) {
            difference = std::max(difference, double(std::abs(p[k] - q[k])));
        }
    }
    std::printf("%d hairs, %d normals point outward; both evaluators agree to %.0e\n", numHairs,
                numOutward, difference);
    return numOutward == numHairs && difference < 1e-5 ? 0 : 1;
}

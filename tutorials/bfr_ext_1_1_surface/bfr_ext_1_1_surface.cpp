// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     Surfaces: the smooth surface of each face of the control mesh, without refinement.
//
//     A surface is a function of u and v.  It depends on a few control points around its face, which
//     are gathered once; then points and first derivatives can be had anywhere in the face.  Who knows
//     Bfr::Surface finds its functions here.
//
#include "bfr_ext/surfaceFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <cstdio>
#include <vector>

using namespace OpenSubdivHex;

int main() {
    Tools::Mesh const cube = Tools::MakeCube();
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask = FarExt::FaceMask::Smooth;
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube),
                                                                Sdc::Options(), options);
    if (!refiner) {
        return 1;
    }
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    if (!factory) {
        return 1;
    }

    int numSurfaces = 0;
    int numOutward = 0;
    BfrExt::Surface<float> surface;
    std::vector<float> patchPoints;
    for (int face = 0; face < factory->GetNumFaces(); ++face) {
        // A face that is a hole has none.
        if (!factory->InitVertexSurface(face, &surface)) {
            continue;
        }
        ++numSurfaces;
        patchPoints.resize(3 * std::size_t(surface.GetNumPatchPoints()));
        surface.PreparePatchPoints(cube.positions.data(), 3, patchPoints.data(), 3);

        // The face is the unit square in the plane of u and v.
        for (int i = 0; i < 9; ++i) {
            float const uv[2] = {0.5F * float(i % 3), 0.5F * float(i / 3)};
            float p[3], du[3], dv[3];
            surface.Evaluate(uv, patchPoints.data(), 3, p, du, dv);
            float const normal[3] = {du[1] * dv[2] - du[2] * dv[1], du[2] * dv[0] - du[0] * dv[2],
                                     du[0] * dv[1] - du[1] * dv[0]};
            // The normals of this surface point away from its centre, the origin.
            numOutward += p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2] > 0;
            if (face == 0) {
                std::printf("%.1f %.1f: %.4f %.4f %.4f\n", double(uv[0]), double(uv[1]),
                            double(p[0]), double(p[1]), double(p[2]));
            }
        }
    }
    std::printf("%d surfaces, %d normals point outward\n", numSurfaces, numOutward);
    return numSurfaces == cube.GetNumFaces() && numOutward == 9 * numSurfaces ? 0 : 1;
}

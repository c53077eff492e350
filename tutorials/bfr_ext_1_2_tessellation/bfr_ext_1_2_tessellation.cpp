// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     LevelTessellation: each face as fine as it needs to be, and no gaps between them.
//
//     A tessellation has a level for the inside of a face and one for each edge.  Whoever gives an
//     edge the same level in both of its faces gets the same points there, to the bit.  So the facets
//     of all faces, made one by one and in any order, are a closed mesh.
//
#include "bfr_ext/surfaceFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <utility>
#include <vector>

using namespace OpenSubdivHex;

int main() {
    Tools::Mesh const cube = Tools::MakeCube();
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube));
    if (!refiner) {
        return 1;
    }
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    if (!factory) {
        return 1;
    }
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);

    // A level for each face, by whatever tells how fine it is to be.  An edge has that of the finer of
    // its faces.
    int const faceLevels[] = {0, 1, 2, 3, 4, 5};
    BfrExt::LevelTessellation::Options options;
    options.SetFacetSize(3);

    // The same points have the same number.
    std::map<std::array<float, 3>, int> numbers;
    std::set<std::pair<int, int>> sides;
    int numFacets = 0;
    BfrExt::Surface<float> surface;
    std::vector<float> controlPoints;
    std::vector<std::array<float, 3>> points;
    std::vector<int> facets;
    for (int face = 0; face < factory->GetNumFaces(); ++face) {
        if (!factory->InitVertexSurface(face, &surface)) {
            return 1;
        }
        controlPoints.resize(3 * std::size_t(surface.GetNumControlPoints()));
        surface.GatherControlPoints(cube.positions.data(), 3, controlPoints.data(), 3);

        std::vector<int> levels;
        for (int const edge : base.GetFaceEdges(face)) {
            int level = 0;
            for (int const edgeFace : base.GetEdgeFaces(edge)) {
                level = std::max(level, faceLevels[edgeFace]);
            }
            levels.push_back(level);
        }
        levels.push_back(faceLevels[face]);
        BfrExt::LevelTessellation const tessellation(surface.GetParameterization(),
                                                     int(levels.size()), levels.data(), options);

        points.resize(std::size_t(tessellation.GetNumCoords()));
        surface.Evaluate(tessellation, controlPoints.data(), 3, points[0].data(), 3);
        facets.resize(3 * std::size_t(tessellation.GetNumFacets()));
        tessellation.GetFacets(facets.data());
        std::printf("face %d: %d points, %d triangles\n", face, tessellation.GetNumCoords(),
                    tessellation.GetNumFacets());

        numFacets += tessellation.GetNumFacets();
        for (int &index : facets) {
            std::array<float, 3> const &point = points[std::size_t(index)];
            index = numbers.emplace(point, int(numbers.size())).first->second;
        }
        for (std::size_t i = 0; i < facets.size(); i += 3) {
            for (std::size_t k = 0; k < 3; ++k) {
                sides.insert({facets[i + k], facets[i + (k + 1) % 3]});
            }
        }
    }

    // In a closed mesh every side of a triangle has another that runs the other way.
    bool isClosed = int(sides.size()) == 3 * numFacets;
    for (auto const &[start, end] : sides) {
        isClosed = isClosed && sides.count({end, start}) == 1;
    }
    std::printf("%d points, %d triangles, %s\n", int(numbers.size()), numFacets,
                isClosed ? "closed" : "with gaps");
    return isClosed ? 0 : 1;
}

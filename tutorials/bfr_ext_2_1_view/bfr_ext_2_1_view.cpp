// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     View: only what a camera needs.
//
//     A view refines each part of a mesh until its facets are closer to the surface than some pixels,
//     and leaves coarse what is outside of the picture.  The camera flies towards the mesh; given the
//     trees of the frame before, what was refined stays so until it is clearly too fine, and nothing
//     flickers.  In every frame the mesh is closed.
//
#include "bfr_ext/view.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <cstdio>
#include <optional>
#include <set>
#include <utility>
#include <vector>

using namespace OpenSubdivHex;

// Numbers all points of a forest: first those that faces share, which the forest has numbers for, then
// those inside of each face.  Gives the sides of all polygons.
static std::set<std::pair<int, int>> collectSides(BfrExt::CellForest const &forest,
                                                  int *numPolygons, bool *isManifold) {
    std::set<std::pair<int, int>> sides;
    int numPoints = int(forest.GetNumBoundaryPoints());
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        BfrExt::LevelTessellation::Options options;
        options.SetFacetSize(0); // polygons
        BfrExt::LevelTessellation const tessellation = forest.GetTessellation(face, options);

        std::vector<int> boundary(std::size_t(tessellation.GetNumBoundaryCoords()));
        forest.GetBoundaryPoints(face, boundary.data());
        std::vector<int> facets(std::size_t(tessellation.GetNumFacetVertices()));
        tessellation.GetFacets(facets.data());
        tessellation.TransformFacetCoordIndices(facets.data(), boundary.data(),
                                                numPoints - int(boundary.size()));
        numPoints += tessellation.GetNumInteriorCoords();

        std::vector<int> sizes(std::size_t(tessellation.GetNumFacets()));
        tessellation.GetFacetSizes(sizes.data());
        int const *facet = facets.data();
        for (int const size : sizes) {
            for (int i = 0; i < size; ++i) {
                *isManifold = sides.insert({facet[i], facet[(i + 1) % size]}).second && *isManifold;
            }
            facet += size;
        }
        *numPolygons += int(sizes.size());
    }
    return sides;
}

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

    // Faces may be half a pixel away from the surface.
    BfrExt::View::Options viewOptions;
    viewOptions.SetFlatness(0.5).SetCulling(true).SetMaxLevel(9);
    // Bounds do not depend on the camera: the first frame that needs one finds it.
    BfrExt::ViewBounds bounds(*factory);
    std::optional<BfrExt::CellForest> last;
    bool areClosed = true;
    for (int frame = 0; frame < 4; ++frame) {
        BfrExt::Camera camera;
        camera.eye[0] = 1;
        camera.eye[1] = 2;
        camera.eye[2] = 6 - 1.2 * frame;
        camera.target[0] = 0.8;
        camera.target[1] = 0.5;
        BfrExt::View const view(camera, viewOptions);
        BfrExt::View::Counts counts;
        BfrExt::CellForest forest =
            view.MakeForest(bounds, cube.positions.data(), 3, last ? &*last : nullptr, &counts);

        int numPolygons = 0;
        bool isClosed = true;
        std::set<std::pair<int, int>> const sides = collectSides(forest, &numPolygons, &isClosed);
        for (auto const &[start, end] : sides) {
            isClosed = isClosed && sides.count({end, start}) == 1;
        }
        areClosed = areClosed && isClosed;
        std::printf("frame %d: %d polygons, %ld cells outside of the picture, by level", frame,
                    numPolygons, counts.outside);
        for (long const count : counts.cellsByLevel) {
            std::printf(" %ld", count);
        }
        std::printf("\n");
        last = std::move(forest);
    }
    std::printf("%s\n", areClosed ? "closed in every frame" : "with gaps");
    return areClosed ? 0 : 1;
}

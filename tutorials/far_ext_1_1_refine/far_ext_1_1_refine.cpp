// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     From a base mesh, described as for any OpenSubdiv scheme, to the levels of its hexagonal
//     refinement.
//
//     Each step keeps every face as a smaller copy of itself (the F-face) and makes a hexagon of
//     every edge (the E-face).  A level answers the questions of Far::TopologyLevel; faces also
//     tell what they were made from.
//
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/shapes.h"

#include <cstdio>

using namespace OpenSubdivHex;

namespace {

// The base mesh as OpenSubdiv programs describe it.
std::unique_ptr<FarExt::TopologyRefiner> createRefiner(Tools::Mesh const &mesh) {
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = mesh.GetNumVertices();
    descriptor.numFaces = mesh.GetNumFaces();
    descriptor.numVertsPerFace = mesh.faceSizes.data();
    descriptor.vertIndicesPerFace = mesh.faceVertices.data();

    FarExt::CallStatus status;
    auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor, Sdc::Options(), &status);
    if (!refiner) {
        std::fprintf(stderr, "%s\n", status.GetErrorMessage().c_str());
    }
    return refiner;
}

// Walks over the edges of a level and asks what its faces were made from: on a closed mesh each edge
// of an F-face lies between that F-face and a hexagon.
bool areFacesSeparatedByHexagons(FarExt::TopologyLevel const &level) {
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        if (level.GetFaceKind(face) != FarExt::FaceKind::Face) {
            continue;
        }
        for (int edge : level.GetFaceEdges(face)) {
            Far::ConstIndexArray const sides = level.GetEdgeFaces(edge);
            int const neighbour = sides[0] == face ? sides[1] : sides[0];
            if (level.GetFaceKind(neighbour) != FarExt::FaceKind::Edge ||
                level.GetFaceVertices(neighbour).size() != 6) {
                return false;
            }
        }
    }
    return true;
}

} // namespace

int main() {
    std::unique_ptr<FarExt::TopologyRefiner> const refiner = createRefiner(Tools::MakeCube());
    if (!refiner) {
        return 1;
    }

    // Without fullTopologyInLastLevel the last level holds the vertices of its faces and nothing
    // else: all that drawing takes.
    FarExt::TopologyRefiner::UniformOptions options(3);
    options.fullTopologyInLastLevel = true;
    FarExt::CallStatus status;
    if (!refiner->RefineUniform(options, &status)) {
        std::fprintf(stderr, "%s\n", status.GetErrorMessage().c_str());
        return 1;
    }

    for (int i = 0; i < refiner->GetNumLevels(); ++i) {
        FarExt::TopologyLevel const &level = refiner->GetLevel(i);
        std::printf("level %d: %d vertices, %d edges, %d faces\n", i, level.GetNumVertices(),
                    level.GetNumEdges(), level.GetNumFaces());
        if (!areFacesSeparatedByHexagons(level)) {
            std::fprintf(stderr, "level %d: two F-faces meet\n", i);
            return 1;
        }
    }

    // One step in detail: an edge of the base, and the hexagon that was made of it.
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);
    FarExt::TopologyLevel const &child = refiner->GetLevel(1);
    int const edge = 0;
    int const hexagon = base.GetEdgeChildFace(edge);
    std::printf("edge %d (vertices %d and %d) became face %d:", edge, base.GetEdgeVertices(edge)[0],
                base.GetEdgeVertices(edge)[1], hexagon);
    Far::ConstIndexArray const vertices = child.GetFaceVertices(hexagon);
    for (int vertex : vertices) {
        std::printf(" %d", vertex);
    }
    std::printf("\n");

    // Old vertices keep their numbers.  The hexagon begins and turns at those of the edge.
    bool const isAsDocumented = child.GetFaceParentEdge(hexagon) == edge &&
                                vertices[0] == base.GetEdgeVertices(edge)[0] &&
                                vertices[3] == base.GetEdgeVertices(edge)[1];
    return isAsDocumented ? 0 : 1;
}

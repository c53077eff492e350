// SPDX-License-Identifier: Apache-2.0
#include "hints.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace OpenSubdivHex::Tools {

namespace {

using FarExt::TopologyLevel;

constexpr int kFirstUnevenLevel = 4; // at which the curvature of Average shows

std::size_t countPlaces(std::vector<float> const &positions) {
    std::vector<std::array<float, 3>> places(positions.size() / 3);
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    }
    std::sort(places.begin(), places.end());
    return std::size_t(std::unique(places.begin(), places.end()) - places.begin());
}

void addOpenEdges(Mesh const &mesh, TopologyLevel const &level, std::vector<std::string> *hints) {
    int const numOpen = level.GetNumBoundaryEdges();
    if (numOpen <= level.GetNumEdges() / 2) {
        return;
    }
    std::size_t const numPlaces = countPlaces(mesh.positions);
    if (numPlaces < std::size_t(mesh.GetNumVertices())) {
        hints->push_back(std::to_string(numOpen) + " of " + std::to_string(level.GetNumEdges()) +
                         " edges are open, and " + std::to_string(mesh.GetNumVertices()) +
                         " vertices lie at " + std::to_string(numPlaces) +
                         (numPlaces == 1 ? " place" : " places") +
                         ": weld the mesh, so that faces share vertices and become one surface");
    }
}

// Vertices where faces meet in several fans.  Warnings have those of non-manifold edges.
void addNonManifoldVertices(TopologyLevel const &level, std::vector<std::string> *hints) {
    std::int64_t numVertices = 0;
    int first = -1;
    for (int vert = 0; vert < level.GetNumVertices(); ++vert) {
        auto const edges = level.GetVertexEdges(vert);
        bool const isOfEdges = std::any_of(edges.begin(), edges.end(),
                                           [&](int edge) { return level.IsEdgeNonManifold(edge); });
        if (level.GetVertexFaces(vert).size() > 0 && level.IsVertexNonManifold(vert) &&
            !isOfEdges) {
            first = numVertices == 0 ? vert : first;
            ++numVertices;
        }
    }
    if (numVertices == 1) {
        hints->push_back("vertex " + std::to_string(first) +
                         " (counted from 0) is non-manifold, its faces meet in that vertex alone: "
                         "it stays where it is; split it where the parts are to move apart");
    } else if (numVertices > 1) {
        hints->push_back(std::to_string(numVertices) +
                         " vertices are non-manifold, the first of them vertex " +
                         std::to_string(first) +
                         " (counted from 0), their faces meet in a vertex alone: they stay where "
                         "they are; split them where the parts are to move apart");
    }
}

} // namespace

bool IsOfTriangles(Mesh const &mesh) {
    auto const numTriangles = std::count(mesh.faceSizes.begin(), mesh.faceSizes.end(), 3);
    return numTriangles > 0 &&
           10 * std::int64_t(numTriangles) >= 9 * std::int64_t(mesh.GetNumFaces());
}

std::vector<std::string> FindHints(Mesh const &mesh, FarExt::TopologyRefiner const &refiner,
                                   int maxLevel, bool isMaskChosen, bool isFirstStepChosen) {
    std::vector<std::string> hints;
    FarExt::HexSchemeOptions const scheme = refiner.GetHexSchemeOptions();
    bool const isHexagonal = scheme.schemeType == FarExt::SchemeType::Hexagonal;
    if (isHexagonal && scheme.firstStep == FarExt::FirstStep::Same && !isFirstStepChosen &&
        maxLevel > 0 && IsOfTriangles(mesh)) {
        hints.emplace_back("the faces are triangles, of which --first-step truncate, or --like "
                           "renderer, makes a smoother surface");
    }
    if (isHexagonal && scheme.faceMask == FarExt::FaceMask::Average && !isMaskChosen &&
        maxLevel >= kFirstUnevenLevel) {
        hints.push_back("with --mask average curvature grows from level to level, which shows from "
                        "level " +
                        std::to_string(kFirstUnevenLevel) +
                        " on; --mask smooth, or --like renderer, bounds it");
    }
    addOpenEdges(mesh, refiner.GetLevel(0), &hints);
    addNonManifoldVertices(refiner.GetLevel(0), &hints);
    return hints;
}

} // namespace OpenSubdivHex::Tools

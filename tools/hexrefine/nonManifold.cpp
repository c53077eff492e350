// SPDX-License-Identifier: Apache-2.0
#include "nonManifold.h"

#include <algorithm>
#include <array>
#include <vector>

namespace OpenSubdivHex::Tools {

namespace {

std::string count(std::size_t number, char const *one, char const *several) {
    return std::to_string(number) + (number == 1 ? one : several);
}

/// A side of an edge that came apart, as its face runs it.
struct Side {
    int start;
    int end;

    std::array<int, 2> GetVertices() const { return {std::min(start, end), std::max(start, end)}; }
};

/// The vertices of each non-manifold edge of the mesh, once.
std::vector<std::array<int, 2>> findNonManifoldEdges(FarExt::TopologyLevel const &base) {
    std::vector<Side> sides;
    for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
        if (base.IsEdgeNonManifold(edge)) {
            auto const vertices = base.GetEdgeVertices(edge);
            sides.push_back({vertices[0], vertices[1]});
        }
    }
    std::stable_sort(sides.begin(), sides.end(), [](Side const &a, Side const &b) {
        return a.GetVertices() < b.GetVertices();
    });
    std::vector<std::array<int, 2>> edges;
    for (auto begin = sides.begin(), end = begin; begin != sides.end(); begin = end) {
        end = std::find_if(begin, sides.end(), [&](Side const &side) {
            return side.GetVertices() != begin->GetVertices();
        });
        bool const isInconsistent = end - begin == 2 && begin->start == begin[1].start;
        if (!isInconsistent) {
            edges.push_back(begin->GetVertices());
        }
    }
    return edges;
}

/// The faces that have a vertex several times.
std::vector<int> findDegenerateFaces(Mesh const &mesh) {
    std::vector<int> faces;
    std::vector<int> vertices;
    auto first = mesh.faceVertices.begin();
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        auto const last = first + mesh.faceSizes[std::size_t(face)];
        vertices.assign(first, last);
        std::sort(vertices.begin(), vertices.end());
        if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end()) {
            faces.push_back(face);
        }
        first = last;
    }
    return faces;
}

} // namespace

std::string DescribeWhatComesApart(Mesh const &mesh, FarExt::TopologyLevel const &base) {
    std::string text;
    std::vector<std::array<int, 2>> const edges = findNonManifoldEdges(base);
    if (!edges.empty()) {
        text = count(edges.size(), " non-manifold edge comes apart",
                     " non-manifold edges come apart") +
               ", first between vertices " + std::to_string(edges[0][0]) + " and " +
               std::to_string(edges[0][1]);
    }
    std::vector<int> const faces = findDegenerateFaces(mesh);
    if (!faces.empty()) {
        text += text.empty() ? "" : "; ";
        text += count(faces.size(), " face has", " faces have") +
                " a vertex several times, first face " + std::to_string(faces[0]);
    }
    return text.empty() ? "" : text + " (counted from 0)";
}

} // namespace OpenSubdivHex::Tools

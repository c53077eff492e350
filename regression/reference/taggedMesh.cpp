// SPDX-License-Identifier: Apache-2.0
#include "quadLineReference.h"
#include "taggedRules.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace OpenSubdivHex::Regression {

using namespace TaggedRules;

TaggedMesh MakeTaggedMesh(TaggedBase const &base) {
    TaggedMesh mesh;
    mesh.chaikin = base.chaikin;
    mesh.freeBoundaries = base.freeBoundaries;
    mesh.vertices.resize(base.numVertices);
    for (int v = 0; v < base.numVertices; ++v) {
        mesh.vertices[v].sharpness = base.vertexSharpness[v];
    }
    std::map<std::pair<int, int>, std::vector<Side>> sides;
    auto vertex = base.faceVertices.begin();
    for (int size : base.faceSizes) {
        Face face;
        face.vertices.assign(vertex, vertex + size);
        vertex += size;
        for (int i = 0; i < size; ++i) {
            sides[pairOf(face.vertices[i], face.vertices[(i + 1) % size])].push_back(
                {int(mesh.faces.size()), i});
        }
        mesh.faces.push_back(face);
    }
    for (Face &face : mesh.faces) {
        face.holes.assign(face.vertices.size(), false);
    }
    for (int face : base.holes) {
        mesh.faces[face].holes.flip();
    }
    std::map<std::pair<int, int>, float> creases;
    for (std::size_t i = 0; i < base.creaseSharpness.size(); ++i) {
        creases[pairOf(base.creasePairs[2 * i], base.creasePairs[2 * i + 1])] =
            base.creaseSharpness[i];
    }
    std::set<std::pair<int, int>> apart;
    for (std::size_t i = 0; i < base.nonManifoldPairs.size(); i += 2) {
        apart.insert(pairOf(base.nonManifoldPairs[i], base.nonManifoldPairs[i + 1]));
    }
    int numLines = 0;
    std::vector<std::vector<int>> lineEnds(base.numVertices); // by vertex: where its lines lead
    for (auto const &[ends, edgeSides] : sides) {
        bool const isApart = ends.first == ends.second || apart.count(ends) > 0;
        bool const isTwoFaces = edgeSides.size() == 2 && edgeSides[0].face != edgeSides[1].face;
        if (edgeSides.size() == 1 && !isApart) {
            Edge edge;
            edge.sides = edgeSides;
            edge.isFree = base.freeBoundaries;
            edge.sharpness = edge.isFree ? 0 : kInfiniteSharpness;
            mesh.edges.push_back(edge);
        } else if (isTwoFaces && !isApart &&
                   mesh.GetStart(edgeSides[0]) != mesh.GetStart(edgeSides[1])) {
            Edge edge;
            edge.sides = edgeSides;
            auto const crease = creases.find(ends);
            edge.sharpness = crease == creases.end() ? 0 : crease->second;
            mesh.edges.push_back(edge);
        } else {
            for (Side side : edgeSides) {
                Edge edge;
                edge.sides.push_back(side);
                edge.sharpness = kInfiniteSharpness;
                edge.line = numLines;
                mesh.edges.push_back(edge);
            }
            // One that a face runs twice counts as more than one.
            std::set<int> faces;
            for (Side side : edgeSides) {
                if (faces.empty() || !faces.insert(side.face).second) {
                    faces.insert(side.face);
                    lineEnds[ends.first].push_back(ends.second);
                    lineEnds[ends.second].push_back(ends.first);
                }
            }
            ++numLines;
        }
    }
    connect(mesh);
    std::vector<int> numInterior(base.numVertices);
    std::vector<bool> hasBoundary(base.numVertices);
    for (Edge const &edge : mesh.edges) {
        for (int end : {mesh.GetStart(edge.sides[0]), mesh.GetEnd(edge.sides[0])}) {
            numInterior[end] += edge.sides.size() == 2;
            hasBoundary[end] = hasBoundary[end] || (edge.sides.size() == 1 && edge.line < 0);
        }
    }
    for (int v = 0; v < base.numVertices; ++v) {
        std::vector<int> const &ends = lineEnds[v];
        TaggedMesh::Vertex &tags = mesh.vertices[v];
        std::set<int> faces;
        for (Side corner : tags.corners) {
            faces.insert(corner.face);
        }
        tags.isNonManifold =
            !ends.empty() || findFans(mesh, v).size() != 1 || faces.size() != tags.corners.size();
        bool const isCurve = faces.size() == tags.corners.size() && ends.size() == 2 &&
                             ends[0] != ends[1] && ends[0] != v && ends[1] != v &&
                             !hasBoundary[v] && int(tags.corners.size()) > 2 + numInterior[v];
        if (tags.isNonManifold && !isCurve) {
            tags.sharpness = kInfiniteSharpness;
        }
    }
    BeginQuadLines(mesh);
    return mesh;
}

TaggedMesh MakeValueMesh(TaggedMesh const &mesh, std::vector<int> const &valueIndices,
                         std::vector<float> const &valueSharpness,
                         std::vector<int> &valuesOfVertices) {
    std::vector<int> firstCorner;
    int numCorners = 0;
    for (Face const &face : mesh.faces) {
        firstCorner.push_back(numCorners);
        numCorners += int(face.vertices.size());
    }
    auto cornerOf = [&](Side side) { return firstCorner[side.face] + side.place; };

    // Corners that meet across an edge that is not cut are the same vertex.
    std::vector<int> vertexOf(numCorners);
    std::iota(vertexOf.begin(), vertexOf.end(), 0);
    auto find = [&](int corner) {
        while (vertexOf[corner] != corner) {
            corner = vertexOf[corner];
        }
        return corner;
    };
    TaggedMesh result;
    result.chaikin = mesh.chaikin;
    result.freeBoundaries = mesh.freeBoundaries;
    result.faces = mesh.faces;
    for (Edge const &edge : mesh.edges) {
        if (edge.sides.size() == 1) {
            result.edges.push_back(edge);
            continue;
        }
        int const start0 = cornerOf(edge.sides[0]);
        int const end0 = cornerOf(nextSide(mesh, edge.sides[0]));
        int const start1 = cornerOf(edge.sides[1]);
        int const end1 = cornerOf(nextSide(mesh, edge.sides[1]));
        if (valueIndices[start0] == valueIndices[end1] &&
            valueIndices[end0] == valueIndices[start1]) {
            result.edges.push_back(edge);
            vertexOf[find(start0)] = find(end1);
            vertexOf[find(end0)] = find(start1);
            continue;
        }
        for (Side side : edge.sides) {
            Edge seam;
            seam.sides.push_back(side);
            seam.sharpness = kInfiniteSharpness;
            result.edges.push_back(seam);
        }
    }
    std::map<int, int> vertices;
    valuesOfVertices.clear();
    result.vertices.resize(numCorners);
    for (std::size_t f = 0; f < result.faces.size(); ++f) {
        for (std::size_t i = 0; i < result.faces[f].vertices.size(); ++i) {
            int const corner = firstCorner[f] + int(i);
            auto const [place, isNew] =
                vertices.try_emplace(find(corner), int(valuesOfVertices.size()));
            if (isNew) {
                valuesOfVertices.push_back(valueIndices[corner]);
            }
            result.faces[f].vertices[i] = place->second;
            float &sharpness = result.vertices[place->second].sharpness;
            sharpness = std::max(sharpness, valueSharpness[corner]);
        }
    }
    result.vertices.resize(valuesOfVertices.size());
    connect(result);
    // A seam that ends in a boundary of the paper's rule has no curve to follow.
    for (TaggedMesh::Vertex &vertex : result.vertices) {
        bool meetsFree = false;
        bool meetsSharp = false;
        for (Side corner : vertex.corners) {
            Face const &face = result.faces[corner.face];
            for (int place : {corner.place, previousSide(result, corner).place}) {
                Edge const &edge = result.edges[face.edges[place]];
                if (edge.sides.size() == 1) {
                    (edge.isFree ? meetsFree : meetsSharp) = true;
                }
            }
        }
        if (meetsFree && meetsSharp) {
            vertex.sharpness = kInfiniteSharpness;
        }
    }
    BeginQuadLines(result);
    return result;
}

} // namespace OpenSubdivHex::Regression

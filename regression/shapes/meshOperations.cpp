// SPDX-License-Identifier: Apache-2.0
#include "meshOperations.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

using DirectedEdge = std::pair<int, int>;

/// Position in faceVertices where the edge starts, by its two vertices in the face's direction.
std::map<DirectedEdge, int> cornersByEdge(Shape const &shape) {
    std::map<DirectedEdge, int> corners;
    int first = 0;
    for (int size : shape.faceSizes) {
        for (int i = 0; i < size; ++i) {
            corners[{shape.faceVertices[first + i], shape.faceVertices[first + (i + 1) % size]}] =
                first + i;
        }
        first += size;
    }
    return corners;
}

/// For each vertex, the corners of its faces in counter-clockwise order; the shape is closed.
std::vector<std::vector<int>> vertexCorners(Shape const &shape) {
    std::map<DirectedEdge, int> const corners = cornersByEdge(shape);
    std::vector<int> previousVertex;
    std::vector<int> aCorner(shape.GetNumVertices(), -1);
    int first = 0;
    for (int size : shape.faceSizes) {
        for (int i = 0; i < size; ++i) {
            previousVertex.push_back(shape.faceVertices[first + (i + size - 1) % size]);
            aCorner[shape.faceVertices[first + i]] = first + i;
        }
        first += size;
    }
    std::vector<std::vector<int>> around(shape.GetNumVertices());
    for (int v = 0; v < shape.GetNumVertices(); ++v) {
        int corner = aCorner[v];
        do {
            around[v].push_back(corner);
            corner = corners.at({v, previousVertex[corner]});
        } while (corner != aCorner[v]);
    }
    return around;
}

std::vector<int> cornerFaces(Shape const &shape) {
    std::vector<int> faces;
    for (int f = 0; f < shape.GetNumFaces(); ++f) {
        faces.insert(faces.end(), shape.faceSizes[f], f);
    }
    return faces;
}

std::vector<double> faceCentres(Shape const &shape) {
    std::vector<double> centres;
    int first = 0;
    for (int size : shape.faceSizes) {
        double centre[3] = {0, 0, 0};
        for (int i = 0; i < size; ++i) {
            for (int k = 0; k < 3; ++k) {
                centre[k] += shape.positions[3 * shape.faceVertices[first + i] + k] / size;
            }
        }
        centres.insert(centres.end(), centre, centre + 3);
        first += size;
    }
    return centres;
}

/// For each corner, the first corner of the fan that it belongs to: the corners at one vertex that
/// are connected through common edges.
std::vector<int> findFans(Shape const &shape) {
    std::map<DirectedEdge, int> const corners = cornersByEdge(shape);
    std::vector<int> fans(shape.GetNumCorners());
    std::iota(fans.begin(), fans.end(), 0);
    auto const find = [&fans](int corner) {
        while (fans[corner] != corner) {
            corner = fans[corner];
        }
        return corner;
    };
    int first = 0;
    for (int size : shape.faceSizes) {
        for (int i = 0; i < size; ++i) {
            int const corner = first + i;
            int const previous = first + (i + size - 1) % size;
            // The face beyond the edge that comes in at this vertex has the edge going out.
            auto const beyond =
                corners.find({shape.faceVertices[corner], shape.faceVertices[previous]});
            if (beyond != corners.end()) {
                int const a = find(corner);
                int const b = find(beyond->second);
                fans[std::max(a, b)] = std::min(a, b);
            }
        }
        first += size;
    }
    for (int &fan : fans) {
        fan = find(fan);
    }
    return fans;
}

void addFace(Shape &shape, std::vector<int> const &vertices) {
    shape.faceSizes.push_back(int(vertices.size()));
    shape.faceVertices.insert(shape.faceVertices.end(), vertices.begin(), vertices.end());
}

} // namespace

Shape MakeDual(std::string name, Shape const &shape) {
    Shape dual;
    dual.name = std::move(name);
    dual.positions = faceCentres(shape);
    std::vector<int> const faces = cornerFaces(shape);
    for (std::vector<int> const &corners : vertexCorners(shape)) {
        std::vector<int> vertices;
        for (int corner : corners) {
            vertices.push_back(faces[corner]);
        }
        addFace(dual, vertices);
    }
    return dual;
}

Shape MakeOrtho(std::string name, Shape const &shape) {
    Shape ortho;
    ortho.name = std::move(name);
    ortho.positions = shape.positions;
    std::vector<double> const centres = faceCentres(shape);
    ortho.positions.insert(ortho.positions.end(), centres.begin(), centres.end());
    int const numVertices = int(shape.positions.size() / 3);
    std::map<DirectedEdge, int> middles;
    auto const findMiddle = [&](int v, int w) {
        DirectedEdge const edge = {std::min(v, w), std::max(v, w)};
        auto const [found, isNew] = middles.try_emplace(edge, int(ortho.positions.size() / 3));
        for (int k = 0; isNew && k < 3; ++k) {
            ortho.positions.push_back((shape.positions[3 * v + k] + shape.positions[3 * w + k]) /
                                      2);
        }
        return found->second;
    };
    int first = 0;
    for (int face = 0; face < int(shape.faceSizes.size()); ++face) {
        int const size = shape.faceSizes[face];
        auto const getVertex = [&](int i) { return shape.faceVertices[first + i % size]; };
        for (int i = 0; i < size; ++i) {
            addFace(ortho, {getVertex(i), findMiddle(getVertex(i), getVertex(i + 1)),
                            numVertices + face, findMiddle(getVertex(i + size - 1), getVertex(i))});
        }
        first += size;
    }
    return ortho;
}

Shape MakeTruncated(std::string name, Shape const &shape) {
    Shape truncated;
    truncated.name = std::move(name);
    // One vertex at a third of each directed edge, numbered as the corner that the edge starts at.
    int first = 0;
    std::map<DirectedEdge, int> const corners = cornersByEdge(shape);
    for (int size : shape.faceSizes) {
        std::vector<int> face;
        for (int i = 0; i < size; ++i) {
            int const v = shape.faceVertices[first + i];
            int const w = shape.faceVertices[first + (i + 1) % size];
            for (int k = 0; k < 3; ++k) {
                truncated.positions.push_back(
                    (2 * shape.positions[3 * v + k] + shape.positions[3 * w + k]) / 3);
            }
            face.push_back(first + i);
            face.push_back(corners.at({w, v}));
        }
        addFace(truncated, face);
        first += size;
    }
    for (std::vector<int> const &around : vertexCorners(shape)) {
        addFace(truncated, around);
    }
    return truncated;
}

Shape MakeChamfered(std::string name, Shape const &shape) {
    Shape chamfered;
    chamfered.name = std::move(name);
    int const numVertices = shape.GetNumVertices();
    std::vector<double> const centres = faceCentres(shape);
    chamfered.positions = shape.positions;
    int first = 0;
    for (int f = 0; f < shape.GetNumFaces(); ++f) {
        std::vector<int> face;
        for (int i = 0; i < shape.faceSizes[f]; ++i) {
            for (int k = 0; k < 3; ++k) {
                double const position = shape.positions[3 * shape.faceVertices[first + i] + k];
                chamfered.positions.push_back((2 * position + centres[3 * f + k]) / 3);
            }
            face.push_back(numVertices + first + i);
        }
        addFace(chamfered, face);
        first += shape.faceSizes[f];
    }
    first = 0;
    std::map<DirectedEdge, int> const corners = cornersByEdge(shape);
    std::vector<int> const faces = cornerFaces(shape);
    std::vector<int> firstCorner(shape.GetNumFaces());
    for (int f = 1; f < shape.GetNumFaces(); ++f) {
        firstCorner[f] = firstCorner[f - 1] + shape.faceSizes[f - 1];
    }
    auto const next = [&](int corner) {
        int const f = faces[corner];
        return firstCorner[f] + (corner - firstCorner[f] + 1) % shape.faceSizes[f];
    };
    for (auto const &[edge, corner] : corners) {
        auto const [v, w] = edge;
        if (v < w) {
            int const opposite = corners.at({w, v});
            addFace(chamfered, {v, numVertices + next(opposite), numVertices + opposite, w,
                                numVertices + next(corner), numVertices + corner});
        }
    }
    return chamfered;
}

Shape MakeUnion(std::string name, Shape const &first, Shape const &second, double offset) {
    Shape both = first;
    both.name = std::move(name);
    for (int v = 0; v < second.GetNumVertices(); ++v) {
        both.positions.push_back(second.positions[3 * v] + offset);
        both.positions.push_back(second.positions[3 * v + 1]);
        both.positions.push_back(second.positions[3 * v + 2]);
    }
    both.faceSizes.insert(both.faceSizes.end(), second.faceSizes.begin(), second.faceSizes.end());
    for (int v : second.faceVertices) {
        both.faceVertices.push_back(v + first.GetNumVertices());
    }
    return both;
}

Shape MakeSplit(std::string name, Shape const &shape) {
    Shape split;
    split.name = std::move(name);
    split.positions = shape.positions;
    split.faceSizes = shape.faceSizes;
    split.faceVertices = shape.faceVertices;
    std::vector<int> const fans = findFans(shape);
    std::vector<bool> isTaken(shape.GetNumVertices(), false);
    for (int corner = 0; corner < shape.GetNumCorners(); ++corner) {
        if (fans[corner] != corner) {
            split.faceVertices[corner] = split.faceVertices[fans[corner]];
            continue;
        }
        int const v = shape.faceVertices[corner];
        if (isTaken[v]) {
            split.faceVertices[corner] = split.GetNumVertices();
            for (int k = 0; k < 3; ++k) {
                split.positions.push_back(shape.positions[3 * v + k]);
            }
        }
        isTaken[v] = true;
    }
    return split;
}

int CountBoundaryEdges(Shape const &shape) {
    std::map<DirectedEdge, int> const corners = cornersByEdge(shape);
    int count = 0;
    for (auto const &[edge, corner] : corners) {
        count += corners.count({edge.second, edge.first}) == 0;
    }
    return count;
}

bool IsManifold(Shape const &shape) {
    if (int(cornersByEdge(shape).size()) < shape.GetNumCorners()) {
        return false;
    }
    std::vector<int> const fans = findFans(shape);
    std::vector<int> numFans(shape.GetNumVertices(), 0);
    for (int corner = 0; corner < shape.GetNumCorners(); ++corner) {
        numFans[shape.faceVertices[corner]] += fans[corner] == corner;
    }
    return std::all_of(numFans.begin(), numFans.end(), [](int count) { return count <= 1; });
}

void Deform(Shape &shape) {
    for (int v = 0; v < shape.GetNumVertices(); ++v) {
        double *const p = &shape.positions[3 * v];
        double const x = p[0];
        double const y = p[1];
        double const z = p[2];
        p[0] = 1.03 * x + 0.11 * std::sin(1.3 * y + 0.2) + 0.05 * z * z + 0.017;
        p[1] = 0.97 * y + 0.09 * std::cos(0.7 * z + 0.5 * x) + 0.031;
        p[2] = 1.01 * z + 0.07 * std::sin(0.9 * x - 0.4 * y + 0.6) + 0.03 * x * y;
    }
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "baseRegions.h"

#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

using Point = std::array<double, 2>;

Point mean(Point const &a, Point const &b) { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; }

// The trapezoid between a side and the side of a polygon of half the size around a centre.
ReferencePolygon makeTrapezoid(Point const &start, Point const &end, Point const &center) {
    return {start, end, mean(end, center), mean(start, center)};
}

ReferencePolygon halve(ReferencePolygon polygon, Point const &center) {
    for (Point &point : polygon) {
        point = mean(point, center);
    }
    return polygon;
}

} // namespace

std::vector<int> FindBaseRegions(std::vector<TaggedMesh> const &levels) {
    TaggedMesh const &last = levels.back();
    std::vector<int> regions(last.faces.size(), -1);
    std::vector<bool> hasSeveral(last.faces.size(), false);
    std::vector<std::vector<int>> neighbors(last.faces.size());
    for (TaggedMesh::Edge const &edge : last.edges) {
        if (edge.sides.size() == 2 && edge.sharpness < kInfiniteSharpness) {
            neighbors[edge.sides[0].face].push_back(edge.sides[1].face);
            neighbors[edge.sides[1].face].push_back(edge.sides[0].face);
        }
    }
    for (std::size_t f = 0; f < last.faces.size(); ++f) {
        // From the faces that were made of faces ever since the first level.
        int region = int(f);
        for (std::size_t level = levels.size() - 1; level > 0 && region >= 0; --level) {
            region = levels[level].faceOrigins[region].face;
        }
        if (region < 0) {
            continue;
        }
        std::vector<int> waiting{int(f)};
        while (!waiting.empty()) {
            int const face = waiting.back();
            waiting.pop_back();
            if (regions[face] == region) {
                continue;
            }
            if (regions[face] >= 0) {
                hasSeveral[face] = true;
                continue;
            }
            regions[face] = region;
            waiting.insert(waiting.end(), neighbors[face].begin(), neighbors[face].end());
        }
    }
    for (std::size_t f = 0; f < regions.size(); ++f) {
        regions[f] = hasSeveral[f] ? -1 : regions[f];
    }
    return regions;
}

std::vector<ReferencePolygon> DivideBasePolygon(int size, int numLevels) {
    double const turn = 2 * std::acos(-1.0) / size;
    ReferencePolygon polygon{{0, 0}};
    Point center{0, 0};
    for (int i = 1; i < size; ++i) {
        Point const last = polygon.back();
        polygon.push_back(size == 3 ? Point{i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}
                                    : Point{last[0] + std::cos(turn * (i - 1)),
                                            last[1] + std::sin(turn * (i - 1))});
        center = {center[0] + polygon.back()[0] / size, center[1] + polygon.back()[1] / size};
    }
    std::vector<ReferencePolygon> trapezoids;
    for (int level = 0; level < numLevels; ++level) {
        std::vector<ReferencePolygon> children;
        for (ReferencePolygon const &trapezoid : trapezoids) {
            Point const middle = mean(trapezoid[0], trapezoid[1]);
            children.push_back(halve(trapezoid, middle));
            for (int i = 1; i < 4; ++i) {
                children.push_back(makeTrapezoid(trapezoid[i], trapezoid[(i + 1) % 4], middle));
            }
        }
        for (int i = 0; i < size; ++i) {
            children.push_back(makeTrapezoid(polygon[i], polygon[(i + 1) % size], center));
        }
        polygon = halve(polygon, center);
        trapezoids = std::move(children);
    }
    trapezoids.insert(trapezoids.begin(), polygon);
    return trapezoids;
}

std::vector<BasePiece> MakeBasePieces(TaggedMesh const &base) {
    std::vector<BasePiece> pieces;
    for (std::size_t f = 0; f < base.faces.size(); ++f) {
        std::vector<int> corners(base.faces[f].vertices.size());
        std::iota(corners.begin(), corners.end(), 0);
        int const size = int(corners.size());
        pieces.push_back(
            {int(f), int(f), corners, DivideBasePolygon(size, 0)[0], base.faces[f].isHalf});
    }
    return pieces;
}

std::vector<BasePiece> RefineBasePieces(TaggedMesh const &mesh, TaggedMesh const &child,
                                        std::vector<BasePiece> const &pieces) {
    using Corners = std::vector<int>;
    // By their vertices from the start of the long side on, and the F-faces by their parents.
    std::map<Corners, std::pair<int, Corners>> halves;
    std::map<int, int> fFaces;
    for (std::size_t f = 0; f < child.faces.size(); ++f) {
        TaggedMesh::Face const &face = child.faces[f];
        if (child.faceOrigins[f].face >= 0) {
            fFaces[child.faceOrigins[f].face] = int(f);
        }
        std::vector<Corners> ofFace;
        if (face.isHalf) {
            ofFace.emplace_back(face.vertices.size());
            std::iota(ofFace[0].begin(), ofFace[0].end(), 0);
        } else if (face.vertices.size() == 6) {
            ofFace = {{0, 3, 4, 5}, {3, 0, 1, 2}};
        }
        for (Corners const &corners : ofFace) {
            Corners vertices;
            for (int const corner : corners) {
                vertices.push_back(face.vertices[corner]);
            }
            halves[vertices] = {int(f), corners};
        }
    }
    std::vector<BasePiece> result;
    for (BasePiece const &piece : pieces) {
        Corners vertices;
        Corners fVertices;
        Point center{0, 0};
        std::size_t const size = piece.corners.size();
        for (int const corner : piece.corners) {
            vertices.push_back(child.vVertices[mesh.faces[piece.face].vertices[corner]]);
            fVertices.push_back(child.fVertices[piece.face][corner]);
        }
        for (std::size_t i = 0; i < size; ++i) {
            if (!piece.isHalf || i < 2) { // the middle of the long side
                double const weight = piece.isHalf ? 0.5 : 1.0 / double(size);
                center = {center[0] + weight * piece.places[i][0],
                          center[1] + weight * piece.places[i][1]};
            }
        }
        auto const addHalf = [&](Corners const &ofHalf, ReferencePolygon const &places) {
            auto const found = halves.find(ofHalf);
            if (found != halves.end()) {
                result.push_back(
                    {piece.baseFace, found->second.first, found->second.second, places, true});
            }
        };
        ReferencePolygon const inner = halve(piece.places, center);
        if (piece.isHalf) {
            addHalf(fVertices, inner);
        } else {
            result.push_back({piece.baseFace, fFaces.at(piece.face), piece.corners, inner, false});
        }
        for (std::size_t i = piece.isHalf ? 1 : 0; i < size; ++i) {
            std::size_t const next = (i + 1) % size;
            addHalf({vertices[i], vertices[next], fVertices[next], fVertices[i]},
                    {piece.places[i], piece.places[next], inner[next], inner[i]});
        }
    }
    return result;
}

} // namespace OpenSubdivHex::Regression

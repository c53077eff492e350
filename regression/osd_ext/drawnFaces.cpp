// SPDX-License-Identifier: Apache-2.0
#include "drawnFaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::TopologyLevel;
using OsdExt::DrawOptions;
using OsdExt::PolygonIndices;

// Whether the hexagon, of which no half is a hole, is to be cut.
bool isCut(TopologyLevel const &level, DrawOptions const &options, int face) {
    int const base0 = level.GetFaceBaseFace(face, 0);
    int const base1 = level.GetFaceBaseFace(face, 1);
    if (base0 != base1 && (options.cutBaseFaces || options.generateBaseCoords)) {
        return true;
    }
    if (!options.labels.empty() && options.labels[base0] != options.labels[base1]) {
        return true;
    }
    float const sharpness = level.GetFaceDiagonalSharpness(face);
    bool const isInfinite = Sdc::Crease::IsInfinite(sharpness);
    if ((options.cutCreases == OsdExt::CreaseCuts::All && sharpness > 0) ||
        (options.cutCreases == OsdExt::CreaseCuts::InfinitelySharp && isInfinite) ||
        (options.sides && isInfinite)) {
        return true;
    }
    bool result = false;
    for (int channel : options.fvarChannels) {
        result = result || level.IsFaceFVarSplit(face, channel);
    }
    return result;
}

// Adds what is drawn of a face: its half, or all of it.
void addPolygon(TopologyLevel const &level, DrawOptions const &options, int face, bool isHalf,
                int half, PolygonIndices *polygons) {
    std::vector<int> corners;
    int const size = level.GetFaceVertices(face).size();
    int const end = level.GetFaceDiagonalEnd(face);
    for (int i = 0; i < (isHalf ? FarExt::GetHalfSize(half, size, end) : size); ++i) {
        corners.push_back(isHalf ? FarExt::GetPlaceInHalves(half, i, end) : i);
    }
    for (int i = 0; i < int(corners.size()); ++i) {
        int const corner = corners[std::size_t(i)];
        int const side = options.sides ? options.sides->FindSide(level, face, corner, half) : -1;
        polygons->vertices.push_back(
            options.vertexOffset +
            (options.splitVertices ? side : level.GetFaceVertices(face)[corner]));
        if (options.sides) {
            polygons->sides.push_back(side);
        }
        for (std::size_t k = 0; k < options.fvarChannels.size(); ++k) {
            int const channel = options.fvarChannels[k];
            bool const isSeam = level.IsFaceFVarSplit(face, channel);
            polygons->fvarValues[k].push_back(isSeam
                                                  ? level.GetFaceFVarValues(face, channel, half)[i]
                                                  : level.GetFaceFVarValues(face, channel)[corner]);
        }
    }
    if (options.generateBaseCoords) {
        std::vector<float> uv(2 * corners.size());
        level.GetFaceBaseCoords(face, half, uv.data());
        polygons->baseCoords.insert(polygons->baseCoords.end(), uv.begin(), uv.end());
    }
    int const baseFace = level.GetFaceBaseFace(face, half);
    polygons->sizes.push_back(int(corners.size()));
    polygons->faces.push_back(face);
    polygons->baseFaces.push_back(baseFace);
    if (!options.labels.empty()) {
        polygons->labels.push_back(options.labels[baseFace]);
    }
}

// Makes separate vertices of polygons without: what a corner has is looked up among all that the
// corners before have.
void separateVertices(TopologyLevel const &level, DrawOptions const &options,
                      PolygonIndices *polygons) {
    OsdExt::DrawnVertices &drawn = polygons->drawnVertices;
    int const numVertices =
        options.splitVertices ? options.sides->GetNumSides() : level.GetNumVertices();
    drawn.fvarValues.resize(options.fvarChannels.size());
    auto const placeOf = [&](std::size_t corner) {
        return std::array<float, 2>{polygons->baseCoords[2 * corner],
                                    polygons->baseCoords[2 * corner + 1]};
    };
    auto const describePlace = [&](std::size_t vert, std::size_t corner, int baseFace) {
        if (options.generateBaseCoords) {
            drawn.baseFaces[vert] = baseFace;
            std::array<float, 2> const place = placeOf(corner);
            std::copy(place.begin(), place.end(), &drawn.baseCoords[2 * vert]);
        }
    };
    auto const add = [&](int vert, int side, std::vector<int> const &values) {
        drawn.vertices.push_back(vert);
        if (options.generateBaseCoords) {
            drawn.baseFaces.push_back(Far::INDEX_INVALID);
            drawn.baseCoords.resize(2 * drawn.vertices.size());
        }
        if (options.sides) {
            drawn.sides.push_back(side);
        }
        for (std::size_t k = 0; k < values.size(); ++k) {
            drawn.fvarValues[k].push_back(values[k]);
        }
    };
    for (int vert = 0; vert < numVertices; ++vert) {
        add(vert, vert, std::vector<int>(options.fvarChannels.size()));
    }
    std::vector<int> baseFaces; // by corner
    for (std::size_t i = 0; i < polygons->sizes.size(); ++i) {
        baseFaces.insert(baseFaces.end(), std::size_t(polygons->sizes[i]), polygons->baseFaces[i]);
    }
    using Key = std::pair<std::vector<int>, std::array<float, 2>>;
    std::map<int, std::map<Key, int>> numbers; // by vertex and what a corner has
    for (std::size_t corner = 0; corner < polygons->vertices.size(); ++corner) {
        int const vert = polygons->vertices[corner] - options.vertexOffset;
        int const side = options.sides ? polygons->sides[corner] : -1;
        std::vector<int> values;
        for (std::vector<int> const &ofChannel : polygons->fvarValues) {
            values.push_back(ofChannel[corner]);
        }
        Key all = {values, {}};
        all.first.push_back(side);
        if (options.generateBaseCoords) {
            all.first.push_back(baseFaces[corner]);
            all.second = placeOf(corner);
        }
        std::map<Key, int> &ofVertex = numbers[vert];
        bool const isFirst = ofVertex.empty();
        int const number =
            ofVertex.try_emplace(all, isFirst ? vert : int(drawn.vertices.size())).first->second;
        if (number == int(drawn.vertices.size())) {
            add(vert, side, values);
            describePlace(std::size_t(number), corner, baseFaces[corner]);
        } else if (isFirst) {
            for (std::size_t k = 0; k < values.size(); ++k) {
                drawn.fvarValues[k][std::size_t(vert)] = values[k];
            }
            if (options.sides) {
                drawn.sides[std::size_t(vert)] = side;
            }
            describePlace(std::size_t(vert), corner, baseFaces[corner]);
        }
        polygons->vertices[corner] = options.vertexOffset + number;
    }
}

PolygonIndices findPolygons(TopologyLevel const &level, DrawOptions const &options) {
    PolygonIndices polygons;
    polygons.fvarValues.resize(options.fvarChannels.size());
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        bool const hasHole =
            !options.drawHoles && (level.IsFaceHole(face, 0) || level.IsFaceHole(face, 1));
        if (!options.drawHoles && level.IsFaceHole(face)) {
            continue;
        }
        if (!hasHole && !isCut(level, options, face)) {
            addPolygon(level, options, face, false, 0, &polygons);
            continue;
        }
        for (int half = 0; half < 2; ++half) {
            if (options.drawHoles || !level.IsFaceHole(face, half)) {
                addPolygon(level, options, face, true, half, &polygons);
            }
        }
    }
    if (options.separateVertices) {
        separateVertices(level, options, &polygons);
    }
    return polygons;
}

bool isEqual(OsdExt::DrawnVertices const &a, OsdExt::DrawnVertices const &b) {
    return a.vertices == b.vertices && a.fvarValues == b.fvarValues && a.sides == b.sides &&
           a.baseCoords == b.baseCoords && a.baseFaces == b.baseFaces;
}

// The corners of a triangle, as places in its polygon: the n corners of a regular one, whose area the
// triangles have, all of them in its orientation.
std::string findTriangleError(PolygonIndices const &polygons,
                              OsdExt::TriangleIndices const &triangles) {
    std::size_t corner = 0;
    std::size_t triangle = 0;
    double const turn = 2 * std::acos(-1.0);
    for (std::size_t i = 0; i < polygons.sizes.size(); ++i) {
        std::size_t const size = std::size_t(polygons.sizes[i]);
        double area = 0;
        for (std::size_t k = 0; k + 2 < size; ++k, ++triangle) {
            if (triangle >= triangles.faces.size() ||
                triangles.faces[triangle] != polygons.faces[i] ||
                triangles.baseFaces[triangle] != polygons.baseFaces[i] ||
                (!polygons.labels.empty() && triangles.labels[triangle] != polygons.labels[i])) {
                return "triangle " + std::to_string(triangle) + " is not one of polygon " +
                       std::to_string(i);
            }
            double angles[3];
            for (std::size_t j = 0; j < 3; ++j) {
                std::size_t const to = 3 * triangle + j;
                std::size_t place = 0;
                // If a vertex is in several corners, the values decide.
                auto const isSame = [&](std::size_t from) {
                    bool same = polygons.vertices[from] == triangles.vertices[to];
                    for (std::size_t c = 0; c < polygons.fvarValues.size(); ++c) {
                        same = same && polygons.fvarValues[c][from] == triangles.fvarValues[c][to];
                    }
                    if (!polygons.sides.empty()) {
                        same = same && polygons.sides[from] == triangles.sides[to];
                    }
                    if (!polygons.baseCoords.empty()) {
                        same =
                            same && polygons.baseCoords[2 * from] == triangles.baseCoords[2 * to] &&
                            polygons.baseCoords[2 * from + 1] == triangles.baseCoords[2 * to + 1];
                    }
                    return same;
                };
                while (place < size && !isSame(corner + place)) {
                    ++place;
                }
                if (place == size) {
                    return "triangle " + std::to_string(triangle) +
                           " has a corner that its polygon does not have";
                }
                angles[j] = turn * double(place) / double(size);
            }
            double const part = std::sin(angles[1] - angles[0]) + std::sin(angles[2] - angles[1]) +
                                std::sin(angles[0] - angles[2]);
            area += part > 0 ? part : double(size);
        }
        double const whole = double(size) * std::sin(turn / double(size));
        if (std::abs(area - whole) > 1e-9 * whole) {
            return "the triangles of polygon " + std::to_string(i) + " do not cover it";
        }
        corner += size;
    }
    return triangle == triangles.faces.size() ? "" : "there are more triangles";
}

bool hasRepeatedVertex(PolygonIndices const &polygons) {
    std::size_t corner = 0;
    for (int size : polygons.sizes) {
        for (int i = 0; i < size; ++i) {
            for (int k = 0; k < i; ++k) {
                if (polygons.vertices[corner + std::size_t(i)] ==
                    polygons.vertices[corner + std::size_t(k)]) {
                    return true;
                }
            }
        }
        corner += std::size_t(size);
    }
    return false;
}

} // namespace

std::string FindDrawingError(TopologyLevel const &level, DrawOptions const &options) {
    FarExt::CallStatus status;
    PolygonIndices const polygons = OsdExt::CreatePolygonIndices(level, options, &status);
    if (!status.IsOk()) {
        return status.GetErrorMessage();
    }
    PolygonIndices const expected = findPolygons(level, options);
    if (polygons.sizes != expected.sizes) {
        return "other sizes";
    }
    if (polygons.vertices != expected.vertices || polygons.sides != expected.sides ||
        polygons.fvarValues != expected.fvarValues) {
        return "other vertices, sides or values";
    }
    if (polygons.faces != expected.faces || polygons.baseFaces != expected.baseFaces ||
        polygons.labels != expected.labels) {
        return "other faces, base faces or labels";
    }
    if (polygons.baseCoords != expected.baseCoords) {
        return "other places in base faces";
    }
    if (!isEqual(polygons.drawnVertices, expected.drawnVertices)) {
        return "other separate vertices";
    }
    OsdExt::TriangleIndices const triangles = OsdExt::CreateTriangleIndices(level, options);
    if (!isEqual(triangles.drawnVertices, expected.drawnVertices)) {
        return "other separate vertices of triangles";
    }
    return hasRepeatedVertex(polygons) ? "" : findTriangleError(polygons, triangles);
}

} // namespace OpenSubdivHex::Regression

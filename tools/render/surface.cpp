// SPDX-License-Identifier: Apache-2.0
#include "surface.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Tools {

namespace {

float computeAngle(Vec3 a, Vec3 b) { return std::atan2(Length(Cross(a, b)), Dot(a, b)); }

float computeSegmentDistance(Vec3 point, Vec3 a, Vec3 b) {
    Vec3 const edge = b - a;
    float const squaredLength = Dot(edge, edge);
    float const t = squaredLength > 0 ? Dot(point - a, edge) / squaredLength : 0;
    return Length(point - (a + std::clamp(t, 0.0f, 1.0f) * edge));
}

OsdExt::DrawOptions getOptions(FarExt::LimitSides const &sides, bool cutsBaseFaces) {
    OsdExt::DrawOptions options;
    options.sides = &sides;
    options.cutBaseFaces = cutsBaseFaces;
    return options;
}

OsdExt::DrawOptions getOptionsOfNormals(FarExt::LimitSides const &sides) {
    OsdExt::DrawOptions options = getOptions(sides, false);
    options.cutCreases = OsdExt::CreaseCuts::InfinitelySharp;
    options.drawHoles = true;
    return options;
}

} // namespace

Surface::Surface(FarExt::TopologyLevel const &level, bool cutsBaseFaces)
    : _level(level), _sides(level),
      _triangles(OsdExt::CreateTriangleIndices(level, getOptions(_sides, cutsBaseFaces))),
      _polygons(OsdExt::CreatePolygonIndices(level, getOptionsOfNormals(_sides))) {
    findTrianglePolygons();
}

void Surface::findTrianglePolygons() {
    std::vector<int> firstPolygons(_level.GetNumFaces());
    std::vector<int> numPolygons(firstPolygons.size());
    for (int polygon = _polygons.GetNumPolygons() - 1; polygon >= 0; --polygon) {
        firstPolygons[_polygons.faces[polygon]] = polygon;
        ++numPolygons[_polygons.faces[polygon]];
    }
    for (int triangle = 0; triangle < _triangles.GetNumTriangles(); ++triangle) {
        int const face = _triangles.faces[triangle];
        int const *const begin = _triangles.vertices.data() + 3 * std::ptrdiff_t(triangle);
        Far::ConstIndexArray const vertices = _level.GetFaceVertices(face);
        // Half 1 alone has corners 1 and 2.
        bool const isInSecond =
            numPolygons[face] > 1 && std::any_of(begin, begin + 3, [&](int vertex) {
                return vertex == vertices[1] || vertex == vertices[2];
            });
        _trianglePolygons.push_back(firstPolygons[face] + (isInSecond ? 1 : 0));
    }
}

void Surface::SetPositions(float const *positions, float const *du, float const *dv) {
    _positions.assign(positions, positions + 3 * std::ptrdiff_t(_level.GetNumVertices()));
    findPolygonNormals();
    if (du && dv) {
        for (int side = 0; side < _sides.GetNumSides(); ++side) {
            _normals[side] = Normalize(Cross(GetVec3(du, side), GetVec3(dv, side)));
        }
    }
}

void Surface::findPolygonNormals() {
    float const *const positions = _positions.data();
    _polygonNormals.clear();
    _normals.assign(_sides.GetNumSides(), Vec3());
    int const *vertices = _polygons.vertices.data();
    int const *sides = _polygons.sides.data();
    for (int const size : _polygons.sizes) {
        Vec3 const first = GetVec3(positions, vertices[0]);
        Vec3 normal;
        for (int i = 2; i < size; ++i) {
            normal = normal + Cross(GetVec3(positions, vertices[i - 1]) - first,
                                    GetVec3(positions, vertices[i]) - first);
        }
        _polygonNormals.push_back(Normalize(normal));
        // A side's normal is the mean of the polygons' normals, weighted by their angles there.
        for (int i = 0; i < size; ++i) {
            Vec3 const point = GetVec3(positions, vertices[i]);
            Vec3 const next = GetVec3(positions, vertices[(i + 1) % size]);
            Vec3 const previous = GetVec3(positions, vertices[(i + size - 1) % size]);
            Vec3 &sideNormal = _normals[sides[i]];
            sideNormal =
                sideNormal + computeAngle(next - point, previous - point) * _polygonNormals.back();
        }
        vertices += size;
        sides += size;
    }
    for (Vec3 &normal : _normals) {
        normal = Normalize(normal);
    }
}

Vec3 Surface::GetSmoothNormal(int triangle, float u, float v) const {
    int const *normals = _triangles.sides.data() + 3 * std::ptrdiff_t(triangle);
    return Normalize((1 - u - v) * _normals[normals[0]] + u * _normals[normals[1]] +
                     v * _normals[normals[2]]);
}

Vec3 Surface::GetFlatNormal(int triangle) const {
    return _polygonNormals[_trianglePolygons[triangle]];
}

int Surface::GetFaceSize(int triangle) const {
    return _level.GetFaceVertices(_triangles.faces[triangle]).size();
}

float Surface::GetEdgeDistance(int triangle, Vec3 point) const {
    Far::ConstIndexArray const vertices = _level.GetFaceVertices(_triangles.faces[triangle]);
    Vec3 end = GetVec3(_positions.data(), vertices[vertices.size() - 1]);
    float distance = Length(point - end);
    for (int vertex : vertices) {
        Vec3 const start = end;
        end = GetVec3(_positions.data(), vertex);
        distance = std::min(distance, computeSegmentDistance(point, start, end));
    }
    return distance;
}

} // namespace OpenSubdivHex::Tools

// SPDX-License-Identifier: Apache-2.0
#include "coplanarEdges.h"

#include "parallel.h"
#include "pi.h"
#include "refinementRows.h"

#include "far_ext/vtr/report.h"

#include <cmath>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;
using Sdc::Crease;

double CoplanarEdges::dot(Vector const &a, Vector const &b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

double CoplanarEdges::length(Vector const &a) { return std::hypot(a.x, a.y, a.z); }

auto CoplanarEdges::cross(Vector const &a, Vector const &b) -> Vector {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename REAL>
CallStatus CoplanarEdges::Begin(REAL const *restPositions) {
    if (!_schemeOptions.IsHexagonal()) {
        return Failure(StatusCode::Unsupported,
                       "refinement by coplanar faces is for the hexagonal scheme alone");
    }
    if (!restPositions) {
        return Failure(StatusCode::InvalidArgument, "the rest positions are null");
    }
    if (!(0 <= _angleTolerance && _angleTolerance <= 180)) {
        return Failure(StatusCode::InvalidArgument, "the angle tolerance " +
                                                        std::to_string(_angleTolerance) +
                                                        " is not between 0 and 180 degrees");
    }
    _positions.resize(std::size_t(level().numVertices));
    for (Index vert = 0; vert < level().numVertices; ++vert) {
        REAL const *position = restPositions + 3 * std::size_t(vert);
        _positions[vert] = {double(position[0]), double(position[1]), double(position[2])};
        // The normals take products of coordinates.
        if (!std::isfinite(dot(_positions[vert], _positions[vert]))) {
            return CallStatus(StatusCode::InvalidArgument, ComponentType::Vertex, vert,
                              "the rest position of vertex " + std::to_string(vert) +
                                  " is not finite, or too far away");
        }
    }
    return CallStatus();
}

template CallStatus CoplanarEdges::Begin(float const *restPositions);
template CallStatus CoplanarEdges::Begin(double const *restPositions);

void CoplanarEdges::Refine() {
    RefinementRows const rows(_hierarchy.mesh.refinements[_depth], _schemeOptions,
                              Interpolation::Vertex);
    std::vector<Vector> refined(std::size_t(rows.GetNumRows()));
    Interpolate<double>(rows, _positions, refined);
    _positions.swap(refined);
    ++_depth;
}

// The direction of the vector area of a face, 1 long; zero when that is nothing but rounding errors.
auto CoplanarEdges::faceNormal(Index face) const -> Vector {
    constexpr double kRounding = 1e-12;
    Far::ConstIndexArray const verts = level().GetFaceVertices(face);
    Vector const &origin = _positions[verts[0]];
    Vector normal;
    double size = 0;
    for (int i = 1; i + 1 < verts.size(); ++i) {
        Vector const side0 = _positions[verts[i]] - origin;
        Vector const side1 = _positions[verts[i + 1]] - origin;
        normal.AddWithWeight(cross(side0, side1), 1);
        size += dot(side0, side0) + dot(side1, side1);
    }
    double const area = length(normal);
    return area > kRounding * size ? Vector{normal.x / area, normal.y / area, normal.z / area}
                                   : Vector();
}

bool CoplanarEdges::isParallel(Vector const &normal0, Vector const &normal1) const {
    constexpr double kDegrees = 180 / kPi;
    double const angle = std::atan2(length(cross(normal0, normal1)), dot(normal0, normal1));
    return length(normal0) > 0 && length(normal1) > 0 && angle * kDegrees <= _angleTolerance;
}

// Whether a feature wants the hexagon of an interior edge.
bool CoplanarEdges::hasFeature(Index edge) const {
    Level const &mesh = level();
    for (Index vert : mesh.edgeVerts[edge]) {
        if (mesh.IsNonManifold(vert) || Crease::IsSharp(mesh.GetVertexSharpness(vert))) {
            return true;
        }
    }
    for (Index face : mesh.edgeFaces[edge]) {
        if (mesh.IsHalfFace(face) || Crease::IsSharp(mesh.GetDiagonalSharpness(face))) {
            return true;
        }
    }
    for (FVarChannel const &channel : _hierarchy.channels) {
        FVarLevel const &fvarLevel = channel.levels[_depth];
        IndexPair const &faces = mesh.edgeFaces[edge];
        LocalIndexPair const &locals = mesh.edgeFaceLocals[edge];
        if (fvarLevel.GetFaceEdge(faces[0], locals[0]) !=
                fvarLevel.GetFaceEdge(faces[1], locals[1]) ||
            fvarLevel.FindSplitFace(faces[0]) || fvarLevel.FindSplitFace(faces[1])) {
            return true;
        }
    }
    return Crease::IsSharp(mesh.GetEdgeSharpness(edge));
}

std::vector<unsigned char> CoplanarEdges::FindFlat() const {
    Level const &mesh = level();
    std::vector<Vector> normals(std::size_t(mesh.numFaces));
    ParallelFor(mesh.numFaces, [&](Index face) { normals[face] = faceNormal(face); });
    std::vector<unsigned char> result(std::size_t(mesh.numEdges));
    ParallelFor(mesh.numEdges, [&](Index edge) {
        if (!mesh.IsBoundary(edge) && !hasFeature(edge)) {
            IndexPair const &faces = mesh.edgeFaces[edge];
            result[edge] = isParallel(normals[faces[0]], normals[faces[1]]);
        }
    });
    return result;
}

} // namespace OpenSubdivHex::FarExt::internal

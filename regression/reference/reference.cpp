// SPDX-License-Identifier: Apache-2.0
#include "reference.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace OpenSubdivHex::Regression {

namespace {

double const kPi = std::acos(-1.0);

using FaceHandle = ReferenceMesh::FaceHandle;
using HalfedgeHandle = ReferenceMesh::HalfedgeHandle;
using VertexHandle = ReferenceMesh::VertexHandle;
using Point = Eigen::RowVectorXd;

/// The corner of a face at a vertex is the face's halfedge that leaves the vertex.
std::vector<HalfedgeHandle> faceCorners(ReferenceMesh const &mesh, FaceHandle face) {
    std::vector<HalfedgeHandle> corners;
    HalfedgeHandle const first = mesh.halfedge_handle(face);
    HalfedgeHandle corner = first;
    do {
        corners.push_back(corner);
        corner = mesh.next_halfedge_handle(corner);
    } while (corner != first);
    return corners;
}

void addFace(ReferenceMesh &mesh, std::vector<VertexHandle> const &vertices) {
    FaceHandle const face = mesh.add_face(vertices);
    if (!face.is_valid()) {
        throw std::runtime_error("reference: OpenMesh refuses face " +
                                 std::to_string(mesh.n_faces()));
    }
}

Point centroid(std::vector<Point> const &face) {
    Point sum = Point::Zero(face[0].size());
    for (Point const &p : face) {
        sum += p;
    }
    return sum / double(face.size());
}

/// "The average of the vertex, the two edge midpoints and the face's centroid."
Point averagePoint(std::vector<Point> const &face, int i) {
    int const n = int(face.size());
    Point const &previous = face[(i + n - 1) % n];
    Point const &vertex = face[i];
    Point const &next = face[(i + 1) % n];
    Point const previousMidpoint = (previous + vertex) / 2;
    Point const nextMidpoint = (vertex + next) / 2;
    return (vertex + previousMidpoint + nextMidpoint + centroid(face)) / 4;
}

/// Doo and Sabin 1978: the vertex itself has (n + 5)/4n, one at angle theta (3 + 2 cos theta)/4n.
Point cosinePoint(std::vector<Point> const &face, int i) {
    int const n = int(face.size());
    Point sum = (n + 5.0) / (4.0 * n) * face[i];
    for (int j = 1; j < n; ++j) {
        sum += (3 + 2 * std::cos(2 * kPi * j / n)) / (4.0 * n) * face[(i + j) % n];
    }
    return sum;
}

/// The scheme's smooth variant; triangles and quads are as Doo and Sabin's.
Point smoothPoint(std::vector<Point> const &face, int i) {
    int const n = int(face.size());
    if (n < 5) {
        return cosinePoint(face, i);
    }
    Point sum = (1.0 / 8 + 15.0 / (8.0 * n)) * face[i];
    for (int j = 1; j < n; ++j) {
        double const theta = 2 * kPi * j / n;
        double const weight =
            (7.0 / 8 + 3.0 / 4 * std::cos(theta) + 1.0 / 4 * std::cos(2 * theta)) / n;
        sum += weight * face[(i + j) % n];
    }
    return sum;
}

/// The number that Refine() gave to the new vertex of each corner, by halfedge.
std::vector<VertexHandle> numberFVertices(ReferenceMesh const &mesh) {
    std::vector<VertexHandle> fVertices(mesh.n_halfedges());
    int count = 0;
    for (FaceHandle face : mesh.faces()) {
        for (HalfedgeHandle corner : faceCorners(mesh, face)) {
            fVertices[corner.idx()] = VertexHandle(count++);
        }
    }
    return fVertices;
}

/// The faces of a vertex if it is irregular, 0 if it is not: of four faces or more, all hexagons, in
/// the interior, of a refined mesh.
int irregularFaces(ReferenceMesh const &mesh, VertexHandle vertex) {
    int count = 0;
    for (FaceHandle face : mesh.vf_range(vertex)) {
        if (mesh.valence(face) != 6) {
            return 0;
        }
        ++count;
    }
    return mesh.numSteps > 0 && count >= 4 && !mesh.is_boundary(vertex) ? count : 0;
}

/// The kind of a vertex's faces in the base mesh.
FormerFaces formerFaces(ReferenceMesh const &mesh, VertexHandle vertex) {
    if (mesh.numSteps > 0) {
        return mesh.formerFaces[vertex.idx()];
    }
    std::vector<int> sizes;
    for (FaceHandle face : mesh.vf_range(vertex)) {
        sizes.push_back(int(mesh.valence(face)));
    }
    return FindFormerFaces(int(sizes.size()), [&](int i) { return sizes[i]; });
}

IrregularRule makeRule(ReferenceMesh const &mesh, VertexHandle vertex, int numFaces) {
    return MakeIrregularRule(numFaces, mesh.numSteps, formerFaces(mesh, vertex));
}

/// Whether across the edge from a corner is the smaller copy of a quad: quads made for edges are at
/// boundaries.
bool isBesideQuad(ReferenceMesh const &mesh, HalfedgeHandle corner) {
    HalfedgeHandle const other = mesh.opposite_halfedge_handle(corner);
    if (mesh.is_boundary(other)) {
        return false;
    }
    FaceHandle const face = mesh.face_handle(other);
    return mesh.numSteps > 0 && mesh.valence(face) == 4 && !mesh.is_boundary(face);
}

QuadPath longer(QuadPath const &path, char digit) { return path.Append(digit); }

/// The path of a half-edge, at its start or its end.
QuadPath pathOf(ReferenceMesh const &mesh, HalfedgeHandle halfedge, bool isStart) {
    if (mesh.numSteps > 0) {
        auto const &paths = isStart ? mesh.pathsOfStart : mesh.pathsOfEnd;
        auto const found = paths.find(halfedge.idx());
        return found != paths.end() ? found->second : QuadPath();
    }
    VertexHandle const vertex =
        isStart ? mesh.from_vertex_handle(halfedge) : mesh.to_vertex_handle(halfedge);
    int numFaces = 0;
    for (FaceHandle face : mesh.vf_range(vertex)) {
        ++numFaces;
        if (mesh.valence(face) != 4) {
            return {};
        }
    }
    if (mesh.is_boundary(vertex)) {
        return {};
    }
    bool const hasKind = numFaces >= 3 && numFaces <= 6;
    return {hasKind ? std::to_string(numFaces) : "o"};
}

/// The rules of Smooth for quads, and for hexagons that are beside a quad or have an irregular vertex: an
/// edge to a quad comes first, quads further away last.
std::optional<Point> irregularPoint(ReferenceMesh const &mesh,
                                    std::vector<HalfedgeHandle> const &corners,
                                    std::vector<Point> const &points, int i) {
    if (corners.size() == 4) {
        return NewPointOfQuad(mesh.numSteps, points, i);
    }
    if (corners.size() != 6) {
        return {};
    }
    if (points.size() == 6) {
        if (auto const point = NewPointByPath(points, i, pathOf(mesh, corners[i], true),
                                              pathOf(mesh, corners[(i + 5) % 6], false))) {
            return point;
        }
    }
    std::vector<int> edges; // to quads
    for (int edge = 0; edge < 6; ++edge) {
        if (isBesideQuad(mesh, corners[edge])) {
            edges.push_back(edge);
        }
    }
    for (int edge : edges) {
        if (edge == i || edge == (i + 5) % 6) {
            if (auto const point = NewPointBesideQuad(mesh.numSteps, points, i, edge)) {
                return point;
            }
        }
    }
    for (int corner : {i, (i + 1) % 6, (i + 5) % 6}) {
        VertexHandle const vertex = mesh.from_vertex_handle(corners[corner]);
        if (int const numFaces = irregularFaces(mesh, vertex); numFaces > 0) {
            return NewIrregularPoint(makeRule(mesh, vertex, numFaces), points, i, corner);
        }
    }
    return edges.size() == 1 ? NewPointBesideQuad(mesh.numSteps, points, i, edges[0])
                             : std::optional<Point>();
}

/// Stage 1: a new point at each corner of each face, from the points of that face alone.
template <typename NewPoint>
void makeFVertices(ReferenceMesh const &mesh, ReferenceValues const &values,
                   std::vector<VertexHandle> const &fVertices, NewPoint &&makePoint,
                   ReferenceValues &result) {
    for (FaceHandle face : mesh.faces()) {
        std::vector<HalfedgeHandle> const corners = faceCorners(mesh, face);
        std::vector<Point> points;
        for (HalfedgeHandle corner : corners) {
            points.push_back(values.row(mesh.from_vertex_handle(corner).idx()));
        }
        for (int i = 0; i < int(corners.size()); ++i) {
            result.row(fVertices[corners[i].idx()].idx()) = makePoint(corners, points, i);
        }
    }
}

/// Stage 2: an old vertex moves to the average of itself and the new points around it, or in between
/// as the rule of an irregular one says.
Point movedVertex(ReferenceMesh const &mesh, ReferenceValues const &values,
                  std::vector<VertexHandle> const &fVertices, VertexHandle vertex,
                  ReferenceMask mask, ReferenceValues const &newPoints) {
    Point sum = values.row(vertex.idx());
    int numPoints = 1;
    for (auto it = mesh.cvoh_iter(vertex); it.is_valid(); ++it) {
        if (!mesh.is_boundary(*it)) {
            sum += newPoints.row(fVertices[it->idx()].idx());
            ++numPoints;
        }
    }
    if (mask == ReferenceMask::Smooth && mesh.numSteps > 0) {
        Point const old = values.row(vertex.idx());
        Point moved = old;
        bool isByPath = true;
        for (auto it = mesh.cvoh_iter(vertex); it.is_valid() && isByPath; ++it) {
            std::optional<double> const weight =
                mesh.is_boundary(*it)
                    ? std::nullopt
                    : WeightByPath(pathOf(mesh, *it, true),
                                   pathOf(mesh, mesh.prev_halfedge_handle(*it), false));
            isByPath = weight.has_value();
            if (isByPath) {
                moved += *weight * (newPoints.row(fVertices[it->idx()].idx()) - old);
            }
        }
        if (isByPath) {
            return moved;
        }
    }
    int const numFaces = mask == ReferenceMask::Smooth ? irregularFaces(mesh, vertex) : 0;
    if (numFaces > 0) {
        double const weight = makeRule(mesh, vertex, numFaces).meanWeight;
        Point const old = values.row(vertex.idx());
        return (1 - weight) * old + weight / numFaces * (sum - old);
    }
    return sum / double(numPoints);
}

VertexHandle vVertex(std::size_t numFVertices, VertexHandle vertex) {
    return VertexHandle(int(numFVertices) + vertex.idx());
}

std::size_t countCorners(ReferenceMesh const &mesh) {
    std::size_t count = 0;
    for (FaceHandle face : mesh.faces()) {
        count += mesh.valence(face);
    }
    return count;
}

/// For a face of the child: the paths of its edges at each vertex.
struct PathsAtVertex {
    QuadPath out;
    QuadPath in;
};
void setPaths(std::vector<VertexHandle> const &vertices, std::vector<PathsAtVertex> const &paths,
              ReferenceMesh &mesh) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        std::size_t const next = (i + 1) % vertices.size();
        int const halfedge = mesh.find_halfedge(vertices[i], vertices[next]).idx();
        mesh.pathsOfStart[halfedge] = paths[i].out;
        mesh.pathsOfEnd[halfedge] = paths[next].in;
    }
}

/// Stage 3: the new points of each face are joined to a face, and each edge makes one between the
/// faces on its two sides.
void connect(ReferenceMesh const &mesh, std::vector<VertexHandle> const &fVertices,
             std::size_t numFVertices, ReferenceLevel &child) {
    for (FaceHandle face : mesh.faces()) {
        std::vector<VertexHandle> vertices;
        for (HalfedgeHandle corner : faceCorners(mesh, face)) {
            vertices.push_back(fVertices[corner.idx()]);
        }
        addFace(child.mesh, vertices);
        std::vector<PathsAtVertex> paths;
        for (HalfedgeHandle corner : faceCorners(mesh, face)) {
            paths.push_back({longer(pathOf(mesh, corner, true), '0'),
                             longer(pathOf(mesh, mesh.prev_halfedge_handle(corner), false), '0')});
        }
        setPaths(vertices, paths, child.mesh);
        ReferenceFaceOrigin origin;
        origin.face = face.idx();
        child.faceOrigins.push_back(origin);
    }
    for (auto edge : mesh.edges()) {
        HalfedgeHandle a = mesh.halfedge_handle(edge, 0);
        if (mesh.is_boundary(a)) {
            a = mesh.opposite_halfedge_handle(a);
        }
        HalfedgeHandle const b = mesh.opposite_halfedge_handle(a);
        VertexHandle const v0 = mesh.from_vertex_handle(a);
        VertexHandle const v1 = mesh.to_vertex_handle(a);
        VertexHandle const aV0 = fVertices[a.idx()];
        VertexHandle const aV1 = fVertices[mesh.next_halfedge_handle(a).idx()];
        if (mesh.is_boundary(b)) {
            addFace(child.mesh, {vVertex(numFVertices, v0), vVertex(numFVertices, v1), aV1, aV0});
        } else {
            VertexHandle const bV1 = fVertices[b.idx()];
            VertexHandle const bV0 = fVertices[mesh.next_halfedge_handle(b).idx()];
            std::vector<VertexHandle> const vertices = {vVertex(numFVertices, v0), bV0, bV1,
                                                        vVertex(numFVertices, v1), aV1, aV0};
            addFace(child.mesh, vertices);
            std::vector<PathsAtVertex> paths(6);
            int place = 0;
            for (HalfedgeHandle side : {a, b}) { // at its start, at its end, and beside both
                HalfedgeHandle const other = mesh.opposite_halfedge_handle(side);
                QuadPath const atStart = pathOf(mesh, side, true);
                QuadPath const atEnd = pathOf(mesh, side, false);
                paths[place] = {longer(pathOf(mesh, other, false), '3'), longer(atStart, '3')};
                paths[(place + 4) % 6] = {longer(atEnd, '1'), longer(atEnd, '2')};
                paths[(place + 5) % 6] = {longer(atStart, '2'), longer(atStart, '1')};
                place += 3;
            }
            setPaths(vertices, paths, child.mesh);
        }
        ReferenceFaceOrigin origin;
        origin.isEFace = true;
        origin.edgeVertices[0] = v0.idx();
        origin.edgeVertices[1] = v1.idx();
        child.faceOrigins.push_back(origin);
    }
}

} // namespace

ReferenceMesh MakeReferenceMesh(std::vector<double> const &positions,
                                std::vector<int> const &faceSizes,
                                std::vector<int> const &faceVertices) {
    ReferenceMesh mesh;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        mesh.add_vertex({positions[i], positions[i + 1], positions[i + 2]});
    }
    auto vertex = faceVertices.begin();
    for (int size : faceSizes) {
        std::vector<VertexHandle> vertices;
        for (int i = 0; i < size; ++i) {
            vertices.push_back(VertexHandle(*vertex++));
        }
        addFace(mesh, vertices);
    }
    for (VertexHandle v : mesh.vertices()) {
        if (!mesh.is_manifold(v)) {
            throw std::runtime_error("reference: vertex " + std::to_string(v.idx()) +
                                     " is not manifold");
        }
    }
    return mesh;
}

Eigen::RowVectorXd NewPoint(ReferenceMask mask, std::vector<Eigen::RowVectorXd> const &face,
                            int i) {
    switch (mask) {
    case ReferenceMask::Average:
        return averagePoint(face, i);
    case ReferenceMask::Cosine:
        return cosinePoint(face, i);
    case ReferenceMask::Smooth:
        return smoothPoint(face, i);
    }
    throw std::invalid_argument("reference: no such mask");
}

Eigen::RowVectorXd NewVaryingPoint(std::vector<Eigen::RowVectorXd> const &face, int i) {
    return (face[i] + centroid(face)) / 2;
}

ReferenceValues GetPoints(ReferenceMesh const &mesh) {
    ReferenceValues points(mesh.n_vertices(), 3);
    for (VertexHandle v : mesh.vertices()) {
        for (int k = 0; k < 3; ++k) {
            points(v.idx(), k) = mesh.point(v)[k];
        }
    }
    return points;
}

ReferenceLevel Refine(ReferenceMesh const &mesh, ReferenceMask mask) {
    ReferenceLevel child;
    child.mesh.numSteps = mesh.numSteps + 1;
    std::vector<VertexHandle> const fVertices = numberFVertices(mesh);
    std::size_t const numFVertices = countCorners(mesh);
    child.mesh.formerFaces.resize(numFVertices + mesh.n_vertices());
    for (VertexHandle v : mesh.vertices()) {
        child.mesh.formerFaces[vVertex(numFVertices, v).idx()] = formerFaces(mesh, v);
    }
    child.vertexOrigins.resize(numFVertices + mesh.n_vertices());
    for (FaceHandle face : mesh.faces()) {
        for (HalfedgeHandle corner : faceCorners(mesh, face)) {
            ReferenceVertexOrigin &origin = child.vertexOrigins[fVertices[corner.idx()].idx()];
            origin.isFVertex = true;
            origin.vertex = mesh.from_vertex_handle(corner).idx();
            origin.face = face.idx();
        }
    }
    for (VertexHandle vertex : mesh.vertices()) {
        child.vertexOrigins[vVertex(numFVertices, vertex).idx()].vertex = vertex.idx();
    }
    ReferenceValues const points = Interpolate(mesh, child, mask, GetPoints(mesh));
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        child.mesh.add_vertex({points(i, 0), points(i, 1), points(i, 2)});
    }
    connect(mesh, fVertices, numFVertices, child);
    return child;
}

ReferenceValues Interpolate(ReferenceMesh const &mesh, ReferenceLevel const &child,
                            ReferenceMask mask, ReferenceValues const &values) {
    ReferenceValues result(child.vertexOrigins.size(), values.cols());
    std::vector<VertexHandle> const fVertices = numberFVertices(mesh);
    auto const makePoint = [&](std::vector<HalfedgeHandle> const &corners,
                               std::vector<Point> const &face, int i) {
        std::optional<Point> const point =
            mask == ReferenceMask::Smooth ? irregularPoint(mesh, corners, face, i) : std::nullopt;
        return point ? *point : NewPoint(mask, face, i);
    };
    makeFVertices(mesh, values, fVertices, makePoint, result);
    std::size_t const numFVertices = countCorners(mesh);
    for (VertexHandle v : mesh.vertices()) {
        result.row(vVertex(numFVertices, v).idx()) =
            movedVertex(mesh, values, fVertices, v, mask, result);
    }
    return result;
}

ReferenceValues InterpolateVarying(ReferenceMesh const &mesh, ReferenceLevel const &child,
                                   ReferenceValues const &values) {
    ReferenceValues result(child.vertexOrigins.size(), values.cols());
    auto const makePoint = [](std::vector<HalfedgeHandle> const &, std::vector<Point> const &face,
                              int i) { return NewVaryingPoint(face, i); };
    makeFVertices(mesh, values, numberFVertices(mesh), makePoint, result);
    std::size_t const numFVertices = countCorners(mesh);
    for (VertexHandle v : mesh.vertices()) {
        result.row(vVertex(numFVertices, v).idx()) = values.row(v.idx());
    }
    return result;
}

} // namespace OpenSubdivHex::Regression

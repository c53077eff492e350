// SPDX-License-Identifier: Apache-2.0
#include "taggedRules.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace OpenSubdivHex::Regression {

using namespace TaggedRules;

namespace {

/// Builds the child of a mesh, first with all half faces apart.
class Refinement {
public:
    Refinement(TaggedMesh const &parent, ReferenceStep const &step) : _parent(parent), _step(step) {
        _child.chaikin = parent.chaikin;
        _child.freeBoundaries = parent.freeBoundaries;
        _child.madeBy = step.scheme;
        _child.numHexagonalSteps = isHexagonal() ? parent.numHexagonalSteps + 1 : 0;
        _child.hasFirstLines = isHexagonal() && parent.hasFirstLines;
    }

    TaggedMesh Run() {
        makeVertices();
        findBasePaths();
        makeFFaces();
        if (_step.scheme != ReferenceScheme::TriHex) {
            makeEFaces();
        }
        makeVFaces();
        joinSides();
        mergeSmoothHalves();
        connect(_child);
        if (!_step.closeGaps) {
            tagPartedVertices();
        }
        return std::move(_child);
    }

private:
    void makeVertices();
    void findBasePaths();
    void setPathsOfSide(int face, int start, int end, int endPoint, int startPoint, Side side,
                        bool areOfQuads = true);
    template <typename PATH>
    static void setPaths(std::vector<PATH> &out, std::vector<PATH> &in, PATH const &atStart,
                         PATH const &atEnd, int start, int end, int endPoint, int startPoint);
    void makeFFaces();
    void makeEFaces();
    void makeVFaces();
    void makeFanFaces(int vertex, Fan const &fan);
    void addVFace(int vertex, std::vector<int> vertices, std::vector<Side> const &corners);
    void joinSides();
    void mergeSmoothHalves();
    void tagPartedVertices();

    /// In the child of a hexagonal step.
    FormerFaces formerFaces(int vertex) const {
        TaggedMesh::Vertex const &tags = _parent.vertices[vertex];
        if (_parent.numHexagonalSteps > 0) {
            // Where edges were flat, it has got other faces.
            bool const areOfEdges =
                std::all_of(tags.corners.begin(), tags.corners.end(), [&](Side corner) {
                    return _parent.faceOrigins[corner.face].edge >= 0;
                });
            return areOfEdges ? tags.formerFaces : FormerFaces::Mixed;
        }
        return FindFormerFaces(int(tags.corners.size()), [&](int i) {
            return int(_parent.faces[tags.corners[i].face].vertices.size());
        });
    }

    float regularChild(Edge const &edge) const {
        return isHexagonal() ? decremented(edge.regularLine) : 0;
    }
    bool isHole(Side side) const { return _parent.faces[side.face].holes[side.place]; }

    int addFace(std::vector<int> vertices, bool isHalf, std::vector<bool> holes,
                TaggedMesh::FaceOrigin origin) {
        Face face;
        face.vertices = std::move(vertices);
        face.isHalf = isHalf;
        face.holes = std::move(holes);
        face.pathsOut.resize(face.vertices.size());
        face.pathsIn.resize(face.vertices.size());
        face.linesOut.resize(face.vertices.size());
        face.linesIn.resize(face.vertices.size());
        _child.faces.push_back(face);
        _child.faceOrigins.push_back(origin);
        return int(_child.faces.size()) - 1;
    }

    int fVertex(Side corner) const { return _child.fVertices[corner.face][corner.place]; }
    int vVertex(int vertex) const { return _child.vVertices[vertex]; }

    bool isHexagonal() const { return _step.scheme == ReferenceScheme::Hexagonal; }
    /// Whether the edge that comes in to a corner makes a quad.
    bool isFlatBefore(Side corner) const {
        Face const &face = _parent.faces[corner.face];
        return isFlat(face.edges[previousSide(_parent, corner).place]);
    }
    bool isFlat(int edge) const {
        return !isHexagonal() || (!_step.flatEdges.empty() && _step.flatEdges[edge]);
    }
    /// Whether no face but flat ones is around the vertex.
    bool isFlatFan(Fan const &fan) const {
        return fan.isClosed && std::all_of(fan.corners.begin(), fan.corners.end(),
                                           [&](Side corner) { return isFlatBefore(corner); });
    }
    bool isKept(int vertex) const {
        std::vector<Fan> const fans = findFans(_parent, vertex);
        return isHexagonal() && (fans.size() != 1 || !isFlatFan(fans[0]));
    }

    TaggedMesh const &_parent;
    ReferenceStep const &_step;
    std::vector<std::vector<QuadPath>> _pathsOut; ///< by face and place of the parent
    std::vector<std::vector<QuadPath>> _pathsIn;
    TaggedMesh _child;
    std::set<std::pair<int, int>> _placed; ///< face and place of sides that have their edge
};

void Refinement::makeVertices() {
    for (int v = 0; v < int(_parent.vertices.size()); ++v) {
        if (!isKept(v)) {
            _child.vVertices.push_back(-1);
            continue;
        }
        _child.vVertices.push_back(int(_child.vertices.size()));
        TaggedMesh::Vertex vertex;
        vertex.sharpness = decremented(_parent.vertices[v].sharpness);
        vertex.isNonManifold = _parent.vertices[v].isNonManifold;
        vertex.formerFaces = isHexagonal() ? formerFaces(v) : FormerFaces::Mixed;
        _child.vertices.push_back(vertex);
        _child.vertexOrigins.push_back({v, -1, -1});
    }
    // Both halves of a hexagon have the same points on the line between them; they run it in
    // opposite directions.
    std::map<std::pair<int, int>, int> onLines;
    for (std::size_t f = 0; f < _parent.faces.size(); ++f) {
        Face const &face = _parent.faces[f];
        _child.fVertices.emplace_back();
        for (int i = 0; i < int(face.vertices.size()); ++i) {
            int vertex = int(_child.vertices.size());
            if (face.isHalf && i < 2) {
                bool const isFirst = _parent.edges[face.edges[0]].sides[0].face == int(f);
                vertex =
                    onLines.try_emplace({face.edges[0], isFirst ? i : 1 - i}, vertex).first->second;
            }
            _child.fVertices.back().push_back(vertex);
            if (vertex == int(_child.vertices.size())) {
                _child.vertices.emplace_back();
                _child.vertexOrigins.push_back({face.vertices[i], int(f), i});
            }
        }
    }
}

/// Finds the paths of the parent: those that it has, or those that begin there.
void Refinement::findBasePaths() {
    for (Face const &face : _parent.faces) {
        _pathsOut.push_back(face.pathsOut);
        _pathsIn.push_back(face.pathsIn);
        _pathsOut.back().resize(face.vertices.size());
        _pathsIn.back().resize(face.vertices.size());
    }
    for (std::size_t v = 0; v < _parent.vertices.size(); ++v) {
        TaggedMesh::Vertex const &vertex = _parent.vertices[v];
        bool const areQuads =
            std::all_of(vertex.corners.begin(), vertex.corners.end(), [&](Side corner) {
                return _parent.faces[corner.face].vertices.size() == 4;
            });
        bool isInside = _parent.numHexagonalSteps == 0 && areQuads && !vertex.isNonManifold;
        float sharpness = vertex.sharpness;
        for (Side corner : vertex.corners) {
            for (Side side : {corner, previousSide(_parent, corner)}) {
                Edge const &edge = _parent.edges[_parent.faces[side.face].edges[side.place]];
                isInside = isInside && edge.sides.size() == 2;
                sharpness = std::max(sharpness, edge.sharpness);
            }
        }
        if (!isInside || isInfinite(sharpness)) {
            continue;
        }
        std::size_t const size = vertex.corners.size();
        bool const hasKind = size >= 3 && size <= 6;
        for (Side corner : vertex.corners) {
            QuadPath const path = {hasKind ? std::to_string(size) : "o", sharpness};
            _pathsOut[corner.face][corner.place] = path;
            _pathsIn[corner.face][corner.place] = path;
        }
    }
}

/// In a face made for an edge: at the old vertices and the new points of a side.
template <typename PATH>
void Refinement::setPaths(std::vector<PATH> &out, std::vector<PATH> &in, PATH const &atStart,
                          PATH const &atEnd, int start, int end, int endPoint, int startPoint) {
    in[std::size_t(start)] = atStart.Append('3');
    out[std::size_t(end)] = atEnd.Append('3');
    out[std::size_t(endPoint)] = atEnd.Append('1');
    in[std::size_t(endPoint)] = atEnd.Append('2');
    out[std::size_t(startPoint)] = atStart.Append('2');
    in[std::size_t(startPoint)] = atStart.Append('1');
}

void Refinement::setPathsOfSide(int face, int start, int end, int endPoint, int startPoint,
                                Side side, bool areOfQuads) {
    Face &made = _child.faces[face];
    int const behind = nextSide(_parent, side).place;
    if (areOfQuads) {
        setPaths(made.pathsOut, made.pathsIn, _pathsOut[side.face][side.place],
                 _pathsIn[side.face][behind], start, end, endPoint, startPoint);
    }
    Face const &from = _parent.faces[side.face];
    if (!from.linesOut.empty()) {
        setPaths(made.linesOut, made.linesIn, from.linesOut[side.place], from.linesIn[behind],
                 start, end, endPoint, startPoint);
    }
}

void Refinement::makeFFaces() {
    for (std::size_t f = 0; f < _parent.faces.size(); ++f) {
        TaggedMesh::FaceOrigin origin;
        origin.face = int(f);
        addFace(_child.fVertices[f], _parent.faces[f].isHalf, _parent.faces[f].holes, origin);
        for (std::size_t i = 0; i < _pathsOut[f].size() && isHexagonal(); ++i) {
            _child.faces[f].pathsOut[i] = _pathsOut[f][i].Append('0');
            _child.faces[f].pathsIn[i] = _pathsIn[f][i].Append('0');
        }
        for (std::size_t i = 0; i < _parent.faces[f].linesOut.size() && isHexagonal(); ++i) {
            _child.faces[f].linesOut[i] = _parent.faces[f].linesOut[i].Append('0');
            _child.faces[f].linesIn[i] = _parent.faces[f].linesIn[i].Append('0');
        }
    }
    for (Edge const &edge : _parent.edges) {
        if (edge.isLong) {
            Edge child;
            for (Side side : edge.sides) {
                child.sides.push_back({side.face, 0});
                _placed.insert({side.face, 0});
            }
            child.isLong = true;
            child.line = edge.line;
            child.sharpness = decremented(edge.sharpness);
            child.regularLine = regularChild(edge);
            _child.edges.push_back(child);
        }
    }
}

void Refinement::makeEFaces() {
    for (std::size_t e = 0; e < _parent.edges.size(); ++e) {
        Edge const &edge = _parent.edges[e];
        if (edge.isLong || (!isHexagonal() && edge.sides.size() == 1)) {
            continue;
        }
        TaggedMesh::FaceOrigin origin;
        origin.edge = int(e);
        int const v0 = _parent.GetStart(edge.sides[0]);
        int const v1 = _parent.GetEnd(edge.sides[0]);
        int const a0 = fVertex(edge.sides[0]);
        int const a1 = fVertex(nextSide(_parent, edge.sides[0]));
        if (edge.sides.size() == 2 && edge.sharpness <= 0) {
            int const b1 = fVertex(edge.sides[1]);
            int const b0 = fVertex(nextSide(_parent, edge.sides[1]));
            bool const a = isHole(edge.sides[0]);
            bool const b = isHole(edge.sides[1]);
            if (isFlat(int(e))) {
                addFace({b0, b1, a1, a0}, false, std::vector<bool>(4, a && b), origin);
            } else {
                int const face = addFace({vVertex(v0), b0, b1, vVertex(v1), a1, a0}, false,
                                         {b, b, b, a, a, a}, origin);
                setPathsOfSide(face, 0, 3, 4, 5, edge.sides[0]);
                setPathsOfSide(face, 3, 0, 1, 2, edge.sides[1]);
            }
            continue;
        }
        // Half a hexagon for each side; their common edge is the line.
        Edge child;
        for (int s = 0; s < int(edge.sides.size()); ++s) {
            Side const side = edge.sides[s];
            origin.side = s;
            int const face =
                addFace({vVertex(_parent.GetStart(side)), vVertex(_parent.GetEnd(side)),
                         fVertex(nextSide(_parent, side)), fVertex(side)},
                        !edge.isFree, std::vector<bool>(4, isHole(side)), origin);
            child.sides.push_back({face, 0});
            _placed.insert({face, 0});
            if (!edge.isFree) {
                setPathsOfSide(face, 0, 1, 2, 3, side,
                               edge.sides.size() == 2 && !isInfinite(edge.sharpness));
            }
        }
        child.isFree = edge.isFree;
        child.line = edge.line;
        child.isLong = !edge.isFree;
        child.sharpness = isInfinite(edge.sharpness)
                              ? edge.sharpness
                              : 0.5f * (childSharpness(_parent, v0, edge.sharpness) +
                                        childSharpness(_parent, v1, edge.sharpness));
        if (edge.isFree) {
            child.sharpness = 0;
        }
        child.regularLine = regularChild(edge);
        _child.edges.push_back(child);
    }
}

void Refinement::makeVFaces() {
    bool const isCoplanar = isHexagonal() && !_step.flatEdges.empty();
    if ((isHexagonal() && !isCoplanar) || !_step.closeGaps) {
        return;
    }
    for (int v = 0; v < int(_parent.vertices.size()); ++v) {
        for (Fan const &fan : findFans(_parent, v)) {
            makeFanFaces(v, fan);
        }
    }
}

void Refinement::makeFanFaces(int vertex, Fan const &fan) {
    int const size = int(fan.corners.size());
    if (_step.scheme == ReferenceScheme::TriHex) {
        std::vector<int> vertices;
        for (Side corner : fan.corners) {
            vertices.push_back(fVertex(corner));
            vertices.push_back(fVertex(previousSide(_parent, corner)));
        }
        if (fan.isClosed) {
            addVFace(vertex, vertices, fan.corners);
        }
        return;
    }
    std::vector<int> points;
    for (Side corner : fan.corners) {
        points.push_back(fVertex(corner));
    }
    if (isFlatFan(fan)) {
        if (size > 2) {
            addVFace(vertex, points, fan.corners);
        }
        return;
    }
    if (!isHexagonal()) {
        return;
    }
    // From the first face of each run, behind an edge that is not flat, to its last.
    for (int first = 0; first < size; ++first) {
        bool const isFirst =
            (first == 0 && !fan.isClosed) || !isFlatBefore(fan.corners[(first + size - 1) % size]);
        std::vector<int> vertices{vVertex(vertex), points[first]};
        std::vector<Side> corners{fan.corners[first]};
        int last = first;
        while (isFirst && isFlatBefore(fan.corners[last])) {
            last = (last + 1) % size;
            vertices.push_back(points[last]);
            corners.push_back(fan.corners[last]);
        }
        if (vertices.size() > 2) {
            addVFace(vertex, vertices, corners);
        }
    }
}

void Refinement::addVFace(int vertex, std::vector<int> vertices, std::vector<Side> const &corners) {
    bool const isAllHole = std::all_of(corners.begin(), corners.end(), [&](Side corner) {
        return isHole(corner) && isHole(previousSide(_parent, corner));
    });
    TaggedMesh::FaceOrigin origin;
    origin.vertex = vertex;
    std::vector<bool> holes(vertices.size(), isAllHole);
    addFace(std::move(vertices), false, std::move(holes), origin);
}

/// All other edges end in a new vertex, so that their ends tell them apart.
void Refinement::joinSides() {
    std::map<std::pair<int, int>, std::vector<Side>> sides;
    for (std::size_t f = 0; f < _child.faces.size(); ++f) {
        std::vector<int> const &vertices = _child.faces[f].vertices;
        for (int i = 0; i < int(vertices.size()); ++i) {
            if (_placed.count({int(f), i}) == 0) {
                sides[pairOf(vertices[i], vertices[(i + 1) % vertices.size()])].push_back(
                    {int(f), i});
            }
        }
    }
    for (auto const &[ends, edgeSides] : sides) {
        Edge edge;
        edge.sides = edgeSides;
        // The end of a line: from an old vertex to the new one on the line.
        TaggedMesh::VertexOrigin const &start = _child.vertexOrigins[ends.first];
        TaggedMesh::VertexOrigin const &origin = _child.vertexOrigins[ends.second];
        if (start.face < 0 && _parent.faces[origin.face].isHalf && origin.place < 2) {
            Edge const &line = _parent.edges[_parent.faces[origin.face].edges[0]];
            edge.line = line.line;
            edge.sharpness = childSharpness(_parent, start.vertex, line.sharpness);
            for (SharpEdge const &other : sharpEdges(_parent, start.vertex)) {
                if (!other.isLong) {
                    edge.regularLine =
                        std::min(regularChild(line), regularChild(_parent.edges[other.edge]));
                }
            }
        } else if (edgeSides.size() == 1) {
            edge.isFree = isHexagonal() || _parent.freeBoundaries;
            edge.sharpness = edge.isFree ? 0 : kInfiniteSharpness;
        }
        _child.edges.push_back(edge);
    }
}

void Refinement::mergeSmoothHalves() {
    std::vector<int> replacedBy(_child.faces.size(), -1);
    std::vector<std::vector<int>> placesInWhole(_child.faces.size());
    std::vector<Edge> edges;
    for (Edge const &edge : _child.edges) {
        if (!edge.isLong || edge.sides.size() == 1 || edge.sharpness > 0) {
            edges.push_back(edge);
            continue;
        }
        int const first = edge.sides[0].face;
        int const second = edge.sides[1].face;
        // Vertex 0 of the first half, then what the second one has beside the line, and so on.
        auto const merge = [&](auto const &a, auto const &b, auto const &atStart,
                               auto const &atEnd) {
            auto result = a;
            result.assign(1, atStart);
            result.insert(result.end(), b.begin() + 2, b.end());
            result.push_back(atEnd);
            result.insert(result.end(), a.begin() + 2, a.end());
            return result;
        };
        Face &whole = _child.faces[first];
        Face const &other = _child.faces[second];
        int const end = int(other.vertices.size()) - 1; // of the line
        int const size = end + int(whole.vertices.size()) - 1;
        placesInWhole[first].push_back(0);
        for (int i = end; i < size; ++i) {
            placesInWhole[first].push_back(i);
        }
        placesInWhole[second].push_back(end);
        for (int i = 0; i < end; ++i) {
            placesInWhole[second].push_back(i);
        }
        whole.vertices =
            merge(whole.vertices, other.vertices, whole.vertices[0], whole.vertices[1]);
        whole.isHalf = false;
        whole.pathsOut =
            merge(whole.pathsOut, other.pathsOut, other.pathsOut[1], whole.pathsOut[1]);
        whole.pathsIn = merge(whole.pathsIn, other.pathsIn, whole.pathsIn[0], other.pathsIn[0]);
        whole.linesOut =
            merge(whole.linesOut, other.linesOut, other.linesOut[1], whole.linesOut[1]);
        whole.linesIn = merge(whole.linesIn, other.linesIn, whole.linesIn[0], other.linesIn[0]);
        bool const isHoleA = whole.holes[0];
        bool const isHoleB = other.holes[0];
        whole.holes.assign(std::size_t(size), isHoleA);
        std::fill_n(whole.holes.begin(), end, isHoleB);
        _child.faceOrigins[first].mergedWith = int(_child.mergedOrigins.size());
        _child.mergedOrigins.push_back(_child.faceOrigins[second]);
        replacedBy[second] = first;
        replacedBy[first] = first;
    }
    // Numbers without those that are gone.
    std::vector<int> numbers(_child.faces.size(), -1);
    std::vector<Face> faces;
    std::vector<TaggedMesh::FaceOrigin> origins;
    for (std::size_t f = 0; f < _child.faces.size(); ++f) {
        if (replacedBy[f] < 0 || replacedBy[f] == int(f)) {
            numbers[f] = int(faces.size());
            faces.push_back(_child.faces[f]);
            origins.push_back(_child.faceOrigins[f]);
        }
    }
    for (Edge &edge : edges) {
        for (Side &side : edge.sides) {
            if (replacedBy[side.face] >= 0) {
                side.place = placesInWhole[side.face][side.place];
                side.face = replacedBy[side.face];
            }
            side.face = numbers[side.face];
        }
    }
    _child.faces = std::move(faces);
    _child.faceOrigins = std::move(origins);
    _child.edges = std::move(edges);
}

/// Gaps part the faces of a vertex into several fans.
void Refinement::tagPartedVertices() {
    for (std::size_t v = 0; v < _child.vertices.size(); ++v) {
        TaggedMesh::Vertex &vertex = _child.vertices[v];
        if (!vertex.isNonManifold && findFans(_child, int(v)).size() > 1) {
            vertex.isNonManifold = true;
        }
    }
}

} // namespace

TaggedMesh Refine(TaggedMesh const &mesh, ReferenceStep const &step) {
    if (step.scheme == ReferenceScheme::Truncate) {
        return Truncate(mesh, step.cuts);
    }
    return Refinement(mesh, step).Run();
}

std::vector<bool> FindFlatEdges(TaggedMesh const &mesh, ReferenceValues const &positions,
                                double angleTolerance) {
    std::vector<Eigen::Vector3d> normals;
    for (Face const &face : mesh.faces) {
        Eigen::Vector3d const origin = positions.row(face.vertices[0]);
        Eigen::Vector3d normal = Eigen::Vector3d::Zero();
        double size = 0;
        for (std::size_t i = 0; i < face.vertices.size(); ++i) {
            std::size_t const next = (i + 1) % face.vertices.size();
            Eigen::Vector3d const p = positions.row(face.vertices[i]);
            Eigen::Vector3d const q = positions.row(face.vertices[next]);
            normal += (p - origin).cross(q - origin);
            size += (q - p).squaredNorm();
        }
        // A face without area has no normal, rounding errors aside.
        normals.push_back(normal.norm() > 1e-12 * size ? normal : Eigen::Vector3d::Zero());
    }
    auto isTagged = [&](int v) {
        return mesh.vertices[v].sharpness > 0 || mesh.vertices[v].isNonManifold;
    };
    std::vector<bool> result;
    for (Edge const &edge : mesh.edges) {
        bool isFlat = edge.sides.size() == 2 && edge.sharpness <= 0 &&
                      !isTagged(mesh.GetStart(edge.sides[0])) &&
                      !isTagged(mesh.GetEnd(edge.sides[0]));
        for (Side side : edge.sides) {
            isFlat = isFlat && !mesh.faces[side.face].isHalf && normals[side.face].norm() > 0;
        }
        if (isFlat) {
            Eigen::Vector3d const &a = normals[edge.sides[0].face];
            Eigen::Vector3d const &b = normals[edge.sides[1].face];
            double const angle = std::atan2(a.cross(b).norm(), a.dot(b));
            isFlat = angle <= angleTolerance * std::acos(-1.0) / 180;
        }
        result.push_back(isFlat);
    }
    return result;
}

} // namespace OpenSubdivHex::Regression

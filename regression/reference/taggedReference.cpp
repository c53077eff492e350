// SPDX-License-Identifier: Apache-2.0
#include "taggedReference.h"

#include "irregularReference.h"
#include "taggedRules.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace TaggedRules {

using Edge = TaggedMesh::Edge;
using Face = TaggedMesh::Face;

bool isInfinite(float sharpness) { return sharpness >= kInfiniteSharpness; }
bool isSemiSharp(float sharpness) { return sharpness > 0 && !isInfinite(sharpness); }

float decremented(float sharpness) {
    return isInfinite(sharpness) ? sharpness : std::max(0.0f, sharpness - 1);
}

void connect(TaggedMesh &mesh) {
    for (Face &face : mesh.faces) {
        face.edges.assign(face.vertices.size(), -1);
    }
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        for (Side side : mesh.edges[e].sides) {
            mesh.faces[side.face].edges[side.place] = int(e);
        }
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < mesh.faces[f].vertices.size(); ++i) {
            mesh.vertices[mesh.faces[f].vertices[i]].corners.push_back({int(f), int(i)});
        }
    }
}

int previousPlace(Face const &face, int place) {
    return (place + int(face.vertices.size()) - 1) % int(face.vertices.size());
}

Side nextSide(TaggedMesh const &mesh, Side side) {
    return {side.face, (side.place + 1) % int(mesh.faces[side.face].vertices.size())};
}

std::vector<SharpEdge> sharpEdges(TaggedMesh const &mesh, int vertex) {
    std::vector<SharpEdge> result;
    for (Side corner : mesh.vertices[vertex].corners) {
        Face const &face = mesh.faces[corner.face];
        int const out = face.edges[corner.place];
        int const before = previousPlace(face, corner.place);
        int const in = face.edges[before];
        auto add = [&](int e, int neighbor) {
            Edge const &edge = mesh.edges[e];
            if (edge.sharpness > 0) {
                result.push_back({e, neighbor, edge.isLong, edge.sharpness});
            }
        };
        add(out, mesh.GetEnd(corner));
        if (mesh.edges[in].sides.size() == 1) {
            add(in, face.vertices[before]);
        }
    }
    return result;
}

float childSharpness(TaggedMesh const &mesh, std::vector<SharpEdge> const &around,
                     float sharpness) {
    if (!mesh.chaikin || !isSemiSharp(sharpness)) {
        return decremented(sharpness);
    }
    float sum = 0;
    int count = 0;
    for (SharpEdge const &edge : around) {
        if (isSemiSharp(edge.sharpness)) {
            sum += edge.sharpness;
            ++count;
        }
    }
    if (count < 2) {
        return decremented(sharpness);
    }
    float const others = (sum - sharpness) / float(count - 1);
    return std::max(0.0f, 0.75f * sharpness + 0.25f * others - 1);
}

float childSharpness(TaggedMesh const &mesh, int vertex, float sharpness) {
    return childSharpness(mesh, sharpEdges(mesh, vertex), sharpness);
}

TaggedRule ruleOf(float vertexSharpness, std::size_t numSharpEdges) {
    if (vertexSharpness > 0 || numSharpEdges > 2) {
        return TaggedRule::Corner;
    }
    TaggedRule const rules[] = {TaggedRule::Smooth, TaggedRule::Dart, TaggedRule::Crease};
    return rules[numSharpEdges];
}

std::vector<SharpEdge> linesOf(TaggedMesh const &mesh, int vertex,
                               std::vector<SharpEdge> const &edges) {
    if (!mesh.vertices[vertex].isNonManifold) {
        return edges;
    }
    std::set<int> known;
    std::vector<SharpEdge> lines;
    for (SharpEdge const &edge : edges) {
        int const line = mesh.edges[edge.edge].line;
        if (line < 0 || known.insert(line).second) {
            lines.push_back(edge);
        }
    }
    return lines;
}

std::vector<RuleShare> ruleShares(TaggedMesh const &mesh, int v) {
    std::vector<SharpEdge> const all = sharpEdges(mesh, v);
    std::vector<SharpEdge> const lines = linesOf(mesh, v, all);
    float const sharpness = mesh.vertices[v].sharpness;
    float const childVertexSharpness = decremented(sharpness);
    TaggedRule const rule = ruleOf(sharpness, lines.size());

    // What gets smooth with this step counts by what is left of it.
    float sum = 0;
    int count = 0;
    if (sharpness > 0 && childVertexSharpness <= 0) {
        sum += sharpness;
        ++count;
    }
    std::vector<SharpEdge> left;
    for (SharpEdge const &line : lines) {
        if (childSharpness(mesh, all, line.sharpness) > 0) {
            left.push_back(line);
        } else {
            sum += line.sharpness;
            ++count;
        }
    }
    TaggedRule const childRule = ruleOf(childVertexSharpness, left.size());
    if (childRule == rule || count == 0) {
        return {{1, rule, lines}};
    }
    double const weight = std::min(1.0f, sum / float(count));
    return {{weight, rule, lines}, {1 - weight, childRule, left}};
}

std::vector<Fan> findFans(TaggedMesh const &mesh, int vertex) {
    using Place = std::pair<int, int>;
    // The corner behind the edge that comes in to a corner.
    auto nextAround = [&](Side corner) {
        Face const &face = mesh.faces[corner.face];
        int const before = previousPlace(face, corner.place);
        Edge const &edge = mesh.edges[face.edges[before]];
        if (edge.sides.size() == 1) {
            return Side{-1, -1};
        }
        bool const isFirst = edge.sides[0].face == corner.face && edge.sides[0].place == before;
        return edge.sides[isFirst ? 1 : 0];
    };
    std::vector<Fan> fans;
    std::set<Place> done;
    auto add = [&](Side start) {
        Fan fan{{}, false};
        Side corner = start;
        while (corner.face >= 0 && done.insert({corner.face, corner.place}).second) {
            fan.corners.push_back(corner);
            corner = nextAround(corner);
        }
        fan.isClosed = corner.face >= 0;
        if (!fan.corners.empty()) {
            fans.push_back(fan);
        }
    };
    for (Side corner : mesh.vertices[vertex].corners) {
        if (mesh.edges[mesh.faces[corner.face].edges[corner.place]].sides.size() == 1) {
            add(corner);
        }
    }
    for (Side corner : mesh.vertices[vertex].corners) {
        add(corner);
    }
    return fans;
}

} // namespace TaggedRules

using namespace TaggedRules;

namespace {

/// The two ends of an edge, the smaller first.
std::pair<int, int> pairOf(int v, int w) { return {std::min(v, w), std::max(v, w)}; }

} // namespace

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
            for (int place : {corner.place, previousPlace(face, corner.place)}) {
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
    return result;
}

namespace {

/// Builds the child of a mesh, first with all half faces apart.
class Refinement {
public:
    Refinement(TaggedMesh const &parent, ReferenceStep const &step) : _parent(parent), _step(step) {
        _child.chaikin = parent.chaikin;
        _child.freeBoundaries = parent.freeBoundaries;
        _child.madeBy = step.scheme;
        _child.numHexagonalSteps = isHexagonal() ? parent.numHexagonalSteps + 1 : 0;
    }

    TaggedMesh Run() {
        makeVertices();
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
    void makeFFaces();
    void makeEFaces();
    void makeVFaces();
    void makeFanFaces(int vertex, Fan const &fan);
    void addVFace(int vertex, std::vector<int> vertices, std::vector<Side> const &corners);
    void joinSides();
    void mergeSmoothHalves();
    void tagPartedVertices();

    bool isHole(Side side) const { return _parent.faces[side.face].holes[side.place]; }

    int addFace(std::vector<int> vertices, bool isHalf, std::vector<bool> holes,
                TaggedMesh::FaceOrigin origin) {
        Face face;
        face.vertices = std::move(vertices);
        face.isHalf = isHalf;
        face.holes = std::move(holes);
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
        return isFlat(face.edges[previousPlace(face, corner.place)]);
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

void Refinement::makeFFaces() {
    for (std::size_t f = 0; f < _parent.faces.size(); ++f) {
        TaggedMesh::FaceOrigin origin;
        origin.face = int(f);
        addFace(_child.fVertices[f], _parent.faces[f].isHalf, _parent.faces[f].holes, origin);
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
                addFace({vVertex(v0), b0, b1, vVertex(v1), a1, a0}, false, {b, b, b, a, a, a},
                        origin);
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
            Face const &face = _parent.faces[corner.face];
            vertices.push_back(fVertex(corner));
            vertices.push_back(fVertex({corner.face, previousPlace(face, corner.place)}));
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
        Face const &face = _parent.faces[corner.face];
        return isHole(corner) && isHole({corner.face, previousPlace(face, corner.place)});
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
        } else if (edgeSides.size() == 1) {
            edge.isFree = isHexagonal() || _parent.freeBoundaries;
            edge.sharpness = edge.isFree ? 0 : kInfiniteSharpness;
        }
        _child.edges.push_back(edge);
    }
}

void Refinement::mergeSmoothHalves() {
    std::vector<int> replacedBy(_child.faces.size(), -1);
    std::vector<int> placesInHexagon[2] = {{0, 3, 4, 5}, {3, 0, 1, 2}};
    std::vector<int> halfOf(_child.faces.size(), 0);
    std::vector<Edge> edges;
    for (Edge const &edge : _child.edges) {
        if (!edge.isLong || edge.sides.size() == 1 || edge.sharpness > 0) {
            edges.push_back(edge);
            continue;
        }
        int const first = edge.sides[0].face;
        int const second = edge.sides[1].face;
        std::vector<int> const a = _child.faces[first].vertices;
        std::vector<int> const b = _child.faces[second].vertices;
        _child.faces[first].vertices = {a[0], b[2], b[3], a[1], a[2], a[3]};
        _child.faces[first].isHalf = false;
        bool const isHoleA = _child.faces[first].holes[0];
        bool const isHoleB = _child.faces[second].holes[0];
        _child.faces[first].holes = {isHoleB, isHoleB, isHoleB, isHoleA, isHoleA, isHoleA};
        _child.faceOrigins[first].mergedWith = int(_child.mergedOrigins.size());
        _child.mergedOrigins.push_back(_child.faceOrigins[second]);
        replacedBy[second] = first;
        replacedBy[first] = first;
        halfOf[second] = 1;
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
                side.place = placesInHexagon[halfOf[side.face]][side.place];
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

/// How far new points in wide sectors are drawn to the vertex, by face and place.
using Pulls = std::map<std::pair<int, int>, double>;

/// The factor of a sector of \p size faces: P = factor * mask + (1 - factor) V.
double sectorFactor(ReferenceMask mask, double size) {
    double const c = std::cos(std::acos(-1.0) / size);
    return mask == ReferenceMask::Average ? 1 / (0.98 + 0.305 * c) : 1 / (1.31 + 0.515 * c);
}

/// How sharp the line is that has the face on one side only; 0 for whole faces.
double lineSharpness(TaggedMesh const &mesh, Face const &face) {
    return face.isHalf ? double(mesh.edges[face.edges[0]].sharpness) : 0;
}

/// Adds \p share of the pulls at a vertex as if all edges of less than \p threshold were smooth.
void addPulls(TaggedMesh const &mesh, ReferenceMask mask, int vertex, double threshold,
              double share, Pulls &pulls) {
    for (Side start : mesh.vertices[vertex].corners) {
        Face const &startFace = mesh.faces[start.face];
        Edge const &startEdge = mesh.edges[startFace.edges[start.place]];
        if (startEdge.sharpness < threshold) {
            continue;
        }
        // Counter-clockwise from one sharp edge to the next.
        std::vector<Side> corners;
        double size = 0;
        Side corner = start;
        Edge const *edge = nullptr;
        while (true) {
            Face const &face = mesh.faces[corner.face];
            corners.push_back(corner);
            size += face.isHalf && corner.place < 2 ? 0.5 : 1;
            int const before = previousPlace(face, corner.place);
            edge = &mesh.edges[face.edges[before]];
            if (edge->sharpness >= threshold || edge->sides.size() == 1) {
                break;
            }
            bool const isFirst =
                edge->sides[0].face == corner.face && edge->sides[0].place == before;
            corner = edge->sides[isFirst ? 1 : 0];
        }
        // All around, with one sharp edge, lies no sector; a boundary may end where it began.
        bool const isAllAround = edge == &startEdge && edge->sides.size() == 2;
        if (edge->sharpness < threshold || isAllAround || size < 3) {
            continue;
        }
        for (Side pulled : corners) {
            // Halves are one face while their line is smooth.
            if (lineSharpness(mesh, mesh.faces[pulled.face]) < threshold) {
                pulls[{pulled.face, pulled.place}] += share * (1 - sectorFactor(mask, size));
            }
        }
    }
}

/// An edge of sharpness s below 1 is sharp with share s and smooth with share 1 - s, the less sharp
/// edges whenever a sharper one is.
Pulls findPulls(TaggedMesh const &mesh, ReferenceMask mask) {
    std::set<double> thresholds{1};
    for (Edge const &edge : mesh.edges) {
        if (edge.sharpness > 0 && edge.sharpness < 1) {
            thresholds.insert(edge.sharpness);
        }
    }
    Pulls pulls;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        double last = 0;
        for (double threshold : thresholds) {
            addPulls(mesh, mask, int(v), threshold, threshold - last, pulls);
            last = threshold;
        }
    }
    return pulls;
}

/// What of a mesh follows the rules of Smooth for hexagons beside what is not of their lattice.
class Irregularities {
public:
    explicit Irregularities(TaggedMesh const &mesh) : _mesh(mesh) {}

    /// A vertex whose faces are four hexagons or more, each made for an edge.
    struct Vertex {
        int numFaces = 0;
        double share = 0; ///< of its rule: what is left by the sharpest thing at it
    };
    /// Of no faces for others.
    Vertex FindVertex(int vertex) const {
        TaggedMesh::Vertex const &tags = _mesh.vertices[vertex];
        double sharpness = tags.sharpness;
        double size = 0;
        for (Side corner : tags.corners) {
            Face const &face = _mesh.faces[corner.face];
            for (int place : {corner.place, previousPlace(face, corner.place)}) {
                Edge const &edge = _mesh.edges[face.edges[place]];
                sharpness = std::max(sharpness, double(edge.sharpness));
                if (edge.sides.size() == 1) {
                    return {};
                }
            }
            if (!isMadeForEdge(corner.face) || (!face.isHalf && face.vertices.size() != 6)) {
                return {};
            }
            size += face.isHalf ? 0.5 : 1;
        }
        bool const isIrregular = _mesh.numHexagonalSteps > 0 &&
                                 _mesh.vertexOrigins[vertex].face < 0 && !tags.isNonManifold &&
                                 size >= 4 && sharpness < 1;
        return isIrregular ? Vertex{int(size), 1 - sharpness} : Vertex();
    }

    /// \brief \p plain, with the rules' share at corner \p i of a hexagon.
    ///
    /// \param hexagon    its points
    /// \param corners    where its corners are in faces: in two halves, one of those on the line
    /// \param sharpness  of the line between two halves, else 0
    Point Apply(std::vector<Point> const &hexagon, std::vector<Side> const &corners,
                double sharpness, int i, Point const &plain) const {
        if (_mesh.numHexagonalSteps == 0 || !isMadeForEdge(corners[0].face)) {
            return plain;
        }
        for (int edge : {i, (i + 5) % 6}) {
            if (isQuad(across(corners[edge]))) {
                double const share = std::max(0.0, 1 - sharpness);
                if (auto const point =
                        NewPointBesideQuad(_mesh.numHexagonalSteps, hexagon, i, edge)) {
                    return share > 0 ? Point(share * *point + (1 - share) * plain) : plain;
                }
            }
        }
        for (int corner : {i, (i + 1) % 6, (i + 5) % 6}) {
            Vertex const vertex = FindVertex(_mesh.GetStart(corners[corner]));
            if (vertex.numFaces > 0) {
                IrregularRule const rule =
                    MakeIrregularRule(vertex.numFaces, _mesh.numHexagonalSteps);
                return vertex.share * NewIrregularPoint(rule, hexagon, i, corner) +
                       (1 - vertex.share) * plain;
            }
        }
        return plain;
    }

private:
    bool isMadeForEdge(int face) const {
        return !_mesh.faceOrigins.empty() && _mesh.faceOrigins[face].edge >= 0;
    }
    /// The face on the other side of the edge that starts at a corner, or -1.
    int across(Side corner) const {
        Edge const &edge = _mesh.edges[_mesh.faces[corner.face].edges[corner.place]];
        if (edge.sides.size() == 1) {
            return -1;
        }
        bool const isFirst =
            edge.sides[0].face == corner.face && edge.sides[0].place == corner.place;
        return edge.sides[isFirst ? 1 : 0].face;
    }
    /// The smaller copy of a quad.
    bool isQuad(int face) const {
        return face >= 0 && _mesh.faceOrigins[face].face >= 0 && !_mesh.faces[face].isHalf &&
               _mesh.faces[face].vertices.size() == 4;
    }

    TaggedMesh const &_mesh;
};

class Interpolation {
public:
    Interpolation(TaggedMesh const &mesh, TaggedMesh const &child, ReferenceMask mask,
                  bool isVarying, ReferenceValues const &values)
        : _mesh(mesh), _child(child), _mask(mask), _isVarying(isVarying), _values(values),
          _irregularities(mesh), _result(child.vertexOrigins.size(), values.cols()) {}

    ReferenceValues Run() {
        bool const isPlain = _isVarying || _child.madeBy != ReferenceScheme::Hexagonal;
        Pulls const pulls = isPlain ? Pulls() : findPulls(_mesh, _mask);
        for (std::size_t v = 0; v < _child.vertexOrigins.size(); ++v) {
            TaggedMesh::VertexOrigin const &origin = _child.vertexOrigins[v];
            if (origin.face < 0) {
                continue;
            }
            auto const pull = pulls.find({origin.face, origin.place});
            double const towards = pull != pulls.end() ? pull->second : 0;
            _result.row(Eigen::Index(v)) =
                cornerPoint({origin.face, origin.place}, towards, _values.row(origin.vertex));
        }
        for (std::size_t v = 0; v < _mesh.vertices.size(); ++v) {
            if (_child.vVertices[v] >= 0) {
                _result.row(_child.vVertices[v]) =
                    _isVarying ? Point(_values.row(Eigen::Index(v))) : movedVertex(int(v));
            }
        }
        return std::move(_result);
    }

private:
    Point maskPoint(std::vector<Point> const &face, int i) const {
        return _isVarying ? NewVaryingPoint(face, i) : NewPoint(_mask, face, i);
    }

    std::vector<Point> pointsOf(std::vector<int> const &vertices) const {
        std::vector<Point> points;
        for (int v : vertices) {
            points.push_back(_values.row(v));
        }
        return points;
    }

    /// The share \p towards of the smooth mask is replaced by \p vertex.
    Point cornerPoint(Side corner, double towards, Point const &vertex) const {
        Face const &face = _mesh.faces[corner.face];
        if (_child.madeBy == ReferenceScheme::TriHex) {
            return edgePoint(pointsOf(face.vertices), corner.place);
        }
        if (!face.isHalf) {
            std::vector<Point> const points = pointsOf(face.vertices);
            Point const plain = towards * vertex + (1 - towards) * maskPoint(points, corner.place);
            if (!hasIrregularRules() || points.size() != 6) {
                return plain;
            }
            std::vector<Side> corners;
            for (int i = 0; i < 6; ++i) {
                corners.push_back({corner.face, i});
            }
            return _irregularities.Apply(points, corners, 0, corner.place, plain);
        }
        Edge const &line = _mesh.edges[face.edges[0]];
        if (line.sides.size() == 1) {
            return halfPoint(face, corner.place);
        }
        // The hexagon that the two halves make: V, R, S, W, Q, P.
        bool const isFirst = line.sides[0].face == corner.face;
        Face const &other = _mesh.faces[line.sides[isFirst ? 1 : 0].face];
        std::vector<int> const &own = face.vertices;
        std::vector<Point> const hexagon =
            pointsOf({own[0], other.vertices[2], other.vertices[3], own[1], own[2], own[3]});
        int const places[] = {0, 3, 4, 5};
        Point const smooth = maskPoint(hexagon, places[corner.place]);
        double const sharp = _isVarying ? 0 : std::min(1.0, double(line.sharpness));
        Point const plain = sharp * halfPoint(face, corner.place) + towards * vertex +
                            (1 - sharp - towards) * smooth;
        if (!hasIrregularRules()) {
            return plain;
        }
        int const self = corner.face;
        int const partner = line.sides[isFirst ? 1 : 0].face;
        return _irregularities.Apply(
            hexagon, {{partner, 1}, {partner, 2}, {partner, 3}, {self, 1}, {self, 2}, {self, 3}},
            line.sharpness, places[corner.place], plain);
    }

    bool hasIrregularRules() const {
        return !_isVarying && _mask == ReferenceMask::Smooth &&
               _child.madeBy == ReferenceScheme::Hexagonal;
    }

    /// Beside the edge that starts at a corner.
    static Point edgePoint(std::vector<Point> const &face, int place) {
        Point centroid = Point::Zero(face[0].size());
        for (Point const &point : face) {
            centroid += point / double(face.size());
        }
        return (face[place] + face[(place + 1) % face.size()] + centroid) / 3;
    }

    Point halfPoint(Face const &face, int place) const {
        std::vector<Point> const points = pointsOf(face.vertices);
        Point const &v = points[0];
        Point const &w = points[1];
        Point const &q = points[2];
        Point const &p = points[3];
        if (place == 0) {
            return (3 * v + w) / 4;
        }
        if (place == 1) {
            return (v + 3 * w) / 4;
        }
        Point const qGhost = (3 * v + w) / 2 - p;
        Point const pGhost = (v + 3 * w) / 2 - q;
        return maskPoint({v, qGhost, pGhost, w, q, p}, place == 2 ? 4 : 5);
    }

    Point smoothVertex(int v) const {
        std::set<int> around;
        for (Side corner : _mesh.vertices[v].corners) {
            around.insert(_child.fVertices[corner.face][corner.place]);
        }
        Point sum = _values.row(v);
        for (int vertex : around) {
            sum += _result.row(vertex);
        }
        Point const plain = sum / double(around.size() + 1);
        Irregularities::Vertex const irregular =
            hasIrregularRules() ? _irregularities.FindVertex(v) : Irregularities::Vertex();
        if (irregular.numFaces == 0) {
            return plain;
        }
        double const weight =
            MakeIrregularRule(irregular.numFaces, _mesh.numHexagonalSteps).meanWeight;
        Point const old = _values.row(v);
        Point const mean = (sum - old) / double(around.size());
        return irregular.share * ((1 - weight) * old + weight * mean) +
               (1 - irregular.share) * plain;
    }

    Point creaseVertex(int v, SharpEdge a, SharpEdge b) const {
        Point const vertex = _values.row(v);
        Point const atA = _values.row(a.neighbor);
        Point const atB = _values.row(b.neighbor);
        if (a.isLong && b.isLong) {
            return (26 * vertex + 3 * atA + 3 * atB) / 32;
        }
        if (!a.isLong && !b.isLong) {
            return (6 * vertex + atA + atB) / 8;
        }
        return a.isLong ? Point((5 * vertex + atA + 2 * atB) / 8)
                        : Point((5 * vertex + 2 * atA + atB) / 8);
    }

    Point vertexByRule(int v, TaggedRule rule, std::vector<SharpEdge> const &edges) const {
        switch (rule) {
        case TaggedRule::Corner:
            return _values.row(v);
        case TaggedRule::Crease:
            return creaseVertex(v, edges[0], edges[1]);
        case TaggedRule::Smooth:
        case TaggedRule::Dart:
            break;
        }
        return smoothVertex(v);
    }

    Point movedVertex(int v) const {
        Point point = Point::Zero(_values.cols());
        for (RuleShare const &share : ruleShares(_mesh, v)) {
            point += share.weight * vertexByRule(v, share.rule, share.lines);
        }
        return point;
    }

    TaggedMesh const &_mesh;
    TaggedMesh const &_child;
    ReferenceMask _mask;
    bool _isVarying;
    ReferenceValues const &_values;
    Irregularities const _irregularities;
    ReferenceValues _result;
};

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

TaggedRule GetRule(TaggedMesh const &mesh, int vertex) {
    return ruleOf(mesh.vertices[vertex].sharpness,
                  linesOf(mesh, vertex, sharpEdges(mesh, vertex)).size());
}

bool IsPinned(TaggedMesh const &mesh, int vertex) {
    std::vector<SharpEdge> const lines = linesOf(mesh, vertex, sharpEdges(mesh, vertex));
    return isInfinite(mesh.vertices[vertex].sharpness) ||
           std::count_if(lines.begin(), lines.end(),
                         [](SharpEdge const &line) { return isInfinite(line.sharpness); }) > 2;
}

ReferenceValues Interpolate(TaggedMesh const &mesh, TaggedMesh const &child, ReferenceMask mask,
                            ReferenceValues const &values) {
    if (child.madeBy == ReferenceScheme::Truncate) {
        return InterpolateTruncation(mesh, child, false, values);
    }
    return Interpolation(mesh, child, mask, false, values).Run();
}

ReferenceValues InterpolateVarying(TaggedMesh const &mesh, TaggedMesh const &child,
                                   ReferenceValues const &values) {
    if (child.madeBy == ReferenceScheme::Truncate) {
        return InterpolateTruncation(mesh, child, true, values);
    }
    return Interpolation(mesh, child, ReferenceMask::Average, true, values).Run();
}

} // namespace OpenSubdivHex::Regression

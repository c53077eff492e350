// SPDX-License-Identifier: Apache-2.0
#include "lineReference.h"
#include "taggedRules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace OpenSubdivHex::Regression {

using namespace TaggedRules;

namespace {

Edge const &edgeOf(TaggedMesh const &mesh, Side side) {
    return mesh.edges[mesh.faces[side.face].edges[side.place]];
}

} // namespace

ReferenceCuts FindCuts(TaggedMesh const &mesh, std::vector<TaggedMesh> const &values) {
    ReferenceCuts result;
    for (Face const &face : mesh.faces) {
        result.cuts.emplace_back(face.vertices.size(), false);
        result.isPassed.emplace_back(face.vertices.size(), false);
    }
    auto const parts = [&](Side side) {
        std::vector<Side> const &sides = edgeOf(mesh, side).sides;
        if (sides.size() == 1) {
            return true;
        }
        bool isParting = mesh.faces[sides[0].face].holes[0] != mesh.faces[sides[1].face].holes[0];
        for (TaggedMesh const &valueMesh : values) {
            isParting = isParting || edgeOf(valueMesh, side).sides.size() == 1;
        }
        return isParting;
    };
    for (int v = 0; v < int(mesh.vertices.size()); ++v) {
        bool const isSharp = mesh.vertices[v].sharpness > 0 || mesh.vertices[v].isNonManifold;
        std::vector<Fan> const fans = findFans(mesh, v);
        for (Fan const &fan : fans) {
            std::vector<Side> parting;
            std::vector<Side> all; // with creases
            for (Side corner : fan.corners) {
                if (parts(corner)) {
                    parting.push_back(corner);
                }
                if (parts(corner) || edgeOf(mesh, corner).sharpness > 0) {
                    all.push_back(corner);
                }
            }
            bool const isOneSector = fan.isClosed && all.size() < 2;
            if (isOneSector && (isSharp || !parting.empty() || fan.corners.size() == 2)) {
                all = fan.corners;
            } else if (isOneSector) {
                all.clear(); // a dart at most
            }
            for (Side corner : all) {
                result.cuts[corner.face][corner.place] = true;
            }
        }
        // A line goes through a vertex with two to 64 faces on each side where nothing else is.
        bool isPassed = fans.size() == 1 && !isSharp && GetRule(mesh, v) == TaggedRule::Crease;
        if (isPassed) {
            std::vector<Side> const &corners = fans[0].corners;
            std::vector<int> ends;
            for (int i = 0; i < int(corners.size()); ++i) {
                if (result.cuts[corners[i].face][corners[i].place]) {
                    ends.push_back(i);
                }
                for (TaggedMesh const &valueMesh : values) {
                    isPassed = isPassed &&
                               valueMesh.vertices[valueMesh.GetStart(corners[i])].sharpness == 0;
                }
            }
            int const size = int(corners.size());
            if (!fans[0].isClosed) {
                isPassed = isPassed && ends.size() == 1 && 2 <= size && size <= 64;
            } else if (ends.size() != 2) {
                isPassed = false;
            } else {
                int const before = ends[1] - ends[0];
                isPassed = isPassed && 2 <= before && before <= 64 && 2 <= size - before &&
                           size - before <= 64;
                // Faces that are kept apart must stay so.
                for (int end : ends) {
                    bool const isForEver =
                        edgeOf(mesh, corners[ends[0]]).sharpness >= kInfiniteSharpness &&
                        edgeOf(mesh, corners[ends[1]]).sharpness >= kInfiniteSharpness;
                    isPassed = isPassed && (isForEver || !parts(corners[end]));
                }
                for (TaggedMesh const &valueMesh : values) {
                    bool const isSeam[] = {edgeOf(valueMesh, corners[ends[0]]).sides.size() == 1,
                                           edgeOf(valueMesh, corners[ends[1]]).sides.size() == 1};
                    isPassed = isPassed && isSeam[0] == isSeam[1];
                }
            }
        }
        for (Side corner : mesh.vertices[v].corners) {
            result.isPassed[corner.face][corner.place] = isPassed;
        }
    }
    return result;
}

namespace {

/// Builds the truncation of a mesh face by face, with the sides of each edge by what it is.
class Truncation {
public:
    Truncation(TaggedMesh const &parent, ReferenceCuts const &cuts) : _parent(parent), _cuts(cuts) {
        _child.chaikin = parent.chaikin;
        _child.freeBoundaries = parent.freeBoundaries;
        _child.madeBy = ReferenceScheme::Truncate;
        _child.hasFirstLines = false;
    }

    TaggedMesh Run() {
        makeVertices();
        for (int f = 0; f < int(_parent.faces.size()); ++f) {
            makeFFace(f);
        }
        for (int v = 0; v < int(_parent.vertices.size()); ++v) {
            for (Fan const &fan : findFans(_parent, v)) {
                makeVFaces(v, fan);
            }
        }
        for (auto const &[key, edge] : _edges) {
            _child.edges.push_back(edge);
        }
        connect(_child);
        BeginRegularLines(_child);
        return std::move(_child);
    }

private:
    /// Kinds of edges: beside a corner, along an edge, from a vertex to a new one on an edge, or through the
    /// polygon of a vertex.
    enum Kind { BesideCorner, AlongEdge, Spoke, Through };
    using Key = std::array<int, 3>;

    bool isCutBefore(Side corner) const { return _cuts.cuts[corner.face][corner.place]; }

    bool isPassed(int v) const {
        std::vector<Side> const &corners = _parent.vertices[v].corners;
        return !corners.empty() && _cuts.isPassed[corners[0].face][corners[0].place];
    }

    bool isKept(int v) const {
        std::vector<Side> const &corners = _parent.vertices[v].corners;
        if (isPassed(v)) {
            return false;
        }
        return corners.empty() || std::any_of(corners.begin(), corners.end(), [&](Side corner) {
                   return isCutBefore(corner) ||
                          edgeOf(_parent, previousSide(_parent, corner)).sides.size() == 1;
               });
    }

    int addVertex(TaggedMesh::VertexOrigin const &origin) {
        _child.vertices.emplace_back();
        _child.vertexOrigins.push_back(origin);
        return int(_child.vertices.size()) - 1;
    }

    void makeVertices() {
        for (int v = 0; v < int(_parent.vertices.size()); ++v) {
            _child.vVertices.push_back(isKept(v) ? addVertex({v, -1, -1}) : -1);
            if (isKept(v)) {
                _child.vertices.back().sharpness = decremented(_parent.vertices[v].sharpness);
                _child.vertices.back().isNonManifold = _parent.vertices[v].isNonManifold;
            }
        }
        for (int f = 0; f < int(_parent.faces.size()); ++f) {
            _child.fVertices.emplace_back();
            for (int i = 0; i < int(_parent.faces[f].vertices.size()); ++i) {
                Side const side = {f, i};
                _child.fVertices.back().push_back(addVertex({_parent.GetStart(side), f, i}));
                if (edgeOf(_parent, side).sides.size() == 1) {
                    _far[{f, i}] = addVertex({_parent.GetEnd(side), f, i, true});
                }
            }
        }
    }

    int nearVertex(Side side) const { return _child.fVertices[side.face][side.place]; }
    int farVertex(Side side) const {
        std::vector<Side> const &sides = edgeOf(_parent, side).sides;
        if (sides.size() == 1) {
            return _far.at({side.face, side.place});
        }
        bool const isFirst = sides[0].face == side.face && sides[0].place == side.place;
        return nearVertex(sides[isFirst ? 1 : 0]);
    }

    void addFace(std::vector<int> vertices, std::vector<Key> const &keys, bool isHalf, bool isHole,
                 TaggedMesh::FaceOrigin const &origin) {
        Face face;
        face.isHalf = isHalf;
        face.vertices = std::move(vertices);
        face.holes.assign(face.vertices.size(), isHole);
        for (int i = 0; i < int(keys.size()); ++i) {
            auto const [place, isNew] = _edges.try_emplace(keys[i]);
            if (isNew) {
                place->second = makeEdge(keys[i]);
            }
            place->second.sides.push_back({int(_child.faces.size()), i});
        }
        _child.faces.push_back(face);
        _child.faceOrigins.push_back(origin);
    }

    /// Where a line passes a vertex, that of its less sharp end.
    float sharpnessThrough(int v) const {
        float result = kInfiniteSharpness;
        for (SharpEdge const &edge : sharpEdges(_parent, v)) {
            float const atVertex = isInfinite(edge.sharpness)
                                       ? edge.sharpness
                                       : childSharpness(_parent, v, edge.sharpness);
            result = std::min(result, atVertex);
        }
        return result;
    }

    /// The tags of a new edge.
    Edge makeEdge(Key const &key) const {
        Edge result;
        if (key[0] == BesideCorner) {
            return result;
        }
        if (key[0] == Through) {
            result.isLong = true;
            result.sharpness = sharpnessThrough(key[1]);
            return result;
        }
        Edge const &edge = _parent.edges[key[1]];
        result.isFree = edge.isFree;
        result.line = edge.line;
        if (key[0] == Spoke) {
            int const v = _child.vertexOrigins[key[2]].vertex;
            result.sharpness = childSharpness(_parent, v, edge.sharpness);
        } else {
            int const v = _parent.GetStart(edge.sides[0]);
            int const w = _parent.GetEnd(edge.sides[0]);
            result.sharpness = 0.5f * (childSharpness(_parent, v, edge.sharpness) +
                                       childSharpness(_parent, w, edge.sharpness));
        }
        if (edge.sharpness >= kInfiniteSharpness) {
            result.sharpness = edge.sharpness;
        }
        return result;
    }

    void makeFFace(int f) {
        std::vector<int> vertices;
        std::vector<Key> keys;
        for (int i = 0; i < int(_parent.faces[f].vertices.size()); ++i) {
            vertices.push_back(farVertex(previousSide(_parent, {f, i})));
            keys.push_back({BesideCorner, f, i});
            vertices.push_back(nearVertex({f, i}));
            keys.push_back({AlongEdge, _parent.faces[f].edges[i], 0});
        }
        TaggedMesh::FaceOrigin origin;
        origin.face = f;
        addFace(vertices, keys, false, _parent.faces[f].holes[0], origin);
    }

    void makeVFaces(int v, Fan const &fan) {
        std::vector<Side> corners = fan.corners;
        auto const isCut = [this](Side corner) { return isCutBefore(corner); };
        auto const first = std::find_if(corners.begin(), corners.end(), isCut);
        bool const isSmooth = isPassed(v) && sharpnessThrough(v) <= 0;
        if (first == corners.end()) {
            makeVFace(v, corners, false);
            return;
        }
        std::rotate(corners.begin(), first, corners.end());
        if (isSmooth && fan.isClosed) { // its halves are one
            makeVFace(v, corners, false);
            return;
        }
        std::vector<Side> sector;
        for (Side corner : corners) {
            if (isCut(corner) && !sector.empty()) {
                makeVFace(v, sector, true);
                sector.clear();
            }
            sector.push_back(corner);
        }
        makeVFace(v, sector, true);
    }

    void makeVFace(int v, std::vector<Side> const &corners, bool isSector) {
        std::vector<int> vertices;
        std::vector<Key> keys;
        bool const isHalf = isSector && isPassed(v);
        Side const last = previousSide(_parent, corners.back());
        if (isHalf) {
            vertices.push_back(farVertex(last));
            keys.push_back({Through, v, 0});
        }
        for (Side corner : corners) {
            vertices.push_back(nearVertex(corner));
            keys.push_back({BesideCorner, corner.face, corner.place});
        }
        if (isSector && !isHalf) {
            vertices.push_back(farVertex(last));
            keys.push_back({Spoke, _parent.faces[last.face].edges[last.place], farVertex(last)});
            vertices.push_back(_child.vVertices[v]);
            Side const start = corners.front();
            keys.push_back(
                {Spoke, _parent.faces[start.face].edges[start.place], nearVertex(start)});
        }
        TaggedMesh::FaceOrigin origin;
        origin.vertex = v;
        bool const isHole = std::all_of(corners.begin(), corners.end(), [this](Side corner) {
            return _parent.faces[corner.face].holes[0];
        });
        addFace(vertices, keys, isHalf, isHole, origin);
        if (!isSector && isPassed(v)) {
            for (std::size_t i = 0; i < corners.size(); ++i) {
                _child.faces.back().holes[i] = _parent.faces[corners[i].face].holes[0];
            }
        }
    }

    TaggedMesh const &_parent;
    ReferenceCuts const &_cuts;
    TaggedMesh _child;
    std::map<std::pair<int, int>, int> _far; ///< by face and place of boundaries
    std::map<Key, Edge> _edges;
};

/// T = v V + b (G + G') + c (the mean of the centroids around V), of a vertex with as many faces; and
/// what a vertex on a line has of V_l - 2 V + V_r.
struct Weights {
    double v, b, c;
    double line = 0;
};

Weights weightsOf(int numFaces) {
    switch (numFaces) {
    case 3:
        return {0, 27.0 / 64, 5.0 / 32};
    case 4:
        return {1.0 / 32, 3.0 / 8, 7.0 / 32};
    case 5:
        return {1.0 / 14, 5.0 / 14, 3.0 / 14};
    case 6:
        return {1.0 / 6, 1.0 / 3, 1.0 / 6};
    case 7:
        return {1.0 / 4, 5.0 / 16, 1.0 / 8};
    case 8:
        return {5.0 / 16, 19.0 / 64, 3.0 / 32};
    default:
        double const b = std::min(0.5, (4 - 2 * std::cos(2 * std::acos(-1.0) / numFaces)) / 9);
        return {1 - 2 * b, b, 0};
    }
}

class TruncatedValues {
public:
    TruncatedValues(TaggedMesh const &mesh, bool isVarying, ReferenceValues const &values)
        : _mesh(mesh), _isVarying(isVarying), _values(values) {}

    Point MakeVertex(int v) const {
        Point const vertex = _values.row(v);
        if (_isVarying || _mesh.vertices[v].corners.empty()) {
            return vertex;
        }
        Point result = Point::Zero(_values.cols());
        for (RuleShare const &share : ruleShares(_mesh, v)) {
            switch (share.rule) {
            case TaggedRule::Corner:
                result += share.weight * vertex;
                break;
            case TaggedRule::Crease:
                result +=
                    share.weight * curvePoint(v, share.lines[0].neighbor, share.lines[1].neighbor);
                break;
            case TaggedRule::Smooth:
            case TaggedRule::Dart:
                result += share.weight * smoothPoint(v);
                break;
            }
        }
        return result;
    }

    Point MakeEdgePoint(TaggedMesh::VertexOrigin const &origin) const {
        Side const side = {origin.face, origin.place};
        int const other = origin.isFar ? _mesh.GetStart(side) : _mesh.GetEnd(side);
        Point const vertex = _values.row(origin.vertex);
        Point const onLine = (2 * vertex + _values.row(other)) / 3;
        Edge const &edge = edgeOf(_mesh, side);
        if (_isVarying || edge.sides.size() == 1 || edge.sharpness >= 1) {
            return onLine;
        }
        Weights const weights = findWeights(origin.vertex, side);
        Point const beside = centroid(edge.sides[0].face) + centroid(edge.sides[1].face);
        Point const smooth = weights.v * vertex + weights.b * beside +
                             weights.c * meanAround(origin.vertex) +
                             weights.line * bendAlongLine(origin.vertex);
        double const sharp = std::max(0.0f, edge.sharpness);
        return sharp * onLine + (1 - sharp) * smooth;
    }

private:
    Point centroid(int face) const {
        Point sum = Point::Zero(_values.cols());
        for (int v : _mesh.faces[face].vertices) {
            sum += _values.row(v);
        }
        return sum / double(_mesh.faces[face].vertices.size());
    }

    Point curvePoint(int v, int left, int right) const {
        return (7 * _values.row(v) + _values.row(left) + _values.row(right)) / 9;
    }

    /// Where the boundaries around a vertex that is on one lead.
    std::vector<int> boundaryEnds(int v) const {
        std::vector<int> ends;
        for (Side corner : _mesh.vertices[v].corners) {
            if (edgeOf(_mesh, corner).sides.size() == 1) {
                ends.push_back(_mesh.GetEnd(corner));
            }
            Side const in = previousSide(_mesh, corner);
            if (edgeOf(_mesh, in).sides.size() == 1) {
                ends.push_back(_mesh.GetStart(in));
            }
        }
        return ends;
    }

    Point smoothPoint(int v) const {
        if (std::vector<int> const ends = boundaryEnds(v); !ends.empty()) {
            return curvePoint(v, ends[0], ends[1]);
        }
        double const own = weightsOf(int(_mesh.vertices[v].corners.size())).v;
        return own * _values.row(v) + (1 - own) * meanAround(v);
    }

    /// V_l - 2 V + V_r by the shares of the rules that know such neighbors.
    Point bendAlongLine(int v) const {
        Point result = Point::Zero(_values.cols());
        std::vector<int> const ends = boundaryEnds(v);
        for (RuleShare const &share : ruleShares(_mesh, v)) {
            Point const twice = 2 * _values.row(v);
            if (share.rule == TaggedRule::Crease) {
                result += share.weight * (_values.row(share.lines[0].neighbor) +
                                          _values.row(share.lines[1].neighbor) - twice);
            } else if (share.rule != TaggedRule::Corner && !ends.empty()) {
                result += share.weight * (_values.row(ends[0]) + _values.row(ends[1]) - twice);
            }
        }
        return result;
    }

    Point meanAround(int v) const {
        Point sum = Point::Zero(_values.cols());
        for (Side corner : _mesh.vertices[v].corners) {
            sum += centroid(corner.face);
        }
        return sum / double(_mesh.vertices[v].corners.size());
    }

    double smoothShare(int v) const {
        double sum = 0;
        for (RuleShare const &share : ruleShares(_mesh, v)) {
            bool const isSmooth =
                share.rule == TaggedRule::Smooth || share.rule == TaggedRule::Dart;
            sum += isSmooth && boundaryEnds(v).empty() ? share.weight : 0;
        }
        return sum;
    }

    /// Weights of the new vertex on the edge that begins in a corner of a vertex.
    Weights findWeights(int v, Side corner) const {
        double const smooth = smoothShare(v);
        Weights const whole = weightsOf(int(_mesh.vertices[v].corners.size()));
        for (Fan const &fan : findFans(_mesh, v)) {
            int const size = int(fan.corners.size());
            int at = 0;
            while (at < size && !(fan.corners[at].face == corner.face &&
                                  fan.corners[at].place == corner.place)) {
                ++at;
            }
            if (at == size) {
                continue;
            }
            // Edge number i is before face number i; an open fan ends with one more.
            auto const isSharp = [&](int i) {
                int const k = (i % size + size) % size;
                return (!fan.isClosed && i == size) ||
                       edgeOf(_mesh, fan.corners[k]).sharpness > 0 ||
                       edgeOf(_mesh, fan.corners[k]).sides.size() == 1;
            };
            int end = at + 1;
            while (end < at + size && !isSharp(end)) {
                ++end;
            }
            int begin = at - 1;
            while (begin > at - size && !isSharp(begin)) {
                --begin;
            }
            int const count = end - begin;
            bool const isAllAround = fan.isClosed && count >= size;
            Weights const mirrored = weightsOf(isAllAround ? size : 2 * count);
            double const b = smooth * whole.b + (1 - smooth) * mirrored.b;
            return {1 - 2 * b - smooth * whole.c, b, smooth * whole.c, mirrored.c / 6};
        }
        return whole;
    }

    TaggedMesh const &_mesh;
    bool _isVarying;
    ReferenceValues const &_values;
};

} // namespace

TaggedMesh Truncate(TaggedMesh const &mesh, ReferenceCuts const &cuts) {
    return Truncation(mesh, cuts).Run();
}

ReferenceValues InterpolateTruncation(TaggedMesh const &mesh, TaggedMesh const &child,
                                      bool isVarying, ReferenceValues const &values) {
    TruncatedValues const truncated(mesh, isVarying, values);
    ReferenceValues result(child.vertexOrigins.size(), values.cols());
    for (std::size_t v = 0; v < child.vertexOrigins.size(); ++v) {
        TaggedMesh::VertexOrigin const &origin = child.vertexOrigins[v];
        result.row(Eigen::Index(v)) =
            origin.face < 0 ? truncated.MakeVertex(origin.vertex) : truncated.MakeEdgePoint(origin);
    }
    return result;
}

} // namespace OpenSubdivHex::Regression

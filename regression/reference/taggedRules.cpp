// SPDX-License-Identifier: Apache-2.0
#include "taggedRules.h"

#include <algorithm>
#include <set>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace TaggedRules {

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

std::pair<int, int> pairOf(int v, int w) { return {std::min(v, w), std::max(v, w)}; }

Side previousSide(TaggedMesh const &mesh, Side side) {
    int const size = int(mesh.faces[side.face].vertices.size());
    return {side.face, (side.place + size - 1) % size};
}

Side nextSide(TaggedMesh const &mesh, Side side) {
    return {side.face, (side.place + 1) % int(mesh.faces[side.face].vertices.size())};
}

std::vector<SharpEdge> sharpEdges(TaggedMesh const &mesh, int vertex) {
    std::vector<SharpEdge> result;
    for (Side corner : mesh.vertices[vertex].corners) {
        Face const &face = mesh.faces[corner.face];
        int const out = face.edges[corner.place];
        int const before = previousSide(mesh, corner).place;
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
        int const before = previousSide(mesh, corner).place;
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

namespace {

bool areQuads(TaggedMesh const &mesh, int vertex) {
    auto const &corners = mesh.vertices[vertex].corners;
    return std::all_of(corners.begin(), corners.end(),
                       [&](Side corner) { return mesh.faces[corner.face].vertices.size() == 4; });
}

void setPathsAround(TaggedMesh &mesh, int v) {
    TaggedMesh::Vertex const &vertex = mesh.vertices[v];
    bool isInside = areQuads(mesh, v) && !vertex.isNonManifold;
    float sharpness = vertex.sharpness;
    for (Side corner : vertex.corners) {
        for (Side side : {corner, previousSide(mesh, corner)}) {
            Edge const &edge = mesh.edges[mesh.faces[side.face].edges[side.place]];
            isInside = isInside && edge.sides.size() == 2;
            sharpness = std::max(sharpness, edge.sharpness);
        }
    }
    if (!isInside || isInfinite(sharpness)) {
        return;
    }
    std::size_t const size = vertex.corners.size();
    bool const hasKind = size >= 3 && size <= 6;
    for (Side corner : vertex.corners) {
        QuadPath path;
        path.steps = hasKind ? std::to_string(size) : "o";
        path.sharpness = sharpness;
        mesh.faces[corner.face].pathsOut[corner.place] = path;
        mesh.faces[corner.face].pathsIn[corner.place] = path;
    }
}

/// Whether two quads are on each side of one line through the vertex, which is equally sharp before and behind it.
bool isRegularOnLine(TaggedMesh const &mesh, int v) {
    TaggedMesh::Vertex const &vertex = mesh.vertices[v];
    std::vector<Fan> const fans = findFans(mesh, v);
    std::vector<SharpEdge> const lines = sharpEdges(mesh, v);
    if (vertex.isNonManifold || vertex.sharpness > 0 || fans.size() != 1 || lines.size() != 2 ||
        lines[0].sharpness != lines[1].sharpness || !areQuads(mesh, v) ||
        vertex.corners.size() != (fans[0].isClosed ? 4 : 2)) {
        return false;
    }
    // Each face has one of the two.
    return std::all_of(vertex.corners.begin(), vertex.corners.end(), [&](Side corner) {
        auto const getEdge = [&](Side side) -> Edge const & {
            return mesh.edges[mesh.faces[side.face].edges[side.place]];
        };
        Edge const &out = getEdge(corner);
        Edge const &in = getEdge(previousSide(mesh, corner));
        return !out.isFree && !in.isFree && (out.sharpness > 0) != (in.sharpness > 0);
    });
}

} // namespace

void setBasePaths(TaggedMesh &mesh) {
    for (Face &face : mesh.faces) {
        face.pathsOut.assign(face.vertices.size(), QuadPath());
        face.pathsIn.assign(face.vertices.size(), QuadPath());
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        setPathsAround(mesh, int(v));
    }
    for (Face &face : mesh.faces) {
        for (int first = 0; first < 4 && face.vertices.size() == 4; ++first) {
            Edge const &edge = mesh.edges[face.edges[first]];
            auto const isAbove = [&](int place) {
                QuadPath const &path = face.pathsOut[place % 4];
                auto const &corners = mesh.vertices[face.vertices[place % 4]].corners;
                return path.steps == "4" && path.sharpness <= 0 &&
                       std::all_of(corners.begin(), corners.end(), [&](Side corner) {
                           std::vector<int> const &edges = mesh.faces[corner.face].edges;
                           return std::all_of(edges.begin(), edges.end(), [&](int other) {
                               float const sharpness = mesh.edges[other].sharpness;
                               return sharpness <= 0 || sharpness == edge.sharpness;
                           });
                       });
            };
            if (edge.sharpness <= 0 || !isAbove(first + 2) || !isAbove(first + 3) ||
                !isRegularOnLine(mesh, face.vertices[first]) ||
                !isRegularOnLine(mesh, face.vertices[(first + 1) % 4])) {
                continue;
            }
            char const outs[] = {'1', '2', '4', '3'};
            char const ins[] = {'2', '1', '3', '4'};
            for (int i = 0; i < 4; ++i) {
                bool const isOnLine = i < 2;
                auto const place = std::size_t((first + i) % 4);
                float const sharpness = isOnLine ? edge.sharpness : 0;
                face.pathsOut[place] = {"4", sharpness, outs[i], edge.sharpness};
                face.pathsIn[place] = {"4", sharpness, ins[i], edge.sharpness};
            }
        }
    }
}

} // namespace TaggedRules

using namespace TaggedRules;

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

} // namespace OpenSubdivHex::Regression

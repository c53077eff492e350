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

    // Edges that get smooth with this step count by the sharpness that they have left.
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

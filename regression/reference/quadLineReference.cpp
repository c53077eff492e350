// SPDX-License-Identifier: Apache-2.0
#include "quadLineReference.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression {

using namespace TaggedRules;

namespace {

/// The sharp edges at a vertex, the sharpest first.
struct EdgesAround {
    std::vector<std::pair<float, int>> edges;

    float GetSharpness(std::size_t i) const { return i < edges.size() ? edges[i].first : 0; }
};

EdgesAround edgesAround(TaggedMesh const &mesh, int vertex) {
    EdgesAround result;
    for (SharpEdge const &edge : sharpEdges(mesh, vertex)) {
        result.edges.emplace_back(edge.sharpness, edge.edge);
    }
    std::stable_sort(result.edges.begin(), result.edges.end(),
                     [](auto const &a, auto const &b) { return a.first > b.first; });
    return result;
}

/// Whether a vertex inside the mesh has four quads; and the sharpest thing there.
bool hasFourQuads(TaggedMesh const &mesh, int vertex, float &sharpness) {
    TaggedMesh::Vertex const &tags = mesh.vertices[std::size_t(vertex)];
    sharpness = tags.sharpness;
    bool result = tags.corners.size() == 4 && !tags.isNonManifold;
    for (Side corner : tags.corners) {
        Face const &face = mesh.faces[std::size_t(corner.face)];
        result = result && face.vertices.size() == 4;
        for (int place : {corner.place, previousSide(mesh, corner).place}) {
            Edge const &edge = mesh.edges[std::size_t(face.edges[std::size_t(place)])];
            result = result && edge.sides.size() == 2;
            sharpness = std::max(sharpness, edge.sharpness);
        }
    }
    return result;
}

bool isLess(LinePath const &a, LinePath const &b) {
    static std::string const kOrder = "abcdvtVT";
    auto const rank = [](LinePath const &path) {
        return std::make_tuple(path.flag[0], kOrder.find(path.flag[1]), path.steps);
    };
    return rank(a) < rank(b);
}

class Beginner {
public:
    explicit Beginner(TaggedMesh &mesh) : _mesh(mesh) {}

    void Run() {
        for (Face &face : _mesh.faces) {
            face.linesOut.assign(face.vertices.size(), {});
            face.linesIn.assign(face.vertices.size(), {});
        }
        for (std::size_t v = 0; v < _mesh.vertices.size(); ++v) {
            beginAt(int(v));
        }
    }

private:
    void beginAt(int v) {
        TaggedMesh::Vertex const &vertex = _mesh.vertices[std::size_t(v)];
        EdgesAround const around = edgesAround(_mesh, v);
        float const line = around.GetSharpness(1);
        float const cross = std::max(around.GetSharpness(2), vertex.sharpness);
        if (vertex.isNonManifold || line <= cross) {
            return;
        }
        int const ends[2] = {around.edges[0].second, around.edges[1].second};
        auto const isEnd = [&](int edge) { return edge == ends[0] || edge == ends[1]; };
        // A side begins in the face behind an edge of the line, counter-clockwise.
        for (Fan const &fan : findFans(_mesh, v)) {
            std::size_t const size = fan.corners.size();
            for (std::size_t start = 0; start < size; ++start) {
                if (!isEnd(edgeFrom(fan.corners[start]))) {
                    continue;
                }
                std::vector<Side> side;
                // An open fan ends at the boundary.
                std::size_t const end = fan.isClosed ? start + size : size;
                for (std::size_t i = start; i < end; ++i) {
                    side.push_back(fan.corners[i % size]);
                    if (isEnd(edgeFrom(previousSide(_mesh, side.back())))) {
                        break;
                    }
                }
                if (isEnd(edgeFrom(previousSide(_mesh, side.back())))) {
                    beginSide(side, line, cross);
                }
            }
        }
    }

    int edgeFrom(Side side) const {
        return _mesh.faces[std::size_t(side.face)].edges[std::size_t(side.place)];
    }

    void beginSide(std::vector<Side> const &side, float line, float cross) {
        std::size_t const count = side.size();
        if (count < 2 || count > 4 || std::any_of(side.begin(), side.end(), [&](Side corner) {
                return _mesh.faces[std::size_t(corner.face)].vertices.size() != 4;
            })) {
            return;
        }
        for (std::size_t i = 0; i < count; ++i) {
            auto const pathAt = [&](std::size_t place) {
                char const letter = char('a' + std::min(place, 2 * count - 1 - place));
                return LinePath{std::to_string(count) + letter, "", line, cross};
            };
            Side const corner = side[i];
            Face &face = _mesh.faces[std::size_t(corner.face)];
            face.linesOut[std::size_t(corner.place)].at = pathAt(2 * i);
            face.linesIn[std::size_t(corner.place)].at = pathAt(2 * i + 1);
            bool const hasLine = i == 0 || i + 1 == count;
            if (i > 0) {
                beginOtherEnd(nextSide(_mesh, corner), false, count, hasLine, line, cross);
            }
            if (i + 1 < count) {
                beginOtherEnd(previousSide(_mesh, corner), true, count, hasLine, line, cross);
            }
        }
    }

    /// Of two lines in the same role the one with the larger share.
    void set(Side corner, LinePath const &out, LinePath const &in) {
        Face &face = _mesh.faces[std::size_t(corner.face)];
        LinePath &ofOut = face.linesOut[std::size_t(corner.place)].away;
        if (ofOut.GetShare() <= out.GetShare()) {
            ofOut = out;
            face.linesIn[std::size_t(corner.place)].away = in;
        }
    }

    /// \param isOut  whether the edge from this corner leads down to the line, else the edge to it does
    void beginOtherEnd(Side corner, bool isOut, std::size_t count, bool hasLine, float line,
                       float cross) {
        Face const &face = _mesh.faces[std::size_t(corner.face)];
        float own = 0;
        if (!hasFourQuads(_mesh, face.vertices[std::size_t(corner.place)], own) ||
            isInfinite(own)) {
            return;
        }
        Side const beyond = isOut ? previousSide(_mesh, corner) : nextSide(_mesh, corner);
        int const v = _mesh.GetStart(beyond);
        cross = std::max({cross, own, _mesh.vertices[std::size_t(v)].sharpness,
                          edgesAround(_mesh, v).GetSharpness(0)});
        if (line <= cross) {
            return;
        }
        std::string const number = std::to_string(count);
        LinePath const down{number + (hasLine ? 'v' : 'V'), "", line, cross};
        LinePath const top{number + (hasLine ? 't' : 'T'), "", line, cross};
        set(corner, isOut ? down : top, isOut ? top : down);
    }

    TaggedMesh &_mesh;
};

struct FlagRow {
    std::optional<double> weightOfPoint;
    std::vector<double> weights;
};
/// By flag and path, with a colon between them.
using FlagRows = std::map<std::string, FlagRow>;

FlagRows readFlagRows() {
    constexpr double kParts = 4096;
    std::ifstream file(REFERENCE_QUAD_LINE_ROWS);
    FlagRows rows;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string key;
        std::string ofPoint;
        if (line[0] != '#' && words >> key >> ofPoint) {
            FlagRow &row = rows[key];
            if (ofPoint != "-") {
                row.weightOfPoint = std::stod(ofPoint) / kParts;
            }
            for (double part = 0; words >> part;) {
                row.weights.push_back(part / kParts);
            }
        }
    }
    if (rows.empty()) {
        throw std::runtime_error("There are no rows in " REFERENCE_QUAD_LINE_ROWS);
    }
    return rows;
}

} // namespace

void BeginQuadLines(TaggedMesh &mesh) { Beginner(mesh).Run(); }

namespace {

std::optional<LineRule> findRule(LinePath const &out, LinePath const &in) {
    static FlagRows const rows = readFlagRows();
    if (out.IsEmpty() || in.IsEmpty()) {
        return {};
    }
    bool const isMirrored = isLess(in, out);
    LinePath const &path = isMirrored ? in : out;
    auto found = rows.find(path.flag + ":" + path.steps);
    if (found == rows.end() && (path.flag[1] == 'v' || path.flag[1] == 't')) {
        found = rows.find(std::string{'2', path.flag[1]} + ":" + path.steps); // of regular lines
    }
    double const share = double(std::min(out.GetShare(), in.GetShare()));
    if (found == rows.end() || share == 0) {
        return {};
    }
    bool const isAlong = path.flag[1] == 'a';
    bool const isOfHalf = isAlong && !path.steps.empty() && path.steps[0] != '0' &&
                          path.steps.find_first_not_of('0', 1) == std::string::npos;
    return LineRule{found->second.weights, isMirrored, isOfHalf, found->second.weightOfPoint,
                    share};
}

} // namespace

std::vector<LineRule> FindQuadLineRules(LinePaths const &out, LinePaths const &in) {
    std::vector<LineRule> rules;
    for (LinePath LinePaths::*const line : {&LinePaths::away, &LinePaths::at}) {
        if (std::optional<LineRule> const rule = findRule(out.*line, in.*line)) {
            rules.push_back(*rule);
        }
    }
    return rules;
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "lineReference.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>

namespace OpenSubdivHex::Regression {

using namespace TaggedRules;

void BeginRegularLines(TaggedMesh &mesh) {
    std::vector<float> regular;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        Edge const &edge = mesh.edges[e];
        float result = edge.sharpness;
        for (int v : {mesh.GetStart(edge.sides[0]), mesh.GetEnd(edge.sides[0])}) {
            float beyond = 0;
            for (SharpEdge const &other : sharpEdges(mesh, v)) {
                if (other.edge != int(e) && other.isLong != edge.isLong) {
                    beyond = other.sharpness;
                }
            }
            result = std::min(result, beyond);
        }
        regular.push_back(result);
    }
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        mesh.edges[e].regularLine = regular[e];
    }
}

namespace {

/// In the file: the steps behind the truncation, the face and the place.
using Key = std::tuple<int, std::string, int>;
struct Row {
    std::optional<double> weightOfPoint;
    std::vector<double> weights;
};

std::map<Key, Row> readRows() {
    constexpr double kParts = 4096;
    std::ifstream file(REFERENCE_LINE_ROWS);
    std::map<Key, Row> rows;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        int steps = 0;
        std::string face;
        int place = 0;
        std::string ofPoint;
        if (line[0] != '#' && words >> steps >> face >> place >> ofPoint) {
            Row &row = rows[{steps, face, place}];
            if (ofPoint != "-") {
                row.weightOfPoint = std::stod(ofPoint) / kParts;
            }
            for (double part = 0; words >> part;) {
                row.weights.push_back(part / kParts);
            }
        }
    }
    if (rows.empty()) {
        throw std::runtime_error("There are no rows in " REFERENCE_LINE_ROWS);
    }
    return rows;
}

/// A place beside a line, and how sharp that is.
struct Role {
    float sharpness;
    std::string face;
    int place;
};

class RoleFinder {
public:
    explicit RoleFinder(TaggedMesh const &mesh) : _mesh(mesh) {}

    std::vector<Role> Find(Side corner, std::vector<Side> const &hexagon, int place) const {
        std::vector<Role> roles;
        auto const add = [&roles](float sharpness, char const *face, int at) {
            if (sharpness > 0) {
                roles.push_back({sharpness, face, at});
            }
        };
        Face const &face = _mesh.faces[corner.face];
        if (face.isHalf && (corner.place < 2 || face.vertices.size() == 4)) {
            float const regular = _mesh.edges[face.edges[0]].regularLine;
            add(regular, "half", corner.place);
        }
        if (hexagon.size() != 6) {
            // On an edge of another face, the two ends alone.
            for (Side side : {corner, previousSide(_mesh, corner)}) {
                Edge const &edge = edgeOf(side);
                if (!edge.isLong) {
                    add(edge.regularLine, "other", 0);
                }
            }
            return roles;
        }
        for (int i = 0; i < 6; ++i) {
            Edge const &edge = edgeOf(hexagon[std::size_t(i)]);
            int const at = (place - i + 6) % 6; // seen from this edge
            if (!edge.isLong) {
                bool const isBetween = isBesideHalfHexagon(hexagon[std::size_t((i + 1) % 6)]) &&
                                       isBesideHalfHexagon(hexagon[std::size_t((i + 5) % 6)]);
                add(edge.regularLine, isBetween ? "on" : "other", at);
            }
            add(lineBefore(hexagon[std::size_t(i)]), "behind", at);
            if (at <= 1) {
                add(lineBeyondHexagon(hexagon[std::size_t(i)]), "beyond", at);
            }
        }
        return roles;
    }

private:
    Edge const &edgeOf(Side side) const {
        return _mesh.edges[_mesh.faces[side.face].edges[side.place]];
    }
    /// The face across, where it runs along the edge.
    std::optional<Side> across(Side side) const {
        Edge const &edge = edgeOf(side);
        if (edge.sides.size() == 1) {
            return {};
        }
        bool const isFirst = edge.sides[0].face == side.face && edge.sides[0].place == side.place;
        return edge.sides[isFirst ? 1 : 0];
    }
    bool isBesideHalfHexagon(Side side) const {
        std::optional<Side> const other = across(side);
        return other && _mesh.faces[other->face].isHalf &&
               _mesh.faces[other->face].vertices.size() == 4;
    }
    /// Sharpness of the line whose half hexagon has this edge opposite to it.
    float lineBefore(Side side) const {
        std::optional<Side> const other = across(side);
        if (!other || other->place != 2) {
            return 0;
        }
        Face const &half = _mesh.faces[other->face];
        return half.isHalf && half.vertices.size() == 4 ? _mesh.edges[half.edges[0]].regularLine
                                                        : 0;
    }
    /// Sharpness of the line on the opposite edge of the hexagon across.
    float lineBeyondHexagon(Side side) const {
        std::optional<Side> const other = across(side);
        if (!other) {
            return 0;
        }
        Face const &face = _mesh.faces[other->face];
        if (!face.isHalf) {
            Edge const &opposite =
                _mesh.edges[face.edges[std::size_t((other->place + 3) % 6) % face.edges.size()]];
            return face.vertices.size() == 6 && !opposite.isLong ? opposite.regularLine : 0;
        }
        // The opposite edge of a half lies in the other half.
        Edge const &line = _mesh.edges[face.edges[0]];
        if (line.sides.size() == 1 || face.vertices.size() != 4 || other->place == 0) {
            return 0;
        }
        Face const &partner =
            _mesh.faces[line.sides[line.sides[0].face == other->face ? 1 : 0].face];
        return partner.vertices.size() == 4
                   ? _mesh.edges[partner.edges[std::size_t(other->place)]].regularLine
                   : 0;
    }

    TaggedMesh const &_mesh;
};

} // namespace

std::optional<LineRule> FindLineRule(TaggedMesh const &mesh, Side corner,
                                     std::vector<Side> const &hexagon, int place) {
    static std::map<Key, Row> const rows = readRows();
    if (mesh.numHexagonalSteps >= kNumLineSteps) {
        return {};
    }
    std::vector<Role> roles = RoleFinder(mesh).Find(corner, hexagon, place);
    for (Role &role : roles) {
        role.sharpness = std::min(1.0f, role.sharpness);
    }
    std::stable_sort(roles.begin(), roles.end(),
                     [](Role const &a, Role const &b) { return a.sharpness > b.sharpness; });
    if (roles.empty() || (roles.size() > 1 && roles[0].sharpness == roles[1].sharpness)) {
        return {};
    }
    Role const &role = roles[0];
    double const share = double(role.sharpness - (roles.size() > 1 ? roles[1].sharpness : 0));
    bool const isHalf = role.face == "half";
    for (bool const isMirrored : {false, true}) {
        int const mirrored = isHalf ? 5 - role.place : (7 - role.place) % 6;
        auto const found =
            rows.find({mesh.numHexagonalSteps, role.face, isMirrored ? mirrored : role.place});
        if (found != rows.end()) {
            return LineRule{found->second.weights, isMirrored, isHalf, found->second.weightOfPoint,
                            share};
        }
    }
    return {};
}

} // namespace OpenSubdivHex::Regression

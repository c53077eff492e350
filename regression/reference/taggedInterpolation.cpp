// SPDX-License-Identifier: Apache-2.0
#include "irregularReference.h"
#include "quadLineReference.h"
#include "taggedRules.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace OpenSubdivHex::Regression {

using namespace TaggedRules;

namespace {

/// How far new points in wide sectors are drawn to the vertex, by face and place.
using Pulls = std::map<std::pair<int, int>, double>;

/// Shares of the masks beside vertices of smooth lines that have one face on a side, by where the vertex is.
struct Narrow {
    double self = 0; ///< the corner's own
    double before =
        0; ///< at the corner before it in the face; in a half face the near end of the line
    double behind = 0; ///< at the corner behind; in a half face not used
    double far = 0;    ///< in a half face the far end of the line
};
using Narrows = std::map<std::pair<int, int>, Narrow>;

/// The factor of a sector of \p size faces: P = factor * mask + (1 - factor) V.
double sectorFactor(ReferenceMask mask, double size) {
    double const c = std::cos(std::acos(-1.0) / size);
    return mask == ReferenceMask::Average ? 1 / (0.98 + 0.305 * c) : 1 / (1.31 + 0.515 * c);
}

/// How sharp the line is that has the face on one side only; 0 for whole faces.
double lineSharpness(TaggedMesh const &mesh, Face const &face) {
    return face.isHalf ? double(mesh.edges[face.edges[0]].sharpness) : 0;
}

/// Calls visit(corners, size) for the sectors at a vertex, counter-clockwise, as if all edges of less than
/// \p threshold were smooth.
template <typename Visit>
void visitSectors(TaggedMesh const &mesh, int vertex, double threshold, Visit const &visit) {
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
            int const before = previousSide(mesh, corner).place;
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
        if (edge->sharpness >= threshold && !isAllAround) {
            visit(corners, size);
        }
    }
}

/// Adds \p share of the pulls at a vertex.
void addPulls(TaggedMesh const &mesh, ReferenceMask mask, int vertex, double threshold,
              double share, Pulls &pulls) {
    visitSectors(mesh, vertex, threshold, [&](std::vector<Side> const &corners, double size) {
        for (Side pulled : corners) {
            // Halves are one face while their line is smooth.
            if (size >= 3 && lineSharpness(mesh, mesh.faces[pulled.face]) < threshold) {
                pulls[{pulled.face, pulled.place}] += share * (1 - sectorFactor(mask, size));
            }
        }
    });
}

/// Adds the share of thresholds from \p last to \p threshold, as far as a smooth line goes through the vertex.
void addNarrows(TaggedMesh const &mesh, int vertex, double threshold, double last,
                Narrows &narrows) {
    TaggedMesh::Vertex const &tags = mesh.vertices[vertex];
    double const share = threshold - std::max(last, double(tags.sharpness));
    std::vector<SharpEdge> const edges = sharpEdges(mesh, vertex);
    auto const numSharp = std::count_if(edges.begin(), edges.end(), [&](SharpEdge const &edge) {
        return edge.sharpness >= threshold;
    });
    if (share <= 0 || numSharp != 2 || tags.isNonManifold) {
        return;
    }
    visitSectors(mesh, vertex, threshold, [&](std::vector<Side> const &corners, double size) {
        for (Side corner : corners) {
            if (size != 1) {
                continue;
            }
            int const place = corner.place;
            if (mesh.faces[corner.face].isHalf) {
                narrows[{corner.face, 3 - place}].before += share;
                narrows[{corner.face, 2 + place}].far += share;
            } else {
                narrows[{corner.face, place}].self += share;
                narrows[{corner.face, (place + 1) % 6}].before += share;
                narrows[{corner.face, (place + 5) % 6}].behind += share;
            }
        }
    });
}

/// An edge of sharpness s below 1 is sharp with share s and smooth with share 1 - s, the less sharp
/// edges whenever a sharper one is.
std::set<double> findThresholds(TaggedMesh const &mesh) {
    std::set<double> thresholds{1};
    for (Edge const &edge : mesh.edges) {
        if (edge.sharpness > 0 && edge.sharpness < 1) {
            thresholds.insert(edge.sharpness);
        }
    }
    return thresholds;
}

Pulls findPulls(TaggedMesh const &mesh, ReferenceMask mask) {
    std::set<double> const thresholds = findThresholds(mesh);
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

Narrows findNarrows(TaggedMesh const &mesh) {
    std::set<double> const thresholds = findThresholds(mesh);
    Narrows narrows;
    for (std::size_t v = 0; v < mesh.vertices.size() && mesh.numHexagonalSteps > 0; ++v) {
        double last = 0;
        for (double threshold : thresholds) {
            addNarrows(mesh, int(v), threshold, last, narrows);
            last = threshold;
        }
    }
    return narrows;
}

/// The components of a mesh that follow the rules of Smooth for hexagons beside irregular vertices and quads.
class Irregularities {
public:
    explicit Irregularities(TaggedMesh const &mesh) : _mesh(mesh) {}

    /// A vertex whose faces are four hexagons or more, each made for an edge.
    struct Vertex {
        int numFaces = 0;
        double share = 0; ///< of its rule: what is left by the sharpest thing at it
        FormerFaces formerFaces = FormerFaces::Mixed;
    };
    /// Without faces for other vertices.
    Vertex FindVertex(int vertex) const {
        TaggedMesh::Vertex const &tags = _mesh.vertices[vertex];
        double sharpness = tags.sharpness;
        double size = 0;
        for (Side corner : tags.corners) {
            Face const &face = _mesh.faces[corner.face];
            for (int place : {corner.place, previousSide(_mesh, corner).place}) {
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
        return isIrregular ? Vertex{int(size), 1 - sharpness, tags.formerFaces} : Vertex();
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
        auto const blend = [&](Point const &point, int edge) {
            double const ofQuad = quadSharpness(across(corners[edge]));
            double const share = std::max(0.0, 1 - std::max(sharpness, ofQuad));
            return share > 0 ? Point(share * point + (1 - share) * plain) : plain;
        };
        std::vector<int> edges; // to quads
        for (int edge = 0; edge < 6; ++edge) {
            if (double const ofQuad = quadSharpness(across(corners[edge]));
                0 <= ofQuad && ofQuad < 1) {
                edges.push_back(edge);
            }
        }
        for (int edge : edges) {
            auto const point = NewPointBesideQuad(_mesh.numHexagonalSteps, hexagon, i, edge);
            if (point && (edge == i || edge == (i + 5) % 6)) {
                return blend(*point, edge);
            }
        }
        for (int corner : {i, (i + 1) % 6, (i + 5) % 6}) {
            Vertex const vertex = FindVertex(_mesh.GetStart(corners[corner]));
            if (vertex.numFaces > 0) {
                IrregularRule const rule =
                    MakeIrregularRule(vertex.numFaces, _mesh.numHexagonalSteps, vertex.formerFaces);
                return vertex.share * NewIrregularPoint(rule, hexagon, i, corner) +
                       (1 - vertex.share) * plain;
            }
        }
        if (edges.size() == 1) {
            if (auto const point =
                    NewPointBesideQuad(_mesh.numHexagonalSteps, hexagon, i, edges[0])) {
                return blend(*point, edges[0]);
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
    /// How sharp the line is that crosses the smaller copy of a quad, if any does; -1 for other faces.
    double quadSharpness(int face) const {
        if (face < 0 || _mesh.faceOrigins[face].face < 0) {
            return -1;
        }
        std::size_t size = _mesh.faces[face].vertices.size();
        if (!_mesh.faces[face].isHalf) {
            return size == 4 ? 0 : -1;
        }
        Edge const &line = _mesh.edges[_mesh.faces[face].edges[0]];
        if (line.sides.size() == 1) {
            return -1;
        }
        size = _mesh.faces[line.sides[0].face].vertices.size() +
               _mesh.faces[line.sides[1].face].vertices.size() - 2;
        return size == 4 ? double(line.sharpness) : -1;
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
        _narrows = hasIrregularRules() ? findNarrows(_mesh) : Narrows();
        for (std::size_t v = 0; v < _child.vertexOrigins.size(); ++v) {
            TaggedMesh::VertexOrigin const &origin = _child.vertexOrigins[v];
            if (origin.face < 0) {
                continue;
            }
            auto const pull = pulls.find({origin.face, origin.place});
            double const towards = pull != pulls.end() ? pull->second : 0;
            Side const corner = {origin.face, origin.place};
            _result.row(Eigen::Index(v)) = mixBesideLine(
                corner,
                mixByPath(corner, cornerPoint(corner, towards, _values.row(origin.vertex))));
        }
        for (std::size_t v = 0; v < _mesh.vertices.size(); ++v) {
            if (_child.vVertices[v] >= 0) {
                _result.row(_child.vVertices[v]) =
                    _isVarying
                        ? Point(_values.row(Eigen::Index(v)))
                        : mixBesideLines(
                              int(v),
                              mixBesideQuadLines(int(v), mixByPaths(int(v), movedVertex(int(v)))));
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
            bool const isQuad = hasIrregularRules() && points.size() == 4;
            Point const smooth = isQuad
                                     ? NewPointOfQuad(_mesh.numHexagonalSteps, points, corner.place)
                                     : maskPoint(points, corner.place);
            Point const plain =
                atOneFace(points, corner, towards * vertex + (1 - towards) * smooth);
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
            return halfPoint(face, corner.place) + fromOneFace(face, corner) +
                   fromLine(face, corner, 1);
        }
        auto const [vertices, place] = wholeOf(corner);
        std::vector<Point> const whole = pointsOf(vertices);
        bool const isQuad = hasIrregularRules() && whole.size() == 4;
        bool const isHexagon = whole.size() == 6 && face.vertices.size() == 4;
        Point const smooth = isQuad ? NewPointOfQuad(_mesh.numHexagonalSteps, whole, place)
                                    : maskPoint(whole, place);
        double const sharp = _isVarying ? 0 : std::min(1.0, double(line.sharpness));
        Point const plain = sharp * halfPoint(face, corner.place) + towards * vertex +
                            (1 - sharp - towards) * smooth + fromOneFace(face, corner) +
                            fromLine(face, corner, sharp);
        if (!hasIrregularRules() || !isHexagon) {
            return plain;
        }
        int const self = corner.face;
        int const partner = line.sides[line.sides[0].face == self ? 1 : 0].face;
        return _irregularities.Apply(
            whole, {{partner, 1}, {partner, 2}, {partner, 3}, {self, 1}, {self, 2}, {self, 3}},
            line.sharpness, place, plain);
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

    /// The other half is completed by ghosts, which have half a turn, as the face has, from its vertex 0 to 1.
    Point halfPoint(Face const &face, int place) const {
        std::vector<Point> const points = pointsOf(face.vertices);
        int const count = int(points.size()) - 1; // of the edges in half a turn
        Point const &v = points[0];
        Point const &w = points[1];
        if (place < 2) {
            return (3 * points[std::size_t(place)] + points[std::size_t(1 - place)]) / 4;
        }
        std::vector<Point> polygon{v};
        for (int i = 1; i < count; ++i) {
            double const c = std::cos(std::acos(-1.0) * i / count);
            polygon.push_back((1 + c) * v + (1 - c) * w - points[std::size_t(count + 1 - i)]);
        }
        polygon.insert(polygon.end(), points.begin() + 1, points.end());
        Point const whole = maskPoint(polygon, count + place - 1);
        if (_isVarying || _mask != ReferenceMask::Smooth || count < 6) {
            return whole;
        }
        // Waves of three turns and more around the polygon are kept by 1/6 in place of 1/8.
        Point slow = Point::Zero(whole.size()); // the waves of less
        for (int j = 0; j < 2 * count; ++j) {
            double const t = std::acos(-1.0) * (j - (count + place - 1)) / count;
            slow +=
                (1 + 2 * std::cos(t) + 2 * std::cos(2 * t)) / (2 * count) * polygon[std::size_t(j)];
        }
        return whole + (1 / 6.0 - 1 / 8.0) * (polygon[std::size_t(count + place - 1)] - slow);
    }

    /// In 256ths, going around from the new point's corner towards or away from the vertex with one face.
    Point atOneFace(std::vector<Point> const &face, Side corner, Point const &plain) const {
        auto const found = _narrows.find({corner.face, corner.place});
        if (found == _narrows.end()) {
            return plain;
        }
        double const weightsOfV[6] = {61.4444, 57.5, 39.7778, 0, 39.7778, 57.5}; // V N A B C M
        double const weightsOfN[6] = {42, 43.5, 124.5, 0, 46, 0};
        Narrow const &narrow = found->second;
        int const vertex = corner.place + (narrow.self > 0 ? 0 : narrow.before > 0 ? 5 : 1);
        Point point = Point::Zero(plain.size());
        for (int j = 0; j < 6; ++j) {
            // From V towards the corner.
            int const place = vertex + (narrow.behind > 0 ? 6 - j : j);
            point += (narrow.self > 0 ? weightsOfV : weightsOfN)[j] / 256 * face[place % 6];
        }
        double const share = narrow.self + narrow.before + narrow.behind;
        return share * point + (1 - share) * plain;
    }

    /// The change that vertices with one face make in half a face.
    Point fromOneFace(Face const &face, Side corner) const {
        auto const found = _narrows.find({corner.face, corner.place});
        if (found == _narrows.end()) {
            return Point::Zero(_values.cols());
        }
        std::vector<Point> const points = pointsOf(face.vertices);
        Point const &self = points[corner.place];
        Point const &twin = points[corner.place == 3 ? 2 : 3];
        Point const &end = points[corner.place == 3 ? 0 : 1];
        Point const &otherEnd = points[corner.place == 3 ? 1 : 0];
        Point const beside = (94.5 * self + 75 * end + 34.5 * otherEnd + 52 * twin) / 256;
        Point const farFrom = (122 * self + 39.5 * end + 78 * otherEnd + 16.5 * twin) / 256;
        // Rules beside lines go first, then the near end.
        double ofLine = 0;
        for (LineRule const &rule : quadLineRulesOf(corner)) {
            if (rule.isOfHalf && !rule.weights.empty()) {
                Edge const &line = _mesh.edges[face.edges[0]];
                double const sharp =
                    line.sides.size() == 1 ? 1 : std::min(1.0, double(line.sharpness));
                ofLine = std::max(ofLine, std::min(sharp, rule.share));
            }
        }
        double const near = std::max(0.0, found->second.before - ofLine);
        double const far =
            std::max(0.0, found->second.far - std::max(double(found->second.before), ofLine));
        return near * beside + far * farFrom - (near + far) * halfPoint(face, corner.place);
    }

    /// The hexagon that a corner is in, with one of those on the line where it has halves; and the corner's place there.
    std::pair<std::vector<Side>, int> hexagonOf(Side corner) const {
        Face const &face = _mesh.faces[corner.face];
        std::vector<Side> corners;
        if (!face.isHalf && face.vertices.size() == 6) {
            for (int i = 0; i < 6; ++i) {
                corners.push_back({corner.face, i});
            }
            return {corners, corner.place};
        }
        Edge const &line = _mesh.edges[face.edges[0]];
        if (!face.isHalf || line.sides.size() == 1 || wholeOf(corner).first.size() != 6) {
            return {};
        }
        // The edges from these corners are those of the hexagon.
        int const partner = line.sides[line.sides[0].face == corner.face ? 1 : 0].face;
        for (int const half : {partner, corner.face}) {
            int const size = int(_mesh.faces[half].vertices.size());
            for (int i = 1; i < size; ++i) {
                corners.push_back({half, i});
            }
        }
        return {corners, wholeOf(corner).second};
    }

    std::optional<LineRule> truncatedRuleOf(Side corner) const {
        if (!hasIrregularRules()) {
            return {};
        }
        auto const [hexagon, place] = hexagonOf(corner);
        return FindLineRule(_mesh, corner, hexagon, place);
    }
    std::vector<LineRule> quadLineRulesOf(Side corner) const {
        if (!hasIrregularRules() || _mesh.faces[corner.face].linesOut.empty()) {
            return {};
        }
        auto const [out, in] = flagsOf<LinePaths>(corner, &Face::linesOut, &Face::linesIn);
        return FindQuadLineRules(out, in);
    }
    /// All rules that have weights, of half a hexagon or not, in the order in which they are mixed in.
    std::vector<LineRule> lineRulesOf(Side corner, bool areOfHalf) const {
        std::vector<LineRule> rules = quadLineRulesOf(corner);
        if (std::optional<LineRule> const rule = truncatedRuleOf(corner)) {
            rules.insert(rules.begin(), *rule);
        }
        auto const isOther = [&](LineRule const &rule) {
            return rule.isOfHalf != areOfHalf || rule.weights.empty();
        };
        rules.erase(std::remove_if(rules.begin(), rules.end(), isOther), rules.end());
        return rules;
    }

    /// A sum of the points around a face, from one of them on.
    static Point sumFrom(std::vector<Point> const &points, int i, LineRule const &rule) {
        Point sum = Point::Zero(points[0].size());
        int const size = int(points.size());
        for (int j = 0; j < size; ++j) {
            int const place = (i + (rule.isMirrored ? size - j : j)) % size;
            sum += rule.weights[std::size_t(j)] * points[std::size_t(place)];
        }
        return sum;
    }

    /// The change that the rows of half a hexagon make, for a line that is as sharp.
    Point fromLine(Face const &face, Side corner, double sharp) const {
        Point change = Point::Zero(_values.cols());
        for (LineRule const &rule : lineRulesOf(corner, true)) {
            Point const point = sumFrom(pointsOf(face.vertices), corner.place, rule);
            change += std::min(sharp, rule.share) * (point - halfPoint(face, corner.place));
        }
        return change;
    }

    /// A new point, whose other rules have made \p other.
    Point mixBesideLine(Side corner, Point const &other) const {
        Point result = other;
        double const crossing = std::min(1.0, lineSharpness(_mesh, _mesh.faces[corner.face]));
        for (LineRule const &rule : lineRulesOf(corner, false)) {
            auto const [whole, place] = wholeOf(corner);
            double const share = std::max(0.0, rule.share - crossing);
            result = share * sumFrom(pointsOf(whole), place, rule) + (1 - share) * result;
        }
        return result;
    }

    /// A moved vertex, likewise: where three faces are around it and all tell the weights of their new points.
    Point mixBesideLines(int v, Point const &other) const {
        double share = smoothShareOf(v);
        Point const old = _values.row(v);
        Point moved = old;
        std::set<int> around;
        for (Side corner : _mesh.vertices[std::size_t(v)].corners) {
            std::optional<LineRule> const rule = truncatedRuleOf(corner);
            if (!rule || !rule->weightOfPoint) {
                return other;
            }
            int const point = _child.fVertices[corner.face][corner.place];
            if (around.insert(point).second) {
                moved += *rule->weightOfPoint * (_result.row(point) - old);
            }
            share = std::min(share, rule->share);
        }
        return around.size() == 3 ? Point(share * moved + (1 - share) * other) : other;
    }

    /// At a corner, those of the hexagon where its face is half of one.
    template <typename PATH>
    std::pair<PATH, PATH> flagsOf(Side corner, std::vector<PATH> Face::*outs,
                                  std::vector<PATH> Face::*ins) const {
        Face const &face = _mesh.faces[corner.face];
        std::size_t const place = std::size_t(corner.place);
        PATH out = (face.*outs)[place];
        PATH in = (face.*ins)[place];
        if (face.isHalf && place < 2) {
            // At the ends of the line, one edge is the other half's.
            Edge const &line = _mesh.edges[face.edges[0]];
            if (line.sides.size() == 1) {
                return {};
            }
            bool const isFirst = line.sides[0].face == corner.face;
            Face const &other = _mesh.faces[line.sides[isFirst ? 1 : 0].face];
            (place == 0 ? out : in) = place == 0 ? (other.*outs)[1] : (other.*ins)[0];
        }
        return {out, in};
    }
    std::pair<QuadPath, QuadPath> pathsOf(Side corner) const {
        if (_mesh.faces[corner.face].pathsOut.empty()) {
            return {};
        }
        return flagsOf<QuadPath>(corner, &Face::pathsOut, &Face::pathsIn);
    }

    /// A new point, whose rules by all else than paths have made \p other.
    Point mixByPath(Side corner, Point const &other) const {
        if (!hasIrregularRules()) {
            return other;
        }
        auto const [hexagon, place] = wholeOf(corner);
        auto const [out, in] = pathsOf(corner);
        std::optional<Point> const byPath =
            hexagon.size() == 6 ? NewPointByPath(pointsOf(hexagon), place, out, in) : std::nullopt;
        return byPath ? Point(out.GetShare() * *byPath + (1 - out.GetShare()) * other) : other;
    }

    /// A moved vertex, likewise: where the paths of all corners tell the weights of their new points.
    Point mixByPaths(int v, Point const &other) const {
        if (!hasIrregularRules() || _mesh.vertices[v].corners.empty()) {
            return other;
        }
        Point const old = _values.row(v);
        Point moved = old;
        std::set<int> around;
        double share = 0;
        for (Side corner : _mesh.vertices[v].corners) {
            int const point = _child.fVertices[corner.face][corner.place];
            auto const [out, in] = pathsOf(corner);
            std::optional<double> const weight = WeightByPath(out, in);
            if (!weight) {
                return other;
            }
            if (around.insert(point).second) {
                moved += *weight * (_result.row(point) - old);
            }
            share = out.GetShare();
        }
        return share * moved + (1 - share) * other;
    }

    /// The part of a vertex that is not sharp.
    double smoothShareOf(int v) const {
        double share = 0;
        for (RuleShare const &ofRule : ruleShares(_mesh, v)) {
            bool const isSmooth =
                ofRule.rule == TaggedRule::Smooth || ofRule.rule == TaggedRule::Dart;
            share += isSmooth ? ofRule.weight : 0;
        }
        return share;
    }

    /// A moved vertex beside lines of quads: each new point around it whose corner tells a weight has this in place of the
    /// one that it has otherwise.
    Point mixBesideQuadLines(int v, Point const &other) const {
        if (!hasIrregularRules()) {
            return other;
        }
        Point const old = _values.row(v);
        double const smoothShare = smoothShareOf(v);
        std::set<int> around;
        std::map<int, double> byPath; // of new points
        double ofPaths = 0;           // their share
        bool haveAllPaths = true;
        for (Side corner : _mesh.vertices[v].corners) {
            int const point = _child.fVertices[corner.face][corner.place];
            around.insert(point);
            auto const [out, in] = pathsOf(corner);
            std::optional<double> const weight = WeightByPath(out, in);
            haveAllPaths = haveAllPaths && weight;
            byPath[point] = weight.value_or(0);
            ofPaths = out.GetShare();
        }
        double const size = double(around.size());
        double plain = 1 / (size + 1);
        if (Irregularities::Vertex const irregular = _irregularities.FindVertex(v);
            irregular.numFaces > 0) {
            double const mean = MakeIrregularRule(irregular.numFaces, _mesh.numHexagonalSteps,
                                                  irregular.formerFaces)
                                    .meanWeight;
            plain = irregular.share * mean / size + (1 - irregular.share) * plain;
        }
        plain *= smoothShare;
        Point moved = other;
        for (Side corner : _mesh.vertices[v].corners) {
            int const point = _child.fVertices[corner.face][corner.place];
            if (around.erase(point) == 0) {
                continue;
            }
            double const before =
                haveAllPaths ? ofPaths * byPath[point] + (1 - ofPaths) * plain : plain;
            double after = before;
            for (LineRule const &rule : quadLineRulesOf(corner)) {
                if (rule.weightOfPoint) {
                    after += smoothShare * rule.share * (*rule.weightOfPoint - after);
                }
            }
            moved += (after - before) * (_result.row(point) - old);
        }
        return moved;
    }

    /// The face, or the hexagon whose half it is, V, R, S, W, Q, P; and the corner's place there.
    std::pair<std::vector<int>, int> wholeOf(Side corner) const {
        Face const &face = _mesh.faces[corner.face];
        std::vector<int> const &own = face.vertices;
        if (!face.isHalf) {
            return {own, corner.place};
        }
        Edge const &line = _mesh.edges[face.edges[0]];
        if (line.sides.size() == 1) {
            return {};
        }
        bool const isFirst = line.sides[0].face == corner.face;
        std::vector<int> const &other = _mesh.faces[line.sides[isFirst ? 1 : 0].face].vertices;
        std::vector<int> whole{own[0]};
        whole.insert(whole.end(), other.begin() + 2, other.end());
        int const end = int(whole.size()); // of the line
        whole.insert(whole.end(), own.begin() + 1, own.end());
        return {whole, corner.place == 0 ? 0 : end + corner.place - 1};
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
            MakeIrregularRule(irregular.numFaces, _mesh.numHexagonalSteps, irregular.formerFaces)
                .meanWeight;
        Point const old = _values.row(v);
        Point const mean = (sum - old) / double(around.size());
        return irregular.share * ((1 - weight) * old + weight * mean) +
               (1 - irregular.share) * plain;
    }

    /// Whether a face has the two others on both sides of a vertex.
    bool isFaceBetween(int v, int a, int b) const {
        auto const &corners = _mesh.vertices[v].corners;
        return std::any_of(corners.begin(), corners.end(), [&](Side corner) {
            std::vector<int> const &vertices = _mesh.faces[corner.face].vertices;
            std::size_t const size = vertices.size();
            int const next = vertices[(std::size_t(corner.place) + 1) % size];
            int const previous = vertices[(std::size_t(corner.place) + size - 1) % size];
            return (next == a && previous == b) || (next == b && previous == a);
        });
    }

    Point creaseVertex(int v, SharpEdge a, SharpEdge b) const {
        Point const vertex = _values.row(v);
        Point const atA = _values.row(a.neighbor);
        Point const atB = _values.row(b.neighbor);
        bool const isFirst = hasIrregularRules() && _mesh.hasFirstLines &&
                             _mesh.numHexagonalSteps < kNumLineSteps &&
                             !_mesh.vertices[v].isNonManifold;
        if (isFirst && a.isLong == b.isLong) {
            return a.isLong ? Point((98 * vertex + 15 * atA + 15 * atB) / 128) : vertex;
        }
        if (a.isLong && b.isLong) {
            return (26 * vertex + 3 * atA + 3 * atB) / 32;
        }
        if (!a.isLong && !b.isLong) {
            bool const hasOneFace =
                _mask != ReferenceMask::Smooth && isFaceBetween(v, a.neighbor, b.neighbor);
            return _mesh.numHexagonalSteps < 4 || _mesh.vertices[v].isNonManifold || hasOneFace
                       ? Point((6 * vertex + atA + atB) / 8)
                       : Point((2 * vertex + 3 * atA + 3 * atB) / 8);
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
    Narrows _narrows;
    ReferenceValues _result;
};

} // namespace

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

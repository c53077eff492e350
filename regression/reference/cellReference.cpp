// SPDX-License-Identifier: Apache-2.0
#include "cellReference.h"

#include <cmath>
#include <map>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

struct CellReference::Line {
    int start;
    int end;
    Line *parts[3] = {}; // none while it is in one piece
};

namespace {

std::array<double, 2> mix(std::array<double, 2> const &from, std::array<double, 2> const &to,
                          double t) {
    return {from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])};
}

} // namespace

CellReference::CellReference(ReferenceMesh const &base, std::vector<int> const &faceVertices)
    : _numVertices(int(base.n_vertices())) {
    std::vector<Line *> lines;
    for (auto const edge : base.edges()) {
        auto const half = edge.h0();
        lines.push_back(addLine(half.from().idx(), half.to().idx()).line);
    }
    std::size_t corner = 0;
    for (auto const face : base.faces()) {
        Piece piece = {face.idx(), true, false, {}, {}};
        int const size = int(base.valence(face));
        double const radius = 0.5 / std::sin(M_PI / size);
        double const height = radius * std::cos(M_PI / size);
        OpenMesh::SmartHalfedgeHandle half = face.halfedge();
        while (half.from().idx() != faceVertices[corner]) {
            half = half.next();
        }
        corner += std::size_t(size);
        for (int i = 0; i < size; ++i, half = half.next()) {
            piece.sides.push_back(
                {lines[std::size_t(half.edge().idx())], half != half.edge().h0()});
            double const angle = 2 * M_PI * (i - 0.5) / size - M_PI / 2;
            // Triangles are right-angled.
            piece.corners.push_back(
                size == 3 ? std::array<double, 2>{i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}
                          : std::array<double, 2>{0.5 + radius * std::cos(angle),
                                                  height + radius * std::sin(angle)});
        }
        _pieces.push_back(std::move(piece));
    }
}

CellReference::~CellReference() = default;

CellReference::Side CellReference::addLine(int start, int end) {
    _lines.push_back(std::make_unique<Line>(Line{start, end}));
    return {_lines.back().get(), false};
}

void CellReference::divide(Line &line) {
    if (line.parts[0]) {
        return;
    }
    int const first = _numVertices++;
    int const second = _numVertices++;
    line.parts[0] = addLine(line.start, first).line;
    line.parts[1] = addLine(first, second).line;
    line.parts[2] = addLine(second, line.end).line;
}

int CellReference::getStart(Side const &side) const {
    return side.isReversed ? side.line->end : side.line->start;
}

CellReference::Side CellReference::getPart(Side const &side, int part) const {
    return {side.line->parts[side.isReversed ? 2 - part : part], side.isReversed};
}

int CellReference::Refine(int piece) {
    Piece const outer = _pieces[std::size_t(piece)];
    auto const reverse = [](Side const &side) { return Side{side.line, !side.isReversed}; };
    std::size_t const size = outer.sides.size();
    Piece inner = {outer.baseFace, outer.isWhole, false, {}, {}};
    // Lines from the corners of the piece to those of the inner one.
    std::vector<Side> spokes;
    std::size_t firstNew = 0;
    if (outer.isWhole) {
        std::array<double, 2> center{};
        for (auto const &corner : outer.corners) {
            center = {center[0] + corner[0] / double(size), center[1] + corner[1] / double(size)};
        }
        for (auto const &corner : outer.corners) {
            inner.corners.push_back(mix(corner, center, 0.5));
        }
    } else {
        // Amid line 0, as its parts are.
        divide(*outer.sides[0].line);
        std::array<double, 2> const middle = mix(outer.corners[0], outer.corners[1], 0.5);
        for (auto const &corner : outer.corners) {
            inner.corners.push_back(mix(corner, middle, 0.5));
        }
        spokes = {getPart(outer.sides[0], 0), reverse(getPart(outer.sides[0], 2))};
        inner.sides = {getPart(outer.sides[0], 1)};
        firstNew = 2;
    }
    for (std::size_t i = firstNew; i < size; ++i) {
        spokes.push_back(addLine(getStart(outer.sides[i]), _numVertices++));
    }
    auto const getInner = [&](std::size_t i) { return getStart(reverse(spokes[i % size])); };
    for (std::size_t i = inner.sides.size(); i < size; ++i) {
        inner.sides.push_back(addLine(getInner(i), getInner(i + 1)));
    }
    int const first = int(_pieces.size());
    _pieces[std::size_t(piece)].isRefined = true;
    _pieces.push_back(inner);
    for (std::size_t i = outer.isWhole ? 0 : 1; i < size; ++i) {
        std::size_t const next = (i + 1) % size;
        _pieces.push_back(
            {outer.baseFace,
             false,
             false,
             {outer.sides[i], spokes[next], reverse(inner.sides[i]), reverse(spokes[i])},
             {outer.corners[i], outer.corners[next], inner.corners[next], inner.corners[i]}});
    }
    return first;
}

// Appends the start of a line and all inside of it.
void CellReference::appendLine(Side const &side, std::array<double, 2> const &from,
                               std::array<double, 2> const &to, Polygon &polygon) const {
    if (!side.line->parts[0]) {
        polygon.vertices.push_back(getStart(side));
        polygon.places.push_back(from);
        return;
    }
    std::array<double, 2> const ends[4] = {from, mix(from, to, 0.25), mix(from, to, 0.75), to};
    for (int part = 0; part < 3; ++part) {
        appendLine(getPart(side, part), ends[part], ends[part + 1], polygon);
    }
}

std::vector<CellReference::Polygon> CellReference::GetPolygons() const {
    std::vector<Polygon> polygons;
    std::map<std::pair<Line *, int>, std::size_t> halves;
    for (Piece const &piece : _pieces) {
        if (piece.isRefined) {
            continue;
        }
        Polygon polygon = {piece.baseFace, {}, {}};
        std::size_t const size = piece.sides.size();
        for (std::size_t i = 0; i < size; ++i) {
            appendLine(piece.sides[i], piece.corners[i], piece.corners[(i + 1) % size], polygon);
        }
        Line *const longLine = piece.sides[0].line;
        if (!piece.isWhole && !longLine->parts[0]) {
            auto const [other, isFirst] =
                halves.emplace(std::make_pair(longLine, piece.baseFace), polygons.size());
            if (!isFirst) {
                // One runs along the line and the other back, with its rest in place of the line.
                Polygon &hexagon = polygons[other->second];
                hexagon.vertices.insert(hexagon.vertices.begin() + 1, polygon.vertices.begin() + 2,
                                        polygon.vertices.end());
                hexagon.places.insert(hexagon.places.begin() + 1, polygon.places.begin() + 2,
                                      polygon.places.end());
                continue;
            }
        }
        polygons.push_back(std::move(polygon));
    }
    return polygons;
}

ReferenceMesh CellReference::MakeMesh() const {
    ReferenceMesh mesh;
    for (int i = 0; i < _numVertices; ++i) {
        mesh.add_vertex({double(i), 0, 0});
    }
    for (Polygon const &polygon : GetPolygons()) {
        std::vector<OpenMesh::VertexHandle> verts;
        for (int const vertex : polygon.vertices) {
            verts.emplace_back(vertex);
        }
        if (!mesh.add_face(verts).is_valid()) {
            throw std::runtime_error("OpenMesh does not take a polygon of cells");
        }
    }
    return mesh;
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "limitReference.h"

#include "taggedRules.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

using namespace TaggedRules;

namespace {

/// Steps from which on the rules are the same for ever.
constexpr int kLastRule = 4;

int bitsOf(float number) {
    int bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    return bits;
}

/// The faces within some rings of a vertex, those that are joined by edges first, each with the place
/// that it was come to: so the order depends on nothing but the first.
std::vector<Side> findFaces(TaggedMesh const &mesh, int vertex, Side start, int numRings) {
    std::vector<int> rings(mesh.faces.size(), -1);
    std::vector<int> around{vertex};
    for (int ring = 0; ring < numRings; ++ring) {
        std::set<int> next;
        for (int v : around) {
            for (Side corner : mesh.vertices[v].corners) {
                if (rings[corner.face] < 0) {
                    rings[corner.face] = ring;
                    next.insert(mesh.faces[corner.face].vertices.begin(),
                                mesh.faces[corner.face].vertices.end());
                }
            }
        }
        around.assign(next.begin(), next.end());
    }
    std::vector<Side> faces;
    std::size_t numSpread = 0;
    auto const add = [&](Side side) {
        if (rings[side.face] >= 0) {
            rings[side.face] = -1;
            faces.push_back(side);
        }
    };
    auto const spread = [&] {
        for (; numSpread < faces.size(); ++numSpread) {
            Side side = faces[numSpread];
            for (std::size_t i = 0; i < mesh.faces[side.face].vertices.size(); ++i) {
                for (Side other : mesh.edges[mesh.faces[side.face].edges[side.place]].sides) {
                    add(other);
                }
                side = nextSide(mesh, side);
            }
        }
    };
    add(start);
    spread();
    // Where fans touch, the faces of one lead to those of the others.
    std::size_t numDone = 0;
    while (numDone < faces.size()) { // which become more
        for (int v : mesh.faces[faces[numDone++].face].vertices) {
            for (Side corner : mesh.vertices[v].corners) {
                add(corner);
                spread();
            }
        }
    }
    return faces;
}

} // namespace

LimitReference::Piece LimitReference::cutOut(TaggedMesh const &mesh, int vertex, Side start,
                                             bool comesIn) const {
    std::vector<Side> const faces = findFaces(mesh, vertex, start, _numRings);
    Piece piece;
    piece.comesIn = comesIn;
    TaggedMesh &part = piece.mesh;
    Signature &signature = piece.signature;
    part.chaikin = mesh.chaikin;
    part.freeBoundaries = mesh.freeBoundaries;
    part.madeBy = mesh.madeBy;
    part.numHexagonalSteps = std::min(mesh.numHexagonalSteps, kLastRule);
    part.hasFirstLines = mesh.hasFirstLines;
    signature = {part.chaikin,           part.freeBoundaries,      int(part.madeBy),
                 part.numHexagonalSteps, mesh.faceOrigins.empty(), comesIn,
                 part.hasFirstLines};
    auto const getKind = [](TaggedMesh::FaceOrigin const &origin) {
        return origin.edge >= 0 ? 1 : origin.face >= 0 ? 0 : 2;
    };

    std::map<int, int> numbers; // of faces
    std::map<int, int> vertices{{vertex, 0}};
    piece.sources.push_back(vertex);
    for (Side const &entry : faces) {
        numbers.emplace(entry.face, int(numbers.size()));
        Face const &face = mesh.faces[entry.face];
        auto const size = face.vertices.size();
        Face copy;
        copy.isHalf = face.isHalf;
        copy.vertices.resize(size);
        copy.edges.resize(size);
        copy.holes.assign(size, false); // of no matter for values
        copy.pathsOut.resize(size);
        copy.pathsIn.resize(size);
        copy.linesOut.resize(size);
        copy.linesIn.resize(size);
        signature.insert(signature.end(), {int(size), face.isHalf, face.isHalf ? entry.place : 0});
        for (std::size_t i = 0; i < size; ++i) {
            std::size_t const place = (std::size_t(entry.place) + i) % size;
            auto const [found, isNew] =
                vertices.emplace(face.vertices[place], int(piece.sources.size()));
            if (isNew) {
                piece.sources.push_back(face.vertices[place]);
            }
            // Half faces begin with their long edge, others with where they were come to.
            std::size_t const to = face.isHalf ? place : i;
            copy.vertices[to] = found->second;
            signature.push_back(found->second);
            if (!face.pathsOut.empty()) {
                copy.pathsOut[to] = Shorten(face.pathsOut[place]);
                copy.pathsIn[to] = Shorten(face.pathsIn[place]);
            }
            if (!face.linesOut.empty()) {
                copy.linesOut[to] = face.linesOut[place];
                copy.linesIn[to] = face.linesIn[place];
            }
            for (LinePath const &path : {copy.linesOut[to].away, copy.linesOut[to].at,
                                         copy.linesIn[to].away, copy.linesIn[to].at}) {
                std::string const flag = path.flag + path.steps;
                signature.push_back(int(flag.size()));
                signature.insert(signature.end(), flag.begin(), flag.end());
                signature.insert(signature.end(), {bitsOf(path.sharpness), bitsOf(path.cross)});
            }
            for (QuadPath const &path : {copy.pathsOut[to], copy.pathsIn[to]}) {
                signature.push_back(int(path.steps.size()));
                signature.insert(signature.end(), path.steps.begin(), path.steps.end());
                signature.push_back(bitsOf(path.sharpness));
            }
        }
        part.faces.push_back(std::move(copy));
        if (!mesh.faceOrigins.empty()) {
            TaggedMesh::FaceOrigin origin;
            int const kind = getKind(mesh.faceOrigins[entry.face]);
            (kind == 1 ? origin.edge : kind == 0 ? origin.face : origin.vertex) = 0;
            part.faceOrigins.push_back(origin);
            signature.push_back(kind);
        }
    }
    for (int const source : piece.sources) {
        TaggedMesh::Vertex copy = mesh.vertices[source];
        copy.corners.clear();
        signature.insert(signature.end(),
                         {bitsOf(copy.sharpness), copy.isNonManifold, int(copy.formerFaces)});
        part.vertices.push_back(copy);
        if (!mesh.vertexOrigins.empty()) {
            TaggedMesh::VertexOrigin origin;
            bool const isOfFace = mesh.vertexOrigins[source].face >= 0;
            (isOfFace ? origin.face : origin.vertex) = 0;
            part.vertexOrigins.push_back(origin);
            signature.push_back(isOfFace);
        }
    }
    // Edges in the order in which the faces run them.
    std::map<int, int> edges;
    std::map<int, int> lines;
    for (Side const &entry : faces) {
        Face const &face = mesh.faces[entry.face];
        auto const size = face.vertices.size();
        for (std::size_t i = 0; i < size; ++i) {
            int const number = face.edges[(std::size_t(entry.place) + i) % size];
            auto const [found, isNew] = edges.emplace(number, int(part.edges.size()));
            signature.push_back(found->second);
            if (!isNew) {
                continue;
            }
            Edge copy = mesh.edges[number];
            copy.sides.clear();
            for (Side side : mesh.edges[number].sides) {
                auto const inPart = numbers.find(side.face);
                if (inPart == numbers.end()) {
                    continue;
                }
                Side const &first = faces[std::size_t(inPart->second)];
                int const sideSize = int(mesh.faces[side.face].vertices.size());
                bool const isHalf = mesh.faces[side.face].isHalf;
                copy.sides.push_back(
                    {inPart->second,
                     isHalf ? side.place : (side.place + sideSize - first.place) % sideSize});
            }
            if (copy.sides.size() < mesh.edges[number].sides.size() && !copy.isLong) {
                copy.isFree = true; // at the end of what was cut out
                copy.sharpness = 0;
            }
            if (copy.line >= 0) {
                copy.line = lines.emplace(copy.line, int(lines.size())).first->second;
            }
            signature.insert(signature.end(),
                             {int(copy.sides.size()), copy.isLong, copy.isFree, copy.line,
                              bitsOf(copy.sharpness), bitsOf(copy.regularLine)});
            part.edges.push_back(std::move(copy));
        }
    }
    connect(part);
    return piece;
}

// Refines a piece until it is one that is known; gives the signature of the first.
LimitReference::Signature LimitReference::addSteps(Piece piece) {
    constexpr int kMaxSteps = 60;
    Signature first = piece.signature;
    for (int step = 0; _steps.count(piece.signature) == 0; ++step) {
        if (step == kMaxSteps) {
            throw std::runtime_error("what is around a vertex never repeats itself");
        }
        TaggedMesh const &mesh = piece.mesh;
        TaggedMesh const child = Refine(mesh);
        // The face that an edge of the first face makes, on its side, is first again: by turns the edge
        // that leaves the vertex and that which comes in, or else the first would go around the vertex.
        Side start = mesh.vertices[0].corners.front();
        Side const other = previousSide(mesh, start);
        auto const isLong = [&](Side side) {
            return mesh.edges[mesh.faces[side.face].edges[side.place]].isLong;
        };
        if (isLong(piece.comesIn ? other : start) ? !piece.comesIn : piece.comesIn) {
            start = other;
        }
        int const edge = mesh.faces[start.face].edges[start.place];
        std::vector<Side> const &sides = mesh.edges[edge].sides;
        int const side = sides[0].face == start.face && sides[0].place == start.place ? 0 : 1;
        int const vertex = child.vVertices[0];
        Side childStart = {-1, -1};
        for (Side corner : child.vertices[vertex].corners) {
            TaggedMesh::FaceOrigin const &origin = child.faceOrigins[corner.face];
            if (origin.edge == edge && (!child.faces[corner.face].isHalf || origin.side == side)) {
                childStart = corner;
            }
        }
        if (childStart.face < 0) {
            throw std::runtime_error("an edge made no face");
        }
        Piece next = cutOut(child, vertex, childStart, !piece.comesIn);
        auto const size = Eigen::Index(piece.sources.size());
        ReferenceValues const values =
            Interpolate(mesh, child, _mask, ReferenceValues::Identity(size, size));
        Eigen::MatrixXd matrix(Eigen::Index(next.sources.size()), size);
        for (std::size_t i = 0; i < next.sources.size(); ++i) {
            matrix.row(Eigen::Index(i)) = values.row(next.sources[i]);
        }
        _steps[piece.signature] = {next.signature, std::move(matrix)};
        piece = std::move(next);
    }
    return first;
}

Eigen::RowVectorXd const &LimitReference::findRow(Signature const &signature) {
    // Back from the first piece that is known, or that comes again.
    std::vector<Signature> path;
    std::set<Signature> met;
    Signature last = signature;
    while (_rows.count(last) == 0 && met.insert(last).second) {
        path.push_back(last);
        last = _steps.at(last).next;
    }
    if (_rows.count(last) == 0) {
        _rows[last] = findRowOfCycle(last);
    }
    for (auto it = path.rbegin(); it != path.rend(); ++it) {
        if (_rows.count(*it) == 0) {
            Step const &step = _steps.at(*it);
            _rows[*it] = _rows.at(step.next) * step.matrix;
        }
    }
    return _rows.at(signature);
}

Eigen::RowVectorXd LimitReference::findRowOfCycle(Signature const &signature) const {
    Eigen::Index const size = _steps.at(signature).matrix.cols();
    Eigen::MatrixXd cycle = Eigen::MatrixXd::Identity(size, size);
    Signature next = signature;
    do {
        Step const &step = _steps.at(next);
        cycle = step.matrix * cycle;
        next = step.next;
    } while (next != signature);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Unit(size, 0);
    constexpr int kMaxTurns = 1000;
    for (int turn = 0; turn < kMaxTurns; ++turn) {
        Eigen::RowVectorXd const before = row;
        row = before * cycle;
        if ((row - before).cwiseAbs().maxCoeff() < 1e-15) {
            return row;
        }
    }
    throw std::runtime_error("a vertex does not come to rest");
}

Eigen::RowVectorXd LimitReference::Find(TaggedMesh const &mesh, ReferenceValues const &values,
                                        int vertex) {
    Side start = mesh.vertices[vertex].corners.front();
    for (Fan const &fan : findFans(mesh, vertex)) {
        if (!fan.isClosed) {
            start = fan.corners.front();
        }
    }
    Piece piece = cutOut(mesh, vertex, start, false);
    std::vector<int> const sources = piece.sources;
    Eigen::RowVectorXd const &row = findRow(addSteps(std::move(piece)));
    Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(values.cols());
    for (std::size_t i = 0; i < sources.size(); ++i) {
        result += row[Eigen::Index(i)] * values.row(sources[i]);
    }
    return result;
}

} // namespace OpenSubdivHex::Regression

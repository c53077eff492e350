// SPDX-License-Identifier: Apache-2.0
#include "quadLineSearch.h"

#include "besideLines.h"
#include "ripple.h"

#include "far_ext/rules/mask.h"
#include "far_ext/rules/quadLine.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::FaceMask;
using FarExt::internal::Level;
using FarExt::internal::LineRole;
using FarExt::internal::QuadLineCorner;
using FarExt::internal::QuadLineRow;

constexpr int kSidesOfQuad = 4;
constexpr int kQuadsOfStrip = 2;    // at a vertex of the line
constexpr double kStripTop = 2;     // of what is looked at, in rows
constexpr int kMeansPerRow = 8;     // in a strip
constexpr int kRingsOfHalfDisk = 4; // that are looked at
constexpr int kLevelOfJudge = 5;
FarExt::HexSchemeOptions const kSmoothBesideLines{FaceMask::Smooth};

namespace quadLines {
struct TableRow {
    int numQuads;
    char flag;
    char const *path;
    int ofVertex;
    int parts[FarExt::kHexagon];
};
constexpr int kNone = FarExt::internal::MaskTable::kNone;
constexpr TableRow kTable[] = {
#include "far_ext/rules/quadLineRows.inl"
};
} // namespace quadLines
using QuadLineTableRow = quadLines::TableRow;
auto const &kQuadLineTable = quadLines::kTable;
constexpr int kNumQuadLineRows = int(std::size(kQuadLineTable));

bool isOfHalf(QuadLineTableRow const &row) {
    bool const isAlongLine = row.flag == 'a';
    return isAlongLine && row.path[0] == '1' && row.path[1 + std::strspn(row.path + 1, "0")] == 0;
}
int getSize(QuadLineTableRow const &row) {
    bool const isOfQuad = row.path[std::strspn(row.path, "0")] == 0;
    return isOfQuad || isOfHalf(row) ? kSidesOfQuad : FarExt::kHexagon;
}

SearchRows makeQuadLineRows() {
    SearchRows rows;
    for (QuadLineTableRow const &shipped : kQuadLineTable) {
        SearchRow &row = rows.emplace_back();
        row.size = getSize(shipped);
        int const *const behind = shipped.parts + row.size;
        row.isSymmetric = std::equal(shipped.parts + 1, behind, std::make_reverse_iterator(behind));
        row.ofVertex =
            shipped.ofVertex == quadLines::kNone ? SearchRow::kNone : shipped.ofVertex / row.parts;
        std::transform(shipped.parts, behind, row.weights,
                       [&row](int part) { return part / row.parts; });
    }
    return rows;
}

/// The masks where no row is, and V' of plain vertices.
SearchRows makeQuadLineStart() {
    using FarExt::Interpolation;
    constexpr int kBesideLongEdge = 2; // place in half a hexagon
    SearchRows rows = makeQuadLineRows();
    double half[kSidesOfQuad * kSidesOfQuad];
    FarExt::ComputeHalfFaceVertexMask(FaceMask::Smooth, Interpolation::Vertex, kSidesOfQuad, half);
    for (int i = 0; i < kNumQuadLineRows; ++i) {
        SearchRow &row = rows[std::size_t(i)];
        QuadLineTableRow const &shipped = kQuadLineTable[i];
        bool const isAtBaseVertex = shipped.path[std::strspn(shipped.path, "3")] == 0;
        int const numFaces = isAtBaseVertex ? kSidesOfQuad : 3;
        row.ofVertex = row.ofVertex == SearchRow::kNone ? row.ofVertex : 1.0 / (1 + numFaces);
        if (row.size == FarExt::kHexagon) {
            FarExt::ComputeFaceVertexMask(FaceMask::Smooth, Interpolation::Vertex, row.size,
                                          row.weights);
        } else if (!isOfHalf(shipped)) {
            std::copy_n(FarExt::ComputeQuadMask(int(std::strlen(shipped.path))).inQuad, row.size,
                        row.weights);
        } else {
            for (int j = 0; j < row.size; ++j) {
                row.weights[j] =
                    half[row.size * kBesideLongEdge + (kBesideLongEdge + j) % row.size];
            }
        }
    }
    return rows;
}

std::vector<CornerRow> findQuadLineRows(Level const &level) {
    std::vector<CornerRow> result(std::size_t(level.numCorners));
    for (QuadLineCorner const &quad : level.quadLineCorners) {
        QuadLineRow ofCorner = {FarExt::internal::kNoMaskRow, false, 0};
        for (LineRole const role : FarExt::internal::kLineRoles) {
            QuadLineRow const ofRole =
                FarExt::internal::FindQuadLineRow(level.numHexagonalSteps, quad.flags, role);
            ofCorner = ofRole.share > 0 ? ofRole : ofCorner;
        }
        auto const [found, isHalf, share] = ofCorner;
        if (share == 0) {
            continue;
        }
        CornerRow &row = result[std::size_t(quad.corner)];
        int const face = level.FindFaceOfCorner(quad.corner);
        int const local = quad.corner - level.faceFirstCorner[std::size_t(face)];
        row.ofFVertex = found.position;
        row.ofVertex = found.vertexWeight < 0 ? CornerRow::kNone : found.position;
        if (isHalf) {
            row.SetPlacesInHalf(level, face, local, found.isBackwards);
        } else {
            row.SetPlaces(local, level.GetFaceSize(face), found.isBackwards);
        }
    }
    return result;
}

MaskedSurface makeSurfaceOfQuads(Shape const &shape, int level, SearchRows const &shipped) {
    return MaskedSurface(shape, kSmoothBesideLines, level, shipped, findQuadLineRows);
}

/// Unit squares in the upper half plane, five by five, with the y axis through the middle of a column.
Shape makeStripOfQuads() {
    constexpr int kNumSquares = 5;
    constexpr int kWidth = kNumSquares + 1;
    Shape shape;
    shape.name = "strip of quads";
    shape.closed = false;
    for (int row = 0; row <= kNumSquares; ++row) {
        for (int column = 0; column <= kNumSquares; ++column) {
            shape.positions.insert(shape.positions.end(),
                                   {column - kNumSquares / 2.0, double(row), 0.0});
        }
    }
    for (int row = 0; row < kNumSquares; ++row) {
        for (int column = 0; column < kNumSquares; ++column) {
            int const v = row * kWidth + column;
            shape.faceSizes.push_back(kSidesOfQuad);
            shape.faceVertices.insert(shape.faceVertices.end(),
                                      {v, v + 1, v + kWidth + 1, v + kWidth});
        }
    }
    return shape;
}

Shape makeShapeOfQuads(int numQuads) {
    constexpr int kNumControlRings = 4;
    return numQuads == kQuadsOfStrip
               ? makeStripOfQuads()
               : MakeVertexDisk(Tiling::Quads, numQuads, kNumControlRings, DiskPart::Half);
}

} // namespace

QuadLineSearch::QuadLineSearch(int numQuads, int level)
    : TableSearch(makeQuadLineRows()), _numQuads(numQuads), _shape(makeShapeOfQuads(numQuads)),
      _surface(makeSurfaceOfQuads(_shape, level, getShipped())),
      _lifted(PlaneDerivatives::Lift(_shape, 0)) {
    std::vector<int> searched;
    for (int i = 0; i < kNumQuadLineRows; ++i) {
        if (kQuadLineTable[i].numQuads == numQuads && _surface.IsUsed(i)) {
            searched.push_back(i);
        }
    }
    search(searched, makeQuadLineStart());
    keepRests(_surface.GetRowsOfVertices());
    chooseVertices();
    if (isStrip()) {
        for (auto const &[numU, numV] : {std::pair(14, 8), std::pair(9, 6)}) {
            double const width = 1.0 / numV;
            addTorusRow(MakeCreasedTorus(numU, numV, TorusFaces::Quads), numU, 0, width, level);
            addTorusRow(MakeOpenTorus(numU, numV, TorusFaces::Quads), numU, width, width, level);
        }
    }
}

bool QuadLineSearch::isStrip() const { return _numQuads == kQuadsOfStrip; }

// In the strip the half of a period that the other is an image of, in half a disk the half likewise, near the vertex more
// than by area.
void QuadLineSearch::chooseVertices() {
    constexpr double kTolerance = 1e-6;
    constexpr double kMargin = 0.03;
    constexpr double kOfRings[kRingsOfHalfDisk] = {0.35, 0.3, 0.25, 0.1};
    PolygonMesh const &mesh = _surface.GetMesh();
    std::vector<double> const areas = ComputeVertexAreas(mesh);
    std::vector<int> vertices;
    std::vector<std::pair<int, double>> groups; // at which distance in them
    for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
        Eigen::Vector3d const &position = mesh.positions[std::size_t(vertex)];
        double const rings = -std::log2(position.head<2>().norm());
        bool const isChosen =
            isStrip() ? position.x() > -kTolerance && position.x() < 0.5 + kTolerance &&
                            position.y() > kMargin && position.y() < kStripTop
                      : position.x() > -kTolerance && rings > 0 && rings <= kRingsOfHalfDisk;
        if (isChosen) {
            double const place = isStrip() ? position.y() * kMeansPerRow : std::floor(rings);
            vertices.push_back(vertex);
            groups.emplace_back(int(place), place - std::floor(place));
            _heights.push_back(position.y());
            _areas.push_back(areas[std::size_t(vertex)]);
        }
    }
    // Means are piecewise linear functions of the distance, or constant in a ring.
    int const numGroups = isStrip() ? int(kStripTop) * kMeansPerRow + 1 : kRingsOfHalfDisk;
    Eigen::VectorXd ofGroups = Eigen::VectorXd::Zero(numGroups);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        ofGroups[groups[i].first] += _areas[i];
    }
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(Eigen::Index(vertices.size()), numGroups);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        auto const [group, behind] = groups[i];
        _areas[i] *= isStrip() ? 1 / ofGroups.sum() : kOfRings[group] / ofGroups[group];
        means(Eigen::Index(i), group) = (1 - behind) * std::sqrt(_areas[i]);
        if (behind > 0) {
            means(Eigen::Index(i), group + 1) = behind * std::sqrt(_areas[i]);
        }
    }
    _means = Eigen::HouseholderQR<Eigen::MatrixXd>(means).householderQ() *
             Eigen::MatrixXd::Identity(means.rows(), means.cols());
    _derivatives = PlaneDerivatives(mesh, vertices);
    _surface.NeedOnly(_derivatives.GetNeeded());
}

void QuadLineSearch::addTorusRow(Shape const &torus, int numU, double line, double rowWidth,
                                 int level) {
    TorusRow row = {makeSurfaceOfQuads(torus, level, getShipped()), {}};
    PolygonMesh const &mesh = row.surface.GetMesh();
    row.chosen = FindTorusStrip(mesh, numU, line, rowWidth, 0);
    row.surface.NeedOnly(PlaneDerivatives(mesh, row.chosen.vertices).GetNeeded());
    _torusRows.push_back(std::move(row));
}

Eigen::VectorXd QuadLineSearch::measureLifts(SearchRows const &rows) const {
    // Weights of parts: x^2 less its mean, all of x^2, x y, y^2 less its mean, all of y^2.
    struct Parts {
        double xxTrace;
        double xxRest;
        double xx;
        double xy;
        double yy;
        double yyAll;
    };
    constexpr Parts kOfStrip = {1, 1, 0.7, 1, 1, 0.5};
    constexpr Parts kOfHalfDisk = {1.4, 0.4, 0.2, 0.3, 0.3, 0};
    Parts const parts = isStrip() ? kOfStrip : kOfHalfDisk;

    std::vector<Eigen::Matrix3d> const derivatives =
        _derivatives.Compute(_surface.Refine(rows, _lifted));
    auto const size = Eigen::Index(derivatives.size());
    Eigen::VectorXd root(size);
    Eigen::Matrix<Eigen::VectorXd, 3, 3> of; // of x^2 / 2, x y and y^2 / 2, by column
    for (int derivative = 0; derivative < 3; ++derivative) {
        for (int lift = 0; lift < 3; ++lift) {
            Eigen::VectorXd &values = of(derivative, lift);
            values.resize(size);
            for (Eigen::Index i = 0; i < size; ++i) {
                auto const d = derivatives[std::size_t(i)].row(derivative);
                root[i] = std::sqrt(_areas[std::size_t(i)]);
                values[i] = root[i] * (lift == 1   ? d[2]
                                       : lift == 0 ? (d[0] + d[1]) / 2
                                                   : (d[0] - d[1]) / 2);
            }
        }
    }
    Eigen::VectorXd profile(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        profile[i] = root[i] * std::min(1.0, _heights[std::size_t(i)]);
    }
    auto const withoutMean = [this](Eigen::VectorXd const &values) -> Eigen::VectorXd {
        return values - _means * (_means.transpose() * values);
    };
    double const half = std::sqrt(0.5);
    std::vector<Eigen::VectorXd> const columns = {
        parts.xxTrace * half * withoutMean(of(0, 0) + of(2, 0)),
        parts.xxRest * half * withoutMean(of(0, 0) - of(2, 0)),
        parts.xxRest * withoutMean(of(1, 0)),
        parts.xx * (of(0, 0) - root),
        parts.xx * of(2, 0),
        parts.xy * of(0, 1),
        parts.xy * (of(1, 1) - root),
        parts.xy * of(2, 1),
        parts.yy * withoutMean(of(0, 2)),
        parts.yy * of(1, 2),
        parts.yy * withoutMean(of(2, 2)),
        parts.yyAll * of(0, 2),
        parts.yyAll * (of(2, 2) - profile)};
    Eigen::VectorXd result(size * Eigen::Index(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) {
        result.segment(Eigen::Index(i) * size, size) = columns[i];
    }
    return result;
}

Eigen::VectorXd QuadLineSearch::measureMore(SearchRows const &rows,
                                            Eigen::VectorXd const &weights) const {
    constexpr double kOfChange = 0.002; // of weights
    constexpr double kOfTori = 1.5;
    Eigen::VectorXd result = kOfChange * (weights - GetStart());
    for (TorusRow const &row : _torusRows) {
        Eigen::VectorXd const uneven = MeasureDeviations(
            row.surface.MakeMesh(rows), row.chosen.vertices, row.chosen.groups, Curvature::Mean);
        result.conservativeResize(result.size() + uneven.size());
        result.tail(uneven.size()) = kOfTori * uneven;
    }
    return result;
}

auto QuadLineSearch::judgeMore(SearchRows const &rows) const -> std::vector<Entry> {
    constexpr int kNumRings = 3;
    std::vector<Entry> entries;
    auto const add = [&entries](std::string const &name, std::vector<double> const &values) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            entries.push_back({name + " " + std::to_string(i + 1), values[i]});
        }
    };
    auto const refine = [&](Shape const &shape) {
        return makeSurfaceOfQuads(shape, kLevelOfJudge, getShipped()).MakeMesh(rows);
    };
    if (!isStrip()) {
        add("ring", MeasureHalfDisk(refine(MakeHalfDisk(Tiling::Quads, _numQuads)), kNumRings));
        return entries;
    }
    for (auto const &[numU, numV] : {std::pair(14, 8), std::pair(20, 10), std::pair(9, 6)}) {
        std::string const size = std::to_string(numU) + " x " + std::to_string(numV);
        double const width = 1.0 / numV;
        add("crease of " + size + ", row",
            MeasureTorusStrips(refine(MakeCreasedTorus(numU, numV, TorusFaces::Quads)), numU, 0,
                               width, 2));
        add("border of " + size + ", row",
            MeasureTorusStrips(refine(MakeOpenTorus(numU, numV, TorusFaces::Quads)), numU, width,
                               width, 2));
    }
    constexpr int kNumAround = 12;
    constexpr int kNumRows = 8;
    for (double rowHeight : {1.0, 0.5}) {
        add("tube of rows of " + std::to_string(rowHeight).substr(0, 3) + ", quarter",
            MeasureTube(refine(MakeTube(kNumAround, kNumRows, rowHeight)),
                        GetTubeRowHeight(kNumAround, rowHeight), 4));
    }
    return entries;
}

void QuadLineSearch::print(SearchRows const &rows) const {
    for (int i = 0; i < kNumQuadLineRows; ++i) {
        SearchRow const &row = rows[std::size_t(i)];
        QuadLineTableRow const &shipped = kQuadLineTable[i];
        if (shipped.numQuads == _numQuads) {
            std::string const ofVertex =
                row.ofVertex == SearchRow::kNone
                    ? "kNone"
                    : std::to_string(std::max(1L, std::lround(row.parts * row.ofVertex)));
            std::printf("{%d, '%c', \"%s\", %s, %s},\n", _numQuads, shipped.flag, shipped.path,
                        ofVertex.c_str(), FormatMask(row).c_str());
        }
    }
}

} // namespace OpenSubdivHex::Regression

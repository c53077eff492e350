// SPDX-License-Identifier: Apache-2.0
#include "lineMaskSearch.h"

#include "evenness.h"

#include "far_ext/rules/lineRow.h"
#include "far_ext/rules/mask.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::FaceMask;
using FarExt::kHexagon;
using FarExt::internal::Level;
using FarExt::internal::LineFace;
using FarExt::internal::LineRowCorner;

constexpr int kTrapezoid = 4;
FarExt::HexSchemeOptions const kTruncate{FaceMask::Smooth, FarExt::SchemeType::Hexagonal,
                                         FarExt::FirstStep::Truncate};

constexpr LineFace kOnLine = LineFace::OnLine;
constexpr LineFace kHalf = LineFace::Half;
constexpr LineFace kBehind = LineFace::Behind;
constexpr LineFace kBeyond = LineFace::Beyond;
constexpr int kNone = -1;
struct LineTableRow {
    int numSteps;
    LineFace face;
    int place;
    int ofVertex;
    int parts[kHexagon];
};
constexpr LineTableRow kLineTable[] = {
#include "far_ext/rules/lineRows.inl"
};
constexpr int kNumLineRows = int(std::size(kLineTable));

SearchRows makeLineRows() {
    SearchRows rows;
    for (LineTableRow const &shipped : kLineTable) {
        SearchRow &row = rows.emplace_back();
        bool const hasMask = shipped.parts[0] > 0;
        row.size = !hasMask ? 0 : shipped.face == kHalf ? kTrapezoid : kHexagon;
        row.ofVertex = shipped.ofVertex == kNone ? SearchRow::kNone : shipped.ofVertex / row.parts;
        std::transform(shipped.parts, shipped.parts + row.size, row.weights,
                       [&row](int part) { return part / row.parts; });
    }
    return rows;
}

CornerRow findLineRow(Level const &level, LineRowCorner const &tag) {
    CornerRow result;
    for (int i = 0; i < kNumLineRows; ++i) {
        LineTableRow const &row = kLineTable[i];
        bool const isHalf = row.face == kHalf;
        int const mirrored = isHalf ? 5 - row.place : (7 - row.place) % kHexagon;
        if (row.numSteps != level.numHexagonalSteps || row.face != tag.face ||
            (row.place != tag.place && mirrored != tag.place)) {
            continue;
        }
        bool const isBackwards = row.place != tag.place;
        int const face = level.FindFaceOfCorner(tag.corner);
        int const local = tag.corner - level.faceFirstCorner[std::size_t(face)];
        result.ofVertex = row.ofVertex == kNone ? CornerRow::kNone : i;
        result.ofFVertex = row.parts[0] > 0 ? i : CornerRow::kNone;
        if (isHalf && result.ofFVertex != CornerRow::kNone) {
            result.SetPlacesInHalf(level, face, local, isBackwards);
        } else {
            result.SetPlaces(local, kHexagon, isBackwards);
        }
    }
    return result;
}

std::vector<CornerRow> findLineRows(Level const &level) {
    std::vector<CornerRow> result(std::size_t(level.numCorners));
    int last = kNone;
    for (LineRowCorner const &tag : level.lineRowCorners) {
        // Between two lines, which are as sharp here, there is no row.
        bool const isFirst = tag.corner != last;
        result[std::size_t(tag.corner)] = isFirst ? findLineRow(level, tag) : CornerRow();
        last = tag.corner;
    }
    KeepWholeVertices(level, result);
    return result;
}

double const kRowHeight = std::sqrt(0.75);
constexpr int kNumColumnsOfStrip = 9;
constexpr int kNumRowsOfStrip = 5;
constexpr double kCenter = 3.5; // x of a period in the middle

/// Rows of equilateral triangles with sides of 1, along the x axis.
Shape makeStrip(int numColumns, int numRows) {
    Shape shape;
    shape.name = "strip";
    shape.closed = false;
    for (int row = 0; row <= numRows; ++row) {
        for (int column = 0; column <= numColumns; ++column) {
            shape.positions.insert(shape.positions.end(),
                                   {float(column - 0.5 * row), float(kRowHeight * row), 0});
        }
    }
    int const width = numColumns + 1;
    for (int row = 0; row < numRows; ++row) {
        for (int column = 0; column < numColumns; ++column) {
            int const v = row * width + column;
            shape.faceSizes.insert(shape.faceSizes.end(), {3, 3});
            shape.faceVertices.insert(shape.faceVertices.end(),
                                      {v, v + 1, v + width + 1, v, v + width + 1, v + width});
        }
    }
    return shape;
}

SearchRows makeLineStart() {
    using FarExt::Interpolation;
    SearchRows rows = makeLineRows();
    double half[kTrapezoid * kTrapezoid];
    FarExt::ComputeHalfFaceVertexMask(FaceMask::Smooth, Interpolation::Vertex, kTrapezoid, half);
    constexpr int kNumFaces = 3;
    for (int i = 0; i < kNumLineRows; ++i) {
        SearchRow &row = rows[std::size_t(i)];
        row.ofVertex = row.ofVertex == SearchRow::kNone ? row.ofVertex : 1.0 / (1 + kNumFaces);
        if (row.size == kHexagon) {
            FarExt::ComputeFaceVertexMask(FaceMask::Smooth, Interpolation::Vertex, kHexagon,
                                          row.weights);
        }
        int const place = kLineTable[i].place;
        for (int j = 0; j < row.size && row.size == kTrapezoid; ++j) {
            row.weights[j] = half[kTrapezoid * place + (place + j) % kTrapezoid];
        }
    }
    return rows;
}

} // namespace

LineMaskSearch::LineMaskSearch(int level)
    : TableSearch(makeLineRows()), _shape(makeStrip(kNumColumnsOfStrip, kNumRowsOfStrip)),
      _surface(_shape, kTruncate, level, getShipped(), findLineRows),
      _lifted(PlaneDerivatives::Lift(_shape, kCenter)) {
    std::vector<int> searched(getShipped().size());
    std::iota(searched.begin(), searched.end(), 0);
    search(searched, makeLineStart());
    keepRests(_surface.GetRowsOfVertices());
    chooseVertices();
}

void LineMaskSearch::chooseVertices() {
    constexpr double kMargin = 0.125; // as beside the lines of tori
    constexpr int kNumGroups = 16;    // in two rows
    // By the masks that the search begins with, so that it does not depend on the library's.
    PolygonMesh const mesh = _surface.MakeMesh(getStart());
    std::vector<double> const areas = ComputeVertexAreas(mesh);
    double sum = 0;
    _areasOfGroups.assign(kNumGroups, 0);
    std::vector<int> vertices;
    for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
        Eigen::Vector3d const &position = mesh.positions[std::size_t(vertex)];
        double const x = position.x() - kCenter;
        double const rows = position.y() / kRowHeight;
        if (x < 0 || x >= 1 || rows < kMargin || rows >= 2) {
            continue;
        }
        vertices.push_back(vertex);
        _groups.push_back(int(rows * kNumGroups / 2));
        _areas.push_back(areas[std::size_t(vertex)]);
        sum += _areas.back();
    }
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        _areas[k] /= sum;
        _areasOfGroups[std::size_t(_groups[k])] += _areas[k];
    }
    _derivatives = PlaneDerivatives(mesh, vertices);
    _surface.NeedOnly(_derivatives.GetNeeded());
}

Eigen::VectorXd LineMaskSearch::measureLifts(SearchRows const &rows) const {
    constexpr double kOfMean = 0.1; // of what means at one distance deviate by
    std::vector<Eigen::Matrix3d> off = _derivatives.Compute(_surface.Refine(rows, _lifted));
    std::vector<Eigen::Matrix3d> means(_areasOfGroups.size(), Eigen::Matrix3d::Zero());
    for (std::size_t k = 0; k < off.size(); ++k) {
        std::size_t const group = std::size_t(_groups[k]);
        off[k] -= PlaneDerivatives::GetExact();
        means[group] += _areas[k] / _areasOfGroups[group] * off[k];
    }
    std::vector<double> values;
    for (std::size_t k = 0; k < off.size(); ++k) {
        AddDeviation(std::sqrt(_areas[k]), off[k] - means[std::size_t(_groups[k])], 1, values);
    }
    for (std::size_t group = 0; group < means.size(); ++group) {
        AddDeviation(std::sqrt(_areasOfGroups[group]), kOfMean * means[group], 1, values);
    }
    return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
}

Eigen::VectorXd LineMaskSearch::measureMore(SearchRows const &,
                                            Eigen::VectorXd const &weights) const {
    constexpr double kOfChange = 0.03;
    return kOfChange * (weights - GetStart());
}

auto LineMaskSearch::judgeMore(SearchRows const &rows) const -> std::vector<Entry> {
    constexpr int kLevel = 5;
    std::vector<Entry> entries;
    for (std::pair<int, int> const &size : {std::pair(14, 8), std::pair(20, 10), std::pair(9, 6)}) {
        auto const [numU, numV] = size;
        double const width = 1.0 / numV;
        for (auto const &[line, torus, place] :
             {std::tuple("crease", MakeCreasedTorus(numU, numV, TorusFaces::Triangles), 0.0),
              std::tuple("border", MakeOpenTorus(numU, numV, TorusFaces::Triangles), width)}) {
            std::vector<double> const strips = MeasureTorusStrips(
                MaskedSurface(torus, kTruncate, kLevel, getShipped(), findLineRows).MakeMesh(rows),
                numU, place, width, 2);
            for (std::size_t row = 0; row < strips.size(); ++row) {
                entries.push_back({line + std::string(" of ") + std::to_string(numU) + " x " +
                                       std::to_string(numV) + ", row " + std::to_string(row + 1),
                                   strips[row]});
            }
        }
    }
    return entries;
}

void LineMaskSearch::print(SearchRows const &rows) const {
    constexpr char const *kNames[] = {"kOnLine", "kHalf", "kBehind", "kBeyond"};
    for (int i = 0; i < kNumLineRows; ++i) {
        SearchRow const &row = rows[std::size_t(i)];
        LineTableRow const &shipped = kLineTable[i];
        std::string const ofVertex = shipped.ofVertex == kNone
                                         ? "kNone"
                                         : std::to_string(std::lround(row.parts * row.ofVertex));
        std::printf("{%d, %s, %d, %s, %s},\n", shipped.numSteps, kNames[int(shipped.face)],
                    shipped.place, ofVertex.c_str(), FormatMask(row).c_str());
    }
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "quadMaskSearch.h"

#include "evenness.h"
#include "ripple.h"
#include "spectrum.h"

#include "far_ext/rules/mask.h"
#include "far_ext/rules/quadPath.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::FaceMask;
using FarExt::kHexagon;
using FarExt::internal::Level;
using FarExt::internal::QuadCorner;

constexpr int kQuad = 4;
constexpr int kNumRegular = 4; // faces at a vertex
constexpr int kNumRings = 3;
constexpr int kNumInQuads = FarExt::kNumStepsToConstantMasks - 1;
constexpr double kPartsInQuads = 256;
double const kPi = std::acos(-1.0);
FarExt::HexSchemeOptions const kSmooth{FaceMask::Smooth};

struct QuadTableRow {
    int numFaces;
    char const *path;
    int ofVertex;
    int parts[kHexagon];
};
constexpr QuadTableRow kQuadTable[] = {
#include "far_ext/rules/quadRows.inl"
};
constexpr int kNumQuadRows = int(std::size(kQuadTable));

/// The rows of the table, then the masks in quads, by level from 1 on.
SearchRows makeQuadRows() {
    SearchRows rows;
    for (QuadTableRow const &shipped : kQuadTable) {
        SearchRow &row = rows.emplace_back();
        int const *const first = shipped.parts;
        int const *const behind = first + kHexagon;
        bool const hasMask = std::any_of(first, behind, [](int part) { return part > 0; });
        row.size = hasMask ? kHexagon : 0;
        row.isSymmetric = std::equal(first + 1, behind, std::make_reverse_iterator(behind));
        row.ofVertex = shipped.ofVertex / row.parts;
        std::transform(first, behind, row.weights, [&row](int part) { return part / row.parts; });
    }
    for (int level = 1; level <= kNumInQuads; ++level) {
        SearchRow &row = rows.emplace_back();
        row.size = kQuad;
        row.isSymmetric = true;
        row.parts = kPartsInQuads;
        std::copy_n(FarExt::ComputeQuadMask(level).inQuad, kQuad, row.weights);
    }
    return rows;
}

std::vector<CornerRow> findQuadRows(Level const &level, SearchRows const &rows) {
    std::vector<CornerRow> result(std::size_t(level.numCorners));
    for (QuadCorner const &quad : level.quadCorners) {
        FarExt::internal::MaskRow const found =
            FarExt::internal::FindQuadRow(level.numHexagonalSteps, quad.flags);
        if (found.position < 0) {
            continue;
        }
        CornerRow &row = result[std::size_t(quad.corner)];
        row.ofVertex = found.position;
        if (rows[std::size_t(found.position)].size > 0) {
            int const face = level.FindFaceOfCorner(quad.corner);
            row.ofFVertex = found.position;
            row.SetPlaces(quad.corner - level.faceFirstCorner[std::size_t(face)], kHexagon,
                          found.isBackwards);
        }
    }
    KeepWholeVertices(level, result);
    if (level.numHexagonalSteps < 1 || level.numHexagonalSteps > kNumInQuads) {
        return result;
    }
    for (int face = 0; face < level.numFaces; ++face) {
        for (int i = 0; i < kQuad && level.GetFaceSize(face) == kQuad && !level.IsHalfFace(face);
             ++i) {
            CornerRow &row = result[std::size_t(level.faceFirstCorner[std::size_t(face)] + i)];
            row.ofFVertex = kNumQuadRows + level.numHexagonalSteps - 1;
            row.SetPlaces(i, kQuad, false);
        }
    }
    return result;
}

// A border that is no line, since there are other masks beside lines.
MaskedSurface makeQuadSurface(Shape const &shape, int level, SearchRows const &shipped) {
    return MaskedSurface(
        shape, kSmooth, level, shipped,
        [&shipped](Level const &parent) { return findQuadRows(parent, shipped); },
        OpenSubdiv::Sdc::Options::VTX_BOUNDARY_NONE);
}

} // namespace

QuadMaskSearch::QuadMaskSearch(int numFaces, int level)
    : TableSearch(makeQuadRows()), _numFaces(numFaces),
      _shape(MakeVertexDisk(Tiling::Quads, numFaces, kNumRings)),
      _surface(makeQuadSurface(_shape, level, getShipped())),
      _lifted(PlaneDerivatives::Lift(_shape, 0)) {
    std::vector<int> searched;
    for (int i = 0; i < int(getShipped().size()); ++i) {
        if (i < kNumQuadRows ? kQuadTable[i].numFaces == _numFaces && _surface.IsUsed(i)
                             : isRegular()) {
            searched.push_back(i);
        }
    }
    search(searched, makeStart());
    chooseVertices();
    if (isRegular()) {
        findCenters();
    }
}

bool QuadMaskSearch::isRegular() const { return _numFaces == kNumRegular; }

SearchRows QuadMaskSearch::makeStart() const {
    SearchRows rows = getShipped();
    for (int i = 0; i < kNumQuadRows; ++i) {
        SearchRow &row = rows[std::size_t(i)];
        if (kQuadTable[i].numFaces != _numFaces) {
            continue;
        }
        if (!isRegular()) {
            auto const *const same = std::find_if(
                std::begin(kQuadTable), std::end(kQuadTable), [&](QuadTableRow const &other) {
                    return other.numFaces == kNumRegular &&
                           std::string(other.path) == kQuadTable[i].path;
                });
            row = getShipped()[std::size_t(same - kQuadTable)];
            continue;
        }
        if (row.size > 0) {
            FarExt::ComputeFaceVertexMask(FaceMask::Smooth, FarExt::Interpolation::Vertex, row.size,
                                          row.weights);
        }
        constexpr int kNumFacesLater = 3; // at all other vertices
        std::string const path = kQuadTable[i].path;
        bool const isAtVertex = path.find_first_not_of("3*") == std::string::npos;
        row.ofVertex = 1.0 / (1 + (isAtVertex ? kNumRegular : kNumFacesLater));
    }
    for (std::size_t i = std::size_t(kNumQuadRows); i < rows.size(); ++i) {
        FarExt::ComputeFaceVertexMask(FaceMask::Smooth, FarExt::Interpolation::Vertex, kQuad,
                                      rows[i].weights);
    }
    return rows;
}

void QuadMaskSearch::chooseVertices() {
    constexpr double kTolerance = 1e-6;
    constexpr double kOuter = 1;
    constexpr double kInner = 1.0 / 17;
    constexpr double kOfRings = 0.4; // the rest by area
    PolygonMesh const &mesh = _surface.GetMesh();
    std::vector<double> const areas = ComputeVertexAreas(mesh);
    std::vector<int> vertices;
    std::vector<int> rings;
    std::vector<double> ofRings;
    double sum = 0;
    for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
        auto const position = mesh.positions[std::size_t(vertex)].head<2>();
        double const distance = position.norm();
        double const angle = std::atan2(position.y(), position.x());
        bool const isInSector =
            distance > 0 && angle > -kTolerance && angle < kPi / _numFaces + kTolerance;
        if (isRegular() ? (isInSector || distance == 0) && position.x() < 0.5 + kTolerance
                        : isInSector && distance > kInner && distance < kOuter) {
            vertices.push_back(vertex);
            double const area = areas[std::size_t(vertex)];
            rings.push_back(isRegular() ? 0 : int(std::floor(-std::log2(distance))));
            ofRings.resize(std::max(ofRings.size(), std::size_t(rings.back()) + 1));
            ofRings[std::size_t(rings.back())] += area;
            _areas.push_back(area);
            sum += area;
        }
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        double const ofRing = _areas[i] / ofRings[std::size_t(rings[i])] / double(ofRings.size());
        _areas[i] = kOfRings * ofRing + (1 - kOfRings) * _areas[i] / sum;
    }
    _derivatives = PlaneDerivatives(mesh, vertices);
    _surface.NeedOnly(_derivatives.GetNeeded());
}

void QuadMaskSearch::findCenters() {
    for (MeshCenter center : {MeshCenter{CenterKind::Vertex, 0}, MeshCenter{CenterKind::Face, 0}}) {
        for (int depth = 0; depth < FarExt::kNumStepsToConstantMasks; ++depth) {
            center = FindChild(center, _surface.GetRefiner().GetLevel(depth),
                               _surface.GetRefiner().GetLevel(depth + 1));
        }
        _centers.push_back(center);
    }
}

Eigen::VectorXd QuadMaskSearch::measureLifts(SearchRows const &rows) const {
    std::vector<Eigen::Matrix3d> const derivatives =
        _derivatives.Compute(_surface.Refine(rows, _lifted));
    Eigen::Matrix3d exact = PlaneDerivatives::GetExact();
    double bowl = 1;
    if (!isRegular()) {
        bowl = 0;
        for (std::size_t i = 0; i < derivatives.size(); ++i) {
            bowl += _areas[i] * (derivatives[i](0, 0) + derivatives[i](2, 0)) / 2;
        }
    }
    exact.col(0) *= bowl;
    double const ofSaddle = isRegular() ? 1 : 0.7;
    std::vector<double> values;
    for (std::size_t i = 0; i < derivatives.size(); ++i) {
        AddDeviation(std::sqrt(_areas[i]), derivatives[i] - exact, ofSaddle, values);
    }
    return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
}

// 0 where curvature is bounded around a vertex and around a quad.
Eigen::VectorXd QuadMaskSearch::measureMore(SearchRows const &rows, Eigen::VectorXd const &) const {
    // How much less than these further eigenvalues are, for curvature to settle soon.
    constexpr double kFurtherBowl = 0.9;
    constexpr double kFurtherTilt = 0.95;
    std::vector<double> values;
    for (MeshCenter const &center : _centers) {
        auto const eigenvalues = ComputeEigenvalues(MakeLocalSubdivision(
            _surface.GetRefiner(), FarExt::kNumStepsToConstantMasks, center, [&](int cVertex) {
                return _surface.GetRow(rows, FarExt::kNumStepsToConstantMasks, cVertex);
            }));
        auto const find = [&](int frequency, int rank) {
            for (Eigenvalue const &eigenvalue : eigenvalues) {
                if (eigenvalue.frequency == frequency && rank-- == 0) {
                    return std::abs(eigenvalue.value);
                }
            }
            return 0.0;
        };
        double const square = find(1, 0) * find(1, 0);
        values.push_back(find(0, 1) / square - 1);
        values.push_back(find(2, 0) / square - 1);
        values.push_back(std::max(0.0, find(0, 2) / square - kFurtherBowl));
        values.push_back(std::max(0.0, find(1, 1) / square - kFurtherTilt));
    }
    return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
}

auto QuadMaskSearch::judgeMore(SearchRows const &rows) const -> std::vector<Entry> {
    constexpr int kLevel = 5;
    std::vector<Entry> entries;
    auto const refine = [&](Shape const &shape) {
        return makeQuadSurface(shape, kLevel, getShipped()).MakeMesh(rows);
    };
    if (isRegular()) {
        for (auto const &[numU, numV] : {std::pair(14, 8), std::pair(9, 6), std::pair(7, 12)}) {
            entries.push_back(
                {"torus of " + std::to_string(numU) + " x " + std::to_string(numV),
                 MeasureTorusUnevenness(refine(MakeTorus(numU, numV, TorusFaces::Quads)), numU)});
        }
        return entries;
    }
    constexpr int kMostRegular = 5;
    Shape const shape = _numFaces > kMostRegular
                            ? MakeSphereHull(60, 200)
                            : MakeTrianglePlatonics()[_numFaces < kNumRegular ? 0 : 2];
    entries.push_back({shape.name + " as a sphere of quads",
                       MeasureSphereUnevenness(refine(MakeSphereOfQuads(shape)))});
    return entries;
}

void QuadMaskSearch::print(SearchRows const &rows) const {
    for (int i = 0; i < kNumQuadRows; ++i) {
        SearchRow const &row = rows[std::size_t(i)];
        if (kQuadTable[i].numFaces == _numFaces) {
            std::printf("{%d, \"%s\", %.0f, %s},\n", _numFaces, kQuadTable[i].path,
                        row.parts * row.ofVertex, FormatMask(row).c_str());
        }
    }
    for (int level = 1; level <= kNumInQuads && isRegular(); ++level) {
        std::printf("in quads, level %d: %s\n", level,
                    FormatMask(rows[std::size_t(kNumQuadRows + level - 1)]).c_str());
    }
}

} // namespace OpenSubdivHex::Regression

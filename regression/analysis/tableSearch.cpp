// SPDX-License-Identifier: Apache-2.0
#include "tableSearch.h"

#include "smoothness.h"

#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/refinementRows.h"
#include "far_ext/vtr/refinementRules.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::Interpolation;
using FarExt::internal::Level;
using FarExt::internal::RefinementRules;

/// A sum of vertices.
struct VertexSum {
    void Clear() { terms.clear(); }
    void AddWithWeight(VertexSum const &other, double weight) {
        for (auto const &[vertex, ofVertex] : other.terms) {
            terms[vertex] += weight * ofVertex;
        }
    }
    std::map<int, double> terms;
};

FarExt::internal::MeshLevels const &getLevels(FarExt::TopologyRefiner const &refiner) {
    return refiner.GetHierarchy().mesh;
}

MaskPoints getPoints(Shape const &shape) {
    MaskPoints points = MaskPoints::Zero(shape.GetNumVertices(), kNumMaskColumns);
    for (int i = 0; i < shape.GetNumVertices(); ++i) {
        points.row(i).head<3>() =
            Eigen::Map<Eigen::RowVector3d const>(&shape.positions[3 * std::size_t(i)]);
    }
    return points;
}

Eigen::VectorXd toVector(std::vector<double> const &values) {
    return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
}

} // namespace

void CornerRow::SetPlacesInHalf(Level const &level, int face, int local, bool isBackwards) {
    constexpr int kTrapezoid = 4;
    std::array<int, kTrapezoid> half = {0, 1, 2, 3};
    int const end = level.GetDiagonalEnd(face);
    for (int i = 0; i < kTrapezoid && !level.IsHalfFace(face); ++i) {
        half[std::size_t(i)] = FarExt::GetPlaceInHalves(local < end ? 1 : 0, i, end);
    }
    auto const first = int(std::find(half.begin(), half.end(), local) - half.begin());
    SetPlaces(first, kTrapezoid, isBackwards);
    for (int i = 0; i < kTrapezoid; ++i) {
        places[std::size_t(i)] = half[std::size_t(places[std::size_t(i)])];
    }
}

void KeepWholeVertices(Level const &level, std::vector<CornerRow> &rows) {
    for (int vert = 0; vert < level.numVertices; ++vert) {
        bool hasAll = true;
        for (int k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1]; ++k) {
            hasAll =
                hasAll && rows[std::size_t(level.GetVertexCorner(k))].ofVertex != CornerRow::kNone;
        }
        for (int k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1] && !hasAll; ++k) {
            rows[std::size_t(level.GetVertexCorner(k))].ofVertex = CornerRow::kNone;
        }
    }
}

MaskedSurface::MaskedSurface(Shape const &shape, FarExt::HexSchemeOptions schemeOptions, int level,
                             SearchRows const &rows, FindRows const &findRows,
                             OpenSubdiv::Sdc::Options::VtxBoundaryInterpolation boundary)
    : _schemeOptions(schemeOptions), _controlPoints(getPoints(shape)), _isUsed(rows.size(), false) {
    OpenSubdiv::Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    _refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(), options,
                                                      {schemeOptions});
    FarExt::TopologyRefiner::UniformOptions uniform(level);
    uniform.fullTopologyInLastLevel = true;
    if (!_refiner || !_refiner->RefineUniform(uniform)) {
        throw std::runtime_error(shape.name + " cannot be refined");
    }
    _mesh = MakeSurfaceLevels(*_refiner, shape).back().mesh;
    for (int depth = 0; depth < level; ++depth) {
        if (getLevels(*_refiner).refinements[std::size_t(depth)].isTruncation) {
            addTruncation(depth);
        } else {
            addStep(depth, rows, findRows(getLevels(*_refiner).levels[std::size_t(depth)]));
        }
    }
    NeedOnly({});
    constexpr double kTolerance = 1e-12;
    MaskPoints const points = Refine(rows, _controlPoints);
    for (int i = 0; i < _mesh.GetNumVertices(); ++i) {
        Eigen::RowVector3d const position = _mesh.positions[std::size_t(i)].transpose();
        if (!((position - points.row(i).head<3>()).norm() < kTolerance)) {
            throw std::runtime_error("vertex " + std::to_string(i) + " of " + shape.name +
                                     " is not where the library has it");
        }
    }
}

void MaskedSurface::addTruncation(int depth) {
    auto const &refinement = getLevels(*_refiner).refinements[std::size_t(depth)];
    int const numParents = refinement.parent->numVertices;
    std::vector<VertexSum> parents(static_cast<std::size_t>(numParents));
    for (int i = 0; i < numParents; ++i) {
        parents[std::size_t(i)].terms = {{i, 1}};
    }
    std::vector<VertexSum> children(std::size_t(refinement.child->numVertices));
    FarExt::internal::Interpolate<double>(
        FarExt::internal::RefinementRows(refinement, _schemeOptions, Interpolation::Vertex),
        parents, children);
    Step step = {numParents, std::vector<Made>(children.size()), {}};
    for (std::size_t i = 0; i < children.size(); ++i) {
        for (auto const &[vertex, weight] : children[i].terms) {
            step.made[i].sources.push_back({true, vertex, weight});
        }
    }
    _steps.push_back(std::move(step));
}

void MaskedSurface::addStep(int depth, SearchRows const &rows,
                            std::vector<CornerRow> const &ofCorners) {
    auto const &refinement = getLevels(*_refiner).refinements[std::size_t(depth)];
    Level const &level = *refinement.parent;
    Step step = {
        level.numVertices, std::vector<Made>(std::size_t(refinement.child->numVertices)), {}};
    RefinementRules const rules(level, _schemeOptions, Interpolation::Vertex);
    for (int face = 0; face < level.numFaces; ++face) {
        auto const verts = level.GetFaceVertices(face);
        auto const rule = rules.GetFaceRule(face);
        for (int i = 0; i < verts.size(); ++i) {
            int const corner = level.faceFirstCorner[std::size_t(face)] + i;
            CornerRow const &row = ofCorners[std::size_t(corner)];
            Made &made = step.made[std::size_t(refinement.GetCornerChildVertex(corner))];
            if (row.ofFVertex == CornerRow::kNone) {
                for (int j = 0; j < verts.size(); ++j) {
                    made.sources.push_back({true, verts[j], rule.GetRow(i)[j]});
                }
                continue;
            }
            _isUsed[std::size_t(row.ofFVertex)] = true;
            for (int j = 0; j < rows[std::size_t(row.ofFVertex)].size; ++j) {
                made.sources.push_back(
                    {true, verts[row.places[std::size_t(j)]], 0, row.ofFVertex, j});
            }
        }
    }
    std::set<std::vector<int>> rowsOfVertices(_rowsOfVertices.begin(), _rowsOfVertices.end());
    for (int vert = 0; vert < level.numVertices; ++vert) {
        Made &made = step.made[std::size_t(refinement.GetVertexChildVertex(vert))];
        int const first = level.vertFirstFace[vert];
        std::vector<int> ofVertex;
        for (int k = first; k < level.vertFirstFace[vert + 1]; ++k) {
            ofVertex.push_back(ofCorners[std::size_t(level.GetVertexCorner(k))].ofVertex);
        }
        auto const rule = rules.GetVertexRule(vert);
        for (int k = first; k < level.vertFirstFace[vert + 1]; ++k) {
            int const row = ofVertex[std::size_t(k - first)];
            made.sources.push_back({false,
                                    refinement.GetCornerChildVertex(level.GetVertexCorner(k)),
                                    rule.GetFaceWeight(k - first), row});
            if (row != CornerRow::kNone) {
                _isUsed[std::size_t(row)] = true;
                made.parent = vert;
            }
        }
        if (made.parent == CornerRow::kNone) {
            for (int i = 0; i < rule.numSources; ++i) {
                made.sources.push_back({true, rule.sources[i], rule.weights[i]});
            }
            continue;
        }
        std::sort(ofVertex.begin(), ofVertex.end());
        if (ofVertex.front() != CornerRow::kNone) {
            rowsOfVertices.insert(ofVertex);
        }
    }
    _rowsOfVertices.assign(rowsOfVertices.begin(), rowsOfVertices.end());
    _steps.push_back(std::move(step));
}

PolygonMesh MaskedSurface::MakeMesh(SearchRows const &rows) const {
    MaskPoints const points = Refine(rows, _controlPoints);
    PolygonMesh mesh = _mesh;
    for (int i = 0; i < mesh.GetNumVertices(); ++i) {
        mesh.positions[std::size_t(i)] = points.row(i).head<3>();
    }
    return mesh;
}

void MaskedSurface::NeedOnly(std::vector<int> const &vertices) {
    std::vector<char> needed(std::size_t(_mesh.GetNumVertices()), vertices.empty());
    for (int vertex : vertices) {
        needed[std::size_t(vertex)] = true;
    }
    for (auto step = _steps.rbegin(); step != _steps.rend(); ++step) {
        std::vector<char> before(std::size_t(step->numParents), vertices.empty());
        // V-vertices come first, and may have F-vertices for sources.
        for (std::size_t i = 0; i < step->made.size(); ++i) {
            Made const &made = step->made[i];
            if (!needed[i]) {
                continue;
            }
            for (Source const &source : made.sources) {
                (source.isOfParent ? before : needed)[std::size_t(source.vertex)] = true;
            }
            if (made.parent != CornerRow::kNone) {
                before[std::size_t(made.parent)] = true;
            }
        }
        step->needed = std::move(needed);
        needed = std::move(before);
    }
}

double MaskedSurface::getWeight(SearchRows const &rows, Source const &source) {
    if (source.row == CornerRow::kNone) {
        return source.weight;
    }
    SearchRow const &row = rows[std::size_t(source.row)];
    return source.place == kOfVertex ? row.ofVertex : row.weights[source.place];
}

MaskPoints MaskedSurface::Refine(SearchRows const &rows, MaskPoints points) const {
    for (Step const &step : _steps) {
        MaskPoints refined = MaskPoints::Zero(Eigen::Index(step.made.size()), kNumMaskColumns);
        // F-vertices, which come last, first.
        for (auto i = Eigen::Index(step.made.size()) - 1; i >= 0; --i) {
            Made const &made = step.made[std::size_t(i)];
            if (!step.needed[std::size_t(i)]) {
                continue;
            }
            double rest = 1;
            for (Source const &source : made.sources) {
                double const weight = getWeight(rows, source);
                refined.row(i) += weight * (source.isOfParent ? points.row(source.vertex)
                                                              : refined.row(source.vertex));
                rest -= weight;
            }
            if (made.parent != CornerRow::kNone) {
                refined.row(i) += rest * points.row(made.parent);
            }
        }
        points = std::move(refined);
    }
    return points;
}

ChildRow MaskedSurface::GetRow(SearchRows const &rows, int depth, int cVertex) const {
    std::vector<Made> const &allMade = _steps[std::size_t(depth)].made;
    std::map<int, double> result;
    Made const &made = allMade[std::size_t(cVertex)];
    double rest = 1;
    for (Source const &source : made.sources) {
        double const weight = getWeight(rows, source);
        rest -= weight;
        if (source.isOfParent) {
            result[source.vertex] += weight;
            continue;
        }
        for (Source const &ofFVertex : allMade[std::size_t(source.vertex)].sources) {
            result[ofFVertex.vertex] += weight * getWeight(rows, ofFVertex);
        }
    }
    if (made.parent != CornerRow::kNone) {
        result[made.parent] += rest;
    }
    return ChildRow(result.begin(), result.end());
}

PlaneDerivatives::PlaneDerivatives(PolygonMesh const &mesh, std::vector<int> const &vertices)
    : _vertices(vertices) {
    for (int vertex : _vertices) {
        _near.push_back(FindNearVertices(mesh, vertex));
    }
}

std::vector<int> PlaneDerivatives::GetNeeded() const {
    std::vector<int> needed;
    for (std::vector<int> const &near : _near) {
        needed.insert(needed.end(), near.begin(), near.end());
    }
    return needed;
}

std::vector<Eigen::Matrix3d> PlaneDerivatives::Compute(MaskPoints const &points) const {
    std::vector<Eigen::Matrix3d> result;
    for (std::size_t k = 0; k < _vertices.size(); ++k) {
        auto const center = points.row(_vertices[k]);
        double size = 0;
        for (int point : _near[k]) {
            size = std::max(size, (points.row(point) - center).head<2>().norm());
        }
        Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 3> right = Eigen::Matrix<double, 6, 3>::Zero();
        for (int point : _near[k]) {
            Eigen::Matrix<double, 1, kNumMaskColumns> const offset = points.row(point) - center;
            double const x = offset[0] / size;
            double const y = offset[1] / size;
            Eigen::Matrix<double, 6, 1> terms;
            terms << 1, x, y, x * x, x * y, y * y;
            normal += terms * terms.transpose();
            right += terms * offset.tail<3>();
        }
        Eigen::Matrix<double, 6, 3> const fit = normal.ldlt().solve(right);
        Eigen::Matrix3d &derivatives = result.emplace_back();
        derivatives << 2 * fit.row(3), fit.row(4), 2 * fit.row(5);
        derivatives /= size * size;
    }
    return result;
}

MaskPoints PlaneDerivatives::Lift(Shape const &shape, double center) {
    MaskPoints lifted = MaskPoints::Zero(shape.GetNumVertices(), kNumMaskColumns);
    for (int i = 0; i < shape.GetNumVertices(); ++i) {
        double const x = double(shape.positions[3 * std::size_t(i)]) - center;
        double const y = shape.positions[3 * std::size_t(i) + 1];
        lifted.row(i) << x, y, (x * x + y * y) / 2, (x * x - y * y) / 2, x * y;
    }
    return lifted;
}

Eigen::Matrix3d PlaneDerivatives::GetExact() {
    Eigen::Matrix3d exact;
    exact << 1, 1, 0, 0, 0, 1, 1, -1, 0;
    return exact;
}

void AddDeviation(double factor, Eigen::Matrix3d const &deviation, double ofSaddle,
                  std::vector<double> &values) {
    for (int lift = 0; lift < 3; ++lift) {
        auto const d = deviation.col(lift);
        double const ofLift = lift == 0 ? factor : factor * ofSaddle;
        values.insert(values.end(),
                      {ofLift * (d[0] + d[2]) / 2, ofLift * (d[0] - d[2]) / 2, ofLift * d[1]});
    }
}

TableSearch::~TableSearch() = default;

void TableSearch::search(std::vector<int> const &searched, SearchRows const &start) {
    _searched = searched;
    for (int row : searched) {
        _start[std::size_t(row)] = start[std::size_t(row)];
    }
}

template <typename FUNCTION>
void TableSearch::forEachFree(SearchRows &rows, FUNCTION const &function) const {
    for (int position : _searched) {
        SearchRow &row = rows[std::size_t(position)];
        row.ForEachFree([&](double &weight, int) { function(weight, row); });
    }
}

Eigen::VectorXd TableSearch::gather(SearchRows rows) const {
    std::vector<double> values;
    forEachFree(rows, [&](double weight, SearchRow const &) { values.push_back(weight); });
    return toVector(values);
}

SearchRows TableSearch::spread(Eigen::VectorXd const &weights) const {
    SearchRows rows = _shipped;
    double const *next = weights.data();
    forEachFree(rows, [&](double &weight, SearchRow const &) { weight = *next++; });
    for (int position : _searched) {
        SearchRow &row = rows[std::size_t(position)];
        for (int i = 1; i < row.size && row.isSymmetric; ++i) {
            row.weights[i] = row.weights[std::min(i, row.size - i)];
        }
        if (row.size > 0) {
            row.weights[0] = 1 - std::accumulate(row.weights + 1, row.weights + row.size, 0.0);
        }
    }
    return rows;
}

Eigen::VectorXd TableSearch::Round(Eigen::VectorXd const &weights) const {
    SearchRows rows = spread(weights);
    forEachFree(rows, [](double &weight, SearchRow const &row) {
        weight = std::round(row.parts * weight) / row.parts;
    });
    return gather(rows);
}

Eigen::VectorXd TableSearch::measureRests(SearchRows const &rows) const {
    constexpr double kOfNegative = 10;
    std::vector<double> values;
    for (int position : _searched) {
        values.push_back(kOfNegative * std::min(0.0, rows[std::size_t(position)].weights[0]));
    }
    for (std::vector<int> const &ofVertex : _rowsOfVertices) {
        double rest = 1;
        for (int row : ofVertex) {
            rest -= rows[std::size_t(row)].ofVertex;
        }
        values.push_back(kOfNegative * std::min(0.0, rest));
    }
    return toVector(values);
}

Eigen::VectorXd TableSearch::Measure(Eigen::VectorXd const &weights) const {
    SearchRows const rows = spread(weights);
    Eigen::VectorXd const parts[] = {measureLifts(rows), measureMore(rows, weights),
                                     measureRests(rows)};
    Eigen::VectorXd values(parts[0].size() + parts[1].size() + parts[2].size());
    values << parts[0], parts[1], parts[2];
    return values;
}

auto TableSearch::Judge(Eigen::VectorXd const &weights) const -> std::vector<Entry> {
    SearchRows const rows = spread(weights);
    std::vector<Entry> entries = judgeMore(rows);
    entries.insert(entries.begin(), {"quadratics", measureLifts(rows).norm()});
    return entries;
}

std::string FormatMask(SearchRow const &row) {
    std::string result = "{";
    for (int i = 0; i < row.size; ++i) {
        result += (i > 0 ? ", " : "") + std::to_string(std::lround(row.parts * row.weights[i]));
    }
    return result + "}";
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "lineMaskSearch.h"

#include "evenness.h"
#include "smoothness.h"
#include "surfaceLevels.h"

#include "far_ext/rules/lineRow.h"
#include "far_ext/rules/mask.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/refinementRows.h"
#include "far_ext/vtr/refinementRules.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::FaceMask;
using FarExt::HexSchemeOptions;
using FarExt::kHexagon;
using FarExt::internal::FindLineRow;
using FarExt::internal::Level;
using FarExt::internal::LineFace;
using FarExt::internal::LineRowCorner;
using FarExt::internal::RefinementRules;

constexpr int kTrapezoid = 4;
constexpr double kParts = 4096;
HexSchemeOptions const kTruncate{FaceMask::Smooth, FarExt::SchemeType::Hexagonal,
                                 FarExt::FirstStep::Truncate};

constexpr LineFace kOnLine = LineFace::OnLine;
constexpr LineFace kHalf = LineFace::Half;
constexpr LineFace kBehind = LineFace::Behind;
constexpr LineFace kBeyond = LineFace::Beyond;
constexpr int kNone = -1;
struct TableRow {
    int numSteps;
    LineFace face;
    int place;
    int ofVertex;
    int parts[kHexagon];

    bool HasMask() const { return parts[0] > 0; }
    int GetSize() const { return face == kHalf ? kTrapezoid : kHexagon; }
};
constexpr TableRow kTable[] = {
#include "far_ext/rules/lineRows.inl"
};
constexpr int kNumRows = int(std::size(kTable));

struct Row {
    double ofVertex;
    double weights[kHexagon];
};
using LineMasks = std::array<Row, kNumRows>;

LineMasks getShippedMasks() {
    LineMasks masks;
    for (int i = 0; i < kNumRows; ++i) {
        masks[std::size_t(i)].ofVertex = kTable[i].ofVertex / kParts;
        std::transform(kTable[i].parts, kTable[i].parts + kHexagon, masks[std::size_t(i)].weights,
                       [](int part) { return part / kParts; });
    }
    return masks;
}

/// The row of a corner, and whether it goes backwards around the face.
struct CornerRow {
    int position = kNone;
    bool isBackwards = false;
};

CornerRow findRow(int numSteps, LineRowCorner const &tag) {
    for (int i = 0; i < kNumRows; ++i) {
        TableRow const &row = kTable[i];
        bool const isThere = row.numSteps == numSteps && row.face == tag.face;
        int const mirrored = row.face == kHalf ? 5 - row.place : (7 - row.place) % kHexagon;
        if (isThere && (row.place == tag.place || mirrored == tag.place)) {
            return {i, row.place != tag.place};
        }
    }
    return {};
}

/// Columns that are computed at once: a position, or x, y, and the lifts of x and y.
constexpr int kNumColumns = 5;
using Points = Eigen::Matrix<double, Eigen::Dynamic, kNumColumns, Eigen::RowMajor>;

/// A control mesh of triangles with one line, truncated and refined once; its points follow the masks.
class Surface {
public:
    Surface(Shape const &shape, int level) {
        OpenSubdiv::Sdc::Options options;
        options.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        _refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(), options,
                                                          {kTruncate});
        FarExt::TopologyRefiner::UniformOptions uniform(level);
        uniform.fullTopologyInLastLevel = true;
        if (!_refiner || !_refiner->RefineUniform(uniform)) {
            throw std::runtime_error(shape.name + " cannot be refined");
        }
        _mesh = MakeSurfaceLevels(*_refiner, shape).back().mesh;
        for (int depth = 0; depth < level; ++depth) {
            _steps.push_back(makeStep(depth));
        }
        NeedOnly({});
    }

    PolygonMesh const &GetMesh() const {
        return _mesh;
    } // of the last level, by the library's masks

    /// Lets Refine() compute these vertices of the last level alone; or all, where there are none.
    void NeedOnly(std::vector<int> const &vertices) {
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
            }
            step->needed = std::move(needed);
            needed = std::move(before);
        }
    }

    Points Refine(LineMasks const &masks, Points points) const {
        for (Step const &step : _steps) {
            Points refined = Points::Zero(Eigen::Index(step.made.size()), kNumColumns);
            // F-vertices, which come last, first.
            for (auto i = Eigen::Index(step.made.size()) - 1; i >= 0; --i) {
                Made const &made = step.made[std::size_t(i)];
                if (!step.needed[std::size_t(i)]) {
                    continue;
                }
                double rest = 1;
                for (Source const &source : made.sources) {
                    double const weight =
                        source.row == kNone ? source.weight
                        : source.place == kNone
                            ? masks[std::size_t(source.row)].ofVertex
                            : masks[std::size_t(source.row)].weights[source.place];
                    refined.row(i) += weight * (source.isOfParent ? points.row(source.vertex)
                                                                  : refined.row(source.vertex));
                    rest -= weight;
                }
                if (made.hasRest) {
                    refined.row(i) += rest * points.row(made.parent);
                }
            }
            points = std::move(refined);
        }
        return points;
    }

private:
    struct Source {
        bool isOfParent; // else an F-vertex
        int vertex;
        double weight;
        int row = kNone; // which has the weight, at a place, or at none of V'
        int place = kNone;
    };
    struct Made {
        std::vector<Source> sources;
        int parent = kNone;
        bool hasRest = false; // the parent has what the others leave to 1
    };
    struct Step {
        int numParents;
        std::vector<Made> made;
        std::vector<char> needed;
    };

    FarExt::internal::MeshLevels const &getLevels() const { return _refiner->GetHierarchy().mesh; }

    Step makeStep(int depth) const {
        Level const &level = getLevels().levels[std::size_t(depth)];
        auto const &refinement = getLevels().refinements[std::size_t(depth)];
        Step step = {
            level.numVertices, std::vector<Made>(std::size_t(refinement.child->numVertices)), {}};
        if (refinement.isTruncation) {
            std::vector<Unit> units(std::size_t(level.numVertices));
            for (int i = 0; i < level.numVertices; ++i) {
                units[std::size_t(i)].terms = {{i, 1}};
            }
            std::vector<Unit> made(step.made.size());
            FarExt::internal::RefinementRows const rows(refinement, kTruncate,
                                                        FarExt::Interpolation::Vertex);
            FarExt::internal::Interpolate<double>(rows, units, made);
            for (std::size_t i = 0; i < made.size(); ++i) {
                for (auto const &[vertex, weight] : made[i].terms) {
                    step.made[i].sources.push_back({true, vertex, weight});
                }
            }
            return step;
        }
        RefinementRules const rules(level, kTruncate, FarExt::Interpolation::Vertex);
        std::vector<CornerRow> rowsOfCorners(std::size_t(level.numCorners));
        int last = kNone;
        for (LineRowCorner const &tag : level.lineRowCorners) {
            // Between two lines, which are as sharp here, there is no row.
            bool const isFirst = tag.corner != last;
            rowsOfCorners[std::size_t(tag.corner)] =
                isFirst ? findRow(level.numHexagonalSteps, tag) : CornerRow();
            last = tag.corner;
        }
        for (int face = 0; face < level.numFaces; ++face) {
            auto const verts = level.GetFaceVertices(face);
            auto const rule = rules.GetFaceRule(face);
            for (int i = 0; i < verts.size(); ++i) {
                int const corner = level.faceFirstCorner[face] + i;
                CornerRow const row = rowsOfCorners[std::size_t(corner)];
                bool const hasMask = row.position != kNone && kTable[row.position].HasMask();
                Made &made = step.made[std::size_t(refinement.GetCornerChildVertex(corner))];
                if (hasMask && kTable[row.position].face == kHalf) {
                    std::array<int, kTrapezoid> const half = findHalf(level, face, i);
                    int const place = kTable[row.position].place == 2 && !row.isBackwards ? 2 : 3;
                    for (int j = 0; j < kTrapezoid; ++j) {
                        int const turns = row.isBackwards ? kTrapezoid - j : j;
                        int const local = half[std::size_t((place + turns) % kTrapezoid)];
                        made.sources.push_back({true, verts[local], 0, row.position, j});
                    }
                    continue;
                }
                for (int j = 0; j < verts.size(); ++j) {
                    int const turns = (row.isBackwards ? i - j : j - i) + verts.size();
                    made.sources.push_back({true, verts[j], rule.GetRow(i)[j],
                                            hasMask ? row.position : kNone, turns % verts.size()});
                }
            }
        }
        for (int vert = 0; vert < level.numVertices; ++vert) {
            Made &made = step.made[std::size_t(refinement.GetVertexChildVertex(vert))];
            auto const rule = rules.GetVertexRule(vert);
            int const first = level.vertFirstFace[vert];
            made.parent = vert;
            made.hasRest = true;
            for (int k = first; k < level.vertFirstFace[vert + 1]; ++k) {
                CornerRow const row = rowsOfCorners[std::size_t(level.GetVertexCorner(k))];
                made.hasRest =
                    made.hasRest && row.position != kNone && kTable[row.position].ofVertex != kNone;
            }
            for (int k = first; k < level.vertFirstFace[vert + 1]; ++k) {
                int const corner = level.GetVertexCorner(k);
                made.sources.push_back(
                    {false, refinement.GetCornerChildVertex(corner), rule.GetFaceWeight(k - first),
                     made.hasRest ? rowsOfCorners[std::size_t(corner)].position : kNone, kNone});
            }
            for (int i = 0; i < rule.numSources && !made.hasRest; ++i) {
                made.sources.push_back({true, rule.sources[i], rule.weights[i]});
            }
        }
        return step;
    }

    /// The places of the half of a face that one of its corners inside is in.
    static std::array<int, kTrapezoid> findHalf(Level const &level, int face, int local) {
        std::array<int, kTrapezoid> half = {0, 1, 2, 3};
        int const end = level.GetDiagonalEnd(face);
        for (int i = 0; i < kTrapezoid && !level.IsHalfFace(face); ++i) {
            half[std::size_t(i)] = FarExt::GetPlaceInHalves(local < end ? 1 : 0, i, end);
        }
        return half;
    }

    /// A sum of vertices.
    struct Unit {
        void Clear() { terms.clear(); }
        void AddWithWeight(Unit const &other, double weight) {
            for (auto const &[vertex, ofVertex] : other.terms) {
                terms[vertex] += weight * ofVertex;
            }
        }
        std::map<int, double> terms;
    };

    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::vector<Step> _steps;
    PolygonMesh _mesh;
};

double const kRowHeight = std::sqrt(0.75);

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

} // namespace

class LineMaskSearch::Implementation {
public:
    explicit Implementation(int level)
        : _shape(makeStrip(kNumColumnsOfStrip, kNumRowsOfStrip)), _surface(_shape, level) {
        _lifted = Points::Zero(_shape.GetNumVertices(), kNumColumns);
        for (int i = 0; i < _shape.GetNumVertices(); ++i) {
            double const x = double(_shape.positions[3 * std::size_t(i)]) - kCenter;
            double const y = _shape.positions[3 * std::size_t(i) + 1];
            _lifted.row(i) << x, y, (x * x + y * y) / 2, (x * x - y * y) / 2, x * y;
        }
        compareWithLibrary();
        chooseVertices();
    }

    Eigen::VectorXd Gather(LineMasks masks) const {
        std::vector<double> values;
        forEachFree(masks, [&](double &weight) { values.push_back(weight); });
        return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
    }

    LineMasks Spread(Eigen::VectorXd const &weights) const {
        LineMasks masks = getShippedMasks();
        double const *next = weights.data();
        forEachFree(masks, [&next](double &weight) { weight = *next++; });
        for (int i = 0; i < kNumRows; ++i) {
            if (kTable[i].HasMask()) {
                double *const mask = masks[std::size_t(i)].weights;
                mask[0] = 1 - std::accumulate(mask + 1, mask + kHexagon, 0.0);
            }
        }
        return masks;
    }

    LineMasks GetStart() const {
        using FarExt::Interpolation;
        LineMasks masks = getShippedMasks();
        double hexagon[kHexagon];
        double half[kTrapezoid * kTrapezoid];
        FarExt::ComputeFaceVertexMask(FaceMask::Smooth, Interpolation::Vertex, kHexagon, hexagon);
        FarExt::ComputeHalfFaceVertexMask(FaceMask::Smooth, Interpolation::Vertex, kTrapezoid,
                                          half);
        constexpr int kNumFaces = 3;
        for (int i = 0; i < kNumRows; ++i) {
            Row &row = masks[std::size_t(i)];
            TableRow const &shipped = kTable[i];
            row.ofVertex = shipped.ofVertex == kNone ? row.ofVertex : 1.0 / (1 + kNumFaces);
            for (int j = 0; j < shipped.GetSize() && shipped.HasMask(); ++j) {
                row.weights[j] =
                    shipped.face == kHalf
                        ? half[kTrapezoid * shipped.place + (shipped.place + j) % kTrapezoid]
                        : hexagon[j];
            }
        }
        return masks;
    }

    Eigen::VectorXd MeasureQuadratics(LineMasks const &masks) const {
        constexpr double kOfMean = 0.1; // of what means at one distance deviate by
        Points const points = _surface.Refine(masks, _lifted);
        Eigen::Matrix3d exact;
        exact << 1, 1, 0, 0, 0, 1, 1, -1, 0;
        std::vector<Eigen::Matrix3d> off;
        std::vector<Eigen::Matrix3d> means(_areasOfGroups.size(), Eigen::Matrix3d::Zero());
        for (std::size_t k = 0; k < _vertices.size(); ++k) {
            off.push_back(computeDerivatives(points, k) - exact);
            std::size_t const group = std::size_t(_groups[k]);
            means[group] += _areas[k] / _areasOfGroups[group] * off.back();
        }
        std::vector<double> values;
        auto const add = [&values](double area, Eigen::Matrix3d const &deviation) {
            for (int lift = 0; lift < 3; ++lift) {
                auto const d = deviation.col(lift);
                double const factor = std::sqrt(area);
                values.insert(values.end(), {factor * (d[0] + d[2]) / 2, factor * (d[0] - d[2]) / 2,
                                             factor * d[1]});
            }
        };
        for (std::size_t k = 0; k < _vertices.size(); ++k) {
            add(_areas[k], off[k] - means[std::size_t(_groups[k])]);
        }
        for (std::size_t group = 0; group < means.size(); ++group) {
            add(_areasOfGroups[group], kOfMean * means[group]);
        }
        return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
    }

    /// The difference of 1 and the sum of the weights, where it is below 0.
    Eigen::VectorXd MeasureRest(LineMasks const &masks) const {
        constexpr double kOfNegative = 10;
        std::vector<double> values;
        for (int i = 0; i < kNumRows; ++i) {
            values.push_back(kOfNegative * std::min(0.0, masks[std::size_t(i)].weights[0]));
        }
        // A vertex of the first row has a half hexagon and one of the next hexagons each.
        for (int numSteps = 0; numSteps < FarExt::internal::kNumLineSteps; ++numSteps) {
            auto const leave = [&](std::array<std::pair<LineFace, int>, 3> const &around) {
                double rest = 1;
                for (int i = 0; i < kNumRows; ++i) {
                    bool const isThere =
                        kTable[i].numSteps == numSteps &&
                        std::find(around.begin(), around.end(),
                                  std::pair(kTable[i].face, kTable[i].place)) != around.end();
                    rest -= isThere ? masks[std::size_t(i)].ofVertex : 0;
                }
                values.push_back(kOfNegative * std::min(0.0, rest));
            };
            leave({{{kHalf, 2}, {kOnLine, 2}, {kBehind, 1}}});
            leave({{{kOnLine, 3}, {kBehind, 2}, {kBeyond, 0}}});
        }
        return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
    }

    std::vector<Entry> Judge(LineMasks const &masks) const {
        std::vector<Entry> entries = {{"quadratics", MeasureQuadratics(masks).norm()}};
        for (std::pair<int, int> const &size :
             {std::pair(14, 8), std::pair(20, 10), std::pair(9, 6)}) {
            int const numU = size.first;
            int const numV = size.second;
            std::string const name =
                " of " + std::to_string(numU) + " x " + std::to_string(numV) + ", row ";
            double const width = 1.0 / numV;
            auto const add = [&](char const *line, Shape const &torus, double place) {
                std::vector<double> const strips =
                    MeasureTorusStrips(refine(torus, masks), numU, place, width, 2);
                entries.push_back({line + name + "1", strips[0]});
                entries.push_back({line + name + "2", strips[1]});
            };
            add("crease", MakeCreasedTorus(numU, numV, TorusFaces::Triangles), 0);
            add("border", MakeOpenTorus(numU, numV, TorusFaces::Triangles), width);
        }
        return entries;
    }

    void Print(LineMasks const &masks) const {
        constexpr char const *kNames[] = {"kOnLine", "kHalf", "kBehind", "kBeyond"};
        for (int i = 0; i < kNumRows; ++i) {
            Row const &row = masks[std::size_t(i)];
            TableRow const &shipped = kTable[i];
            std::printf("{%d, %s, %d, ", shipped.numSteps, kNames[int(shipped.face)],
                        shipped.place);
            std::printf(shipped.ofVertex == kNone ? "kNone, {" : "%.0f, {", kParts * row.ofVertex);
            for (int j = 0; j < shipped.GetSize() && shipped.HasMask(); ++j) {
                std::printf("%s%.0f", j > 0 ? ", " : "", kParts * row.weights[j]);
            }
            std::printf("}},\n");
        }
    }

    Eigen::VectorXd Round(Eigen::VectorXd const &weights) const {
        return (kParts * weights).array().round() / kParts;
    }

private:
    static constexpr int kNumColumnsOfStrip = 9;
    static constexpr int kNumRowsOfStrip = 5;
    static constexpr double kCenter = 3.5; // x of a period in the middle

    static PolygonMesh refine(Shape const &shape, LineMasks const &masks) {
        constexpr int kLevel = 5;
        Surface const surface(shape, kLevel);
        Points points = Points::Zero(shape.GetNumVertices(), kNumColumns);
        for (int i = 0; i < shape.GetNumVertices(); ++i) {
            for (int j = 0; j < 3; ++j) {
                points(i, j) = shape.positions[3 * std::size_t(i) + std::size_t(j)];
            }
        }
        points = surface.Refine(masks, points);
        PolygonMesh mesh = surface.GetMesh();
        for (int i = 0; i < mesh.GetNumVertices(); ++i) {
            mesh.positions[std::size_t(i)] = points.row(i).head<3>();
        }
        return mesh;
    }

    /// Calls function(weight) for the free ones: the first of each mask is what the others leave.
    template <typename FUNCTION>
    static void forEachFree(LineMasks &masks, FUNCTION const &function) {
        for (int i = 0; i < kNumRows; ++i) {
            Row &row = masks[std::size_t(i)];
            if (kTable[i].ofVertex != kNone) {
                function(row.ofVertex);
            }
            for (int j = 1; j < kTable[i].GetSize() && kTable[i].HasMask(); ++j) {
                function(row.weights[j]);
            }
        }
    }

    /// Throws where the masks of the library do not make here what they make there.
    void compareWithLibrary() const {
        constexpr double kTolerance = 1e-12;
        Points const points = _surface.Refine(getShippedMasks(), _lifted);
        PolygonMesh const &mesh = _surface.GetMesh();
        for (int i = 0; i < mesh.GetNumVertices(); ++i) {
            Eigen::RowVector2d position = mesh.positions[std::size_t(i)].head<2>().transpose();
            position[0] -= kCenter;
            if (!((position - points.row(i).head<2>()).norm() < kTolerance)) {
                throw std::runtime_error("vertex " + std::to_string(i) +
                                         " is not where the library has it");
            }
        }
    }

    void chooseVertices() {
        constexpr double kMargin = 0.125; // as beside the lines of tori
        constexpr int kNumGroups = 16;    // in two rows
        // By the masks that the search begins with, so that it does not depend on the library's.
        PolygonMesh mesh = _surface.GetMesh();
        Points const points = _surface.Refine(GetStart(), _lifted);
        for (int i = 0; i < mesh.GetNumVertices(); ++i) {
            mesh.positions[std::size_t(i)] = {points(i, 0), points(i, 1), 0};
        }
        std::vector<double> const areas = ComputeVertexAreas(mesh);
        double sum = 0;
        _areasOfGroups.assign(kNumGroups, 0);
        std::vector<int> needed;
        for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
            Eigen::Vector3d const &position = mesh.positions[std::size_t(vertex)];
            double const x = position.x();
            double const rows = position.y() / kRowHeight;
            if (x < 0 || x >= 1 || rows < kMargin || rows >= 2) {
                continue;
            }
            _vertices.push_back(vertex);
            _groups.push_back(int(rows * kNumGroups / 2));
            _areas.push_back(areas[std::size_t(vertex)]);
            _near.push_back(FindNearVertices(mesh, vertex));
            needed.insert(needed.end(), _near.back().begin(), _near.back().end());
            sum += _areas.back();
        }
        for (std::size_t k = 0; k < _vertices.size(); ++k) {
            _areas[k] /= sum;
            _areasOfGroups[std::size_t(_groups[k])] += _areas[k];
        }
        _surface.NeedOnly(needed);
    }

    /// The second derivatives xx, xy, yy of the lifts at a chosen vertex, in the plane of the points.
    Eigen::Matrix3d computeDerivatives(Points const &points, std::size_t k) const {
        std::vector<int> const &near = _near[k];
        auto const center = points.row(_vertices[k]);
        double size = 0;
        for (int point : near) {
            size = std::max(size, (points.row(point) - center).head<2>().norm());
        }
        Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 3> right = Eigen::Matrix<double, 6, 3>::Zero();
        for (int point : near) {
            Eigen::Matrix<double, 1, kNumColumns> const offset = points.row(point) - center;
            double const x = offset[0] / size;
            double const y = offset[1] / size;
            Eigen::Matrix<double, 6, 1> terms;
            terms << 1, x, y, x * x, x * y, y * y;
            normal += terms * terms.transpose();
            right += terms * offset.tail<3>();
        }
        Eigen::Matrix<double, 6, 3> const fit = normal.ldlt().solve(right);
        Eigen::Matrix3d derivatives;
        derivatives << 2 * fit.row(3), fit.row(4), 2 * fit.row(5);
        return derivatives / (size * size);
    }

    Shape const _shape;
    Surface _surface;
    Points _lifted;
    // The chosen vertices; the sum of areas is 1, and groups are by distance from the border.
    std::vector<int> _vertices;
    std::vector<int> _groups;
    std::vector<double> _areas;
    std::vector<std::vector<int>> _near;
    std::vector<double> _areasOfGroups;
};

LineMaskSearch::LineMaskSearch(int level)
    : _implementation(std::make_unique<Implementation>(level)) {}
LineMaskSearch::~LineMaskSearch() = default;

Eigen::VectorXd LineMaskSearch::GetShipped() const {
    return _implementation->Gather(getShippedMasks());
}
Eigen::VectorXd LineMaskSearch::GetStart() const {
    return _implementation->Gather(_implementation->GetStart());
}

Eigen::VectorXd LineMaskSearch::Measure(Eigen::VectorXd const &weights) const {
    LineMasks const masks = _implementation->Spread(weights);
    constexpr double kOfChange = 0.03;
    Eigen::VectorXd const parts[] = {_implementation->MeasureQuadratics(masks),
                                     _implementation->MeasureRest(masks),
                                     kOfChange * (weights - GetStart())};
    Eigen::VectorXd values(parts[0].size() + parts[1].size() + parts[2].size());
    values << parts[0], parts[1], parts[2];
    return values;
}

std::vector<LineMaskSearch::Entry> LineMaskSearch::Judge(Eigen::VectorXd const &weights) const {
    return _implementation->Judge(_implementation->Spread(weights));
}

Eigen::VectorXd LineMaskSearch::Round(Eigen::VectorXd weights) const {
    return _implementation->Round(weights);
}
void LineMaskSearch::Print(Eigen::VectorXd const &weights) const {
    _implementation->Print(_implementation->Spread(weights));
}

} // namespace OpenSubdivHex::Regression

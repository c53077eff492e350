// SPDX-License-Identifier: Apache-2.0
#include "quadMaskSearch.h"

#include "evenness.h"
#include "localSubdivision.h"
#include "ripple.h"
#include "smoothness.h"
#include "spectrum.h"

#include "far_ext/rules/mask.h"
#include "far_ext/rules/quadPath.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/refinement.h"
#include "far_ext/vtr/refinementRules.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <string>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::FaceMask;
using FarExt::HexSchemeOptions;
using FarExt::kHexagon;
using FarExt::internal::Level;
using FarExt::internal::QuadCorner;
using FarExt::internal::MaskRow;
using FarExt::internal::RefinementRules;

constexpr int kQuad = 4;
constexpr int kNumRegular = 4; // faces at a vertex
constexpr int kNumInQuads = FarExt::kNumStepsToConstantMasks - 1;
constexpr double kParts = 4096;
constexpr double kPartsInQuads = 256;
double const kPi = std::acos(-1.0);

struct TableRow {
    int numFaces;
    char const *path;
    int ofVertex;
    int parts[kHexagon];
};
constexpr TableRow kTable[] = {
#include "far_ext/rules/quadRows.inl"
};
constexpr int kNumRows = int(std::size(kTable));

/// All masks by paths, and those in quads, of which some are searched for.
struct QuadMasks {
    struct Row {
        double ofVertex;
        double weights[kHexagon]; // of a hexagon
        bool HasMask() const { return weights[0] > 0 || weights[1] > 0; }
    };
    std::array<Row, kNumRows> rows;
    double inQuads[kNumInQuads][kQuad]; // by level, from 1 on
};

QuadMasks getShippedMasks() {
    QuadMasks masks;
    for (int i = 0; i < kNumRows; ++i) {
        masks.rows[std::size_t(i)].ofVertex = kTable[i].ofVertex / kParts;
        std::transform(kTable[i].parts, kTable[i].parts + kHexagon,
                       masks.rows[std::size_t(i)].weights, [](int part) { return part / kParts; });
    }
    for (int i = 0; i < kNumInQuads; ++i) {
        std::copy_n(FarExt::ComputeQuadMask(i + 1).inQuad, kQuad, masks.inQuads[i]);
    }
    return masks;
}

/// Columns that are computed at once: x, y, and the lifts of x and y.
constexpr int kNumColumns = 5;
using Points = Eigen::Matrix<double, Eigen::Dynamic, kNumColumns, Eigen::RowMajor>;

/// A control mesh of quads, refined once; its points follow the masks.
class Surface {
public:
    Surface(Shape const &shape, int level) {
        _refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(),
                                                          OpenSubdiv::Sdc::Options(),
                                                          {HexSchemeOptions{FaceMask::Smooth}});
        FarExt::TopologyRefiner::UniformOptions options(level);
        options.fullTopologyInLastLevel = true;
        if (!_refiner || !_refiner->RefineUniform(options)) {
            throw std::runtime_error(shape.name + " cannot be refined");
        }
        _mesh = MakeSurfaceLevels(*_refiner, shape).back().mesh;
        for (int depth = 0; depth < level; ++depth) {
            _rules.emplace_back(getLevel(depth), _refiner->GetHexSchemeOptions(),
                                FarExt::Interpolation::Vertex);
            _rows.emplace_back(findRows(depth));
        }
        _needed.resize(std::size_t(level) + 1);
        NeedOnly({});
    }

    FarExt::TopologyRefiner const &GetRefiner() const { return *_refiner; }
    PolygonMesh const &GetMesh() const {
        return _mesh;
    } // of the last level, by the library's masks
    int GetLevel() const { return int(_rules.size()); }

    /// Lets Refine() compute these vertices of the last level alone; or all, where there are none.
    void NeedOnly(std::vector<int> const &vertices) {
        for (std::size_t i = 0; i < _needed.size(); ++i) {
            _needed[i].assign(std::size_t(getLevel(int(i)).numVertices), vertices.empty());
        }
        for (int vertex : vertices) {
            _needed.back()[std::size_t(vertex)] = true;
        }
        for (int depth = GetLevel() - 1; depth >= 0; --depth) {
            Level const &level = getLevel(depth);
            auto const &refinement = getLevels().refinements[std::size_t(depth)];
            std::vector<char> &needed = _needed[std::size_t(depth)];
            std::vector<char> &cNeeded = _needed[std::size_t(depth) + 1];
            for (int vert = 0; vert < level.numVertices; ++vert) {
                if (cNeeded[std::size_t(refinement.GetVertexChildVertex(vert))]) {
                    needed[std::size_t(vert)] = true;
                    for (int k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1];
                         ++k) {
                        cNeeded[std::size_t(
                            refinement.GetCornerChildVertex(level.GetVertexCorner(k)))] = true;
                    }
                    auto const rule = _rules[std::size_t(depth)].GetVertexRule(vert);
                    for (int i = 0; i < rule.numSources; ++i) {
                        needed[std::size_t(rule.sources[i])] = true;
                    }
                }
            }
            for (int face = 0; face < level.numFaces; ++face) {
                auto const verts = level.GetFaceVertices(face);
                for (int i = 0; i < verts.size(); ++i) {
                    if (cNeeded[getFVertex(depth, face, i)]) {
                        std::for_each(verts.begin(), verts.end(),
                                      [&](int vert) { needed[std::size_t(vert)] = true; });
                    }
                }
            }
        }
    }

    Points Refine(QuadMasks const &masks, Points points) const {
        for (int depth = 0; depth < GetLevel(); ++depth) {
            Level const &level = getLevel(depth);
            auto const &refinement = getLevels().refinements[std::size_t(depth)];
            std::vector<char> const &needed = _needed[std::size_t(depth) + 1];
            Points refined = Points::Zero(Eigen::Index(needed.size()), kNumColumns);
            double turned[kHexagon];
            for (int face = 0; face < level.numFaces; ++face) {
                auto const verts = level.GetFaceVertices(face);
                for (int i = 0; i < verts.size(); ++i) {
                    std::size_t const fVertex = getFVertex(depth, face, i);
                    if (needed[fVertex]) {
                        double const *const weights = getFaceWeights(masks, depth, face, i, turned);
                        for (int j = 0; j < verts.size(); ++j) {
                            refined.row(Eigen::Index(fVertex)) += weights[j] * points.row(verts[j]);
                        }
                    }
                }
            }
            for (int vert = 0; vert < level.numVertices; ++vert) {
                int const vVertex = refinement.GetVertexChildVertex(vert);
                if (!needed[std::size_t(vVertex)]) {
                    continue;
                }
                forEachVertexWeight(
                    masks, depth, vert, [&](bool isOfParent, int index, double weight) {
                        refined.row(vVertex) +=
                            weight * (isOfParent ? points.row(index) : refined.row(index));
                    });
            }
            points = std::move(refined);
        }
        return points;
    }

    /// How a vertex of the level behind \p depth is made.
    ChildRow GetRow(QuadMasks const &masks, int depth, int cVertex) const {
        Level const &level = getLevel(depth);
        ChildRow row;
        auto const add = [&](int vertex, double weight) {
            auto const found = std::find_if(row.begin(), row.end(), [vertex](auto const &entry) {
                return entry.first == vertex;
            });
            if (found == row.end()) {
                row.emplace_back(vertex, weight);
            } else {
                found->second += weight;
            }
        };
        auto const addFVertex = [&](int fVertex, double factor) {
            int const corner = fVertex - level.numVertices;
            int const face = level.FindFaceOfCorner(corner);
            double turned[kHexagon];
            double const *const weights = getFaceWeights(
                masks, depth, face, corner - level.faceFirstCorner[std::size_t(face)], turned);
            auto const verts = level.GetFaceVertices(face);
            for (int j = 0; j < verts.size(); ++j) {
                add(verts[j], factor * weights[j]);
            }
        };
        if (cVertex >= level.numVertices) {
            addFVertex(cVertex, 1);
            return row;
        }
        forEachVertexWeight(masks, depth, cVertex, [&](bool isOfParent, int index, double weight) {
            if (isOfParent) {
                add(index, weight);
            } else {
                addFVertex(index, weight);
            }
        });
        return row;
    }

    /// Calls function(position in the table, whether its mask is symmetric) for each corner with a row.
    template <typename FUNCTION>
    void ForEachRow(FUNCTION const &function) const {
        for (int depth = 0; depth < GetLevel(); ++depth) {
            for (QuadCorner const &quad : getLevel(depth).quadCorners) {
                int const position = _rows[std::size_t(depth)][std::size_t(quad.corner)].position;
                if (position >= 0) {
                    function(position, quad.flags.out == quad.flags.in);
                }
            }
        }
    }

private:
    struct CornerRow {
        int position = -1;
        bool isBackwards = false;
    };

    FarExt::internal::MeshLevels const &getLevels() const { return _refiner->GetHierarchy().mesh; }
    Level const &getLevel(int depth) const { return getLevels().levels[std::size_t(depth)]; }
    std::size_t getFVertex(int depth, int face, int i) const {
        return std::size_t(getLevels().refinements[std::size_t(depth)].GetCornerChildVertex(
            getLevel(depth).faceFirstCorner[std::size_t(face)] + i));
    }

    std::vector<CornerRow> findRows(int depth) const {
        Level const &level = getLevel(depth);
        std::vector<CornerRow> rows(std::size_t(level.numCorners));
        for (QuadCorner const &quad : level.quadCorners) {
            MaskRow const row = FarExt::internal::FindQuadRow(level.numHexagonalSteps, quad.flags);
            rows[std::size_t(quad.corner)] = {row.position, row.isBackwards};
        }
        return rows;
    }

    double const *getFaceWeights(QuadMasks const &masks, int depth, int face, int i,
                                 double (&turned)[kHexagon]) const {
        Level const &level = getLevel(depth);
        int const size = level.GetFaceSize(face);
        CornerRow const row =
            _rows[std::size_t(depth)][std::size_t(level.faceFirstCorner[std::size_t(face)] + i)];
        double const *weights = nullptr;
        if (size == kQuad && depth >= 1 && depth <= kNumInQuads && !level.IsHalfFace(face)) {
            weights = masks.inQuads[depth - 1];
        } else if (row.position >= 0 && masks.rows[std::size_t(row.position)].HasMask()) {
            weights = masks.rows[std::size_t(row.position)].weights;
        }
        if (!weights) {
            return _rules[std::size_t(depth)].GetFaceRule(face).GetRow(i);
        }
        for (int j = 0; j < size; ++j) {
            turned[(i + (row.isBackwards ? size - j : j)) % size] = weights[j];
        }
        return turned;
    }

    /// Calls function(whether it is a vertex of the parent, else an F-vertex; its index; its weight).
    template <typename FUNCTION>
    void forEachVertexWeight(QuadMasks const &masks, int depth, int vert,
                             FUNCTION const &function) const {
        Level const &level = getLevel(depth);
        auto const &refinement = getLevels().refinements[std::size_t(depth)];
        auto const &rows = _rows[std::size_t(depth)];
        int const first = level.vertFirstFace[vert];
        int const behind = level.vertFirstFace[vert + 1];
        auto const forEachFace = [&](auto const &getWeight) {
            for (int k = first; k < behind; ++k) {
                int const corner = level.GetVertexCorner(k);
                function(false, refinement.GetCornerChildVertex(corner), getWeight(k, corner));
            }
        };
        bool hasRows = behind > first;
        double rest = 1;
        for (int k = first; k < behind && hasRows; ++k) {
            int const position = rows[std::size_t(level.GetVertexCorner(k))].position;
            hasRows = position >= 0;
            rest -= hasRows ? masks.rows[std::size_t(position)].ofVertex : 0;
        }
        if (hasRows) {
            function(true, vert, rest);
            forEachFace([&](int, int corner) {
                return masks.rows[std::size_t(rows[std::size_t(corner)].position)].ofVertex;
            });
            return;
        }
        auto const rule = _rules[std::size_t(depth)].GetVertexRule(vert);
        for (int i = 0; i < rule.numSources; ++i) {
            function(true, rule.sources[i], rule.weights[i]);
        }
        forEachFace([&](int k, int) { return rule.GetFaceWeight(k - first); });
    }

    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::vector<RefinementRules> _rules;       // by parent
    std::vector<std::vector<CornerRow>> _rows; // by parent and corner
    std::vector<std::vector<char>> _needed;    // by level and vertex
    PolygonMesh _mesh;
};

/// The second derivatives xx, xy, yy of lifted points at some vertices, in the plane of the points.
class Curvatures {
public:
    Curvatures(PolygonMesh const &mesh, std::vector<int> vertices)
        : _vertices(std::move(vertices)) {
        for (int vertex : _vertices) {
            _near.push_back(FindNearVertices(mesh, vertex));
        }
    }

    std::vector<int> GetNeeded() const {
        std::vector<int> needed;
        for (std::vector<int> const &near : _near) {
            needed.insert(needed.end(), near.begin(), near.end());
        }
        return needed;
    }

    /// By vertex; columns are lifts.
    std::vector<Eigen::Matrix3d> Compute(Points const &points) const {
        std::vector<Eigen::Matrix3d> result;
        for (std::size_t k = 0; k < _vertices.size(); ++k) {
            std::vector<int> const &near = _near[k];
            auto const center = points.row(_vertices[k]);
            Eigen::Matrix<double, Eigen::Dynamic, 6> terms(Eigen::Index(near.size()), 6);
            Eigen::Matrix<double, Eigen::Dynamic, 3> heights(Eigen::Index(near.size()), 3);
            double size = 0;
            for (int point : near) {
                size = std::max(size, (points.row(point) - center).head<2>().norm());
            }
            for (std::size_t i = 0; i < near.size(); ++i) {
                auto const row = Eigen::Index(i);
                Eigen::Matrix<double, 1, kNumColumns> const offset = points.row(near[i]) - center;
                double const x = offset[0] / size;
                double const y = offset[1] / size;
                terms.row(row) << 1, x, y, x * x, x * y, y * y;
                heights.row(row) = offset.tail<3>();
            }
            Eigen::Matrix<double, 6, 3> const fit =
                (terms.transpose() * terms).ldlt().solve(terms.transpose() * heights);
            Eigen::Matrix3d &derivatives = result.emplace_back();
            derivatives.row(0) = 2 * fit.row(3);
            derivatives.row(1) = fit.row(4);
            derivatives.row(2) = 2 * fit.row(5);
            derivatives /= size * size;
        }
        return result;
    }

private:
    std::vector<int> _vertices;
    std::vector<std::vector<int>> _near;
};

} // namespace

class QuadMaskSearch::Implementation {
public:
    Implementation(int numFaces, int level)
        : _numFaces(numFaces), _shape(MakeVertexDisk(Tiling::Quads, numFaces, kNumRings)),
          _surface(_shape, level) {
        _lifted = Points::Zero(_shape.GetNumVertices(), kNumColumns);
        for (int i = 0; i < _shape.GetNumVertices(); ++i) {
            double const x = _shape.positions[3 * std::size_t(i)];
            double const y = _shape.positions[3 * std::size_t(i) + 1];
            _lifted.row(i) << x, y, (x * x + y * y) / 2, (x * x - y * y) / 2, x * y;
        }
        compareWithLibrary();
        findFree();
        chooseVertices();
        if (isRegular()) {
            findCenters();
        }
    }

    Eigen::VectorXd Gather(QuadMasks const &masks) const {
        std::vector<double> values;
        QuadMasks copy = masks;
        forEachFree(copy, [&](double *mask, int, std::vector<int> const &places, bool) {
            std::transform(places.begin(), places.end(), std::back_inserter(values),
                           [mask](int place) { return mask[place]; });
        });
        return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
    }

    QuadMasks Spread(Eigen::VectorXd const &weights) const {
        QuadMasks masks = getShippedMasks();
        double const *next = weights.data();
        forEachFree(masks,
                    [&](double *mask, int size, std::vector<int> const &places, bool isSymmetric) {
                        for (int place : places) {
                            mask[place] = *next++;
                            if (isSymmetric) {
                                mask[size - place] = mask[place];
                            }
                        }
                        if (size > 1) {
                            mask[0] = 1 - std::accumulate(mask + 1, mask + size, 0.0);
                        }
                    });
        return masks;
    }

    QuadMasks GetStart() const {
        QuadMasks masks = getShippedMasks();
        double regular[kHexagon];
        FarExt::ComputeFaceVertexMask(FaceMask::Smooth, FarExt::Interpolation::Vertex, kHexagon,
                                      regular);
        for (int i = 0; i < kNumRows; ++i) {
            QuadMasks::Row &row = masks.rows[std::size_t(i)];
            if (kTable[i].numFaces != _numFaces) {
                continue;
            }
            if (!isRegular()) {
                auto const *const same =
                    std::find_if(std::begin(kTable), std::end(kTable), [&](TableRow const &other) {
                        return other.numFaces == kNumRegular &&
                               std::string(other.path) == kTable[i].path;
                    });
                row = masks.rows[std::size_t(same - kTable)];
                continue;
            }
            if (row.HasMask()) {
                std::copy_n(regular, kHexagon, row.weights);
            }
            constexpr int kNumFacesLater = 3; // at all other vertices
            std::string const path = kTable[i].path;
            bool const isAtVertex = path.find_first_not_of("3*") == std::string::npos;
            row.ofVertex = 1.0 / (1 + (isAtVertex ? kNumRegular : kNumFacesLater));
        }
        if (isRegular()) {
            for (auto &mask : masks.inQuads) {
                FarExt::ComputeFaceVertexMask(FaceMask::Smooth, FarExt::Interpolation::Vertex,
                                              kQuad, mask);
            }
        }
        return masks;
    }

    Eigen::VectorXd MeasureQuadratics(QuadMasks const &masks) const {
        std::vector<Eigen::Matrix3d> const derivatives =
            _curvatures->Compute(_surface.Refine(masks, _lifted));
        Eigen::Matrix3d exact;
        exact << 1, 1, 0, 0, 0, 1, 1, -1, 0;
        double bowl = 1;
        if (!isRegular()) {
            bowl = 0;
            for (std::size_t i = 0; i < derivatives.size(); ++i) {
                bowl += _areas[i] * (derivatives[i](0, 0) + derivatives[i](2, 0)) / 2;
            }
        }
        exact.col(0) *= bowl;
        double const ofLifts[] = {1, isRegular() ? 1 : 0.7, isRegular() ? 1 : 0.7};
        constexpr int kNumValues = 9;
        Eigen::VectorXd values(Eigen::Index(derivatives.size()) * kNumValues);
        Eigen::Index next = 0;
        for (std::size_t i = 0; i < derivatives.size(); ++i) {
            Eigen::Matrix3d const off = derivatives[i] - exact;
            for (int lift = 0; lift < 3; ++lift) {
                double const factor = ofLifts[lift] * std::sqrt(_areas[i]);
                values[next++] = factor * (off(0, lift) + off(2, lift)) / 2;
                values[next++] = factor * (off(0, lift) - off(2, lift)) / 2;
                values[next++] = factor * off(1, lift);
            }
        }
        return values;
    }

    /// 0 where curvature is bounded around a vertex and around a quad.
    Eigen::VectorXd MeasureBounds(QuadMasks const &masks) const {
        if (!isRegular()) {
            return Eigen::VectorXd();
        }
        // How much less than these further eigenvalues are, for curvature to settle soon.
        constexpr double kFurtherBowl = 0.9;
        constexpr double kFurtherTilt = 0.95;
        std::vector<double> values;
        for (MeshCenter const &center : _centers) {
            auto const eigenvalues = ComputeEigenvalues(MakeLocalSubdivision(
                _surface.GetRefiner(), FarExt::kNumStepsToConstantMasks, center, [&](int cVertex) {
                    return _surface.GetRow(masks, FarExt::kNumStepsToConstantMasks, cVertex);
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

    /// The difference of 1 and the sum of the weights, where it is below 0.
    Eigen::VectorXd MeasureRest(QuadMasks masks) const {
        constexpr double kOfNegative = 10;
        std::vector<double> values;
        forEachFree(masks, [&](double const *mask, int, std::vector<int> const &, bool) {
            values.push_back(kOfNegative * std::min(0.0, mask[0]));
        });
        return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
    }

    std::vector<Entry> Judge(QuadMasks const &masks) const {
        std::vector<Entry> entries = {{"quadratics", MeasureQuadratics(masks).norm()}};
        if (isRegular()) {
            for (auto const &[numU, numV] : {std::pair(14, 8), std::pair(9, 6), std::pair(7, 12)}) {
                Shape const torus = MakeTorus(numU, numV, TorusFaces::Quads);
                entries.push_back(
                    {"torus of " + std::to_string(numU) + " x " + std::to_string(numV),
                     MeasureTorusUnevenness(refine(torus, masks), numU)});
            }
            return entries;
        }
        constexpr int kMostRegular = 5;
        Shape const shape = _numFaces > kMostRegular
                                ? MakeSphereHull(60, 200)
                                : MakeTrianglePlatonics()[_numFaces < kNumRegular ? 0 : 2];
        entries.push_back({shape.name + " as a sphere of quads",
                           MeasureSphereUnevenness(refine(MakeSphereOfQuads(shape), masks))});
        return entries;
    }

    void Print(QuadMasks const &masks) const {
        for (int i = 0; i < kNumRows; ++i) {
            QuadMasks::Row const &row = masks.rows[std::size_t(i)];
            if (kTable[i].numFaces != _numFaces) {
                continue;
            }
            std::printf("{%d, \"%s\", %.0f, {", _numFaces, kTable[i].path, kParts * row.ofVertex);
            for (int j = 0; j < kHexagon && row.HasMask(); ++j) {
                std::printf("%s%.0f", j > 0 ? ", " : "", kParts * row.weights[j]);
            }
            std::printf("}},\n");
        }
        for (int level = 1; level <= kNumInQuads && isRegular(); ++level) {
            double const *const mask = masks.inQuads[level - 1];
            std::printf("in quads, level %d: {%.0f, %.0f, %.0f, %.0f}\n", level,
                        kPartsInQuads * mask[0], kPartsInQuads * mask[1], kPartsInQuads * mask[2],
                        kPartsInQuads * mask[3]);
        }
    }

    Eigen::VectorXd Round(Eigen::VectorXd weights) const {
        QuadMasks masks = getShippedMasks();
        double *next = weights.data();
        forEachFree(masks, [&](double const *, int size, std::vector<int> const &places, bool) {
            double const parts = size == kQuad ? kPartsInQuads : kParts;
            for (std::size_t i = 0; i < places.size(); ++i, ++next) {
                *next = std::round(parts * *next) / parts;
            }
        });
        return weights;
    }

private:
    static constexpr int kNumRings = 3;

    static PolygonMesh refine(Shape const &shape, QuadMasks const &masks) {
        constexpr int kLevel = 5;
        Surface const surface(shape, kLevel);
        Points points = Points::Zero(shape.GetNumVertices(), kNumColumns);
        for (int i = 0; i < shape.GetNumVertices(); ++i) {
            points.row(i).head<3>() =
                Eigen::Map<Eigen::RowVector3d const>(&shape.positions[3 * std::size_t(i)]);
        }
        points = surface.Refine(masks, points);
        PolygonMesh mesh = surface.GetMesh();
        for (int i = 0; i < mesh.GetNumVertices(); ++i) {
            mesh.positions[std::size_t(i)] = points.row(i).head<3>();
        }
        return mesh;
    }

    bool isRegular() const { return _numFaces == kNumRegular; }

    /// Calls function(weights, their number, places of the free ones, whether the mask is symmetric), with the number 1
    /// for the weight of an F-vertex in V'.
    template <typename FUNCTION>
    void forEachFree(QuadMasks &masks, FUNCTION const &function) const {
        for (auto const &[position, isSymmetric] : _free) {
            QuadMasks::Row &row = masks.rows[std::size_t(position)];
            if (row.HasMask()) {
                function(row.weights, kHexagon,
                         isSymmetric ? std::vector<int>{1, 2, 3} : std::vector<int>{1, 2, 3, 4, 5},
                         isSymmetric);
            }
            function(&row.ofVertex, 1, {0}, false);
        }
        for (auto &mask : masks.inQuads) {
            if (isRegular()) {
                function(mask, kQuad, {1, 2}, true);
            }
        }
    }

    /// Throws where the masks of the library do not make here what they make there.
    void compareWithLibrary() const {
        constexpr double kTolerance = 1e-12;
        Points const points = _surface.Refine(getShippedMasks(), _lifted);
        PolygonMesh const &mesh = _surface.GetMesh();
        for (int i = 0; i < mesh.GetNumVertices(); ++i) {
            auto const position = mesh.positions[std::size_t(i)].head<2>();
            if (!((position.transpose() - points.row(i).head<2>()).norm() < kTolerance)) {
                throw std::runtime_error("vertex " + std::to_string(i) +
                                         " is not where the library has it");
            }
        }
    }

    void findFree() {
        std::array<int, kNumRows> isSymmetric;
        isSymmetric.fill(-1);
        _surface.ForEachRow(
            [&](int position, bool symmetric) { isSymmetric[std::size_t(position)] = symmetric; });
        for (int i = 0; i < kNumRows; ++i) {
            if (kTable[i].numFaces == _numFaces && isSymmetric[std::size_t(i)] >= 0) {
                _free.emplace_back(i, isSymmetric[std::size_t(i)] == 1);
            }
        }
    }

    void chooseVertices() {
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
            double const ofRing =
                _areas[i] / ofRings[std::size_t(rings[i])] / double(ofRings.size());
            _areas[i] = kOfRings * ofRing + (1 - kOfRings) * _areas[i] / sum;
        }
        _curvatures = std::make_unique<Curvatures>(mesh, vertices);
        _surface.NeedOnly(_curvatures->GetNeeded());
    }

    void findCenters() {
        for (MeshCenter center :
             {MeshCenter{CenterKind::Vertex, 0}, MeshCenter{CenterKind::Face, 0}}) {
            for (int depth = 0; depth < FarExt::kNumStepsToConstantMasks; ++depth) {
                center = FindChild(center, _surface.GetRefiner().GetLevel(depth),
                                   _surface.GetRefiner().GetLevel(depth + 1));
            }
            _centers.push_back(center);
        }
    }

    int const _numFaces;
    Shape const _shape;
    Surface _surface;
    Points _lifted;
    std::vector<std::pair<int, bool>>
        _free;                  // positions in the table, and whether masks are symmetric
    std::vector<double> _areas; // by chosen vertex; their sum is 1
    std::unique_ptr<Curvatures> _curvatures;
    std::vector<MeshCenter> _centers; // at the first level with constant masks
};

QuadMaskSearch::QuadMaskSearch(int numFaces, int level)
    : _implementation(std::make_unique<Implementation>(numFaces, level)) {}
QuadMaskSearch::~QuadMaskSearch() = default;

Eigen::VectorXd QuadMaskSearch::GetShipped() const {
    return _implementation->Gather(getShippedMasks());
}
Eigen::VectorXd QuadMaskSearch::GetStart() const {
    return _implementation->Gather(_implementation->GetStart());
}

Eigen::VectorXd QuadMaskSearch::Measure(Eigen::VectorXd const &weights) const {
    QuadMasks const masks = _implementation->Spread(weights);
    Eigen::VectorXd const parts[] = {_implementation->MeasureQuadratics(masks),
                                     _implementation->MeasureBounds(masks),
                                     _implementation->MeasureRest(masks)};
    Eigen::VectorXd values(parts[0].size() + parts[1].size() + parts[2].size());
    values << parts[0], parts[1], parts[2];
    return values;
}

std::vector<QuadMaskSearch::Entry> QuadMaskSearch::Judge(Eigen::VectorXd const &weights) const {
    return _implementation->Judge(_implementation->Spread(weights));
}

Eigen::VectorXd QuadMaskSearch::Round(Eigen::VectorXd weights) const {
    return _implementation->Round(std::move(weights));
}
void QuadMaskSearch::Print(Eigen::VectorXd const &weights) const {
    _implementation->Print(_implementation->Spread(weights));
}

} // namespace OpenSubdivHex::Regression

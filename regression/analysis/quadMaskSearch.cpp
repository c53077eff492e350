// SPDX-License-Identifier: Apache-2.0
#include "quadMaskSearch.h"

#include "evenness.h"
#include "maskedStep.h"
#include "position.h"
#include "ripple.h"

#include "far_ext/mask.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::FaceMask;
using FarExt::HexSchemeOptions;
using FarExt::IrregularVertexMask;
using FarExt::internal::IrregularCorner;
using FarExt::internal::Level;
using FarExt::internal::RefinementMask;
using Position = PositionReal<double>;

constexpr int kHexagon = 6;
constexpr int kNumSearchedLevels = 2;

struct HexagonWeights {
    double atVertex[kHexagon];
    double atNeighbor[kHexagon];
    double besideQuad[kHexagon];
};

/// Of one of the first levels, from 1 on.
HexagonWeights spread(QuadWeights const &weights, int level) {
    auto const setAtVertex = [](double side, double next, double(&at)[kHexagon]) {
        double const values[] = {1 - 2 * side - 2 * next, side, next, 0, next, side};
        std::copy(std::begin(values), std::end(values), at);
    };
    HexagonWeights result{};
    if (level == 1) {
        setAtVertex(weights[0], weights[1], result.atVertex);
        // No corner at a neighbor of a vertex among quads but is beside a quad.
        FarExt::ComputeQuadNeighborMask(1, result.besideQuad);
        return result;
    }
    setAtVertex(weights[2], weights[3], result.atVertex);
    double const atNeighbor[] = {weights[4], weights[5], 0,
                                 0,          weights[6], 1 - weights.segment<3>(4).sum()};
    std::copy(std::begin(atNeighbor), std::end(atNeighbor), result.atNeighbor);
    result.besideQuad[0] = 1 - weights.tail<5>().sum();
    std::copy_n(weights.data() + 7, 5, result.besideQuad + 1);
    return result;
}

/// The mask of an irregular corner, from the corner on; null of one that is not searched for.
double const *findMask(HexagonWeights const &weights, IrregularCorner const &irregular) {
    switch (irregular.kind) {
    case IrregularCorner::kAtVertexAmongQuads:
        return weights.atVertex;
    case IrregularCorner::kBehindVertexAmongQuads:
    case IrregularCorner::kBeforeVertexAmongQuads:
        return weights.atNeighbor;
    case IrregularCorner::kAlongQuad:
    case IrregularCorner::kBehindQuad:
        return weights.besideQuad;
    default:
        return nullptr;
    }
}

bool isBackwards(IrregularCorner::Kind kind) {
    return kind == IrregularCorner::kBeforeVertexAmongQuads || kind == IrregularCorner::kBehindQuad;
}

/// Quads of a plane around a vertex, lifted by very little to a quadratic form, or to x y.
Shape makeLifted(double xx, double xy, double yy) {
    constexpr int kNumRings = 3;
    constexpr double kHeight = 1e-3; // so that slopes do not matter
    Shape shape = MakeVertexDisk(Tiling::Quads, 4, kNumRings);
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        double const x = shape.positions[i];
        double const y = shape.positions[i + 1];
        shape.positions[i + 2] = kHeight * (xx * x * x + xy * x * y + yy * y * y);
    }
    return shape;
}

} // namespace

/// A control mesh of quads, refined once; its points follow the weights.
class QuadJudge::Surface {
public:
    Surface(std::string name, Shape const &shape, int level, Curvature curvature, double weight)
        : _name(std::move(name)), _curvature(curvature), _weight(weight) {
        HexSchemeOptions const options{FaceMask::Smooth};
        _refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(),
                                                          OpenSubdiv::Sdc::Options(), {options});
        FarExt::TopologyRefiner::UniformOptions uniformOptions(level);
        uniformOptions.fullTopologyInLastLevel = true;
        if (!_refiner || !_refiner->RefineUniform(uniformOptions)) {
            throw std::runtime_error(_name + " cannot be refined");
        }
        _mesh = MakeSurfaceLevels(*_refiner, shape).back().mesh;
        for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
            _base.push_back({Eigen::Map<Eigen::Vector3d const>(&shape.positions[i])});
        }
        for (int depth = 0; depth < level; ++depth) {
            _masks.emplace_back(getLevels().levels[std::size_t(depth)], options,
                                FarExt::Interpolation::Vertex);
        }
    }

    void LookAtSector(int numU) { _chosen = FindTorusSector(_mesh, numU); }
    void LookAtCenter() {
        for (int vertex = 0; vertex < _mesh.GetNumVertices(); ++vertex) {
            if (_mesh.positions[vertex].head<2>().norm() < 1) {
                _chosen.vertices.push_back(vertex);
            }
        }
        _chosen.groups.assign(_chosen.vertices.size(), 0);
    }

    Eigen::VectorXd Measure(QuadWeights const &weights) {
        refine(weights);
        Eigen::VectorXd const deviations =
            MeasureDeviations(_mesh, _chosen.vertices, _chosen.groups, _curvature);
        _unevenness = deviations.norm();
        return _weight * deviations;
    }

    Entry GetEntry() const { return {_name, _unevenness}; }

private:
    FarExt::internal::MeshLevels const &getLevels() const { return _refiner->GetHierarchy().mesh; }

    void refine(QuadWeights const &weights) {
        std::vector<Position> points = _base;
        std::vector<double> scratch;
        for (std::size_t depth = 0; depth < _masks.size(); ++depth) {
            Level const &parent = getLevels().levels[depth];
            bool const isSearched = depth > 0 && depth <= kNumSearchedLevels;
            HexagonWeights const searched =
                isSearched ? spread(weights, int(depth)) : HexagonWeights{};
            double turned[kHexagon];
            auto const getWeights = [&](int face, int i) -> double const * {
                int const corner = parent.faceFirstCorner[std::size_t(face)] + i;
                auto const irregular = parent.GetIrregularCorners(corner, corner + 1);
                double const *const mask =
                    isSearched && !irregular.empty() ? findMask(searched, irregular[0]) : nullptr;
                if (!mask) {
                    return _masks[depth].GetFaceVertexWeights(face, i, scratch);
                }
                for (int j = 0; j < kHexagon; ++j) {
                    turned[(i + (isBackwards(irregular[0].kind) ? kHexagon - j : j)) % kHexagon] =
                        mask[j];
                }
                return turned;
            };
            std::vector<Position> refined(std::size_t(getLevels().levels[depth + 1].numVertices));
            InterpolateMasked(getLevels().refinements[depth], _masks[depth], getWeights, points,
                              refined);
            points = std::move(refined);
        }
        std::transform(points.begin(), points.end(), _mesh.positions.begin(),
                       [](Position const &point) { return point.value; });
    }

    std::string _name;
    Curvature _curvature;
    double _weight;
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::vector<RefinementMask> _masks; // by parent
    std::vector<Position> _base;
    PolygonMesh _mesh;
    VertexGroups _chosen;
    double _unevenness = 0;
};

QuadJudge::QuadJudge(int level) {
    constexpr double kOfPlane = 0.2;
    for (auto const &[numU, numV] : {std::pair(14, 8), {20, 10}, {9, 6}}) {
        _surfaces.push_back(std::make_unique<Surface>(
            "torus " + std::to_string(numU) + " x " + std::to_string(numV),
            MakeTorus(numU, numV, TorusFaces::Quads), level, Curvature::Mean, 1));
        _surfaces.back()->LookAtSector(numU);
    }
    auto const addLifted = [&](char const *name, Shape const &shape, Curvature curvature) {
        _surfaces.push_back(std::make_unique<Surface>(name, shape, level, curvature, kOfPlane));
        _surfaces.back()->LookAtCenter();
    };
    addLifted("x^2 + y^2", makeLifted(1, 0, 1), Curvature::Mean);
    addLifted("x^2 - y^2", makeLifted(1, 0, -1), Curvature::Gaussian);
    addLifted("2 x y", makeLifted(0, 2, 0), Curvature::Gaussian);
}

QuadJudge::~QuadJudge() = default;

Eigen::VectorXd QuadJudge::Measure(QuadWeights const &weights) {
    constexpr double kOfNegative = 1.5;
    std::vector<double> values;
    for (auto const &surface : _surfaces) {
        Eigen::VectorXd const deviations = surface->Measure(weights);
        values.insert(values.end(), deviations.begin(), deviations.end());
    }
    for (int level = 1; level <= kNumSearchedLevels; ++level) {
        HexagonWeights const all = spread(weights, level);
        for (auto const &mask : {all.atVertex, all.atNeighbor, all.besideQuad}) {
            std::transform(mask, mask + kHexagon, std::back_inserter(values),
                           [](double weight) { return kOfNegative * std::min(0.0, weight); });
        }
    }
    return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
}

std::vector<QuadJudge::Entry> QuadJudge::GetEntries() const {
    std::vector<Entry> entries;
    for (auto const &surface : _surfaces) {
        entries.push_back(surface->GetEntry());
    }
    return entries;
}

QuadWeights GetShippedQuadWeights() {
    IrregularVertexMask const first =
        FarExt::ComputeIrregularVertexMask(FarExt::kNumFacesAmongQuads, 1, true);
    IrregularVertexMask const second =
        FarExt::ComputeIrregularVertexMask(FarExt::kNumFacesAmongQuads, 2, true);
    double besideQuad[kHexagon];
    FarExt::ComputeQuadNeighborMask(2, besideQuad);
    QuadWeights result;
    result << first.atVertex[1], first.atVertex[2], second.atVertex[1], second.atVertex[2],
        second.atNeighbor[0], second.atNeighbor[1], second.atNeighbor[4],
        Eigen::Map<Eigen::Matrix<double, 5, 1> const>(besideQuad + 1);
    return result;
}

QuadWeights GetPlainQuadWeights() {
    IrregularVertexMask const plain =
        FarExt::ComputeIrregularVertexMask(FarExt::kNumFacesAmongQuads, 1);
    double face[kHexagon];
    FarExt::ComputeFaceVertexMask(FaceMask::Smooth, FarExt::Interpolation::Vertex, kHexagon, face);
    QuadWeights result;
    result << plain.atVertex[1], plain.atVertex[2], plain.atVertex[1], plain.atVertex[2],
        plain.atNeighbor[0], plain.atNeighbor[1], plain.atNeighbor[4],
        Eigen::Map<Eigen::Matrix<double, 5, 1> const>(face + 1);
    return result;
}

QuadWeights SearchQuadWeights(QuadWeights weights, int maxSteps, QuadJudge &judge) {
    constexpr double kDifference = 1e-5;
    constexpr double kLargestChange = 0.1;
    constexpr double kLeastGain = 1e-4;
    constexpr double kFactor = 5; // of the damping, from one attempt to the next
    constexpr int kMaxAttempts = 9;
    double damping = 1e-3;
    Eigen::VectorXd values = judge.Measure(weights);
    for (int step = 0; step < maxSteps; ++step) {
        Eigen::MatrixXd derivatives(values.size(), weights.size());
        for (Eigen::Index i = 0; i < weights.size(); ++i) {
            QuadWeights changed = weights;
            changed[i] += kDifference;
            derivatives.col(i) = (judge.Measure(changed) - values) / kDifference;
        }
        Eigen::MatrixXd const squares = derivatives.transpose() * derivatives;
        QuadWeights const slope = derivatives.transpose() * values;
        double const before = values.norm();
        bool isBetter = false;
        for (int attempt = 0; attempt < kMaxAttempts && !isBetter; ++attempt, damping *= kFactor) {
            Eigen::MatrixXd damped = squares;
            damped.diagonal().array() += damping;
            QuadWeights right = -slope;
            for (Eigen::Index i = 0; i < weights.size(); ++i) {
                if (weights[i] <= 0 && slope[i] > 0) { // stays at 0
                    damped.row(i).setZero();
                    damped.col(i).setZero();
                    damped(i, i) = 1;
                    right[i] = 0;
                }
            }
            QuadWeights change = damped.ldlt().solve(right);
            change *= std::min(1.0, kLargestChange / change.cwiseAbs().maxCoeff());
            QuadWeights const next = (weights + change).cwiseMax(0);
            Eigen::VectorXd const nextValues = judge.Measure(next);
            if (nextValues.norm() < before) {
                weights = next;
                values = nextValues;
                damping /= kFactor * kFactor;
                isBetter = true;
            }
        }
        if (before - values.norm() < kLeastGain * before) {
            break;
        }
    }
    judge.Measure(weights);
    return weights;
}

QuadWeights RoundQuadWeights(QuadWeights const &weights) {
    constexpr double kParts = 128;
    return (kParts * weights).array().round() / kParts;
}

} // namespace OpenSubdivHex::Regression

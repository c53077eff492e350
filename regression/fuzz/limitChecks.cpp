// SPDX-License-Identifier: Apache-2.0
#include "elementBuffer.h"
#include "oracle.h"

#include "far_ext/stencilTableFactory.h"
#include "osd_ext/refinementEvaluator.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

using FarExt::LimitSides;
using FarExt::LimitStencilTableFactoryReal;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

/// The bound that LimitStencilTableFactory documents for derivatives, and some roundings.
constexpr double kLargestWeight = 8 + 1e-5;

/// Points and derivatives at the vertices, further sides and face centres of a level.
struct LimitLevel {
    ReferenceValues points, du, dv;
    LimitSides sides;
};

/// The sum of the weights of each row, and of their products with the control values.
template <typename TABLE, typename REAL>
ReferenceValues apply(TABLE const &table, std::vector<REAL> const &weights,
                      ReferenceValues const &base, double expectedSum, std::string const &name) {
    ReferenceValues values = ReferenceValues::Zero(table.GetNumStencils(), base.cols());
    for (int i = 0; i < table.GetNumStencils(); ++i) {
        double sum = 0;
        double size = 1;
        int const offset = table.GetOffsets()[std::size_t(i)];
        for (int k = offset; k < offset + table.GetSizes()[std::size_t(i)]; ++k) {
            double const weight = weights[std::size_t(k)];
            int const index = table.GetControlIndices()[std::size_t(k)];
            double const smallest = expectedSum == 1 ? -1e-9 : -kLargestWeight;
            if (!(weight >= smallest && weight <= kLargestWeight) || index < 0 ||
                index >= base.rows()) {
                Fail(name, ": row ", i, " has weight ", weight, " of ", index);
            }
            values.row(i) += weight * base.row(index);
            sum += weight;
            size += std::abs(weight);
        }
        if (!(std::abs(sum - expectedSum) < (sizeof(REAL) == 8 ? 1e-9 : 3e-6) * size)) {
            Fail(name, ": row ", i, " has weights that sum to ", sum);
        }
    }
    return values;
}

template <typename REAL>
LimitLevel makeLimit(TopologyRefiner const &refiner, int level, ReferenceValues const &base) {
    using Factory = LimitStencilTableFactoryReal<REAL>;
    typename Factory::Options options;
    options.level = level;
    options.generateFurtherSides = true;
    options.generateFaceCenters = true;
    FarExt::CallStatus status;
    auto const table = Factory::Create(refiner, options, &status);
    if (!table) {
        Fail("no limit table of level ", level, ": ", status.GetErrorMessage());
    }
    LimitLevel limit{{}, {}, {}, LimitSides(refiner.GetLevel(level))};
    int const numRows = limit.sides.GetNumSides() + refiner.GetLevel(level).GetNumFaces();
    if (table->GetNumStencils() != numRows) {
        Fail("the limit table of level ", level, " has ", table->GetNumStencils(), " rows, not ",
             numRows);
    }
    std::string const name = "limit of level " + std::to_string(level);
    limit.points = apply(*table, table->GetWeights(), base, 1, name);
    limit.du = apply(*table, table->GetDuWeights(), base, 0, name + ", du");
    limit.dv = apply(*table, table->GetDvWeights(), base, 0, name + ", dv");
    return limit;
}

/// The points of vertices and faces are those of their children, which have the same limit.
void checkNextLevel(OracleLevels const &levels, int depth, LimitLevel const &parent,
                    LimitLevel const &child) {
    TopologyLevel const &level = levels.refiner.GetLevel(depth);
    double const allowed =
        levels.oracleCase.GetTolerance(1e-10) * std::max(1.0, GetSize(levels.values[0].levels[0]));
    double const allowedOfNormals = 1000 * levels.oracleCase.GetTolerance(1e-9);
    for (int side = 0; side < parent.sides.GetNumSides(); ++side) {
        int const vert = parent.sides.GetVertex(side);
        if (!IsOnFreeBoundary(levels.refiner, level, vert) &&
            !(GetDifference(parent.points.row(side), child.points.row(vert)) <= allowed)) {
            Fail("the limit of vertex ", vert, " is ", parent.points.row(side), " at level ", depth,
                 ", and then ", child.points.row(vert));
        }
    }
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        auto const row = parent.sides.GetNumSides() + face;
        auto const cRow = child.sides.GetNumSides() + level.GetFaceChildFaces(face)[0];
        if (!(GetDifference(parent.points.row(row), child.points.row(cRow)) <= allowed)) {
            Fail("the limit of face ", face, " is ", parent.points.row(row), " at level ", depth,
                 ", and then ", child.points.row(cRow));
        }
        // Its plane, where that is one.
        Eigen::Vector3d const normal =
            Eigen::Vector3d(parent.du.row(row)).cross(Eigen::Vector3d(parent.dv.row(row)));
        Eigen::Vector3d const cNormal =
            Eigen::Vector3d(child.du.row(cRow)).cross(Eigen::Vector3d(child.dv.row(cRow)));
        double const area = parent.du.row(row).norm() * parent.dv.row(row).norm();
        if (normal.norm() > 0.05 * area && area > 1e-3 &&
            !((normal.normalized() - cNormal.normalized()).norm() < allowedOfNormals)) {
            Fail("the normal of face ", face, " is ", normal.normalized().transpose(), " at level ",
                 depth, ", and then ", cNormal.normalized().transpose());
        }
    }
}

/// RefinementEvaluator makes the points and derivatives of the table's vertices.
class LimitEvaluation {
public:
    LimitEvaluation(OracleLevels const &levels, Dice &dice)
        : _base(levels.values[0].levels[0]), _dice(dice),
          _scope(GetSimdLevels()[std::size_t(dice.Roll(int(GetSimdLevels().size())))], 1),
          _evaluator(OsdExt::RefinementEvaluator::Create(levels.refiner)),
          _source(MakeSource(_base, 1 + dice.Roll(9), dice)) {}

    void Check(int level, LimitLevel const &expected) {
        std::string const name = "EvaluateLimit of level " + std::to_string(level);
        int const count = _evaluator->GetNumElements(level);
        ElementBuffer points = makeBuffer(count);
        ElementBuffer du = makeBuffer(count);
        ElementBuffer dv = makeBuffer(count);
        ElementBuffer alone = makeBuffer(count);
        FarExt::CallStatus status;
        if (!_evaluator->EvaluateLimit(_source.floats.data(), _source.desc, points.floats.data(),
                                       points.desc, du.floats.data(), du.desc, dv.floats.data(),
                                       dv.desc, level, &status) ||
            !_evaluator->EvaluateLimit(_source.floats.data(), _source.desc, alone.floats.data(),
                                       alone.desc, level, &status)) {
            Fail(name, " refuses: ", status.GetErrorMessage());
        }
        double const allowed = 2e-6 * std::max(1.0, GetSize(_base));
        // Sums of weights of derivatives are 16 at most.
        double const allowedOfDerivatives = 10 * allowed;
        CheckElements(points, 0, count, expected.points, 0, allowed, name);
        CheckElements(alone, 0, count, expected.points, 0, allowed, name + ", points alone");
        CheckElements(du, 0, count, expected.du, 0, allowedOfDerivatives, name + ", du");
        CheckElements(dv, 0, count, expected.dv, 0, allowedOfDerivatives, name + ", dv");
    }

private:
    ElementBuffer makeBuffer(int count) { return ElementBuffer(count, _source.desc.length, _dice); }

    ReferenceValues const &_base;
    Dice &_dice;
    EvaluatorScope const _scope;
    std::unique_ptr<OsdExt::RefinementEvaluator> const _evaluator;
    ElementBuffer const _source;
};

} // namespace

bool IsOnFreeBoundary(TopologyRefiner const &refiner, TopologyLevel const &level, int vert) {
    bool const isRule =
        refiner.GetSchemeOptions().GetVtxBoundaryInterpolation() == Sdc::Options::VTX_BOUNDARY_NONE;
    auto const edges = level.GetVertexEdges(vert);
    return isRule && std::any_of(edges.begin(), edges.end(), [&](int edge) {
               return level.IsEdgeBoundary(edge) && !level.IsEdgeInfSharp(edge);
           });
}

void CheckLimits(OracleLevels const &levels, Dice &dice) {
    ReferenceValues const &base = levels.values[0].levels[0];
    // A truncation has no limit of its own: level 1 is its base.
    int const first = levels.refiner.GetHexSchemeOptions().IsHexagonal() ? 0 : 1;
    int const maxLevel = std::min(levels.refiner.GetMaxLevel(), 2);
    if (maxLevel < first) {
        return;
    }
    LimitLevel parent = makeLimit<double>(levels.refiner, first, base);
    LimitLevel const inFloat = makeLimit<float>(levels.refiner, first, base);
    LimitEvaluation evaluation(levels, dice);
    evaluation.Check(first, parent);
    double const allowed = 2e-6 * std::max(1.0, GetSize(base));
    for (Eigen::Index row = 0; row < parent.points.rows(); ++row) {
        double const size =
            1 + parent.du.row(row).cwiseAbs().maxCoeff() + parent.dv.row(row).cwiseAbs().maxCoeff();
        if (!(GetDifference(parent.points.row(row), inFloat.points.row(row)) <= allowed) ||
            !(GetDifference(parent.du.row(row), inFloat.du.row(row)) <= allowed * 10 * size) ||
            !(GetDifference(parent.dv.row(row), inFloat.dv.row(row)) <= allowed * 10 * size)) {
            Fail("the limit table of floats has another row ", row);
        }
    }
    for (int level = first + 1; level <= maxLevel; ++level) {
        LimitLevel child = makeLimit<double>(levels.refiner, level, base);
        checkNextLevel(levels, level - 1, parent, child);
        evaluation.Check(level, child);
        parent = std::move(child);
    }
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "oracle.h"

#include "regression/far_ext/regionMatch.h"
#include "regression/far_ext/taggedMatch.h"
#include "regression/osd_ext/drawnFaces.h"
#include "regression/reference/largestValue.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/error.h>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

using FarExt::CallStatus;
using FarExt::StatusCode;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

/// The difference that some roundings make, in double precision.
constexpr double kTolerance = 1e-12;

/// Far prints what it finds about meshes unless it is told not to.
void silenceFar() {
    static bool const isSilent = [] {
        Far::SetErrorCallback([](Far::ErrorType, char const *) {});
        Far::SetWarningCallback([](char const *) {});
        return true;
    }();
    static_cast<void>(isSilent);
}

/// A refusal says what it is about, and is one of those that are documented.
void checkRefusal(OracleCase const &oracleCase, CallStatus const &status) {
    if (status.IsOk() || status.GetErrorMessage().empty()) {
        Fail("no refiner, and no cause");
    }
    bool const takesTags = oracleCase.schemeType == FarExt::SchemeType::Hexagonal &&
                           oracleCase.firstStep != FarExt::FirstStep::TriHex;
    if (status.GetCode() == StatusCode::Unsupported && !takesTags) {
        return;
    }
    // A channel that does not come apart where its mesh does.
    if (status.GetCode() == StatusCode::Unsupported && !oracleCase.shape.fvarChannels.empty() &&
        status.GetComponentType() == FarExt::ComponentType::Vertex &&
        CreateFarRefiner(oracleCase.shape, oracleCase.sdcOptions)
            ->GetLevel(0)
            .IsVertexNonManifold(status.GetComponentIndex())) {
        return;
    }
    Fail("refused: ", status.GetErrorMessage());
}

void checkLevels(TopologyRefiner const &refiner) {
    for (int level = 0; level <= refiner.GetMaxLevel(); ++level) {
        CallStatus status;
        if (!refiner.GetLevel(level).Validate(&status)) {
            Fail("level ", level, " is not valid: ", status.GetErrorMessage());
        }
    }
}

/// The polygons and triangles of the last level, by direct search.
void checkDrawnFaces(TopologyRefiner const &refiner, Dice &dice) {
    TopologyLevel const &level = refiner.GetLevel(refiner.GetMaxLevel());
    std::vector<int> labels(std::size_t(refiner.GetLevel(0).GetNumFaces()));
    for (int &label : labels) {
        label = dice.Roll(3);
    }
    OsdExt::DrawOptions options;
    options.cutBaseFaces = dice.IsOneOf(2);
    options.cutCreases = OsdExt::CreaseCuts(dice.Roll(3));
    options.drawHoles = dice.IsOneOf(2);
    if (dice.IsOneOf(2)) {
        options.labels = Far::ConstIndexArray(labels.data(), int(labels.size()));
    }
    for (int channel = 0; channel < refiner.GetNumFVarChannels(); ++channel) {
        if (dice.IsOneOf(2)) {
            options.fvarChannels.push_back(channel);
        }
    }
    std::string const error = FindDrawingError(level, options);
    if (!error.empty()) {
        Fail("drawn faces: ", error);
    }
}

void checkRows(std::vector<ReferenceValues> const &actual,
               std::vector<ReferenceValues> const &expected, double tolerance,
               std::string const &what) {
    double const allowed = tolerance * std::max(1.0, GetSize(expected[0]));
    for (std::size_t level = 0; level < expected.size(); ++level) {
        for (Eigen::Index i = 0; i < expected[level].rows(); ++i) {
            // Rows that the reference does not know are those of values that no corner has.
            if (!std::isnan(expected[level](i, 0)) &&
                !(GetDifference(actual[level].row(i), expected[level].row(i)) <= allowed)) {
                Fail(what, " differ from the reference: level ", level, ", row ", i, ": ",
                     actual[level].row(i), ", not ", expected[level].row(i));
            }
        }
    }
}

/// Topology and values of one mode against the reference.
void checkReference(OracleLevels const &levels, OracleLevels::Values const &values,
                    TaggedMatch const &match) {
    if (!match.GetError().empty()) {
        Fail("topology differs from the reference, channel ", values.channel, ": ",
             match.GetError());
    }
    bool const isLinear = values.mode == FarExt::INTERPOLATE_VARYING ||
                          (values.mode == FarExt::INTERPOLATE_FACE_VARYING &&
                           levels.refiner.GetFVarLinearInterpolation(values.channel) ==
                               Sdc::Options::FVAR_LINEAR_ALL);
    ReferenceValues const &base = values.levels[0];
    checkRows(values.levels,
              isLinear ? match.InterpolateVaryingAll(base)
                       : match.InterpolateAll(levels.oracleCase.mask, base),
              levels.oracleCase.GetTolerance(kTolerance),
              "values of mode " + std::to_string(values.mode));
}

void checkReferences(OracleLevels const &levels) {
    OracleCase const &oracleCase = levels.oracleCase;
    TaggedMatch const match(oracleCase.shape, levels.refiner, -1, oracleCase.closeGaps);
    checkReference(levels, levels.values[0], match);
    checkReference(levels, levels.values[1], match);
    for (std::size_t i = 2; i < levels.values.size(); ++i) {
        int const channel = levels.values[i].channel;
        checkReference(
            levels, levels.values[i],
            TaggedMatch(oracleCase.shape, levels.refiner, channel, oracleCase.closeGaps));
    }
}

std::vector<OracleLevels::Values> interpolate(OracleCase const &oracleCase,
                                              TopologyRefiner const &refiner) {
    ReferenceValues const positions = GetPositions(oracleCase.shape);
    std::vector<OracleLevels::Values> values;
    values.push_back({FarExt::INTERPOLATE_VERTEX, 0, InterpolateLevels(refiner, positions)});
    values.push_back({FarExt::INTERPOLATE_VARYING, 0,
                      InterpolateLevels(refiner, positions, ValueKind::Varying)});
    for (int channel = 0; channel < refiner.GetNumFVarChannels(); ++channel) {
        values.push_back(
            {FarExt::INTERPOLATE_FACE_VARYING, channel,
             InterpolateLevels(refiner, GetValues(oracleCase.shape.fvarChannels[channel]),
                               ValueKind::FaceVarying, channel)});
    }
    return values;
}

} // namespace

double GetDifference(Eigen::RowVectorXd const &a, Eigen::RowVectorXd const &b) {
    return GetLargestValue(a - b);
}

void CheckOracleCase(OracleCase const &oracleCase) {
    silenceFar();
    CheckBases(oracleCase);
    CallStatus status;
    auto const refiner = CreateRefiner(oracleCase, &status);
    if (!refiner) {
        checkRefusal(oracleCase, status);
        return;
    }
    checkLevels(*refiner);
    OracleLevels const levels{oracleCase, *refiner, interpolate(oracleCase, *refiner)};
    Dice dice(oracleCase.checks);
    checkDrawnFaces(*refiner, dice);
    checkReferences(levels);
    CheckTables(levels, dice);
    CheckEvaluators(levels, dice);
    bool const isHexagonal = refiner->GetHexSchemeOptions().IsHexagonal();
    if (isHexagonal && !oracleCase.isCoplanar && dice.IsOneOf(4)) {
        if (std::string const error = FindRegionError(oracleCase.shape, *refiner); !error.empty()) {
            Fail("base faces differ from the reference: ", error);
        }
    }
    bool const isTruncation = oracleCase.firstStep == FarExt::FirstStep::Truncate;
    if ((isHexagonal || isTruncation) && dice.IsOneOf(4)) {
        CheckOrders(levels, dice);
    }
    if ((isHexagonal || isTruncation) && !oracleCase.isCoplanar && dice.IsOneOf(8)) {
        CheckLimits(levels, dice);
    }
    if (oracleCase.schemeType == FarExt::SchemeType::Hexagonal && !oracleCase.isCoplanar &&
        oracleCase.level >= refiner->GetHexSchemeOptions().GetSurfaceLevel() && dice.IsOneOf(32)) {
        CheckSurfaces(levels, dice);
    }
    if (oracleCase.schemeType == FarExt::SchemeType::Hexagonal && !oracleCase.isCoplanar &&
        dice.IsOneOf(32)) {
        CheckPatches(levels, dice);
    }
    if (dice.IsOneOf(2048)) {
        CheckThreads(oracleCase);
    }
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
#include "oracle.h"

#include "far_ext/stencilTableFactory.h"
#include "osd_ext/refinementEvaluator.h"
#include "regression/osd_ext/evaluators.h"

namespace OpenSubdivHex::Regression {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

/// All that one to three threads must make alike.
struct Made {
    std::vector<int> topology;
    std::vector<float> tables;
    std::vector<float> values;
};

template <typename ARRAY>
void append(std::vector<int> &to, ARRAY const &from) {
    to.insert(to.end(), from.begin(), from.end());
}

std::vector<int> listTopology(TopologyRefiner const &refiner) {
    std::vector<int> all;
    for (int depth = 0; depth <= refiner.GetMaxLevel(); ++depth) {
        TopologyLevel const &level = refiner.GetLevel(depth);
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            append(all, level.GetFaceVertices(f));
            append(all, level.GetFaceEdges(f));
        }
        for (int e = 0; e < level.GetNumEdges(); ++e) {
            append(all, level.GetEdgeVertices(e));
            append(all, level.GetEdgeFaces(e));
            all.push_back(int(level.GetEdgeSharpness(e) * 256));
        }
        for (int v = 0; v < level.GetNumVertices(); ++v) {
            append(all, level.GetVertexFaces(v));
            append(all, level.GetVertexEdges(v));
            all.push_back(level.GetVertexRule(v));
        }
    }
    return all;
}

Made make(OracleCase const &oracleCase, int numThreads) {
    EvaluatorScope const scope(OsdExt::GetSimdLevel(), numThreads);
    FarExt::CallStatus status;
    auto const refiner = CreateRefiner(oracleCase, &status);
    if (!refiner) {
        Fail("refused at level ", oracleCase.level, ": ", status.GetErrorMessage());
    }
    Made made{listTopology(*refiner), {}, {}};
    auto const addTable = [&](auto const &table) {
        if (!table) {
            Fail("no table at level ", oracleCase.level, ": ", status.GetErrorMessage());
        }
        append(made.topology, table->GetSizes());
        append(made.topology, table->GetControlIndices());
        made.tables.insert(made.tables.end(), table->GetWeights().begin(),
                           table->GetWeights().end());
    };
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    addTable(FarExt::StencilTableFactory::Create(*refiner, options, &status));
    OsdExt::RefinementEvaluator::Options evaluatorOptions;
    if (refiner->GetNumFVarChannels() > 0) {
        evaluatorOptions.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
        options.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
        options.factorizeIntermediateLevels = false;
        addTable(FarExt::StencilTableFactory::Create(*refiner, options, &status));
    }
    if (refiner->GetHexSchemeOptions().GetStepOfLevel(oracleCase.level + 1) ==
            FarExt::StepType::Hexagonal &&
        !oracleCase.isCoplanar) {
        FarExt::LimitStencilTableFactory::Options limitOptions;
        limitOptions.level = oracleCase.level;
        limitOptions.generateFaceCenters = true;
        addTable(FarExt::LimitStencilTableFactory::Create(*refiner, limitOptions, &status));
    }
    auto const evaluator = OsdExt::RefinementEvaluator::Create(*refiner, evaluatorOptions);
    std::vector<float> source;
    for (int i = 0; i < 3 * evaluator->GetNumElements(0); ++i) {
        source.push_back(float(i * 7919 % 1009) / 505 - 1);
    }
    made.values.resize(3 * std::size_t(evaluator->GetNumElements(oracleCase.level)));
    Descriptor const desc(0, 3, 3);
    evaluator->Evaluate(source.data(), desc, made.values.data(), desc, oracleCase.level);
    return made;
}

} // namespace

void CheckThreads(OracleCase const &oracleCase) {
    OracleCase large = oracleCase;
    // From there on all parallel loops have work for several threads.
    large.level = oracleCase.shape.GetNumCorners() > 12 ? 6 : 7;
    Made const expected = make(large, 1);
    for (int numThreads : {2, 3}) {
        Made const made = make(large, numThreads);
        if (made.topology != expected.topology || made.tables != expected.tables ||
            made.values != expected.values) {
            Fail(numThreads, " threads make other ",
                 made.topology != expected.topology ? "relations or indices"
                 : made.tables != expected.tables   ? "weights"
                                                    : "values",
                 " than one");
        }
    }
}

} // namespace OpenSubdivHex::Regression

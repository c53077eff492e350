// SPDX-License-Identifier: Apache-2.0
#include "elementBuffer.h"
#include "oracle.h"

#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/refinementEvaluator.h"
#include "osd_ext/stencilEvaluator.h"
#include "regression/osd_ext/evaluators.h"

#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace OpenSubdivHex::Regression {

using OsdExt::RefinementEvaluator;

namespace {

bool haveSameBits(std::vector<float> const &a, std::vector<float> const &b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

/// \brief A table in each evaluator: all of it, and a range.
class TableEvaluation {
public:
    TableEvaluation(Far::StencilTable const &table, ReferenceValues const &base,
                    ReferenceValues const &expected, Dice &dice)
        : _table(table), _expected(expected), _length(1 + dice.Roll(9)),
          _allowed(2e-6 * std::max(1.0, GetSize(base))), _source(MakeSource(base, _length, dice)),
          _destination(table.GetNumStencils(), _length, dice) {}

    void Run(Dice &dice) {
        int const numStencils = _table.GetNumStencils();
        // OpenSubdiv's evaluators write a range elsewhere: see StencilEvaluator.
        std::vector<Evaluator> const &osd = GetOsdEvaluators();
        evaluate(osd[dice.IsOneOf(64) ? osd.size() - 1 : 0], 0, numStencils);
        std::vector<ElementBuffer> bySimdLevel;
        for (Evaluator const &own : GetOwnEvaluators()) {
            if (own.numThreads > 1) {
                break;
            }
            ElementBuffer const whole = evaluate(own, 0, numStencils);
            bool const isOmp = bySimdLevel.size() == GetSimdLevels().size();
            if (!isOmp) {
                bySimdLevel.push_back(whole);
                checkCompact(own.simdLevel, whole);
            } else if (!haveSameBits(whole.floats, bySimdLevel.back().floats)) {
                Fail(own.name, " gives other bits than CpuEvaluator");
            }
            int const begin = dice.Roll(numStencils + 1);
            int const end = begin + dice.Roll(numStencils + 1 - begin);
            ElementBuffer part = evaluate(own, begin, end);
            for (int i = begin; i < end; ++i) {
                if (std::memcmp(&part.At(i, 0), &bySimdLevel.back().At(i, 0),
                                std::size_t(_length) * sizeof(float)) != 0) {
                    Fail(own.name, " gives other bits for element ", i, " of a range");
                }
            }
        }
    }

private:
    ElementBuffer evaluate(Evaluator const &evaluator, int begin, int end) {
        EvaluatorScope const scope(evaluator);
        ElementBuffer result = _destination;
        if (!evaluator.functions.value(
                _source.floats.data(), _source.desc, result.floats.data(), result.desc,
                _table.GetSizes().data(), _table.GetOffsets().data(),
                _table.GetControlIndices().data(), _table.GetWeights().data(), begin, end)) {
            Fail(evaluator.name, " refuses stencils ", begin, " to ", end);
        }
        CheckElements(result, begin, end, _expected, begin, _allowed, evaluator.name);
        return result;
    }

    void checkCompact(OsdExt::SimdLevel simdLevel, ElementBuffer const &expected) {
        EvaluatorScope const scope(simdLevel, 1);
        auto const compact = OsdExt::CompactStencilTable::Create(_table);
        Descriptor const desc(0, _length, _length);
        auto const create = [&](int count) {
            using Osd::CpuVertexBuffer;
            return std::unique_ptr<CpuVertexBuffer>(
                CpuVertexBuffer::Create(_length, std::max(1, count)));
        };
        auto const src = create(_table.GetNumControlVertices());
        auto const dst = create(_table.GetNumStencils());
        for (int i = 0; i < _table.GetNumControlVertices(); ++i) {
            std::copy_n(&_source.At(i, 0), _length, src->BindCpuBuffer() + i * _length);
        }
        if (!OsdExt::CpuEvaluator::EvalStencils(src.get(), desc, dst.get(), desc, compact.get())) {
            Fail("CpuEvaluator refuses a compact table");
        }
        ElementBuffer whole = expected;
        for (int i = 0; i < _table.GetNumStencils(); ++i) {
            if (std::memcmp(dst->BindCpuBuffer() + i * _length, &whole.At(i, 0),
                            std::size_t(_length) * sizeof(float)) != 0) {
                Fail("a compact table gives other bits for stencil ", i);
            }
        }
    }

    Far::StencilTable const &_table;
    ReferenceValues const &_expected;
    int _length;
    double _allowed;
    ElementBuffer _source;
    ElementBuffer _destination;
};

void checkTableEvaluators(OracleLevels const &levels, OracleLevels::Values const &values,
                          Dice &dice) {
    FarExt::StencilTableFactory::Options options;
    options.interpolationMode = values.mode;
    options.fvarChannel = values.channel;
    options.generateIntermediateLevels = false;
    auto const table = FarExt::StencilTableFactory::Create(levels.refiner, options);
    if (table && table->GetNumStencils() == int(values.levels.back().rows())) {
        TableEvaluation(*table, values.levels[0], values.levels.back(), dice).Run(dice);
    }
}

/// Level by level and all at once, at one SIMD level.
void checkRefinementEvaluator(OracleLevels const &levels, OracleLevels::Values const &values,
                              OsdExt::SimdLevel simdLevel, Dice &dice) {
    EvaluatorScope const scope(simdLevel, 1);
    RefinementEvaluator::Options options;
    options.interpolationMode = values.mode;
    options.fvarChannel = values.channel;
    FarExt::CallStatus status;
    auto const evaluator = RefinementEvaluator::Create(levels.refiner, options, &status);
    if (!evaluator) {
        Fail("no RefinementEvaluator: ", status.GetErrorMessage());
    }
    std::string const name = "RefinementEvaluator of mode " + std::to_string(values.mode);
    int const length = 1 + dice.Roll(9);
    double const allowed = 1e-6 * std::max(1.0, GetSize(values.levels[0]));
    ElementBuffer const source = MakeSource(values.levels[0], length, dice);
    ElementBuffer all(int(evaluator->GetNumElementsAllLevels()), length, dice);
    if (!evaluator->EvaluateAllLevels(source.floats.data(), source.desc, all.floats.data(),
                                      all.desc, &status)) {
        Fail(name, " refuses all levels: ", status.GetErrorMessage());
    }
    int first = 0;
    for (int level = 0; level <= evaluator->GetMaxLevel(); ++level) {
        ReferenceValues const &expected = values.levels[std::size_t(level)];
        int const numElements = evaluator->GetNumElements(level);
        if (numElements != int(expected.rows())) {
            Fail(name, " has ", numElements, " elements at level ", level);
        }
        ElementBuffer one(numElements, length, dice);
        if (!evaluator->Evaluate(source.floats.data(), source.desc, one.floats.data(), one.desc,
                                 level, &status)) {
            Fail(name, " refuses level ", level, ": ", status.GetErrorMessage());
        }
        CheckElements(one, 0, numElements, expected, 0, allowed,
                      name + ", level " + std::to_string(level));
        for (int i = 0; i < numElements && level > 0; ++i) {
            if (std::memcmp(&one.At(i, 0), &all.At(first + i, 0),
                            std::size_t(length) * sizeof(float)) != 0) {
                Fail(name, " gives other bits for element ", i, " of level ", level,
                     " alone than among all");
            }
        }
        first += level == 0 ? 0 : numElements;
    }
}

} // namespace

void CheckEvaluators(OracleLevels const &levels, Dice &dice) {
    auto const &simdLevels = GetSimdLevels();
    for (OracleLevels::Values const &values : levels.values) {
        if (dice.IsOneOf(2)) {
            checkTableEvaluators(levels, values, dice);
        }
        checkRefinementEvaluator(levels, values, simdLevels[dice.Roll(int(simdLevels.size()))],
                                 dice);
    }
}

} // namespace OpenSubdivHex::Regression

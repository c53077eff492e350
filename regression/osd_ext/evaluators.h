// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_OSD_EXT_EVALUATORS_H
#define OPENSUBDIVHEX_REGRESSION_OSD_EXT_EVALUATORS_H

#include "far_ext/executor.h"
#include "osd_ext/simdLevel.h"

#include <opensubdiv/osd/bufferDescriptor.h>

#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

using Descriptor = OpenSubdiv::Osd::BufferDescriptor;

/// \brief The functions of an evaluator that take pointers.
struct EvaluatorFunctions {
    template <class EVALUATOR>
    static EvaluatorFunctions Of() {
        return {&EVALUATOR::EvalStencils, &EVALUATOR::EvalStencils, &EVALUATOR::EvalStencils};
    }

    bool (*value)(float const *src, Descriptor const &srcDesc, float *dst,
                  Descriptor const &dstDesc, int const *sizes, int const *offsets,
                  int const *indices, float const *weights, int start, int end);
    bool (*first)(float const *src, Descriptor const &srcDesc, float *dst,
                  Descriptor const &dstDesc, float *du, Descriptor const &duDesc, float *dv,
                  Descriptor const &dvDesc, int const *sizes, int const *offsets,
                  int const *indices, float const *weights, float const *duWeights,
                  float const *dvWeights, int start, int end);
    bool (*second)(float const *src, Descriptor const &srcDesc, float *dst,
                   Descriptor const &dstDesc, float *du, Descriptor const &duDesc, float *dv,
                   Descriptor const &dvDesc, float *duu, Descriptor const &duuDesc, float *duv,
                   Descriptor const &duvDesc, float *dvv, Descriptor const &dvvDesc,
                   int const *sizes, int const *offsets, int const *indices, float const *weights,
                   float const *duWeights, float const *dvWeights, float const *duuWeights,
                   float const *duvWeights, float const *dvvWeights, int start, int end);
};

/// \brief An evaluator and what it runs on.
struct Evaluator {
    std::string name;
    EvaluatorFunctions functions;
    OsdExt::SimdLevel simdLevel;
    int numThreads;
};

/// The evaluators of this library: CpuEvaluator at every SIMD level that is there, ParallelEvaluator with 1 to 8
/// threads.
std::vector<Evaluator> const &GetOwnEvaluators();

/// The evaluators of OpenSubdiv.
std::vector<Evaluator> const &GetOsdEvaluators();

/// \brief Sets the SIMD level and the number of threads while it lives.
class EvaluatorScope {
public:
    EvaluatorScope(OsdExt::SimdLevel simdLevel, int numThreads);
    explicit EvaluatorScope(Evaluator const &evaluator)
        : EvaluatorScope(evaluator.simdLevel, evaluator.numThreads) {}
    ~EvaluatorScope();

    EvaluatorScope(EvaluatorScope const &) = delete;
    EvaluatorScope &operator=(EvaluatorScope const &) = delete;

private:
    OsdExt::SimdLevel _simdLevel;
    FarExt::ExecutorScope _threads;
    int _numOsdThreads;
};

/// All levels that this build and this machine have.
std::vector<OsdExt::SimdLevel> GetSimdLevels();

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#include "evaluators.h"

#include "osd_ext/cpuEvaluator.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#ifdef OPENSUBDIV_HAS_OPENMP
#include <opensubdiv/osd/ompEvaluator.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif

namespace OpenSubdivHex::Regression {

using OsdExt::SimdLevel;

namespace {

// The number of threads of Osd's evaluators.
int getNumOsdThreads() {
#ifdef _OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}

void setNumOsdThreads([[maybe_unused]] int numThreads) {
#ifdef _OPENMP
    omp_set_num_threads(numThreads);
#endif
}

} // namespace

std::vector<Evaluator> const &GetOwnEvaluators() {
    static std::vector<Evaluator> const evaluators = [] {
        char const *const levelNames[] = {"Portable", "Avx2", "Avx512"};
        std::vector<Evaluator> result;
        for (SimdLevel const level : GetSimdLevels()) {
            result.push_back({std::string("OsdExt::CpuEvaluator ") + levelNames[int(level)],
                              EvaluatorFunctions::Of<OsdExt::CpuEvaluator>(), level, 1});
        }
        for (int numThreads = 1; numThreads <= 8; ++numThreads) {
            result.push_back({"OsdExt::ParallelEvaluator " + std::to_string(numThreads),
                              EvaluatorFunctions::Of<OsdExt::ParallelEvaluator>(),
                              OsdExt::GetMaxSimdLevel(), numThreads});
        }
        return result;
    }();
    return evaluators;
}

std::vector<Evaluator> const &GetOsdEvaluators() {
    using namespace OpenSubdiv;
    static std::vector<Evaluator> const evaluators = {
        {"Osd::CpuEvaluator", EvaluatorFunctions::Of<Osd::CpuEvaluator>(), SimdLevel::Portable, 1},
#ifdef OPENSUBDIV_HAS_OPENMP
        {"Osd::OmpEvaluator", EvaluatorFunctions::Of<Osd::OmpEvaluator>(), SimdLevel::Portable, 2},
#endif
    };
    return evaluators;
}

EvaluatorScope::EvaluatorScope(SimdLevel simdLevel, int numThreads)
    : _simdLevel(OsdExt::GetSimdLevel()), _threads(nullptr, numThreads),
      _numOsdThreads(getNumOsdThreads()) {
    OsdExt::SetSimdLevel(simdLevel);
    setNumOsdThreads(numThreads);
}

EvaluatorScope::~EvaluatorScope() {
    OsdExt::SetSimdLevel(_simdLevel);
    setNumOsdThreads(_numOsdThreads);
}

std::vector<SimdLevel> GetSimdLevels() {
    std::vector<SimdLevel> levels;
    for (SimdLevel const level : {SimdLevel::Portable, SimdLevel::Avx2, SimdLevel::Avx512}) {
        if (level <= OsdExt::GetMaxSimdLevel()) {
            levels.push_back(level);
        }
    }
    return levels;
}

} // namespace OpenSubdivHex::Regression

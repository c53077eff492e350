// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_TBB_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_TBB_EVALUATOR_H

#include "far_ext/tbbExecutor.h"
#include "ompEvaluator.h"

namespace OpenSubdivHex::OsdExt {

/// \brief Evaluates stencils and patches on TBB's threads, in the arena of the calling thread: a faster
/// Osd::TbbEvaluator.  It is OmpEvaluator with a FarExt::TbbExecutor, whatever executor is set, and as
/// many threads as FarExt::SetNumThreads() or a FarExt::ExecutorScope says.
///
/// \code
///     OsdExt::TbbEvaluator::EvalStencils(srcBuffer, srcDesc, dstBuffer, dstDesc, table.get());
/// \endcode
///
/// Header only: a program that includes this header links TBB.
class TbbEvaluator : public StencilEvaluator<TbbEvaluator>, public PatchEvaluator<TbbEvaluator> {
    friend class StencilEvaluator<TbbEvaluator>;
    friend class PatchEvaluator<TbbEvaluator>;
    static bool run(float const *src, Osd::BufferDescriptor const &srcDesc,
                    internal::StencilOutput const *outputs, int numOutputs,
                    internal::StencilRows const &rows, int start, int end) {
        FarExt::TbbExecutor executor;
        FarExt::ExecutorScope const scope(&executor, FarExt::internal::GetChosenNumThreads());
        return OmpEvaluator::run(src, srcDesc, outputs, numOutputs, rows, start, end);
    }
    static void runPatches(internal::PatchTask const &task, int numPlaces) {
        FarExt::TbbExecutor executor;
        FarExt::ExecutorScope const scope(&executor, FarExt::internal::GetChosenNumThreads());
        OmpEvaluator::runPatches(task, numPlaces);
    }
};

} // namespace OpenSubdivHex::OsdExt

#endif

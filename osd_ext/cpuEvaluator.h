// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CPU_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_CPU_EVALUATOR_H

#include "patchEvaluator.h"
#include "stencilEvaluator.h"

namespace OpenSubdivHex::OsdExt {

/// \brief Evaluates stencils and patches on the calling thread, in ascending order: a faster
/// Osd::CpuEvaluator.  StencilEvaluator and PatchEvaluator have its functions, SimdLevel its
/// instructions for stencils.
///
/// \code
///     OsdExt::CpuEvaluator::EvalStencils(srcBuffer, srcDesc, dstBuffer, dstDesc, table.get());
/// \endcode
class OPENSUBDIVHEX_API CpuEvaluator : public StencilEvaluator<CpuEvaluator>,
                                       public PatchEvaluator<CpuEvaluator> {
    friend class StencilEvaluator<CpuEvaluator>;
    friend class PatchEvaluator<CpuEvaluator>;
    static bool run(float const *src, Osd::BufferDescriptor const &srcDesc,
                    StencilOutput const *outputs, int numOutputs, StencilRows const &rows,
                    int start, int end);
    static void runPatches(PatchTask const &task, int numPlaces);
};

/// \brief Evaluates stencils and patches on the threads of FarExt::GetExecutor(), at most
/// FarExt::GetNumThreads(): a faster Osd::OmpEvaluator and Osd::TbbEvaluator.
///
/// \code
///     OsdExt::ParallelEvaluator::EvalStencils(srcBuffer, srcDesc, dstBuffer, dstDesc, table.get());
/// \endcode
///
/// Results are those of CpuEvaluator, bit for bit.  Ranges of few stencils are evaluated on the
/// calling thread.
///
/// The default executor's threads are the library's own.  With a FarExt::OmpExecutor they are those of
/// OpenMP, with a FarExt::TbbExecutor those of TBB: for a call by FarExt::ExecutorScope, for all calls by
/// FarExt::SetExecutor().
class OPENSUBDIVHEX_API ParallelEvaluator : public StencilEvaluator<ParallelEvaluator>,
                                            public PatchEvaluator<ParallelEvaluator> {
    friend class StencilEvaluator<ParallelEvaluator>;
    friend class PatchEvaluator<ParallelEvaluator>;
    static bool run(float const *src, Osd::BufferDescriptor const &srcDesc,
                    StencilOutput const *outputs, int numOutputs, StencilRows const &rows,
                    int start, int end);
    static void runPatches(PatchTask const &task, int numPlaces);
};

} // namespace OpenSubdivHex::OsdExt

#endif

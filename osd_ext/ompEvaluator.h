// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_OMP_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_OMP_EVALUATOR_H

#include "patchEvaluator.h"
#include "stencilEvaluator.h"

namespace OpenSubdivHex::OsdExt {

/// \brief Evaluates stencils and patches on several threads: a faster Osd::OmpEvaluator.  StencilEvaluator and
/// PatchEvaluator have its functions, SimdLevel its instructions for stencils.
///
/// \code
///     OsdExt::OmpEvaluator::EvalStencils(srcBuffer, srcDesc, dstBuffer, dstDesc, table.get());
/// \endcode
///
/// Results are those of CpuEvaluator, bit for bit.  Short ranges are evaluated on the calling thread.
///
/// Threads are those of FarExt::GetExecutor(), as many as FarExt::SetNumThreads() or OpenMP say.  By default they are not
/// OpenMP's own threads, which are slow beside other busy threads: give the call a FarExt::OmpExecutor to use those.
class OPENSUBDIVHEX_API OmpEvaluator : public StencilEvaluator<OmpEvaluator>,
                                       public PatchEvaluator<OmpEvaluator> {
    friend class StencilEvaluator<OmpEvaluator>;
    friend class PatchEvaluator<OmpEvaluator>;
    friend class TbbEvaluator;
    static bool run(float const *src, Osd::BufferDescriptor const &srcDesc,
                    internal::StencilOutput const *outputs, int numOutputs,
                    internal::StencilRows const &rows, int start, int end);
    static void runPatches(internal::PatchTask const &task, int numPlaces);
};

} // namespace OpenSubdivHex::OsdExt

#endif

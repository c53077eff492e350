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
                    internal::StencilOutput const *outputs, int numOutputs,
                    internal::StencilRows const &rows, int start, int end);
    static void runPatches(internal::PatchTask const &task, int numPlaces);
};

} // namespace OpenSubdivHex::OsdExt

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CPU_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_CPU_EVALUATOR_H

#include "stencilEvaluator.h"

namespace OpenSubdivHex::OsdExt {

/// \brief Evaluates stencils on the calling thread, in ascending order: a faster
/// Osd::CpuEvaluator.  See StencilEvaluator for its functions, SimdLevel for the instructions that
/// it uses.
class OPENSUBDIVHEX_API CpuEvaluator : public StencilEvaluator<CpuEvaluator> {
    friend class StencilEvaluator<CpuEvaluator>;
    static bool run(float const *src, Osd::BufferDescriptor const &srcDesc,
                    internal::StencilOutput const *outputs, int numOutputs,
                    internal::StencilRows const &rows, int start, int end);
};

} // namespace OpenSubdivHex::OsdExt

#endif

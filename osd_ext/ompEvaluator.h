// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_OMP_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_OMP_EVALUATOR_H

#include "stencilEvaluator.h"

namespace OpenSubdivHex::OsdExt {

/// \brief Evaluates stencils on the threads of OpenMP, as many as FarExt::SetNumThreads() and OpenMP
/// say: a faster Osd::OmpEvaluator.  See StencilEvaluator for its functions, SimdLevel for the
/// instructions that it uses.
///
/// Results are those of CpuEvaluator, bit for bit.  Ranges of few stencils are evaluated on the
/// calling thread.
///
/// The class is there without OpenMP, too, so that no program need ask: it then does what
/// CpuEvaluator does, and IsParallel() is false.
class OPENSUBDIVHEX_API OmpEvaluator : public StencilEvaluator<OmpEvaluator> {
public:
    /// Whether this library was built with OpenMP.
    static bool IsParallel();

private:
    friend class StencilEvaluator<OmpEvaluator>;
    static bool run(float const *src, Osd::BufferDescriptor const &srcDesc,
                    internal::StencilOutput const *outputs, int numOutputs,
                    internal::StencilRows const &rows, int start, int end);
};

} // namespace OpenSubdivHex::OsdExt

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_OMP_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_OMP_EVALUATOR_H

#include "patchEvaluator.h"
#include "stencilEvaluator.h"

namespace OpenSubdivHex::OsdExt {

/// \brief Evaluates stencils on as many threads as FarExt::SetNumThreads() or OpenMP say: a faster
/// Osd::OmpEvaluator.  See StencilEvaluator for its functions, SimdLevel for the instructions that
/// it uses.
///
/// Results are those of CpuEvaluator, bit for bit.  Ranges of few stencils are evaluated on the
/// calling thread.
///
/// The threads are those of FarExt::GetExecutor(), by default not OpenMP's own, which wait for each
/// other at the end of every loop and keep their processors meanwhile: beside other threads that are
/// busy they can be slower than one.  Give the call a FarExt::OmpExecutor to have them.
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

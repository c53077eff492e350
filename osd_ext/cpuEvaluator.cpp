// SPDX-License-Identifier: Apache-2.0
#include "cpuEvaluator.h"

#include "osd_ext/stencil/stencilKernel.h"

namespace OpenSubdivHex::OsdExt {

bool CpuEvaluator::run(float const *src, Osd::BufferDescriptor const &srcDesc,
                       StencilOutput const *outputs, int numOutputs, StencilRows const &rows,
                       int start, int end) {
    internal::StencilTask task;
    if (!internal::MakeStencilTask(src, srcDesc, outputs, numOutputs, rows, start, end, &task)) {
        return false;
    }
    if (start < end) {
        internal::GetStencilKernel()(task, start, end, internal::FindFirstWeight(rows, start));
    }
    return true;
}

void CpuEvaluator::runPatches(PatchTask const &task, int numPlaces) {
    evaluatePatches(task, 0, numPlaces);
}

} // namespace OpenSubdivHex::OsdExt

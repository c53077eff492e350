// SPDX-License-Identifier: Apache-2.0
#include "cpuEvaluator.h"

namespace OpenSubdivHex::OsdExt {

void CpuEvaluator::run(internal::StencilTask const &task, int begin, int end) {
    internal::GetStencilKernel()(task, begin, end, internal::FindFirstWeight(task.rows, begin));
}

} // namespace OpenSubdivHex::OsdExt

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_CUDA_STENCILS_BY_THREAD_H
#define OPENSUBDIVHEX_REGRESSION_CUDA_STENCILS_BY_THREAD_H

#include "osd_ext/cudaEvaluator.h"

namespace OpenSubdivHex::Regression {

/// \brief Evaluates all stencils of a table by one thread each, with its sums in the memory of the
/// destination, as Osd::CudaEvaluator does: what CudaEvaluator is compared with.
///
/// \param src,dst  packed elements of \p length floats, on the device
/// \return  whether the default stream took the work
bool EvalStencilsByThread(float const *src, float *dst, int length,
                          OsdExt::CudaStencilTable const &table);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_THREAD_POOL_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_THREAD_POOL_H

#include "far_ext/executor.h"

namespace OpenSubdivHex::FarExt::internal {

/// The default executor: see GetDefaultExecutor().
Executor &GetThreadPool();

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CUDA_STREAM_H
#define OPENSUBDIVHEX_OSD_EXT_CUDA_STREAM_H

// The name of the type in CUDA's runtime.
struct CUstream_st;

namespace OpenSubdivHex::OsdExt {

/// cudaStream_t, for headers that need no CUDA; null is the default stream.
using CudaStream = CUstream_st *;

} // namespace OpenSubdivHex::OsdExt

#endif

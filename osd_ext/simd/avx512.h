// SPDX-License-Identifier: Apache-2.0
//
// The intrinsics of AVX-512, for sources that are compiled for it.
#ifndef OPENSUBDIVHEX_OSD_EXT_SIMD_AVX512_H
#define OPENSUBDIVHEX_OSD_EXT_SIMD_AVX512_H

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 sees uninitialized values in its own intrinsics, also where they are inlined behind this header.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>

#endif

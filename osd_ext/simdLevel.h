// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_SIMD_LEVEL_H
#define OPENSUBDIVHEX_OSD_EXT_SIMD_LEVEL_H

namespace OpenSubdivHex::OsdExt {

/// \brief The instructions that the evaluators of this library use, each level above the one
/// before it.
///
/// Avx2 and Avx512 are there when the library was built by GCC or Clang for x86-64.
///
/// Results are the same, bit for bit, for any number of threads, ranges and buffers, at one level.
/// Levels differ in the last bits: above Portable, products are fused with sums (FMA), and the
/// terms of a stencil are summed in another order.
enum class SimdLevel {
    Portable, ///< what the compiler makes of plain C++, on any machine
    Avx2,     ///< AVX2 and FMA
    Avx512    ///< AVX-512 F and VL
};

/// The highest level that both this build and this machine have.
SimdLevel GetMaxSimdLevel();

/// The level in use: GetMaxSimdLevel() until SetSimdLevel() was called.
SimdLevel GetSimdLevel();

/// \brief Sets the level for all evaluations of the process that start from now on.  Meant for
/// tests and comparisons.  Safe to call from any thread.
///
/// \return  false if \p level is above GetMaxSimdLevel(); the level in use then stays
bool SetSimdLevel(SimdLevel level);

} // namespace OpenSubdivHex::OsdExt

#endif

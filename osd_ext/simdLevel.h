// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_SIMD_LEVEL_H
#define OPENSUBDIVHEX_OSD_EXT_SIMD_LEVEL_H

#include "far_ext/export.h"

#include <string>

namespace OpenSubdivHex::OsdExt {

/// \brief The instructions that CpuEvaluator and ParallelEvaluator use, in ascending order.
///
/// \code
///     OsdExt::SetSimdLevel(OsdExt::SimdLevel::Portable); // to compare
/// \endcode
///
/// Avx2 and Avx512 exist in builds by GCC or Clang for x86-64.
///
/// Results are the same, bit for bit, for any number of threads, ranges and buffers, at one level.
/// Levels differ in the last bits: above Portable, products are fused with sums (FMA), and the
/// terms of a stencil are summed in another order.
///
/// RefinementEvaluator has the same results at every level, but for its limits: where masks are those of
/// irregular vertices and quads its code is compiled for each level, without fused products, and elsewhere
/// once, for the processors that the whole library is compiled for.
enum class SimdLevel {
    Portable, ///< what the compiler makes of plain C++, on any machine
    Avx2,     ///< AVX2 and FMA
    Avx512    ///< AVX-512 F and VL
};

/// The highest level that both this build and this machine have.
OPENSUBDIVHEX_API SimdLevel GetMaxSimdLevel() noexcept;

/// \brief The level in use.
///
/// Until SetSimdLevel() is called, the environment variable OPENSUBDIVHEX_SIMD names the level when it is first needed, else
/// the level is GetMaxSimdLevel().  An unknown name, or one above GetMaxSimdLevel(), is ignored: compare the variable with
/// the name of this level to notice.
OPENSUBDIVHEX_API SimdLevel GetSimdLevel() noexcept;

/// \brief Sets the level for all evaluations of the process that start from now on.  Meant for
/// tests and comparisons.  Safe to call from any thread.
///
/// \return  false if \p level is above GetMaxSimdLevel() or no level at all; the level in use then
///          stays
OPENSUBDIVHEX_API bool SetSimdLevel(SimdLevel level) noexcept;

/// @name Names of levels
/// "portable", "avx2" and "avx512": spelled so in OPENSUBDIVHEX_SIMD, and by hexrefine.
/// @{

/// The name of a level.
OPENSUBDIVHEX_API char const *GetSimdLevelName(SimdLevel level);
/// \return  false, with \p level as it was, if no level has this name
OPENSUBDIVHEX_API bool FindSimdLevel(std::string const &name, SimdLevel *level);
/// @}

} // namespace OpenSubdivHex::OsdExt

#endif

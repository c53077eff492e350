// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_PI_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_PI_H

namespace OpenSubdivHex::FarExt::internal {

inline constexpr long double kLongPi = 3.141592653589793238462643383279502884L;
inline constexpr double kPi = kLongPi;

} // namespace OpenSubdivHex::FarExt::internal

#endif

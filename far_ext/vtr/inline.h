// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_INLINE_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_INLINE_H

/// For functions whose values must stay in registers, whatever the compiler would choose.
#if defined(__GNUC__)
#define OPENSUBDIVHEX_INLINE inline __attribute__((always_inline))
#else
#define OPENSUBDIVHEX_INLINE inline
#endif

#endif

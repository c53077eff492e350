// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_EXPORT_H
#define OPENSUBDIVHEX_FAR_EXT_EXPORT_H

/// \ingroup far_ext
/// \brief Marks what the shared libraries export; all else stays inside them.
///
/// It does nothing in a static library, so that a shared one which takes that in exports nothing of
/// it, and nothing in a program: to call what is exported needs no mark.
#if defined(OPENSUBDIVHEX_IS_SHARED) && defined(__GNUC__) && !defined(_WIN32)
#define OPENSUBDIVHEX_API __attribute__((visibility("default")))
#else
#define OPENSUBDIVHEX_API
#endif

#endif

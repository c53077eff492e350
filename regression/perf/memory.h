// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_MEMORY_H
#define OPENSUBDIVHEX_REGRESSION_PERF_MEMORY_H

#include <functional>

namespace OpenSubdivHex::Regression {

/// \brief From now on all memory comes from the heap, which never shrinks: what is freed stays
/// mapped and is used again, its pages touched already.  Cannot be undone.
///
/// \return  false where the C library has no such setting (it is the GNU one's)
bool KeepFreedMemory();

/// The bytes that are allocated now; 0 where the C library does not tell.
double GetAllocatedBytes();

/// \brief The most memory, in bytes of touched pages, that \p work has at a time beyond what the
/// process had before.  NaN where the system does not tell (it is Linux that does).
double MeasurePeakBytes(std::function<void()> const &work);

} // namespace OpenSubdivHex::Regression

#endif

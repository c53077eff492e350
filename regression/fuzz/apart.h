// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FUZZ_APART_H
#define OPENSUBDIVHEX_REGRESSION_FUZZ_APART_H

#include <functional>

namespace OpenSubdivHex::Regression {

/// \brief Calls \p run in a process of its own, which prints nothing, so that a crash and an
/// endless loop are failures like others.  The calling process must not have started threads.
///
/// \return  whether it threw, crashed, or took longer than \p numSeconds
bool FailsApart(std::function<void()> const &run, unsigned numSeconds);

} // namespace OpenSubdivHex::Regression

/// \brief Prints the smallest input it finds that fails as \p data does.  A fuzz target may define it beside
/// LLVMFuzzerTestOneInput; the driver calls it.
extern "C" void FuzzReport(unsigned char const *data, unsigned long size);

#endif

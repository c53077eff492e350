// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_MEASURED_H
#define OPENSUBDIVHEX_REGRESSION_PERF_MEASURED_H

#include "report.h"

#include <string>

namespace OpenSubdivHex::Regression {

/// \brief The results of contests that pythonBenchmark.py timed and wrote to the file \p path.
///
/// Adds to \p environment what it says of its own.  Throws std::runtime_error, which names the file,
/// if that cannot be read or is not of this form.
Results ReadMeasured(std::string const &path, Environment &environment);

} // namespace OpenSubdivHex::Regression

#endif

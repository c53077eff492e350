// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_REPORT_H
#define OPENSUBDIVHEX_REGRESSION_PERF_REPORT_H

#include "results.h"

#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression {

/// Names and values, e.g. of the processor and of the versions of the peers.
using Environment = std::vector<std::pair<std::string, std::string>>;

/// The machine, how busy it is, the build and the peers.
Environment DescribeEnvironment();

/// All results as Markdown: the rows with their verdicts, the costs, and how costs grow where that
/// was measured.
std::string FormatMarkdown(Results const &results, Environment const &environment);

/// Formats results as JSON.
std::string FormatJson(Results const &results, Environment const &environment);

} // namespace OpenSubdivHex::Regression

#endif

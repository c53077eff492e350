// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_ROWS_H
#define OPENSUBDIVHEX_REGRESSION_PERF_ROWS_H

#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A promise: by what factor this library is to be faster than a peer in the same run.
struct Row {
    std::string name; ///< unique, without spaces
    std::string work;
    std::string peer;
    double atLeast;
    double aim;
    bool isUpperBound = false; ///< figures must not exceed the bounds, instead of reaching them
};

/// The rows of the program perf itself, in the order in which they are printed.
std::vector<Row> const &GetRows();

/// Stands in the work of rows of frames for their mesh, which the suite puts in its place.
constexpr char kFrameMesh[] = "{mesh}";

/// The rows of perf --device.
std::vector<Row> const &GetDeviceRows();

/// The rows of pythonBenchmark.py.
std::vector<Row> const &GetPythonRows();

/// The row of that name, of all of these; throws std::out_of_range if there is none.
Row const &GetRow(std::string const &name);

/// \brief Which of the bounds \p figure meets: "aim", "at least" or "below".  A figure that is NaN
/// is below, and where the bounds are upper ones, "at least" is to be read as "at most".
std::string GetVerdict(Row const &row, double figure);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_LARGEST_VALUE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_LARGEST_VALUE_H

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace OpenSubdivHex::Regression {

/// \brief The largest absolute value, infinity where one is not finite.
///
/// Eigen's maxCoeff() passes over NaN in all places but the first.
template <typename DERIVED>
double GetLargestValue(Eigen::DenseBase<DERIVED> const &values) {
    return values.allFinite() ? values.derived().cwiseAbs().maxCoeff()
                              : std::numeric_limits<double>::infinity();
}

/// The larger one, NaN where one is: std::max() passes over that.
inline double GetLarger(double a, double b) { return std::isnan(a) || a > b ? a : b; }

} // namespace OpenSubdivHex::Regression

#endif

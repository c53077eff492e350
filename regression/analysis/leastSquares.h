// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_LEAST_SQUARES_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_LEAST_SQUARES_H

#include <Eigen/Core>

#include <functional>

namespace OpenSubdivHex::Regression {

/// \brief Weights for which the norm of what \p measure returns is smaller than for \p weights, or the same: by
/// Levenberg's and Marquardt's method, with differences for derivatives and weights kept from falling below 0.
///
/// The result is a local optimum, and the same on each run.
///
/// \param maxSteps   it ends before where a step gains less than a ten thousandth
/// \param measure    as many numbers for all weights
/// \param firstFree  weights before it stay as they are
Eigen::VectorXd
FindLeastSquares(Eigen::VectorXd weights, int maxSteps,
                 std::function<Eigen::VectorXd(Eigen::VectorXd const &)> const &measure,
                 int firstFree = 0);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#include "leastSquares.h"

#include <Eigen/Dense>

#include <algorithm>

namespace OpenSubdivHex::Regression {

Eigen::VectorXd
FindLeastSquares(Eigen::VectorXd weights, int maxSteps,
                 std::function<Eigen::VectorXd(Eigen::VectorXd const &)> const &measure,
                 int firstFree) {
    constexpr double kDifference = 1e-5;
    constexpr double kLargestChange = 0.1;
    constexpr double kLeastGain = 1e-4;
    constexpr double kFactor = 5; // of the damping, from one attempt to the next
    constexpr int kMaxAttempts = 9;
    double damping = 1e-3;
    Eigen::VectorXd values = measure(weights);
    for (int step = 0; step < maxSteps; ++step) {
        Eigen::MatrixXd derivatives = Eigen::MatrixXd::Zero(values.size(), weights.size());
        for (Eigen::Index i = firstFree; i < weights.size(); ++i) {
            Eigen::VectorXd changed = weights;
            changed[i] += kDifference;
            derivatives.col(i) = (measure(changed) - values) / kDifference;
        }
        Eigen::MatrixXd const squares = derivatives.transpose() * derivatives;
        Eigen::VectorXd const slope = derivatives.transpose() * values;
        double const before = values.norm();
        bool isBetter = false;
        for (int attempt = 0; attempt < kMaxAttempts && !isBetter; ++attempt, damping *= kFactor) {
            Eigen::MatrixXd damped = squares;
            damped.diagonal().array() += damping;
            Eigen::VectorXd right = -slope;
            for (Eigen::Index i = 0; i < weights.size(); ++i) {
                if (i < firstFree || (weights[i] <= 0 && slope[i] > 0)) { // stays, or stays at 0
                    damped.row(i).setZero();
                    damped.col(i).setZero();
                    damped(i, i) = 1;
                    right[i] = 0;
                }
            }
            Eigen::VectorXd change = damped.ldlt().solve(right);
            change *= std::min(1.0, kLargestChange / change.cwiseAbs().maxCoeff());
            Eigen::VectorXd const next = (weights + change).cwiseMax(0);
            Eigen::VectorXd const nextValues = measure(next);
            if (nextValues.norm() < before) {
                weights = next;
                values = nextValues;
                damping /= kFactor * kFactor;
                isBetter = true;
            }
        }
        if (before - values.norm() < kLeastGain * before) {
            break;
        }
    }
    return weights;
}

} // namespace OpenSubdivHex::Regression

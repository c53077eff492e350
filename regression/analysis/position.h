// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_POSITION_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_POSITION_H

#include <Eigen/Core>

namespace OpenSubdivHex::Regression {

/// A position with the interface that primvar refiners ask for.
template <typename REAL>
struct PositionReal {
    void Clear() { value.setZero(); }
    void AddWithWeight(PositionReal const &other, REAL weight) { value += weight * other.value; }
    Eigen::Matrix<REAL, 3, 1> value;
};

} // namespace OpenSubdivHex::Regression

#endif

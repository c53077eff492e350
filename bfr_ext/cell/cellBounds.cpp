// SPDX-License-Identifier: Apache-2.0
#include "cellBounds.h"

#include "pointRows.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

CellBounds const &CellBounds::Find(CellType const &type) {
    return type.GetPatterns().Get<CellBounds>(PatternTable::GetKind<double>(PatternOf::CellBounds),
                                              nullptr, nullptr, [&] { return CellBounds(type); });
}

CellBounds::CellBounds(CellType const &type) {
    constexpr int kSteps = 2;
    _weights.assign(std::size_t(type.GetNumPoints()), 0.0);
    // The last step is looked at for all children together, which share points.
    ForDescendants(type, PointRows(type), kSteps - 1,
                   [&](CellType const &child, PointRows const &points) {
                       PointRows const rows(child, points);
                       for (std::size_t i = 0; i < rows.GetNumRows(); ++i) {
                           double const *const row = rows.GetRow(i);
                           for (std::size_t k = 0; k < _weights.size(); ++k) {
                               _weights[k] = std::max(_weights[k], row[k]);
                           }
                       }
                   });
}

// A sum of numbers is the limit and the sum of what they exceed it by; so it is largest where those that
// exceed it most weigh as much as they may.
double CellBounds::getExcess(std::vector<double> const &numbers, double limit, double sign) const {
    double excess = 0;
    double sumOfWeights = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        double const beyond = sign * (numbers[i] - limit);
        excess += beyond > 0 ? beyond * _weights[i] : 0;
        sumOfWeights += beyond > 0 ? _weights[i] : 0;
    }
    if (sumOfWeights <= 1) {
        return excess;
    }
    struct Point {
        double beyond;
        double weight;
    };
    std::vector<Point> points;
    points.reserve(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        double const beyond = sign * (numbers[i] - limit);
        if (beyond > 0) {
            points.push_back({beyond, _weights[i]});
        }
    }
    std::sort(points.begin(), points.end(),
              [](Point const &a, Point const &b) { return a.beyond > b.beyond; });
    excess = 0;
    double rest = 1;
    for (Point const &point : points) {
        double const weight = std::min(rest, point.weight);
        excess += weight * point.beyond;
        rest -= weight;
    }
    return excess;
}

} // namespace OpenSubdivHex::BfrExt::internal

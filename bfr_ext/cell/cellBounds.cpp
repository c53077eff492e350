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
    constexpr int kMaxPoints = 128;
    _weights.assign(std::size_t(type.GetNumPoints()), 0.0);
    if (type.GetNumPoints() > kMaxPoints) {
        boundByStep(type.GetStep());
        return;
    }
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

// By the points one step on, whose rows have few entries: dense rows beside a face of some hundred vertices
// would take minutes.
void CellBounds::boundByStep(StepMatrix const &step) {
    std::vector<double> row(_weights.size());
    for (std::size_t i = 0; i < step.GetNumRows(); ++i) {
        step.ForEachEntry(i, [&](std::size_t point, double weight) { row[point] += weight; });
        step.ForEachEntry(i, [&](std::size_t point, double) {
            _weights[point] = std::max(_weights[point], row[point]);
        });
        step.ForEachEntry(i, [&](std::size_t point, double) { row[point] = 0; });
    }
}

// A sum of numbers is the limit and the sum of what they exceed it by.  It is largest where those that
// exceed it most weigh as much as they may, all others nothing: with t what the least of them exceeds
// it by, it is t and the sum of what those exceed t by.  For any other t, that is larger: so it is a bound, and
// some steps of bisection make it a close one.
double CellBounds::getExcess(std::vector<double> const &numbers, double limit, double sign) const {
    constexpr int kBisections = 5;
    double largest = 0;
    for (double const number : numbers) {
        largest = std::max(largest, sign * (number - limit));
    }
    double result = largest;
    double least = 0;
    double t = 0;
    for (int i = 0; i <= kBisections && largest > 0; ++i) {
        double sum = 0;
        double weight = 0;
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            double const beyond = sign * (numbers[k] - limit) - t;
            sum += _weights[k] * std::max(beyond, 0.0);
            weight += beyond > 0 ? _weights[k] : 0;
        }
        result = std::min(result, t + sum);
        if (weight > 1) {
            least = t;
        } else {
            largest = t; // none is left where t is the limit itself
        }
        t = (least + largest) / 2;
    }
    return result;
}

} // namespace OpenSubdivHex::BfrExt::internal

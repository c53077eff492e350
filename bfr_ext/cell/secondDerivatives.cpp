// SPDX-License-Identifier: Apache-2.0
#include "secondDerivatives.h"

#include "halfCell.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

using Row = std::vector<double>;
using Rows = SecondDerivatives::Rows;

constexpr std::size_t kNumCorners = std::size(HalfCell::kCorners);

// Each makes what is left half as large.
constexpr int kNumRounds = 60;
// A bound of errors in weights, which are at most some hundred; rows that do not converge exceed it.
constexpr double kRowTolerance = 1e-9;

double dotRows(Row const &a, Row const &b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::vector<Pair> applyStep(CellType const &type, std::size_t child,
                            std::vector<Pair> const &places) {
    std::vector<Pair> result(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        type.GetChildren()[child].step.ForEachEntry(i, [&](std::size_t point, double weight) {
            result[i][0] += weight * places[point][0];
            result[i][1] += weight * places[point][1];
        });
    }
    return result;
}

// Moves places so that the surface has its corners where HalfCell has them.
void fitToCorners(CellType const &type, std::vector<Pair> &places) {
    auto const find = [&](std::size_t corner) {
        Row const &weights = type.GetCornerPoints()[corner];
        Pair sum = {0, 0};
        for (std::size_t i = 0; i < places.size(); ++i) {
            sum = {sum[0] + weights[i] * places[i][0], sum[1] + weights[i] * places[i][1]};
        }
        return sum;
    };
    auto const subtract = [](Pair const &p, Pair const &q) -> Pair {
        return {p[0] - q[0], p[1] - q[1]};
    };
    Pair const origin = find(0);
    Pair const a = subtract(find(1), origin);
    Pair const b = subtract(find(3), origin);
    double const area = a[0] * b[1] - a[1] * b[0];
    for (Pair &place : places) {
        Pair const p = subtract(place, origin);
        double const s = (p[0] * b[1] - p[1] * b[0]) / area;
        double const t = (a[0] * p[1] - a[1] * p[0]) / area;
        place = {s * HalfCell::kCorners[1][0] + t * HalfCell::kCorners[3][0],
                 s * HalfCell::kCorners[1][1] + t * HalfCell::kCorners[3][1]};
    }
}

// Where the points of a half cell lie in a regular lattice, by the coordinates of HalfCell: the surface and steps keep
// linear functions of these places.  Step after step all else shrinks by 2 against them, from any start.  Empty where
// a step does not keep places.
std::vector<Pair> findLatticePlaces(CellType const &type) {
    constexpr double kTolerance = 1e-9;
    if (type.GetKind() != FarExt::internal::CellKind::Half || !type.IsRegular()) {
        return {};
    }
    auto const &[along, across] = type.GetDerivatives(0).rows;
    std::vector<Pair> places;
    for (std::size_t i = 0; i < along.size(); ++i) {
        places.push_back({along[i], across[i]});
    }
    for (int round = 0; round < kNumRounds; ++round) {
        places = applyStep(type, 0, places);
        fitToCorners(type, places);
    }
    for (std::size_t child = 0; child < std::size(HalfCell::kChildren); ++child) {
        std::vector<Pair> const behindStep = applyStep(type, child, places);
        for (std::size_t i = 0; i < places.size(); ++i) {
            auto const [x, h] = HalfCell::kChildren[child].Apply(behindStep[i]);
            if (!(std::hypot(x - places[i][0], h - places[i][1]) < kTolerance)) {
                return {};
            }
        }
    }
    return places;
}

// A quadratic function of the coordinates of HalfCell.
struct Quadratic {
    void Scale(double factor) {
        for (double &value : atPoints) {
            value *= factor;
        }
        for (double &value : secondDerivatives) {
            value *= factor;
        }
    }
    // Adds so many times the other one.
    void Add(double factor, Quadratic const &other) {
        for (std::size_t i = 0; i < atPoints.size(); ++i) {
            atPoints[i] += factor * other.atPoints[i];
        }
        for (std::size_t k = 0; k < secondDerivatives.size(); ++k) {
            secondDerivatives[k] += factor * other.secondDerivatives[k];
        }
    }

    Row atPoints;
    std::array<double, SecondDerivatives::kNumRows> secondDerivatives;
};

// Functions that span all quadratic ones, orthogonal and of length 1 as vectors of what they are at the points.
std::vector<Quadratic> findQuadratics(std::vector<Pair> const &places) {
    std::vector<Quadratic> quadratics = {{{}, {0, 0, 0}}, {{}, {0, 0, 0}}, {{}, {0, 0, 0}},
                                         {{}, {2, 0, 0}}, {{}, {0, 1, 0}}, {{}, {0, 0, 2}}};
    for (auto const &[x, h] : places) {
        double const terms[] = {1, x, h, x * x, x * h, h * h};
        for (std::size_t i = 0; i < quadratics.size(); ++i) {
            quadratics[i].atPoints.push_back(terms[i]);
        }
    }
    for (std::size_t i = 0; i < quadratics.size(); ++i) {
        Quadratic &quadratic = quadratics[i];
        for (std::size_t k = 0; k < i; ++k) {
            quadratic.Add(-dotRows(quadratic.atPoints, quadratics[k].atPoints), quadratics[k]);
        }
        quadratic.Scale(1 / std::sqrt(dotRows(quadratic.atPoints, quadratic.atPoints)));
    }
    return quadratics;
}

// The nearest rows that give the second derivatives of quadratic functions.
void fitToQuadratics(std::vector<Quadratic> const &quadratics, Rows &rows) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
        for (Quadratic const &quadratic : quadratics) {
            double const factor =
                quadratic.secondDerivatives[k] - dotRows(rows[k], quadratic.atPoints);
            for (std::size_t i = 0; i < rows[k].size(); ++i) {
                rows[k][i] += factor * quadratic.atPoints[i];
            }
        }
    }
}

double findLargestChange(Rows const &before, Rows const &rows) {
    double largest = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        for (std::size_t i = 0; i < rows[k].size(); ++i) {
            largest = std::max(largest, std::abs(rows[k][i] - before[k][i]));
        }
    }
    return largest;
}

} // namespace

SecondDerivatives const &SecondDerivatives::Find(CellType const &type) {
    return type.GetPatterns().Get<SecondDerivatives>(
        PatternTable::GetKind<double>(PatternOf::SecondDerivatives), nullptr, nullptr,
        [&] { return SecondDerivatives(type); });
}

SecondDerivatives::SecondDerivatives(CellType const &type) {
    std::vector<Pair> const places =
        type.HasContinuousCurvature() ? findLatticePlaces(type) : std::vector<Pair>();
    if (places.empty()) {
        return;
    }
    std::vector<Quadratic> const quadratics = findQuadratics(places);
    Rows start;
    start.fill(Row(places.size()));
    fitToQuadratics(quadratics, start);
    _rows.assign(kNumCorners, start);
    double largestChange = 0;
    for (int round = 0; round < kNumRounds; ++round) {
        std::vector<Rows> const before = _rows;
        largestChange = 0;
        for (std::size_t corner = 0; corner < kNumCorners; ++corner) {
            auto const child = std::size_t(HalfCell::kCornerChildren[corner]);
            Rows const &ofChild = before[std::size_t(HalfCell::kCornersOfChildren[corner])];
            for (std::size_t k = 0; k < kNumRows; ++k) {
                type.GetChildren()[child].step.ApplyLeft(ofChild[k], _rows[corner][k]);
            }
            Turn(HalfCell::kChildren[child].rows, _rows[corner]);
            fitToQuadratics(quadratics, _rows[corner]);
            largestChange =
                std::max(largestChange, findLargestChange(before[corner], _rows[corner]));
        }
    }
    if (!(largestChange < kRowTolerance)) {
        _rows.clear();
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

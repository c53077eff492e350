// SPDX-License-Identifier: Apache-2.0
#include "latticeBounds.h"

#include "latticePlaces.h"
#include "pointRows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

constexpr int kStepsOfParts = 2;
constexpr int kStepsOfRests = 4; // from a part

constexpr std::size_t kNumCorners = 4;

// Heights at the corners of a half cell are those of a linear function if the first edge is twice the
// one across.  Else they miss it by defect d, and those of the closest linear function are less by the
// multiples of d that these are.
constexpr std::array<double, kNumCorners> kDefect = {-1, 1, -2, 2};
constexpr double kSquareOfDefect = 10;

Pair findPlace(double const *row, std::vector<Pair> const &places) {
    Pair place = {0, 0};
    for (std::size_t i = 0; i < places.size(); ++i) {
        place = {place[0] + row[i] * places[i][0], place[1] + row[i] * places[i][1]};
    }
    return place;
}

// A function of places for each point of a cell.
class LinearFunctions {
public:
    // Those that are closest to what the corners of a part have in their rows.
    LinearFunctions(std::array<std::vector<double>, kNumCorners> corners,
                    std::vector<Pair> const &places)
        : _origin(findPlace(corners[0].data(), places)), _constants(corners[0].size()),
          _slopes(corners[0].size()) {
        Pair const a = subtract(findPlace(corners[1].data(), places), _origin);
        Pair const b = subtract(findPlace(corners[3].data(), places), _origin);
        double const determinant = a[0] * b[1] - a[1] * b[0];
        for (std::size_t i = 0; i < _constants.size(); ++i) {
            double defect = 0;
            for (std::size_t k = 0; k < kNumCorners; ++k) {
                defect += kDefect[k] * corners[k][i];
            }
            std::array<double, kNumCorners> values;
            for (std::size_t k = 0; k < kNumCorners; ++k) {
                values[k] = corners[k][i] - kDefect[k] * defect / kSquareOfDefect;
            }
            double const alongA = values[1] - values[0];
            double const alongB = values[3] - values[0];
            _constants[i] = values[0];
            _slopes[i] = {(alongA * b[1] - alongB * a[1]) / determinant,
                          (alongB * a[0] - alongA * b[0]) / determinant};
        }
    }

    // Raises c to what a row is away from the functions.
    void AddRests(double const *row, std::vector<Pair> const &places,
                  std::vector<double> &c) const {
        Pair const d = subtract(findPlace(row, places), _origin);
        for (std::size_t i = 0; i < c.size(); ++i) {
            double const value = _constants[i] + _slopes[i][0] * d[0] + _slopes[i][1] * d[1];
            c[i] = std::max(c[i], std::abs(row[i] - value));
        }
    }

private:
    static Pair subtract(Pair const &p, Pair const &q) { return {p[0] - q[0], p[1] - q[1]}; }

    Pair _origin;
    std::vector<double> _constants;
    std::vector<Pair> _slopes;
};

// The number of the sample at a place, which is added if it is new.
std::size_t findSample(Pair const &place, std::vector<double> const &row, std::vector<Pair> &places,
                       std::vector<std::vector<double>> &rows) {
    constexpr double kTolerance = 1e-6;
    auto const found = std::find_if(places.begin(), places.end(), [&](Pair const &other) {
        return std::hypot(place[0] - other[0], place[1] - other[1]) < kTolerance;
    });
    auto const number = std::size_t(found - places.begin());
    if (found == places.end()) {
        places.push_back(place);
        rows.push_back(row);
    }
    return number;
}

} // namespace

LatticeBounds const &LatticeBounds::Find(CellType const &type) {
    return type.GetPatterns().Get<LatticeBounds>(
        PatternTable::GetKind<double>(PatternOf::LatticeBounds), nullptr, nullptr,
        [&] { return LatticeBounds(type); });
}

LatticeBounds::LatticeBounds(CellType const &type) {
    std::vector<Pair> const places = FindLatticePlaces(type);
    if (places.empty()) {
        return;
    }
    std::vector<Pair> samplePlaces;
    std::vector<std::vector<double>> samples;
    std::vector<std::vector<double>> rests;
    ForDescendants(type, PointRows(type), kStepsOfParts,
                   [&](CellType const &, PointRows const &part) {
                       std::array<std::vector<double>, kNumCorners> corners;
                       Part numbers;
                       for (std::size_t k = 0; k < kNumCorners; ++k) {
                           corners[k] = part.Sum(type.GetCornerPoints()[k]);
                           numbers[k] = findSample(findPlace(corners[k].data(), places), corners[k],
                                                   samplePlaces, samples);
                       }
                       _parts.push_back(numbers);
                       LinearFunctions const functions(corners, places);
                       std::vector<double> c(places.size());
                       // The last step is looked at for all children together, which share points.
                       ForDescendants(type, part, kStepsOfRests - 1,
                                      [&](CellType const &, PointRows const &parent) {
                                          PointRows const rows(type, parent);
                                          for (std::size_t i = 0; i < rows.GetNumRows(); ++i) {
                                              functions.AddRests(rows.GetRow(i), places, c);
                                          }
                                      });
                       rests.push_back(std::move(c));
                   });
    auto const fill = [&](std::vector<std::vector<double>> const &rows) {
        PlaceMatrix<double> matrix(rows.size(), places.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            matrix.Set(i, rows[i]);
        }
        return matrix;
    };
    _samples = fill(samples);
    _rests = fill(rests);
}

LatticeBounds::Ranges LatticeBounds::GetRanges(std::vector<double> const &heights,
                                               std::vector<double> &scratch) const {
    std::size_t const numPoints = heights.size();
    scratch.resize(numPoints + _samples.GetNumPlaces() + _parts.size());
    double *const sizes = scratch.data();
    double *const samples = sizes + numPoints;
    double *const rests = samples + _samples.GetNumPlaces();
    std::transform(heights.begin(), heights.end(), sizes, [](double h) { return std::abs(h); });
    SumUpPlaces(_samples, {heights.data(), 1, 1, nullptr, samples, 1});
    SumUpPlaces(_rests, {sizes, 1, 1, nullptr, rests, 1});
    auto const [least, largest] = std::minmax_element(samples, rests);
    Ranges result = {{*least, *largest}, {*least, *largest}};
    for (std::size_t part = 0; part < _parts.size(); ++part) {
        std::array<double, kNumCorners> corners;
        double defect = 0;
        for (std::size_t k = 0; k < kNumCorners; ++k) {
            corners[k] = samples[_parts[part][k]];
            defect += kDefect[k] * corners[k];
        }
        for (std::size_t k = 0; k < kNumCorners; ++k) {
            double const height = corners[k] - kDefect[k] * defect / kSquareOfDefect;
            result.bound.min = std::min(result.bound.min, height - rests[part]);
            result.bound.max = std::max(result.bound.max, height + rests[part]);
        }
    }
    return result;
}

} // namespace OpenSubdivHex::BfrExt::internal

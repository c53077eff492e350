// SPDX-License-Identifier: Apache-2.0
#include "slopeBounds.h"

#include "latticePlaces.h"
#include "pointRows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

constexpr int kSteps = 5;  // k
constexpr int kRounds = 4; // of closer bounds

using Row = std::vector<double>;

double sumAbsolute(Row const &row) {
    return std::accumulate(row.begin(), row.end(), 0.0,
                           [](double sum, double a) { return sum + std::abs(a); });
}

bool isBounded(CellType const &type) {
    return type.HasBoundedCurvature() && !FindLatticePlaces(type).empty();
}

// How many steps on all cells are bounded, or a larger number than a limit.
int countSteps(CellType const &type, int limit) {
    if (isBounded(type)) {
        return 0;
    }
    if (limit == 0) {
        return 1;
    }
    int result = 0;
    for (CellType::Child const &child : type.GetChildren()) {
        result = std::max(result, 1 + countSteps(*child.type, limit - 1));
        if (result > limit) {
            break;
        }
    }
    return result;
}

void takeLargest(Row const &row, Row &largest) {
    std::transform(row.begin(), row.end(), largest.begin(), largest.begin(),
                   [](double a, double b) { return std::max(std::abs(a), b); });
}

} // namespace

struct SlopeBounds::Descendant {
    std::vector<Row> rests; // by point: what it is away from the cell's own linear function
    Row changes;            // how long the change of the slopes is, of a point by 1
    double sumOfChanges;    // the same where all points are moved by 1 at most
};

SlopeBounds const &SlopeBounds::Find(CellType const &type) {
    return type.GetPatterns().Get<SlopeBounds>(
        PatternTable::GetKind<double>(PatternOf::SlopeBounds), nullptr, nullptr,
        [&] { return SlopeBounds(type); });
}

SlopeBounds::SlopeBounds(CellType const &type) {
    if (!isBounded(type)) {
        _numSteps = type.HasBoundedCurvature() ? countSteps(type, kMaxSteps) : kMaxSteps + 1;
        return;
    }
    _places = FindLatticePlaces(type);
    fitSlopes();
    std::vector<Descendant> descendants;
    ForDescendants(type, PointRows(type), kSteps, [&](CellType const &, PointRows const &points) {
        descendants.push_back(look(points));
    });
    close(descendants);
    if (Exist()) {
        for (int round = 0; round < kRounds; ++round) {
            narrow(descendants);
        }
    }
}

Pair SlopeBounds::fromCenter(std::size_t point) const {
    return {_places[point][0] - _center[0], _places[point][1] - _center[1]};
}

// The slopes of the nearest linear function are S^-1 sum (x_i - mean) P_i.
void SlopeBounds::fitSlopes() {
    std::size_t const size = _places.size();
    for (Pair const &place : _places) {
        _center = {_center[0] + place[0] / double(size), _center[1] + place[1] / double(size)};
    }
    double xx = 0;
    double xy = 0;
    double yy = 0;
    for (std::size_t i = 0; i < size; ++i) {
        Pair const d = fromCenter(i);
        xx += d[0] * d[0];
        xy += d[0] * d[1];
        yy += d[1] * d[1];
    }
    double const determinant = xx * yy - xy * xy;
    for (std::size_t i = 0; i < size; ++i) {
        Pair const d = fromCenter(i);
        _slopes[0].push_back((yy * d[0] - xy * d[1]) / determinant);
        _slopes[1].push_back((xx * d[1] - xy * d[0]) / determinant);
    }
}

SlopeBounds::Descendant SlopeBounds::look(PointRows const &points) const {
    std::size_t const size = _places.size();
    // What the cell's linear function is, in terms of the first points.
    Row const mean = points.Sum(Row(size, 1 / double(size)));
    Row const slopes[2] = {points.Sum(_slopes[0]), points.Sum(_slopes[1])};
    Descendant result;
    for (std::size_t k = 0; k < size; ++k) {
        Pair const d = fromCenter(k);
        Row rest(size);
        for (std::size_t i = 0; i < size; ++i) {
            rest[i] = points.GetRow(k)[i] - mean[i] - d[0] * slopes[0][i] - d[1] * slopes[1][i];
        }
        result.rests.push_back(std::move(rest));
    }
    // Slopes that the type's own linear function has there are no change.  Coordinates are turned, and
    // 2^k times as large.
    Row changes[2];
    for (std::size_t j = 0; j < 2; ++j) {
        Pair ofLinear = {0, 0};
        for (std::size_t i = 0; i < size; ++i) {
            Pair const d = fromCenter(i);
            ofLinear = {ofLinear[0] + slopes[j][i] * d[0], ofLinear[1] + slopes[j][i] * d[1]};
        }
        for (std::size_t i = 0; i < size; ++i) {
            changes[j].push_back(std::ldexp(
                slopes[j][i] - ofLinear[0] * _slopes[0][i] - ofLinear[1] * _slopes[1][i], kSteps));
        }
    }
    for (std::size_t i = 0; i < size; ++i) {
        result.changes.push_back(std::hypot(changes[0][i], changes[1][i]));
    }
    result.sumOfChanges = std::hypot(sumAbsolute(changes[0]), sumAbsolute(changes[1]));
    return result;
}

// Sums up what any number of steps may change.
void SlopeBounds::close(std::vector<Descendant> const &descendants) {
    double growth = 0;      // 2^k g
    double sumOfChange = 0; // s
    Row rests(_places.size());
    Row changes(_places.size());
    for (Descendant const &descendant : descendants) {
        for (Row const &rest : descendant.rests) {
            growth = std::max(growth, std::ldexp(sumAbsolute(rest), kSteps));
            takeLargest(rest, rests);
        }
        takeLargest(descendant.changes, changes);
        sumOfChange = std::max(sumOfChange, descendant.sumOfChanges);
    }
    if (!(growth < 1)) {
        return;
    }
    double const further = std::ldexp(sumOfChange / (1 - growth), kSteps);
    for (std::size_t i = 0; i < changes.size(); ++i) {
        changes[i] += further * rests[i];
    }
    _changes = std::move(changes);
}

// What bounds changes in all cells bounds those behind the first steps, each by its own rests.
void SlopeBounds::narrow(std::vector<Descendant> const &descendants) {
    Row bounds(_changes.size());
    for (Descendant const &descendant : descendants) {
        Row further(_changes.size());
        for (std::size_t k = 0; k < _changes.size(); ++k) {
            for (std::size_t i = 0; i < _changes.size(); ++i) {
                further[i] += _changes[k] * std::abs(descendant.rests[k][i]);
            }
        }
        for (std::size_t i = 0; i < _changes.size(); ++i) {
            bounds[i] = std::max(bounds[i], descendant.changes[i] + std::ldexp(further[i], kSteps));
        }
    }
    _changes = std::move(bounds);
}

SlopeBounds::Normals SlopeBounds::GetNormals(CellValues const &values) const {
    Vector3 along = {};
    Vector3 across = {};
    Vector3 mean = {};
    std::size_t const size = _places.size();
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            double const value = values.GetPoint(int(i))[k];
            mean[k] += value / double(size);
            along[k] += _slopes[0][i] * value;
            across[k] += _slopes[1][i] * value;
        }
    }
    Vector3 const area = Cross(along, across);
    double const length = GetLength(area);
    Normals const none = {{}, std::numeric_limits<double>::infinity()};
    if (!(length > 0)) {
        return none;
    }
    Vector3 const normal = Scale(area, 1 / length);
    // The rests, in the plane of the slopes and out of it.
    double changesIn = 0;
    double changesOut = 0;
    for (std::size_t i = 0; i < size; ++i) {
        Pair const d = fromCenter(i);
        Vector3 rest;
        for (std::size_t k = 0; k < 3; ++k) {
            rest[k] = values.GetPoint(int(i))[k] - mean[k] - d[0] * along[k] - d[1] * across[k];
        }
        double const height = Dot(normal, rest);
        changesOut += _changes[i] * std::abs(height);
        changesIn += _changes[i] * GetLength(Subtract(rest, Scale(normal, height)));
    }
    // The square of how much the slopes make a direction longer, at least, of a symmetric matrix.
    double const alongAlong = Dot(along, along);
    double const acrossAcross = Dot(across, across);
    double const alongAcross = Dot(along, across);
    double const leastSquare =
        (alongAlong + acrossAcross - std::hypot(alongAlong - acrossAcross, 2 * alongAcross)) / 2;
    double const least = std::sqrt(std::max(0.0, leastSquare)) - changesIn;
    return least > 0 ? Normals{normal, changesOut / least} : none;
}

} // namespace OpenSubdivHex::BfrExt::internal

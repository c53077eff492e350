// SPDX-License-Identifier: Apache-2.0
#include "cellBounds.h"

#include "vector3.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

using FarExt::internal::LimitPatch;
using Matrix = std::vector<std::vector<double>>; // by row

// Steps that weights and rests are looked at behind.
constexpr int kStepsOfWeights = 2;
constexpr int kStepsOfRests = 5;
constexpr int kRoundsOfBounds = 4;

// A half cell as it is in the regular lattice: coordinates that steps turn and make larger by 2.
Pair toLattice(Pair const &p) { return {p[0], p[1] * std::sqrt(0.75)}; }
Pair fromLattice(Pair const &p) { return {p[0], p[1] / std::sqrt(0.75)}; }

// Rows of the child's points in terms of the first ancestor's, from those of the parent.
Matrix multiply(ChildStep const &step, Matrix const &rows) {
    Matrix result(step.GetNumRows(), std::vector<double>(rows[0].size()));
    for (std::size_t i = 0; i < result.size(); ++i) {
        step.ForEachEntry(i, [&](std::size_t point, double weight) {
            std::vector<double> const &row = rows[point];
            for (std::size_t j = 0; j < row.size(); ++j) {
                result[i][j] += weight * row[j];
            }
        });
    }
    return result;
}

Matrix makeIdentity(std::size_t size) {
    Matrix result(size, std::vector<double>(size));
    for (std::size_t i = 0; i < size; ++i) {
        result[i][i] = 1;
    }
    return result;
}

// Calls function(child, rows, child numbers) for all cells some steps on.
template <typename FUNCTION>
void forDescendants(CellType const &type, Matrix const &rows, int numSteps,
                    std::vector<std::size_t> &path, FUNCTION const &function) {
    if (numSteps == 0) {
        function(rows, path);
        return;
    }
    std::vector<CellType::Child> const &children = type.GetChildren();
    for (std::size_t i = 0; i < children.size(); ++i) {
        path.push_back(i);
        forDescendants(*children[i].type, multiply(children[i].step, rows), numSteps - 1, path,
                       function);
        path.pop_back();
    }
}

// The places of the points of a half cell, if the faces of its patch are hexagons of a regular lattice.
std::vector<Pair> findPlaces(FarExt::internal::CellPatch const &cell) {
    LimitPatch const &patch = cell.patch;
    constexpr std::size_t kSize = 6;
    bool const isHalf = cell.kind == FarExt::internal::CellKind::Half;
    if (!isHalf || std::any_of(patch.faceSizes.begin(), patch.faceSizes.end(),
                               [](int size) { return size != int(kSize); })) {
        return {};
    }
    std::size_t const numFaces = patch.faceSizes.size();
    std::vector<Pair> places(patch.sources.size());
    std::vector<bool> isPlaced(places.size());
    std::vector<Pair> centers(numFaces);
    std::vector<bool> isDone(numFaces);
    // All corners of a face follow from its centre and two of them.
    auto const place = [&](std::size_t face, std::size_t local, Pair const &first,
                           Pair const &second, Pair const &center) {
        Pair from = {first[0] - center[0], first[1] - center[1]};
        Pair to = {second[0] - center[0], second[1] - center[1]};
        for (std::size_t i = 0; i < kSize; ++i) {
            auto const vert = std::size_t(patch.faceVerts[kSize * face + (local + i) % kSize]);
            places[vert] = {center[0] + from[0], center[1] + from[1]};
            isPlaced[vert] = true;
            Pair const next = {to[0] - from[0], to[1] - from[1]};
            from = to;
            to = next;
        }
        centers[face] = center;
        isDone[face] = true;
    };
    // Corners 1, 2 and 3 of a half cell follow one another in the hexagon.
    Pair const center = toLattice({0.5, 0});
    place(0, std::size_t(cell.locals[1]), toLattice(HalfCell::kCorners[1]),
          toLattice(HalfCell::kCorners[2]), center);
    std::vector<std::size_t> faces = {0};
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (std::size_t local = 0; local < kSize; ++local) {
            std::size_t const corner = kSize * faces[i] + local;
            Far::Index const other = patch.otherCorners[corner];
            if (other < 0 || isDone[std::size_t(other) / kSize]) {
                continue;
            }
            std::size_t const face = std::size_t(other) / kSize;
            Pair const &start = places[std::size_t(patch.faceVerts[corner])];
            Pair const &end =
                places[std::size_t(patch.faceVerts[kSize * faces[i] + (local + 1) % kSize])];
            Pair const &own = centers[faces[i]];
            place(face, std::size_t(other) % kSize, end, start,
                  {start[0] + end[0] - own[0], start[1] + end[1] - own[1]});
            faces.push_back(face);
        }
    }
    bool const areAllPlaced = std::find(isPlaced.begin(), isPlaced.end(), false) == isPlaced.end();
    return areAllPlaced ? places : std::vector<Pair>();
}

// Whether a step makes a regular lattice of the places.
bool keepsPlaces(CellType const &type, std::vector<Pair> const &places) {
    constexpr double kTolerance = 1e-9;
    for (std::size_t child = 0; child < 4; ++child) {
        ChildStep const &step = type.GetChildren()[child].step;
        for (std::size_t i = 0; i < places.size(); ++i) {
            Pair sum = {0, 0};
            step.ForEachEntry(i, [&](std::size_t point, double weight) {
                sum[0] += weight * places[point][0];
                sum[1] += weight * places[point][1];
            });
            Pair const inChild = toLattice(HalfCell::kChildren[child].Apply(fromLattice(sum)));
            if (!(std::hypot(inChild[0] - places[i][0], inChild[1] - places[i][1]) < kTolerance)) {
                return false;
            }
        }
    }
    return true;
}

double sumAbsolute(std::vector<double> const &row) {
    return std::accumulate(row.begin(), row.end(), 0.0,
                           [](double sum, double a) { return sum + std::abs(a); });
}

void takeLargest(std::vector<double> const &row, std::vector<double> &largest) {
    for (std::size_t i = 0; i < row.size(); ++i) {
        largest[i] = std::max(largest[i], std::abs(row[i]));
    }
}

} // namespace

CellBounds const &CellBounds::Find(CellType const &type) {
    return type.GetPatterns().Get<CellBounds>(PatternTable::GetKind<double>(PatternOf::Bounds),
                                              nullptr, nullptr, [&] { return CellBounds(type); });
}

CellBounds::CellBounds(CellType const &type) {
    auto const size = std::size_t(type.GetNumPoints());
    _weights.assign(size, 0.0);
    std::vector<std::size_t> path;
    forDescendants(type, makeIdentity(size), kStepsOfWeights, path,
                   [&](Matrix const &rows, std::vector<std::size_t> const &) {
                       for (std::vector<double> const &row : rows) {
                           for (std::size_t i = 0; i < size; ++i) {
                               _weights[i] = std::max(_weights[i], row[i]);
                           }
                       }
                   });

    if (!type.HasBoundedCurvature() || type.IsWhole() || !type.IsRegular()) {
        return;
    }
    _places = findPlaces(type.GetCell());
    if (_places.empty() || !keepsPlaces(type, _places)) {
        return;
    }
    // The slopes of the nearest linear function are S^-1 sum (x_i - mean) P_i.
    for (Pair const &place : _places) {
        _center = {_center[0] + place[0] / double(size), _center[1] + place[1] / double(size)};
    }
    double xx = 0;
    double xy = 0;
    double yy = 0;
    for (Pair const &place : _places) {
        Pair const d = {place[0] - _center[0], place[1] - _center[1]};
        xx += d[0] * d[0];
        xy += d[0] * d[1];
        yy += d[1] * d[1];
    }
    std::vector<double> slopes[2];
    for (Pair const &place : _places) {
        Pair const d = {place[0] - _center[0], place[1] - _center[1]};
        double const determinant = xx * yy - xy * xy;
        slopes[0].push_back((yy * d[0] - xy * d[1]) / determinant);
        slopes[1].push_back((xx * d[1] - xy * d[0]) / determinant);
    }
    auto const applyToPlaces = [&](std::vector<double> const &row) {
        Pair sum = {0, 0};
        for (std::size_t i = 0; i < size; ++i) {
            sum[0] += row[i] * (_places[i][0] - _center[0]);
            sum[1] += row[i] * (_places[i][1] - _center[1]);
        }
        return sum;
    };
    double largestRest = 0;
    double largestChange = 0;
    struct Descendant {
        std::vector<double> changes; // of slopes, by point
        Matrix rests;                // absolute values
    };
    std::vector<Descendant> descendants;
    std::vector<double> rests(size);
    std::vector<double> changes(size);
    forDescendants(
        type, makeIdentity(size), kStepsOfRests, path,
        [&](Matrix const &rows, std::vector<std::size_t> const &children) {
            // What the child's linear function is, in terms of the first points.
            std::vector<double> mean(size);
            std::vector<double> childSlopes[2] = {mean, mean};
            for (std::size_t k = 0; k < size; ++k) {
                for (std::size_t i = 0; i < size; ++i) {
                    mean[i] += rows[k][i] / double(size);
                    childSlopes[0][i] += slopes[0][k] * rows[k][i];
                    childSlopes[1][i] += slopes[1][k] * rows[k][i];
                }
            }
            Descendant descendant{std::vector<double>(size), {}};
            for (std::size_t k = 0; k < size; ++k) {
                std::vector<double> rest(size);
                for (std::size_t i = 0; i < size; ++i) {
                    rest[i] = rows[k][i] - mean[i] -
                              (_places[k][0] - _center[0]) * childSlopes[0][i] -
                              (_places[k][1] - _center[1]) * childSlopes[1][i];
                }
                largestRest = std::max(largestRest, sumAbsolute(rest));
                takeLargest(rest, rests);
                std::transform(rest.begin(), rest.end(), rest.begin(),
                               [](double a) { return std::abs(a); });
                descendant.rests.push_back(std::move(rest));
            }
            // What they are of points without a slope.  Coordinates are turned and 2^k times
            // as large.
            Pair const ofSlopes[2] = {applyToPlaces(childSlopes[0]), applyToPlaces(childSlopes[1])};
            double const scale = std::ldexp(1.0, int(children.size()));
            double sums[2] = {};
            for (std::size_t i = 0; i < size; ++i) {
                double change[2];
                for (std::size_t j = 0; j < 2; ++j) {
                    change[j] = childSlopes[j][i] - ofSlopes[j][0] * slopes[0][i] -
                                ofSlopes[j][1] * slopes[1][i];
                    sums[j] += std::abs(change[j]);
                }
                descendant.changes[i] = scale * std::hypot(change[0], change[1]);
                changes[i] = std::max(changes[i], descendant.changes[i]);
            }
            largestChange = std::max(largestChange, scale * std::hypot(sums[0], sums[1]));
            descendants.push_back(std::move(descendant));
        });
    double const growth = std::ldexp(largestRest, kStepsOfRests);
    if (growth < 1) {
        _slopes[0] = std::move(slopes[0]);
        _slopes[1] = std::move(slopes[1]);
        double const further = std::ldexp(largestChange / (1 - growth), kStepsOfRests);
        _slopeChanges = std::move(changes);
        for (std::size_t i = 0; i < size; ++i) {
            _slopeChanges[i] += further * rests[i];
        }
        // What bounds changes in all cells bounds those behind the first steps, each by its own rests.
        for (int round = 0; round < kRoundsOfBounds; ++round) {
            std::vector<double> bounds(size);
            for (Descendant const &descendant : descendants) {
                std::vector<double> sum(size);
                for (std::size_t k = 0; k < size; ++k) {
                    for (std::size_t i = 0; i < size; ++i) {
                        sum[i] += _slopeChanges[k] * descendant.rests[k][i];
                    }
                }
                for (std::size_t i = 0; i < size; ++i) {
                    bounds[i] = std::max(bounds[i],
                                         descendant.changes[i] + std::ldexp(sum[i], kStepsOfRests));
                }
            }
            _slopeChanges = std::move(bounds);
        }
    }
}

CellBounds::Range CellBounds::GetRange(std::vector<double> const &numbers) const {
    std::vector<std::size_t> order(numbers.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
    // The least sum has as much of the least numbers as there may be.
    auto const sum = [&](auto begin, auto end) {
        double result = 0;
        double rest = 1;
        for (auto i = begin; i != end && rest > 0; ++i) {
            double const weight = std::min(rest, _weights[*i]);
            result += weight * numbers[*i];
            rest -= weight;
        }
        return result;
    };
    return {sum(order.begin(), order.end()), sum(order.rbegin(), order.rend())};
}

CellBounds::Normals CellBounds::GetNormals(std::vector<double> const &values) const {
    Vector3 along = {};
    Vector3 across = {};
    Vector3 mean = {};
    std::size_t const size = _places.size();
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            double const value = values[3 * i + k];
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
        Vector3 rest;
        for (std::size_t k = 0; k < 3; ++k) {
            rest[k] = values[3 * i + k] - mean[k] - (_places[i][0] - _center[0]) * along[k] -
                      (_places[i][1] - _center[1]) * across[k];
        }
        double const height = Dot(normal, rest);
        changesOut += _slopeChanges[i] * std::abs(height);
        changesIn += _slopeChanges[i] * GetLength(Subtract(rest, Scale(normal, height)));
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

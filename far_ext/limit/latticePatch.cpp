// SPDX-License-Identifier: Apache-2.0
#include "latticePatch.h"

#include "far_ext/vtr/pi.h"

#include <cmath>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

constexpr double kPlaceTolerance = 1e-6; ///< of places, which are 1 apart

using Point = LatticePatch::Point;

bool isAt(Point a, Point b) { return std::abs(a - b) < kPlaceTolerance; }

} // namespace

/// A corner in the plane, and the edge to the next one of its face.
struct LatticePatch::Directed {
    Point point;
    Point edge;

    Directed Next(int faceSize) const {
        return {point + edge, edge * std::polar(1.0, 2 * kPi / faceSize)};
    }
    Directed Across() const { return {point + edge, -edge}; }
};

LatticePatch::LatticePatch(int faceSize) : _faceSize(faceSize) {
    Point const corner0 = 0.5 / std::sin(kPi / faceSize);
    std::vector<Directed> const base = [&] {
        std::vector<Directed> corners = {{corner0, Turn(corner0, 1) - corner0}};
        for (int i = 1; i < faceSize; ++i) {
            corners.push_back(corners.back().Next(faceSize));
        }
        return corners;
    }();
    // Whether a face has a vertex that is one of the base face or its neighbour.
    auto const isNear = [&](Directed corner) {
        for (int i = 0; i < faceSize; ++i, corner = corner.Next(faceSize)) {
            for (Directed const &ofBase : base) {
                if (std::abs(corner.point - ofBase.point) < 1 + kPlaceTolerance) {
                    return true;
                }
            }
        }
        return false;
    };
    std::vector<Directed> corners = {base[0]};
    addStep({0, false, 0}, base[0].point);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (bool const isAcross : {false, true}) {
            Directed const next = isAcross ? corners[i].Across() : corners[i].Next(faceSize);
            bool const isNew =
                std::none_of(corners.begin(), corners.end(), [&](Directed const &corner) {
                    return isAt(corner.point, next.point) && isAt(corner.edge, next.edge);
                });
            if (isNew && isNear(next)) {
                corners.push_back(next);
                addStep({int(i), isAcross, 0}, next.point);
            }
        }
    }
    setPlaces();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        _steps[i].place = findPlace(corners[i].point);
    }
}

void LatticePatch::addStep(Step step, Point point) {
    _steps.push_back(step);
    if (findPlace(point) == GetNumPlaces()) {
        _points.push_back(point);
    }
}

// Numbers the points by their orbits.
void LatticePatch::setPlaces() {
    std::vector<Point> onAxes;
    std::vector<Point> inPairs;
    auto const isIn = [](std::vector<Point> const &points, Point point) {
        return std::any_of(points.begin(), points.end(),
                           [&](Point other) { return isAt(other, point); });
    };
    auto const addOrbit = [&](std::vector<Point> &points, Point first) {
        for (int i = 0; i < _faceSize; ++i) {
            points.push_back(Turn(first, i));
        }
    };
    for (Point const point : _points) {
        if (isIn(onAxes, point) || isIn(inPairs, point)) {
            continue;
        }
        Point const *onAxis = nullptr;
        for (Point const &other : _points) {
            bool const isOfOrbit = isAt(std::pow(other, _faceSize), std::pow(point, _faceSize)) &&
                                   std::abs(other.imag()) < kPlaceTolerance;
            // An even number of turns has one at either end of the axis.
            onAxis = isOfOrbit && (!onAxis || other.real() > 0) ? &other : onAxis;
        }
        if (onAxis) {
            addOrbit(onAxes, *onAxis);
        } else {
            addOrbit(inPairs, point);
            addOrbit(inPairs, std::conj(point));
        }
    }
    _numAxes = int(onAxes.size()) / _faceSize;
    onAxes.insert(onAxes.end(), inPairs.begin(), inPairs.end());
    _points.swap(onAxes);
}

Point LatticePatch::Turn(Point point, int corners) const {
    return point * std::polar(1.0, 2 * kPi * corners / _faceSize);
}

int LatticePatch::TurnPlace(int place, int corners) const {
    int const local = place % _faceSize;
    return place - local + (local + corners) % _faceSize;
}

int LatticePatch::MirrorPlace(int place) const {
    int const orbit = place / _faceSize;
    int const local = (_faceSize - place % _faceSize) % _faceSize;
    if (orbit < _numAxes) {
        return orbit * _faceSize + local;
    }
    int const isSecond = (orbit - _numAxes) % 2;
    return (orbit + 1 - 2 * isSecond) * _faceSize + local;
}

FaceCorner LatticePatch::follow(Level const &level, FaceCorner from, bool isAcross) {
    return isAcross ? level.GetCornerAcross(from.corner)
                    : FaceCorner{from.face, level.GetNextCorner(from.face, from.corner)};
}

bool LatticePatch::areDifferent(Index const *verts) const {
    Index sorted[kMaxPlaces];
    Index *const end = std::copy_n(verts, _points.size(), sorted);
    std::sort(sorted, end);
    return std::adjacent_find(sorted, end) == end;
}

int LatticePatch::findPlace(Point point) const {
    return int(std::find_if(_points.begin(), _points.end(),
                            [&](Point other) { return isAt(other, point); }) -
               _points.begin());
}

} // namespace OpenSubdivHex::FarExt::internal

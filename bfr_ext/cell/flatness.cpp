// SPDX-License-Identifier: Apache-2.0
#include "flatness.h"

#include "cellBounds.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

struct Line {
    double GetDistance(double const *point) const {
        Vector3 const d = Subtract(ToVector3(point), origin);
        return length > 0 ? GetLength(Cross(along, d)) / length : GetLength(d);
    }

    Vector3 origin;
    Vector3 along;
    double length; // of that; 0: the line is a point
};

bool isStraight(CellValues const &values, Line const &line, double length, int numSteps) {
    std::vector<double> distances;
    distances.reserve(std::size_t(values.GetNumPoints()));
    for (int i = 0; i < values.GetNumPoints(); ++i) {
        distances.push_back(line.GetDistance(values.GetPoint(i)));
    }
    if (CellBounds::Find(values.GetType()).GetMax(distances, length) <= length) {
        return true;
    }
    if (numSteps == 0) {
        return false;
    }
    CellValues part;
    for (std::size_t i = 0; i < values.GetType().GetChildren().size(); ++i) {
        part.SetChild(values, int(i));
        if (!isStraight(part, line, length, numSteps - 1)) {
            return false;
        }
    }
    return true;
}

} // namespace

// The plane through the first corner with the mean normal of all.
Flatness::Plane Flatness::findPlane(std::vector<double> const &corners) {
    Vector3 const origin = ToVector3(corners.data());
    Vector3 area = {};
    for (std::size_t i = 3; i + 3 < corners.size(); i += 3) {
        Vector3 const part = Cross(Subtract(ToVector3(&corners[i]), origin),
                                   Subtract(ToVector3(&corners[i + 3]), origin));
        area = Subtract(area, Scale(part, -1));
    }
    double const length = GetLength(area);
    return {origin, length > 0 ? Scale(area, 1 / length) : Vector3{0, 0, 1}};
}

Flatness::Bounds Flatness::Find(RefinedCells &cells, std::size_t cell,
                                std::vector<double> const &corners, double length) {
    constexpr double kMargin = 0.03125;    // of the window, on either side
    constexpr double kRounding = 1 - 1e-9; // what is attained may be beyond bounds by a last digit
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    _plane = findPlane(corners);
    _attained = {0, 0};
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        _attained.Add(_plane.GetHeight(&corners[i]));
    }
    Bounds bounds = {kRounding * _attained.GetLength(), kInfinity};
    auto const isDecided = [&] { return length < bounds.least || bounds.most <= length; };
    int const numSteps = cells.GetHeightBounds(cell) ? kNumBoundedSteps : kNumSteps;
    _parts.assign(1, {cell, numSteps, {-kInfinity, kInfinity}});
    Range closed = {0, 0}; // of all that is not refined
    while (!_parts.empty() && !isDecided()) {
        Range bound = closed;
        for (Part &part : _parts) {
            part.range = findRange(cells, part.cell).Cut(part.range);
            bound.Add(part.range);
        }
        closed.Add(_attained);
        bound.Add(_attained);
        bounds.most = std::min(bounds.most, bound.GetLength());
        double const margin = kMargin * closed.GetLength();
        Range const window = {closed.min - margin, closed.max + margin};
        auto const open = std::partition(_parts.begin(), _parts.end(), [&](Part const &part) {
            return part.numStepsLeft == 0 || window.Has(part.range);
        });
        std::for_each(_parts.begin(), open, [&](Part const &part) { closed.Add(part.range); });
        bounds.least = std::max(bounds.least, kRounding * closed.GetLength());
        _next.clear();
        if (!isDecided()) {
            std::for_each(open, _parts.end(),
                          [&](Part const &part) { refine(cells, part, _next); });
        }
        std::swap(_parts, _next);
    }
    return isDecided() ? bounds : Bounds{bounds.most, bounds.most};
}

Flatness::Range Flatness::findHeights(CellValues const &values) {
    auto const size = std::size_t(values.GetNumPoints());
    std::size_t const stride = values.GetPaddedSize();
    _heights.resize(size);
    Vector3 const normal = _plane.normal;
    double const ofOrigin = Dot(normal, _plane.origin);
    double const *point = values.GetPoint(0);
    double least = Dot(normal, ToVector3(point)) - ofOrigin;
    double largest = least;
    for (std::size_t i = 0; i < size; ++i, point += stride) {
        double const height = Dot(normal, ToVector3(point)) - ofOrigin;
        _heights[i] = height;
        least = std::min(least, height);
        largest = std::max(largest, height);
    }
    return {least, largest};
}

// Of all heights in a cell, and those that the surface has for certain.
Flatness::Range Flatness::findRange(RefinedCells &cells, std::size_t cell) {
    Range const range = findHeights(cells[cell]);
    HeightBounds const *const bounds = cells.GetHeightBounds(cell);
    if (!bounds) {
        return range;
    }
    HeightBounds::Ranges const ranges = bounds->GetRanges(_heights.data(), _scratch);
    _attained.min = std::min(_attained.min, ranges.attained.min);
    _attained.max = std::max(_attained.max, ranges.attained.max);
    if (_attained.Has(range)) {
        return range;
    }
    return {std::max(range.min, ranges.bound.min), std::min(range.max, ranges.bound.max)};
}

void Flatness::refine(RefinedCells &cells, Part const &parent, std::vector<Part> &children) {
    std::size_t const first = cells.GetFirstChild(parent.cell);
    int const numChildren = cells.GetNumChildren(parent.cell);
    for (int i = 0; i < numChildren; ++i) {
        std::size_t const child = first + std::size_t(i);
        int const numSteps = cells.GetHeightBounds(child) ? kNumBoundedSteps : kNumSteps;
        children.push_back({child, std::min(parent.numStepsLeft - 1, numSteps), parent.range});
    }
    // Of all children the first alone has corners that the cell has not.
    if (!cells.GetHeightBounds(parent.cell)) {
        for (int corner = 0; corner < cells[first].GetType().GetNumCorners(); ++corner) {
            double point[3];
            cells.EvaluateCorner(first, corner, point);
            _attained.Add(_plane.GetHeight(point));
        }
    }
}

bool IsStraight(std::vector<CellValues> const &parts, double const start[3], double const end[3],
                double length) {
    constexpr int kNumSteps = 2; // beyond the parts
    Vector3 const along = Subtract(ToVector3(end), ToVector3(start));
    Line const line = {ToVector3(start), along, GetLength(along)};
    return std::all_of(parts.begin(), parts.end(), [&](CellValues const &part) {
        return isStraight(part, line, length, kNumSteps);
    });
}

} // namespace OpenSubdivHex::BfrExt::internal

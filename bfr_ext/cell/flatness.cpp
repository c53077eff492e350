// SPDX-License-Identifier: Apache-2.0
#include "flatness.h"

#include "cellBounds.h"
#include "latticeBounds.h"
#include "vector3.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

struct Plane {
    double GetHeight(double const *point) const {
        return Dot(normal, Subtract(ToVector3(point), origin));
    }

    Vector3 origin;
    Vector3 normal;
};

struct Line {
    double GetDistance(double const *point) const {
        Vector3 const d = Subtract(ToVector3(point), origin);
        return length > 0 ? GetLength(Cross(along, d)) / length : GetLength(d);
    }

    Vector3 origin;
    Vector3 along;
    double length; // of that; 0: the line is a point
};

// The plane through the first corner with the mean normal of all.
Plane findPlane(std::vector<double> const &corners) {
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

bool isStraight(CellValues const &values, Line const &line, double length, int numSteps) {
    std::vector<double> const &points = values.GetValues();
    std::vector<double> distances;
    for (std::size_t i = 0; i < points.size(); i += 3) {
        distances.push_back(line.GetDistance(&points[i]));
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

// Makes a range as long as is allowed, on both sides by as large a part of what a bound has beyond it.
Flatness::Range Flatness::widen(Range const &range, Range const &bound, double length) {
    double const below = range.min - bound.min;
    double const above = bound.max - range.max;
    double const factor = std::max(0.0, length - range.GetLength()) / (below + above);
    return {range.min - factor * below, range.max + factor * above};
}

void Flatness::Cell::SetType(CellType const &cellType) {
    type = &cellType;
    LatticeBounds const &bounds = LatticeBounds::Find(cellType);
    lattice = bounds.Exist() ? &bounds : nullptr;
}

Flatness::Cell &Flatness::Cells::Add() {
    if (size == cells.size()) {
        cells.emplace_back();
    }
    return cells[size++];
}

bool Flatness::IsFlat(CellValues const &values, std::vector<double> const &corners, double length) {
    Plane const plane = findPlane(corners);
    _attained = {0, 0};
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        _attained.Add(plane.GetHeight(&corners[i]));
    }
    if (_attained.GetLength() > length) {
        return false;
    }
    Cells *cells = &_cells[0];
    Cells *next = &_cells[1];
    cells->size = 0;
    next->size = 0;
    Cell &first = cells->Add();
    first.SetType(values.GetType());
    first.numStepsLeft = first.lattice ? kNumLatticeSteps : kNumSteps;
    first.heights.clear();
    for (std::size_t i = 0; i < values.GetValues().size(); i += 3) {
        first.heights.push_back(plane.GetHeight(&values.GetValues()[i]));
    }
    if (!first.lattice) {
        refine(first, *next); // its own range is too far from what the surface has
        std::swap(cells, next);
    }
    Range closed = {0, 0}; // of all that is not refined
    while (cells->size > 0) {
        Range bound = closed;
        for (std::size_t i = 0; i < cells->size; ++i) {
            Cell &cell = cells->cells[i];
            cell.range = findRange(cell);
            if (_attained.GetLength() > length) {
                return false;
            }
            bound.Add(cell.range);
        }
        closed.Add(_attained);
        bound.Add(_attained);
        if (bound.GetLength() <= length) {
            return true;
        }
        Range const window = widen(closed, bound, length);
        next->size = 0;
        for (std::size_t i = 0; i < cells->size; ++i) {
            Cell const &cell = cells->cells[i];
            if (cell.numStepsLeft == 0 || window.Has(cell.range)) {
                closed.Add(cell.range);
            } else {
                refine(cell, *next);
            }
        }
        if (closed.GetLength() > length) {
            return false;
        }
        std::swap(cells, next);
    }
    return true;
}

// Of all heights in a cell, and those that the surface has for certain.
Flatness::Range Flatness::findRange(Cell const &cell) {
    if (cell.lattice) {
        LatticeBounds::Ranges const range = cell.lattice->GetRanges(cell.heights, _scratch);
        _attained.Add(range.attained.min);
        _attained.Add(range.attained.max);
        return {range.bound.min, range.bound.max};
    }
    auto const [least, largest] = std::minmax_element(cell.heights.begin(), cell.heights.end());
    if (*least >= _attained.min && *largest <= _attained.max) {
        return {*least, *largest};
    }
    CellBounds const &bounds = CellBounds::Find(*cell.type);
    return {bounds.GetMin(cell.heights, _attained.min), bounds.GetMax(cell.heights, _attained.max)};
}

void Flatness::refine(Cell const &parent, Cells &children) {
    parent.type->GetStep().Apply(parent.heights, _scratch);
    bool isFirst = true;
    for (CellType::Child const &link : parent.type->GetChildren()) {
        Cell &child = children.Add();
        child.SetType(*link.type);
        child.numStepsLeft =
            std::min(parent.numStepsLeft - 1, child.lattice ? kNumLatticeSteps : kNumSteps);
        link.step.CopyNumbers(_scratch, child.heights);
        if (isFirst && !parent.lattice) {
            // Of all children it alone has corners that the cell has not.
            for (std::vector<double> const &weights : link.type->GetCornerPoints()) {
                double height = 0;
                for (std::size_t i = 0; i < weights.size(); ++i) {
                    height += weights[i] * child.heights[i];
                }
                _attained.Add(height);
            }
        }
        isFirst = false;
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

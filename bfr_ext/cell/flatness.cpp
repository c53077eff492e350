// SPDX-License-Identifier: Apache-2.0
#include "flatness.h"

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
    if (CellBounds::Find(values.GetType()).GetRange(distances).max <= length) {
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

void Flatness::Range::Add(double height) {
    min = std::min(min, height);
    max = std::max(max, height);
}

bool Flatness::IsFlat(std::vector<double> const &corners, std::vector<CellValues> const &children,
                      double length) {
    Plane const plane = findPlane(corners);
    Range attained = {0, 0};
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        attained.Add(plane.GetHeight(&corners[i]));
    }
    Cells *cells = &_cells[0];
    cells->cells.clear();
    cells->heights.clear();
    for (CellValues const &child : children) {
        cells->cells.push_back({&child.GetType(), cells->heights.size(), false});
        std::vector<double> const &points = child.GetValues();
        for (std::size_t i = 0; i < points.size(); i += 3) {
            cells->heights.push_back(plane.GetHeight(&points[i]));
        }
    }
    for (int step = 1; attained.GetLength() <= length; ++step) {
        if (findBound(*cells, attained).GetLength() <= length) {
            return true;
        }
        if (step == kNumSteps) {
            return false;
        }
        if (step == 1) {
            // Of all children it alone has corners that the cell has not.
            for (int i = 0; i < children[0].GetType().GetNumCorners(); ++i) {
                double corner[3];
                children[0].EvaluateCorner(i, corner);
                attained.Add(plane.GetHeight(corner));
            }
        }
        Cells *const next = &_cells[step % 2];
        refine(*cells, *next);
        cells = next;
    }
    return false;
}

// Of all heights, having found which cells may go beyond those that the surface has.
Flatness::Range Flatness::findBound(Cells &cells, Range const &attained) {
    Range bound = attained;
    for (Cell &cell : cells.cells) {
        auto const begin = cells.heights.begin() + std::ptrdiff_t(cell.firstHeight);
        _scratch.assign(begin, begin + cell.type->GetNumPoints());
        CellBounds::Range const range = CellBounds::Find(*cell.type).GetRange(_scratch);
        cell.isWithin = attained.Has({range.min, range.max});
        bound.Add(range.min);
        bound.Add(range.max);
    }
    return bound;
}

void Flatness::refine(Cells const &parents, Cells &children) {
    children.cells.clear();
    children.heights.clear();
    for (Cell const &parent : parents.cells) {
        if (parent.isWithin) {
            continue;
        }
        double const *const heights = &parents.heights[parent.firstHeight];
        for (CellType::Child const &child : parent.type->GetChildren()) {
            children.cells.push_back({child.type, children.heights.size(), false});
            for (std::size_t row = 0; row < child.step.GetNumRows(); ++row) {
                double height = 0;
                child.step.ForEachEntry(row, [&](std::size_t point, double weight) {
                    height += weight * heights[point];
                });
                children.heights.push_back(height);
            }
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

// SPDX-License-Identifier: Apache-2.0
#include "flatness.h"

#include "surfaceSamples.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Factor for the surface between samples.
constexpr double kFactor = 1.125;

} // namespace

// The plane through the first corner with the mean normal of all.
Flatness::Plane Flatness::findPlane(std::vector<double> const &corners) {
    Vector3 const area = FindArea(corners);
    double const length = GetLength(area);
    return {ToVector3(corners.data()), length > 0 ? Scale(area, 1 / length) : Vector3{0, 0, 1}};
}

void Flatness::add(double height) {
    _least = std::min(_least, height);
    _largest = std::max(_largest, height);
}

double Flatness::FindThickness(RefinedCells &cells, std::size_t cell,
                               std::vector<double> const &corners) {
    constexpr int kNumSteps = 3; // that cells of many points are refined by
    _plane = findPlane(corners);
    _least = 0;
    _largest = 0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        add(_plane.GetHeight(&corners[i]));
    }
    addSamples(cells, cell, kNumSteps);
    return kFactor * (_largest - _least);
}

void Flatness::addSamples(RefinedCells &cells, std::size_t cell, int numSteps) {
    if (!cells.HasSamples(cell)) {
        if (numSteps == 0) {
            return;
        }
        std::size_t const first = cells.GetFirstChild(cell);
        int const numChildren = cells.GetNumChildren(cell);
        // Only the first child has corners that the cell has not.
        double point[3];
        for (int i = 0; i < cells[first].GetType().GetNumCorners(); ++i) {
            cells.EvaluateCorner(first, i, point);
            add(_plane.GetHeight(point));
        }
        for (int i = 0; i < numChildren; ++i) {
            addSamples(cells, first + std::size_t(i), numSteps - 1);
        }
        return;
    }
    CellValues const &values = cells[cell];
    auto const size = std::size_t(values.GetNumPoints());
    double const *point = values.GetPoint(0);
    double const ofOrigin = Dot(_plane.normal, _plane.origin);
    _heights.resize(size);
    for (std::size_t i = 0; i < size; ++i, point += values.GetPaddedSize()) {
        _heights[i] = Dot(_plane.normal, ToVector3(point)) - ofOrigin;
    }
    SurfaceSamples::Find(values.GetType()).Evaluate(_heights.data(), 1, 1, _samples);
    std::for_each(_samples.begin(), _samples.end(), [&](double height) { add(height); });
}

bool IsStraight(std::vector<CellValues> const &parts, double const start[3], double const end[3],
                double length) {
    Vector3 const origin = ToVector3(start);
    Vector3 const along = Subtract(ToVector3(end), origin);
    double const lengthOfLine = GetLength(along);
    std::vector<double> samples;
    return std::all_of(parts.begin(), parts.end(), [&](CellValues const &part) {
        SurfaceSamples::Find(part.GetType())
            .Evaluate(part.GetPoint(0), std::ptrdiff_t(part.GetPaddedSize()), 3, samples);
        for (std::size_t i = 0; i < samples.size(); i += 3) {
            Vector3 const d = Subtract(ToVector3(&samples[i]), origin);
            double const distance =
                lengthOfLine > 0 ? GetLength(Cross(along, d)) / lengthOfLine : GetLength(d);
            if (kFactor * distance > length) {
                return false;
            }
        }
        return true;
    });
}

} // namespace OpenSubdivHex::BfrExt::internal

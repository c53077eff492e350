// SPDX-License-Identifier: Apache-2.0
#include "cellGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Margins for the surface between samples: a quadratic surface exceeds the range of heights by up to a fifteenth;
// children, which have fewer samples, exceed it mostly by less than a quarter.
constexpr double kFactorOfCell = 1.125;
constexpr double kFactorOfChildren = 1.25;
// Each step leaves a quarter of the thickness where the surface is smooth: with a margin, of the factors' size.
constexpr double kLeastOfWhole = 0.3;
constexpr double kExpected = 0.22;

} // namespace

CellGrid::CellGrid(FaceShape shape)
    : _shape(shape), _places(shape, kNumSteps),
      _plan(shape, kNumSteps, _places.GetAll(), CellPlan::Use::AllPoints, true),
      _planOfBase(shape, kNumSteps, _places.GetAll(), CellPlan::Use::AllPoints, shape.size == 0) {
    add(CellOutline<Pair>::MakeRoot(shape), kNumSteps);
}

CellGrid &CellGrid::Get(FaceShape shape) {
    static thread_local std::map<FaceShape, CellGrid> grids;
    return grids.try_emplace(shape, shape).first->second;
}

// Adds a cell, and those that some steps make of it.
int CellGrid::add(CellOutline<Pair> const &outline, int numSteps) {
    std::size_t const number = _cells.size();
    _cells.emplace_back();
    _cells[number].factor = numSteps == kNumSteps ? kFactorOfCell : kFactorOfChildren;
    for (int i = 0; i < outline.GetNumCorners(_shape); ++i) {
        _cells[number].corners.push_back(int(_places.Find(outline.GetCorner(_shape, i))));
    }
    _cells[number].samples = _cells[number].corners;
    for (int i = 0; numSteps > 0 && i < outline.GetNumChildren(_shape); ++i) {
        int const child = add(outline.GetChild(_shape, i), numSteps - 1);
        Cell &cell = _cells[number];
        cell.children.push_back(child);
        std::vector<int> const &samples = _cells[std::size_t(child)].samples;
        cell.samples.insert(cell.samples.end(), samples.begin(), samples.end());
    }
    std::vector<int> &samples = _cells[number].samples;
    std::sort(samples.begin(), samples.end());
    samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
    return int(number);
}

void CellGrid::Sample(CellValues const &cell, std::vector<double> &samples) {
    sample(cell.GetPoint(0), cell.GetPaddedSize(), cell.GetNumPoints(), samples,
           [&](float *const *results) {
               _evaluator.Evaluate(cell.GetType(), _plan, 3, _points.data(), 3, results, 3);
           });
}

void CellGrid::Sample(BaseFace const &face, double const *controlPoints,
                      RingSources<float> const &shared, std::vector<double> &samples) {
    BaseType const &type = face.type;
    PlainFaceType const *const plain = type.GetPlain();
    auto const evaluateRings = [&](RingSources<float> const &sources, float *const *results) {
        _ringValues.Set(plain->GetRings().GetRings(), face.GetTurns() + face.size, sources);
        _evaluator.Evaluate(*plain, _ringValues, _planOfBase, results, 3);
    };
    if (plain && shared.points) {
        _samples.resize(3 * _places.GetSize());
        float *const results[1] = {_samples.data()};
        evaluateRings(shared, results);
        samples.assign(_samples.begin(), _samples.end());
        return;
    }
    sample(controlPoints, 3, face.numPoints, samples, [&](float *const *results) {
        if (plain) {
            evaluateRings({_points.data(), 3, 3, std::size_t(face.numPoints), nullptr}, results);
        } else {
            _evaluator.Evaluate(*type, type.IsInLattice() ? _plan : _planOfBase, 3, _points.data(),
                                3, results, 3);
        }
    });
}

// Has evaluate(results) make the samples from the points in single precision.
template <typename FUNCTION>
void CellGrid::sample(double const *points, std::size_t stride, int numPoints,
                      std::vector<double> &samples, FUNCTION const &evaluate) {
    Vector3 const origin = ToVector3(points);
    auto const forEachNumber = [&](auto const &function) {
        for (std::size_t i = 0; i < std::size_t(numPoints); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                function(3 * i + k, points[i * stride + k] - origin[k]);
            }
        }
    };
    double size = std::numeric_limits<double>::min();
    forEachNumber([&](std::size_t, double number) { size = std::max(size, std::abs(number)); });
    double const scale = 1 / size;
    _points.resize(3 * std::size_t(numPoints));
    forEachNumber([&](std::size_t i, double number) { _points[i] = float(number * scale); });
    _samples.resize(3 * _places.GetSize());
    float *const results[1] = {_samples.data()};
    evaluate(results);
    samples.resize(_samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = origin[i % 3] + size * double(_samples[i]);
    }
}

void CellGrid::measure(std::vector<double> const &samples, Cell const &cell,
                       CellMeasures &measures) const {
    auto const getSample = [&](int sample) { return ToVector3(&samples[3 * std::size_t(sample)]); };
    Vector3 const origin = getSample(cell.corners[0]);
    Vector3 area = {};
    Vector3 last = {}; // from the origin
    Vector3 sum = {};
    double longest = 0; // square
    for (std::size_t i = 1; i < cell.corners.size(); ++i) {
        Vector3 const next = Subtract(getSample(cell.corners[i]), origin);
        Vector3 const side = Subtract(next, last);
        area = Add(area, Cross(last, next));
        longest = std::max(longest, Dot(side, side));
        sum = Add(sum, next);
        last = next;
    }
    double const length = GetLength(area);
    Vector3 const normal = length > 0 ? Scale(area, 1 / length) : Vector3{0, 0, 1};
    Vector3 const center = Add(origin, Scale(sum, 1 / double(cell.corners.size())));
    double radius = 0; // square
    double least = 0;  // the height of the center, which lies between those of corners
    double largest = 0;
    for (int const sample : cell.samples) {
        Vector3 const d = Subtract(getSample(sample), center);
        radius = std::max(radius, Dot(d, d));
        double const height = Dot(normal, d);
        least = std::min(least, height);
        largest = std::max(largest, height);
    }
    measures.thickness = cell.factor * (largest - least);
    measures.ball = {center, cell.factor * std::sqrt(radius)};
    measures.longestSide = std::sqrt(std::max(longest, Dot(last, last)));
}

void CellGrid::Measure(std::vector<double> const &samples, CellMeasures &cell) const {
    measure(samples, _cells[0], cell);
}

void CellGrid::MeasureChildren(std::vector<double> const &samples, CellMeasures const &cell,
                               bool isSharp, CellMeasures *children) const {
    // Half children of whole cells have sides as long as these.
    double const usual = _shape.size > 0 ? cell.thickness : cell.thickness / 4;
    for (std::size_t i = 0; i < _cells[0].children.size(); ++i) {
        measure(samples, _cells[std::size_t(_cells[0].children[i])], children[i]);
        if (_shape.size > 0 && i == 0) {
            // The samples of a whole child lie on its diagonals, where a saddle may have no height.
            children[i].thickness = std::max(children[i].thickness, kLeastOfWhole * cell.thickness);
        }
        // A child may be flatter than its own children, by chance.
        children[i].childThickness =
            isSharp ? children[i].thickness : kExpected * std::max(children[i].thickness, usual);
    }
}

CellFacing CellGrid::FindFacing(std::vector<double> const &samples, int cell,
                                std::vector<Vector3> normals) const {
    // A margin for normals between those at samples.
    constexpr double kFactor = 3.25;
    constexpr double kLargest = 1; // where it bends further, too little is known of the surface
    Vector3 sum = {};
    std::vector<Vector3> places;
    auto const addPolygons = [&](auto const &self, Cell const &part) -> void {
        for (int const child : part.children) {
            self(self, _cells[std::size_t(child)]);
        }
        std::size_t const numCorners = part.children.empty() ? part.corners.size() : 0;
        auto const getCorner = [&](std::size_t corner) {
            return ToVector3(&samples[3 * std::size_t(part.corners[corner % numCorners])]);
        };
        for (std::size_t i = 0; i < numCorners; ++i) {
            Vector3 const place = getCorner(i);
            places.push_back(place);
            normals.push_back(Cross(Subtract(getCorner(i + 1), place),
                                    Subtract(getCorner(i + numCorners - 1), place)));
            sum = Add(sum, normals.back());
        }
    };
    addPolygons(addPolygons,
                _cells[cell == 0 ? 0 : std::size_t(_cells[0].children[std::size_t(cell) - 1])]);
    CellFacing facing;
    double const length = GetLength(sum);
    if (!(length > 0)) {
        return facing;
    }
    facing.normal = Scale(sum, 1 / length);
    facing.center = Scale(std::accumulate(places.begin(), places.end(), Vector3{}, Add),
                          1 / double(places.size()));
    double largest = 0; // tangent of an angle to the normal
    for (Vector3 const &normal : normals) {
        double const height = Dot(facing.normal, normal);
        if (!(height > 0)) {
            return facing;
        }
        largest =
            std::max(largest, GetLength(Subtract(normal, Scale(facing.normal, height))) / height);
    }
    if (largest > kLargest) {
        return facing;
    }
    facing.spread = kFactor * largest;
    for (Vector3 const &place : places) {
        Vector3 const d = Subtract(place, facing.center);
        facing.radius = std::max(facing.radius, kFactor * GetLength(d));
        facing.depth = std::max(facing.depth, -kFactor * Dot(facing.normal, d));
    }
    return facing;
}

} // namespace OpenSubdivHex::BfrExt::internal

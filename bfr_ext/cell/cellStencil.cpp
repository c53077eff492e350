// SPDX-License-Identifier: Apache-2.0
#include "cellStencil.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::BasePolygon;

namespace {

// In a regular lattice the error of a bilinear cell falls by 4 in a step where curvature is bounded.
// Elsewhere it falls as the cells do, by 1.25 at least.
constexpr int kRegularDepth = 16;
constexpr int kLastDepth = 40;
// In the differences between first derivatives at corners that are closer, their rounding shows.
constexpr int kDepthOfDifferences = 10;

Pair clampToHalf(Pair const &coords) {
    double const h = std::min(std::max(coords[1], 0.0), 0.5);
    return {std::min(std::max(coords[0], 0.5 * h), 1 - 0.5 * h), h};
}

} // namespace

BasePoint FindInUncommonPolygon(FaceShape shape, double u, double v, double tolerance) {
    return FindBasePoint(BasePolygon(shape), shape, u, v, tolerance);
}

CellStep FindCellStep(FaceShape shape, int sector, Pair const &coords) {
    if (shape.size == 0) {
        int const child = HalfCell::FindChild(coords);
        return {std::size_t(child), &HalfCell::kChildren[child], false};
    }
    if (coords[0] + coords[1] > 0.5) {
        return {std::size_t(sector + 1 - shape.GetFirstSector()), &HalfCell::kFromSector, false};
    }
    return {0, &kToFFace, true};
}

Pair CellStep::Apply(Pair const &coords) const {
    Pair const ofChild = map->Apply(coords);
    return isChildWhole ? ClampToSector(ofChild) : clampToHalf(ofChild);
}

int FindCellCorner(FaceShape shape, int sector, Pair const &coords) {
    if (shape.size > 0) {
        return coords == Pair{1, 0}   ? sector
               : coords == Pair{0, 1} ? (sector + 1) % shape.size
                                      : -1;
    }
    auto const *const corner =
        std::find(std::begin(HalfCell::kCorners), std::end(HalfCell::kCorners), coords);
    return corner == std::end(HalfCell::kCorners) ? -1 : int(corner - HalfCell::kCorners);
}

namespace {

void add(std::vector<double> &sum, double factor, std::vector<double> const &row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
        sum[i] += factor * row[i];
    }
}

// Turns weights of what is behind some steps into those of what it is before them, or behind the first.
void goBack(std::vector<ChildStep const *> const &steps, StencilOf of, std::vector<double> &weights,
            std::vector<double> &scratch) {
    for (std::size_t i = steps.size(); i-- > 0;) {
        if (i == 0 && of == StencilOf::Step) {
            steps[i]->Spread(weights, scratch);
        } else {
            steps[i]->ApplyLeft(weights, scratch);
        }
        weights.swap(scratch);
    }
}

} // namespace

int CellStencil::Place::FindCorner() const {
    return FindCellCorner(type->GetShape(), sector, coords);
}

void CellStencil::Place::FindCornerWeights(std::vector<double> &weights) const {
    if (!type->IsWhole()) {
        std::array<double, 4> const ofHalf = HalfCell::GetCornerWeights(coords);
        weights.assign(ofHalf.begin(), ofHalf.end());
        return;
    }
    auto const numCorners = std::size_t(type->GetNumCorners());
    double const inner = 1 - coords[0] - coords[1];
    if (type->IsHalfPolygon()) { // of the centre, in the middle of the long edge
        weights.assign(numCorners, 0.0);
        weights[0] = weights[1] = 0.5 * inner;
    } else {
        weights.assign(numCorners, inner / double(numCorners));
    }
    weights[std::size_t(sector)] += coords[0];
    weights[(std::size_t(sector) + 1) % numCorners] += coords[1];
}

std::vector<Pair> CellStencil::Place::FindCornersInPlane() const {
    std::vector<Pair> corners;
    if (type->IsWhole()) {
        BasePolygon const polygon(type->GetShape());
        Pair mean = {0, 0};
        for (int i = 0; type->IsHalfPolygon() && i < polygon.GetSize(); ++i) {
            Pair const corner = polygon.GetCorner(i);
            mean = {mean[0] + corner[0] / polygon.GetSize(),
                    mean[1] + corner[1] / polygon.GetSize()};
        }
        for (int i = 0; i < polygon.GetSize(); ++i) {
            Pair const corner = polygon.GetCorner(i);
            corners.push_back(
                {std::ldexp(corner[0] - mean[0], -depth), std::ldexp(corner[1] - mean[1], -depth)});
        }
        return corners;
    }
    auto const &[x, h] = toCoords; // by u and v
    double const determinant = x[0] * h[1] - x[1] * h[0];
    constexpr Pair kMean = {0.5, 0.25};
    for (Pair const &corner : HalfCell::kCorners) {
        Pair const p = {corner[0] - kMean[0], corner[1] - kMean[1]};
        corners.push_back(
            {(h[1] * p[0] - x[1] * p[1]) / determinant, (x[0] * p[1] - h[0] * p[0]) / determinant});
    }
    return corners;
}

void CellStencil::Place::AddDerivatives(std::size_t corner, double weight,
                                        std::vector<double> const (&derivatives)[2],
                                        std::vector<double> *byUv) const {
    Pair ofCorner[2] = {toCoords[0], toCoords[1]};
    if (type->IsWhole()) {
        // The corner has the coordinates of its own sector, larger by what the steps have made them.
        std::copy_n(MakeCornerPoint(type->GetShape(), int(corner), depth).toCoords, 2, ofCorner);
    }
    for (std::size_t k = 0; k < 2; ++k) {
        add(byUv[k], weight * ofCorner[0][k], derivatives[0]);
        add(byUv[k], weight * ofCorner[1][k], derivatives[1]);
    }
}

bool CellStencil::isLast(Place const &place) const {
    return place.depth >= kLastDepth ||
           (place.depth >= kRegularDepth && !place.type->IsWhole() &&
            place.type->HasBoundedCurvature() && place.type->IsRegular());
}

CellStencil::Place CellStencil::begin(BasePoint const &point) {
    _steps.clear();
    return {&_root, 0, point.sector, point.coords, {point.toCoords[0], point.toCoords[1]}};
}

// To the child that has the point.
void CellStencil::takeStep(Place &place) {
    CellStep const step = FindCellStep(place.type->GetShape(), place.sector, place.coords);
    CellType::Child const &next = place.type->GetChildren()[step.child];
    place.coords = step.Apply(place.coords);
    Multiply(step.map->rows, place.toCoords, place.toCoords);
    place.type = next.type;
    ++place.depth;
    _steps.push_back(&next.step);
}

void CellStencil::addCorner(Place const &place, std::size_t corner, double weight,
                            bool hasDerivatives) {
    add(_weights[0], weight, place.type->GetCornerPoints()[corner]);
    if (hasDerivatives) {
        place.AddDerivatives(corner, weight, place.type->GetDerivatives(int(corner)).rows,
                             _weights + 1);
    }
}

// Takes the steps back, and from derivatives what rounding has left.
void CellStencil::finish(std::size_t firstKind, std::size_t endKind) {
    for (std::size_t kind = firstKind; kind < endKind; ++kind) {
        std::vector<double> &weights = _weights[kind];
        goBack(_steps, _of, weights, _scratch);
        // Steps shrink all that rounding has left of differences between near points but their sum.
        double const sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        add(weights, -sum, _weights[0]);
    }
}

void CellStencil::Find(BasePoint const &point, bool hasDerivatives) {
    Place place = begin(point);
    // A corner that is there before the step has its derivatives from there.
    Place const root = place;
    int const rootCorner = _of == StencilOf::Step && hasDerivatives ? root.FindCorner() : -1;
    int corner = -1;
    while (((corner = place.FindCorner()) < 0 && !isLast(place)) ||
           (_of == StencilOf::Step && _steps.empty())) {
        takeStep(place);
    }

    hasDerivatives = hasDerivatives && rootCorner < 0;
    int const numRows = hasDerivatives ? 3 : 1;
    for (int i = 0; i < numRows; ++i) {
        _weights[i].assign(std::size_t(place.type->GetNumPoints()), 0.0);
    }
    if (corner >= 0) {
        addCorner(place, std::size_t(corner), 1, hasDerivatives);
    } else {
        place.FindCornerWeights(_cornerWeights);
        for (std::size_t i = 0; i < _cornerWeights.size(); ++i) {
            addCorner(place, i, _cornerWeights[i], hasDerivatives);
        }
    }
    goBack(_steps, _of, _weights[0], _scratch);
    finish(1, hasDerivatives ? 3 : 1);
    if (rootCorner >= 0) {
        _weights[1].assign(_weights[0].size(), 0.0);
        _weights[2] = _weights[1];
        root.AddDerivatives(std::size_t(rootCorner), 1,
                            root.type->GetDerivatives(rootCorner, _of).rows, _weights + 1);
    }
}

void CellStencil::FindSecond(BasePoint const &point) {
    assert(_of == StencilOf::Points);
    Place place = begin(point);
    // A corner of a cell without such derivatives is in one with them some steps on, or never.
    while (SecondDerivatives::Find(*place.type).Exist()
               ? place.FindCorner() < 0 && place.depth < kRegularDepth
               : place.depth < kDepthOfDifferences) {
        takeStep(place);
    }
    for (std::size_t kind = 3; kind < std::size(_weights); ++kind) {
        _weights[kind].assign(std::size_t(place.type->GetNumPoints()), 0.0);
    }
    if (SecondDerivatives::Find(*place.type).Exist()) {
        addSecondAtCorners(place);
    } else {
        addSecondBetweenCorners(place);
    }
    finish(3, std::size(_weights));
}

void CellStencil::addSecondAtCorners(Place const &place) {
    SecondDerivatives const &derivatives = SecondDerivatives::Find(*place.type);
    place.FindCornerWeights(_cornerWeights);
    for (std::size_t corner = 0; corner < _cornerWeights.size(); ++corner) {
        SecondDerivatives::Rows byUv = derivatives.AtCorner(corner);
        SecondDerivatives::Turn(place.toCoords, byUv);
        for (std::size_t k = 0; k < byUv.size(); ++k) {
            add(_weights[3 + k], _cornerWeights[corner], byUv[k]);
        }
    }
}

// The slopes of the linear functions that are nearest to the first derivatives at the corners.
void CellStencil::addSecondBetweenCorners(Place const &place) {
    std::vector<Pair> const corners = place.FindCornersInPlane();
    double uu = 0;
    double uv = 0;
    double vv = 0;
    for (auto const &[u, v] : corners) {
        uu += u * u;
        uv += u * v;
        vv += v * v;
    }
    double const determinant = uu * vv - uv * uv;
    std::vector<double> byUv[2];
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (std::vector<double> &row : byUv) {
            row.assign(std::size_t(place.type->GetNumPoints()), 0.0);
        }
        place.AddDerivatives(i, 1, place.type->GetDerivatives(int(i)).rows, byUv);
        auto const [u, v] = corners[i];
        Pair const slope = {(vv * u - uv * v) / determinant, (uu * v - uv * u) / determinant};
        add(_weights[3], slope[0], byUv[0]);
        add(_weights[4], 0.5 * slope[1], byUv[0]);
        add(_weights[4], 0.5 * slope[0], byUv[1]);
        add(_weights[5], slope[1], byUv[1]);
    }
}

std::vector<double> FindBorderStencil(CellType const &root, double point, StencilOf of) {
    std::vector<ChildStep const *> steps;
    CellType const *type = &root;
    bool const isVertex = root.GetNumCorners() == 1;
    auto const isAtEnd = [&] { return isVertex || point == 0 || point == 1; };
    for (int depth = 0; depth < kLastDepth; ++depth) {
        if (isAtEnd() && (of == StencilOf::Points || !steps.empty())) {
            break;
        }
        std::vector<CellType::Child> const &children = type->GetChildren();
        std::size_t child = 0;
        if (children.size() > 1) {
            // The edges at both ends run to the middle.
            child = point < 0.25 ? 0 : point > 0.75 ? 2 : 1;
            point = child == 0 ? 4 * point : child == 1 ? 2 * point - 0.5 : 4 * (1 - point);
        }
        steps.push_back(&children[child].step);
        type = children[child].type;
    }
    std::vector<std::vector<double>> const &ends = type->GetCornerPoints();
    std::vector<double> weights = ends[point == 1 && !isVertex ? 1 : 0];
    for (std::size_t i = 0; !isAtEnd() && i < weights.size(); ++i) {
        weights[i] = (1 - point) * ends[0][i] + point * ends[1][i];
    }
    std::vector<double> scratch;
    goBack(steps, of, weights, scratch);
    return weights;
}

} // namespace OpenSubdivHex::BfrExt::internal

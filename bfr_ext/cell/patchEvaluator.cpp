// SPDX-License-Identifier: Apache-2.0
#include "patchEvaluator.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Whether a leaf is taken apart.
bool isLarge(CellType const &type, CellPlan::Node const &leaf) {
    constexpr int kMaxPoints = 128;
    return type.GetNumPoints() > kMaxPoints && leaf.numSteps > 0;
}

// Returns the derivatives of a face at the start of an edge, by the coordinates in the edge's sector, from the
// points of the child beside the edge.
template <typename REAL>
PlaceMatrix<REAL> const &getFaceDerivatives(PlaceSource<REAL> const &child) {
    constexpr int kKind = PatternTable::GetKind<REAL>(PatternOf::FaceCorner);
    return child.GetPatterns().template Get<PlaceMatrix<REAL>>(kKind, nullptr, nullptr, [&] {
        CellType::Derivatives derivatives = child.type->GetDerivatives(0, child.GetSources(), true);
        HalfCell::kFromSector.TurnDerivatives(derivatives.rows);
        return child.MakeMatrix(2, [&](std::size_t k) { return derivatives.rows[k]; });
    });
}

// Returns the derivatives of a child at its own corner; the child is evaluated behind another step.
template <typename REAL>
PlaceMatrix<REAL> const &getCornerDerivatives(PlaceSource<REAL> const &child, int corner) {
    constexpr int kKind = PatternTable::GetKind<REAL>(PatternOf::ChildCorner);
    return child.GetPatterns().template Get<PlaceMatrix<REAL>>(kKind, &corner, &corner + 1, [&] {
        auto const &rows = child.type->GetDerivatives(corner, child.GetSources()).rows;
        return child.MakeMatrix(2, [&](std::size_t k) { return rows[k]; });
    });
}

} // namespace

template <typename REAL>
void PatchEvaluator<REAL>::begin(CellPlan const &plan, std::size_t size, REAL *const *results,
                                 std::ptrdiff_t resultStride) {
    _size = size;
    _paddedSize = StepMatrix::GetPaddedSize(size);
    _hasDerivatives = plan.HasDerivatives();
    _results[0] = results[0];
    _results[1] = _hasDerivatives ? results[1] : nullptr;
    _resultStride = resultStride;
}

template <typename REAL>
void PatchEvaluator<REAL>::Evaluate(CellType const &type, CellPlan const &plan, int size,
                                    REAL const *controlPoints, std::ptrdiff_t stride,
                                    REAL *const *results, std::ptrdiff_t resultStride) {
    begin(plan, std::size_t(size), results, resultStride);
    bool const isTakenApart = plan[0].leaf && isLarge(type, plan[0]);
    if (plan[0].leaf && !isTakenApart) {
        evaluateLeaf({&type, nullptr, controlPoints, stride, nullptr}, plan[0]);
        return;
    }
    auto const numPoints = std::size_t(type.GetNumPoints());
    std::vector<REAL> &points = getPoints(0, numPoints);
    for (std::size_t i = 0; i < numPoints; ++i) {
        StepMatrix::Pad(controlPoints + std::ptrdiff_t(i) * stride, _size,
                        &points[i * _paddedSize]);
    }
    descend(type, isTakenApart ? plan.TakeApart(plan[0]) : plan, 0, 0);
}

// Makes the points of all children of a cell, whose own are at twice the depth; those of one child at a
// time are behind these.
template <typename REAL>
void PatchEvaluator<REAL>::descend(CellType const &type, CellPlan const &plan, std::size_t node,
                                   std::size_t depth) {
    std::vector<REAL> const &ownPoints = getPoints(2 * depth, 0);
    if (!plan[node].corners.empty()) {
        evaluateCorners(type, plan[node], ownPoints.data());
    }
    if (plan[node].children.empty()) {
        return;
    }
    StepMatrix const &step = type.GetStep();
    step.Apply(ownPoints.data(), _paddedSize, getPoints(2 * depth + 1, step.GetNumRows()).data());
    descendToChildren(type, plan, node, depth);
}

// From what the step of the cell has made.
template <typename REAL>
void PatchEvaluator<REAL>::descendToChildren(CellType const &type, CellPlan const &plan,
                                             std::size_t node, std::size_t depth) {
    std::vector<REAL> const &points = getPoints(2 * depth + 1, 0);
    for (std::size_t const next : plan[node].children) {
        CellPlan::Node const &child = plan[next];
        CellType::Child const &link = type.GetChildren()[child.child];
        std::vector<REAL> &childPoints = getPoints(2 * depth + 2, link.step.GetNumRows());
        link.step.CopyPoints(points.data(), _paddedSize, childPoints.data());
        if (!child.leaf) {
            descend(*link.type, plan, next, depth + 1);
        } else if (isLarge(*link.type, child)) {
            descend(*link.type, plan.TakeApart(child), 0, depth + 1);
        } else {
            evaluateLeaf(
                {link.type, nullptr, childPoints.data(), std::ptrdiff_t(_paddedSize), nullptr},
                child);
        }
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::Evaluate(PlainFaceType const &type, RingValues<REAL> &values,
                                    CellPlan const &plan, REAL *const *results,
                                    std::ptrdiff_t resultStride) {
    begin(plan, values.GetSize(), results, resultStride);
    FaceRings const &face = type.GetRings();
    for (CellPlan::CornerPlace const &corner : plan[0].corners) {
        auto const source = FindChildSource(face, corner.corner + 1, values, _indices);
        evaluateCorner(source, getFaceDerivatives(source), corner);
    }
    for (std::size_t const next : plan[0].children) {
        CellPlan::Node const &child = plan[next];
        auto const source = FindChildSource(face, child.child, values, _indices);
        if (child.leaf) {
            evaluateLeaf(source, child);
            continue;
        }
        RingCell const &cell = *source.ringCell;
        for (std::size_t i = 0; cell.IsInner() && i < child.corners.size(); ++i) {
            CellPlan::CornerPlace const &corner = child.corners[i];
            evaluateCorner(source, getCornerDerivatives(source, int(corner.corner)), corner);
        }
        std::vector<int> const &columns = cell.GetColumns();
        std::vector<REAL> &points = getPoints(cell.IsInner() ? 3 : 2, columns.size());
        for (std::size_t i = 0; i < columns.size(); ++i) {
            StepMatrix::CopyPadded(source.points + std::size_t(_indices[i]) * _paddedSize,
                                   _paddedSize, &points[std::size_t(columns[i]) * _paddedSize]);
        }
        if (cell.IsInner()) {
            descendToChildren(cell.GetType(), plan, next, 1);
        } else {
            descend(cell.GetType(), plan, next, 1);
        }
    }
}

// The matrices of a leaf are made when they are first asked for.
template <typename REAL>
void PatchEvaluator<REAL>::evaluateLeaf(PlaceSource<REAL> const &source,
                                        CellPlan::Node const &leaf) {
    if (leaf.runs.empty()) {
        return; // none would stand for all
    }
    LeafPlaces const &places = *leaf.leaf;
    auto const make = [&] {
        std::vector<BfrPlace> all;
        for (std::size_t row = 0; row < places.GetSize(); ++row) {
            auto const &[sector, coords] = places[row];
            BasePoint const point = source.type->IsWhole()
                                        ? MakeBasePoint(source.type->GetShape(), sector, coords)
                                        : BasePoint{sector, coords, {{1, 0}, {0, 1}}};
            all.push_back({point, {{1, 0}, {0, 1}}, {}});
        }
        return source.MakeMatrices(all, _hasDerivatives);
    };
    int const numSteps = places.GetNumSteps();
    PatternOf const of = _hasDerivatives ? PatternOf::LeafDerivatives : PatternOf::Leaf;
    source.Evaluate(source.GetPatterns().template Get<typename PlaceSource<REAL>::Matrices>(
                        PatternTable::GetKind<REAL>(of), &numSteps, &numSteps + 1, make),
                    _size, _results, _resultStride, &leaf.runs);
    if (_hasDerivatives) {
        turnDerivatives(leaf);
    }
}

// Turns derivatives by the coordinates of a leaf into derivatives by u and v.
template <typename REAL>
void PatchEvaluator<REAL>::turnDerivatives(CellPlan::Node const &leaf) const {
    auto const &[first, second] = leaf.toCoords;
    if (first == Pair{1, 0} && second == Pair{0, 1}) {
        return;
    }
    for (PlaceRun const &run : leaf.runs) {
        for (int i = 0; i < run.count; ++i) {
            std::ptrdiff_t const place = std::ptrdiff_t(run.place + i) * _resultStride;
            REAL *const du = _results[0] + place;
            REAL *const dv = _results[1] + place;
            TurnDerivatives(leaf.toCoords, _size, du, dv, du, dv);
        }
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluateCorners(CellType const &type, CellPlan::Node const &cell,
                                           REAL const *points) {
    auto const sumUp = [&](std::vector<double> const &weights, REAL *result) {
        SumUp(weights.data(), weights.size(), points, nullptr, _size, std::ptrdiff_t(_paddedSize),
              result);
    };
    _derivatives.resize(2 * _size);
    for (CellPlan::CornerPlace const &corner : cell.corners) {
        if (!_hasDerivatives) {
            sumUp(type.GetCornerPoints()[corner.corner],
                  _results[0] + std::ptrdiff_t(corner.place) * _resultStride);
            continue;
        }
        auto const &rows = type.GetDerivatives(int(corner.corner)).rows;
        sumUp(rows[0], _derivatives.data());
        sumUp(rows[1], _derivatives.data() + _size);
        writeDerivatives(corner);
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluateCorner(PlaceSource<REAL> const &source,
                                          PlaceMatrix<REAL> const &derivatives,
                                          CellPlan::CornerPlace const &corner) {
    _derivatives.resize(2 * _size);
    source.Evaluate(derivatives, _size, _derivatives.data(), std::ptrdiff_t(_size));
    writeDerivatives(corner);
}

// Writes the derivatives by u and v, from those by the coordinates of the corner.
template <typename REAL>
void PatchEvaluator<REAL>::writeDerivatives(CellPlan::CornerPlace const &corner) {
    std::ptrdiff_t const place = std::ptrdiff_t(corner.place) * _resultStride;
    TurnDerivatives(corner.toCoords, _size, _derivatives.data(), _derivatives.data() + _size,
                    _results[0] + place, _results[1] + place);
}

// With room for some points at least.
template <typename REAL>
std::vector<REAL> &PatchEvaluator<REAL>::getPoints(std::size_t place, std::size_t numPoints) {
    while (_points.size() <= place) {
        _points.emplace_back();
    }
    std::vector<REAL> &points = _points[place];
    points.resize(std::max(points.size(), numPoints * _paddedSize));
    return points;
}

template class PatchEvaluator<float>;
template class PatchEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

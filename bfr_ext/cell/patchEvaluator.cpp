// SPDX-License-Identifier: Apache-2.0
#include "patchEvaluator.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Whether a leaf is taken apart.
bool isLarge(CellType const &type, CellPlan::Node const &leaf) {
    constexpr int kMaxPoints = 128;
    return type.GetNumPoints() > kMaxPoints && leaf.numSteps > 0;
}

// A leaf: a cell of some type, of whose rings its points may be those.
struct Leaf {
    CellType const &type;
    RingCell const *ringCell;
    LeafPlaces const &places;

    // Expands a sum of the points of the type into one of the points of the rings.
    std::vector<double> const &Order(std::vector<double> const &weights,
                                     std::vector<double> &scratch) const {
        if (!ringCell) {
            return weights;
        }
        ringCell->GetPlaces().Order(weights, scratch);
        return scratch;
    }

    StencilOf GetStencilOf() const {
        return ringCell && ringCell->IsInner() ? StencilOf::Step : StencilOf::Points;
    }
    std::size_t GetNumPoints() const {
        return ringCell ? ringCell->GetColumns().size() : std::size_t(type.GetNumPoints());
    }
};

// Weights of some places, by point.
using Rows = std::vector<std::vector<double>>;

// Matrices that evaluate a leaf.
template <typename REAL, std::size_t COUNT>
using LeafMatrices = std::array<PlaceMatrix<REAL>, COUNT>;

// Makes matrices of a leaf, the rows of which find(stencil, place) finds, and getRow(stencil, i) gives.
template <typename REAL, std::size_t COUNT, typename FIND, typename GET>
LeafMatrices<REAL, COUNT> makeMatrices(Leaf const &leaf, FIND const &find, GET const &getRow) {
    CellStencil stencil(leaf.type, leaf.GetStencilOf());
    Rows rows(leaf.places.GetSize() * COUNT);
    std::vector<double> scratch;
    for (std::size_t row = 0; row < leaf.places.GetSize(); ++row) {
        find(stencil, leaf.places[row]);
        for (std::size_t i = 0; i < COUNT; ++i) {
            rows[row * COUNT + i] = leaf.Order(getRow(stencil, i), scratch);
        }
    }
    LeafMatrices<REAL, COUNT> result;
    result.fill(PlaceMatrix<REAL>(leaf.places.GetSize(), rows[0].size()));
    for (std::size_t row = 0; row < rows.size(); ++row) {
        result[row % COUNT].Set(row / COUNT, rows[row]);
    }
    return result;
}

// The matrices of a leaf for points, or for derivatives, are made when they are first asked for.
template <typename REAL, std::size_t COUNT, typename FIND, typename GET>
LeafMatrices<REAL, COUNT> const &getMatrices(PatternOf of, Leaf const &leaf, FIND const &find,
                                             GET const &getRow) {
    int const numSteps = leaf.places.GetNumSteps();
    PatternTable &patterns = leaf.ringCell ? leaf.ringCell->GetPatterns() : leaf.type.GetPatterns();
    return patterns.Get<LeafMatrices<REAL, COUNT>>(
        PatternTable::GetKind<REAL>(of), &numSteps, &numSteps + 1,
        [&] { return makeMatrices<REAL, COUNT>(leaf, find, getRow); });
}

template <typename REAL>
LeafMatrices<REAL, 1> const &getPointMatrices(Leaf const &leaf) {
    return getMatrices<REAL, 1>(
        PatternOf::Leaf, leaf,
        [](CellStencil &stencil, LeafPlaces::Place const &place) {
            stencil.Find({place.sector, place.coords, {}}, false);
        },
        [](CellStencil const &stencil, std::size_t) -> std::vector<double> const & {
            return stencil.GetWeights();
        });
}

// Two places: derivatives, of which getRow(k) gives the rows as of the type.
template <typename REAL, typename GET>
PlaceMatrix<REAL> makeDerivatives(RingCell const &cell, GET const &getRow) {
    PlaceMatrix<REAL> matrix(2, cell.GetColumns().size());
    std::vector<double> ordered;
    for (std::size_t k = 0; k < 2; ++k) {
        cell.GetPlaces().Order(getRow(k), ordered);
        matrix.Set(k, ordered);
    }
    return matrix;
}

// Returns the derivatives of a face at the start of an edge, by the coordinates in the edge's sector, from the
// points of the child beside the edge.
template <typename REAL>
PlaceMatrix<REAL> const &getFaceDerivatives(RingCell const &child) {
    constexpr int kKind = PatternTable::GetKind<REAL>(PatternOf::FaceCorner);
    return child.GetPatterns().Get<PlaceMatrix<REAL>>(kKind, nullptr, nullptr, [&] {
        CellType const &type = child.GetType();
        CellType::Derivatives const &derivatives =
            child.IsInner() ? type.GetParentDerivativesOfStep(0) : type.GetParentDerivatives(0);
        return makeDerivatives<REAL>(child, [&](std::size_t k) {
            return HalfCell::kFromSector.GetDerivatives(derivatives.rows, k);
        });
    });
}

// Returns the derivatives of a child at its own corner; the child is evaluated behind another step.
template <typename REAL>
PlaceMatrix<REAL> const &getCornerDerivatives(RingCell const &child, int corner) {
    constexpr int kKind = PatternTable::GetKind<REAL>(PatternOf::ChildCorner);
    return child.GetPatterns().Get<PlaceMatrix<REAL>>(kKind, &corner, &corner + 1, [&] {
        CellType::Derivatives const &derivatives = child.GetType().GetDerivativesOfStep(corner);
        return makeDerivatives<REAL>(child, [&](std::size_t k) -> std::vector<double> const & {
            return derivatives.rows[k];
        });
    });
}

} // namespace

template <typename REAL>
void PatchEvaluator<REAL>::Evaluate(CellType const &type, CellPlan const &plan, int size,
                                    REAL const *controlPoints, std::ptrdiff_t stride, REAL *results,
                                    std::ptrdiff_t resultStride) {
    _results = results;
    _resultStride = resultStride;
    evaluate(type, plan, size, controlPoints, stride);
}

template <typename REAL>
void PatchEvaluator<REAL>::EvaluateDerivatives(CellType const &type, CellPlan const &plan, int size,
                                               REAL const *controlPoints, std::ptrdiff_t stride,
                                               REAL *du, REAL *dv, std::ptrdiff_t resultStride) {
    _results = nullptr;
    _derivatives[0] = du;
    _derivatives[1] = dv;
    _resultStride = resultStride;
    evaluate(type, plan, size, controlPoints, stride);
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluate(CellType const &type, CellPlan const &plan, int size,
                                    REAL const *controlPoints, std::ptrdiff_t stride) {
    _size = std::size_t(size);
    _paddedSize = StepMatrix::GetPaddedSize(_size);
    bool const isTakenApart = plan[0].leaf && isLarge(type, plan[0]);
    if (plan[0].leaf && !isTakenApart) {
        if (!plan[0].runs.empty()) {
            evaluateLeaf(type, nullptr, plan[0], controlPoints, stride, nullptr);
        }
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
            evaluateLeaf(*link.type, nullptr, child, childPoints.data(),
                         std::ptrdiff_t(_paddedSize), nullptr);
        }
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::Evaluate(PlainFaceType const &type, RingValues<REAL> &values,
                                    CellPlan const &plan, REAL *results,
                                    std::ptrdiff_t resultStride) {
    _results = results;
    _resultStride = resultStride;
    evaluate(type, values, plan);
}

template <typename REAL>
void PatchEvaluator<REAL>::EvaluateDerivatives(PlainFaceType const &type, RingValues<REAL> &values,
                                               CellPlan const &plan, REAL *du, REAL *dv,
                                               std::ptrdiff_t resultStride) {
    _results = nullptr;
    _derivatives[0] = du;
    _derivatives[1] = dv;
    _resultStride = resultStride;
    evaluate(type, values, plan);
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluate(PlainFaceType const &type, RingValues<REAL> &values,
                                    CellPlan const &plan) {
    _size = values.GetSize();
    _paddedSize = values.GetPaddedSize();
    FaceRings const &face = type.GetRings();
    REAL const *const ofRings = values.GetPoints();
    evaluateCorners(face, values, plan[0]);
    for (std::size_t const next : plan[0].children) {
        CellPlan::Node const &child = plan[next];
        RingCell const &cell = face.GetChild(child.child);
        std::vector<int> const &columns = cell.GetColumns();
        values.FindChildIndices(face, child.child, _indices);
        if (child.leaf) {
            evaluateLeaf(cell.GetType(), &cell, child, ofRings, std::ptrdiff_t(_paddedSize),
                         _indices.data());
            continue;
        }
        if (cell.IsInner()) {
            evaluateCorners(cell, child, ofRings);
        }
        std::vector<REAL> &points = getPoints(cell.IsInner() ? 3 : 2, columns.size());
        for (std::size_t i = 0; i < columns.size(); ++i) {
            StepMatrix::CopyPadded(ofRings + std::size_t(_indices[i]) * _paddedSize, _paddedSize,
                                   &points[std::size_t(columns[i]) * _paddedSize]);
        }
        if (cell.IsInner()) {
            descendToChildren(cell.GetType(), plan, next, 1);
        } else {
            descend(cell.GetType(), plan, next, 1);
        }
    }
}

// The points are those of the type, or of the rings that it is told as a cell of.
template <typename REAL>
void PatchEvaluator<REAL>::evaluateLeaf(CellType const &type, RingCell const *ringCell,
                                        CellPlan::Node const &leaf, REAL const *points,
                                        std::ptrdiff_t stride, int const *indices) {
    assert(!leaf.runs.empty()); // none would stand for all
    Leaf const ofLeaf = {type, ringCell, *leaf.leaf};
    if (_results) {
        SumUpPlaces(getPointMatrices<REAL>(ofLeaf)[0],
                    {points, stride, _size, indices, _results, _resultStride, leaf.runs.data(),
                     leaf.runs.size()});
        return;
    }
    auto const &matrices = getMatrices<REAL, 2>(
        PatternOf::LeafDerivatives, ofLeaf,
        [&](CellStencil &stencil, LeafPlaces::Place const &place) {
            stencil.Find(type.IsWhole() ? MakeBasePoint(type.GetShape(), place.sector, place.coords)
                                        : BasePoint{place.sector, place.coords, {{1, 0}, {0, 1}}},
                         true);
        },
        [](CellStencil const &stencil, std::size_t i) -> std::vector<double> const & {
            return i == 0 ? stencil.GetDuWeights() : stencil.GetDvWeights();
        });
    for (std::size_t i = 0; i < 2; ++i) {
        SumUpPlaces(matrices[i], {points, stride, _size, indices, _derivatives[i], _resultStride,
                                  leaf.runs.data(), leaf.runs.size()});
    }
    turnDerivatives(leaf);
}

// Turns derivatives by the coordinates of a leaf into derivatives by u and v.
template <typename REAL>
void PatchEvaluator<REAL>::turnDerivatives(CellPlan::Node const &leaf) const {
    auto const &[first, second] = leaf.toCoords;
    if (first == Pair{1, 0} && second == Pair{0, 1}) {
        return;
    }
    REAL const factors[2][2] = {{REAL(first[0]), REAL(second[0])},
                                {REAL(first[1]), REAL(second[1])}};
    for (PlaceRun const &run : leaf.runs) {
        std::ptrdiff_t place = std::ptrdiff_t(run.place) * _resultStride;
        for (int i = 0; i < run.count; ++i, place += _resultStride) {
            for (std::ptrdiff_t k = place; k < place + std::ptrdiff_t(_size); ++k) {
                REAL const along = _derivatives[0][k];
                REAL const across = _derivatives[1][k];
                _derivatives[0][k] = factors[0][0] * along + factors[0][1] * across;
                _derivatives[1][k] = factors[1][0] * along + factors[1][1] * across;
            }
        }
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluateCorners(CellType const &type, CellPlan::Node const &cell,
                                           REAL const *points) {
    auto const sum = [&](std::vector<double> const &weights, std::size_t k) {
        double result = 0;
        REAL const *point = points + k;
        for (double const weight : weights) {
            result += weight * double(*point);
            point += _paddedSize;
        }
        return result;
    };
    for (CellPlan::CornerPlace const &corner : cell.corners) {
        std::ptrdiff_t const first = std::ptrdiff_t(corner.place) * _resultStride;
        if (_results) {
            for (std::size_t k = 0; k < _size; ++k) {
                _results[first + std::ptrdiff_t(k)] =
                    REAL(sum(type.GetCornerPoints()[corner.corner], k));
            }
            continue;
        }
        CellType::Corner const &ofType = type.GetCorners()[corner.corner];
        for (std::size_t k = 0; k < _size; ++k) {
            double const along[2] = {sum(ofType.derivatives[0], k), sum(ofType.derivatives[1], k)};
            for (std::size_t i = 0; i < 2; ++i) {
                _derivatives[i][first + std::ptrdiff_t(k)] =
                    REAL(corner.toCoords[0][i] * along[0] + corner.toCoords[1][i] * along[1]);
            }
        }
    }
}

// A base face, from the points of its rings.
template <typename REAL>
void PatchEvaluator<REAL>::evaluateCorners(FaceRings const &face, RingValues<REAL> &values,
                                           CellPlan::Node const &cell) {
    for (CellPlan::CornerPlace const &corner : cell.corners) {
        RingCell const &child = face.GetChild(corner.corner + 1);
        values.FindChildIndices(face, corner.corner + 1, _indices);
        evaluateCorner(getFaceDerivatives<REAL>(child), corner, values.GetPoints());
    }
}

// One of its children, whose indices are known.
template <typename REAL>
void PatchEvaluator<REAL>::evaluateCorners(RingCell const &child, CellPlan::Node const &cell,
                                           REAL const *points) {
    for (CellPlan::CornerPlace const &corner : cell.corners) {
        evaluateCorner(getCornerDerivatives<REAL>(child, int(corner.corner)), corner, points);
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluateCorner(PlaceMatrix<REAL> const &derivatives,
                                          CellPlan::CornerPlace const &corner, REAL const *points) {
    _along.resize(2 * _size);
    SumUpPlaces(derivatives, {points, std::ptrdiff_t(_paddedSize), _size, _indices.data(),
                              _along.data(), std::ptrdiff_t(_size)});
    std::ptrdiff_t const first = std::ptrdiff_t(corner.place) * _resultStride;
    for (std::size_t i = 0; i < 2; ++i) {
        REAL const factors[2] = {REAL(corner.toCoords[0][i]), REAL(corner.toCoords[1][i])};
        for (std::size_t k = 0; k < _size; ++k) {
            _derivatives[i][first + std::ptrdiff_t(k)] =
                factors[0] * _along[k] + factors[1] * _along[_size + k];
        }
    }
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

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

// Two places: derivatives, of which getRow(k) gives the rows as of the type.
template <typename REAL, typename GET>
PlaceMatrix<REAL> makeDerivatives(RingCell const &cell, GET const &getRow) {
    PlaceMatrix<REAL> matrix(2, cell.GetColumns().size());
    for (std::size_t k = 0; k < 2; ++k) {
        matrix.Set(k, cell.GetPlaces().Order(getRow(k)));
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
        CellType::Derivatives const &derivatives = type.GetDerivatives(0, child.GetSources(), true);
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
        CellType::Derivatives const &derivatives =
            child.GetType().GetDerivatives(corner, child.GetSources());
        return makeDerivatives<REAL>(child, [&](std::size_t k) -> std::vector<double> const & {
            return derivatives.rows[k];
        });
    });
}

} // namespace

// The derivatives are by Bfr's u and v.
template <typename REAL>
typename PlaceSource<REAL>::Matrices
PlaceSource<REAL>::MakeMatrices(std::vector<BfrPlace> const &places, bool hasDerivatives) const {
    StencilOf const of = ringCell ? ringCell->GetSources() : StencilOf::Points;
    CellStencil stencil(type, of);
    std::size_t const numColumns =
        ringCell ? ringCell->GetColumns().size() : std::size_t(type.GetNumPoints());
    Matrices result = {{}, hasDerivatives ? std::size_t(2) : std::size_t(1)};
    std::fill_n(result.matrices.begin(), result.count,
                PlaceMatrix<REAL>(places.size(), numColumns));
    auto const set = [&](std::size_t kind, std::size_t row, std::vector<double> const &weights) {
        result.matrices[kind].Set(row, ringCell ? ringCell->GetPlaces().Order(weights) : weights);
    };
    std::vector<double> derivative;
    for (std::size_t row = 0; row < places.size(); ++row) {
        BfrPlace const &place = places[row];
        stencil.Find(place.point, hasDerivatives);
        if (!hasDerivatives) {
            set(0, row, stencil.GetWeights());
            continue;
        }
        std::vector<double> const *along[2] = {&stencil.GetDuWeights(), &stencil.GetDvWeights()};
        // Vertices of the face have the derivatives of the face.
        if (ringCell && !type.IsWhole() && place.point.coords == HalfCell::kCorners[0]) {
            CellType::Derivatives const &ofFace = type.GetDerivatives(0, of, true);
            along[0] = &ofFace.rows[0];
            along[1] = &ofFace.rows[1];
        }
        for (std::size_t k = 0; k < 2; ++k) {
            derivative.resize(along[0]->size());
            for (std::size_t i = 0; i < derivative.size(); ++i) {
                derivative[i] =
                    place.toOwn[0][k] * (*along[0])[i] + place.toOwn[1][k] * (*along[1])[i];
            }
            set(k, row, derivative);
        }
    }
    return result;
}

template <typename REAL>
void PlaceSource<REAL>::Evaluate(Matrices const &matrices, std::size_t size, REAL *const *results,
                                 std::ptrdiff_t resultStride,
                                 std::vector<PlaceRun> const *runs) const {
    for (std::size_t i = 0; i < matrices.count; ++i) {
        SumUpPlaces(matrices.matrices[i], {points, stride, size, indices, results[i], resultStride,
                                           runs ? runs->data() : nullptr, runs ? runs->size() : 0});
    }
}

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
        evaluateLeaf({type, nullptr, controlPoints, stride, nullptr}, plan[0]);
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
                {*link.type, nullptr, childPoints.data(), std::ptrdiff_t(_paddedSize), nullptr},
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
    REAL const *const ofRings = values.GetPoints();
    auto const findIndices = [&](std::size_t child) -> RingCell const & {
        RingCell const &cell = face.GetChild(child);
        values.FindChildIndices(face, child, _indices);
        return cell;
    };
    for (CellPlan::CornerPlace const &corner : plan[0].corners) {
        evaluateCorner(getFaceDerivatives<REAL>(findIndices(corner.corner + 1)), corner, ofRings);
    }
    for (std::size_t const next : plan[0].children) {
        CellPlan::Node const &child = plan[next];
        RingCell const &cell = findIndices(child.child);
        if (child.leaf) {
            evaluateLeaf(
                {cell.GetType(), &cell, ofRings, std::ptrdiff_t(_paddedSize), _indices.data()},
                child);
            continue;
        }
        for (std::size_t i = 0; cell.IsInner() && i < child.corners.size(); ++i) {
            CellPlan::CornerPlace const &corner = child.corners[i];
            evaluateCorner(getCornerDerivatives<REAL>(cell, int(corner.corner)), corner, ofRings);
        }
        std::vector<int> const &columns = cell.GetColumns();
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
            BasePoint const point = source.type.IsWhole()
                                        ? MakeBasePoint(source.type.GetShape(), sector, coords)
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
    REAL const factors[2][2] = {{REAL(first[0]), REAL(second[0])},
                                {REAL(first[1]), REAL(second[1])}};
    for (PlaceRun const &run : leaf.runs) {
        std::ptrdiff_t place = std::ptrdiff_t(run.place) * _resultStride;
        for (int i = 0; i < run.count; ++i, place += _resultStride) {
            for (std::ptrdiff_t k = place; k < place + std::ptrdiff_t(_size); ++k) {
                REAL const along = _results[0][k];
                REAL const across = _results[1][k];
                _results[0][k] = factors[0][0] * along + factors[0][1] * across;
                _results[1][k] = factors[1][0] * along + factors[1][1] * across;
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
        if (!_hasDerivatives) {
            for (std::size_t k = 0; k < _size; ++k) {
                _results[0][first + std::ptrdiff_t(k)] =
                    REAL(sum(type.GetCornerPoints()[corner.corner], k));
            }
            continue;
        }
        CellType::Derivatives const &ofType = type.GetDerivatives(int(corner.corner));
        for (std::size_t k = 0; k < _size; ++k) {
            double const along[2] = {sum(ofType.rows[0], k), sum(ofType.rows[1], k)};
            for (std::size_t i = 0; i < 2; ++i) {
                _results[i][first + std::ptrdiff_t(k)] =
                    REAL(corner.toCoords[0][i] * along[0] + corner.toCoords[1][i] * along[1]);
            }
        }
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
            _results[i][first + std::ptrdiff_t(k)] =
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

template struct PlaceSource<float>;
template struct PlaceSource<double>;
template class PatchEvaluator<float>;
template class PatchEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

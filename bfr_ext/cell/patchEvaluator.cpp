// SPDX-License-Identifier: Apache-2.0
#include "patchEvaluator.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Numbers of a padded point that are computed with at once.
constexpr std::size_t kPadding = 4;

// Rows that are evaluated before their sums are handed out.
constexpr std::size_t kNumRowsAtOnce = 32;

// Copies the numbers of a point.
template <typename REAL>
void copyPoint(REAL const *from, std::size_t size, REAL *to) {
    if (size == 3) {
        to[0] = from[0];
        to[1] = from[1];
        to[2] = from[2];
    } else {
        std::copy_n(from, size, to);
    }
}

template <typename REAL>
void applyStep(StepMatrix const &step, REAL const *points, std::size_t stride, REAL *result) {
    std::size_t const numRows = step.GetNumRows();
    for (std::size_t row = 0; row < numRows; ++row) {
        for (std::size_t first = 0; first < stride; first += kPadding, result += kPadding) {
            REAL sums[kPadding] = {};
            step.ForEachEntry(row, [&](std::size_t parentPoint, double doubleWeight) {
                REAL const *const point = points + parentPoint * stride + first;
                REAL const weight = REAL(doubleWeight);
                for (std::size_t i = 0; i < kPadding; ++i) {
                    sums[i] += weight * point[i];
                }
            });
            std::copy(sums, sums + kPadding, result);
        }
    }
}

} // namespace

template <typename REAL>
LeafMatrix<REAL>::LeafMatrix(CellType const &type, LeafPlaces const &places)
    : numColumns(std::size_t(type.GetNumPoints())) {
    weights.reserve(places.GetSize() * numColumns);
    CellStencil stencil(type);
    for (std::size_t row = 0; row < places.GetSize(); ++row) {
        stencil.Find({places[row].sector, places[row].coords, {}}, false);
        for (double const weight : stencil.GetWeights()) {
            weights.push_back(REAL(weight));
        }
    }
}

template <typename REAL>
LeafMatrix<REAL> const &LeafMatrix<REAL>::Get(CellType const &type, LeafPlaces const &places) {
    // Patterns of tessellations have levels at the begin of their keys.
    constexpr int kKeyOfLeaves = -1;
    return type.GetPattern<LeafMatrix>({kKeyOfLeaves, places.GetNumSteps(), int(sizeof(REAL))},
                                       [&] { return LeafMatrix(type, places); });
}

template <typename REAL>
PatchEvaluator<REAL>::PatchEvaluator(int pointSize, std::size_t maxMemory)
    : _size(std::size_t(pointSize)), _maxMemory(maxMemory),
      _stride((_size + kPadding - 1) / kPadding * kPadding),
      _sums(kNumRowsAtOnce * kNumLanes * _size) {}

template <typename REAL>
void PatchEvaluator<REAL>::Add(CellType const &type, CellPlan const &plan,
                               REAL const *controlPoints, REAL *result) {
    if (_points.empty()) {
        _points.emplace_back();
    }
    auto const numPoints = std::size_t(type.GetNumPoints());
    _points[0].assign(numPoints * _stride, 0);
    for (std::size_t i = 0; i < numPoints; ++i) {
        copyPoint(controlPoints + i * _size, _size, &_points[0][i * _stride]);
    }
    descend(type, plan, 0, 0, result);
}

template <typename REAL>
void PatchEvaluator<REAL>::descend(CellType const &type, CellPlan const &plan, std::size_t node,
                                   std::size_t depth, REAL *result) {
    for (std::size_t const next : plan[node].children) {
        CellPlan::Node const &child = plan[next];
        CellType::Child const &childType = type.GetChildren()[child.child];
        if (_points.size() <= depth + 1) {
            _points.emplace_back();
        }
        std::vector<REAL> &points = _points[depth + 1];
        points.resize(
            std::max(points.size(), std::size_t(childType.type->GetNumPoints()) * _stride));
        applyStep(childType.step, _points[depth].data(), _stride, points.data());
        if (child.leaf) {
            addLeaf(*childType.type, child, points.data(), result);
        } else {
            descend(*childType.type, plan, next, depth + 1, result);
        }
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::addLeaf(CellType const &type, CellPlan::Node const &leaf,
                                   REAL const *points, REAL *result) {
    std::unique_ptr<Bucket> &found = _buckets[{&type, leaf.numSteps}];
    if (!found) {
        found = std::make_unique<Bucket>();
        found->matrix = &LeafMatrix<REAL>::Get(type, *leaf.leaf);
        found->block.resize(found->matrix->numColumns * kNumLanes * _size);
        found->numLanes = 0;
        _memory += sizeof(Bucket) + found->block.size() * sizeof(REAL);
    }
    Bucket &bucket = *found;
    if (bucket.numLanes == 0) {
        bucket.places = leaf.leaf;
        _waiting.push_back(&bucket);
    }
    REAL *lane = bucket.block.data() + bucket.numLanes * _size;
    for (std::size_t i = 0; i < bucket.matrix->numColumns; ++i) {
        copyPoint(points + i * _stride, _size, lane);
        lane += kNumLanes * _size;
    }
    bucket.leaves[bucket.numLanes] = &leaf;
    bucket.results[bucket.numLanes] = result;
    if (++bucket.numLanes == kNumLanes) {
        _waiting.erase(std::find(_waiting.begin(), _waiting.end(), &bucket));
        evaluate(bucket);
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::Finish() {
    for (Bucket *const bucket : _waiting) {
        evaluate(*bucket);
    }
    _waiting.clear();
    if (_memory > _maxMemory) {
        _buckets.clear();
        _memory = 0;
    }
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluate(Bucket &bucket) {
    unsigned groups = 0;
    for (std::size_t lane = 0; lane < bucket.numLanes; ++lane) {
        groups |= bucket.leaves[lane]->groups;
    }
    for (std::size_t group = 0; group < LeafPlaces::kNumGroups;) {
        std::size_t end = group;
        while (end < LeafPlaces::kNumGroups && (groups >> end & 1) == 1) {
            ++end;
        }
        for (std::size_t row = bucket.places->GetFirst(group); row < bucket.places->GetFirst(end);
             row += kNumRowsAtOnce) {
            evaluateRows(bucket, row, std::min(row + kNumRowsAtOnce, bucket.places->GetFirst(end)));
        }
        group = end + 1;
    }
    bucket.numLanes = 0;
}

template <typename REAL>
void PatchEvaluator<REAL>::evaluateRows(Bucket const &bucket, std::size_t begin, std::size_t end) {
    std::size_t const numColumns = bucket.matrix->numColumns;
    std::size_t const stride = kNumLanes * _size;
    // Whole registers, of which the rest is of no matter.
    std::size_t const width = (bucket.numLanes * _size + kNumLanes - 1) / kNumLanes * kNumLanes;
    Multiply({bucket.matrix->weights.data() + begin * numColumns, end - begin, numColumns,
              bucket.block.data(), stride, width, _sums.data(), stride});
    for (std::size_t lane = 0; lane < bucket.numLanes; ++lane) {
        int const *const places = bucket.leaves[lane]->placesOfRows.data();
        REAL *const result = bucket.results[lane];
        REAL const *sums = _sums.data() + lane * _size;
        for (std::size_t row = begin; row < end; ++row, sums += stride) {
            if (places[row] >= 0) {
                copyPoint(sums, _size, result + std::size_t(places[row]) * _size);
            }
        }
    }
}

template struct LeafMatrix<float>;
template struct LeafMatrix<double>;
template class PatchEvaluator<float>;
template class PatchEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

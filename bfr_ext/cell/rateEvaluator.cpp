// SPDX-License-Identifier: Apache-2.0
#include "rateEvaluator.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Places of a block, in full blocks of matrices.
constexpr std::size_t kBlockSize = 8 * PlaceMatrix<float>::kMaxWidth;
static_assert(kBlockSize % PlaceMatrix<double>::kMaxWidth == 0);
// Matrices of more points are not kept: for a quad with a rate of 64 they take half a megabyte.
constexpr std::size_t kMaxKeptPlaces = 4096;

// Calls function(matrices, begin) for blocks of matrices, which make(begin, end) makes of places [begin, end).
template <typename MATRICES, std::size_t SIZE, typename MAKE, typename FUNCTION>
void forEachBlock(PatternTable &patterns, int kind, std::array<int, SIZE> const &key,
                  std::size_t numPlaces, MAKE const &make, FUNCTION const &function) {
    std::array<int, SIZE + 1> blockKey = {};
    std::copy(key.begin(), key.end(), blockKey.begin());
    for (std::size_t begin = 0; begin < numPlaces; begin += kBlockSize, ++blockKey[SIZE]) {
        auto const makeBlock = [&] { return make(begin, std::min(begin + kBlockSize, numPlaces)); };
        if (numPlaces <= kMaxKeptPlaces) {
            int const *const first = blockKey.data();
            function(patterns.Get<MATRICES>(kind, first, first + blockKey.size(), makeBlock),
                     begin);
        } else {
            function(makeBlock(), begin);
        }
    }
}

// The places of a face in one of its children, and their numbers in the face.
std::vector<BfrPlace> selectPlaces(std::vector<BfrPlace> const &places, std::size_t child,
                                   FaceShape shape, std::vector<PlaceRun> &runs) {
    std::vector<BfrPlace> result;
    for (std::size_t i = 0; i < places.size(); ++i) {
        BasePoint const &point = places[i].point;
        CellStep const step = FindCellStep(shape, point.sector, point.coords);
        if (step.child == child) {
            runs.push_back({int(result.size()), int(i), 1});
            result.push_back(MoveToChild(places[i], step, shape));
        }
    }
    JoinRuns(runs);
    return result;
}

} // namespace

// Only quads have two inner rates.  Others have one, which follows from the number of places, as the place does if it
// is one.  The first place of a quad is one segment inside of the corner.
template <typename REAL>
RateEvaluator<REAL>::RateEvaluator(Bfr::Tessellation const &tessellation,
                                   BorderEvaluator<REAL> &border, REAL *const results[3],
                                   std::ptrdiff_t resultStride)
    : _tessellation(tessellation), _border(border), _results{results[0], results[1], results[2]},
      _resultStride(resultStride), _numInner(std::size_t(tessellation.GetNumInteriorCoords())) {
    bool const isQuad = tessellation.GetParameterization().GetType() == Bfr::Parameterization::QUAD;
    for (std::size_t i = 0; isQuad && _numInner > 1 && i < 2; ++i) {
        _innerRates[i] = tessellation.IsUniform() ? tessellation.GetNumEdgeCoords(0) + 1
                                                  : int(std::lround(1 / getInnerCoord(0)[i]));
    }
}

template <typename REAL>
Pair RateEvaluator<REAL>::getInnerCoord(std::size_t place) {
    auto const stride = std::size_t(_tessellation.GetCoordStride());
    if (_innerCoords.empty()) {
        _innerCoords.resize(_numInner * stride);
        _tessellation.GetInteriorCoords(_innerCoords.data());
    }
    return {_innerCoords[place * stride], _innerCoords[place * stride + 1]};
}

template <typename REAL>
void RateEvaluator<REAL>::Evaluate(CellType const &type, REAL const *points,
                                   std::ptrdiff_t stride) {
    Source const source = {{&type, nullptr, points, stride, nullptr}, 0};
    forEachEdge([&](int edge, int rate, int first) {
        evaluateBorder(edge, rate, first);
        if (_results[1]) {
            evaluateDerivativesOnEdge(source, edge, rate, first);
        }
    });
    evaluateInside(source);
}

template <typename REAL>
void RateEvaluator<REAL>::Evaluate(PlainFaceType const &type) {
    // Their memory is kept for the next face.
    static thread_local std::vector<int> indices;
    auto const getSource = [&](std::size_t child) -> Source {
        return {FindChildSource(type.GetRings(), child, _border.GetRingValues(), indices), child};
    };
    forEachEdge([&](int edge, int rate, int first) {
        evaluateBorder(edge, rate, first);
        Source const source = getSource(std::size_t(edge) + 1);
        evaluateInside(source);
        if (_results[1]) {
            evaluateDerivativesOnEdge(source, edge, rate, first);
        }
    });
    evaluateInside(getSource(0));
}

// Calls function(edge, rate, number of the place of its first vertex).
template <typename REAL>
template <typename FUNCTION>
void RateEvaluator<REAL>::forEachEdge(FUNCTION const &function) const {
    int first = 0;
    for (int edge = 0; edge < _tessellation.GetFaceSize(); ++edge) {
        int const rate = _tessellation.GetNumEdgeCoords(edge) + 1;
        function(edge, rate, first);
        first += rate;
    }
}

// Writes the points of an edge, and of the vertex where it begins.
template <typename REAL>
void RateEvaluator<REAL>::evaluateBorder(int edge, int rate, int first) const {
    if (rate > 1) {
        _border.EvaluateRate(std::size_t(edge), rate, getResult(0, first + 1), _resultStride);
    }
    // The edge has made the points of all rings, and the vertex finds those of its own among them.
    _border.EvaluateVertex(std::size_t(edge), getResult(0, first));
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateInside(Source const &source) {
    evaluateInside(source, PatternOf::Rates);
    if (_results[1]) {
        evaluateInside(source, PatternOf::RateDerivatives);
    }
}

template <typename REAL>
int RateEvaluator<REAL>::getFaceKey() const {
    Bfr::Parameterization const parameterization = _tessellation.GetParameterization();
    constexpr int kNumTypes = 3;
    return kNumTypes * parameterization.GetFaceSize() + int(parameterization.GetType());
}

// The shape of the face: plain ones are no half polygons.
template <typename REAL>
FaceShape RateEvaluator<REAL>::getShape(Source const &source) const {
    return source.places.ringCell ? FaceShape(_tessellation.GetFaceSize())
                                  : source.places.type->GetShape();
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateInside(Source const &source, PatternOf of) {
    bool const areDerivatives = of == PatternOf::RateDerivatives;
    forEachBlock<Matrices>(
        source.places.GetPatterns(), PatternTable::GetKind<REAL>(of),
        std::array<int, 5>{getFaceKey(), int(source.child), int(_numInner), _innerRates[0],
                           _innerRates[1]},
        _numInner,
        [&](std::size_t begin, std::size_t end) {
            return makeInside(source, begin, end, areDerivatives);
        },
        [&](Matrices const &matrices, std::size_t begin) {
            sumUp(source, matrices, areDerivatives,
                  _tessellation.GetNumBoundaryCoords() + int(begin));
        });
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateDerivativesOnEdge(Source const &source, int edge, int rate,
                                                    int first) const {
    Bfr::Parameterization const parameterization = _tessellation.GetParameterization();
    FaceShape const shape = getShape(source);
    forEachBlock<Matrices>(
        source.places.GetPatterns(), PatternTable::GetKind<REAL>(PatternOf::RateDerivativesOnEdge),
        std::array<int, 3>{getFaceKey(), edge, rate}, std::size_t(rate),
        [&](std::size_t begin, std::size_t end) {
            std::vector<BfrPlace> places;
            for (auto i = int(begin); i < int(end); ++i) {
                BfrPlace const place = MakeBfrEdgePlace(parameterization, shape, edge, i, rate);
                places.push_back(
                    source.places.ringCell
                        ? MoveToChild(place, FindCellStep(shape, edge, place.point.coords), shape)
                        : place);
            }
            return Matrices{source.places.MakeMatrices(places, true), {}};
        },
        [&](Matrices const &matrices, std::size_t begin) {
            sumUp(source, matrices, true, first + int(begin));
        });
}

// The matrices of those of the places [begin, end) inside that the source has.
template <typename REAL>
typename RateEvaluator<REAL>::Matrices
RateEvaluator<REAL>::makeInside(Source const &source, std::size_t begin, std::size_t end,
                                bool hasDerivatives) {
    // Coordinates are sums of some ten thousand steps at most.
    constexpr double kTolerance = 1e-11;
    FaceShape const shape = getShape(source);
    std::vector<BfrPlace> places;
    for (std::size_t i = begin; i < end; ++i) {
        places.push_back(
            FindBfrPlace(_tessellation.GetParameterization(), shape, getInnerCoord(i), kTolerance));
    }
    if (!source.places.ringCell) {
        return {source.places.MakeMatrices(places, hasDerivatives), {}};
    }
    std::vector<PlaceRun> runs;
    std::vector<BfrPlace> const ofChild = selectPlaces(places, source.child, shape, runs);
    return {source.places.MakeMatrices(ofChild, hasDerivatives), std::move(runs)};
}

template <typename REAL>
void RateEvaluator<REAL>::sumUp(Source const &source, Matrices const &matrices, bool areDerivatives,
                                int firstPlace) const {
    // No runs would stand for all places.
    if (matrices.ofPlaces.matrices[0].GetNumPlaces() == 0) {
        return;
    }
    REAL *results[2] = {};
    for (std::size_t i = 0; i < matrices.ofPlaces.count; ++i) {
        results[i] = getResult((areDerivatives ? 1 : 0) + i, firstPlace);
    }
    source.places.Evaluate(matrices.ofPlaces, _border.GetSize(), results, _resultStride,
                           matrices.runs.empty() ? nullptr : &matrices.runs);
}

template class RateEvaluator<float>;
template class RateEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

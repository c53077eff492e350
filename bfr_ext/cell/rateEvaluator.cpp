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
// Those of more places are not kept: matrices of a quad with a rate of 64 take half a megabyte.
constexpr std::size_t kMaxKeptPlaces = 64 * 64;

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

} // namespace

// Only quads have two inner rates.  Others have one, which follows from the number of places, as the place does if it
// is one.  The first place of a quad is one segment inside of the corner.
BfrInnerPlaces::BfrInnerPlaces(Bfr::Tessellation const &tessellation)
    : _tessellation(tessellation), _size(std::size_t(tessellation.GetNumInteriorCoords())) {
    if (tessellation.GetParameterization().GetType() != Bfr::Parameterization::QUAD || _size <= 1) {
        return;
    }
    if (tessellation.IsUniform()) {
        _rates[0] = _rates[1] = tessellation.GetNumEdgeCoords(0) + 1;
        return;
    }
    findCoords();
    for (std::size_t i = 0; i < 2; ++i) {
        _rates[i] = int(std::lround(1 / getCoord(0)[i]));
    }
}

std::vector<BfrPlace> BfrInnerPlaces::Find(std::size_t begin, std::size_t end) {
    // Coordinates are sums of some ten thousand steps at most.
    constexpr double kTolerance = 1e-11;
    findCoords();
    std::vector<BfrPlace> places;
    for (std::size_t i = begin; i < end; ++i) {
        places.push_back(
            FindBfrPlace(_tessellation.GetParameterization(), getCoord(i), kTolerance));
    }
    return places;
}

Pair BfrInnerPlaces::getCoord(std::size_t place) const {
    double const *const uv = &_coords[place * std::size_t(_tessellation.GetCoordStride())];
    return {uv[0], uv[1]};
}

void BfrInnerPlaces::findCoords() {
    if (_coords.empty()) {
        _coords.resize(_size * std::size_t(_tessellation.GetCoordStride()));
        _tessellation.GetInteriorCoords(_coords.data());
    }
}

template <typename REAL>
RateEvaluator<REAL>::RateEvaluator(Bfr::Tessellation const &tessellation,
                                   BorderEvaluator<REAL> &border, REAL *const results[3],
                                   std::ptrdiff_t resultStride)
    : _tessellation(tessellation), _border(border), _results{results[0], results[1], results[2]},
      _resultStride(resultStride), _inner(tessellation) {
    int first = 0;
    for (int edge = 0; edge < tessellation.GetFaceSize(); ++edge) {
        _firstPlaces.push_back(first);
        first += tessellation.GetNumEdgeCoords(edge) + 1;
    }
}

template <typename REAL>
void RateEvaluator<REAL>::Evaluate(CellType const &type, REAL const *points,
                                   std::ptrdiff_t stride) {
    evaluateBorder();
    evaluate({type, nullptr, 0, points, stride, nullptr});
}

template <typename REAL>
void RateEvaluator<REAL>::Evaluate(PlainFaceType const &type) {
    evaluateBorder();
    FaceRings const &face = type.GetRings();
    RingValues<REAL> const &values = _border.GetRingValues();
    for (std::size_t child = 0; child <= _firstPlaces.size(); ++child) {
        RingCell const &cell = face.GetChild(child);
        _indices.resize(cell.GetColumns().size());
        face.FindChildIndices(child, _indices.data());
        evaluate({cell.GetType(), &cell, child, values.GetPoints(),
                  std::ptrdiff_t(values.GetPaddedSize()), _indices.data()});
    }
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateBorder() {
    for (std::size_t edge = 0; edge < _firstPlaces.size(); ++edge) {
        int const rate = _tessellation.GetNumEdgeCoords(int(edge)) + 1;
        _border.EvaluateVertex(edge, getResult(0, _firstPlaces[edge]));
        if (rate > 1) {
            _border.EvaluateRate(edge, rate, getResult(0, _firstPlaces[edge] + 1), _resultStride);
        }
    }
}

template <typename REAL>
void RateEvaluator<REAL>::evaluate(Source const &source) {
    evaluateInside(source, PatternOf::Rates);
    if (!_results[1]) {
        return;
    }
    evaluateInside(source, PatternOf::RateDerivatives);
    // Children beside an edge have the places on it.
    int const numEdges = int(_firstPlaces.size());
    int const begin = source.cell ? std::max(int(source.child) - 1, 0) : 0;
    int const end = source.cell ? int(source.child) : numEdges;
    for (int edge = begin; edge < end; ++edge) {
        evaluateDerivativesOnEdge(source, edge);
    }
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateInside(Source const &source, PatternOf of) {
    std::array<int, 6> const key = {
        int(_firstPlaces.size()), int(_tessellation.GetParameterization().GetType()),
        int(_inner.GetSize()),    _inner.GetRate(0),
        _inner.GetRate(1),        int(source.child)};
    forEachBlock<Matrices>(
        source.GetPatterns(), PatternTable::GetKind<REAL>(of), key, _inner.GetSize(),
        [&](std::size_t begin, std::size_t end) {
            return makeInside(source, _inner.Find(begin, end), int(_firstPlaces.size()),
                              of == PatternOf::RateDerivatives);
        },
        [&](Matrices const &matrices, std::size_t begin) {
            sumUp(source, matrices, std::size_t(_tessellation.GetNumBoundaryCoords()) + begin);
        });
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateDerivativesOnEdge(Source const &source, int edge) {
    Bfr::Parameterization const parameterization = _tessellation.GetParameterization();
    int const size = parameterization.GetFaceSize();
    int const rate = _tessellation.GetNumEdgeCoords(edge) + 1;
    forEachBlock<Matrices>(
        source.GetPatterns(), PatternTable::GetKind<REAL>(PatternOf::RateDerivativesOnEdge),
        std::array<int, 4>{size, int(parameterization.GetType()), edge, rate}, std::size_t(rate),
        [&](std::size_t begin, std::size_t end) {
            std::vector<BfrPlace> places;
            for (auto i = int(begin); i < int(end); ++i) {
                BfrPlace const place = MakeBfrEdgePlace(parameterization, edge, i, rate);
                places.push_back(
                    source.cell
                        ? MoveToChild(place, FindCellStep(true, edge, place.point.coords), size)
                        : place);
            }
            return makeMatrices(source, places, true);
        },
        [&](Matrices const &matrices, std::size_t begin) {
            sumUp(source, matrices, std::size_t(_firstPlaces[std::size_t(edge)]) + begin);
        });
}

// The matrices of those places that the source has.
template <typename REAL>
typename RateEvaluator<REAL>::Matrices
RateEvaluator<REAL>::makeInside(Source const &source, std::vector<BfrPlace> const &places,
                                int faceSize, bool hasDerivatives) {
    if (!source.cell) {
        return makeMatrices(source, places, hasDerivatives);
    }
    std::vector<BfrPlace> ofChild;
    std::vector<PlaceRun> runs;
    for (std::size_t i = 0; i < places.size(); ++i) {
        BasePoint const &point = places[i].point;
        CellStep const step = FindCellStep(true, point.sector, point.coords);
        if (step.child != source.child) {
            continue;
        }
        int const row = int(ofChild.size());
        ofChild.push_back(MoveToChild(places[i], step, faceSize));
        bool const isFollowing = !runs.empty() && runs.back().place + runs.back().count == int(i) &&
                                 row % PlaceRun::kMaxBlock != 0;
        if (isFollowing) {
            ++runs.back().count;
        } else {
            runs.push_back({row, int(i), 1});
        }
    }
    Matrices matrices = makeMatrices(source, ofChild, hasDerivatives);
    matrices.runs = std::move(runs);
    return matrices;
}

template <typename REAL>
typename RateEvaluator<REAL>::Matrices
RateEvaluator<REAL>::makeMatrices(Source const &source, std::vector<BfrPlace> const &places,
                                  bool hasDerivatives) {
    bool const isOfStep = source.cell && source.cell->IsInner();
    std::size_t const numColumns =
        source.cell ? source.cell->GetColumns().size() : std::size_t(source.type.GetNumPoints());
    CellStencil stencil(source.type, isOfStep ? StencilOf::Step : StencilOf::Points);
    std::vector<double> ordered;
    auto const order = [&](std::vector<double> const &weights) -> std::vector<double> const & {
        if (!source.cell) {
            return weights;
        }
        source.cell->GetPlaces().Order(weights, ordered);
        return ordered;
    };
    Matrices result;
    result.matrices.assign(hasDerivatives ? 2 : 1, PlaceMatrix<REAL>(places.size(), numColumns));
    std::vector<double> derivative;
    for (std::size_t row = 0; row < places.size(); ++row) {
        BfrPlace const &place = places[row];
        stencil.Find(place.point, hasDerivatives);
        if (!hasDerivatives) {
            result.matrices[0].Set(row, order(stencil.GetWeights()));
            continue;
        }
        std::vector<double> const *along[2] = {&stencil.GetDuWeights(), &stencil.GetDvWeights()};
        // Vertices of the face have the derivatives of the face.
        if (source.cell && !source.type.IsWhole() && place.point.coords == HalfCell::kCorners[0]) {
            CellType::Derivatives const &ofFace = isOfStep
                                                      ? source.type.GetParentDerivativesOfStep(0)
                                                      : source.type.GetParentDerivatives(0);
            along[0] = &ofFace.rows[0];
            along[1] = &ofFace.rows[1];
        }
        for (std::size_t k = 0; k < 2; ++k) {
            derivative.resize(along[0]->size());
            for (std::size_t i = 0; i < derivative.size(); ++i) {
                derivative[i] =
                    place.toOwn[0][k] * (*along[0])[i] + place.toOwn[1][k] * (*along[1])[i];
            }
            result.matrices[k].Set(row, order(derivative));
        }
    }
    return result;
}

template <typename REAL>
void RateEvaluator<REAL>::sumUp(Source const &source, Matrices const &matrices,
                                std::size_t firstPlace) const {
    // No runs would stand for all places.
    if (matrices.matrices[0].GetNumPlaces() == 0) {
        return;
    }
    std::size_t const firstKind = matrices.matrices.size() == 1 ? 0 : 1;
    for (std::size_t i = 0; i < matrices.matrices.size(); ++i) {
        SumUpPlaces(matrices.matrices[i],
                    {source.points, source.stride, _border.GetSize(), source.indices,
                     getResult(firstKind + i, int(firstPlace)), _resultStride,
                     matrices.runs.empty() ? nullptr : matrices.runs.data(), matrices.runs.size()});
    }
}

template class RateEvaluator<float>;
template class RateEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "rateEvaluator.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Places of a block: a multiple of the width of blocks of matrices.
constexpr std::size_t kBlockSize = 8 * PlaceMatrix<float>::kMaxWidth;
static_assert(kBlockSize % PlaceMatrix<double>::kMaxWidth == 0);
// Those of more places are not kept: matrices of a face with a rate of 64 take half a megabyte.
constexpr std::size_t kMaxKeptPlaces = 64 * 64;

// The matrices of some places: that of the points, or those of the derivatives by Bfr's u and v.
template <typename REAL>
using Matrices = std::vector<PlaceMatrix<REAL>>;

template <typename REAL>
Matrices<REAL> makeMatrices(CellType const &type, std::vector<BfrPlace> const &places,
                            bool hasDerivatives) {
    Matrices<REAL> matrices(hasDerivatives ? 2 : 1,
                            PlaceMatrix<REAL>(places.size(), std::size_t(type.GetNumPoints())));
    CellStencil stencil(type);
    std::vector<double> derivative(std::size_t(type.GetNumPoints()));
    for (std::size_t i = 0; i < places.size(); ++i) {
        stencil.Find(places[i].point, hasDerivatives);
        if (!hasDerivatives) {
            matrices[0].Set(i, stencil.GetWeights());
            continue;
        }
        Pair const(&toPlane)[2] = places[i].toPlane;
        for (std::size_t k = 0; k < 2; ++k) {
            for (std::size_t point = 0; point < derivative.size(); ++point) {
                derivative[point] = toPlane[0][k] * stencil.GetDuWeights()[point] +
                                    toPlane[1][k] * stencil.GetDvWeights()[point];
            }
            matrices[k].Set(i, derivative);
        }
    }
    return matrices;
}

// The places inside of a face.
class InnerPlaces {
public:
    explicit InnerPlaces(Bfr::Tessellation const &tessellation)
        : _tessellation(tessellation), _size(std::size_t(tessellation.GetNumInteriorCoords())) {
        findRates();
    }

    std::size_t GetSize() const { return _size; }
    /// What tells them from those of other tessellations of the face.
    std::vector<int> GetKey() const {
        return {int(_tessellation.GetParameterization().GetType()), int(_size), _rates[0],
                _rates[1]};
    }
    std::vector<BfrPlace> Find(std::size_t begin, std::size_t end) {
        // Of coordinates that are sums of some ten thousand steps.
        constexpr double kTolerance = 1e-11;
        findCoords();
        std::vector<BfrPlace> places;
        for (std::size_t i = begin; i < end; ++i) {
            places.push_back(
                FindBfrPlace(_tessellation.GetParameterization(), getCoord(i), kTolerance));
        }
        return places;
    }

private:
    Pair getCoord(std::size_t place) const {
        double const *const uv = &_coords[place * std::size_t(_tessellation.GetCoordStride())];
        return {uv[0], uv[1]};
    }
    void findCoords() {
        if (_coords.empty()) {
            _coords.resize(_size * std::size_t(_tessellation.GetCoordStride()));
            _tessellation.GetInteriorCoords(_coords.data());
        }
    }
    // Of quads, which alone may have two: others have one, which follows from the number of places, as the place
    // does if it is one.  The first place has both, one segment inside of the corner.
    void findRates() {
        if (_tessellation.GetParameterization().GetType() != Bfr::Parameterization::QUAD ||
            _size <= 1) {
            return;
        }
        if (_tessellation.IsUniform()) {
            _rates[0] = _rates[1] = _tessellation.GetNumEdgeCoords(0) + 1;
            return;
        }
        findCoords();
        for (std::size_t i = 0; i < 2; ++i) {
            _rates[i] = int(std::lround(1 / getCoord(0)[i]));
        }
    }

    Bfr::Tessellation const &_tessellation;
    std::size_t const _size;
    int _rates[2] = {};
    std::vector<double> _coords;
};

// Calls function(matrices, begin) for the blocks of some places.
//
// \param key    what tells the places, and will tell the block
// \param find   gives places [begin, end)
template <typename REAL, typename FIND, typename FUNCTION>
void forEachBlock(CellType const &type, PatternOf of, std::vector<int> key, std::size_t numPlaces,
                  FIND const &find, FUNCTION const &function) {
    bool const hasDerivatives = of != PatternOf::Rates;
    bool const areKept = numPlaces <= kMaxKeptPlaces;
    key.push_back(0);
    for (std::size_t begin = 0; begin < numPlaces; begin += kBlockSize, ++key.back()) {
        auto const make = [&] {
            return makeMatrices<REAL>(type, find(begin, std::min(begin + kBlockSize, numPlaces)),
                                      hasDerivatives);
        };
        if (areKept) {
            function(
                type.GetPatterns().template Get<Matrices<REAL>>(
                    PatternTable::GetKind<REAL>(of), key.data(), key.data() + key.size(), make),
                begin);
        } else {
            function(make(), begin);
        }
    }
}

} // namespace

template <typename REAL>
void EvaluateRates(CellType const &type, Bfr::Tessellation const &tessellation,
                   RateSums<REAL> const &sums, BorderEvaluator<REAL> &border) {
    auto const getResult = [&](int kind, std::size_t place) {
        return sums.results[kind] + std::ptrdiff_t(place) * sums.resultStride;
    };
    auto const sumUp = [&](PlaceMatrix<REAL> const &matrix, int kind, std::size_t place) {
        SumUpPlaces(matrix, {sums.points, sums.stride, sums.size, nullptr, getResult(kind, place),
                             sums.resultStride});
    };
    auto const sumUpDerivatives = [&](Matrices<REAL> const &matrices, std::size_t place) {
        sumUp(matrices[0], 1, place);
        sumUp(matrices[1], 2, place);
    };
    bool const hasDerivatives = sums.results[1] != nullptr;
    Bfr::Parameterization const parameterization = tessellation.GetParameterization();
    std::size_t first = 0;
    for (int edge = 0; edge < tessellation.GetFaceSize(); ++edge) {
        int const rate = tessellation.GetNumEdgeCoords(edge) + 1;
        border.EvaluateVertex(std::size_t(edge), getResult(0, first));
        if (rate > 1) {
            border.EvaluateRate(std::size_t(edge), rate, getResult(0, first + 1),
                                sums.resultStride);
        }
        if (hasDerivatives) {
            forEachBlock<REAL>(
                type, PatternOf::RateDerivativesOnEdge,
                {int(parameterization.GetType()), edge, rate}, std::size_t(rate),
                [&](std::size_t begin, std::size_t end) {
                    std::vector<BfrPlace> places;
                    for (std::size_t i = begin; i < end; ++i) {
                        places.push_back(MakeBfrEdgePlace(parameterization, edge, int(i), rate));
                    }
                    return places;
                },
                [&](Matrices<REAL> const &matrices, std::size_t begin) {
                    sumUpDerivatives(matrices, first + begin);
                });
        }
        first += std::size_t(rate);
    }
    InnerPlaces inner(tessellation);
    auto const find = [&](std::size_t begin, std::size_t end) { return inner.Find(begin, end); };
    forEachBlock<REAL>(type, PatternOf::Rates, inner.GetKey(), inner.GetSize(), find,
                       [&](Matrices<REAL> const &matrices, std::size_t begin) {
                           sumUp(matrices[0], 0, first + begin);
                       });
    if (hasDerivatives) {
        forEachBlock<REAL>(type, PatternOf::RateDerivatives, inner.GetKey(), inner.GetSize(), find,
                           [&](Matrices<REAL> const &matrices, std::size_t begin) {
                               sumUpDerivatives(matrices, first + begin);
                           });
    }
}

template void EvaluateRates(CellType const &, Bfr::Tessellation const &, RateSums<float> const &,
                            BorderEvaluator<float> &);
template void EvaluateRates(CellType const &, Bfr::Tessellation const &, RateSums<double> const &,
                            BorderEvaluator<double> &);

} // namespace OpenSubdivHex::BfrExt::internal

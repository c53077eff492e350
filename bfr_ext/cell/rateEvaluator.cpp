// SPDX-License-Identifier: Apache-2.0
#include "rateEvaluator.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Matrices of more points are not kept: for a quad with a rate of 64 they take half a megabyte.
constexpr std::size_t kMaxKeptPlaces = 4096;
// Places of a block where they are not kept, in full blocks of matrices.
constexpr std::size_t kBlockSize = 8 * PlaceMatrix<float>::kMaxWidth;
static_assert(kBlockSize % PlaceMatrix<double>::kMaxWidth == 0);

// Calls function(begin, end, isKept) for blocks of places.
template <typename FUNCTION>
void forEachBlock(std::size_t numPlaces, FUNCTION const &function) {
    bool const isKept = numPlaces <= kMaxKeptPlaces;
    std::size_t const size = isKept ? numPlaces : kBlockSize;
    for (std::size_t begin = 0; begin < numPlaces; begin += size) {
        function(begin, std::min(begin + size, numPlaces), isKept);
    }
}

void addToRuns(int row, int place, std::vector<PlaceRun> &runs) {
    bool const isFollowing = !runs.empty() && runs.back().row + runs.back().count == row &&
                             runs.back().place + runs.back().count == place &&
                             row % PlaceRun::kMaxBlock != 0;
    if (isFollowing) {
        ++runs.back().count;
    } else {
        runs.push_back({row, place, 1});
    }
}

// A place of a face in one of its children.
struct PlaceInChild {
    BfrPlace place;
    int number; // in the face
};

// An order of places that does not depend on how coordinates are rounded.
bool isBefore(PlaceInChild const &a, PlaceInChild const &b) {
    constexpr double kGrid = double(1ULL << 40);
    auto const getKey = [](BasePoint const &point) {
        return std::make_tuple(point.sector, std::round(point.coords[1] * kGrid),
                               std::round(point.coords[0] * kGrid));
    };
    return getKey(a.place.point) < getKey(b.place.point);
}

bool areSame(std::vector<PlaceInChild> const &some, std::vector<BfrPlace> const &others) {
    constexpr double kTolerance = 1e-14;
    return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                      [](PlaceInChild const &a, BfrPlace const &b) {
                          Pair const &p = a.place.point.coords;
                          Pair const &q = b.point.coords;
                          return a.place.point.sector == b.point.sector &&
                                 std::abs(p[0] - q[0]) <= kTolerance &&
                                 std::abs(p[1] - q[1]) <= kTolerance;
                      });
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

std::vector<BfrPlace> BfrInnerPlaces::Find(FaceShape shape, std::size_t begin, std::size_t end) {
    // Coordinates are sums of some ten thousand steps at most.
    constexpr double kTolerance = 1e-11;
    findCoords();
    std::vector<BfrPlace> places;
    for (std::size_t i = begin; i < end; ++i) {
        places.push_back(
            FindBfrPlace(_tessellation.GetParameterization(), shape, getCoord(i), kTolerance));
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
      _resultStride(resultStride), _inner(tessellation) {}

RatePlan::RatePlan(std::vector<BfrPlace> const &ofFace, FaceShape shape)
    : children(1 + std::size_t(shape.size)), toOwn(ofFace.size()) {
    std::vector<std::vector<PlaceInChild>> ofChildren(children.size());
    for (std::size_t i = 0; i < ofFace.size(); ++i) {
        BasePoint const &point = ofFace[i].point;
        CellStep const step = FindCellStep(shape, point.sector, point.coords);
        BfrPlace place = MoveToChild(ofFace[i], step, shape);
        toOwn[i] = {{place.toOwn[0], place.toOwn[1]}};
        place.toOwn[0] = {1, 0};
        place.toOwn[1] = {0, 1};
        ofChildren[step.child].push_back({place, int(i)});
    }
    for (std::size_t i = 0; i < children.size(); ++i) {
        std::vector<PlaceInChild> &places = ofChildren[i];
        std::sort(places.begin(), places.end(), isBefore);
        // Whole cells are no half cells.
        std::size_t like = i == 0 ? 0 : 1;
        while (like < i && !areSame(places, children[like].places)) {
            ++like;
        }
        children[i].like = like;
        for (std::size_t row = 0; row < places.size(); ++row) {
            addToRuns(int(row), places[row].number, children[i].runs);
            if (like == i) {
                children[i].places.push_back(places[row].place);
            }
        }
    }
}

template <typename REAL>
void RateEvaluator<REAL>::Evaluate(CellType const &type, REAL const *points,
                                   std::ptrdiff_t stride) {
    Source const source = {type, nullptr, 0, points, stride, nullptr};
    forEachEdge([&](int edge, int rate, int first) {
        evaluateVertex(edge, first);
        evaluateEdge(edge, rate, first);
        if (_results[1]) {
            evaluateDerivativesOnEdge(source, edge, rate, first);
        }
    });
    evaluateInside(source, PatternOf::Rates);
    if (_results[1]) {
        evaluateInside(source, PatternOf::RateDerivatives);
    }
}

template <typename REAL>
void RateEvaluator<REAL>::Evaluate(PlainFaceType const &type) {
    forEachEdge([&](int edge, int rate, int first) {
        evaluateVertex(edge, first);
        evaluateEdge(edge, rate, first);
        if (_results[1]) {
            evaluateDerivativesOnEdge(getChild(type, std::size_t(edge) + 1), edge, rate, first);
        }
    });
    evaluateInside(type, PatternOf::Rates);
    if (_results[1]) {
        evaluateInside(type, PatternOf::RateDerivatives);
    }
}

// Valid until the next call.
template <typename REAL>
typename RateEvaluator<REAL>::Source RateEvaluator<REAL>::getChild(PlainFaceType const &type,
                                                                   std::size_t child) const {
    // Its memory is kept for the next face.
    static thread_local std::vector<int> indices;
    RingValues<REAL> const &values = _border.GetRingValues();
    RingCell const &cell = type.GetRings().GetChild(child);
    indices.resize(cell.GetColumns().size());
    type.GetRings().FindChildIndices(child, indices.data());
    return {
        cell.GetType(), &cell, child, values.GetPoints(), std::ptrdiff_t(values.GetPaddedSize()),
        indices.data()};
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

template <typename REAL>
void RateEvaluator<REAL>::evaluateVertex(int edge, int first) const {
    _border.EvaluateVertex(std::size_t(edge), getResult(0, first));
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateEdge(int edge, int rate, int first) const {
    if (rate > 1) {
        _border.EvaluateRate(std::size_t(edge), rate, getResult(0, first + 1), _resultStride);
    }
}

template <typename REAL>
int RateEvaluator<REAL>::getFaceKey() const {
    Bfr::Parameterization const parameterization = _tessellation.GetParameterization();
    constexpr int kNumTypes = 3;
    return kNumTypes * parameterization.GetFaceSize() + int(parameterization.GetType());
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateInside(Source const &source, PatternOf of) {
    forEachBlock(_inner.GetSize(), [&](std::size_t begin, std::size_t end, bool isKept) {
        sumUp(
            source, of, getInnerKey(), isKept,
            [&] {
                return makeMatrices(source, _inner.Find(source.type.GetShape(), begin, end),
                                    of == PatternOf::RateDerivatives);
            },
            nullptr, _tessellation.GetNumBoundaryCoords() + int(begin));
    });
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateInside(PlainFaceType const &type, PatternOf of) {
    FaceShape const shape(_tessellation.GetFaceSize());
    forEachBlock(_inner.GetSize(), [&](std::size_t begin, std::size_t end, bool isKept) {
        auto const make = [&] { return RatePlan(_inner.Find(shape, begin, end), shape); };
        auto const evaluate = [&](RatePlan const &plan) {
            for (std::size_t child = 0; child < plan.children.size(); ++child) {
                if (!plan.children[child].runs.empty()) {
                    evaluateChild(getChild(type, child), plan, of, isKept,
                                  _tessellation.GetNumBoundaryCoords() + int(begin));
                }
            }
        };
        if (isKept) {
            InnerKey const key = getInnerKey();
            evaluate(
                type.GetRingCells().FindPlan<RatePlan>(key.data(), key.data() + key.size(), make));
        } else {
            evaluate(make());
        }
    });
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateChild(Source const &source, RatePlan const &plan, PatternOf of,
                                        bool isKept, int firstPlace) const {
    RatePlan::Child const &child = plan.children[source.child];
    bool const areDerivatives = of == PatternOf::RateDerivatives;
    auto const [faceKey, numPlaces, firstRate, secondRate] = getInnerKey();
    sumUp(
        source, of, std::array<int, 5>{int(child.like), faceKey, numPlaces, firstRate, secondRate},
        isKept,
        [&] { return makeMatrices(source, plan.children[child.like].places, areDerivatives); },
        &child.runs, firstPlace);
    if (areDerivatives) {
        turnDerivatives(plan, child.runs, firstPlace);
    }
}

// Turns derivatives by the coordinates of a child into derivatives by Bfr's u and v.
template <typename REAL>
void RateEvaluator<REAL>::turnDerivatives(RatePlan const &plan, std::vector<PlaceRun> const &runs,
                                          int firstPlace) const {
    for (PlaceRun const &run : runs) {
        for (int place = run.place; place < run.place + run.count; ++place) {
            auto const &[x, y] = plan.toOwn[std::size_t(place)].rows;
            REAL const factors[2][2] = {{REAL(x[0]), REAL(y[0])}, {REAL(x[1]), REAL(y[1])}};
            REAL *const du = getResult(1, firstPlace + place);
            REAL *const dv = getResult(2, firstPlace + place);
            for (std::size_t k = 0; k < _border.GetSize(); ++k) {
                REAL const along = du[k];
                REAL const across = dv[k];
                du[k] = factors[0][0] * along + factors[0][1] * across;
                dv[k] = factors[1][0] * along + factors[1][1] * across;
            }
        }
    }
}

template <typename REAL>
void RateEvaluator<REAL>::evaluateDerivativesOnEdge(Source const &source, int edge, int rate,
                                                    int first) const {
    Bfr::Parameterization const parameterization = _tessellation.GetParameterization();
    // Plain faces are no half polygons.
    FaceShape const shape =
        source.cell ? FaceShape(_tessellation.GetFaceSize()) : source.type.GetShape();
    forEachBlock(std::size_t(rate), [&](std::size_t begin, std::size_t end, bool isKept) {
        auto const make = [&] {
            std::vector<BfrPlace> places;
            for (auto i = int(begin); i < int(end); ++i) {
                BfrPlace const place = MakeBfrEdgePlace(parameterization, shape, edge, i, rate);
                places.push_back(
                    source.cell
                        ? MoveToChild(place, FindCellStep(shape, edge, place.point.coords), shape)
                        : place);
            }
            return makeMatrices(source, places, true);
        };
        sumUp(source, PatternOf::RateDerivativesOnEdge,
              std::array<int, 3>{getFaceKey(), edge, rate}, isKept, make, nullptr,
              first + int(begin));
    });
}

template <typename REAL>
typename RateEvaluator<REAL>::Matrices
RateEvaluator<REAL>::makeMatrices(Source const &source, std::vector<BfrPlace> const &places,
                                  bool hasDerivatives) {
    Matrices result;
    std::array<Rows, 2> const rows = findRows(source, places, hasDerivatives);
    for (std::size_t kind = 0; kind < (hasDerivatives ? 2 : 1); ++kind) {
        result[kind] = PlaceMatrix<REAL>(rows[kind].size(), rows[kind][0].size());
        for (std::size_t row = 0; row < rows[kind].size(); ++row) {
            result[kind].Set(row, rows[kind][row]);
        }
    }
    return result;
}

// By place, the weights of what the source has: of the point, or of the derivatives by the coordinates of toOwn.
template <typename REAL>
std::array<typename RateEvaluator<REAL>::Rows, 2>
RateEvaluator<REAL>::findRows(Source const &source, std::vector<BfrPlace> const &places,
                              bool hasDerivatives) {
    bool const isOfStep = source.cell && source.cell->IsInner();
    CellStencil stencil(source.type, isOfStep ? StencilOf::Step : StencilOf::Points);
    std::array<Rows, 2> result;
    auto const add = [&](std::size_t kind, std::vector<double> const &weights) {
        std::vector<double> &row = result[kind].emplace_back(weights);
        if (source.cell) {
            source.cell->GetPlaces().Order(weights, row);
        }
    };
    std::vector<double> derivative;
    for (BfrPlace const &place : places) {
        stencil.Find(place.point, hasDerivatives);
        if (!hasDerivatives) {
            add(0, stencil.GetWeights());
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
            add(k, derivative);
        }
    }
    return result;
}

// Evaluates places by matrices that the source keeps, or by those that make() gives.
template <typename REAL>
template <std::size_t SIZE, typename MAKE>
void RateEvaluator<REAL>::sumUp(Source const &source, PatternOf of,
                                std::array<int, SIZE> const &key, bool isKept, MAKE const &make,
                                std::vector<PlaceRun> const *runs, int firstPlace) const {
    bool const areDerivatives = of != PatternOf::Rates;
    if (isKept) {
        sumUp(source,
              source.GetPatterns().template Get<Matrices>(PatternTable::GetKind<REAL>(of),
                                                          key.data(), key.data() + SIZE, make),
              areDerivatives, runs, firstPlace);
    } else {
        sumUp(source, make(), areDerivatives, runs, firstPlace);
    }
}

template <typename REAL>
void RateEvaluator<REAL>::sumUp(Source const &source, Matrices const &matrices, bool areDerivatives,
                                std::vector<PlaceRun> const *runs, int firstPlace) const {
    for (std::size_t i = 0; i < (areDerivatives ? 2 : 1); ++i) {
        SumUpPlaces(matrices[i], {source.points, source.stride, _border.GetSize(), source.indices,
                                  getResult(areDerivatives ? 1 + i : 0, firstPlace), _resultStride,
                                  runs ? runs->data() : nullptr, runs ? runs->size() : 0});
    }
}

template class RateEvaluator<float>;
template class RateEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

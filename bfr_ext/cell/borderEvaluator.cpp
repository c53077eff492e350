// SPDX-License-Identifier: Apache-2.0
#include "borderEvaluator.h"

#include "bfr_ext/cellTree.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Finds what the sources of an edge weigh at its places.
class WeightFinder {
public:
    WeightFinder(CellType const &type, RingCell const *cell)
        : _type(type), _cell(cell),
          _of(cell && cell->IsInner() ? StencilOf::Step : StencilOf::Points) {}

    // Valid until the next call.
    std::vector<double> const &Find(double point) {
        _stencil.Find(_type, point, _of);
        if (!_cell) {
            return _stencil.GetWeights();
        }
        _cell->GetPlaces().Order(_stencil.GetWeights(), _ordered);
        return _ordered;
    }

private:
    CellType const &_type;
    RingCell const *const _cell;
    StencilOf const _of;
    BorderStencil _stencil;
    std::vector<double> _ordered;
};

// The places inside of an edge of a level, from its start on; they are the same from its end.
std::vector<double> makeEdgePoints(int level) {
    Polyline const polyline(level);
    std::vector<double> points(static_cast<std::size_t>(polyline.GetNumPoints()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = polyline.GetParameter(int(i));
    }
    return points;
}

// Returns the points of a rate, in the edge's own direction: 1 - i/rate would be rounded.
std::vector<double> makeRatePoints(int rate) {
    std::vector<double> points;
    for (int i = 1; i < rate; ++i) {
        points.push_back(double(i) / rate);
    }
    return points;
}

} // namespace

template <typename REAL>
void BorderEvaluator<REAL>::SetFace(CellType const &type, int const *turns, REAL const *points,
                                    std::ptrdiff_t stride, std::size_t size) {
    _type = &type;
    _plain = nullptr;
    _turns = turns;
    _numEdges = std::size_t(type.GetNumCorners());
    _points = points;
    _stride = stride;
    _size = size;
    _paddedSize = StepMatrix::GetPaddedSize(size);
    _edge = {};
    // As long as the type is there, so are its items and their matrices.
    if (_typeNumber != type.GetNumber()) {
        _typeNumber = type.GetNumber();
        _items.assign(2 * _numEdges, {});
        _places = {};
        _vertex = {};
    }
}

template <typename REAL>
void BorderEvaluator<REAL>::SetFace(PlainFaceType const &type, int const *turns,
                                    std::size_t numPoints, REAL const *points,
                                    std::ptrdiff_t stride, std::size_t size) {
    VertexRings const &rings = type.GetRings().GetRings();
    _values.Set(rings, numPoints, nullptr, points, stride, size);
    _type = nullptr;
    _plain = &type;
    _turns = turns;
    _numEdges = rings.GetRings().size();
    _points = points;
    _stride = stride;
    _size = size;
    _paddedSize = _values.GetPaddedSize();
    _edge = {};
    _typeNumber = 0;
    _places = {};
    _vertex = {};
}

template <typename REAL>
void BorderEvaluator<REAL>::EvaluateVertex(std::size_t vert, REAL *result) {
    int const turn = _turns[_numEdges + vert];
    if (_plain) {
        FaceRings const &face = _plain->GetRings();
        if (RingCell const *const cell = face.GetVVertex(int(vert), turn)) {
            int const numFaces = face.GetRings().GetRings()[vert].GetNumFaces();
            _values.EvaluateVertex(*cell, int(vert), turn == 0 ? 0 : numFaces - turn, result);
            return;
        }
    }
    CellType::BorderItem const &item = getItem(_numEdges + vert);
    if (item.rings) {
        _vertexValues.Set(item.rings->rings, item.points.size(), item.points.data(), _points,
                          _stride, _size);
        _vertexValues.EvaluateVertex(*item.rings->cell, 0, 0, result);
    } else {
        SumUpPlaces(findVertex(*item.type),
                    {_points, _stride, _size, item.points.data(), result, 0});
    }
}

// Returns an item for which a plain face has no rings.
template <typename REAL>
CellType::BorderItem const &BorderEvaluator<REAL>::getItem(std::size_t item) {
    if (_plain) {
        return _plain->GetLatticeItem(_turns, item);
    }
    KnownItem &known = _items[item];
    if (known.turn != _turns[item]) {
        known = {_turns[item], &_type->GetBorderItem(_turns, item)};
    }
    return *known.item;
}

template <typename REAL>
void BorderEvaluator<REAL>::setEdge(std::size_t edge) {
    if (_edge.type && edge == _edgeNumber) {
        return;
    }
    _edgeNumber = edge;
    _isReversed = _turns[edge] == 1;
    if (_plain) {
        FaceRings const &face = _plain->GetRings();
        if (RingCell const *const cell = face.GetLongEdge(int(edge), _isReversed)) {
            _indices.resize(cell->GetColumns().size());
            face.FindLongEdgeIndices(int(edge), _isReversed, _indices.data());
            _edge = {&cell->GetType(), cell, _values.GetPoints(), std::ptrdiff_t(_paddedSize),
                     _indices.data()};
            return;
        }
    }
    CellType::BorderItem const &item = getItem(edge);
    if (item.type->IsInLattice() || item.type->IsLongEdge()) {
        _edge = {item.type, nullptr, _points, _stride, item.points.data()};
    } else if (item.rings) {
        _edgeValues.Set(item.rings->rings, item.points.size(), item.points.data(), _points, _stride,
                        _size);
        RingCell const &cell = *item.rings->cell;
        VertexRings const &rings = item.rings->rings;
        _indices.resize(cell.GetColumns().size());
        RingStep const step = cell.GetLastStep();
        cell.GetPlaces().FindIndices(
            rings.GetCenter(0, 0, step), [&](int ring) { return rings.GetBlock(ring, 0, step); },
            _indices.data());
        _edge = {&cell.GetType(), &cell, _edgeValues.GetPoints(), std::ptrdiff_t(_paddedSize),
                 _indices.data()};
    } else {
        CellType::Child const &longEdge = item.type->GetChildren()[0];
        _paddedPoints.resize(item.points.size() * _paddedSize);
        for (std::size_t i = 0; i < item.points.size(); ++i) {
            StepMatrix::Pad(_points + item.points[i] * _stride, _size,
                            &_paddedPoints[i * _paddedSize]);
        }
        StepMatrix const &step = item.type->GetStep();
        _stepPoints.resize(step.GetNumRows() * _paddedSize);
        step.Apply(_paddedPoints.data(), _paddedSize, _stepPoints.data());
        _longEdgePoints.resize(longEdge.step.GetNumRows() * _paddedSize);
        longEdge.step.CopyPoints(_stepPoints.data(), _paddedSize, _longEdgePoints.data());
        _edge = {longEdge.type, nullptr, _longEdgePoints.data(), std::ptrdiff_t(_paddedSize),
                 nullptr};
    }
}

template <typename REAL>
void BorderEvaluator<REAL>::EvaluateEdge(std::size_t edge, int level, REAL *results,
                                         std::ptrdiff_t stride) {
    evaluateInside(edge, false, level, results, stride);
}

template <typename REAL>
void BorderEvaluator<REAL>::EvaluateRate(std::size_t edge, int rate, REAL *results,
                                         std::ptrdiff_t stride) {
    evaluateInside(edge, true, rate, results, stride);
}

// The matrix of a level, or of a rate.
template <typename REAL>
PlaceMatrix<REAL> const &BorderEvaluator<REAL>::findPlaces(bool isRate, int level) {
    PatternTable *const patterns = &getPatterns(*_edge.type, _edge.cell);
    PatternOf const of = isRate ? PatternOf::BorderRate : PatternOf::Border;
    if (_places.patterns == patterns && _places.of == of && _places.level == level) {
        return *_places.matrix;
    }
    auto const make = [&] {
        return makeMatrix(*_edge.type, _edge.cell,
                          isRate ? makeRatePoints(level) : makeEdgePoints(level));
    };
    if (isRate && level > kMaxKeptRate) {
        return _placeMatrix = make();
    }
    _places = {patterns, of, level,
               &patterns->Get<PlaceMatrix<REAL>>(PatternTable::GetKind<REAL>(of), &level,
                                                 &level + 1, make)};
    return *_places.matrix;
}

template <typename REAL>
void BorderEvaluator<REAL>::evaluateInside(std::size_t edge, bool isRate, int level, REAL *results,
                                           std::ptrdiff_t stride) {
    setEdge(edge);
    PlaceMatrix<REAL> const &matrix = findPlaces(isRate, level);
    auto const last = std::ptrdiff_t(matrix.GetNumPlaces()) - 1;
    sumUp(matrix, _isReversed ? results + last * stride : results, _isReversed ? -stride : stride);
}

// They are kept one by one, since polylines have few in common, and without what a matrix of one place is
// filled up with, which is most of it.
template <typename REAL>
void BorderEvaluator<REAL>::EvaluateKeptPoint(std::size_t edge, Pair const &place, REAL *result) {
    constexpr int kStep = Polyline::kLength >> kLastKeptLevel;
    setEdge(edge);
    double const point = place[_isReversed ? 0 : 1];
    int const key = int(point * Polyline::kLength);
    if (key % kStep != 0) {
        sumUp(makeMatrix(*_edge.type, _edge.cell, {point}), result, 0);
        return;
    }
    std::vector<REAL> const &weights =
        getPatterns(*_edge.type, _edge.cell)
            .template Get<std::vector<REAL>>(
                PatternTable::GetKind<REAL>(PatternOf::BorderPlace), &key, &key + 1, [&] {
                    std::vector<double> const stencil =
                        WeightFinder(*_edge.type, _edge.cell).Find(point);
                    return std::vector<REAL>(stencil.begin(), stencil.end());
                });
    if (_placeMatrix.GetNumPoints() != weights.size()) {
        _placeMatrix = PlaceMatrix<REAL>(1, weights.size());
    }
    _placeMatrix.Set(0, weights);
    sumUp(_placeMatrix, result, 0);
}

template <typename REAL>
PlaceMatrix<REAL> BorderEvaluator<REAL>::makeMatrix(CellType const &type, RingCell const *cell,
                                                    std::vector<double> const &points) {
    PlaceMatrix<REAL> matrix(points.size(),
                             cell ? cell->GetColumns().size() : std::size_t(type.GetNumPoints()));
    WeightFinder finder(type, cell);
    for (std::size_t place = 0; place < points.size(); ++place) {
        matrix.Set(place, finder.Find(points[place]));
    }
    return matrix;
}

template <typename REAL>
PlaceMatrix<REAL> const &BorderEvaluator<REAL>::findVertex(CellType const &type) {
    if (_vertex.patterns != &type.GetPatterns()) {
        _vertex.patterns = &type.GetPatterns();
        _vertex.matrix = &type.GetPatterns().template Get<PlaceMatrix<REAL>>(
            PatternTable::GetKind<REAL>(PatternOf::Border), nullptr, nullptr, [&] {
                PlaceMatrix<REAL> matrix(1, std::size_t(type.GetNumPoints()));
                matrix.Set(0, type.GetCornerPoints()[0]);
                return matrix;
            });
    }
    return *_vertex.matrix;
}

template class BorderEvaluator<float>;
template class BorderEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

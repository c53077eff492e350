// SPDX-License-Identifier: Apache-2.0
#include "borderEvaluator.h"

#include "bfr_ext/cellTree.h"

namespace OpenSubdivHex::BfrExt::internal {

namespace {

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

// Returns a matrix of the places of an edge, or of a vertex.
template <typename REAL>
PlaceMatrix<REAL> makeMatrix(PlaceSource<REAL> const &source, std::vector<double> const &points) {
    return source.MakeMatrix(points.size(), [&](std::size_t row) {
        return FindBorderStencil(*source.type, points[row], source.GetSources());
    });
}

} // namespace

template <typename REAL>
void BorderEvaluator<REAL>::SetFace(GatheredPoints<REAL> &points) {
    BaseFace const &face = points.GetFace();
    _plain = face.type.GetPlain();
    _type = _plain ? nullptr : &*face.type;
    _turns = face.GetTurns();
    _numEdges = std::size_t(face.size);
    _points = &points;
    _paddedSize = StepMatrix::GetPaddedSize(points.GetSize());
    _edge = {};
    _hasValues = false;
    // As long as the type is there, so are its items and their matrices.
    std::uint64_t const typeNumber = _plain ? 0 : _type->GetNumber();
    if (_plain || _typeNumber != typeNumber) {
        _typeNumber = typeNumber;
        _items.assign(_plain ? 0 : 2 * _numEdges, {});
        _places = {};
        _vertex = {};
    }
}

template <typename REAL>
void BorderEvaluator<REAL>::setValues() {
    _values.Set(_plain->GetRings().GetRings(), _turns + _numEdges,
                _points->GetSources(std::size_t(_points->GetFace().numPoints), nullptr));
    _hasValues = true;
}

template <typename REAL>
void BorderEvaluator<REAL>::EvaluateVertex(std::size_t vert, REAL *result) {
    // All plain faces make the same point of a vertex.
    if (!_plain || !_points->GetShared()) {
        evaluateVertex(vert, result);
        return;
    }
    REAL const *const point =
        _points->GetShared()->FindSurfacePoint(_points->GetFace().GetPoints()[vert], _paddedSize,
                                               [&](REAL *shared) { evaluateVertex(vert, shared); });
    std::copy_n(point, GetSize(), result);
}

template <typename REAL>
void BorderEvaluator<REAL>::evaluateVertex(std::size_t vert, REAL *result) {
    if (_plain) {
        RingCell const *const cell =
            _plain->GetRings().GetVVertex(int(vert), _turns[_numEdges + vert]);
        if (cell) {
            GetRingValues().EvaluateVertex(*cell, int(vert), result);
            return;
        }
    }
    CellType::BorderItem const &item = getItem(_numEdges + vert);
    if (item.rings) {
        _vertexValues.Set(item.rings->rings, nullptr,
                          _points->GetSources(item.points.size(), item.points.data()));
        _vertexValues.EvaluateVertex(*item.rings->cell, 0, result);
    } else {
        PlaceSource<REAL> const source = {item.type, nullptr, _points->Get(), _points->GetStride(),
                                          item.points.data()};
        PlaceMatrix<REAL> const &matrix = find(source.GetPatterns(), PatternOf::Border, 0, _vertex,
                                               [&] { return makeMatrix(source, {0}); });
        source.Evaluate(matrix, GetSize(), result, 0);
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
            REAL const *const points = GetRingValues().GetPoints();
            _indices.resize(cell->GetColumns().size());
            face.FindLongEdgeIndices(
                int(edge), _isReversed,
                [&](int ring, int ofRing) { return _values.GetPointsOfRing(ring, ofRing); },
                _indices.data());
            _edge = {&cell->GetType(), cell, points, std::ptrdiff_t(_paddedSize), _indices.data()};
            return;
        }
    }
    CellType::BorderItem const &item = getItem(edge);
    if (item.type->IsInLattice() || item.type->IsLongEdge()) {
        _edge = {item.type, nullptr, _points->Get(), _points->GetStride(), item.points.data()};
    } else if (item.rings) {
        // Face 0 of both rings is the first face of the edge: this one, or that across the edge.
        std::size_t const next = edge + 1 < _numEdges ? edge + 1 : 0;
        int const *const ofVerts = _turns + _numEdges;
        int const turns[2] = {_isReversed ? ofVerts[next] + 1 : ofVerts[edge],
                              _isReversed ? ofVerts[edge] - 1 : ofVerts[next]};
        _edgeValues.Set(item.rings->rings, turns,
                        _points->GetSources(item.points.size(), item.points.data()));
        RingCell const &cell = *item.rings->cell;
        REAL const *const points = _edgeValues.GetPoints();
        _indices.resize(cell.GetColumns().size());
        cell.GetPlaces().FindIndices([&](int ring) { return _edgeValues.GetPointsOfRing(ring, 0); },
                                     _indices.data());
        _edge = {&cell.GetType(), &cell, points, std::ptrdiff_t(_paddedSize), _indices.data()};
    } else {
        CellType::Child const &longEdge = item.type->GetChildren()[0];
        REAL const *const points = _points->Get();
        _paddedPoints.resize(item.points.size() * _paddedSize);
        for (std::size_t i = 0; i < item.points.size(); ++i) {
            StepMatrix::Pad(points + item.points[i] * _points->GetStride(), GetSize(),
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

// Finds the matrix with a number, such as a level or a rate.
template <typename REAL>
template <typename MAKE>
PlaceMatrix<REAL> const &BorderEvaluator<REAL>::find(PatternTable &patterns, PatternOf of,
                                                     int number, Found &last, MAKE const &make) {
    if (last.patterns != &patterns || last.of != of || last.number != number) {
        int const kind = PatternTable::GetKind<REAL>(of);
        last = {&patterns, of, number,
                &patterns.Get<PlaceMatrix<REAL>>(kind, &number, &number + 1, make)};
    }
    return *last.matrix;
}

template <typename REAL>
void BorderEvaluator<REAL>::evaluateInside(std::size_t edge, bool isRate, int level, REAL *results,
                                           std::ptrdiff_t stride) {
    setEdge(edge);
    auto const make = [&] {
        return makeMatrix(_edge, isRate ? makeRatePoints(level) : makeEdgePoints(level));
    };
    bool const isKept = !isRate || level <= kMaxKeptRate;
    PlaceMatrix<REAL> const &matrix =
        isKept ? find(_edge.GetPatterns(), isRate ? PatternOf::BorderRate : PatternOf::Border,
                      level, _places, make)
               : _placeMatrix = make();
    auto const last = std::ptrdiff_t(matrix.GetNumPlaces()) - 1;
    _edge.Evaluate(matrix, GetSize(), _isReversed ? results + last * stride : results,
                   _isReversed ? -stride : stride);
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
        _edge.Evaluate(makeMatrix(_edge, {point}), GetSize(), result, 0);
        return;
    }
    std::vector<REAL> const &weights = _edge.GetPatterns().template Get<std::vector<REAL>>(
        PatternTable::GetKind<REAL>(PatternOf::BorderPlace), &key, &key + 1, [&] {
            std::vector<double> const stencil =
                _edge.Order(FindBorderStencil(*_edge.type, point, _edge.GetSources()));
            return std::vector<REAL>(stencil.begin(), stencil.end());
        });
    if (_placeMatrix.GetNumPoints() != weights.size()) {
        _placeMatrix = PlaceMatrix<REAL>(1, weights.size());
    }
    _placeMatrix.Set(0, weights);
    _edge.Evaluate(_placeMatrix, GetSize(), result, 0);
}

template class BorderEvaluator<float>;
template class BorderEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

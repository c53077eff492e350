// SPDX-License-Identifier: Apache-2.0
#include "cellValues.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

void CellValues::SetBase(BaseType const &type, double const *controlPoints, int length) {
    _plain = type.GetPlain();
    _type = _plain ? nullptr : &*type;
    int const numPoints = _plain ? _plain->GetNumPoints() : _type->GetNumPoints();
    _level = 0;
    _length = length;
    _paddedSize = StepMatrix::GetPaddedSize(std::size_t(length));
    _numPoints = numPoints;
    _isRefined = false;
    _isInner = false;
    _faceShape = GetShape();
    // Behind them one of zeros, for rings.
    _points.resize(std::max(_points.size(), (std::size_t(numPoints) + 1) * _paddedSize));
    for (std::size_t i = 0; i < std::size_t(numPoints); ++i) {
        StepMatrix::Pad(controlPoints + i * std::size_t(length), std::size_t(length),
                        &_points[i * _paddedSize]);
    }
    std::fill_n(&_points[std::size_t(numPoints) * _paddedSize], _paddedSize, 0.0);
}

int CellValues::GetNumChildren() const {
    return _plain ? 1 + int(_plain->GetRings().GetRings().GetRings().size())
                  : int(_type->GetChildren().size());
}

void CellValues::refine() const {
    if (_isRefined) {
        return;
    }
    _isRefined = true;
    auto const grow = [&](std::size_t numPoints) {
        _refined.resize(std::max(_refined.size(), numPoints * _paddedSize));
    };
    if (_plain) {
        VertexRings const &rings = _plain->GetRings().GetRings();
        grow(rings.GetNumPoints());
        rings.Apply(_points.data(), _paddedSize, _refined.data());
        return;
    }
    StepMatrix const &step = _type->GetStep();
    grow(step.GetNumRows());
    step.Apply(_points.data(), _paddedSize, _refined.data());
}

void CellValues::SetChild(CellValues const &parent, int child) {
    parent.refine();
    _level = parent._level + 1;
    _length = parent._length;
    _paddedSize = parent._paddedSize;
    _plain = nullptr;
    _isRefined = false;
    _isInner = false;
    _faceShape = parent._faceShape;
    auto const grow = [&](int numPoints) {
        _numPoints = numPoints;
        _points.resize(std::max(_points.size(), std::size_t(numPoints) * _paddedSize));
    };
    if (parent._plain) {
        FaceRings const &face = parent._plain->GetRings();
        RingCell const &cell = face.GetChild(std::size_t(child));
        auto const copy = [&](RingPlaces const &places, RingStep step,
                              std::vector<double> &points) {
            std::vector<int> const &columns = places.GetColumns();
            _indices.resize(columns.size());
            face.FindChildIndices(
                std::size_t(child), places,
                [&](int ring, int ofRing) {
                    return face.GetRings().GetPoints(ring, 0, ofRing, step);
                },
                _indices.data());
            for (std::size_t i = 0; i < columns.size(); ++i) {
                StepMatrix::CopyPadded(&parent._refined[std::size_t(_indices[i]) * _paddedSize],
                                       _paddedSize, &points[std::size_t(columns[i]) * _paddedSize]);
            }
        };
        _type = &cell.GetType();
        grow(_type->GetNumPoints());
        copy(cell.GetPoints(), RingStep::First, _points);
        if (cell.IsInner()) {
            _refined.resize(std::max(_refined.size(), cell.GetColumns().size() * _paddedSize));
            copy(cell.GetPlaces(), RingStep::Second, _refined);
            _isRefined = true;
            _isInner = true;
        }
    } else {
        CellType::Child const &link = parent._type->GetChildren()[std::size_t(child)];
        _type = link.type;
        grow(_type->GetNumPoints());
        link.step.CopyPoints(parent._refined.data(), _paddedSize, _points.data());
    }
    if (!_type->IsWhole()) {
        findCoords(parent, child);
    }
}

void CellValues::findCoords(CellValues const &parent, int child) {
    if (parent._plain || parent._type->IsWhole()) {
        _sector = child - 1 + _faceShape.GetFirstSector();
        for (std::size_t i = 0; i < 2; ++i) {
            Pair const &row = HalfCell::kFromSector.rows[i];
            _toCoords[i] = {std::ldexp(row[0], parent._level), std::ldexp(row[1], parent._level)};
        }
        return;
    }
    _sector = parent._sector;
    Multiply(HalfCell::kChildren[std::size_t(child)].rows, parent._toCoords, _toCoords);
}

void CellValues::sum(std::vector<double> const &weights, std::vector<double> const &points,
                     double *result) const {
    constexpr std::size_t kLanes = StepMatrix::kPadding;
    auto const length = std::size_t(_length);
    for (std::size_t first = 0; first < length; first += kLanes) {
        double const *point = points.data() + first;
        double sums[kLanes] = {};
        for (double const weight : weights) {
            for (std::size_t k = 0; k < kLanes; ++k) {
                sums[k] += weight * point[k];
            }
            point += _paddedSize;
        }
        std::copy_n(sums, std::min(kLanes, length - first), result + first);
    }
}

void CellValues::EvaluateCorner(int corner, double *p) const {
    assert(!_isInner);
    sum(GetType().GetCornerPoints()[std::size_t(corner)], _points, p);
}

void CellValues::EvaluateCorner(int corner, double *du, double *dv) const {
    CellType const &type = GetType();
    Pair toCoords[2];
    if (type.IsWhole()) {
        // The corner has the coordinates of its own sector, larger by what the steps have made them.
        std::copy_n(MakeCornerPoint(type.GetShape(), corner, _level).toCoords, 2, toCoords);
    } else {
        Multiply(_toCoords, MakeBasePoint(_faceShape, _sector, {}).toCoords, toCoords);
    }
    for (std::size_t i = 0; i < 2; ++i) {
        double *const result = i == 0 ? du : dv;
        if (_isInner) {
            sum(type.GetDerivatives(corner, StencilOf::Step).rows[i], _refined, result);
        } else {
            sum(type.GetDerivatives(corner).rows[i], _points, result);
        }
    }
    TurnDerivatives(toCoords, std::size_t(_length), du, dv, du, dv);
}

} // namespace OpenSubdivHex::BfrExt::internal

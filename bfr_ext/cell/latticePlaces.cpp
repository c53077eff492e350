// SPDX-License-Identifier: Apache-2.0
#include "latticePlaces.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <queue>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

using FarExt::internal::LimitPatch;

using Place = std::complex<double>;

Place toPlace(Pair const &p) { return {p[0], p[1]}; }

// The corners of a face from one on, as far as its shape goes: a regular polygon, or half a hexagon, with a
// long edge that begins at some corner.
Place getTemplate(std::size_t size, std::size_t corner, std::size_t longEdge, bool isHalf) {
    if (isHalf) {
        std::size_t const local = (corner + size - longEdge) % size;
        return toPlace(ToLattice(HalfCell::kCorners[local]));
    }
    return std::polar(1.0, 2 * FarExt::internal::kPi * double(corner % size) / double(size));
}

// Whether a step makes a regular lattice of the places.
bool keepsPlaces(CellType const &type, std::vector<Pair> const &places) {
    constexpr double kTolerance = 1e-9;
    for (std::size_t child = 0; child < 4; ++child) {
        ChildStep const &step = type.GetChildren()[child].step;
        for (std::size_t i = 0; i < places.size(); ++i) {
            Pair sum = {0, 0};
            step.ForEachEntry(i, [&](std::size_t point, double weight) {
                sum[0] += weight * places[point][0];
                sum[1] += weight * places[point][1];
            });
            Pair const inChild = ToLattice(HalfCell::kChildren[child].Apply(FromLattice(sum)));
            if (!(std::hypot(inChild[0] - places[i][0], inChild[1] - places[i][1]) < kTolerance)) {
                return false;
            }
        }
    }
    return true;
}

// Lays out the faces around a cell one after the other, each from the edge that it shares with one laid out
// before.  A point gets its place from the first of its faces.
class PointPlacer {
public:
    explicit PointPlacer(LimitPatch const &patch)
        : _patch(patch), _places(patch.sources.size()), _isPlaced(patch.sources.size()),
          _isFacePlaced(patch.faceSizes.size()) {
        for (std::size_t face = 0; face < patch.faceSizes.size(); ++face) {
            _faceOfCorner.insert(_faceOfCorner.end(), std::size_t(patch.faceSizes[face]), face);
            _firstCorners.push_back(_faceOfCorner.size());
        }
    }

    // All corners of a face follow from two of them, local and the one after it.
    void PlaceFace(std::size_t face, std::size_t local, Place const &start, Place const &end) {
        std::size_t const size = getSize(face);
        std::size_t const longEdge = findLongEdge(face);
        bool const isHalf = longEdge < size && size == FarExt::internal::kNumHalfCellCorners;
        auto const get = [&](std::size_t corner) {
            return getTemplate(size, corner, longEdge, isHalf);
        };
        Place const scale = (end - start) / (get(local + 1) - get(local));
        for (std::size_t i = 0; i < size; ++i) {
            auto const vert = std::size_t(_patch.faceVerts[_firstCorners[face] + i]);
            if (!_isPlaced[vert]) {
                _places[vert] = start + scale * (get(i) - get(local));
                _isPlaced[vert] = true;
            }
        }
        _isFacePlaced[face] = true;
        _unvisitedFaces.push(face);
    }

    // From the faces placed so far to all that edges join to them.
    void PlaceOtherFaces() {
        while (!_unvisitedFaces.empty()) {
            placeFacesBeside(_unvisitedFaces.front());
            _unvisitedFaces.pop();
        }
    }

    std::vector<Pair> GetPlaces() const {
        std::vector<Pair> places;
        places.reserve(_places.size());
        for (Place const &p : _places) {
            places.push_back({p.real(), p.imag()});
        }
        return places;
    }

private:
    std::size_t getSize(std::size_t face) const { return std::size_t(_patch.faceSizes[face]); }

    // The local index of the long edge, or the size of a face that has none.
    std::size_t findLongEdge(std::size_t face) const {
        auto const begin = _patch.otherCorners.begin() + std::ptrdiff_t(_firstCorners[face]);
        auto const end = begin + _patch.faceSizes[face];
        return std::size_t(std::find(begin, end, Far::Index(FarExt::internal::kSharpBoundaryB)) -
                           begin);
    }

    void placeFacesBeside(std::size_t placed) {
        std::size_t const first = _firstCorners[placed];
        std::size_t const size = getSize(placed);
        auto const getPlace = [&](std::size_t local) {
            return _places[std::size_t(_patch.faceVerts[first + local % size])];
        };
        for (std::size_t local = 0; local < size; ++local) {
            Far::Index const other = _patch.otherCorners[first + local];
            if (other < 0) {
                continue;
            }
            std::size_t const face = _faceOfCorner[std::size_t(other)];
            if (!_isFacePlaced[face]) {
                PlaceFace(face, std::size_t(other) - _firstCorners[face], getPlace(local + 1),
                          getPlace(local));
            }
        }
    }

    LimitPatch const &_patch;
    std::vector<std::size_t> _firstCorners = {0};
    std::vector<std::size_t> _faceOfCorner;
    std::vector<Place> _places;
    std::vector<bool> _isPlaced;
    std::vector<bool> _isFacePlaced;
    std::queue<std::size_t> _unvisitedFaces; // placed, but not yet those beside them
};

} // namespace

// A half cell is half of a regular hexagon.
Pair ToLattice(Pair const &p) { return {p[0], p[1] * std::sqrt(0.75)}; }
Pair FromLattice(Pair const &p) { return {p[0], p[1] / std::sqrt(0.75)}; }

std::vector<Pair> PlacePoints(FarExt::internal::CellPatch const &cell) {
    PointPlacer placer(cell.patch);
    // Corners 1 and 2 follow one another in the face.
    placer.PlaceFace(0, std::size_t(cell.locals[1]), toPlace(ToLattice(HalfCell::kCorners[1])),
                     toPlace(ToLattice(HalfCell::kCorners[2])));
    placer.PlaceOtherFaces();
    return placer.GetPlaces();
}

std::vector<Pair> FindLatticePlaces(CellType const &type) {
    if (type.GetKind() != FarExt::internal::CellKind::Half || !type.IsRegular()) {
        return {};
    }
    FarExt::internal::CellPatch const cell = type.MakeCell();
    std::vector<int> const &sizes = cell.patch.faceSizes;
    constexpr int kSize = 6;
    if (std::any_of(sizes.begin(), sizes.end(), [](int size) { return size != kSize; })) {
        return {};
    }
    std::vector<Pair> places = PlacePoints(cell);
    return keepsPlaces(type, places) ? places : std::vector<Pair>();
}

} // namespace OpenSubdivHex::BfrExt::internal

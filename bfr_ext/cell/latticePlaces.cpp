// SPDX-License-Identifier: Apache-2.0
#include "latticePlaces.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

using FarExt::internal::LimitPatch;

using Place = std::complex<double>;

Pair fromLattice(Pair const &p) { return {p[0], p[1] / std::sqrt(0.75)}; }
Place toPlace(Pair const &p) { return {p[0], p[1]}; }

// The corners of a face from one on, as far as its shape goes: a regular polygon, or half a hexagon, with a
// long edge that begins at some corner.
Place getTemplate(std::size_t size, std::size_t corner, std::size_t longEdge, bool isHalf) {
    constexpr double kTurn = 6.283185307179586;
    if (isHalf) {
        std::size_t const local = (corner + size - longEdge) % size;
        return toPlace(ToLattice(HalfCell::kCorners[local]));
    }
    return std::polar(1.0, kTurn * double(corner % size) / double(size));
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
            Pair const inChild = ToLattice(HalfCell::kChildren[child].Apply(fromLattice(sum)));
            if (!(std::hypot(inChild[0] - places[i][0], inChild[1] - places[i][1]) < kTolerance)) {
                return false;
            }
        }
    }
    return true;
}

} // namespace

// A half cell is half of a regular hexagon.
Pair ToLattice(Pair const &p) { return {p[0], p[1] * std::sqrt(0.75)}; }

std::vector<Pair> PlacePoints(FarExt::internal::CellPatch const &cell) {
    LimitPatch const &patch = cell.patch;
    std::size_t const numFaces = patch.faceSizes.size();
    std::vector<std::size_t> firstCorners = {0};
    std::vector<std::size_t> faceOfCorner;
    for (std::size_t face = 0; face < numFaces; ++face) {
        faceOfCorner.insert(faceOfCorner.end(), std::size_t(patch.faceSizes[face]), face);
        firstCorners.push_back(faceOfCorner.size());
    }
    std::vector<Place> places(patch.sources.size());
    std::vector<bool> isPlaced(places.size());
    std::vector<bool> isDone(numFaces);
    std::vector<std::size_t> faces;
    // All corners of a face follow from two of them.
    auto const place = [&](std::size_t face, std::size_t local, Place const &start,
                           Place const &end) {
        auto const size = std::size_t(patch.faceSizes[face]);
        auto const begin = patch.otherCorners.begin() + std::ptrdiff_t(firstCorners[face]);
        auto const longEdge = std::size_t(std::find(begin, begin + std::ptrdiff_t(size),
                                                    Far::Index(FarExt::internal::kSharpBoundaryB)) -
                                          begin);
        bool const isHalf = longEdge < size && size == FarExt::internal::kNumHalfCellCorners;
        auto const get = [&](std::size_t corner) {
            return getTemplate(size, corner, longEdge, isHalf);
        };
        Place const scale = (end - start) / (get(local + 1) - get(local));
        for (std::size_t i = 0; i < size; ++i) {
            auto const vert = std::size_t(patch.faceVerts[firstCorners[face] + i]);
            if (!isPlaced[vert]) {
                places[vert] = start + scale * (get(i) - get(local));
                isPlaced[vert] = true;
            }
        }
        isDone[face] = true;
        faces.push_back(face);
    };
    // Corners 1 and 2 follow one another in the face.
    place(0, std::size_t(cell.locals[1]), toPlace(ToLattice(HalfCell::kCorners[1])),
          toPlace(ToLattice(HalfCell::kCorners[2])));
    for (std::size_t next = 0; next < faces.size();) {
        std::size_t const placed = faces[next++];
        std::size_t const first = firstCorners[placed];
        auto const size = std::size_t(patch.faceSizes[placed]);
        for (std::size_t local = 0; local < size; ++local) {
            Far::Index const other = patch.otherCorners[first + local];
            if (other < 0 || isDone[faceOfCorner[std::size_t(other)]]) {
                continue;
            }
            std::size_t const face = faceOfCorner[std::size_t(other)];
            auto const getEnd = [&](std::size_t corner) {
                return places[std::size_t(patch.faceVerts[first + corner % size])];
            };
            place(face, std::size_t(other) - firstCorners[face], getEnd(local + 1), getEnd(local));
        }
    }
    std::vector<Pair> result;
    result.reserve(places.size());
    for (Place const &p : places) {
        result.push_back({p.real(), p.imag()});
    }
    return result;
}

std::vector<Pair> FindLatticePlaces(CellType const &type) {
    if (type.GetCell().kind != FarExt::internal::CellKind::Half || !type.IsRegular()) {
        return {};
    }
    std::vector<int> const &sizes = type.GetCell().patch.faceSizes;
    constexpr int kSize = 6;
    if (std::any_of(sizes.begin(), sizes.end(), [](int size) { return size != kSize; })) {
        return {};
    }
    std::vector<Pair> places = PlacePoints(type.GetCell());
    return keepsPlaces(type, places) ? places : std::vector<Pair>();
}

} // namespace OpenSubdivHex::BfrExt::internal

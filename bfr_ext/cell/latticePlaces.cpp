// SPDX-License-Identifier: Apache-2.0
#include "latticePlaces.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

using FarExt::internal::LimitPatch;

Pair fromLattice(Pair const &p) { return {p[0], p[1] / std::sqrt(0.75)}; }

// The places of the points of a half cell, if the faces of its patch are hexagons of a regular lattice.
std::vector<Pair> findPlaces(FarExt::internal::CellPatch const &cell) {
    LimitPatch const &patch = cell.patch;
    constexpr std::size_t kSize = 6;
    bool const isHalf = cell.kind == FarExt::internal::CellKind::Half;
    if (!isHalf || std::any_of(patch.faceSizes.begin(), patch.faceSizes.end(),
                               [](int size) { return size != int(kSize); })) {
        return {};
    }
    std::size_t const numFaces = patch.faceSizes.size();
    std::vector<Pair> places(patch.sources.size());
    std::vector<bool> isPlaced(places.size());
    std::vector<Pair> centers(numFaces);
    std::vector<bool> isDone(numFaces);
    // All corners of a face follow from its centre and two of them.
    auto const place = [&](std::size_t face, std::size_t local, Pair const &first,
                           Pair const &second, Pair const &center) {
        Pair from = {first[0] - center[0], first[1] - center[1]};
        Pair to = {second[0] - center[0], second[1] - center[1]};
        for (std::size_t i = 0; i < kSize; ++i) {
            auto const vert = std::size_t(patch.faceVerts[kSize * face + (local + i) % kSize]);
            places[vert] = {center[0] + from[0], center[1] + from[1]};
            isPlaced[vert] = true;
            Pair const next = {to[0] - from[0], to[1] - from[1]};
            from = to;
            to = next;
        }
        centers[face] = center;
        isDone[face] = true;
    };
    // Corners 1, 2 and 3 of a half cell follow one another in the hexagon.
    Pair const center = ToLattice({0.5, 0});
    place(0, std::size_t(cell.locals[1]), ToLattice(HalfCell::kCorners[1]),
          ToLattice(HalfCell::kCorners[2]), center);
    std::vector<std::size_t> faces = {0};
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (std::size_t local = 0; local < kSize; ++local) {
            std::size_t const corner = kSize * faces[i] + local;
            Far::Index const other = patch.otherCorners[corner];
            if (other < 0 || isDone[std::size_t(other) / kSize]) {
                continue;
            }
            std::size_t const face = std::size_t(other) / kSize;
            Pair const &start = places[std::size_t(patch.faceVerts[corner])];
            Pair const &end =
                places[std::size_t(patch.faceVerts[kSize * faces[i] + (local + 1) % kSize])];
            Pair const &own = centers[faces[i]];
            place(face, std::size_t(other) % kSize, end, start,
                  {start[0] + end[0] - own[0], start[1] + end[1] - own[1]});
            faces.push_back(face);
        }
    }
    bool const areAllPlaced = std::find(isPlaced.begin(), isPlaced.end(), false) == isPlaced.end();
    return areAllPlaced ? places : std::vector<Pair>();
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

std::vector<Pair> FindLatticePlaces(CellType const &type) {
    if (type.IsWhole() || !type.IsRegular()) {
        return {};
    }
    std::vector<Pair> places = findPlaces(type.GetCell());
    return !places.empty() && keepsPlaces(type, places) ? places : std::vector<Pair>();
}

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "mirrorMatrix.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

using Images = Symmetries::Images;

// By how much weights of stencils that are images of each other differ at most, which is rounding.
constexpr double kImageTolerance = 1e-12;

// 1, or -1 where what has a parity turns its sign in an image.
double getSign(std::size_t parity, std::size_t image) {
    std::size_t const both = parity & image;
    return both == 1 || both == 2 ? -1 : 1;
}

bool areImages(std::vector<double> const &stencil, std::vector<double> const &other,
               std::vector<Images> const &pointImages, std::size_t image, double sign) {
    for (std::size_t point = 0; point < stencil.size(); ++point) {
        auto const ofOther = std::size_t(pointImages[point][image]);
        if (!(std::abs(sign * stencil[point] - other[ofOther]) <= kImageTolerance)) {
            return false;
        }
    }
    return true;
}

} // namespace

template <typename REAL>
MirrorMatrix<REAL>::MirrorMatrix(Symmetries const &symmetries, std::vector<BasePoint> const &places,
                                 std::size_t first,
                                 std::vector<std::vector<double>> const &stencils,
                                 std::size_t parity)
    : _numPoints(symmetries.GetPointImages().size()) {
    assert(_numPoints <= kMaxPoints);
    findOrbits(symmetries);
    std::size_t const numImages = symmetries.GetNumImages();
    std::vector<Images> const placeImages = symmetries.FindPlaceImages(places);
    std::vector<std::size_t> slots;             // by slot, the place that stands for it
    std::vector<int> ofPlaces(stencils.size()); // slots and images
    std::vector<bool> isDone(stencils.size());
    for (std::size_t place = 0; place < stencils.size(); ++place) {
        if (isDone[place]) {
            continue;
        }
        for (std::size_t image = 0; image < numImages; ++image) {
            int const other = placeImages[first + place][image] - int(first);
            if (other >= 0 && !isDone[std::size_t(other)] &&
                areImages(stencils[place], stencils[std::size_t(other)],
                          symmetries.GetPointImages(), image, getSign(parity, image))) {
                isDone[std::size_t(other)] = true;
                ofPlaces[std::size_t(other)] = int(slots.size() * numImages + image);
            }
        }
        slots.push_back(place);
    }
    findTargets(ofPlaces, slots.size(), numImages);
    // Points of one parity make what has that of the stencils besides.
    for (std::size_t part = 0; part < numImages; ++part) {
        std::size_t const ofPoints = part ^ parity;
        std::size_t const firstColumn = _firstColumns[ofPoints];
        _parts.push_back(
            {PlaceMatrix<REAL>(slots.size(), _firstColumns[ofPoints + 1] - firstColumn),
             firstColumn});
    }
    for (std::size_t slot = 0; slot < slots.size(); ++slot) {
        std::vector<double> const weights = findParts(stencils[slots[slot]]);
        for (Part &part : _parts) {
            auto const begin = weights.begin() + std::ptrdiff_t(part.firstColumn);
            part.matrix.Set(slot, {begin, begin + std::ptrdiff_t(part.matrix.GetNumPoints())});
        }
    }
}

// By place, \p ofPlaces has the slot times the number of images, and the image.
template <typename REAL>
void MirrorMatrix<REAL>::findTargets(std::vector<int> const &ofPlaces, std::size_t numSlots,
                                     std::size_t numImages) {
    constexpr std::size_t kMaxWidth = PlaceMatrix<REAL>::kMaxWidth;
    _targets.resize((numSlots + kMaxWidth - 1) / kMaxWidth);
    auto const getBlock = [&](std::size_t place) {
        return std::size_t(ofPlaces[place]) / numImages / kMaxWidth;
    };
    for (std::size_t place = 0; place < ofPlaces.size(); ++place) {
        std::size_t const slot = std::size_t(ofPlaces[place]) / numImages;
        std::size_t const image = std::size_t(ofPlaces[place]) % numImages;
        Target const target = {int(image * kMaxWidth + slot % kMaxWidth), int(place)};
        Targets &targets = _targets[getBlock(place)];
        bool const isFollowed =
            place + 1 < ofPlaces.size() && getBlock(place + 1) >= getBlock(place);
        (isFollowed ? targets.followed : targets.others).push_back(target);
    }
}

template <typename REAL>
void MirrorMatrix<REAL>::findOrbits(Symmetries const &symmetries) {
    std::size_t const numImages = symmetries.GetNumImages();
    std::vector<Images> const &images = symmetries.GetPointImages();
    std::vector<bool> isDone(_numPoints);
    std::vector<std::vector<std::pair<std::size_t, std::size_t>>> columns(numImages);
    for (std::size_t point = 0; point < _numPoints; ++point) {
        if (isDone[point]) {
            continue;
        }
        Orbit orbit = {};
        for (std::size_t image = 0; image < numImages; ++image) {
            int const other = images[point][image];
            if (!isDone[std::size_t(other)]) {
                isDone[std::size_t(other)] = true;
                orbit.points[std::size_t(orbit.size++)] = other;
            }
        }
        // What an image does not change has the parities under which its sign is not turned.
        std::size_t numColumns = 0;
        for (std::size_t parity = 0; parity < numImages; ++parity) {
            bool isOfOrbit = true;
            for (std::size_t image = 0; image < numImages; ++image) {
                isOfOrbit =
                    isOfOrbit && (images[point][image] != int(point) || getSign(parity, image) > 0);
            }
            if (isOfOrbit) {
                columns[parity].emplace_back(_orbits.size(), numColumns++);
            }
        }
        _orbits.push_back(orbit);
    }
    std::size_t numColumns = 0;
    for (auto const &ofParity : columns) {
        _firstColumns.push_back(numColumns);
        for (auto const &[orbit, place] : ofParity) {
            _orbits[orbit].columns[place] = int(numColumns++);
        }
    }
    _firstColumns.push_back(numColumns);
}

// The weights of the sums of points, by column.
template <typename REAL>
std::vector<double> MirrorMatrix<REAL>::findParts(std::vector<double> const &stencil) const {
    std::vector<double> weights(_numPoints);
    for (Orbit const &orbit : _orbits) {
        for (std::size_t i = 0; i < std::size_t(orbit.size); ++i) {
            double sum = 0;
            for (std::size_t k = 0; k < std::size_t(orbit.size); ++k) {
                sum += getSign(i, k) * stencil[std::size_t(orbit.points[k])];
            }
            weights[std::size_t(orbit.columns[i])] = sum / orbit.size;
        }
    }
    return weights;
}

template class MirrorMatrix<float>;
template class MirrorMatrix<double>;

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "symmetries.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::LimitPatch;

namespace {

int wrap(int corner, int faceSize) { return (corner % faceSize + faceSize) % faceSize; }

// The images of a patch's vertices, of whose face 0 the corners become those that add up with them to
// shift; none where the patch is not symmetrical in this way.
std::vector<int> reflect(LimitPatch const &patch, int faceSize, int shift) {
    struct Face {
        int image = -1;
        int shift = 0;
    };
    std::vector<Face> faces(patch.faceSizes.size());
    std::vector<int> order = {0};
    faces[0] = {0, shift};
    std::vector<int> images(patch.sources.size(), -1);
    for (std::size_t i = 0; i < order.size(); ++i) {
        Face const face = faces[std::size_t(order[i])];
        for (int corner = 0; corner < faceSize; ++corner) {
            int const own = order[i] * faceSize + corner;
            int const first = face.image * faceSize;
            int &image = images[std::size_t(patch.faceVerts[std::size_t(own)])];
            int const cornerImage = first + wrap(face.shift - corner, faceSize);
            int const vert = patch.faceVerts[std::size_t(cornerImage)];
            if (image >= 0 && image != vert) {
                return {};
            }
            image = vert;
            // Edges become edges that begin where the others end.
            int const other = patch.otherCorners[std::size_t(own)];
            int const edgeImage = first + wrap(face.shift - corner - 1, faceSize);
            int const otherImage = patch.otherCorners[std::size_t(edgeImage)];
            if (other < 0 || otherImage < 0) {
                if (other != otherImage) {
                    return {};
                }
                continue;
            }
            Face &next = faces[std::size_t(other / faceSize)];
            Face const expected = {otherImage / faceSize,
                                   wrap(other % faceSize + otherImage % faceSize + 1, faceSize)};
            if (next.image < 0) {
                next = expected;
                order.push_back(other / faceSize);
            } else if (next.image != expected.image || next.shift != expected.shift) {
                return {};
            }
        }
    }
    return images;
}

} // namespace

Symmetries::Symmetries(CellType const &type, Kind kind) : _faceSize(type.GetNumCorners()) {
    LimitPatch const &patch = type.GetCell().patch;
    for (std::size_t point = 0; point < patch.sources.size(); ++point) {
        _pointImages.push_back({int(point), int(point), int(point), int(point)});
    }
    std::vector<std::vector<int>> wanted;
    int const across = 1 + _faceSize / 2;
    bool const isEven = _faceSize % 2 == 0;
    if (kind == Kind::Reflections) {
        wanted.push_back({1});
        if (isEven) {
            wanted.push_back({across});
        }
    } else if (isEven) {
        wanted.push_back({1, across});
    }
    for (std::vector<int> const &shifts : wanted) {
        std::vector<Images> pointImages = _pointImages;
        std::size_t const bit = GetNumImages();
        for (Images &images : pointImages) {
            std::copy_n(images.begin(), bit, images.begin() + std::ptrdiff_t(bit));
        }
        bool isSymmetry = true;
        for (int const shift : shifts) {
            std::vector<int> const reflected = reflect(patch, _faceSize, shift);
            isSymmetry = isSymmetry && !reflected.empty();
            for (std::size_t point = 0; isSymmetry && point < pointImages.size(); ++point) {
                for (std::size_t image = bit; image < 2 * bit; ++image) {
                    int &ofPoint = pointImages[point][image];
                    ofPoint = reflected[std::size_t(ofPoint)];
                }
            }
        }
        if (!isSymmetry) {
            break;
        }
        _pointImages = std::move(pointImages);
        _reflections.push_back(shifts);
    }
}

std::vector<Symmetries::Images>
Symmetries::FindPlaceImages(std::vector<BasePoint> const &places) const {
    using Key = std::tuple<int, double, double>;
    // The line from the centre to a corner belongs to the sector that begins there.
    auto const getKey = [&](int sector, Pair const &coords) {
        return coords[0] == 0 ? Key{wrap(sector + 1, _faceSize), coords[1], 0}
                              : Key{sector, coords[0], coords[1]};
    };
    std::map<Key, int> numbers;
    for (std::size_t place = 0; place < places.size(); ++place) {
        numbers.emplace(getKey(places[place].sector, places[place].coords), int(place));
    }
    std::vector<Images> result;
    for (BasePoint const &place : places) {
        Images images;
        images.fill(-1);
        for (std::size_t image = 0; image < GetNumImages(); ++image) {
            int sector = place.sector;
            Pair coords = place.coords;
            for (std::size_t i = 0; i < _reflections.size(); ++i) {
                if ((image >> i) % 2 == 0) {
                    continue;
                }
                for (int const shift : _reflections[i]) {
                    sector = wrap(shift - sector - 1, _faceSize);
                    coords = {coords[1], coords[0]};
                }
            }
            auto const found = numbers.find(getKey(sector, coords));
            images[image] = found == numbers.end() ? -1 : found->second;
        }
        result.push_back(images);
    }
    return result;
}

} // namespace OpenSubdivHex::BfrExt::internal

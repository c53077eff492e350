// SPDX-License-Identifier: Apache-2.0
#include "packedCell.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <type_traits>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

using namespace FarExt::internal;

namespace {

constexpr std::size_t kMaxBytesOfNumber = 5;

char *packNumber(std::uint32_t number, char *to) {
    std::uint32_t rest = number << 1 ^ (number >> 31 != 0 ? ~std::uint32_t(0) : 0);
    for (; rest >= 0x80; rest >>= 7) {
        *to++ = char(rest | 0x80);
    }
    *to++ = char(rest);
    return to;
}

template <typename T>
constexpr std::size_t kNumWords = sizeof(T) / sizeof(std::uint32_t);

// Appends what it is given.
class Packer {
public:
    explicit Packer(std::string &bytes) : _bytes(bytes) {}

    template <typename T>
    void Number(T number) {
        PackNumber(int(number), _bytes);
    }
    template <typename T>
    void Array(std::vector<T> const &array) {
        Number(array.size());
        addElements(array);
    }
    /// Of a known size, and mostly 0.
    void Tags(std::vector<float> const &tags, std::size_t /*size*/) {
        bool const hasAny =
            std::any_of(tags.begin(), tags.end(), [](float tag) { return tag != 0; });
        Number(hasAny);
        if (hasAny) {
            addElements(tags);
        }
    }
    void Array(QuadCorners const &quads) {
        Array(std::vector<QuadCorner>(quads.begin(), quads.end()));
    }

private:
    template <typename T>
    void addElements(std::vector<T> const &array) {
        static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(std::uint32_t) == 0);
        std::size_t const size = _bytes.size();
        _bytes.resize(size + array.size() * kNumWords<T> * kMaxBytesOfNumber);
        char *to = &_bytes[size];
        for (T const &element : array) {
            std::uint32_t words[kNumWords<T>];
            std::memcpy(words, &element, sizeof element);
            for (std::uint32_t const word : words) {
                to = packNumber(word, to);
            }
        }
        _bytes.resize(std::size_t(to - _bytes.data()));
    }

    std::string &_bytes;
};

// Takes back what a Packer was given.
class Unpacker {
public:
    explicit Unpacker(char const *bytes) : _next(bytes) {}

    template <typename T>
    void Number(T &number) {
        number = T(take());
    }
    template <typename T>
    void Array(std::vector<T> &array) {
        array.resize(take());
        takeElements(array);
    }
    void Tags(std::vector<float> &tags, std::size_t size) {
        tags.assign(size, 0.0f);
        if (take() != 0) {
            takeElements(tags);
        }
    }
    void Array(QuadCorners &quads) {
        std::vector<QuadCorner> array;
        Array(array);
        std::for_each(array.begin(), array.end(),
                      [&](QuadCorner const &quad) { quads.push_back(quad); });
    }

private:
    std::uint32_t take() {
        std::uint32_t rest = 0;
        int shift = 0;
        for (; (*_next & 0x80) != 0; shift += 7) {
            rest |= std::uint32_t(*_next++ & 0x7f) << shift;
        }
        rest |= std::uint32_t(*_next++) << shift;
        return rest >> 1 ^ ((rest & 1) != 0 ? ~std::uint32_t(0) : 0);
    }
    template <typename T>
    void takeElements(std::vector<T> &array) {
        for (T &element : array) {
            std::uint32_t words[kNumWords<T>];
            for (std::uint32_t &word : words) {
                word = take();
            }
            std::memcpy(&element, words, sizeof element);
        }
    }

    char const *_next;
};

// Gives all parts of a cell to a packer or unpacker, but for those that follow from others.
template <typename PACKER, typename CELL>
void packParts(PACKER packer, CELL &cell) {
    auto &patch = cell.patch;
    packer.Number(cell.kind);
    packer.Array(cell.locals);
    std::size_t numPoints = patch.sources.size();
    packer.Number(numPoints);
    packer.Array(patch.faceSizes);
    packer.Array(patch.faceVerts);
    packer.Array(patch.otherCorners);
    packer.Tags(patch.edgeSharpness, patch.faceVerts.size());
    packer.Tags(patch.diagonalSharpness, patch.faceSizes.size());
    packer.Tags(patch.vertSharpness, numPoints);
    packer.Array(patch.crossedFaces);
    packer.Array(patch.nonManifoldVerts);
    packer.Array(patch.lineCorners);
    packer.Array(patch.lines);
    packer.Array(patch.sharpVerts);
    packer.Array(patch.sharpEnds);
    packer.Array(patch.irregularVerts);
    packer.Number(patch.numHexagonalSteps);
    packer.Number(patch.hasFirstLineMasks);
    CornerTags::ForEachKind([&](auto &tags) { packer.Array(tags); }, patch);
    if constexpr (!std::is_const_v<CELL>) {
        patch.sources.resize(numPoints);
    }
}

} // namespace

void PackNumber(int number, std::string &bytes) {
    char packed[kMaxBytesOfNumber];
    bytes.append(packed, packNumber(std::uint32_t(number), packed));
}

void PackCell(CellPatch const &cell, std::string &bytes) { packParts(Packer(bytes), cell); }

CellPatch UnpackCell(std::string const &bytes) {
    CellPatch cell;
    packParts(Unpacker(bytes.data()), cell);
    std::iota(cell.patch.sources.begin(), cell.patch.sources.end(), 0);
    for (int const local : cell.locals) {
        cell.corners.push_back(cell.patch.faceVerts[std::size_t(local)]);
    }
    return cell;
}

} // namespace OpenSubdivHex::BfrExt::internal

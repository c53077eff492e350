// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_SHARED_RINGS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_SHARED_RINGS_H

#include <opensubdiv/far/types.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

namespace Far = OpenSubdiv::Far;

/// \brief The rings of some vertices of a mesh, and the points of the surface there, each made by the first face that asks
/// for it: other faces would make the same, to the bit.
///
/// The points lie in one block of memory, in which new ones overwrite the oldest.  Points that are found stay until half of
/// the block is overwritten.  One thread uses an object at a time, for one array of points of one size.
template <typename REAL>
class SharedRings {
public:
    /// Bytes of the points; up to kNumEntries vertices take 24 more each.
    static constexpr std::size_t kNumBytes = std::size_t(1) << 20;

    /// Whether the rings of a face with so many points stay until the face is done.
    ///
    /// \param paddedSize  numbers of a point, here and below
    static bool HasRoom(std::size_t numPoints, std::size_t paddedSize) {
        return numPoints <= getCapacity(paddedSize) / 8;
    }
    /// The points of all vertices; null before the first is made.
    REAL const *GetPoints() const { return _numbers.get(); }

    /// Whether FindRing() would make nothing.
    bool HasRing(Far::Index vertex, std::size_t paddedSize) {
        return isKnown(getEntry(vertex, paddedSize).ring);
    }
    /// \brief The number of the first of the points of a vertex's ring among GetPoints(); they are one behind the other.
    ///
    /// \param make  make(points) writes them where they are not known
    template <typename MAKE>
    std::size_t FindRing(Far::Index vertex, std::size_t numPoints, std::size_t paddedSize,
                         MAKE const &make) {
        return find(getEntry(vertex, paddedSize).ring, numPoints, paddedSize, make);
    }
    /// The point of the surface at a vertex, which make(point) writes where it is not known.
    template <typename MAKE>
    REAL const *FindSurfacePoint(Far::Index vertex, std::size_t paddedSize, MAKE const &make) {
        std::size_t const point =
            find(getEntry(vertex, paddedSize).surfacePoint, 1, paddedSize, make);
        return _numbers.get() + point * paddedSize;
    }

private:
    // Numbers of points that count on where the block begins anew: modulo the capacity they are places in the block.
    struct Entry {
        Far::Index vertex = Far::INDEX_INVALID;
        std::uint64_t ring = 0; // 0: not known
        std::uint64_t surfacePoint = 0;
    };

    static constexpr std::size_t kNumEntries = 4096;

    static std::size_t getCapacity(std::size_t paddedSize) {
        return kNumBytes / (paddedSize * sizeof(REAL));
    }

    Entry &getEntry(Far::Index vertex, std::size_t paddedSize) {
        if (!_numbers) {
            _entries.resize(kNumEntries);
            _capacity = getCapacity(paddedSize);
            _end = 2 * _capacity;
            _numbers.reset(new REAL[_capacity * paddedSize]); // not initialized
        }
        Entry &entry = _entries[std::size_t(vertex) % kNumEntries];
        if (entry.vertex != vertex) {
            entry = {vertex, 0, 0};
        }
        return entry;
    }

    bool isKnown(std::uint64_t number) const { return _end - number <= _capacity / 2; }

    template <typename MAKE>
    std::size_t find(std::uint64_t &number, std::size_t numPoints, std::size_t paddedSize,
                     MAKE const &make) {
        if (!isKnown(number)) {
            std::size_t const left = _capacity - _end % _capacity;
            number = left < numPoints ? _end + left : _end;
            _end = number + numPoints;
            make(&_numbers[number % _capacity * paddedSize]);
        }
        return number % _capacity;
    }

    std::vector<Entry> _entries;
    std::unique_ptr<REAL[]> _numbers;
    std::uint64_t _capacity = 0; // in points
    std::uint64_t _end = 0;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_KEPT_FACES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_KEPT_FACES_H

#include <opensubdiv/far/types.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

namespace Far = OpenSubdiv::Far;

/// \brief The types and the points that surfaces of a mesh's faces have: what a face has is kept when it was
/// found twice, as long as there is memory.
///
/// Any number of threads may use it; what is there already is found without a lock.
///
/// \tparam TYPE  of faces; it has no destructor
template <typename TYPE>
class KeptFaces {
public:
    using Index = Far::Index;

    /// A face, behind which its points and turns lie.
    struct Face {
        Index const *GetPoints() const { return reinterpret_cast<Index const *>(this + 1); }

        TYPE type;
        int size;
        int numPoints; ///< without the turns
    };

    /// \param owner      of the types
    /// \param numKinds   of data, each of which has points of its own
    /// \param maxMemory  in bytes; what would take more is not kept
    KeptFaces(std::shared_ptr<void const> owner, int numFaces, std::size_t numKinds,
              std::size_t maxMemory)
        : _owner(std::move(owner)), _numFaces(numFaces), _maxMemory(maxMemory), _kinds(numKinds) {}
    KeptFaces(KeptFaces const &) = delete;
    KeptFaces &operator=(KeptFaces const &) = delete;

    /// Null for a face that is not kept or is none.
    Face const *Find(std::size_t kind, Index face) const {
        Slot const *const slots = _kinds[kind].slots.load(std::memory_order_acquire);
        if (!slots || std::size_t(face) >= std::size_t(_numFaces)) {
            return nullptr;
        }
        Face const *const found = slots[face].load(std::memory_order_acquire);
        return found == &_metOnce ? nullptr : found;
    }

    /// \brief Keeps a face that is added a second time: for others it is not worth the memory.
    ///
    /// \param points  its points and turns
    /// \return        the one that is kept; null where none is
    Face const *Add(std::size_t kind, Index face, TYPE const &type, int size,
                    std::vector<Index> const &points) {
        // Without this, all threads would wait for the lock with each face that there is no memory for.
        if (_isFull.load(std::memory_order_relaxed) ||
            _kinds[kind].isRefused.load(std::memory_order_relaxed)) {
            return nullptr;
        }
        Slot *const slots = getSlots(kind);
        if (!slots) {
            return nullptr;
        }
        Face const *found = nullptr;
        if (slots[face].compare_exchange_strong(found, &_metOnce, std::memory_order_acquire)) {
            return nullptr;
        }
        if (found != &_metOnce) {
            return found; // another thread was faster
        }
        std::lock_guard<std::mutex> const lock(_mutex);
        found = slots[face].load(std::memory_order_relaxed);
        if (found != &_metOnce) {
            return found;
        }
        void *const memory = allocate(sizeof(Face) + points.size() * sizeof(Index));
        if (!memory) {
            return nullptr;
        }
        Face *const added = new (memory) Face{type, size, int(points.size()) - 2 * size};
        std::copy(points.begin(), points.end(), reinterpret_cast<Index *>(added + 1));
        slots[face].store(added, std::memory_order_release);
        return added;
    }

private:
    static_assert(std::is_trivially_destructible_v<TYPE>);
    static_assert(alignof(Index) <= alignof(Face));

    using Slot = std::atomic<Face const *>;
    struct Kind {
        std::atomic<Slot *> slots{nullptr}; // by face
        std::unique_ptr<Slot[]> memory;
        std::atomic<bool> isRefused{false}; // there was no memory for the slots
    };
    // Faces lie in blocks, one behind the other.
    static constexpr std::size_t kBlockSize = 1 << 16;

    // Null where there is no memory.
    Slot *getSlots(std::size_t kind) {
        Kind &ofKind = _kinds[kind];
        Slot *slots = ofKind.slots.load(std::memory_order_acquire);
        if (slots) {
            return slots;
        }
        std::lock_guard<std::mutex> const lock(_mutex);
        if (!ofKind.memory && takeMemory(std::size_t(_numFaces) * sizeof(Slot))) {
            ofKind.memory.reset(new Slot[std::size_t(_numFaces)]());
            ofKind.slots.store(ofKind.memory.get(), std::memory_order_release);
        }
        ofKind.isRefused.store(!ofKind.memory, std::memory_order_relaxed);
        return ofKind.memory.get();
    }

    bool takeMemory(std::size_t size) {
        if (size > _maxMemory - _numBytes) {
            return false;
        }
        _numBytes += size;
        return true;
    }

    void *allocate(std::size_t size) {
        size = (size + alignof(Face) - 1) / alignof(Face) * alignof(Face);
        if (size > _numLeft) {
            std::size_t const blockSize = std::max(size, kBlockSize);
            if (!takeMemory(blockSize)) {
                _isFull.store(true, std::memory_order_relaxed);
                return nullptr;
            }
            // Not written before it is used.
            _blocks.emplace_back(new std::byte[blockSize]);
            _next = _blocks.back().get();
            _numLeft = blockSize;
        }
        void *const result = _next;
        _next += size;
        _numLeft -= size;
        return result;
    }

    std::shared_ptr<void const> const _owner;
    int const _numFaces;
    std::size_t const _maxMemory;
    Face const _metOnce{}; // whose address stands for faces that are not kept yet
    std::mutex _mutex;
    std::vector<Kind> _kinds;
    std::atomic<bool> _isFull{false}; // there was no memory for more faces
    std::size_t _numBytes = 0;
    std::vector<std::unique_ptr<std::byte[]>> _blocks;
    std::byte *_next = nullptr;
    std::size_t _numLeft = 0;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_KEPT_FACES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_KEPT_FACES_H

#include "memoryCount.h"

#include <opensubdiv/far/types.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <new>
#include <type_traits>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

namespace Far = OpenSubdiv::Far;

/// A face, behind which its points and turns lie.
template <typename TYPE>
struct KeptFace {
    using Index = Far::Index;

    Index const *GetPoints() const { return reinterpret_cast<Index const *>(this + 1); }
    Index const *GetTurns() const { return GetPoints() + numPoints; }

    /// Its bytes, with \p count points and turns.
    static std::size_t GetMemory(std::size_t count) {
        return sizeof(KeptFace) + count * sizeof(Index);
    }
    /// Makes one of memory that has the points and turns already, \p count of them, behind the place of the rest.
    static KeptFace const &Make(void *memory, TYPE const &type, int size, std::size_t count) {
        static_assert(alignof(Index) <= alignof(KeptFace));
        return *new (memory) KeptFace{type, size, int(count) - 2 * size};
    }

    TYPE type;
    int size;
    int numPoints; ///< without the turns
};

/// The points and turns of a KeptFace in bytes of one's own, from which it is made when they are there.
template <typename TYPE>
class FacePoints {
public:
    using Index = Far::Index;

    explicit FacePoints(std::vector<std::byte> &bytes) : _bytes(bytes) {}

    void resize(std::size_t count) { _bytes.resize(KeptFace<TYPE>::GetMemory(count)); }
    std::size_t size() const { return (_bytes.size() - sizeof(KeptFace<TYPE>)) / sizeof(Index); }
    Index *data() { return reinterpret_cast<Index *>(_bytes.data() + sizeof(KeptFace<TYPE>)); }
    KeptFace<TYPE> const &Make(TYPE const &type, int faceSize) {
        return KeptFace<TYPE>::Make(_bytes.data(), type, faceSize, size());
    }

private:
    std::vector<std::byte> &_bytes;
};

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

    using Face = KeptFace<TYPE>;

    /// \param numKinds   of data, each of which has points of its own
    /// \param maxMemory  in bytes; what would take more is not kept
    /// \param memory     counts what the faces take
    KeptFaces(int numFaces, std::size_t numKinds, std::size_t maxMemory, MemoryCount &memory)
        : _numFaces(numFaces), _maxMemory(maxMemory), _memory(memory), _kinds(numKinds) {}
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

    /// \brief Keeps a copy of a face that is added a second time: for others it is not worth the memory.
    ///
    /// \return  the one that is kept; null where none is
    Face const *Add(std::size_t kind, Index face, Face const &own) {
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
        std::size_t const count = std::size_t(own.numPoints) + 2 * std::size_t(own.size);
        std::size_t const size = Face::GetMemory(count);
        if (!takeMemory(size)) {
            _isFull.store(true, std::memory_order_relaxed);
            return nullptr;
        }
        auto *const memory = static_cast<std::byte *>(_blocks.allocate(size));
        std::copy_n(own.GetPoints(), count, reinterpret_cast<Index *>(memory + sizeof(Face)));
        Face const *const added = &Face::Make(memory, own.type, own.size, count);
        slots[face].store(added, std::memory_order_release);
        return added;
    }

private:
    static_assert(std::is_trivially_destructible_v<TYPE>);

    using Slot = std::atomic<Face const *>;
    struct Kind {
        std::atomic<Slot *> slots{nullptr}; // by face
        std::unique_ptr<Slot[]> memory;
        std::atomic<bool> isRefused{false}; // there was no memory for the slots
    };

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
        _memory.Add(size);
        return true;
    }

    int const _numFaces;
    std::size_t const _maxMemory;
    MemoryCount &_memory;
    Face const _metOnce{}; // whose address stands for faces that are not kept yet
    std::mutex _mutex;
    std::vector<Kind> _kinds;
    std::atomic<bool> _isFull{false}; // there was no memory for more faces
    std::size_t _numBytes = 0;
    std::pmr::monotonic_buffer_resource _blocks; // of faces
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

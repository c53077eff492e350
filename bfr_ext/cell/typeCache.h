// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_TYPE_CACHE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_TYPE_CACHE_H

#include "cellType.h"

#include <cstddef>
#include <memory>
#include <mutex>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The types of a SurfaceFactoryCache, in bounded memory.  Any number of threads may use it.
///
/// Types refer to each other, back and forth, and evaluation goes from one to the next without a lock.  So they go together:
/// when those that the cache has take half of the memory, it begins anew, and what is asked for again is made again.  Those
/// before go with the last surface that has one; the other half of the memory is for these.
class TypeCache {
public:
    explicit TypeCache(std::size_t maxMemory) : _maxMemory(maxMemory) {}

    std::size_t GetMaxMemory() const { return _maxMemory; }
    /// The bytes of all types, those that only surfaces still have among them.
    std::size_t GetMemory() const { return *_memory; }
    /// Whether some types take so much that the cache begins anew.
    bool IsFull(CellTypes &types) const { return types.GetMemory().Get() > _maxMemory / 2; }
    /// The types to find others among.
    std::shared_ptr<CellTypes> Get() {
        std::shared_ptr<CellTypes> before; // goes without the lock
        std::lock_guard<std::mutex> const lock(_mutex);
        if (!_types || IsFull(*_types)) {
            before = std::move(_types);
            _types = std::make_shared<CellTypes>(_memory);
        }
        return _types;
    }
    /// How many these are.
    std::size_t GetNumTypes() const {
        std::lock_guard<std::mutex> const lock(_mutex);
        return _types ? _types->GetSize() : 0;
    }

private:
    std::size_t const _maxMemory;
    std::shared_ptr<MemoryCount::Total> const _memory = std::make_shared<MemoryCount::Total>(0);
    mutable std::mutex _mutex;
    std::shared_ptr<CellTypes> _types;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

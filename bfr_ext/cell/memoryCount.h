// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_MEMORY_COUNT_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_MEMORY_COUNT_H

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Bytes that a value has on the heap.  A class whose members have some says so by a GetHeapSize() of its own.
template <typename T>
std::size_t GetHeapSize(T const &value);
/// Overload for arrays.
template <typename T, typename ALLOCATOR>
std::size_t GetHeapSize(std::vector<T, ALLOCATOR> const &values);
/// \copydoc GetHeapSize(std::vector<T, ALLOCATOR> const &)
template <typename T, std::size_t SIZE>
std::size_t GetHeapSize(std::array<T, SIZE> const &values);
/// Overload for what a pointer owns.
template <typename T>
std::size_t GetHeapSize(std::unique_ptr<T> const &value);

template <typename T, typename ALLOCATOR>
std::size_t GetHeapSize(std::vector<T, ALLOCATOR> const &values) {
    std::size_t size = values.capacity() * sizeof(T);
    if constexpr (!std::is_trivially_copyable_v<T>) {
        for (T const &value : values) {
            size += GetHeapSize(value);
        }
    }
    return size;
}
template <typename T, std::size_t SIZE>
std::size_t GetHeapSize(std::array<T, SIZE> const &values) {
    std::size_t size = 0;
    for (T const &value : values) {
        size += GetHeapSize(value);
    }
    return size;
}
template <typename T>
std::size_t GetHeapSize(std::unique_ptr<T> const &value) {
    return value ? sizeof(T) + GetHeapSize(*value) : 0;
}

template <typename T>
std::size_t GetHeapSize(T const &value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
        return 0;
    } else {
        return value.GetHeapSize();
    }
}

/// Bytes of several values on the heap.
template <typename... VALUES>
std::size_t GetHeapSizes(VALUES const &...values) {
    return (GetHeapSize(values) + ...);
}

/// \brief Counts the bytes of what belongs together and goes at once, as part of a total.  Any number of threads may add to
/// it.
class MemoryCount {
public:
    using Total = std::atomic<std::size_t>;

    explicit MemoryCount(std::shared_ptr<Total> total) : _total(std::move(total)) {}
    ~MemoryCount() { *_total -= _size; }
    MemoryCount(MemoryCount const &) = delete;
    MemoryCount &operator=(MemoryCount const &) = delete;

    void Add(std::size_t size) {
        _size.fetch_add(size, std::memory_order_relaxed);
        _total->fetch_add(size, std::memory_order_relaxed);
    }
    std::size_t Get() const { return _size.load(std::memory_order_relaxed); }

private:
    std::atomic<std::size_t> _size{0};
    std::shared_ptr<Total> const _total;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

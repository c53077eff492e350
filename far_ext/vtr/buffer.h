// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BUFFER_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BUFFER_H

#include "far_ext/export.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

constexpr std::size_t kCacheLine = 64; ///< bytes; the least alignment of an array

/// Memory for a large array: not initialized, on huge pages where the system offers them.
/// Throws std::bad_alloc.
OPENSUBDIVHEX_API void *AllocateArray(std::size_t bytes);
OPENSUBDIVHEX_API void FreeArray(void *memory);

/// Has the system put pages behind memory that was not written yet, in parallel and huge ones where
/// it offers them.  Whoever writes it first need not wait for them then.  Content is kept.
OPENSUBDIVHEX_API void PrepareArray(void *memory, std::size_t bytes);

/// \brief Resizes an empty vector whose owner writes every element, of a trivial type.
///
/// Its memory is prepared, so that it is not touched in pages of 4 KiB, or by one thread alone,
/// later; and not written where the standard library is that of GCC.
template <typename T>
void ResizeLarge(std::vector<T> &array, std::size_t size) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    array.reserve(size);
    PrepareArray(array.data(), size * sizeof(T));
#if defined(__GLIBCXX__) && !defined(_GLIBCXX_DEBUG) && !defined(_GLIBCXX_SANITIZE_VECTOR)
    // resize() would write all elements once more: benchmark table/quad/large/warm with 2 threads
    // is 1.25 times as fast without.  Folly's resizeWithoutInitialization() relies on the same two
    // members of the vector's base class, to which a C cast goes though it is not accessible.  Elements of
    // such types begin to live when their memory is allocated.
    auto &memory = (std::_Vector_base<T, std::allocator<T>> &)array;
    memory._M_impl._M_finish = memory._M_impl._M_start + size;
#else
    array.resize(size);
#endif
}

/// Asks for the cache lines of memory that will be read soon; \p bytes may lead behind its end.
inline void Prefetch([[maybe_unused]] void const *memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__GNUC__)
    // A number, since a pointer may not lead behind the end of its array.
    auto const address = reinterpret_cast<std::uintptr_t>(memory);
    for (std::size_t i = 0; i < bytes; i += kCacheLine) {
        __builtin_prefetch(reinterpret_cast<void const *>(address + i));
    }
    __asm__ volatile(""); // else GCC drops functions that do nothing but this
#endif
}

/// \brief An array of trivial elements that are not written until the owner writes them.
///
/// Resize() keeps nothing of the content and takes new memory only when it needs more than it has,
/// so that refining again reuses the memory of the levels before.  PlaceArrays() gives many arrays
/// a place in one Buffer<std::byte>.
template <typename T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    void Resize(std::size_t size) {
        if (size > _capacity) {
            Place(nullptr, 0);
            _memory.reset(static_cast<T *>(AllocateArray(size * sizeof(T))));
            _data = _memory.get();
            _capacity = size;
        }
        _size = size;
    }
    /// Takes the size and the elements of another array.
    template <typename ARRAY>
    void Assign(ARRAY const &array) {
        Resize(array.size());
        std::copy(array.begin(), array.end(), _data);
    }
    /// Uses \p memory of someone else, which must outlive the use, and frees its own.
    void Place(T *memory, std::size_t size) {
        _memory.reset();
        _capacity = 0;
        _data = memory;
        _size = size;
    }

    std::size_t size() const { return _size; }
    bool empty() const { return _size == 0; }
    T *data() { return _data; }
    T const *data() const { return _data; }
    T &operator[](std::size_t i) { return _data[i]; }
    T const &operator[](std::size_t i) const { return _data[i]; }
    T const *begin() const { return data(); }
    T const *end() const { return data() + _size; }

private:
    struct Free {
        void operator()(T *memory) const { FreeArray(memory); }
    };
    std::unique_ptr<T, Free> _memory; // null when placed
    T *_data = nullptr;
    std::size_t _size = 0;
    std::size_t _capacity = 0; // of _memory
};

/// \brief Places arrays one after the other in \p memory, which grows to their size at once: so all
/// but the smallest of them lie on huge pages.
///
/// \param forEachArray  calls the function that it is given, function(buffer, size), for each array
template <typename FOR_EACH_ARRAY>
void PlaceArrays(Buffer<std::byte> &memory, FOR_EACH_ARRAY const &forEachArray) {
    auto const roundUp = [](std::size_t bytes) {
        return (bytes + kCacheLine - 1) / kCacheLine * kCacheLine;
    };
    std::size_t bytes = 0;
    forEachArray(
        [&](auto &buffer, std::size_t size) { bytes += roundUp(size * sizeof(*buffer.data())); });
    memory.Resize(bytes);
    std::byte *next = memory.data();
    forEachArray([&](auto &buffer, std::size_t size) {
        using T = std::remove_reference_t<decltype(*buffer.data())>;
        buffer.Place(reinterpret_cast<T *>(next), size);
        next += roundUp(size * sizeof(T));
    });
}

} // namespace OpenSubdivHex::FarExt::internal

#endif

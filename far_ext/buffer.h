// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_BUFFER_H
#define OPENSUBDIVHEX_FAR_EXT_BUFFER_H

#include <cstddef>
#include <memory>
#include <type_traits>

namespace OpenSubdivHex::FarExt::internal {

/// Memory for a large array: not initialized, on huge pages where the system offers them.
/// Throws std::bad_alloc.
void *AllocateArray(std::size_t bytes);
void FreeArray(void *memory);

/// Has the system put pages behind memory that was not written yet, in parallel and huge ones where
/// it offers them.  Whoever writes it first need not wait for them then.  Content is kept.
void PrepareArray(void *memory, std::size_t bytes);

/// \brief An array of trivial elements that are not written until the owner writes them.
///
/// Resize() keeps nothing of the content and takes new memory only when it needs more than it has,
/// so that refining again reuses the memory of the levels before.
template <typename T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    void Resize(std::size_t size) {
        if (size > _capacity) {
            _data.reset();
            _size = _capacity = 0;
            _data.reset(static_cast<T *>(AllocateArray(size * sizeof(T))));
            _capacity = size;
        }
        _size = size;
    }

    std::size_t size() const { return _size; }
    bool empty() const { return _size == 0; }
    T *data() { return _data.get(); }
    T const *data() const { return _data.get(); }
    T &operator[](std::size_t i) { return _data.get()[i]; }
    T const &operator[](std::size_t i) const { return _data.get()[i]; }
    T const *begin() const { return data(); }
    T const *end() const { return data() + _size; }

private:
    struct Free {
        void operator()(T *memory) const { FreeArray(memory); }
    };
    std::unique_ptr<T, Free> _data;
    std::size_t _size = 0;
    std::size_t _capacity = 0;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

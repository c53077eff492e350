// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_OSD_EXT_GUARDED_ARRAY_H
#define OPENSUBDIVHEX_REGRESSION_OSD_EXT_GUARDED_ARRAY_H

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/mman.h>
#include <unistd.h>
#define OPENSUBDIVHEX_HAS_GUARD_PAGES
#endif

namespace OpenSubdivHex::Regression {

/// The end of a GuardedArray that lies against memory which nobody may touch.
enum class GuardedEnd { First, Last };

/// \brief An array of exactly so many elements: who reads or writes beside it is stopped by the
/// operating system, where that is Unix, at \p guardedEnd.
template <class T>
class GuardedArray {
public:
    explicit GuardedArray(std::vector<T> const &values, GuardedEnd guardedEnd = GuardedEnd::Last)
        : _size(values.size()) {
#ifdef OPENSUBDIVHEX_HAS_GUARD_PAGES
        std::size_t const pageSize = std::size_t(sysconf(_SC_PAGESIZE));
        std::size_t const numBytes = _size * sizeof(T);
        std::size_t const innerSize = (numBytes + pageSize - 1) / pageSize * pageSize;
        _mappedSize = innerSize + 2 * pageSize;
        _mapped = mmap(nullptr, _mappedSize, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (_mapped == MAP_FAILED) {
            throw std::bad_alloc();
        }
        char *const inner = static_cast<char *>(_mapped) + pageSize;
        if (innerSize > 0 && mprotect(inner, innerSize, PROT_READ | PROT_WRITE) != 0) {
            munmap(_mapped, _mappedSize);
            throw std::bad_alloc();
        }
        std::size_t const start = guardedEnd == GuardedEnd::First ? 0 : innerSize - numBytes;
        _data = reinterpret_cast<T *>(inner + start);
#else
        static_cast<void>(guardedEnd);
        _data = new T[_size];
#endif
        std::copy(values.begin(), values.end(), _data);
    }

    ~GuardedArray() {
#ifdef OPENSUBDIVHEX_HAS_GUARD_PAGES
        munmap(_mapped, _mappedSize);
#else
        delete[] _data;
#endif
    }

    GuardedArray(GuardedArray const &) = delete;
    GuardedArray &operator=(GuardedArray const &) = delete;

    T *data() const { return _data; }
    std::size_t size() const { return _size; }
    T &operator[](std::size_t i) const { return _data[i]; }

private:
    std::size_t _size;
    T *_data;
#ifdef OPENSUBDIVHEX_HAS_GUARD_PAGES
    void *_mapped;
    std::size_t _mappedSize;
#endif
};

} // namespace OpenSubdivHex::Regression

#endif

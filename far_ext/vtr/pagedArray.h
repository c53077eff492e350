// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_PAGED_ARRAY_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_PAGED_ARRAY_H

#include "buffer.h"
#include "far_ext/status.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Elements by index, a few of a large range at a time, as scratch memory of one thread: they are in pages,
/// and there are pages for indices that were asked for lately.
///
/// So the scratch memory of all threads is small beside the level that they work on.
template <typename T>
class PagedArray {
public:
    using Index = Far::Index;

    /// For indices below \p end.
    explicit PagedArray(Index end)
        : _pageSize(std::min(kPageSize, std::size_t(end))),
          _pageOfPlace(std::size_t(end) / kPageSize + 1) {}

    /// \brief Before each piece of work: gives pages free for other indices where there are many.
    ///
    /// What was in them is what new elements have then.
    void Begin() {
        if (_places.size() > kMaxPages) {
            free();
        }
    }
    /// New elements are T() again.
    void Clear() {
        free();
        _pages.clear();
    }

    /// An element; a new one is T(), or what any element was when Begin() gave its page free.
    T &operator[](Index i) {
        std::size_t const place = std::size_t(i) / kPageSize;
        if (place != _lastPlace) {
            _lastPage = findPage(place);
            _lastPlace = place;
        }
        return _lastPage[std::size_t(i) % kPageSize];
    }
    /// Calls function(element, k) for the elements of indices[k], 0 <= k < count, which ascend: where they are in
    /// one page, as mostly, in a loop of as much work as over an array.
    template <typename FUNCTION>
    void ForEach(Index const *indices, int count, FUNCTION const &function) {
        if (T *const page = findPageOfAll(indices, count)) {
            for (int k = 0; k < count; ++k) {
                function(page[std::size_t(indices[k]) % kPageSize], k);
            }
        } else {
            for (int k = 0; k < count; ++k) {
                function((*this)[indices[k]], k);
            }
        }
    }

private:
    // Large, so that the indices of a list mostly are in one.
    static constexpr std::size_t kPageSize = 65536;
    static constexpr std::size_t kMaxPages = 4;
    static constexpr std::size_t kNoPlace = ~std::size_t(0);

    // Null where they are in several.
    T *findPageOfAll(Index const *indices, int count) {
        if (_pageOfPlace.size() == 1 && _lastPage) {
            return _lastPage;
        }
        if (count == 0 ||
            std::size_t(indices[0]) / kPageSize != std::size_t(indices[count - 1]) / kPageSize) {
            return nullptr;
        }
        return &(*this)[indices[0]] - std::size_t(indices[0]) % kPageSize;
    }
    T *findPage(std::size_t place) {
        if (!_pageOfPlace[place]) {
            if (_places.size() == _pages.size()) {
                Buffer<T> page;
                page.Resize(_pageSize);
                std::fill_n(page.data(), _pageSize, T());
                _pages.push_back(std::move(page));
            }
            _places.push_back(place);
            _pageOfPlace[place] = _pages[_places.size() - 1].data();
        }
        return _pageOfPlace[place];
    }
    void free() {
        for (std::size_t const place : _places) {
            _pageOfPlace[place] = nullptr;
        }
        _places.clear();
        _lastPlace = kNoPlace;
        _lastPage = nullptr;
    }

    std::size_t _pageSize;
    std::vector<T *> _pageOfPlace; // null where there is none
    std::vector<Buffer<T>> _pages;
    std::vector<std::size_t> _places; // of the first of these, which are in use
    std::size_t _lastPlace = kNoPlace;
    T *_lastPage = nullptr;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

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

/// \brief Elements by index as scratch memory of one thread, which uses a few of a range at a time.
///
/// A range of up to 2^20 indices is an array.  Elements of a longer one are in pages, and there are pages for
/// indices that were asked for lately: so the scratch memory of all threads is small beside the level that they
/// work on.
template <typename T>
class PagedArray {
public:
    using Index = Far::Index;

    /// For indices below \p end.
    explicit PagedArray(Index end) {
        if (end <= kMaxWhole) {
            _whole.assign(std::size_t(end), T());
        } else {
            _pageOfPlace.resize(std::size_t(end) / kPageSize + 1);
        }
    }

    /// \brief Before each piece of work: gives pages free for other indices where there are many.
    ///
    /// New elements keep the former content of their memory.
    void Begin() {
        if (_places.size() > kMaxPages) {
            free();
        }
    }
    /// New elements are T() again.
    void Clear() {
        std::fill(_whole.begin(), _whole.end(), T());
        free();
        _pages.clear();
    }

    /// An element; a new one is T(), or what any element was when Begin() gave its page free.
    T &operator[](Index i) { return _whole.empty() ? findElement(i) : _whole[std::size_t(i)]; }
    /// Calls function(element, k) for the elements of indices[k], 0 <= k < count.
    template <typename FUNCTION>
    void ForEach(Index const *indices, int count, FUNCTION const &function) {
        if (!_whole.empty()) {
            T *const whole = _whole.data();
            for (int k = 0; k < count; ++k) {
                function(whole[indices[k]], k);
            }
            return;
        }
        for (int k = 0; k < count; ++k) {
            function(findElement(indices[k]), k);
        }
    }

private:
    static constexpr Index kMaxWhole = 1 << 20;
    // Large, so that an index mostly is in the page of the one before.
    static constexpr std::size_t kPageSize = 65536;
    static constexpr std::size_t kMaxPages = 4;
    static constexpr std::size_t kNoPlace = ~std::size_t(0);

    T &findElement(Index i) {
        std::size_t const place = std::size_t(i) / kPageSize;
        if (place != _lastPlace) {
            _lastPage = findPage(place);
            _lastPlace = place;
        }
        return _lastPage[std::size_t(i) % kPageSize];
    }
    T *findPage(std::size_t place) {
        if (!_pageOfPlace[place]) {
            if (_places.size() == _pages.size()) {
                Buffer<T> page;
                page.Resize(kPageSize);
                std::fill_n(page.data(), kPageSize, T());
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
    }

    std::vector<T> _whole;
    std::vector<T *> _pageOfPlace; // null where there is none
    std::vector<Buffer<T>> _pages;
    std::vector<std::size_t> _places; // of the first of these, which are in use
    std::size_t _lastPlace = kNoPlace;
    T *_lastPage = nullptr;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

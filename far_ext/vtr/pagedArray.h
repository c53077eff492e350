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
    explicit PagedArray(Index end) : _places(std::size_t(end) / kPageSize + 1) {}

    /// \brief Before each piece of work: gives pages free for other indices where there are many.
    ///
    /// What was in them is what new elements have then.
    void Begin() {
        if (_used.size() > kMaxPages) {
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
        T *page = _places[place];
        if (!page) {
            page = addPage(place);
        }
        return page[std::size_t(i) % kPageSize];
    }
    /// An element that was asked for since Begin().
    T const &Get(Index i) const {
        return _places[std::size_t(i) / kPageSize][std::size_t(i) % kPageSize];
    }

private:
    static constexpr std::size_t kPageSize = 512;
    static constexpr std::size_t kMaxPages = 256;

    T *addPage(std::size_t place) {
        if (_used.size() == _pages.size()) {
            Buffer<T> page;
            page.Resize(kPageSize);
            std::fill_n(page.data(), kPageSize, T());
            _pages.push_back(std::move(page));
        }
        _used.push_back(place);
        return _places[place] = _pages[_used.size() - 1].data();
    }
    void free() {
        for (std::size_t const place : _used) {
            _places[place] = nullptr;
        }
        _used.clear();
    }

    std::vector<T *> _places; // by page of the range: where it is, or null
    std::vector<Buffer<T>> _pages;
    std::vector<std::size_t> _used; // by page of these, the first of them: which one it is
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

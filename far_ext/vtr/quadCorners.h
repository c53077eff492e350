// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_QUAD_CORNERS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_QUAD_CORNERS_H

#include "buffer.h"

#include "far_ext/indexing.h"
#include "far_ext/rules/quadPath.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief A corner one of whose flags came from a quad, by a path that matters for masks.
struct QuadCorner {
    Far::Index corner;
    QuadFlags flags;
};

/// \brief The QuadCorners of a level, one for a corner at most, ascending.
///
/// Flags are kept by corner, in pages of as many corners as some quads or hexagons have, and equal pages are one: where
/// a mesh is regular, flags repeat from face to face, and take next to no memory.
class QuadCorners {
public:
    using Index = Far::Index;
    class Iterator;

    bool empty() const { return _numCorners == 0; }
    /// The number of corners with flags.
    std::size_t size() const { return _numCorners; }
    OPENSUBDIVHEX_API void clear();
    /// A corner behind all others.
    OPENSUBDIVHEX_API void push_back(QuadCorner const &quad);
    /// Replaces all tags by \p flags, by corner.
    void Assign(Buffer<QuadFlags> const &flags);

    /// None if the corner has none.
    QuadFlags GetFlags(Index corner) const {
        auto const page = std::size_t(corner / kPage);
        return page < _pages.size() ? _flags[std::size_t(_pages[page] + corner % kPage)]
                                    : QuadFlags();
    }
    Iterator begin() const;
    Iterator end() const;

    /// Calls function(array) for the arrays of \p quads.
    template <typename FUNCTION>
    static void ForEachArray(QuadCorners const &quads, FUNCTION const &function) {
        function(quads._pages);
        function(quads._flags);
    }

private:
    static constexpr Index kPage = 48; // corners
    static constexpr Index kNoFlags = 0;

    Index getEnd() const { return Index(_pages.size()) * kPage; }
    Index addPage();
    void shareLastPage(std::size_t hashOfPage);
    bool areEqual(Index page, QuadFlags const *flags) const;

    std::size_t _numCorners = 0;
    std::vector<Index> _pages; // positions in _flags; one of no flags begins at kNoFlags
    std::vector<QuadFlags> _flags;
    std::unordered_map<std::size_t, Index> _pageOfHash;
};

/// \brief Goes from one corner with flags to the next.
class QuadCorners::Iterator {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = QuadCorner;
    using difference_type = std::ptrdiff_t;
    using pointer = QuadCorner const *;
    using reference = QuadCorner const &;

    Iterator() = default;
    /// At the first corner with flags of corners \p begin to \p end - 1; at \p end if there is none.
    Iterator(QuadCorners const &quads, Index begin, Index end)
        : _quads(&quads), _end(end), _quad{begin, {}} {
        find();
    }

    reference operator*() const { return _quad; }
    pointer operator->() const { return &_quad; }
    Iterator &operator++() {
        ++_quad.corner;
        find();
        return *this;
    }
    bool operator==(Iterator const &other) const { return _quad.corner == other._quad.corner; }
    bool operator!=(Iterator const &other) const { return !(*this == other); }

private:
    void find() {
        Index const end = std::min(_end, _quads->getEnd());
        while (_quad.corner < end) {
            Index const page = _quads->_pages[std::size_t(_quad.corner / kPage)];
            Index local = _quad.corner % kPage;
            _quad.corner -= local;
            if (page == kNoFlags) {
                local = kPage;
            }
            for (; local < kPage && _quad.corner + local < end; ++local) {
                _quad.flags = _quads->_flags[std::size_t(page + local)];
                if (_quad.flags.HasAny()) {
                    _quad.corner += local;
                    return;
                }
            }
            _quad.corner += local;
        }
        _quad.corner = _end;
    }

    QuadCorners const *_quads = nullptr;
    Index _end = 0;
    QuadCorner _quad = {};
};

inline QuadCorners::Iterator QuadCorners::begin() const { return {*this, 0, getEnd()}; }
inline QuadCorners::Iterator QuadCorners::end() const { return {*this, getEnd(), getEnd()}; }

} // namespace OpenSubdivHex::FarExt::internal

#endif

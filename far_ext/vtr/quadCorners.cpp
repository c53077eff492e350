// SPDX-License-Identifier: Apache-2.0
#include "quadCorners.h"

#include "parallel.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

bool isSame(QuadFlags x, QuadFlags y) {
    return x.out == y.out && x.in == y.in && x.sharpness == y.sharpness;
}

std::size_t hash(QuadFlags const *flags, Index count) {
    constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u; // of Fibonacci hashing
    std::uint64_t result = 0;
    for (Index i = 0; i < count; ++i) {
        std::uint64_t bits = 0;
        static_assert(sizeof bits == sizeof(QuadFlags));
        std::memcpy(&bits, flags + i, sizeof bits);
        result = (result ^ bits) * kFactor;
        result ^= result >> 32;
    }
    return std::size_t(result);
}

} // namespace

void QuadCorners::clear() {
    _numCorners = 0;
    _pages.clear();
    _flags.clear();
    _pageOfHash.clear();
}

// A page of no flags; returns its position.
Index QuadCorners::addPage() {
    if (_flags.empty()) {
        _flags.resize(std::size_t{kPage}); // at kNoFlags
    }
    auto const position = Index(_flags.size());
    _flags.resize(_flags.size() + kPage);
    return position;
}

bool QuadCorners::areEqual(Index page, QuadFlags const *flags) const {
    return std::equal(flags, flags + kPage, _flags.begin() + page, isSame);
}

// Takes the last page away again if an earlier one is equal.
void QuadCorners::shareLastPage(std::size_t hashOfPage) {
    Index const last = _pages.back();
    auto const [found, isNew] = _pageOfHash.try_emplace(hashOfPage, last);
    if (!isNew && areEqual(found->second, _flags.data() + last)) {
        _pages.back() = found->second;
        _flags.resize(std::size_t(last));
    }
}

void QuadCorners::push_back(QuadCorner const &quad) {
    auto const page = std::size_t(quad.corner / kPage);
    if (page >= _pages.size()) {
        if (!_pages.empty()) {
            shareLastPage(hash(_flags.data() + _pages.back(), kPage));
        }
        _pages.resize(page, kNoFlags);
        _pages.push_back(addPage());
    }
    _flags[std::size_t(_pages.back()) + std::size_t(quad.corner % kPage)] = quad.flags;
    ++_numCorners;
}

void QuadCorners::Assign(Buffer<QuadFlags> const &flags) {
    struct Page {
        std::size_t hash;
        Index numCorners;
    };
    clear();
    auto const numCorners = Index(flags.size());
    Buffer<Page> pages;
    pages.Resize(std::size_t(GetNumParallelRanges(numCorners, kPage)));
    auto const getSize = [&](Index page) { return std::min(kPage, numCorners - page * kPage); };
    ParallelFor(Index(pages.size()), [&](Index page) {
        QuadFlags const *const first = flags.data() + std::ptrdiff_t(page) * kPage;
        Index const size = getSize(page);
        pages[std::size_t(page)] = {
            hash(first, size),
            Index(std::count_if(first, first + size, [](QuadFlags of) { return of.HasAny(); }))};
    });
    for (Index page = 0; page < Index(pages.size()); ++page) {
        auto const [hashOfPage, count] = pages[std::size_t(page)];
        if (count == 0) {
            continue;
        }
        _numCorners += std::size_t(count);
        _pages.resize(std::size_t(page), kNoFlags);
        QuadFlags const *const first = flags.data() + std::ptrdiff_t(page) * kPage;
        Index const size = getSize(page);
        auto const found = _pageOfHash.find(hashOfPage);
        if (size == kPage && found != _pageOfHash.end() && areEqual(found->second, first)) {
            _pages.push_back(found->second);
            continue;
        }
        _pages.push_back(addPage());
        std::copy_n(first, size, _flags.begin() + _pages.back());
        if (size == kPage) {
            _pageOfHash.try_emplace(hashOfPage, _pages.back());
        }
    }
    _pageOfHash.clear();
}

} // namespace OpenSubdivHex::FarExt::internal

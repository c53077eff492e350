// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_BYTE_BLOCKS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_BYTE_BLOCKS_H

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Memory for many things of some bytes, which goes at once.  One thread uses it at a time.
class ByteBlocks {
public:
    /// \param blockSize  in bytes, of a block at least
    explicit ByteBlocks(std::size_t blockSize) : _blockSize(blockSize) {}

    /// Bytes by which the blocks grow when so many are taken.
    std::size_t GetGrowth(std::size_t size) const {
        return pad(size) <= _numLeft ? 0 : std::max(pad(size), _blockSize);
    }
    /// Bytes that have not been written, where anything may begin.
    std::byte *Take(std::size_t size) {
        if (std::size_t const growth = GetGrowth(size)) {
            _blocks.emplace_back(new std::byte[growth]);
            _next = _blocks.back().get();
            _numLeft = growth;
        }
        std::byte *const result = _next;
        _next += pad(size);
        _numLeft -= pad(size);
        return result;
    }

private:
    static std::size_t pad(std::size_t size) {
        constexpr std::size_t kUnit = alignof(std::max_align_t);
        return (size + kUnit - 1) / kUnit * kUnit;
    }

    std::size_t const _blockSize;
    std::vector<std::unique_ptr<std::byte[]>> _blocks;
    std::byte *_next = nullptr;
    std::size_t _numLeft = 0;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

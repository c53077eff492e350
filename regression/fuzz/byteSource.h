// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FUZZ_BYTE_SOURCE_H
#define OPENSUBDIVHEX_REGRESSION_FUZZ_BYTE_SOURCE_H

#include <cstddef>
#include <cstdint>

namespace OpenSubdivHex::Regression {

/// \brief Choices read off the bytes of a fuzzer.  Where they end, all further ones are the first.
class ByteSource {
public:
    ByteSource(std::uint8_t const *data, std::size_t size) : _data(data), _end(data + size) {}

    bool IsAtEnd() const { return _data == _end; }
    int GetByte() { return IsAtEnd() ? 0 : *_data++; }
    /// 0 ... count - 1, of 256 at most.
    int Choose(int count) { return count > 0 ? GetByte() % count : 0; }
    /// True in about one of \p count cases, never at the end.
    bool IsOneOf(int count) { return GetByte() % count == count - 1; }

private:
    std::uint8_t const *_data;
    std::uint8_t const *_end;
};

} // namespace OpenSubdivHex::Regression

#endif

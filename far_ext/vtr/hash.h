// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_HASH_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_HASH_H

#include <cstdint>

namespace OpenSubdivHex::FarExt::internal {

/// The hash of some numbers and one more, from the hash of the numbers before it.
inline std::uint64_t AddToHash(std::uint64_t hash, std::uint64_t number) {
    constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u; // of Fibonacci hashing
    hash = (hash ^ number) * kFactor;
    return hash ^ hash >> 29;
}

} // namespace OpenSubdivHex::FarExt::internal

#endif

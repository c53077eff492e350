// SPDX-License-Identifier: Apache-2.0
//
// How the kernels of the limit read and write: compiled once per SIMD level with them, and by the rules
// of limitKernelTemplate.h.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LIMIT_ACCESS_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LIMIT_ACCESS_H

#include "limitKernel.h"

#include "osd_ext/simd/quad.h"

#include <cstddef>
#include <cstdint>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

constexpr int kPoint = RegularFaceGroup::kPointStride;

/// How elements of WIDTH floats are read and written.  A quad of three packed floats takes in the
/// first of the next element.
template <int WIDTH, bool IS_PACKED>
struct LimitAccess {
    static constexpr int kWidth = WIDTH;
    static constexpr bool kIsPoints = IS_PACKED && WIDTH == RegularFaceGroup::kPointStride;
    static constexpr int kReach = kIsPoints ? kQuad : WIDTH;

    /// The element at a place in points, or sums, that are \p pointStride floats apart.
    static OPENSUBDIVHEX_INLINE float const *AtPlace(Elements<float const> const &elements,
                                                     std::uint32_t place, int pointStride) {
        return elements.data +
               (kIsPoints ? place
                          : std::ptrdiff_t(place / unsigned(pointStride)) * elements.stride);
    }
    template <class FLOAT>
    static OPENSUBDIVHEX_INLINE FLOAT *At(Elements<FLOAT> const &elements, std::ptrdiff_t i) {
        return elements.data + i * (kIsPoints ? WIDTH : elements.stride);
    }
};

/// Asks for memory that is written soon.
OPENSUBDIVHEX_INLINE void prefetch([[maybe_unused]] float const *place) {
#if defined(__GNUC__)
    constexpr int kForWriting = 1;
    __builtin_prefetch(place, kForWriting);
#endif
}

/// sum += weight value
template <class SIMD>
OPENSUBDIVHEX_INLINE void addProduct(typename SIMD::Vector &sum,
                                     typename SIMD::Vector const &weight,
                                     typename SIMD::Vector const &value) {
    sum = SIMD::MultiplyAdd(weight, value, sum);
}

/// Elements of any length, up to four floats at a time: calls function(task, access) for them.
template <class TASK, typename FUNCTION>
OPENSUBDIVHEX_INLINE void forEachQuad(TASK task, FUNCTION const &function) {
    bool isPacked = task.isReadBehind && task.values.stride == task.length;
    for (int i = 0; i < task.numOutputs; ++i) {
        isPacked = isPacked && task.outputs[i].stride == task.length;
    }
    if (isPacked && task.length == RegularFaceGroup::kPointStride) {
        return function(task, LimitAccess<RegularFaceGroup::kPointStride, true>());
    }
    while (task.length > kQuad) {
        function(task, LimitAccess<kQuad, false>());
        task.Skip(kQuad);
    }
    switch (task.length) {
    case 1:
        return function(task, LimitAccess<1, false>());
    case 2:
        return function(task, LimitAccess<2, false>());
    case 3:
        return function(task, LimitAccess<3, false>());
    default:
        return function(task, LimitAccess<kQuad, false>());
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

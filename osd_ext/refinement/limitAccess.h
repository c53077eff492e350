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

/// \brief The portable SIMD level, whose vectors hold four floats of one face.
///
/// The types of other SIMD levels hold several faces; they have the same functions.
struct OneFace {
    static constexpr int kNumFaces = 1;
    using Vector = Quad;

    static OPENSUBDIVHEX_INLINE Vector Spread(float value) {
        return OsdExt::internal::Spread(value);
    }
    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector const &a, Vector const &b,
                                                   Vector const &sum) {
        return sum + a * b;
    }
    static OPENSUBDIVHEX_INLINE Vector Load(float const *const *places) {
        return LoadFloats<kQuad>(places[0]);
    }
    static OPENSUBDIVHEX_INLINE Vector LoadRest(float const *const *places, int length) {
        return OsdExt::internal::LoadRest(places[0], length);
    }
    static OPENSUBDIVHEX_INLINE void StorePoints(float *const *places, Vector const &vector) {
        StoreFloats<kPoint>(places[0], vector);
    }
    static OPENSUBDIVHEX_INLINE void StoreQuads(float *const *places, Vector const &vector) {
        StoreFloats<kQuad>(places[0], vector);
    }
    static OPENSUBDIVHEX_INLINE void StoreRest(float *const *places, Vector const &vector,
                                               int length) {
        OsdExt::internal::StoreRest(places[0], vector, length);
    }
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE void StoreRun(float *const *places, Vector const (&x)[COUNT]) {
        float *next = places[0];
        for (int i = 0; i + 1 < COUNT; ++i, next += kPoint) {
            StoreFloats<kQuad>(next, x[i]);
        }
        StoreFloats<kPoint>(next, x[COUNT - 1]);
    }
};

/// Elements that the kernels take at a time.
enum class LimitWidth {
    Points, ///< three floats of elements that have no more and no gaps
    Quads,  ///< four of any elements
    Rest    ///< the last one to three of any
};

/// How elements are read and written, up to four floats at a time.  A quad that is read of points takes in
/// the first float of the next one.
template <LimitWidth WIDTH>
struct LimitAccess {
    static constexpr bool kIsPoints = WIDTH == LimitWidth::Points;

    /// \param length  of the rest; else of no matter
    template <class SIMD>
    static OPENSUBDIVHEX_INLINE typename SIMD::Vector Load(float const *const *places, int length) {
        if constexpr (WIDTH == LimitWidth::Rest) {
            return SIMD::LoadRest(places, length);
        } else {
            return SIMD::Load(places);
        }
    }
    template <class SIMD>
    static OPENSUBDIVHEX_INLINE void Store(float *const *places,
                                           typename SIMD::Vector const &vector, int length) {
        if constexpr (WIDTH == LimitWidth::Rest) {
            SIMD::StoreRest(places, vector, length);
        } else if constexpr (kIsPoints) {
            SIMD::StorePoints(places, vector);
        } else {
            SIMD::StoreQuads(places, vector);
        }
    }

    /// The element at a place in points, as in RegularFaceGroup.
    static OPENSUBDIVHEX_INLINE float const *AtPlace(Elements<float const> const &elements,
                                                     std::uint32_t place) {
        return elements.data +
               (kIsPoints ? place : std::ptrdiff_t(place / unsigned(kPoint)) * elements.stride);
    }
    template <class FLOAT>
    static OPENSUBDIVHEX_INLINE FLOAT *At(Elements<FLOAT> const &elements, std::ptrdiff_t i) {
        return elements.data + i * (kIsPoints ? kPoint : elements.stride);
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
        return function(task, LimitAccess<LimitWidth::Points>());
    }
    for (; task.length >= kQuad; task.Skip(kQuad)) {
        function(task, LimitAccess<LimitWidth::Quads>());
    }
    if (task.length > 0) {
        function(task, LimitAccess<LimitWidth::Rest>());
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

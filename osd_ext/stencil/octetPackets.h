// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_STENCIL_OCTET_PACKETS_H
#define OPENSUBDIVHEX_OSD_EXT_STENCIL_OCTET_PACKETS_H

#include "stencilKernelTemplate.h"

#include "osd_ext/simd/octet.h"

#include <type_traits>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// COUNT elements, 1 or 2, of 5 to 8 floats, each in an octet.
template <class OCTET, int COUNT, int WIDTH>
struct WidePacket {
    static constexpr int kNumElements = COUNT;

    struct Vector {
        typename OCTET::Vector octets[COUNT];
    };

    static OPENSUBDIVHEX_INLINE Vector Zero() {
        Vector result;
        for (auto &octet : result.octets) {
            octet = OCTET::Spread(0);
        }
        return result;
    }

    template <class SOURCE>
    static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices,
                                                    int numElements = COUNT) {
        Vector result = Zero();
        for (int i = 0; i < COUNT; ++i) {
            if (i < numElements) {
                float const *const element = src[indices[i]];
                result.octets[i] = OCTET::Join(LoadFloats<kQuad>(element),
                                               LoadFloats<WIDTH - kQuad>(element + kQuad));
            }
        }
        return result;
    }

    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights, int numElements = COUNT) {
        Vector result = Zero();
        for (int i = 0; i < COUNT; ++i) {
            if (i < numElements) {
                result.octets[i] = OCTET::Spread(weights[i]);
            }
        }
        return result;
    }

    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector const &elements, Vector const &weights,
                                                   Vector const &sum) {
        return MultiplyAddFrom(0, elements, weights, sum);
    }
    /// Only from element \p first on.
    static OPENSUBDIVHEX_INLINE Vector MultiplyAddFrom(int first, Vector const &elements,
                                                       Vector const &weights, Vector const &sum) {
        Vector result = sum;
        for (int i = 0; i < COUNT; ++i) {
            if (i >= first) {
                result.octets[i] =
                    OCTET::MultiplyAdd(elements.octets[i], weights.octets[i], sum.octets[i]);
            }
        }
        return result;
    }

    static OPENSUBDIVHEX_INLINE void StoreSum(float *dst, Vector const &sum) {
        typename OCTET::Vector element = sum.octets[0];
        for (int i = 1; i < COUNT; ++i) {
            element = OCTET::Add(element, sum.octets[i]);
        }
        StoreFloats<kQuad>(dst, OCTET::GetFirst(element));
        StoreFloats<WIDTH - kQuad>(dst + kQuad, OCTET::GetSecond(element));
    }
};

/// Two elements of 1 to 4 floats, each in a quad of an octet.
template <class OCTET, int WIDTH>
struct NarrowPacket {
    static constexpr int kNumElements = 2;

    using Vector = typename OCTET::Vector;

    static OPENSUBDIVHEX_INLINE Vector Zero() { return OCTET::Spread(0); }

    template <class SOURCE>
    static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices) {
        return OCTET::Join(LoadFloats<WIDTH>(src[indices[0]]), LoadFloats<WIDTH>(src[indices[1]]));
    }
    template <class SOURCE>
    static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices,
                                                    int /*numElements*/) {
        return OCTET::Join(LoadFloats<WIDTH>(src[indices[0]]), Quad{});
    }

    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights) {
        return OCTET::SpreadTwo(weights);
    }
    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights, int /*numElements*/) {
        return OCTET::Join(Spread(weights[0]), Quad{});
    }

    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector const &elements, Vector const &weights,
                                                   Vector const &sum) {
        return OCTET::MultiplyAdd(elements, weights, sum);
    }
    /// Only from element \p first on.
    static OPENSUBDIVHEX_INLINE Vector MultiplyAddFrom(int first, Vector const &elements,
                                                       Vector const &weights, Vector const &sum) {
        Vector const result = MultiplyAdd(elements, weights, sum);
        return first == 0 ? result : OCTET::Mix(sum, result);
    }

    static OPENSUBDIVHEX_INLINE void StoreSum(float *dst, Vector const &sum) {
        StoreFloats<WIDTH>(dst, OCTET::GetFirst(sum) + OCTET::GetSecond(sum));
    }
};

/// A SIMD level by its octets, which takes COUNT wide elements at a time.
template <class OCTET, int COUNT>
struct OctetSimd {
    template <int WIDTH>
    using Packet = std::conditional_t<(WIDTH > kQuad), WidePacket<OCTET, COUNT, WIDTH>,
                                      NarrowPacket<OCTET, WIDTH>>;
};

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

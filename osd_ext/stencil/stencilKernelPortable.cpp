// SPDX-License-Identifier: Apache-2.0
#include "stencilKernelTemplate.h"

#include "osd_ext/simd/quad.h"

#include <type_traits>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// What packets have in common: eight floats.
struct PacketBase {
    struct Vector {
        Quad first;
        Quad second;
    };

    static OPENSUBDIVHEX_INLINE Vector Zero() { return {Quad{}, Quad{}}; }

    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector const &elements, Vector const &weights,
                                                   Vector const &sum) {
        return {sum.first + elements.first * weights.first,
                sum.second + elements.second * weights.second};
    }
};

/// One element of 5 to 8 floats.
template <int WIDTH>
struct WidePacket : PacketBase {
    static constexpr int kNumElements = 1;

    template <class SOURCE>
    static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices,
                                                    int /*numElements*/ = 1) {
        float const *const element = src[*indices];
        return {LoadFloats<4>(element), LoadFloats<WIDTH - 4>(element + 4)};
    }

    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights, int /*numElements*/ = 1) {
        return {Spread(*weights), Spread(*weights)};
    }

    static OPENSUBDIVHEX_INLINE Vector MultiplyAddFrom(int /*first*/, Vector const &elements,
                                                       Vector const &weights, Vector const &sum) {
        return MultiplyAdd(elements, weights, sum);
    }

    static OPENSUBDIVHEX_INLINE void StoreSum(float *dst, Vector const &sum) {
        StoreFloats<4>(dst, sum.first);
        StoreFloats<WIDTH - 4>(dst + 4, sum.second);
    }
};

/// Two elements of 1 to 4 floats.
template <int WIDTH>
struct NarrowPacket : PacketBase {
    static constexpr int kNumElements = 2;

    template <class SOURCE>
    static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices) {
        return {LoadFloats<WIDTH>(src[indices[0]]), LoadFloats<WIDTH>(src[indices[1]])};
    }
    template <class SOURCE>
    static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices,
                                                    int /*numElements*/) {
        return {LoadFloats<WIDTH>(src[indices[0]]), Quad{}};
    }

    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights) {
        return {Spread(weights[0]), Spread(weights[1])};
    }
    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights, int /*numElements*/) {
        return {Spread(weights[0]), Quad{}};
    }

    /// Of elements \p first and on alone.
    static OPENSUBDIVHEX_INLINE Vector MultiplyAddFrom(int first, Vector const &elements,
                                                       Vector const &weights, Vector const &sum) {
        Vector const result = MultiplyAdd(elements, weights, sum);
        return {first == 0 ? result.first : sum.first, result.second};
    }

    static OPENSUBDIVHEX_INLINE void StoreSum(float *dst, Vector const &sum) {
        StoreFloats<WIDTH>(dst, sum.first + sum.second);
    }
};

/// Plain C++, in a form that compilers turn into the vectors of any machine.
struct PortableSimd {
    template <int WIDTH>
    using Packet = std::conditional_t<(WIDTH > 4), WidePacket<WIDTH>, NarrowPacket<WIDTH>>;
};

} // namespace

void EvalStencilsPortable(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    evalStencilsAs<PortableSimd>(task, begin, end, firstWeight);
}

} // namespace OpenSubdivHex::OsdExt::internal

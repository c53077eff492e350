// SPDX-License-Identifier: Apache-2.0
#include "stencilKernelTemplate.h"

#include <type_traits>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

#if defined(__GNUC__)

/// Four floats, in a register where the machine has such.
using Quad = float __attribute__((vector_size(16)));

#else

struct Quad {
    float v[4];

    float &operator[](int i) { return v[i]; }
    float operator[](int i) const { return v[i]; }
};

inline Quad operator+(Quad const &a, Quad const &b) {
    return {{a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}};
}

inline Quad operator*(Quad const &a, Quad const &b) {
    return {{a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]}};
}

#endif

/// Reads the first WIDTH floats, 1 to 4; the others are 0.
template <int WIDTH>
OPENSUBDIVHEX_INLINE Quad loadFloats(float const *src) {
    // Entry by entry into a vector that exists would shuffle it for each of them.
    return Quad{src[0], WIDTH > 1 ? src[1] : 0, WIDTH > 2 ? src[2] : 0, WIDTH > 3 ? src[3] : 0};
}

/// Writes the first WIDTH floats, 1 to 4.
template <int WIDTH>
OPENSUBDIVHEX_INLINE void storeFloats(float *dst, Quad const &values) {
    for (int i = 0; i < WIDTH; ++i) {
        dst[i] = values[i];
    }
}

OPENSUBDIVHEX_INLINE Quad fillQuad(float value) { return Quad{value, value, value, value}; }

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
        return {loadFloats<4>(element), loadFloats<WIDTH - 4>(element + 4)};
    }

    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights, int /*numElements*/ = 1) {
        return {fillQuad(*weights), fillQuad(*weights)};
    }

    static OPENSUBDIVHEX_INLINE Vector MultiplyAddFrom(int /*first*/, Vector const &elements,
                                                       Vector const &weights, Vector const &sum) {
        return MultiplyAdd(elements, weights, sum);
    }

    static OPENSUBDIVHEX_INLINE void StoreSum(float *dst, Vector const &sum) {
        storeFloats<4>(dst, sum.first);
        storeFloats<WIDTH - 4>(dst + 4, sum.second);
    }
};

/// Two elements of 1 to 4 floats.
template <int WIDTH>
struct NarrowPacket : PacketBase {
    static constexpr int kNumElements = 2;

    template <class SOURCE>
    static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices) {
        return {loadFloats<WIDTH>(src[indices[0]]), loadFloats<WIDTH>(src[indices[1]])};
    }
    template <class SOURCE>
    static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices,
                                                    int /*numElements*/) {
        return {loadFloats<WIDTH>(src[indices[0]]), Quad{}};
    }

    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights) {
        return {fillQuad(weights[0]), fillQuad(weights[1])};
    }
    static OPENSUBDIVHEX_INLINE Vector LoadWeights(float const *weights, int /*numElements*/) {
        return {fillQuad(weights[0]), Quad{}};
    }

    /// Of elements \p first and on alone.
    static OPENSUBDIVHEX_INLINE Vector MultiplyAddFrom(int first, Vector const &elements,
                                                       Vector const &weights, Vector const &sum) {
        Vector const result = MultiplyAdd(elements, weights, sum);
        return {first == 0 ? result.first : sum.first, result.second};
    }

    static OPENSUBDIVHEX_INLINE void StoreSum(float *dst, Vector const &sum) {
        storeFloats<WIDTH>(dst, sum.first + sum.second);
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

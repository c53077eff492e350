// SPDX-License-Identifier: Apache-2.0
#include "stencilKernelTemplate.h"

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
    Quad result{};
    for (int i = 0; i < WIDTH; ++i) {
        result[i] = src[i];
    }
    return result;
}

/// Writes the first WIDTH floats, 1 to 4.
template <int WIDTH>
OPENSUBDIVHEX_INLINE void storeFloats(float *dst, Quad const &values) {
    for (int i = 0; i < WIDTH; ++i) {
        dst[i] = values[i];
    }
}

/// Plain C++, in a form that compilers turn into the vectors of any machine.
struct PortableSimd {
    static bool EqualIndices(int const *first, int const *second, int size) {
        return equalIndices(first, second, size);
    }

    template <int WIDTH>
    struct Packet {
        static constexpr int kNumElements = 1;
        static constexpr int kNumSums = WIDTH <= 4 ? 2 : 1;
        static constexpr int kNumQuads = WIDTH <= 4 ? 1 : 2;
        static constexpr int kLastWidth = WIDTH - 4 * (kNumQuads - 1);

        struct Vector {
            Quad first;
            Quad last;
        };

        static Vector Zero() { return {Quad{}, Quad{}}; }

        template <class SOURCE>
        static OPENSUBDIVHEX_INLINE Vector LoadElements(SOURCE src, int const *indices,
                                                        int /*numElements*/ = 1) {
            float const *const element = src[*indices];
            if constexpr (kNumQuads == 1) {
                return {Quad{}, loadFloats<WIDTH>(element)};
            } else {
                return {loadFloats<4>(element), loadFloats<kLastWidth>(element + 4)};
            }
        }

        static OPENSUBDIVHEX_INLINE Quad LoadWeights(float const *weights,
                                                     int /*numElements*/ = 1) {
            return Quad{*weights, *weights, *weights, *weights};
        }

        static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector const &elements, Quad const &weights,
                                                       Vector sum) {
            if constexpr (kNumQuads > 1) {
                sum.first = sum.first + elements.first * weights;
            }
            sum.last = sum.last + elements.last * weights;
            return sum;
        }

        static OPENSUBDIVHEX_INLINE Vector Add(Vector const &first, Vector const &second) {
            return {first.first + second.first, first.last + second.last};
        }

        static OPENSUBDIVHEX_INLINE void StoreSum(float *dst, Vector const &sum) {
            if constexpr (kNumQuads > 1) {
                storeFloats<4>(dst, sum.first);
                dst += 4;
            }
            storeFloats<kLastWidth>(dst, sum.last);
        }
    };
};

} // namespace

void EvalStencilsPortable(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    evalStencilsAs<PortableSimd>(task, begin, end, firstWeight);
}

} // namespace OpenSubdivHex::OsdExt::internal

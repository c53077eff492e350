// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX2 and FMA; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "stencilKernelTemplate.h"

#include <immintrin.h>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// Writes the first WIDTH floats, 1 to 4.
template <int WIDTH>
inline void storeFloats(float *dst, __m128 values) {
    if constexpr (WIDTH == 4) {
        _mm_storeu_ps(dst, values);
    } else if constexpr (WIDTH == 1) {
        _mm_store_ss(dst, values);
    } else {
        _mm_storel_epi64(reinterpret_cast<__m128i *>(dst), _mm_castps_si128(values));
        if constexpr (WIDTH == 3) {
            _mm_store_ss(dst + 2, _mm_movehl_ps(values, values));
        }
    }
}

/// Reads the first WIDTH floats, 1 to 4, and not one more; the others are 0.
template <int WIDTH>
inline __m128 loadFloats(float const *src) {
    if constexpr (WIDTH == 4) {
        return _mm_loadu_ps(src);
    } else if constexpr (WIDTH == 1) {
        return _mm_load_ss(src);
    } else {
        __m128 const two =
            _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<__m128i const *>(src)));
        if constexpr (WIDTH == 2) {
            return two;
        } else {
            return _mm_insert_ps(two, _mm_load_ss(src + 2), 0x20);
        }
    }
}

/// One element of 5 to 8 floats.
template <int WIDTH>
struct WidePacket {
    static constexpr int kNumElements = 1;
    static constexpr int kNumSums = 2;

    using Vector = __m256;

    static Vector Zero() { return _mm256_setzero_ps(); }

    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices, int /*numElements*/ = 1) {
        float const *const element = src[*indices];
        if constexpr (WIDTH == 8) {
            return _mm256_loadu_ps(element);
        } else {
            return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(element)),
                                        loadFloats<WIDTH - 4>(element + 4), 1);
        }
    }

    static Vector LoadWeights(float const *weights, int /*numElements*/ = 1) {
        return _mm256_broadcast_ss(weights);
    }

    static Vector MultiplyAdd(Vector elements, Vector weights, Vector sum) {
        return _mm256_fmadd_ps(elements, weights, sum);
    }

    static Vector Add(Vector first, Vector second) { return _mm256_add_ps(first, second); }

    static void StoreSum(float *dst, Vector sum) {
        if constexpr (WIDTH == 8) {
            _mm256_storeu_ps(dst, sum);
        } else {
            _mm_storeu_ps(dst, _mm256_castps256_ps128(sum));
            storeFloats<WIDTH - 4>(dst + 4, _mm256_extractf128_ps(sum, 1));
        }
    }
};

/// Two elements of 1 to 4 floats, each in one half.
template <int WIDTH>
struct NarrowPacket {
    static constexpr int kNumElements = 2;
    static constexpr int kNumSums = 1;

    using Vector = __m256;

    static Vector Zero() { return _mm256_setzero_ps(); }

    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(loadFloats<WIDTH>(src[indices[0]])),
                                    loadFloats<WIDTH>(src[indices[1]]), 1);
    }
    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices, int /*numElements*/) {
        return _mm256_insertf128_ps(_mm256_setzero_ps(), loadFloats<WIDTH>(src[indices[0]]), 0);
    }

    static Vector LoadWeights(float const *weights) { return spread(loadFloats<2>(weights)); }
    static Vector LoadWeights(float const *weights, int /*numElements*/) {
        return spread(_mm_load_ss(weights));
    }

    static Vector MultiplyAdd(Vector elements, Vector weights, Vector sum) {
        return _mm256_fmadd_ps(elements, weights, sum);
    }
    /// Of the last element alone.
    static Vector MultiplyAddLast(Vector elements, Vector weights, Vector sum,
                                  int /*numElements*/) {
        return _mm256_blend_ps(sum, _mm256_fmadd_ps(elements, weights, sum), 0xf0);
    }

    static Vector Add(Vector first, Vector second) { return _mm256_add_ps(first, second); }

    static void StoreSum(float *dst, Vector sum) {
        storeFloats<WIDTH>(dst,
                           _mm_add_ps(_mm256_castps256_ps128(sum), _mm256_extractf128_ps(sum, 1)));
    }

private:
    static Vector spread(__m128 weights) {
        return _mm256_permutevar8x32_ps(_mm256_castps128_ps256(weights),
                                        _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1));
    }
};

template <int WIDTH, bool IS_WIDE>
struct PacketType {
    using Type = NarrowPacket<WIDTH>;
};
template <int WIDTH>
struct PacketType<WIDTH, true> {
    using Type = WidePacket<WIDTH>;
};

struct Avx2Simd {
    template <int WIDTH>
    using Packet = typename PacketType<WIDTH, (WIDTH > 4)>::Type;

    static bool EqualIndices(int const *first, int const *second, int size) {
        return equalIndices(first, second, size);
    }
};

} // namespace

void EvalStencilsAvx2(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    evalStencilsAs<Avx2Simd>(task, begin, end, firstWeight);
}

} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX-512 F and VL; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "stencilKernelTemplate.h"

#include "osd_ext/simd/avx512.h"

#include <type_traits>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

constexpr unsigned firstBits(int count) { return (1u << count) - 1; }

/// Two elements of 5 to 8 floats, each in one half.
template <int WIDTH>
struct WidePacket {
    static constexpr int kNumElements = 2;

    using Vector = __m512;

    static Vector Zero() { return _mm512_setzero_ps(); }

    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices) {
        return join(load(src[indices[0]]), load(src[indices[1]]));
    }
    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices, int /*numElements*/) {
        return join(load(src[indices[0]]), _mm256_setzero_ps());
    }

    static Vector LoadWeights(float const *weights) {
        return spread(
            _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<__m128i const *>(weights))));
    }
    static Vector LoadWeights(float const *weights, int /*numElements*/) {
        return spread(_mm_load_ss(weights));
    }

    static Vector MultiplyAdd(Vector elements, Vector weights, Vector sum) {
        return _mm512_fmadd_ps(elements, weights, sum);
    }
    /// Only from element \p first on.
    static Vector MultiplyAddFrom(int first, Vector elements, Vector weights, Vector sum) {
        return _mm512_mask3_fmadd_ps(elements, weights, sum, __mmask16(0xffffu << (8 * first)));
    }

    static void StoreSum(float *dst, Vector sum) {
        __m256 const upper = _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(sum), 1));
        __m256 const element = _mm256_add_ps(_mm512_castps512_ps256(sum), upper);
        if constexpr (WIDTH == 8) {
            _mm256_storeu_ps(dst, element);
        } else {
            _mm256_mask_storeu_ps(dst, firstBits(WIDTH), element);
        }
    }

private:
    static __m256 load(float const *element) {
        return WIDTH == 8 ? _mm256_loadu_ps(element)
                          : _mm256_maskz_loadu_ps(firstBits(WIDTH), element);
    }
    static Vector join(__m256 lower, __m256 upper) {
        return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(lower)),
                                                   _mm256_castps_pd(upper), 1));
    }
    static Vector spread(__m128 weights) {
        return _mm512_permutexvar_ps(
            _mm512_setr_epi32(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1),
            _mm512_castps128_ps512(weights));
    }
};

/// Four elements of 1 to 4 floats, each in one quarter.
template <int WIDTH>
struct NarrowPacket {
    static constexpr int kNumElements = 4;

    using Vector = __m512;

    static Vector Zero() { return _mm512_setzero_ps(); }

    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices) {
        return join(load(src[indices[0]]), load(src[indices[1]]), load(src[indices[2]]),
                    load(src[indices[3]]));
    }
    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices, int numElements) {
        __m128 const zero = _mm_setzero_ps();
        return join(load(src[indices[0]]), numElements > 1 ? load(src[indices[1]]) : zero,
                    numElements > 2 ? load(src[indices[2]]) : zero, zero);
    }

    static Vector LoadWeights(float const *weights) { return spread(_mm_loadu_ps(weights)); }
    static Vector LoadWeights(float const *weights, int numElements) {
        return spread(_mm_maskz_loadu_ps(__mmask8(firstBits(numElements)), weights));
    }

    static Vector MultiplyAdd(Vector elements, Vector weights, Vector sum) {
        return _mm512_fmadd_ps(elements, weights, sum);
    }
    /// Only from element \p first on.
    static Vector MultiplyAddFrom(int first, Vector elements, Vector weights, Vector sum) {
        return _mm512_mask3_fmadd_ps(elements, weights, sum, __mmask16(0xffffu << (4 * first)));
    }

    static void StoreSum(float *dst, Vector sum) {
        __m256 const upper = _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(sum), 1));
        __m256 const pair = _mm256_add_ps(_mm512_castps512_ps256(sum), upper);
        __m128 const element =
            _mm_add_ps(_mm256_castps256_ps128(pair), _mm256_extractf128_ps(pair, 1));
        if constexpr (WIDTH == 4) {
            _mm_storeu_ps(dst, element);
        } else {
            _mm_mask_storeu_ps(dst, firstBits(WIDTH), element);
        }
    }

private:
    static __m128 load(float const *element) {
        return WIDTH == 4 ? _mm_loadu_ps(element) : _mm_maskz_loadu_ps(firstBits(WIDTH), element);
    }
    static Vector join(__m128 first, __m128 second, __m128 third, __m128 fourth) {
        __m256 const lower = _mm256_insertf128_ps(_mm256_castps128_ps256(first), second, 1);
        __m256 const upper = _mm256_insertf128_ps(_mm256_castps128_ps256(third), fourth, 1);
        return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(lower)),
                                                   _mm256_castps_pd(upper), 1));
    }
    static Vector spread(__m128 weights) {
        return _mm512_permutexvar_ps(
            _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3),
            _mm512_castps128_ps512(weights));
    }
};

struct Avx512Simd {
    template <int WIDTH>
    using Packet = std::conditional_t<(WIDTH > 4), WidePacket<WIDTH>, NarrowPacket<WIDTH>>;
};

} // namespace

void EvalStencilsAvx512(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    evalStencilsAs<Avx512Simd>(task, begin, end, firstWeight);
}

} // namespace OpenSubdivHex::OsdExt::internal

#endif

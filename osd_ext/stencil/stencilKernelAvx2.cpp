// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX2 and FMA; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "stencilKernelTemplate.h"

#include <immintrin.h>

#include <type_traits>

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
    } else if constexpr (WIDTH == 2) {
        return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<__m128i const *>(src)));
    } else {
        return _mm_maskload_ps(src, _mm_setr_epi32(-1, -1, -1, 0));
    }
}

/// Two elements of 5 to 8 floats, each in a vector of its own.
template <int WIDTH>
struct WidePacket {
    static constexpr int kNumElements = 2;

    struct Vector {
        __m256 first;
        __m256 second;
    };

    static Vector Zero() { return {_mm256_setzero_ps(), _mm256_setzero_ps()}; }

    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices) {
        return {load(src[indices[0]]), load(src[indices[1]])};
    }
    template <class SOURCE>
    static Vector LoadElements(SOURCE src, int const *indices, int /*numElements*/) {
        return {load(src[indices[0]]), _mm256_setzero_ps()};
    }

    static Vector LoadWeights(float const *weights) {
        return {_mm256_broadcast_ss(weights), _mm256_broadcast_ss(weights + 1)};
    }
    static Vector LoadWeights(float const *weights, int /*numElements*/) {
        return {_mm256_broadcast_ss(weights), _mm256_setzero_ps()};
    }

    static Vector MultiplyAdd(Vector elements, Vector weights, Vector sum) {
        return {_mm256_fmadd_ps(elements.first, weights.first, sum.first),
                _mm256_fmadd_ps(elements.second, weights.second, sum.second)};
    }
    /// Of elements \p first and on alone.
    static Vector MultiplyAddFrom(int first, Vector elements, Vector weights, Vector sum) {
        return {first == 0 ? _mm256_fmadd_ps(elements.first, weights.first, sum.first) : sum.first,
                _mm256_fmadd_ps(elements.second, weights.second, sum.second)};
    }

    static void StoreSum(float *dst, Vector sum) {
        __m256 const element = _mm256_add_ps(sum.first, sum.second);
        if constexpr (WIDTH == 8) {
            _mm256_storeu_ps(dst, element);
        } else {
            _mm_storeu_ps(dst, _mm256_castps256_ps128(element));
            storeFloats<WIDTH - 4>(dst + 4, _mm256_extractf128_ps(element, 1));
        }
    }

private:
    static __m256 load(float const *element) {
        if constexpr (WIDTH == 8) {
            return _mm256_loadu_ps(element);
        } else {
            return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(element)),
                                        loadFloats<WIDTH - 4>(element + 4), 1);
        }
    }
};

/// Two elements of 1 to 4 floats, each in one half.
template <int WIDTH>
struct NarrowPacket {
    static constexpr int kNumElements = 2;

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
    /// Of elements \p first and on alone.
    static Vector MultiplyAddFrom(int first, Vector elements, Vector weights, Vector sum) {
        Vector const result = _mm256_fmadd_ps(elements, weights, sum);
        return first == 0 ? result : _mm256_blend_ps(sum, result, 0xf0);
    }

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

struct Avx2Simd {
    template <int WIDTH>
    using Packet = std::conditional_t<(WIDTH > 4), WidePacket<WIDTH>, NarrowPacket<WIDTH>>;
};

} // namespace

void EvalStencilsAvx2(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    evalStencilsAs<Avx2Simd>(task, begin, end, firstWeight);
}

} // namespace OpenSubdivHex::OsdExt::internal

#endif

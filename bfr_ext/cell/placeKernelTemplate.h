// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PLACE_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PLACE_KERNEL_TEMPLATE_H

#include "placeKernel.h"

#include <utility>

// Included by one source file for each set of instructions, which must not share what the compiler
// makes of it: hence the unnamed namespace.
namespace OpenSubdivHex::BfrExt::internal {
namespace {

/// Numbers that are computed with at once, in a register where the machine has such.
template <typename REAL, std::size_t BYTES>
struct PlainLanes {
    static constexpr std::size_t kSize = BYTES / sizeof(REAL);

    PlainLanes operator*(REAL factor) const {
        PlainLanes result;
        for (std::size_t i = 0; i < kSize; ++i) {
            result.values[i] = values[i] * factor;
        }
        return result;
    }
    PlainLanes &operator+=(PlainLanes const &other) {
        for (std::size_t i = 0; i < kSize; ++i) {
            values[i] += other.values[i];
        }
        return *this;
    }

    REAL values[kSize];
};

///
/// In memory they are aligned as numbers are.  They are read and written as InMemory and never by
/// std::memcpy(), with which compilers would keep all sums in memory.
template <typename REAL, std::size_t BYTES>
struct LanesOf {
    using Type = PlainLanes<REAL, BYTES>;
    using InMemory = Type;
};
#if defined(__GNUC__)
template <>
struct LanesOf<float, 16> {
    using Type = float __attribute__((vector_size(16)));
    using InMemory = float __attribute__((vector_size(16), aligned(4), may_alias));
};
template <>
struct LanesOf<double, 16> {
    using Type = double __attribute__((vector_size(16)));
    using InMemory = double __attribute__((vector_size(16), aligned(8), may_alias));
};
template <>
struct LanesOf<float, 32> {
    using Type = float __attribute__((vector_size(32)));
    using InMemory = float __attribute__((vector_size(32), aligned(4), may_alias));
};
template <>
struct LanesOf<double, 32> {
    using Type = double __attribute__((vector_size(32)));
    using InMemory = double __attribute__((vector_size(32), aligned(8), may_alias));
};
template <>
struct LanesOf<float, 64> {
    using Type = float __attribute__((vector_size(64)));
    using InMemory = float __attribute__((vector_size(64), aligned(4), may_alias));
};
template <>
struct LanesOf<double, 64> {
    using Type = double __attribute__((vector_size(64)));
    using InMemory = double __attribute__((vector_size(64), aligned(8), may_alias));
};
#endif

#if defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define OPENSUBDIVHEX_HAS_SHUFFLES
#endif
#endif

#ifdef OPENSUBDIVHEX_HAS_SHUFFLES
/// Register OUT of three, in which x, y and z of points alternate, from those of all x, y and z.
template <std::size_t OUT, typename LANES, std::size_t... I>
LANES interleave(LANES const &x, LANES const &y, LANES const &z, std::index_sequence<I...>) {
    constexpr std::size_t kSize = sizeof...(I);
    LANES const xy = __builtin_shufflevector(
        x, y, int((OUT * kSize + I) / 3 + (OUT * kSize + I) % 3 % 2 * kSize)...);
    return __builtin_shufflevector(
        xy, z, int((OUT * kSize + I) % 3 == 2 ? kSize + (OUT * kSize + I) / 3 : I)...);
}
#endif

/// Sums of a block of places.
template <std::size_t BYTES, typename REAL>
class BlockSums {
public:
    using Lanes = typename LanesOf<REAL, BYTES>::Type;
    using InMemory = typename LanesOf<REAL, BYTES>::InMemory;
    static constexpr std::size_t kSize = BYTES / sizeof(REAL);
    static_assert(sizeof(Lanes) == BYTES);

    BlockSums(PlaceMatrix<REAL> const &matrix, PlaceSums<REAL> const &sums)
        : _matrix(matrix), _sums(sums),
          _isPacked(sums.size == 3 && sums.resultStride == 3 && !sums.rows) {}

    void Form() {
        std::size_t const numPlaces = _matrix.GetNumPlaces();
        PlaceOfRow const *row = _sums.rows;
        for (_begin = 0; _begin < numPlaces; _begin += PlaceMatrix<REAL>::kMaxWidth) {
            _width = _matrix.GetWidth(_begin);
            _count = std::min(_width, numPlaces - _begin);
            PlaceOfRow const *const firstRow = row;
            if (_sums.rows) {
                while (row != _sums.rows + _sums.numRows && row->row < int(_begin + _count)) {
                    ++row;
                }
                if (row == firstRow) {
                    continue;
                }
                _count = std::size_t(row[-1].row) + 1 - _begin;
            }
            std::size_t component = 0;
            for (; component + 3 <= _sums.size; component += 3) {
                formComponents<3>(component, firstRow, row);
            }
            for (; component < _sums.size; ++component) {
                formComponents<1>(component, firstRow, row);
            }
        }
    }

private:
    template <std::size_t NUM_COMPONENTS>
    void formComponents(std::size_t component, PlaceOfRow const *firstRow,
                        PlaceOfRow const *lastRow) {
        if (_sums.indices) {
            formTiles<NUM_COMPONENTS, true>(component);
        } else {
            formTiles<NUM_COMPONENTS, false>(component);
        }
        REAL *const results = _sums.results + component;
        if (!_sums.rows) {
            for (std::size_t i = _numWritten; i < _count; ++i) {
                write<NUM_COMPONENTS>(i, results + std::ptrdiff_t(_begin + i) * _sums.resultStride);
            }
            return;
        }
        for (PlaceOfRow const *row = firstRow; row != lastRow; ++row) {
            write<NUM_COMPONENTS>(std::size_t(row->row) - _begin,
                                  results + std::ptrdiff_t(row->place) * _sums.resultStride);
        }
    }

    template <std::size_t NUM_COMPONENTS>
    void write(std::size_t i, REAL *result) const {
        for (std::size_t k = 0; k < NUM_COMPONENTS; ++k) {
            result[k] = _numbers[k][i];
        }
    }

    template <std::size_t NUM_COMPONENTS, bool HAS_INDICES>
    void formTiles(std::size_t component) {
        _numWritten = 0;
        std::size_t first = 0;
        std::size_t const end = (_count + kSize - 1) / kSize * kSize;
        for (; first + 3 * kSize <= end; first += 3 * kSize) {
            formTile<3, NUM_COMPONENTS, HAS_INDICES>(component, first);
        }
        if (first + 2 * kSize <= end) {
            formTile<2, NUM_COMPONENTS, HAS_INDICES>(component, first);
            first += 2 * kSize;
        }
        if (first < end) {
            formTile<1, NUM_COMPONENTS, HAS_INDICES>(component, first);
        }
    }

    /// NUM_LANES registers of places, from the first on, of each component.
    template <std::size_t NUM_LANES, std::size_t NUM_COMPONENTS, bool HAS_INDICES>
    void formTile(std::size_t component, std::size_t first) {
        std::size_t const numPoints = _matrix.GetNumPoints();
        REAL const *weights = _matrix.GetBlock(_begin) + first;
        REAL const *const points = _sums.points + component;
        Lanes sums[NUM_COMPONENTS][NUM_LANES] = {};
        for (std::size_t i = 0; i < numPoints; ++i) {
            auto const *const lanes = reinterpret_cast<InMemory const *>(weights);
            weights += _width;
            auto const place = std::ptrdiff_t(HAS_INDICES ? std::size_t(_sums.indices[i]) : i);
            REAL const *const point = points + place * _sums.stride;
            for (std::size_t lane = 0; lane < NUM_LANES; ++lane) {
                Lanes const ofLane = lanes[lane];
                for (std::size_t k = 0; k < NUM_COMPONENTS; ++k) {
                    sums[k][lane] += ofLane * point[k];
                }
            }
        }
#ifdef OPENSUBDIVHEX_HAS_SHUFFLES
        if constexpr (NUM_COMPONENTS == 3) {
            if (_isPacked && first + NUM_LANES * kSize <= _count) {
                constexpr std::make_index_sequence<kSize> kIndices;
                auto *result = reinterpret_cast<InMemory *>(_sums.results + 3 * (_begin + first));
                for (std::size_t lane = 0; lane < NUM_LANES; ++lane) {
                    Lanes const &x = sums[0][lane];
                    Lanes const &y = sums[1][lane];
                    Lanes const &z = sums[2][lane];
                    *result++ = interleave<0>(x, y, z, kIndices);
                    *result++ = interleave<1>(x, y, z, kIndices);
                    *result++ = interleave<2>(x, y, z, kIndices);
                }
                _numWritten = first + NUM_LANES * kSize;
                return;
            }
        }
#endif
        for (std::size_t k = 0; k < NUM_COMPONENTS; ++k) {
            auto *numbers = reinterpret_cast<InMemory *>(_numbers[k] + first);
            for (std::size_t lane = 0; lane < NUM_LANES; ++lane) {
                *numbers++ = sums[k][lane];
            }
        }
    }

    PlaceMatrix<REAL> const &_matrix;
    PlaceSums<REAL> const &_sums;
    bool const _isPacked; // whether results are three numbers each without gaps
    std::size_t _begin = 0;
    std::size_t _width = 0;
    std::size_t _count = 0;      // places of the block, up to the last one that is wanted
    std::size_t _numWritten = 0; // of these, the first ones, which are in the results already
    REAL _numbers[3][PlaceMatrix<REAL>::kMaxWidth];
};

template <std::size_t BYTES, typename REAL>
void sumUpPlaces(PlaceMatrix<REAL> const &matrix, PlaceSums<REAL> const &sums) {
    BlockSums<BYTES, REAL>(matrix, sums).Form();
}

} // namespace
} // namespace OpenSubdivHex::BfrExt::internal

#endif

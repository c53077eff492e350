// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PLACE_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PLACE_KERNEL_TEMPLATE_H

#include "placeKernel.h"
#include "registers.h"

#include <cstring>
#include <type_traits>
#include <utility>

namespace OpenSubdivHex::BfrExt::internal {
namespace {

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
        x, y, int((OUT * kSize + I) / 3 + ((OUT * kSize + I) % 3 == 1 ? kSize : 0))...);
    return __builtin_shufflevector(
        xy, z, int((OUT * kSize + I) % 3 < 2 ? I : kSize + (OUT * kSize + I) / 3)...);
}
#endif

/// Forms sums of a block of places, in tiles of some registers each.
template <std::size_t BYTES, typename REAL>
class TileSums {
public:
    using In = Registers<REAL, BYTES>;
    using Lanes = typename In::Lanes;
    static constexpr std::size_t kSize = In::kSize;

    /// Stores kSize points, from those of the components.
    static void StorePoints(Lanes const &x, Lanes const &y, Lanes const &z, REAL *to) {
#ifdef OPENSUBDIVHEX_HAS_SHUFFLES
        constexpr std::make_index_sequence<kSize> kIndices;
        In::Store(interleave<0>(x, y, z, kIndices), to);
        In::Store(interleave<1>(x, y, z, kIndices), to + kSize);
        In::Store(interleave<2>(x, y, z, kIndices), to + 2 * kSize);
#else
        REAL numbers[3][kSize];
        In::Store(x, numbers[0]);
        In::Store(y, numbers[1]);
        In::Store(z, numbers[2]);
        for (std::size_t i = 0; i < kSize; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                *to++ = numbers[k][i];
            }
        }
#endif
    }

    /// The numbers of the places of a block, component by component.
    using Numbers = REAL[3][PlaceMatrix<REAL>::kMaxWidth];

    /// The numbers place by place, with three components, of as many places as registers hold.
    using Points = REAL (*)[3];

    /// \param begin   the first place of the block
    /// \param count   places of the block that are wanted, the first ones
    /// \param points  as those of PlaceSums, from the first component on that is wanted
    /// \param result  Numbers, or Points of three components
    template <std::size_t NUM_COMPONENTS, bool HAS_INDICES, typename RESULT>
    static void Form(PlaceMatrix<REAL> const &matrix, std::size_t begin, std::size_t count,
                     REAL const *points, std::ptrdiff_t stride, int const *indices,
                     RESULT &result) {
        TileSums const tiles{matrix.GetNumPoints(), matrix.GetWidth(begin), points, stride,
                             indices};
        REAL const *const weights = matrix.GetBlock(begin);
        forTiles<kMaxTile>(0, count, [&](auto numLanes, std::size_t first) {
            tiles.template form<numLanes(), NUM_COMPONENTS, HAS_INDICES>(weights, first, result);
        });
    }

    std::size_t numPoints;
    std::size_t width; // of the block
    REAL const *points;
    std::ptrdiff_t stride;
    int const *indices;

private:
    // Registers of places at most, so that the sums of all components are in registers: there are 32 of
    // the widest ones, and else 16.
    static constexpr std::size_t kMaxTile = BYTES == 64 ? 6 : 3;

    /// Calls function(number, first) for the registers of some places, NUM_LANES at a time and then as many as are
    /// left.  The number is an integral constant.
    template <std::size_t NUM_LANES, typename FUNCTION>
    static void forTiles(std::size_t first, std::size_t end, FUNCTION const &function) {
        if constexpr (NUM_LANES > 0) {
            for (; first + (NUM_LANES - 1) * kSize < end; first += NUM_LANES * kSize) {
                function(std::integral_constant<std::size_t, NUM_LANES>(), first);
            }
            forTiles<NUM_LANES - 1>(first, end, function);
        }
    }

    /// NUM_LANES registers of places, from the first on, of each component.
    template <std::size_t NUM_LANES, std::size_t NUM_COMPONENTS, bool HAS_INDICES, typename RESULT>
    void form(REAL const *weights, std::size_t first, RESULT &result) const {
        Lanes sums[NUM_LANES][NUM_COMPONENTS];
        setZero(sums);
        weights += first;
        for (std::size_t i = 0; i < numPoints; ++i) {
            auto const place = std::ptrdiff_t(HAS_INDICES ? std::size_t(indices[i]) : i);
            REAL const *const point = points + place * stride;
            for (std::size_t lane = 0; lane < NUM_LANES; ++lane) {
                Lanes ofLane = In::Load(weights + lane * kSize);
                keepInRegister(ofLane);
                for (std::size_t k = 0; k < NUM_COMPONENTS; ++k) {
                    In::AddProducts(sums[lane][k], ofLane, point[k]);
                }
            }
            weights += width;
        }
        for (std::size_t lane = 0; lane < NUM_LANES; ++lane) {
            storeSums(sums[lane], first + lane * kSize, result);
        }
    }

    /// GCC would keep an array in memory that is set to 0 as a whole.
    template <std::size_t NUM, std::size_t NUM_COMPONENTS>
    static void setZero(Lanes (&sums)[NUM][NUM_COMPONENTS]) {
        for (auto &some : sums) {
            std::fill(std::begin(some), std::end(some), Lanes{});
        }
    }

    /// GCC would read the lanes again for each component, and machines read less than they multiply.
    static void keepInRegister(Lanes &lanes) {
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
        asm("" : "+v"(lanes));
#else
        static_cast<void>(lanes);
#endif
    }

    template <std::size_t NUM_COMPONENTS>
    static void storeSums(Lanes const (&sums)[NUM_COMPONENTS], std::size_t first,
                          Numbers &numbers) {
        for (std::size_t k = 0; k < NUM_COMPONENTS; ++k) {
            In::Store(sums[k], numbers[k] + first);
        }
    }
    static void storeSums(Lanes const (&sums)[3], std::size_t first, Points const &places) {
        StorePoints(sums[0], sums[1], sums[2], places[first]);
    }
};

/// Calls function(number, component) for all components: three at a time, where so many are left, each from
/// component on, and then one at a time.  The number is an integral constant.
template <typename FUNCTION>
void forComponents(std::size_t numComponents, FUNCTION const &function) {
    std::size_t component = 0;
    for (; component + 3 <= numComponents; component += 3) {
        function(std::integral_constant<std::size_t, 3>(), component);
    }
    for (; component < numComponents; ++component) {
        function(std::integral_constant<std::size_t, 1>(), component);
    }
}

/// Places of a block of a matrix.
struct PlaceBlock {
    std::size_t begin;
    std::size_t count; ///< up to the last one that is wanted
    /// The wanted places; null: all.
    PlaceRun const *firstRun;
    PlaceRun const *endRun;
};

/// Calls function(block) for all blocks with places that are wanted.
template <typename REAL, typename FUNCTION>
void forBlocks(PlaceMatrix<REAL> const &matrix, PlaceSums<REAL> const &sums,
               FUNCTION const &function) {
    std::size_t const numPlaces = matrix.GetNumPlaces();
    PlaceRun const *run = sums.runs;
    for (std::size_t begin = 0; begin < numPlaces; begin += PlaceMatrix<REAL>::kMaxWidth) {
        PlaceBlock block = {begin, std::min(matrix.GetWidth(begin), numPlaces - begin), run, run};
        if (sums.runs) {
            run = std::lower_bound(run, sums.runs + sums.numRuns, int(begin + block.count),
                                   [](PlaceRun const &other, int end) { return other.row < end; });
            if (run == block.firstRun) {
                continue;
            }
            block.endRun = run;
            block.count = std::size_t(run[-1].row + run[-1].count) - begin;
        }
        function(block);
    }
}

/// Writes points of three numbers.
template <typename REAL>
void writeRun(REAL const (*places)[3], std::size_t count, REAL *results, std::ptrdiff_t stride) {
    if (stride == 3) {
        std::memcpy(results, places, count * sizeof(*places));
        return;
    }
    for (std::size_t i = 0; i < count; ++i, results += stride) {
        std::memcpy(results, places[i], sizeof(*places));
    }
}

/// Writes what is wanted of a block, from TileSums::Points or TileSums::Numbers.
template <std::size_t NUM_COMPONENTS, typename REAL, typename NUMBERS>
void writePlaces(PlaceBlock const &block, NUMBERS const &numbers, REAL *results,
                 std::ptrdiff_t stride) {
    auto const write = [&](std::size_t first, std::ptrdiff_t place, std::size_t count) {
        REAL *to = results + place * stride;
        if constexpr (NUM_COMPONENTS == 3) {
            writeRun(numbers + first, count, to, stride);
        } else {
            for (std::size_t i = first; i < first + count; ++i, to += stride) {
                for (std::size_t k = 0; k < NUM_COMPONENTS; ++k) {
                    to[k] = numbers[k][i];
                }
            }
        }
    };
    if (!block.firstRun) {
        write(0, std::ptrdiff_t(block.begin), block.count);
    }
    for (PlaceRun const *run = block.firstRun; run != block.endRun; ++run) {
        write(std::size_t(run->row) - block.begin, std::ptrdiff_t(run->place),
              std::size_t(run->count));
    }
}

/// Sums of the places of a matrix, block by block.
template <std::size_t BYTES, typename REAL>
class BlockSums {
public:
    BlockSums(PlaceMatrix<REAL> const &matrix, PlaceSums<REAL> const &sums)
        : _matrix(matrix), _sums(sums) {}

    void Form() {
        forBlocks(_matrix, _sums, [&](PlaceBlock const &block) {
            forComponents(_sums.size, [&](auto number, std::size_t component) {
                if (_sums.indices) {
                    this->template formComponents<number(), true>(component, block);
                } else {
                    this->template formComponents<number(), false>(component, block);
                }
            });
        });
    }

private:
    using Tiles = TileSums<BYTES, REAL>;

    template <std::size_t NUM_COMPONENTS, bool HAS_INDICES>
    void formComponents(std::size_t component, PlaceBlock const &block) {
        auto const form = [&](auto &result) {
            Tiles::template Form<NUM_COMPONENTS, HAS_INDICES>(_matrix, block.begin, block.count,
                                                              _sums.points + component,
                                                              _sums.stride, _sums.indices, result);
        };
        REAL *const results = _sums.results + component;
        if constexpr (NUM_COMPONENTS == 3) {
            bool const fillsRegisters = block.count == _matrix.GetWidth(block.begin);
            if (fillsRegisters && !block.firstRun && _sums.resultStride == 3) {
                auto *places = reinterpret_cast<typename Tiles::Points>(results) + block.begin;
                form(places);
                return;
            }
            typename Tiles::Points places = _places;
            form(places);
            writePlaces<NUM_COMPONENTS>(block, places, results, _sums.resultStride);
        } else {
            form(_numbers);
            writePlaces<NUM_COMPONENTS>(block, _numbers, results, _sums.resultStride);
        }
    }

    PlaceMatrix<REAL> const &_matrix;
    PlaceSums<REAL> const &_sums;
    typename Tiles::Numbers _numbers;
    REAL _places[PlaceMatrix<REAL>::kMaxWidth][3];
};

template <std::size_t BYTES, typename REAL>
void sumUpPlaces(PlaceMatrix<REAL> const &matrix, PlaceSums<REAL> const &sums) {
    BlockSums<BYTES, REAL>(matrix, sums).Form();
}
} // namespace
} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PLACE_KERNEL_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PLACE_KERNEL_H

#include "memoryCount.h"
#include "patchSums.h"

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// Memory that begins where a register of any machine may: those that lie across two lines of the cache
/// would be read in twice the time.
template <typename T>
struct RegisterAllocator {
    using value_type = T;
    static constexpr std::align_val_t kAlignment{64};

    RegisterAllocator() = default;
    template <typename OTHER>
    RegisterAllocator(RegisterAllocator<OTHER> const &) {}

    T *allocate(std::size_t size) {
        return static_cast<T *>(::operator new(size * sizeof(T), kAlignment));
    }
    void deallocate(T *array, std::size_t) { ::operator delete(array, kAlignment); }
    friend bool operator==(RegisterAllocator const &, RegisterAllocator const &) { return true; }
    friend bool operator!=(RegisterAllocator const &, RegisterAllocator const &) { return false; }
};

/// \brief Rows of a matrix that follow one another, whose places in a face follow one another, too.
///
/// A run ends where a block of rows does, of any matrix.
struct PlaceRun {
    static constexpr int kMaxBlock = 48;

    int row;
    int place;
    int count;
};

/// \brief The stencils of places as a dense matrix.
///
/// Places stand in blocks of kMaxWidth, and of what is left at the end; a block has the weights of its
/// places side by side, point by point.  Widths are those of whole registers, of any machine's.
template <typename REAL>
class PlaceMatrix {
public:
    static constexpr std::size_t kLanes = 64 / sizeof(REAL);
    static constexpr std::size_t kMaxWidth = 6 * kLanes;
    static_assert(kMaxWidth % PlaceRun::kMaxBlock == 0);

    PlaceMatrix() = default;
    PlaceMatrix(std::size_t numPlaces, std::size_t numPoints)
        : _numPlaces(numPlaces), _numPoints(numPoints),
          _weights((numPlaces + kLanes - 1) / kLanes * kLanes * numPoints) {}

    std::size_t GetNumPlaces() const { return _numPlaces; }
    std::size_t GetNumPoints() const { return _numPoints; }
    std::size_t GetHeapSize() const { return internal::GetHeapSize(_weights); }

    template <typename WEIGHT = double>
    void Set(std::size_t place, std::vector<WEIGHT> const &stencil) {
        std::size_t const begin = place / kMaxWidth * kMaxWidth;
        std::size_t const width = GetWidth(begin);
        REAL *weight = _weights.data() + begin * _numPoints + (place - begin);
        for (WEIGHT const value : stencil) {
            *weight = REAL(value);
            weight += width;
        }
    }

    /// The width of the block that begins with place \p begin.
    std::size_t GetWidth(std::size_t begin) const {
        return std::min(kMaxWidth, (_numPlaces - begin + kLanes - 1) / kLanes * kLanes);
    }
    /// The weights of that block.
    REAL const *GetBlock(std::size_t begin) const { return _weights.data() + begin * _numPoints; }

private:
    std::size_t _numPlaces = 0;
    std::size_t _numPoints = 0;
    std::vector<REAL, RegisterAllocator<REAL>> _weights;
};

/// \brief Points, and where the weighted sums of them go that a matrix makes.
///
/// Each number of the result is a sum of its own, over the points in their order: so it does not depend on what is
/// computed beside it.  All kernels for machines that fuse products with sums give the same bits; the portable one, for
/// machines that may not, gives its own.
template <typename REAL>
struct PlaceSums {
    REAL const *points;
    std::ptrdiff_t stride; ///< from one point to the next, in numbers
    std::size_t size;      ///< of a point
    int const *indices;    ///< which points the columns of the matrix have, or null: all in turn
    REAL *results;
    std::ptrdiff_t resultStride;
    /// The wanted points, ascending by row; null: all, each where its row says.
    PlaceRun const *runs = nullptr;
    std::size_t numRuns = 0;
};

/// The sums that a set of instructions forms.
template <typename REAL>
struct SumKernels {
    void (*sumUpPlaces)(PlaceMatrix<REAL> const &matrix, PlaceSums<REAL> const &sums);
    /// The same bits for any size and stride of points.
    void (*sumUpPatch)(PatchSums<REAL> const &sums);
};

/// @name Those of some instructions, which the machine must have
/// @{
template <typename REAL>
SumKernels<REAL> GetPortableKernels();
template <typename REAL>
SumKernels<REAL> GetAvx2Kernels();
template <typename REAL>
SumKernels<REAL> GetAvx512Kernels();
/// @}

/// Those that the machine has, the portable ones first and the widest ones last.
template <typename REAL>
std::vector<SumKernels<REAL>> FindKernels();

/// @name Sums by the widest ones
/// @{
void SumUpPlaces(PlaceMatrix<float> const &matrix, PlaceSums<float> const &sums);
void SumUpPlaces(PlaceMatrix<double> const &matrix, PlaceSums<double> const &sums);
void SumUpPatch(PatchSums<float> const &sums);
void SumUpPatch(PatchSums<double> const &sums);
/// @}

} // namespace OpenSubdivHex::BfrExt::internal

#endif

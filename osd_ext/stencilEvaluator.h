// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_STENCIL_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_STENCIL_EVALUATOR_H

#include "far_ext/export.h"

#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/osd/bufferDescriptor.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <vector>

namespace OpenSubdivHex {

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

namespace internal {
struct StencilBlock;
struct StencilTypes;
} // namespace internal

/// \cond  Not for users.
/// \brief The types that StencilEvaluator shares with its evaluators: nothing for users.
class StencilEvaluatorBase {
protected:
    /// The stencils of a table: as StencilEvaluator takes them or, if there are blocks, in these.
    struct StencilRows {
        /// Whether the weights of a stencil are found without a look at those before it.
        bool HasPlaces() const { return offsets || blocks; }

        int const *sizes;
        int const *offsets; ///< may be null
        int const *indices;
        internal::StencilBlock const *blocks = nullptr; ///< sizes and offsets are not read then
    };

    /// A set of weights and where their sums go: the value or one of its derivatives.
    struct StencilOutput {
        float *dst;
        Osd::BufferDescriptor desc;
        float const *weights;
    };

private:
    friend class CompactStencilTable;
    friend struct internal::StencilTypes;
};
/// \endcond

/// \brief A stencil table in less memory: consecutive stencils with the same indices, such as those of the corners of a
/// face, share one list of indices.
///
/// \code
///     auto compact = OsdExt::CompactStencilTable::Create(*table);
///     OsdExt::ParallelEvaluator::EvalStencils(src, desc, dst, desc, compact.get());
/// \endcode
///
/// CpuEvaluator and ParallelEvaluator take it, with the results of the table that it was made from, bit for bit;
/// other evaluators do not.  For tables of the hexagonal scheme it takes 0.62 to 0.65 of the memory, and evaluation is 1.1
/// to 1.7 times as fast on one thread (benchmark evaluation, compact table).  A table of Catmull-Clark gets larger.
///
/// Several threads may make, and evaluate, the same table at once.  std::bad_alloc passes through.
class OPENSUBDIVHEX_API CompactStencilTable {
public:
    ~CompactStencilTable();

    /// Makes the table of the stencils of \p table, which is not needed afterwards.
    static std::unique_ptr<CompactStencilTable const> Create(Far::StencilTable const &table);

    /// Stencils, as of the table that it was made from.
    int GetNumStencils() const { return _numStencils; }
    /// Control vertices, as of the table that it was made from.
    int GetNumControlVertices() const { return _numControlVertices; }
    /// Lists of indices that stencils share.
    int GetNumBlocks() const;
    /// Bytes of all arrays.
    std::size_t GetNumBytes() const;

private:
    template <class EVALUATOR>
    friend class StencilEvaluator;

    CompactStencilTable();

    StencilEvaluatorBase::StencilRows getRows() const;

    int _numStencils = 0;
    int _numControlVertices = 0;
    std::vector<internal::StencilBlock> _blocks;
    std::vector<int> _indices;
    std::vector<float> _weights;
};

/// \brief Functions of CpuEvaluator and ParallelEvaluator that evaluate stencils, with the signatures of
/// Osd::CpuEvaluator, so that templates such as Osd::Mesh accept them.  PatchEvaluator has the EvalPatches functions.
///
/// \code
///     Osd::BufferDescriptor const desc(0, 3, 3); // x, y and z
///     OsdExt::ParallelEvaluator::EvalStencils(srcBuffer, desc, dstBuffer, desc, table.get());
/// \endcode
///
/// **Tables.** Any Far::StencilTable or Far::LimitStencilTable, of this library or of OpenSubdiv,
/// or a class with their functions, and CompactStencilTable.  Offsets may be missing, as Far's
/// option generateOffsets suggests: stencils then follow each other without gaps, and ParallelEvaluator
/// and ranges that do not start at 0 cost a pass over the sizes.
///
/// **Elements.** Source element j is the \c length floats from <tt>offset + j * stride</tt> on,
/// computed in 64 bits.  Nothing else is read, not even beside them, and nothing else is written.
///
/// **Ranges.** Stencils [start, end) are evaluated, and the destination element of stencil i is
/// element i, for all lengths and evaluators.  Osd::CpuEvaluator and Osd::OmpEvaluator of
/// OpenSubdiv 3.5 and 3.6 write it to element i - start instead, except that Osd::CpuEvaluator
/// writes packed elements of length 4 and 8 to element i, with the sizes of other stencils: it is
/// wrong there unless start is 0.
///
/// **Aliasing.** All buffers may be one.  No element that is written in a call may be read in it,
/// but for CpuEvaluator, which evaluates the stencils in ascending order: a stencil may read the
/// results of those before it.
///
/// **Order of summation.** It depends on the size of the stencil and on the SimdLevel alone, so
/// that results are the same, bit for bit, for both evaluators and for any number of threads,
/// range, stride and offset.
///
/// **Threads.** Several threads may evaluate at once, also the same table and from the same source,
/// into elements of their own.  Nothing throws but ParallelEvaluator, std::bad_alloc for a
/// table without offsets; nothing is written then.
///
/// **Return value.** True if all went well, also where there is nothing to do: an empty table, and
/// end <= start.  False, with nothing written, if
///  - the lengths of the descriptors differ, or are less than 1,
///  - a stride is less than the length, or an offset is negative,
///  - start is negative in a range that is not empty,
///  - the table or a buffer is null, or in a range that is not empty src, sizes or a destination,
///  - the table has no weights for a derivative that is asked for.
///
/// Osd returns false for an empty table without derivatives, and checks nothing but the lengths.
template <class EVALUATOR>
class StencilEvaluator : public StencilEvaluatorBase {
public:
    /// @name With buffers
    /// \param srcBuffer,dstBuffer,...  have a function BindCpuBuffer() that returns a float pointer
    /// \param instance,deviceContext   not used
    /// @{

    /// Evaluates all stencils of a table.
    template <class SRC_BUFFER, class DST_BUFFER, class STENCIL_TABLE>
    static bool
    EvalStencils(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc, DST_BUFFER *dstBuffer,
                 Osd::BufferDescriptor const &dstDesc, STENCIL_TABLE const *stencilTable,
                 EVALUATOR const * /*instance*/ = nullptr, void * /*deviceContext*/ = nullptr) {
        return stencilTable &&
               evalTable(srcBuffer, srcDesc, *stencilTable,
                         {bind(dstBuffer, dstDesc, *stencilTable, stencilTable->GetWeights())});
    }

    /// Overload for a CompactStencilTable.
    template <class SRC_BUFFER, class DST_BUFFER>
    static bool
    EvalStencils(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc, DST_BUFFER *dstBuffer,
                 Osd::BufferDescriptor const &dstDesc, CompactStencilTable const *stencilTable,
                 EVALUATOR const * /*instance*/ = nullptr, void * /*deviceContext*/ = nullptr) {
        return stencilTable && eval(srcBuffer ? srcBuffer->BindCpuBuffer() : nullptr, srcDesc,
                                    {{dstBuffer ? dstBuffer->BindCpuBuffer() : nullptr, dstDesc,
                                      stencilTable->_weights.data()}},
                                    stencilTable->getRows(), 0, stencilTable->GetNumBlocks());
    }

    /// Overload with first derivatives, for a Far::LimitStencilTable.
    template <class SRC_BUFFER, class DST_BUFFER, class STENCIL_TABLE>
    static bool
    EvalStencils(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc, DST_BUFFER *dstBuffer,
                 Osd::BufferDescriptor const &dstDesc, DST_BUFFER *duBuffer,
                 Osd::BufferDescriptor const &duDesc, DST_BUFFER *dvBuffer,
                 Osd::BufferDescriptor const &dvDesc, STENCIL_TABLE const *stencilTable,
                 EVALUATOR const * /*instance*/ = nullptr, void * /*deviceContext*/ = nullptr) {
        return stencilTable &&
               evalTable(srcBuffer, srcDesc, *stencilTable,
                         {bind(dstBuffer, dstDesc, *stencilTable, stencilTable->GetWeights()),
                          bind(duBuffer, duDesc, *stencilTable, stencilTable->GetDuWeights()),
                          bind(dvBuffer, dvDesc, *stencilTable, stencilTable->GetDvWeights())});
    }

    /// Overload with first and second derivatives.
    template <class SRC_BUFFER, class DST_BUFFER, class STENCIL_TABLE>
    static bool
    EvalStencils(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc, DST_BUFFER *dstBuffer,
                 Osd::BufferDescriptor const &dstDesc, DST_BUFFER *duBuffer,
                 Osd::BufferDescriptor const &duDesc, DST_BUFFER *dvBuffer,
                 Osd::BufferDescriptor const &dvDesc, DST_BUFFER *duuBuffer,
                 Osd::BufferDescriptor const &duuDesc, DST_BUFFER *duvBuffer,
                 Osd::BufferDescriptor const &duvDesc, DST_BUFFER *dvvBuffer,
                 Osd::BufferDescriptor const &dvvDesc, STENCIL_TABLE const *stencilTable,
                 EVALUATOR const * /*instance*/ = nullptr, void * /*deviceContext*/ = nullptr) {
        return stencilTable &&
               evalTable(srcBuffer, srcDesc, *stencilTable,
                         {bind(dstBuffer, dstDesc, *stencilTable, stencilTable->GetWeights()),
                          bind(duBuffer, duDesc, *stencilTable, stencilTable->GetDuWeights()),
                          bind(dvBuffer, dvDesc, *stencilTable, stencilTable->GetDvWeights()),
                          bind(duuBuffer, duuDesc, *stencilTable, stencilTable->GetDuuWeights()),
                          bind(duvBuffer, duvDesc, *stencilTable, stencilTable->GetDuvWeights()),
                          bind(dvvBuffer, dvvDesc, *stencilTable, stencilTable->GetDvvWeights())});
    }
    /// @}

    /// @name With pointers
    /// \param src,dst,...  without the offset of their descriptors, which is added
    /// \param sizes        of the indices of each stencil, 0 or more
    /// \param offsets      of the first index of each stencil, 0 or more; null: without gaps from 0
    /// on
    /// \param indices      of source elements, 0 or more
    /// \param weights,...  in the order of the indices
    /// @{

    // clang-tidy does not see that pointers in braces are copied.
    // NOLINTBEGIN(readability-non-const-parameter)

    /// Evaluates stencils [start, end).
    static bool EvalStencils(float const *src, Osd::BufferDescriptor const &srcDesc, //
                             float *dst, Osd::BufferDescriptor const &dstDesc,       //
                             int const *sizes, int const *offsets, int const *indices,
                             float const *weights, int start, int end) {
        return eval(src, srcDesc, {{dst, dstDesc, weights}}, {sizes, offsets, indices, nullptr},
                    start, end);
    }

    /// Overload with first derivatives.
    static bool EvalStencils(float const *src, Osd::BufferDescriptor const &srcDesc, //
                             float *dst, Osd::BufferDescriptor const &dstDesc,       //
                             float *du, Osd::BufferDescriptor const &duDesc,         //
                             float *dv, Osd::BufferDescriptor const &dvDesc,         //
                             int const *sizes, int const *offsets, int const *indices,
                             float const *weights, float const *duWeights, float const *dvWeights,
                             int start, int end) {
        return eval(src, srcDesc,
                    {{dst, dstDesc, weights}, {du, duDesc, duWeights}, {dv, dvDesc, dvWeights}},
                    {sizes, offsets, indices, nullptr}, start, end);
    }

    /// Overload with first and second derivatives.
    static bool EvalStencils(float const *src, Osd::BufferDescriptor const &srcDesc, //
                             float *dst, Osd::BufferDescriptor const &dstDesc,       //
                             float *du, Osd::BufferDescriptor const &duDesc,         //
                             float *dv, Osd::BufferDescriptor const &dvDesc,         //
                             float *duu, Osd::BufferDescriptor const &duuDesc,       //
                             float *duv, Osd::BufferDescriptor const &duvDesc,       //
                             float *dvv, Osd::BufferDescriptor const &dvvDesc,       //
                             int const *sizes, int const *offsets, int const *indices,
                             float const *weights, float const *duWeights, float const *dvWeights,
                             float const *duuWeights, float const *duvWeights,
                             float const *dvvWeights, int start, int end) {
        return eval(src, srcDesc,
                    {{dst, dstDesc, weights},
                     {du, duDesc, duWeights},
                     {dv, dvDesc, dvWeights},
                     {duu, duuDesc, duuWeights},
                     {duv, duvDesc, duvWeights},
                     {dvv, dvvDesc, dvvWeights}},
                    {sizes, offsets, indices, nullptr}, start, end);
    }
    // NOLINTEND(readability-non-const-parameter)
    /// @}

    /// Does nothing: every evaluation is complete when its function returns.
    static void Synchronize(void * /*deviceContext*/ = nullptr) {}

private:
    /// An output without weights, where the table has none for all of its indices, is refused.
    template <class BUFFER, class STENCIL_TABLE>
    static StencilOutput bind(BUFFER *buffer, Osd::BufferDescriptor const &desc,
                              STENCIL_TABLE const &table, std::vector<float> const &weights) {
        bool const areThere = weights.size() >= table.GetControlIndices().size();
        return {buffer ? buffer->BindCpuBuffer() : nullptr, desc,
                areThere ? weights.data() : nullptr};
    }

    template <class SRC_BUFFER, class STENCIL_TABLE>
    static bool evalTable(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc,
                          STENCIL_TABLE const &table,
                          std::initializer_list<StencilOutput> outputs) {
        int const numStencils = table.GetNumStencils();
        bool const hasOffsets = table.GetOffsets().size() >= std::size_t(numStencils);
        return eval(srcBuffer ? srcBuffer->BindCpuBuffer() : nullptr, srcDesc, outputs,
                    {table.GetSizes().data(), hasOffsets ? table.GetOffsets().data() : nullptr,
                     table.GetControlIndices().data(), nullptr},
                    0, numStencils);
    }

    static bool eval(float const *src, Osd::BufferDescriptor const &srcDesc,
                     std::initializer_list<StencilOutput> outputs, StencilRows const &rows,
                     int start, int end) {
        return EVALUATOR::run(src, srcDesc, outputs.begin(), int(outputs.size()), rows, start, end);
    }
};

/// \brief Makes a buffer (such as Osd::CpuVertexBuffer) for the control vertices of \p table and, behind them, its results.
///
/// \code
///     auto buffer = OsdExt::CreateInPlaceBuffer<Osd::CpuVertexBuffer>(*table, 3);
///     buffer->UpdateData(positions, 0, table->GetNumControlVertices());
///     OsdExt::EvalStencilsInPlace<OsdExt::ParallelEvaluator>(*table, buffer.get());
/// \endcode
///
/// \param numElements  floats per vertex
/// \return  null for less than 1, and where the floats of the buffer are more than 2^31 - 1, which
///          Osd's buffers do not count
template <class BUFFER>
std::unique_ptr<BUFFER> CreateInPlaceBuffer(Far::StencilTable const &table, int numElements) {
    std::int64_t const numVertices =
        std::int64_t(table.GetNumControlVertices()) + table.GetNumStencils();
    if (numElements < 1 || numVertices > (std::numeric_limits<int>::max)() / numElements) {
        return nullptr;
    }
    return std::unique_ptr<BUFFER>(BUFFER::Create(numElements, int(numVertices)));
}

/// \brief Evaluates all stencils of \p table within one buffer: the control values are its first
/// table.GetNumControlVertices() vertices, the results are written right behind them.
///
/// \tparam EVALUATOR  Osd::CpuEvaluator, Osd::OmpEvaluator or another with their static functions
/// \return  what EVALUATOR::EvalStencils returns; false, with nothing written, for no buffer, and where
///          the floats before the results are more than 2^31 - 1, which no descriptor has as an offset
template <class EVALUATOR, class BUFFER>
bool EvalStencilsInPlace(Far::StencilTable const &table, BUFFER *buffer) {
    int const width = buffer ? buffer->GetNumElements() : 0;
    if (width < 1 || table.GetNumControlVertices() > (std::numeric_limits<int>::max)() / width) {
        return false;
    }
    Osd::BufferDescriptor const src(0, width, width);
    Osd::BufferDescriptor const dst(table.GetNumControlVertices() * width, width, width);
    return EVALUATOR::EvalStencils(buffer, src, buffer, dst, &table);
}

/// \brief Evaluates all stencils of \p table from one buffer of control values into another, whose
/// first vertex is the result of the first stencil.  Both have the same number of elements.
///
/// \return  what EVALUATOR::EvalStencils returns; false, with nothing written, where a buffer is missing
template <class EVALUATOR, class SRC_BUFFER, class DST_BUFFER>
bool EvalStencils(Far::StencilTable const &table, SRC_BUFFER *srcBuffer, DST_BUFFER *dstBuffer) {
    if (!srcBuffer || !dstBuffer) {
        return false;
    }
    int const width = srcBuffer->GetNumElements();
    Osd::BufferDescriptor const desc(0, width, width);
    return EVALUATOR::EvalStencils(srcBuffer, desc, dstBuffer, desc, &table);
}

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

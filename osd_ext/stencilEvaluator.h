// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_STENCIL_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_STENCIL_EVALUATOR_H

#include "compactStencilTable.h"

#include <opensubdiv/osd/bufferDescriptor.h>

#include <initializer_list>
#include <vector>

namespace OpenSubdivHex {

namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

namespace internal {

/// \brief An output of stencils, the value or a derivative: its weights and its destination.
struct StencilOutput {
    float *dst;
    Osd::BufferDescriptor desc;
    float const *weights;
};

} // namespace internal

/// \brief Functions of CpuEvaluator, OmpEvaluator and TbbEvaluator that evaluate stencils, with the signatures of
/// Osd::CpuEvaluator, so that templates such as Osd::Mesh accept them.  PatchEvaluator has the EvalPatches functions.
///
/// \code
///     Osd::BufferDescriptor const desc(0, 3, 3); // x, y and z
///     OsdExt::OmpEvaluator::EvalStencils(srcBuffer, desc, dstBuffer, desc, table.get());
/// \endcode
///
/// **Tables.** Any Far::StencilTable or Far::LimitStencilTable, of this library or of OpenSubdiv,
/// or a class with their functions, and CompactStencilTable.  Offsets may be missing, as Far's
/// option generateOffsets suggests: stencils then follow each other without gaps, and OmpEvaluator
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
/// into elements of their own.  Nothing throws but OmpEvaluator and TbbEvaluator, std::bad_alloc for a
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
class StencilEvaluator {
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
    static internal::StencilOutput bind(BUFFER *buffer, Osd::BufferDescriptor const &desc,
                                        STENCIL_TABLE const &table,
                                        std::vector<float> const &weights) {
        bool const areThere = weights.size() >= table.GetControlIndices().size();
        return {buffer ? buffer->BindCpuBuffer() : nullptr, desc,
                areThere ? weights.data() : nullptr};
    }

    template <class SRC_BUFFER, class STENCIL_TABLE>
    static bool evalTable(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc,
                          STENCIL_TABLE const &table,
                          std::initializer_list<internal::StencilOutput> outputs) {
        int const numStencils = table.GetNumStencils();
        bool const hasOffsets = table.GetOffsets().size() >= std::size_t(numStencils);
        return eval(srcBuffer ? srcBuffer->BindCpuBuffer() : nullptr, srcDesc, outputs,
                    {table.GetSizes().data(), hasOffsets ? table.GetOffsets().data() : nullptr,
                     table.GetControlIndices().data(), nullptr},
                    0, numStencils);
    }

    static bool eval(float const *src, Osd::BufferDescriptor const &srcDesc,
                     std::initializer_list<internal::StencilOutput> outputs,
                     internal::StencilRows const &rows, int start, int end) {
        return EVALUATOR::run(src, srcDesc, outputs.begin(), int(outputs.size()), rows, start, end);
    }
};

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

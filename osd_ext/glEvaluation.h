// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_GL_EVALUATION_H
#define OPENSUBDIVHEX_OSD_EXT_GL_EVALUATION_H

#include <opensubdiv/osd/bufferDescriptor.h>
#include <opensubdiv/osd/glComputeEvaluator.h>

#include <algorithm>
#include <memory>

namespace OpenSubdivHex {

namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

namespace internal {

/// \brief Calls function(start, end) for ranges of some stencils, until one gives false.
///
/// \return  whether all gave true; false, with no call, for maxStencils below 1
template <typename FUNCTION>
bool ForEachStencilRange(int numStencils, int maxStencils, FUNCTION function) {
    bool isDone = maxStencils >= 1;
    for (int start = 0, end = 0; isDone && start < numStencils; start = end) {
        end = start + (std::min)(numStencils - start, maxStencils);
        isDone = function(start, end);
    }
    return isDone;
}

} // namespace internal

/// \name Evaluation by OpenGL
/// The evaluators of Osd, of which this header is a part: a program that includes it links osdGPU.
/// A context of OpenGL must be current in all of these functions.
/// @{

/// \brief Copies a stencil table to OpenGL, for Osd's evaluators.
///
/// \code
///     auto onDevice = OsdExt::CreateGLStencilTable<Osd::GLStencilTableSSBO>(*table);
///     OsdExt::EvalStencilsInRanges(*evaluator, src, srcDesc, dst, dstDesc, *onDevice);
/// \endcode
///
/// Osd's own constructors of these tables crash if the functions of OpenGL are not loaded yet, which Osd::GLVertexBuffer and
/// the evaluators do; this function loads them.
///
/// \tparam GL_TABLE   Osd::GLStencilTableSSBO for Osd::GLComputeEvaluator, Osd::GLStencilTableTBO for
///                    Osd::GLXFBEvaluator
/// \tparam FAR_TABLE  Far::StencilTable or Far::LimitStencilTable
template <class GL_TABLE, class FAR_TABLE>
std::unique_ptr<GL_TABLE> CreateGLStencilTable(FAR_TABLE const &table) {
    Osd::GLComputeEvaluator const loadsFunctions;
    return std::unique_ptr<GL_TABLE>(GL_TABLE::Create(&table));
}

/// The most stencils that Osd::GLComputeEvaluator evaluates in a call on every driver: 65,535 groups,
/// which OpenGL promises, of 64.  With more of them than the driver takes it writes nothing, and
/// returns true.
constexpr int kMaxGLComputeStencils = 65535 * 64;

/// \brief Evaluates all stencils of \p table, in ranges that every driver takes.
///
/// \param instance     compiled for the descriptors, see Osd::GLComputeEvaluator::Create
/// \param srcBuffer,dstBuffer  such as Osd::GLVertexBuffer; they may be one
/// \param maxStencils  of a range
/// \return  false if \p instance has no program, and for maxStencils below 1
template <class SRC_BUFFER, class DST_BUFFER>
bool EvalStencilsInRanges(Osd::GLComputeEvaluator const &instance, SRC_BUFFER *srcBuffer,
                          Osd::BufferDescriptor const &srcDesc, DST_BUFFER *dstBuffer,
                          Osd::BufferDescriptor const &dstDesc,
                          Osd::GLStencilTableSSBO const &table,
                          int maxStencils = kMaxGLComputeStencils) {
    Osd::BufferDescriptor const none;
    return internal::ForEachStencilRange(
        table.GetNumStencils(), maxStencils, [&](int start, int end) {
            return instance.EvalStencils(srcBuffer->BindVBO(), srcDesc, dstBuffer->BindVBO(),
                                         dstDesc, 0, none, 0, none, table.GetSizesBuffer(),
                                         table.GetOffsetsBuffer(), table.GetIndicesBuffer(),
                                         table.GetWeightsBuffer(), 0, 0, start, end);
        });
}

/// Overload with first derivatives, for tables of a Far::LimitStencilTable.
template <class SRC_BUFFER, class DST_BUFFER>
bool EvalStencilsInRanges(Osd::GLComputeEvaluator const &instance, SRC_BUFFER *srcBuffer,
                          Osd::BufferDescriptor const &srcDesc, DST_BUFFER *dstBuffer,
                          Osd::BufferDescriptor const &dstDesc, DST_BUFFER *duBuffer,
                          Osd::BufferDescriptor const &duDesc, DST_BUFFER *dvBuffer,
                          Osd::BufferDescriptor const &dvDesc, Osd::GLStencilTableSSBO const &table,
                          int maxStencils = kMaxGLComputeStencils) {
    return internal::ForEachStencilRange(
        table.GetNumStencils(), maxStencils, [&](int start, int end) {
            return instance.EvalStencils(
                srcBuffer->BindVBO(), srcDesc, dstBuffer->BindVBO(), dstDesc, duBuffer->BindVBO(),
                duDesc, dvBuffer->BindVBO(), dvDesc, table.GetSizesBuffer(),
                table.GetOffsetsBuffer(), table.GetIndicesBuffer(), table.GetWeightsBuffer(),
                table.GetDuWeightsBuffer(), table.GetDvWeightsBuffer(), start, end);
        });
}
/// @}

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_STENCIL_EVALUATION_H
#define OPENSUBDIVHEX_OSD_EXT_STENCIL_EVALUATION_H

#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/osd/bufferDescriptor.h>

#include <memory>

namespace OpenSubdivHex {

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

/// \brief Makes a buffer (such as Osd::CpuVertexBuffer) for EvalStencilsInPlace: room for the
/// control vertices of \p table and, after them, for its stencils.
///
/// \param numElements  floats per vertex, 1 or more
template <class BUFFER>
std::unique_ptr<BUFFER> CreateInPlaceBuffer(Far::StencilTable const &table, int numElements) {
    return std::unique_ptr<BUFFER>(
        BUFFER::Create(numElements, table.GetNumControlVertices() + table.GetNumStencils()));
}

/// \brief Evaluates all stencils of \p table within one buffer: the control values are its first
/// table.GetNumControlVertices() vertices, the results are written right behind them.
///
/// \tparam EVALUATOR  Osd::CpuEvaluator, Osd::OmpEvaluator or another with their static functions
/// \return  what EVALUATOR::EvalStencils returns
template <class EVALUATOR, class BUFFER>
bool EvalStencilsInPlace(Far::StencilTable const &table, BUFFER *buffer) {
    int const width = buffer->GetNumElements();
    Osd::BufferDescriptor const src(0, width, width);
    Osd::BufferDescriptor const dst(table.GetNumControlVertices() * width, width, width);
    return EVALUATOR::EvalStencils(buffer, src, buffer, dst, &table);
}

/// \brief Evaluates all stencils of \p table from one buffer of control values into another, whose
/// first vertex is the result of the first stencil.  Both have the same number of elements.
template <class EVALUATOR, class SRC_BUFFER, class DST_BUFFER>
bool EvalStencils(Far::StencilTable const &table, SRC_BUFFER *srcBuffer, DST_BUFFER *dstBuffer) {
    int const width = srcBuffer->GetNumElements();
    Osd::BufferDescriptor const desc(0, width, width);
    return EVALUATOR::EvalStencils(srcBuffer, desc, dstBuffer, desc, &table);
}

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_STENCIL_EVALUATION_H
#define OPENSUBDIVHEX_OSD_EXT_STENCIL_EVALUATION_H

#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/osd/bufferDescriptor.h>

#include <cstdint>
#include <limits>
#include <memory>

namespace OpenSubdivHex {

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

/// \brief Makes a buffer (such as Osd::CpuVertexBuffer) for the control vertices of \p table and, behind them, its results.
///
/// \code
///     auto buffer = OsdExt::CreateInPlaceBuffer<Osd::CpuVertexBuffer>(*table, 3);
///     buffer->UpdateData(positions, 0, table->GetNumControlVertices());
///     OsdExt::EvalStencilsInPlace<OsdExt::OmpEvaluator>(*table, buffer.get());
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

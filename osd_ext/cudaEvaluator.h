// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CUDA_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_CUDA_EVALUATOR_H

#include "far_ext/export.h"

#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/osd/bufferDescriptor.h>

#include <memory>

// The name of the type in CUDA's runtime.
struct CUstream_st;

namespace OpenSubdivHex {

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

/// cudaStream_t, for headers that need no CUDA; null is the default stream.
using CudaStream = CUstream_st *;

/// \brief Floats on the current CUDA device: Osd::CudaVertexBuffer for an OpenSubdiv without CUDA.
///
/// \code
///     std::unique_ptr<OsdExt::CudaVertexBuffer> const buffer(OsdExt::CudaVertexBuffer::Create(3, numVertices));
///     buffer->UpdateData(positions, 0, numVertices);
/// \endcode
///
/// A device context is a cudaStream_t, null for the default one.  Memory that is not there throws
/// std::bad_alloc, any other error std::runtime_error with its name.
class OPENSUBDIVHEX_API CudaVertexBuffer {
public:
    /// Gives a buffer of \p numVertices elements with \p numElements floats each, whose values are not
    /// known.
    static CudaVertexBuffer *Create(int numElements, int numVertices,
                                    void *deviceContext = nullptr);
    /// Frees the floats, when the device has done what it was asked for.
    ~CudaVertexBuffer();

    CudaVertexBuffer(CudaVertexBuffer const &) = delete;
    CudaVertexBuffer &operator=(CudaVertexBuffer const &) = delete;

    /// Copies \p numVertices elements of \p src to those from \p startVertex on, and waits for it.
    void UpdateData(float const *src, int startVertex, int numVertices,
                    void *deviceContext = nullptr);
    /// Copies all elements to \p dst, and waits for it, and for what the context was asked before.
    void GetData(float *dst, void *deviceContext = nullptr) const;

    /// Floats of an element.
    int GetNumElements() const { return _numElements; }
    /// Elements.
    int GetNumVertices() const { return _numVertices; }
    /// The address on the device.
    float *BindCudaBuffer() { return _floats; }

private:
    CudaVertexBuffer(int numElements, int numVertices, float *floats)
        : _numElements(numElements), _numVertices(numVertices), _floats(floats) {}

    int _numElements;
    int _numVertices;
    float *_floats;
};

/// \brief A stencil table on the current CUDA device: Osd::CudaStencilTable for an OpenSubdiv without CUDA.
///
/// \code
///     std::unique_ptr<OsdExt::CudaStencilTable> const onDevice(OsdExt::CudaStencilTable::Create(table.get()));
///     OsdExt::CudaEvaluator::EvalStencils(src, desc, dst, desc, onDevice.get());
/// \endcode
class OPENSUBDIVHEX_API CudaStencilTable {
public:
    /// \brief Copies a table to the device, and waits for it.
    ///
    /// Memory that is not there throws std::bad_alloc, any other error std::runtime_error.
    static CudaStencilTable *Create(Far::StencilTable const *table, void *deviceContext = nullptr);
    /// Overload with the weights of first derivatives.
    static CudaStencilTable *Create(Far::LimitStencilTable const *table,
                                    void *deviceContext = nullptr);
    /// Frees them, when the device has done what it was asked for.
    ~CudaStencilTable();

    CudaStencilTable(CudaStencilTable const &) = delete;
    CudaStencilTable &operator=(CudaStencilTable const &) = delete;

    /// @name Addresses on the device
    /// @{

    /// By stencil: its number of indices.
    void *GetSizesBuffer() const;
    /// By stencil: the position of its first index.
    void *GetOffsetsBuffer() const;
    /// The indices.
    void *GetIndicesBuffer() const;
    /// A weight for each index.
    void *GetWeightsBuffer() const;
    /// A weight of the derivative by u for each index; null without derivatives.
    void *GetDuWeightsBuffer() const;
    /// A weight of the derivative by v for each index; null without derivatives.
    void *GetDvWeightsBuffer() const;
    /// @}

    /// How many stencils there are.
    int GetNumStencils() const;

private:
    struct Arrays;

    explicit CudaStencilTable(std::unique_ptr<Arrays> arrays);

    std::unique_ptr<Arrays> _arrays;
};

/// \brief Evaluates stencil tables on the current CUDA device: Osd::CudaEvaluator for an OpenSubdiv without CUDA.
///
/// Four threads sum a stencil, with elements of up to 4 floats in registers.
///
/// Element j of a buffer is the \c length floats from <tt>offset + j * stride</tt> on; stencil i is
/// written to element i.  Source and destination may be one buffer, as long as no float is both read
/// and written.  What is asked for is put on a stream; Synchronize() waits.  Results differ from
/// CpuEvaluator's by the order of sums.
///
/// All functions return false, with nothing written, if the lengths of the descriptors differ or are
/// less than 1, a stride is less than the length, an offset or \c start is negative, something is null
/// where there are stencils, or CUDA says that it cannot run them.  An error of the thread that CUDA held
/// before a call, and nobody has asked it for (cudaGetLastError()), is taken for one of the call.
class OPENSUBDIVHEX_API CudaEvaluator {
public:
    /// @name With buffers
    /// \param srcBuffer,dstBuffer,...  have a function BindCudaBuffer() that returns an address, as
    ///                                 Osd::CudaVertexBuffer and CudaVertexBuffer
    /// \param stencilTable             has the functions of CudaStencilTable
    /// \param instance                 not used
    /// \param deviceContext            a cudaStream_t, null for the default stream
    /// @{

    /// Evaluates all stencils of a table.
    template <class SRC_BUFFER, class DST_BUFFER, class STENCIL_TABLE>
    static bool
    EvalStencils(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc, DST_BUFFER *dstBuffer,
                 Osd::BufferDescriptor const &dstDesc, STENCIL_TABLE const *stencilTable,
                 CudaEvaluator const * /*instance*/ = nullptr, void *deviceContext = nullptr) {
        return srcBuffer && dstBuffer && stencilTable &&
               EvalStencils(srcBuffer->BindCudaBuffer(), srcDesc, dstBuffer->BindCudaBuffer(),
                            dstDesc, toInts(stencilTable->GetSizesBuffer()),
                            toInts(stencilTable->GetOffsetsBuffer()),
                            toInts(stencilTable->GetIndicesBuffer()),
                            toFloats(stencilTable->GetWeightsBuffer()), 0,
                            stencilTable->GetNumStencils(), deviceContext);
    }

    /// Overload with first derivatives.
    template <class SRC_BUFFER, class DST_BUFFER, class STENCIL_TABLE>
    static bool
    EvalStencils(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc, DST_BUFFER *dstBuffer,
                 Osd::BufferDescriptor const &dstDesc, DST_BUFFER *duBuffer,
                 Osd::BufferDescriptor const &duDesc, DST_BUFFER *dvBuffer,
                 Osd::BufferDescriptor const &dvDesc, STENCIL_TABLE const *stencilTable,
                 CudaEvaluator const * /*instance*/ = nullptr, void *deviceContext = nullptr) {
        return srcBuffer && dstBuffer && duBuffer && dvBuffer && stencilTable &&
               EvalStencils(srcBuffer->BindCudaBuffer(), srcDesc, dstBuffer->BindCudaBuffer(),
                            dstDesc, duBuffer->BindCudaBuffer(), duDesc, dvBuffer->BindCudaBuffer(),
                            dvDesc, toInts(stencilTable->GetSizesBuffer()),
                            toInts(stencilTable->GetOffsetsBuffer()),
                            toInts(stencilTable->GetIndicesBuffer()),
                            toFloats(stencilTable->GetWeightsBuffer()),
                            toFloats(stencilTable->GetDuWeightsBuffer()),
                            toFloats(stencilTable->GetDvWeightsBuffer()), 0,
                            stencilTable->GetNumStencils(), deviceContext);
    }
    /// @}

    /// @name With addresses on the device
    /// \param src,dst,...    without the offset of their descriptors, which is added
    /// \param sizes          of the indices of each stencil
    /// \param offsets        of the first index of each stencil
    /// \param indices        of source elements
    /// \param weights,...    in the order of the indices
    /// \param start,end      the stencils that are evaluated
    /// \param deviceContext  a cudaStream_t, null for the default stream
    /// @{

    /// Evaluates stencils [start, end).
    static bool EvalStencils(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                             Osd::BufferDescriptor const &dstDesc, int const *sizes,
                             int const *offsets, int const *indices, float const *weights,
                             int start, int end, void *deviceContext = nullptr);

    /// Overload with first derivatives.
    static bool EvalStencils(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                             Osd::BufferDescriptor const &dstDesc, float *du,
                             Osd::BufferDescriptor const &duDesc, float *dv,
                             Osd::BufferDescriptor const &dvDesc, int const *sizes,
                             int const *offsets, int const *indices, float const *weights,
                             float const *duWeights, float const *dvWeights, int start, int end,
                             void *deviceContext = nullptr);
    /// @}

    /// Waits for what a cudaStream_t was asked for, null for the default stream.
    static void Synchronize(void *deviceContext = nullptr);

private:
    static int const *toInts(void const *address) { return static_cast<int const *>(address); }
    static float const *toFloats(void const *address) {
        return static_cast<float const *>(address);
    }
};

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

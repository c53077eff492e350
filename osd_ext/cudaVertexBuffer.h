// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CUDA_VERTEX_BUFFER_H
#define OPENSUBDIVHEX_OSD_EXT_CUDA_VERTEX_BUFFER_H

#include "far_ext/export.h"

namespace OpenSubdivHex::OsdExt {

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

} // namespace OpenSubdivHex::OsdExt

#endif

// SPDX-License-Identifier: Apache-2.0
#include "osd_ext/cudaEvaluator.h"

#include "cudaErrors.h"

#include <algorithm>
#include <cstddef>
#include <memory>

namespace OpenSubdivHex::OsdExt {

using internal::ThrowCudaError;

namespace {

cudaStream_t getStream(void *deviceContext) { return static_cast<cudaStream_t>(deviceContext); }

} // namespace

CudaVertexBuffer *CudaVertexBuffer::Create(int numElements, int numVertices,
                                           void * /*deviceContext*/) {
    std::unique_ptr<CudaVertexBuffer> result(
        new CudaVertexBuffer(numElements, numVertices, nullptr));
    std::size_t const numFloats = std::size_t(numElements) * std::size_t(numVertices);
    void *floats = nullptr;
    ThrowCudaError(cudaMalloc(&floats, std::max<std::size_t>(1, numFloats) * sizeof(float)));
    result->_floats = static_cast<float *>(floats);
    return result.release();
}

CudaVertexBuffer::~CudaVertexBuffer() { cudaFree(_floats); }

void CudaVertexBuffer::UpdateData(float const *src, int startVertex, int numVertices,
                                  void *deviceContext) {
    auto const numElements = std::size_t(_numElements);
    ThrowCudaError(cudaMemcpyAsync(_floats + numElements * std::size_t(startVertex), src,
                                   numElements * std::size_t(numVertices) * sizeof(float),
                                   cudaMemcpyHostToDevice, getStream(deviceContext)));
    ThrowCudaError(cudaStreamSynchronize(getStream(deviceContext)));
}

void CudaVertexBuffer::GetData(float *dst, void *deviceContext) const {
    std::size_t const numFloats = std::size_t(_numElements) * std::size_t(_numVertices);
    ThrowCudaError(cudaMemcpyAsync(dst, _floats, numFloats * sizeof(float), cudaMemcpyDeviceToHost,
                                   getStream(deviceContext)));
    ThrowCudaError(cudaStreamSynchronize(getStream(deviceContext)));
}

} // namespace OpenSubdivHex::OsdExt

// SPDX-License-Identifier: Apache-2.0
#include "osd_ext/cudaEvaluator.h"

#include "cudaErrors.h"
#include "stencilSum.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace OpenSubdivHex::OsdExt {

using internal::kStencilLanes;
using internal::StencilArguments;
using internal::StencilSum;
using internal::ThrowCudaError;
using Osd::BufferDescriptor;

namespace {

constexpr unsigned kGroup = 128; // threads of a block
constexpr int kMaxLength = 4;    // floats in registers

cudaStream_t getStream(void *deviceContext) { return static_cast<cudaStream_t>(deviceContext); }

// Some threads for each stencil, which are neighbours in a warp.
template <int LENGTH>
__global__ void __launch_bounds__(kGroup) evalStencils(StencilArguments arguments) {
    std::int64_t const thread = std::int64_t(blockIdx.x) * kGroup + threadIdx.x;
    auto const lane = int(thread % kStencilLanes);
    std::int64_t const stencil = arguments.start + thread / kStencilLanes;
    // All threads of a warp take part in exchanges.
    StencilSum<LENGTH> sum = {};
    if (stencil < arguments.end) {
        sum = internal::SumLane<LENGTH, kStencilLanes>(arguments, int(stencil), lane);
    }
    for (int apart = kStencilLanes / 2; apart > 0; apart /= 2) {
        StencilSum<LENGTH> other;
        for (int k = 0; k < LENGTH; ++k) {
            other.x[k] = __shfl_xor_sync(0xffffffffu, sum.x[k], apart);
        }
        sum.Add(other);
    }
    if (stencil < arguments.end && lane == 0) {
        internal::StoreSum(arguments, int(stencil), sum);
    }
}

bool areValid(BufferDescriptor const &srcDesc, BufferDescriptor const &dstDesc, float const *src,
              float const *dst, StencilArguments const &arguments) {
    bool const isEmpty = arguments.end <= arguments.start;
    return srcDesc.length >= 1 && srcDesc.length == dstDesc.length &&
           srcDesc.stride >= srcDesc.length && dstDesc.stride >= dstDesc.length &&
           srcDesc.offset >= 0 && dstDesc.offset >= 0 &&
           (isEmpty || (arguments.start >= 0 && src && dst && arguments.sizes &&
                        arguments.offsets && arguments.indices && arguments.weights));
}

// Elements of any length, up to kMaxLength floats at a time.
void evalLanes(StencilArguments arguments, cudaStream_t stream) {
    std::int64_t const numThreads = std::int64_t(arguments.end - arguments.start) * kStencilLanes;
    auto const numGroups = unsigned((numThreads + kGroup - 1) / kGroup);
    for (int left = arguments.length; left > 0; left -= kMaxLength) {
        switch (left) {
        case 1:
            evalStencils<1><<<numGroups, kGroup, 0, stream>>>(arguments);
            break;
        case 2:
            evalStencils<2><<<numGroups, kGroup, 0, stream>>>(arguments);
            break;
        case 3:
            evalStencils<3><<<numGroups, kGroup, 0, stream>>>(arguments);
            break;
        default:
            evalStencils<kMaxLength><<<numGroups, kGroup, 0, stream>>>(arguments);
        }
        arguments.src += kMaxLength;
        arguments.dst += kMaxLength;
    }
}

/// A destination and the weights that it is made with.
struct Output {
    float *dst;
    BufferDescriptor const &desc;
    float const *weights;
};

StencilArguments makeArguments(int const *sizes, int const *offsets, int const *indices, int start,
                               int end) {
    StencilArguments arguments = {};
    arguments.sizes = sizes;
    arguments.offsets = offsets;
    arguments.indices = indices;
    arguments.start = start;
    arguments.end = end;
    return arguments;
}

bool eval(float const *src, BufferDescriptor const &srcDesc, std::vector<Output> const &outputs,
          StencilArguments arguments, void *deviceContext) {
    std::vector<StencilArguments> ofOutputs;
    for (Output const &output : outputs) {
        arguments.weights = output.weights;
        if (!areValid(srcDesc, output.desc, src, output.dst, arguments)) {
            return false;
        }
        arguments.src = src + srcDesc.offset;
        arguments.srcStride = srcDesc.stride;
        arguments.dst = output.dst + output.desc.offset;
        arguments.dstStride = output.desc.stride;
        arguments.length = srcDesc.length;
        ofOutputs.push_back(arguments);
    }
    if (arguments.end > arguments.start) {
        for (StencilArguments const &ofOutput : ofOutputs) {
            evalLanes(ofOutput, getStream(deviceContext));
        }
    }
    return cudaGetLastError() == cudaSuccess;
}

template <typename T>
T *copyToDevice(T const *values, std::size_t size, cudaStream_t stream) {
    void *address = nullptr;
    if (size > 0) {
        ThrowCudaError(cudaMalloc(&address, size * sizeof(T)));
        cudaError_t const error =
            cudaMemcpyAsync(address, values, size * sizeof(T), cudaMemcpyHostToDevice, stream);
        if (error != cudaSuccess) {
            cudaFree(address);
            ThrowCudaError(error);
        }
    }
    return static_cast<T *>(address);
}

} // namespace

struct CudaStencilTable::Arrays {
    Arrays() = default;
    Arrays(Arrays const &) = delete;
    Arrays &operator=(Arrays const &) = delete;
    ~Arrays() {
        for (void *const address :
             {static_cast<void *>(sizes), static_cast<void *>(offsets),
              static_cast<void *>(indices), static_cast<void *>(weights),
              static_cast<void *>(duWeights), static_cast<void *>(dvWeights)}) {
            cudaFree(address);
        }
    }

    template <class TABLE>
    void Copy(TABLE const &table, cudaStream_t stream) {
        numStencils = table.GetNumStencils();
        auto const copy = [&](auto const &values) {
            return copyToDevice(values.data(), values.size(), stream);
        };
        sizes = copy(table.GetSizes());
        offsets = copy(table.GetOffsets());
        indices = copy(table.GetControlIndices());
        weights = copy(table.GetWeights());
    }

    int numStencils = 0;
    int *sizes = nullptr;
    int *offsets = nullptr;
    int *indices = nullptr;
    float *weights = nullptr;
    float *duWeights = nullptr;
    float *dvWeights = nullptr;
};

CudaStencilTable *CudaStencilTable::Create(Far::StencilTable const *table, void *deviceContext) {
    auto arrays = std::make_unique<Arrays>();
    arrays->Copy(*table, getStream(deviceContext));
    ThrowCudaError(cudaStreamSynchronize(getStream(deviceContext)));
    return new CudaStencilTable(std::move(arrays));
}

CudaStencilTable *CudaStencilTable::Create(Far::LimitStencilTable const *table,
                                           void *deviceContext) {
    cudaStream_t const stream = getStream(deviceContext);
    auto arrays = std::make_unique<Arrays>();
    arrays->Copy(*table, stream);
    arrays->duWeights =
        copyToDevice(table->GetDuWeights().data(), table->GetDuWeights().size(), stream);
    arrays->dvWeights =
        copyToDevice(table->GetDvWeights().data(), table->GetDvWeights().size(), stream);
    ThrowCudaError(cudaStreamSynchronize(stream));
    return new CudaStencilTable(std::move(arrays));
}

CudaStencilTable::CudaStencilTable(std::unique_ptr<Arrays> arrays) : _arrays(std::move(arrays)) {}
CudaStencilTable::~CudaStencilTable() = default;

void *CudaStencilTable::GetSizesBuffer() const { return _arrays->sizes; }
void *CudaStencilTable::GetOffsetsBuffer() const { return _arrays->offsets; }
void *CudaStencilTable::GetIndicesBuffer() const { return _arrays->indices; }
void *CudaStencilTable::GetWeightsBuffer() const { return _arrays->weights; }
void *CudaStencilTable::GetDuWeightsBuffer() const { return _arrays->duWeights; }
void *CudaStencilTable::GetDvWeightsBuffer() const { return _arrays->dvWeights; }
int CudaStencilTable::GetNumStencils() const { return _arrays->numStencils; }

bool CudaEvaluator::EvalStencils(float const *src, BufferDescriptor const &srcDesc, float *dst,
                                 BufferDescriptor const &dstDesc, int const *sizes,
                                 int const *offsets, int const *indices, float const *weights,
                                 int start, int end, void *deviceContext) {
    StencilArguments const arguments = makeArguments(sizes, offsets, indices, start, end);
    return eval(src, srcDesc, {{dst, dstDesc, weights}}, arguments, deviceContext);
}

bool CudaEvaluator::EvalStencils(float const *src, BufferDescriptor const &srcDesc, float *dst,
                                 BufferDescriptor const &dstDesc, float *du,
                                 BufferDescriptor const &duDesc, float *dv,
                                 BufferDescriptor const &dvDesc, int const *sizes,
                                 int const *offsets, int const *indices, float const *weights,
                                 float const *duWeights, float const *dvWeights, int start, int end,
                                 void *deviceContext) {
    StencilArguments const arguments = makeArguments(sizes, offsets, indices, start, end);
    return eval(src, srcDesc,
                {{dst, dstDesc, weights}, {du, duDesc, duWeights}, {dv, dvDesc, dvWeights}},
                arguments, deviceContext);
}

void CudaEvaluator::Synchronize(void *deviceContext) {
    cudaStreamSynchronize(getStream(deviceContext));
}

} // namespace OpenSubdivHex::OsdExt

// SPDX-License-Identifier: Apache-2.0
#include "cudaRefinementEvaluator.h"

#include "cuda/cudaDevice.h"
#include "device/deviceEvaluator.h"

#include <utility>

namespace OpenSubdivHex::OsdExt {

using FarExt::CallStatus;
using FarExt::internal::Report;
using internal::CudaDevice;
using internal::DeviceBufferName;
using internal::DeviceEvaluator;
using Osd::BufferDescriptor;

namespace {

DeviceEvaluator::Values getValues(float const *buffer, BufferDescriptor const &desc) {
    return {DeviceBufferName(reinterpret_cast<std::uintptr_t>(buffer)), desc};
}

} // namespace

std::unique_ptr<CudaRefinementEvaluator>
CudaRefinementEvaluator::Create(FarExt::TopologyRefiner const &refiner, Options options,
                                CallStatus *status) {
    auto device = std::make_unique<CudaDevice>();
    CudaDevice &ofEvaluator = *device;
    auto evaluator = std::make_unique<DeviceEvaluator>(std::move(device), refiner);
    if (!Report(evaluator->Prepare(options), status)) {
        return nullptr;
    }
    return std::unique_ptr<CudaRefinementEvaluator>(
        new CudaRefinementEvaluator(std::move(evaluator), ofEvaluator));
}

CudaRefinementEvaluator::CudaRefinementEvaluator(std::unique_ptr<DeviceEvaluator> evaluator,
                                                 CudaDevice &device)
    : _evaluator(std::move(evaluator)), _device(device) {}

CudaRefinementEvaluator::~CudaRefinementEvaluator() = default;

void CudaRefinementEvaluator::SetStream(CudaStream stream) { _device.SetStream(stream); }

int CudaRefinementEvaluator::GetMaxLevel() const { return _evaluator->GetMaxLevel(); }

int CudaRefinementEvaluator::GetNumElements(int level) const {
    return _evaluator->GetNumElements(level);
}

std::int64_t CudaRefinementEvaluator::GetNumElementsAllLevels() const {
    return _evaluator->GetNumElementsAllLevels();
}

std::int64_t CudaRefinementEvaluator::GetNumDeviceBytes() const {
    return _evaluator->GetNumDeviceBytes();
}

bool CudaRefinementEvaluator::Evaluate(float const *src, BufferDescriptor const &srcDesc,
                                       float *dst, BufferDescriptor const &dstDesc, int level,
                                       CallStatus *status) {
    return Report(_evaluator->Evaluate(getValues(src, srcDesc), getValues(dst, dstDesc), level),
                  status);
}

bool CudaRefinementEvaluator::EvaluateAllLevels(float const *src, BufferDescriptor const &srcDesc,
                                                float *dst, BufferDescriptor const &dstDesc,
                                                CallStatus *status) {
    return Report(_evaluator->EvaluateAllLevels(getValues(src, srcDesc), getValues(dst, dstDesc)),
                  status);
}

bool CudaRefinementEvaluator::EvaluateLimit(float const *src, BufferDescriptor const &srcDesc,
                                            float *dst, BufferDescriptor const &dstDesc, int level,
                                            CallStatus *status) {
    return Report(
        _evaluator->EvaluateLimit(getValues(src, srcDesc), {getValues(dst, dstDesc)}, level),
        status);
}

bool CudaRefinementEvaluator::EvaluateLimit(float const *src, BufferDescriptor const &srcDesc,
                                            float *dst, BufferDescriptor const &dstDesc, float *du,
                                            BufferDescriptor const &duDesc, float *dv,
                                            BufferDescriptor const &dvDesc, int level,
                                            CallStatus *status) {
    return Report(_evaluator->EvaluateLimit(
                      getValues(src, srcDesc),
                      {getValues(dst, dstDesc), getValues(du, duDesc), getValues(dv, dvDesc)},
                      level),
                  status);
}

std::int64_t CudaRefinementEvaluator::GetNumTriangles(int level) const {
    return _evaluator->GetNumTriangles(level);
}

bool CudaRefinementEvaluator::MakeTriangleIndices(unsigned *dst, int level, int vertexOffset,
                                                  CallStatus *status) {
    return Report(_evaluator->MakeTriangleIndices(
                      DeviceBufferName(reinterpret_cast<std::uintptr_t>(dst)), level, vertexOffset),
                  status);
}

} // namespace OpenSubdivHex::OsdExt

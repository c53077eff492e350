// SPDX-License-Identifier: Apache-2.0
#include "cudaRefinementEvaluator.h"

#include "cuda/cudaDevice.h"

#include <utility>

namespace OpenSubdivHex::OsdExt {

CudaRefinementEvaluator::CudaRefinementEvaluator(std::unique_ptr<internal::Device> device,
                                                 FarExt::TopologyRefiner const &refiner)
    : DeviceRefinementEvaluator(std::move(device), refiner) {}

std::unique_ptr<CudaRefinementEvaluator>
CudaRefinementEvaluator::Create(FarExt::TopologyRefiner const &refiner, Options options,
                                FarExt::CallStatus *status) {
    std::unique_ptr<CudaRefinementEvaluator> result(
        new CudaRefinementEvaluator(std::make_unique<internal::CudaDevice>(), refiner));
    return result->prepare(options, status) ? std::move(result) : nullptr;
}

void CudaRefinementEvaluator::SetStream(CudaStream stream) {
    static_cast<internal::CudaDevice &>(getDevice()).SetStream(stream);
}

bool CudaRefinementEvaluator::MakeTriangleIndices(unsigned *dst, int level, int vertexOffset,
                                                  FarExt::CallStatus *status) {
    return makeTriangleIndices(internal::GetBufferName(dst), level, vertexOffset, status);
}

} // namespace OpenSubdivHex::OsdExt

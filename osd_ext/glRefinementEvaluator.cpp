// SPDX-License-Identifier: Apache-2.0
#include "glRefinementEvaluator.h"

#include "gl/glDevice.h"

#include <utility>

namespace OpenSubdivHex::OsdExt {

GLRefinementEvaluator::GLRefinementEvaluator(std::unique_ptr<internal::Device> device,
                                             FarExt::TopologyRefiner const &refiner)
    : DeviceRefinementEvaluator(std::move(device), refiner) {}

std::unique_ptr<GLRefinementEvaluator>
GLRefinementEvaluator::Create(FarExt::TopologyRefiner const &refiner, Options options,
                              FarExt::CallStatus *status) {
    std::unique_ptr<GLRefinementEvaluator> result(
        new GLRefinementEvaluator(std::make_unique<internal::GlDevice>(), refiner));
    return result->prepare(options, status) ? std::move(result) : nullptr;
}

bool GLRefinementEvaluator::MakeTriangleIndices(unsigned dst, int level, int vertexOffset,
                                                FarExt::CallStatus *status) {
    return makeTriangleIndices(internal::GetBufferName(dst), level, vertexOffset, status);
}

} // namespace OpenSubdivHex::OsdExt

// SPDX-License-Identifier: Apache-2.0
#include "far_ext/vtr/report.h"
#include "osd_ext/refinementEvaluator.h"

#include "deviceEvaluator.h"

#include <utility>

namespace OpenSubdivHex::OsdExt {

using FarExt::CallStatus;
using FarExt::internal::Report;
using internal::DeviceValues;

DeviceRefinementEvaluator::DeviceRefinementEvaluator(std::unique_ptr<internal::Device> device,
                                                     FarExt::TopologyRefiner const &refiner)
    : _evaluator(std::make_unique<internal::DeviceEvaluator>(std::move(device), refiner)) {}

DeviceRefinementEvaluator::~DeviceRefinementEvaluator() = default;

int DeviceRefinementEvaluator::GetMaxLevel() const { return _evaluator->GetMaxLevel(); }

int DeviceRefinementEvaluator::GetNumElements(int level) const {
    return _evaluator->GetNumElements(level);
}

std::int64_t DeviceRefinementEvaluator::GetNumElementsAllLevels() const {
    return _evaluator->GetNumElementsAllLevels();
}

std::int64_t DeviceRefinementEvaluator::GetNumDeviceBytes() const {
    return _evaluator->GetNumDeviceBytes();
}

std::int64_t DeviceRefinementEvaluator::GetNumTriangles(int level) const {
    return _evaluator->GetNumTriangles(level);
}

internal::Device &DeviceRefinementEvaluator::getDevice() const { return _evaluator->GetDevice(); }

bool DeviceRefinementEvaluator::prepare(Options options, CallStatus *status) {
    return Report(_evaluator->Prepare(options), status);
}

bool DeviceRefinementEvaluator::evaluate(DeviceValues const &src, DeviceValues const &dst,
                                         int level, CallStatus *status) {
    return Report(_evaluator->Evaluate(src, dst, level), status);
}

bool DeviceRefinementEvaluator::evaluateAllLevels(DeviceValues const &src, DeviceValues const &dst,
                                                  CallStatus *status) {
    return Report(_evaluator->EvaluateAllLevels(src, dst), status);
}

bool DeviceRefinementEvaluator::evaluateLimit(DeviceValues const &src,
                                              std::vector<DeviceValues> const &outputs, int level,
                                              CallStatus *status) {
    return Report(_evaluator->EvaluateLimit(src, outputs, level), status);
}

bool DeviceRefinementEvaluator::makeTriangleIndices(internal::DeviceBufferName dst, int level,
                                                    int vertexOffset, CallStatus *status) {
    return Report(_evaluator->MakeTriangleIndices(dst, level, vertexOffset), status);
}

} // namespace OpenSubdivHex::OsdExt

// SPDX-License-Identifier: Apache-2.0
#include "glRefinementEvaluator.h"

#include "device/deviceEvaluator.h"
#include "gl/glDevice.h"

#include <utility>

namespace OpenSubdivHex::OsdExt {

using FarExt::CallStatus;
using FarExt::internal::Report;
using internal::DeviceEvaluator;
using Osd::BufferDescriptor;

std::unique_ptr<GLRefinementEvaluator>
GLRefinementEvaluator::Create(FarExt::TopologyRefiner const &refiner, Options options,
                              CallStatus *status) {
    auto evaluator =
        std::make_unique<DeviceEvaluator>(std::make_unique<internal::GlDevice>(), refiner);
    if (!Report(evaluator->Prepare(options), status)) {
        return nullptr;
    }
    return std::unique_ptr<GLRefinementEvaluator>(new GLRefinementEvaluator(std::move(evaluator)));
}

GLRefinementEvaluator::GLRefinementEvaluator(std::unique_ptr<DeviceEvaluator> evaluator)
    : _evaluator(std::move(evaluator)) {}

GLRefinementEvaluator::~GLRefinementEvaluator() = default;

int GLRefinementEvaluator::GetMaxLevel() const { return _evaluator->GetMaxLevel(); }

int GLRefinementEvaluator::GetNumElements(int level) const {
    return _evaluator->GetNumElements(level);
}

std::int64_t GLRefinementEvaluator::GetNumElementsAllLevels() const {
    return _evaluator->GetNumElementsAllLevels();
}

std::int64_t GLRefinementEvaluator::GetNumDeviceBytes() const {
    return _evaluator->GetNumDeviceBytes();
}

bool GLRefinementEvaluator::Evaluate(unsigned src, BufferDescriptor const &srcDesc, unsigned dst,
                                     BufferDescriptor const &dstDesc, int level,
                                     CallStatus *status) {
    return Report(_evaluator->Evaluate({src, srcDesc}, {dst, dstDesc}, level), status);
}

bool GLRefinementEvaluator::EvaluateAllLevels(unsigned src, BufferDescriptor const &srcDesc,
                                              unsigned dst, BufferDescriptor const &dstDesc,
                                              CallStatus *status) {
    return Report(_evaluator->EvaluateAllLevels({src, srcDesc}, {dst, dstDesc}), status);
}

bool GLRefinementEvaluator::EvaluateLimit(unsigned src, BufferDescriptor const &srcDesc,
                                          unsigned dst, BufferDescriptor const &dstDesc, int level,
                                          CallStatus *status) {
    return Report(_evaluator->EvaluateLimit({src, srcDesc}, {{dst, dstDesc}}, level), status);
}

bool GLRefinementEvaluator::EvaluateLimit(unsigned src, BufferDescriptor const &srcDesc,
                                          unsigned dst, BufferDescriptor const &dstDesc,
                                          unsigned du, BufferDescriptor const &duDesc, unsigned dv,
                                          BufferDescriptor const &dvDesc, int level,
                                          CallStatus *status) {
    return Report(_evaluator->EvaluateLimit({src, srcDesc},
                                            {{dst, dstDesc}, {du, duDesc}, {dv, dvDesc}}, level),
                  status);
}

std::int64_t GLRefinementEvaluator::GetNumTriangles(int level) const {
    return _evaluator->GetNumTriangles(level);
}

bool GLRefinementEvaluator::MakeTriangleIndices(unsigned dst, int level, int vertexOffset,
                                                CallStatus *status) {
    return Report(_evaluator->MakeTriangleIndices(dst, level, vertexOffset), status);
}

} // namespace OpenSubdivHex::OsdExt

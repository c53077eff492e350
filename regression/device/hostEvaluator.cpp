// SPDX-License-Identifier: Apache-2.0
#include "hostEvaluator.h"

#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

using namespace OsdExt::internal;
using FarExt::CallStatus;
using FarExt::internal::Report;
using Osd::BufferDescriptor;

namespace {

DeviceBufferName getName(void const *buffer) {
    return DeviceBufferName(reinterpret_cast<std::uintptr_t>(buffer));
}
char *getBytes(DeviceBufferName buffer) { return reinterpret_cast<char *>(std::uintptr_t(buffer)); }

constexpr std::int64_t kAnyBytes = std::numeric_limits<std::int64_t>::max();

class HostDevice : public Device {
public:
    explicit HostDevice(std::int64_t maxBytes) : _maxBytes(maxBytes) {}

    CallStatus CheckContext() const override { return CallStatus(); }
    std::int64_t GetMaxBytes() const override { return _maxBytes; }
    DeviceBufferName Allocate(std::int64_t numBytes) override {
        return getName(new char[std::size_t(numBytes)]);
    }
    void Free(DeviceBufferName buffer) override { delete[] getBytes(buffer); }
    void Write(DeviceBufferName buffer, std::int64_t firstByte, void const *data,
               std::int64_t numBytes) override {
        std::memcpy(getBytes(buffer) + firstByte, data, std::size_t(numBytes));
    }
    CallStatus CheckBuffer(DeviceBufferName buffer, std::int64_t /*numFloats*/,
                           std::string const &what) const override {
        return buffer != 0 ? CallStatus()
                           : FarExt::internal::Failure(FarExt::StatusCode::InvalidArgument,
                                                       "the " + what + " is null");
    }
    CallStatus Prepare(DeviceKernel, int, int) override { return CallStatus(); }
    void Run(DeviceTask const &task) override { _tasks.push_back(task); }
    void Wait() override {
        for (; !_tasks.empty(); _tasks.pop_back()) {
            runBackwards(_tasks.back());
        }
    }
    CallStatus EndFrame() override {
        Wait();
        return CallStatus();
    }

private:
    static void runBackwards(DeviceTask const &task) {
        RunInParts(task.kernel, task.length, task.faceSize, task.GetArguments(),
                   [&](auto compiled, DeviceArguments const &arguments) {
                       using Compiled = decltype(compiled);
                       typename Compiled::Kernels kernels;
                       static_cast<DeviceArguments &>(kernels) = arguments;
                       kernels.count = task.count;
                       for (std::uint32_t i = task.count; i > 0; --i) {
                           RunKernel<Compiled::kKernel>(kernels, i - 1);
                       }
                   });
    }

    std::int64_t _maxBytes;
    std::vector<DeviceTask> _tasks; // that nothing waited for
};

} // namespace

HostEvaluator::HostEvaluator(std::int64_t maxBytes, FarExt::TopologyRefiner const &refiner)
    : _evaluator(std::make_unique<HostDevice>(maxBytes), refiner) {}

std::unique_ptr<HostEvaluator> HostEvaluator::Create(FarExt::TopologyRefiner const &refiner,
                                                     Options options, CallStatus *status) {
    std::unique_ptr<HostEvaluator> result(new HostEvaluator(kAnyBytes, refiner));
    return Report(result->_evaluator.Prepare(options), status) ? std::move(result) : nullptr;
}

std::unique_ptr<HostEvaluator> HostEvaluator::CreateWithin(std::int64_t maxBytes,
                                                           FarExt::TopologyRefiner const &refiner,
                                                           CallStatus *status) {
    std::unique_ptr<HostEvaluator> result(new HostEvaluator(maxBytes, refiner));
    return Report(result->_evaluator.Prepare({}), status) ? std::move(result) : nullptr;
}

bool HostEvaluator::Evaluate(float const *src, BufferDescriptor const &srcDesc, float *dst,
                             BufferDescriptor const &dstDesc, int level, CallStatus *status) {
    return Report(_evaluator.Evaluate({getName(src), srcDesc}, {getName(dst), dstDesc}, level),
                  status);
}

bool HostEvaluator::EvaluateAllLevels(float const *src, BufferDescriptor const &srcDesc, float *dst,
                                      BufferDescriptor const &dstDesc, CallStatus *status) {
    return Report(_evaluator.EvaluateAllLevels({getName(src), srcDesc}, {getName(dst), dstDesc}),
                  status);
}

bool HostEvaluator::EvaluateLimit(float const *src, BufferDescriptor const &srcDesc, float *dst,
                                  BufferDescriptor const &dstDesc, int level, CallStatus *status) {
    return Report(
        _evaluator.EvaluateLimit({getName(src), srcDesc}, {{getName(dst), dstDesc}}, level),
        status);
}

bool HostEvaluator::EvaluateLimit(float const *src, BufferDescriptor const &srcDesc, float *dst,
                                  BufferDescriptor const &dstDesc, float *du,
                                  BufferDescriptor const &duDesc, float *dv,
                                  BufferDescriptor const &dvDesc, int level, CallStatus *status) {
    return Report(_evaluator.EvaluateLimit(
                      {getName(src), srcDesc},
                      {{getName(dst), dstDesc}, {getName(du), duDesc}, {getName(dv), dvDesc}},
                      level),
                  status);
}

bool HostEvaluator::MakeTriangleIndices(unsigned *dst, int level, int vertexOffset,
                                        CallStatus *status) {
    return Report(_evaluator.MakeTriangleIndices(getName(dst), level, vertexOffset), status);
}

} // namespace OpenSubdivHex::Regression

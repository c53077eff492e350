// SPDX-License-Identifier: Apache-2.0
#include "hostEvaluator.h"

#include "far_ext/vtr/report.h"

#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

using namespace OsdExt::internal;
using FarExt::CallStatus;

namespace {

char *getBytes(DeviceBufferName buffer) { return reinterpret_cast<char *>(std::uintptr_t(buffer)); }

constexpr std::int64_t kAnyBytes = std::numeric_limits<std::int64_t>::max();

class HostDevice : public Device {
public:
    explicit HostDevice(std::int64_t maxBytes) : _maxBytes(maxBytes) {}

    CallStatus CheckContext() const override { return CallStatus(); }
    std::int64_t GetMaxBytes() const override { return _maxBytes; }
    DeviceBufferName Allocate(std::int64_t numBytes) override {
        return GetBufferName(new char[std::size_t(numBytes)]);
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
    : DeviceRefinementEvaluator(std::make_unique<HostDevice>(maxBytes), refiner) {}

std::unique_ptr<HostEvaluator> HostEvaluator::Create(FarExt::TopologyRefiner const &refiner,
                                                     Options options, CallStatus *status) {
    std::unique_ptr<HostEvaluator> result(new HostEvaluator(kAnyBytes, refiner));
    return result->prepare(options, status) ? std::move(result) : nullptr;
}

std::unique_ptr<HostEvaluator> HostEvaluator::CreateWithin(std::int64_t maxBytes,
                                                           FarExt::TopologyRefiner const &refiner,
                                                           CallStatus *status) {
    std::unique_ptr<HostEvaluator> result(new HostEvaluator(maxBytes, refiner));
    return result->prepare({}, status) ? std::move(result) : nullptr;
}

bool HostEvaluator::MakeTriangleIndices(unsigned *dst, int level, int vertexOffset,
                                        CallStatus *status) {
    return makeTriangleIndices(GetBufferName(dst), level, vertexOffset, status);
}

} // namespace OpenSubdivHex::Regression

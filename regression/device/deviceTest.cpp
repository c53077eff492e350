// SPDX-License-Identifier: Apache-2.0
//
// The kernels of devices as C++ compiles them.
#include "deviceEvaluatorTest.h"
#include "hostEvaluator.h"

namespace OpenSubdivHex::Regression {

namespace {

/// Floats as a buffer of a processor.
class HostBuffer {
public:
    explicit HostBuffer(std::vector<float> values) : _values(std::move(values)) {}
    float *BindCpuBuffer() { return _values.data(); }
    std::vector<float> const &Get() const { return _values; }

private:
    std::vector<float> _values;
};

struct Host {
    static constexpr char const *kName = "Kernels";
    using Evaluator = HostEvaluator;
    using Buffer = HostBuffer;

    static std::string GetMissing() { return {}; }
    static bool IsNeeded() { return true; }
    static std::unique_ptr<Buffer> MakeBuffer(std::vector<float> const &values, int) {
        return std::make_unique<Buffer>(values);
    }
    static std::vector<float> Read(Buffer &buffer, std::size_t) { return buffer.Get(); }
};

} // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Host, DeviceEvaluator, Host, KindName);

} // namespace OpenSubdivHex::Regression

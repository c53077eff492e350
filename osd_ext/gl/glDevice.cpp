// SPDX-License-Identifier: Apache-2.0
#include "glDevice.h"

#include "far_ext/vtr/report.h"
#include "osd_ext/gl/kernelText.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace OpenSubdivHex::OsdExt::internal {

using FarExt::CallStatus;
using FarExt::StatusCode;

namespace {

constexpr int kMinVersion = 43;
constexpr std::uint32_t kGroup = 64; // invocations
// Groups of a dispatch in one dimension, which every driver takes.
constexpr std::uint32_t kMaxGroups = 65535;
// Places in a buffer are numbers of 32 bits in shaders.
constexpr std::int64_t kMaxPlaces = std::int64_t(1) << 32;
// Bytes of a buffer that shaders reach on all drivers known, whatever these promise; some crash beyond.
constexpr std::int64_t kMaxBytes = std::int64_t(1) << 31;

// In the order of DeviceKernel.
constexpr char const *kNames[] = {
    "copyElement",       "makeFVerticesOfRun", "makeFVerticesOfFace", "makeFVerticesByWeights",
    "makeListedFVertex", "makeVVertexOfRun",   "makeListedVVertex",   "makeRegularLimit",
    "makeOwnLimit",      "makeLatticeLimit",   "makeListedLimit",     "makeTriangles"};

// Text before the kernels, behind LENGTH and SIZE: see kernels.inl.
constexpr char const *kHead = R"(
layout(local_size_x = 64) in;
#define PLACE uint
#define READ_ARRAY(number, block, type, name) \
    layout(std430, binding = number) readonly buffer block { type name[]; };
#define ARRAY(number, block, type, name) \
    layout(std430, binding = number) buffer block { type name[]; };
#define PARAMETER(type, name) uniform type name;
#define PARAMETER_ARRAY(type, name, size) uniform type name[size];
#define FUNCTION
#define REFERENCE(type) inout type
#define PRECISE precise
)";
constexpr char const *kMain = R"(
void main() {
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u +
             gl_LocalInvocationID.x;
    if (i < count) {
        KERNEL(i);
    }
}
)";

void set(GLint place, float value) { glUniform1f(place, value); }
void set(GLint place, float const *values, GLsizei count) { glUniform1fv(place, count, values); }
void set(GLint place, std::uint32_t value) { glUniform1ui(place, value); }
// Places that are used fit, since CheckBuffer() has seen the last one.
void set(GLint place, std::uint64_t value) { glUniform1ui(place, GLuint(value)); }

} // namespace

CallStatus GlDevice::CheckContext() const {
    if (epoxy_gl_version() < kMinVersion || !epoxy_is_desktop_gl()) {
        return FarExt::internal::Failure(StatusCode::Unsupported,
                                         "there is no current context of OpenGL 4.3");
    }
    return CallStatus();
}

std::int64_t GlDevice::GetMaxBytes() const {
    GLint64 maxBytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &maxBytes);
    return std::min(std::max<GLint64>(maxBytes, kMaxBytes), kMaxPlaces * GLint64(sizeof(float)));
}

DeviceBufferName GlDevice::Allocate(std::int64_t numBytes) {
    GlBuffer buffer;
    buffer.Allocate(numBytes, nullptr);
    return buffer.Release();
}

void GlDevice::Free(DeviceBufferName buffer) {
    auto const name = GLuint(buffer);
    glDeleteBuffers(1, &name);
}

void GlDevice::Write(DeviceBufferName buffer, std::int64_t firstByte, void const *data,
                     std::int64_t numBytes) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, GLuint(buffer));
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, GLintptr(firstByte), GLsizeiptr(numBytes), data);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
}

void GlDevice::Fill(DeviceBufferName buffer, std::int64_t numBytes,
                    std::function<void(void *)> const &write) {
    // Unmaps the buffer, whatever write() throws.
    struct Mapping {
        explicit Mapping(DeviceBufferName buffer, std::int64_t numBytes) {
            glBindBuffer(GL_SHADER_STORAGE_BUFFER, GLuint(buffer));
            memory = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, GLsizeiptr(numBytes),
                                      GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_RANGE_BIT);
        }
        Mapping(Mapping const &) = delete;
        Mapping &operator=(Mapping const &) = delete;
        ~Mapping() {
            Unmap();
            glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
        }
        /// Whether the buffer has what was written.
        bool Unmap() {
            return std::exchange(memory, nullptr) != nullptr &&
                   glUnmapBuffer(GL_SHADER_STORAGE_BUFFER) == GL_TRUE;
        }
        void *memory;
    };
    Mapping mapping(buffer, numBytes);
    if (mapping.memory) {
        write(mapping.memory);
    }
    if (!mapping.Unmap()) {
        Device::Fill(buffer, numBytes, write);
    }
}

CallStatus GlDevice::CheckBuffer(DeviceBufferName buffer, std::int64_t numFloats,
                                 std::string const &what) const {
    auto const fail = [](StatusCode code, std::string const &message) {
        return FarExt::internal::Failure(code, message);
    };
    if (!glIsBuffer(GLuint(buffer))) {
        return fail(StatusCode::InvalidArgument,
                    "the " + what + " " + std::to_string(std::int64_t(buffer)) + " is no buffer");
    }
    GLint64 numBytes = 0;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, GLuint(buffer));
    glGetBufferParameteri64v(GL_SHADER_STORAGE_BUFFER, GL_BUFFER_SIZE, &numBytes);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    std::int64_t const numNeeded = numFloats * std::int64_t(sizeof(float));
    if (numBytes < numNeeded) {
        return fail(StatusCode::InvalidArgument,
                    "the " + what + " has " + std::to_string(numBytes) +
                        " bytes, but its last element ends at byte " + std::to_string(numNeeded));
    }
    std::int64_t const maxBytes = GetMaxBytes();
    if (numNeeded > maxBytes) {
        return fail(StatusCode::TooLarge,
                    "the last element of the " + what + " ends at byte " +
                        std::to_string(numNeeded) +
                        ", beyond what this driver reaches: " + std::to_string(maxBytes));
    }
    return CallStatus();
}

CallStatus GlDevice::Prepare(DeviceKernel kernel, int length, int faceSize) {
    Kernel &prepared = _kernels[{kernel, length, faceSize}];
    if (prepared.program) {
        return CallStatus();
    }
    char const *const name = kNames[int(kernel)];
    std::string const definitions = "#version 430\n#define LENGTH " + std::to_string(length) +
                                    "\n#define SIZE " +
                                    std::to_string(faceSize == 0 ? kMinUnrolledFace : faceSize) +
                                    "\n#define KERNEL " + name + "\n";
    std::vector<char const *> texts = {definitions.c_str(), kHead};
    texts.insert(texts.end(), std::begin(kKernelTexts), std::end(kKernelTexts));
    texts.push_back(kMain);
    auto program =
        std::make_unique<GlProgram>(std::vector<GlProgram::Shader>{{GL_COMPUTE_SHADER, texts}});
    if (!program->GetError().empty()) {
        return FarExt::internal::Failure(StatusCode::Unsupported,
                                         "kernel " + std::string(name) + " of length " +
                                             std::to_string(length) + ": " + program->GetError());
    }
    prepared.program = std::move(program);
#define PLACE Place
#define PARAMETER(type, name) prepared.uniforms.push_back((*prepared.program)[#name]);
#define PARAMETER_ARRAY(type, name, size) PARAMETER(type, name)
#include "osd_ext/device/kernelParameters.inl"
#undef PARAMETER_ARRAY
#undef PARAMETER
#undef PLACE
    return CallStatus();
}

void GlDevice::Run(DeviceTask const &task) {
    Kernel const &kernel = _kernels.at({task.kernel, task.length, task.faceSize});
    DeviceParameters parameters = task.parameters;
    parameters.count = task.count;
    kernel.program->Use();
    GLint const *uniform = kernel.uniforms.data();
#define PLACE Place
#define PARAMETER(type, name) set(*uniform++, parameters.name);
#define PARAMETER_ARRAY(type, name, size) set(*uniform++, parameters.name, size);
#include "osd_ext/device/kernelParameters.inl"
#undef PARAMETER_ARRAY
#undef PARAMETER
#undef PLACE
    DeviceBufferName const buffers[] = {task.sources,        task.results,   task.indices,
                                        task.weights,        task.duResults, task.dvResults,
                                        task.listedVertices, task.triangles};
    for (GLuint binding = 0; binding < std::size(buffers); ++binding) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, GLuint(buffers[binding]));
    }
    std::uint32_t const numGroups = parameters.count / kGroup + (parameters.count % kGroup != 0);
    std::uint32_t const numRows = numGroups / kMaxGroups + (numGroups % kMaxGroups != 0);
    glDispatchCompute(numGroups / numRows + (numGroups % numRows != 0), numRows, 1);
}

void GlDevice::Wait() { glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT); }

// Binds nothing, as if nothing had been.
CallStatus GlDevice::EndFrame() {
    glUseProgram(0);
    constexpr GLuint kNumBindings = 8;
    for (GLuint binding = 0; binding < kNumBindings; ++binding) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, 0);
    }
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    return CallStatus();
}

} // namespace OpenSubdivHex::OsdExt::internal

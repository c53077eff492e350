// SPDX-License-Identifier: Apache-2.0
#include "glTextures.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace OpenSubdivHex::OsdExt::internal {

namespace {

// What kernels.inl declares to be read, and the results, which some kernels read, too.
struct ReadArray {
    GLuint binding;
    GLenum format;
    DeviceBufferName DeviceTask::*buffer;
};
constexpr ReadArray kArrays[] = {
    {0, GL_R32F, &DeviceTask::sources},        {1, GL_R32F, &DeviceTask::results},
    {2, GL_R32UI, &DeviceTask::indices},       {3, GL_R32F, &DeviceTask::weights},
    {4, GL_RGBA32F, &DeviceTask::weights}, // four at once
    {6, GL_R32UI, &DeviceTask::listedVertices}};
constexpr std::int64_t kBytesOfTexel = 4;

std::int64_t getNumBytes(DeviceBufferName buffer) {
    GLint64 result = 0;
    if (buffer != 0) {
        glBindBuffer(GL_TEXTURE_BUFFER, GLuint(buffer));
        glGetBufferParameteri64v(GL_TEXTURE_BUFFER, GL_BUFFER_SIZE, &result);
        glBindBuffer(GL_TEXTURE_BUFFER, 0);
    }
    return result;
}

} // namespace

GlTextures::~GlTextures() {
    if (_names[0] != 0) {
        glDeleteTextures(kNumBindings, _names);
    }
}

std::int64_t GlTextures::getMaxTexels() {
    if (!_maxTexels) {
        auto const *const renderer = reinterpret_cast<char const *>(glGetString(GL_RENDERER));
        GLint maxTexels = 0;
        if (renderer && std::strstr(renderer, "llvmpipe")) {
            glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &maxTexels);
        }
        _maxTexels = maxTexels;
    }
    return *_maxTexels;
}

bool GlTextures::Bind(DeviceTask const &task) {
    if (!AreFaster()) {
        return false;
    }
    bool const areTextures =
        std::all_of(std::begin(kArrays), std::end(kArrays), [&](ReadArray const &array) {
            return getNumBytes(task.*array.buffer) <= getMaxTexels() * kBytesOfTexel;
        });
    if (_names[0] == 0) {
        glGenTextures(kNumBindings, _names);
    }
    DeviceTask ofWeights;
    ofWeights.weights = task.weights;
    setBuffers(areTextures ? task : ofWeights);
    _areBound = true;
    return areTextures;
}

void GlTextures::Unbind() {
    if (_areBound) {
        setBuffers(DeviceTask());
        _areBound = false;
    }
}

// Textures without a buffer are not bound.
void GlTextures::setBuffers(DeviceTask const &task) {
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (ReadArray const &array : kArrays) {
        auto const buffer = GLuint(task.*array.buffer);
        GLuint const name = _names[array.binding];
        glActiveTexture(GL_TEXTURE0 + array.binding);
        glBindTexture(GL_TEXTURE_BUFFER, name);
        glTexBuffer(GL_TEXTURE_BUFFER, array.format, buffer);
        glBindTexture(GL_TEXTURE_BUFFER, buffer != 0 ? name : 0);
    }
    glActiveTexture(GLenum(active));
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_GL_GL_OBJECTS_H
#define OPENSUBDIVHEX_TOOLS_GL_GL_OBJECTS_H

#include "osd_ext/gl/glObjects.h"

#include <epoxy/gl.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief An array in a buffer of OpenGL, for which GlBuffer's rules hold.
class GlArray {
public:
    /// Makes room for \p size numbers of 4 bytes, whose values are not known.
    void Resize(std::size_t size) { allocate(size, nullptr); }
    /// Takes the numbers, of 4 bytes each, of another array.
    template <typename T>
    void Assign(std::vector<T> const &values) {
        static_assert(sizeof(T) == kBytes);
        allocate(values.size(), values.data());
    }
    /// The name of the buffer, as Osd's vertex buffers give it.
    GLuint BindVBO() const { return _buffer.GetName(); }
    std::size_t GetSize() const { return _size; }

    /// Binds it for shaders.
    void Bind(GLuint binding) const {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, BindVBO());
    }

private:
    static constexpr std::size_t kBytes = 4;

    void allocate(std::size_t size, void const *values) {
        // A buffer without a byte cannot be bound for shaders.
        std::size_t const numBytes = size > 0 ? size * kBytes : kBytes;
        _buffer.Allocate(std::int64_t(numBytes), size > 0 ? values : nullptr);
        _size = size;
    }

    OsdExt::internal::GlBuffer _buffer;
    std::size_t _size = 0;
};

/// \brief A program of OpenGL that throws std::runtime_error where its compiler takes it not.
class ViewProgram : public OsdExt::internal::GlProgram {
public:
    explicit ViewProgram(std::vector<Shader> const &shaders) : GlProgram(shaders) {
        if (!GetError().empty()) {
            throw std::runtime_error(GetError());
        }
    }
};

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_GL_GL_OBJECTS_H
#define OPENSUBDIVHEX_OSD_EXT_GL_GL_OBJECTS_H

#include <epoxy/gl.h>

#include <cstdint>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief A buffer of OpenGL, deleted with this.  A context is current wherever one lives.
class GlBuffer {
public:
    GlBuffer() = default;
    GlBuffer(GlBuffer const &) = delete;
    GlBuffer &operator=(GlBuffer const &) = delete;
    ~GlBuffer() { glDeleteBuffers(1, &_name); }

    /// \brief Makes it one of \p numBytes, 1 or more, with \p data, or an unknown content where that is
    /// null.  Throws std::bad_alloc where the driver has not so much.
    void Allocate(std::int64_t numBytes, void const *data) {
        if (_name == 0) {
            glGenBuffers(1, &_name);
        }
        GLint64 numAllocated = 0;
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, _name);
        glBufferData(GL_SHADER_STORAGE_BUFFER, GLsizeiptr(numBytes), data, GL_DYNAMIC_COPY);
        glGetBufferParameteri64v(GL_SHADER_STORAGE_BUFFER, GL_BUFFER_SIZE, &numAllocated);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
        if (numAllocated != numBytes) {
            glGetError(); // which is told by the exception
            throw std::bad_alloc();
        }
    }
    GLuint GetName() const { return _name; }
    /// Gives the buffer to the caller.
    GLuint Release() { return std::exchange(_name, 0); }

private:
    GLuint _name = 0;
};

/// \brief A program of OpenGL, deleted with this.  A context is current wherever one lives.
class GlProgram {
public:
    struct Shader {
        GLenum type;
        std::vector<char const *> texts; ///< one behind the other
    };

    explicit GlProgram(std::vector<Shader> const &shaders) : _name(glCreateProgram()) {
        for (Shader const &shader : shaders) {
            GLuint const name = glCreateShader(shader.type);
            glShaderSource(name, GLsizei(shader.texts.size()), shader.texts.data(), nullptr);
            glCompileShader(name);
            addLog(name, glGetShaderiv, glGetShaderInfoLog);
            glAttachShader(_name, name);
            glDeleteShader(name);
        }
        glLinkProgram(_name);
        GLint isLinked = GL_FALSE;
        glGetProgramiv(_name, GL_LINK_STATUS, &isLinked);
        if (isLinked != GL_TRUE) {
            addLog(_name, glGetProgramiv, glGetProgramInfoLog);
            _error = "the compiler of OpenGL does not take this program: " + _log;
        }
    }
    GlProgram(GlProgram const &) = delete;
    GlProgram &operator=(GlProgram const &) = delete;
    ~GlProgram() { glDeleteProgram(_name); }

    /// Empty, or what the compiler says.
    std::string const &GetError() const { return _error; }

    void Use() const { glUseProgram(_name); }
    /// The place of a uniform; -1, which may be set in vain, of one that the program does not use.
    GLint operator[](char const *uniform) const { return glGetUniformLocation(_name, uniform); }

private:
    // The log of a shader or a program.
    template <typename GET_NUMBER, typename GET_LOG>
    void addLog(GLuint name, GET_NUMBER getNumber, GET_LOG getLog) {
        GLint size = 0;
        getNumber(name, GL_INFO_LOG_LENGTH, &size);
        if (size > 0) {
            std::string log(std::size_t(size), ' ');
            getLog(name, size, &size, log.data());
            _log.append(log, 0, std::size_t(size));
        }
    }

    GLuint _name;
    std::string _log;
    std::string _error;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

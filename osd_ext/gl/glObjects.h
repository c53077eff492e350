// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_GL_GL_OBJECTS_H
#define OPENSUBDIVHEX_OSD_EXT_GL_GL_OBJECTS_H

#include <epoxy/gl.h>

#include <string>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

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
            glAttachShader(_name, name);
            glDeleteShader(name);
        }
        glLinkProgram(_name);
        GLint isLinked = GL_FALSE;
        glGetProgramiv(_name, GL_LINK_STATUS, &isLinked);
        if (isLinked != GL_TRUE) {
            constexpr int kMaxLog = 2000;
            char log[kMaxLog] = "";
            glGetProgramInfoLog(_name, kMaxLog, nullptr, log);
            _error = std::string("the compiler of OpenGL takes no shader of this program: ") + log;
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
    GLuint _name;
    std::string _error;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

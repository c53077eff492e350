// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_GL_GL_CONTEXT_H
#define OPENSUBDIVHEX_REGRESSION_GL_GL_CONTEXT_H

#include <EGL/egl.h>
#include <GL/gl.h>
#include <GL/glext.h>

#include <cstdint>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A context of OpenGL 4.3 or later without a window, current while it lives: of a device, else of
/// the processor.
class GlContext {
public:
    GlContext();
    ~GlContext();

    GlContext(GlContext const &) = delete;
    GlContext &operator=(GlContext const &) = delete;

    /// Empty, or why there is none.
    std::string const &GetError() const { return _error; }

    /// The renderer's name, by its driver.
    std::string GetRenderer() const;

    /// The floats of a buffer of OpenGL, once all that was called before is done.
    std::vector<float> Read(GLuint buffer, std::size_t numFloats,
                            std::int64_t firstFloat = 0) const;

    /// A buffer of any size; 0 where the driver has none.
    GLuint MakeBuffer(std::int64_t numBytes) const;
    void DeleteBuffer(GLuint buffer) const;

    /// How many groups of invocations the driver dispatches at once, in the first direction.
    int GetMaxComputeGroups() const;

    /// The first error since the last call; GL_NO_ERROR is 0.
    GLenum GetGlError() const;

    /// Makes a complete framebuffer of one pixel, and binds it.
    void BindFramebuffer();
    /// Binds the framebuffer of the surface, of which there is none.
    void UnbindFramebuffer();

private:
    bool makeContext();
    void release();

    EGLDisplay _display = EGL_NO_DISPLAY;
    EGLContext _context = EGL_NO_CONTEXT;
    std::string _error;
};

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_GL_OFFSCREEN_H
#define OPENSUBDIVHEX_TOOLS_GL_OFFSCREEN_H

#include "tools/render/image.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace OpenSubdivHex::Tools {

/// \brief A context of OpenGL 4.3 without a window, current while it lives, with a framebuffer.
class Offscreen {
public:
    /// Throws std::runtime_error where the machine has none.
    Offscreen(int width, int height);
    ~Offscreen();
    Offscreen(Offscreen const &) = delete;
    Offscreen &operator=(Offscreen const &) = delete;

    /// Returns the picture that was drawn.
    Image Read() const;

private:
    void makeFramebuffer();

    int _width;
    int _height;
    EGLDisplay _display = EGL_NO_DISPLAY;
    EGLContext _context = EGL_NO_CONTEXT;
    GLuint _framebuffers[2] = {}; // several samples for each pixel, and one
    GLuint _renderbuffers[3] = {};
};

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#include "offscreen.h"

#include <algorithm>

#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Tools {

namespace {

constexpr int kNumSamples = 4; // which OpenGL 4.3 promises

} // namespace

Offscreen::Offscreen(int width, int height) : _width(width), _height(height) {
    _display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                        reinterpret_cast<void *>(EGL_DEFAULT_DISPLAY), nullptr);
    if (_display == EGL_NO_DISPLAY || !eglInitialize(_display, nullptr, nullptr)) {
        throw std::runtime_error("EGL has no display without a window");
    }
    EGLint const configAttributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                       EGL_OPENGL_BIT, EGL_NONE};
    EGLint const contextAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                        4,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_NONE};
    EGLConfig config = nullptr;
    EGLint numConfigs = 0;
    if (eglBindAPI(EGL_OPENGL_API) &&
        eglChooseConfig(_display, configAttributes, &config, 1, &numConfigs) && numConfigs > 0) {
        _context = eglCreateContext(_display, config, EGL_NO_CONTEXT, contextAttributes);
    }
    if (_context == EGL_NO_CONTEXT ||
        !eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, _context)) {
        eglTerminate(_display);
        throw std::runtime_error("EGL makes no context of OpenGL 4.3 without a window");
    }
    makeFramebuffer();
}

void Offscreen::makeFramebuffer() {
    glGenFramebuffers(2, _framebuffers);
    glGenRenderbuffers(3, _renderbuffers);
    auto const attach = [&](int number, int numSamples, GLenum format, GLenum place) {
        glBindRenderbuffer(GL_RENDERBUFFER, _renderbuffers[number]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, numSamples, format, _width, _height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, _renderbuffers[number]);
    };
    glBindFramebuffer(GL_FRAMEBUFFER, _framebuffers[1]);
    attach(2, 0, GL_RGBA8, GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_FRAMEBUFFER, _framebuffers[0]);
    attach(0, kNumSamples, GL_RGBA8, GL_COLOR_ATTACHMENT0);
    attach(1, kNumSamples, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw std::runtime_error("OpenGL has no framebuffer of " + std::to_string(_width) + " by " +
                                 std::to_string(_height) + " pixels");
    }
}

Offscreen::~Offscreen() {
    glDeleteFramebuffers(2, _framebuffers);
    glDeleteRenderbuffers(3, _renderbuffers);
    eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(_display, _context);
    eglTerminate(_display);
}

Image Offscreen::Read() const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, _framebuffers[0]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, _framebuffers[1]);
    glBlitFramebuffer(0, 0, _width, _height, 0, 0, _width, _height, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, _framebuffers[1]);
    Image image(_width, _height);
    std::vector<std::uint8_t> rows(image.pixels.size()); // from the bottom
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, _width, _height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    glBindFramebuffer(GL_FRAMEBUFFER, _framebuffers[0]);
    auto const rowSize = std::size_t(3 * _width);
    for (int y = 0; y < _height; ++y) {
        std::copy_n(rows.data() + std::size_t(_height - 1 - y) * rowSize, rowSize,
                    image.GetPixel(0, y));
    }
    return image;
}

} // namespace OpenSubdivHex::Tools

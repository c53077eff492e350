// SPDX-License-Identifier: Apache-2.0
#include "glContext.h"

#include <EGL/eglext.h>

#include <cstring>

namespace OpenSubdivHex::Regression {

namespace {

/// A function of OpenGL or EGL, by its name.
template <typename FUNCTION>
FUNCTION getFunction(char const *name) {
    return reinterpret_cast<FUNCTION>(eglGetProcAddress(name));
}

/// Displays without a window that may exist: those of devices, as NVIDIA's driver has them, then the one
/// of Mesa, which takes processors, too.
std::vector<EGLDisplay> findDisplays() {
    auto const getPlatformDisplay =
        getFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (!getPlatformDisplay) {
        return {};
    }
    constexpr EGLint kMaxDevices = 16;
    EGLDeviceEXT devices[kMaxDevices];
    EGLint numDevices = 0;
    auto const queryDevices = getFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    auto const queryString = getFunction<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    if (!queryDevices || !queryString || !queryDevices(kMaxDevices, devices, &numDevices)) {
        numDevices = 0;
    }
    std::vector<EGLDisplay> displays;
    for (EGLint i = 0; i < numDevices; ++i) {
        char const *const extensions = queryString(devices[i], EGL_EXTENSIONS);
        if (extensions && !std::strstr(extensions, "EGL_MESA_device_software")) {
            displays.push_back(getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
        }
    }
    displays.push_back(getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA,
                                          reinterpret_cast<void *>(EGL_DEFAULT_DISPLAY), nullptr));
    return displays;
}

} // namespace

GlContext::GlContext() : _error("EGL has no display without a window") {
    for (EGLDisplay display : findDisplays()) {
        if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) {
            _display = display;
            if (makeContext()) {
                _error.clear();
                return;
            }
            _error = "EGL makes no context of OpenGL 4.3 without a surface";
            release();
        }
    }
}

bool GlContext::makeContext() {
    EGLint const configAttributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                       EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint numConfigs = 0;
    EGLint const contextAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                        4,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_NONE};
    if (eglBindAPI(EGL_OPENGL_API) &&
        eglChooseConfig(_display, configAttributes, &config, 1, &numConfigs) && numConfigs > 0) {
        _context = eglCreateContext(_display, config, EGL_NO_CONTEXT, contextAttributes);
    }
    return _context != EGL_NO_CONTEXT &&
           eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, _context);
}

GlContext::~GlContext() { release(); }

void GlContext::release() {
    if (_display == EGL_NO_DISPLAY) {
        return;
    }
    eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (_context != EGL_NO_CONTEXT) {
        eglDestroyContext(_display, _context);
    }
    eglTerminate(_display);
    _context = EGL_NO_CONTEXT;
    _display = EGL_NO_DISPLAY;
}

std::vector<float> GlContext::Read(GLuint buffer, std::size_t numFloats,
                                   std::int64_t firstFloat) const {
    std::vector<float> values(numFloats);
    getFunction<PFNGLMEMORYBARRIERPROC>("glMemoryBarrier")(GL_BUFFER_UPDATE_BARRIER_BIT);
    getFunction<PFNGLBINDBUFFERPROC>("glBindBuffer")(GL_COPY_READ_BUFFER, buffer);
    getFunction<PFNGLGETBUFFERSUBDATAPROC>("glGetBufferSubData")(
        GL_COPY_READ_BUFFER, GLintptr(firstFloat) * GLintptr(sizeof(float)),
        GLsizeiptr(numFloats * sizeof(float)), values.data());
    return values;
}

GLuint GlContext::MakeBuffer(std::int64_t numBytes) const {
    GLuint buffer = 0;
    getFunction<PFNGLGENBUFFERSPROC>("glGenBuffers")(1, &buffer);
    getFunction<PFNGLBINDBUFFERPROC>("glBindBuffer")(GL_COPY_READ_BUFFER, buffer);
    getFunction<PFNGLBUFFERDATAPROC>("glBufferData")(GL_COPY_READ_BUFFER, GLsizeiptr(numBytes),
                                                     nullptr, GL_DYNAMIC_COPY);
    if (GetGlError() != GL_NO_ERROR) {
        DeleteBuffer(buffer);
        return 0;
    }
    return buffer;
}

void GlContext::DeleteBuffer(GLuint buffer) const {
    getFunction<PFNGLDELETEBUFFERSPROC>("glDeleteBuffers")(1, &buffer);
}

std::string GlContext::GetRenderer() const {
    GLubyte const *const name = getFunction<GLubyte const *(*)(GLenum)>("glGetString")(GL_RENDERER);
    return reinterpret_cast<char const *>(name);
}

int GlContext::GetMaxComputeGroups() const {
    GLint count = 0;
    getFunction<PFNGLGETINTEGERI_VPROC>("glGetIntegeri_v")(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0,
                                                           &count);
    return count;
}

GLenum GlContext::GetGlError() const { return getFunction<GLenum (*)()>("glGetError")(); }

void GlContext::BindFramebuffer() {
    GLuint renderbuffer = 0;
    GLuint framebuffer = 0;
    getFunction<PFNGLGENRENDERBUFFERSPROC>("glGenRenderbuffers")(1, &renderbuffer);
    getFunction<PFNGLBINDRENDERBUFFERPROC>("glBindRenderbuffer")(GL_RENDERBUFFER, renderbuffer);
    getFunction<PFNGLRENDERBUFFERSTORAGEPROC>("glRenderbufferStorage")(GL_RENDERBUFFER, GL_RGBA8, 1,
                                                                       1);
    getFunction<PFNGLGENFRAMEBUFFERSPROC>("glGenFramebuffers")(1, &framebuffer);
    getFunction<PFNGLBINDFRAMEBUFFERPROC>("glBindFramebuffer")(GL_FRAMEBUFFER, framebuffer);
    getFunction<PFNGLFRAMEBUFFERRENDERBUFFERPROC>("glFramebufferRenderbuffer")(
        GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
}

void GlContext::UnbindFramebuffer() {
    getFunction<PFNGLBINDFRAMEBUFFERPROC>("glBindFramebuffer")(GL_FRAMEBUFFER, 0);
}

} // namespace OpenSubdivHex::Regression

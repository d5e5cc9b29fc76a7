// A GL context without a window, drawn by Mesa in software: the renderer that shares nothing with ours; or somebody else's.
// SPDX-License-Identifier: MIT
#include "apps/gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "apps/gl/objects.h"

namespace sightline {
namespace {

constexpr int kWays = 2;
std::atomic<bool> taken[kWays];

std::string eglFault(const char* call) {
    char code[16];
    std::snprintf(code, sizeof code, "0x%04x", static_cast<unsigned>(eglGetError()));
    return std::string(call) + " failed with " + code;
}

/// EGL gives the same display, and with it the same driver threads, to everybody who asks in the same way.
EGLDisplay displayOf(int way) {
    if (way == 0) return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) return EGL_NO_DISPLAY;
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (!eglQueryDevicesEXT(16, devices, &count)) return EGL_NO_DISPLAY;
    for (EGLint i = 0; i < count; ++i) {
        const char* can = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
        if (can != nullptr && std::string(can).find("EGL_MESA_device_software") != std::string::npos)
            return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    }
    return EGL_NO_DISPLAY;
}

}  // namespace

Result<GlContext> GlContext::create(uint32_t threads) {
    if (threads > 16) return Error{Error::Kind::kUsage, "OpenGL: the software driver takes at most 16 threads"};
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        return glFault("EGL here has no EGL_MESA_platform_surfaceless");
    Error last = glFault("two contexts are alive already");
    for (int way = 0; way < kWays; ++way) {
        if (taken[way].exchange(true)) continue;
        GlContext context;
        context.way_ = way;
        context.threads_ = threads;
        if (const Status opened = context.open(way); opened) return context;
        else last = opened.error();
    }
    return last;
}

Result<GlContext> GlContext::current() {
    const int version = epoxy_gl_version();
    if (version < 45)
        return glFault("4.5 is needed, and here is " + std::to_string(version / 10) + "." +
                       std::to_string(version % 10));
    GlContext context;
    context.readRenderer();
    return context;
}

void GlContext::readRenderer() {
    const auto text = [](GLenum name) {
        const GLubyte* value = glGetString(name);
        return std::string(value != nullptr ? reinterpret_cast<const char*>(value) : "unknown");
    };
    renderer_ = text(GL_RENDERER) + ", " + text(GL_VERSION);
}

Status GlContext::open(int way) {
    const EGLDisplay display = displayOf(way);
    if (display == EGL_NO_DISPLAY) return glFault("EGL has no display for the software driver");
    if (!eglInitialize(display, nullptr, nullptr)) return glFault(eglFault("eglInitialize"));
    display_ = display;
    if (!eglBindAPI(EGL_OPENGL_API)) return glFault(eglFault("eglBindAPI"));
    const EGLint wish[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wish);
    if (context_ == EGL_NO_CONTEXT) return glFault(eglFault("eglCreateContext for GL 4.5"));
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) return glFault(eglFault("eglMakeCurrent"));
    readRenderer();
    if (renderer_.find("llvmpipe") == std::string::npos)
        return glFault("drawn by " + renderer_ + ", not by Mesa's llvmpipe");
    return success();
}

void GlContext::makeCurrent() const {
    if (context_ != nullptr && eglGetCurrentContext() != context_)
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

void GlContext::close() {
    if (display_ != nullptr) {
        if (context_ != nullptr) {
            if (eglGetCurrentContext() == context_)
                eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
            eglDestroyContext(display_, context_);
        }
        eglTerminate(display_);
    }
    if (way_ >= 0) taken[way_] = false;
    display_ = context_ = nullptr;
    way_ = -1;
}

GlContext::GlContext(GlContext&& other) noexcept { *this = std::move(other); }

GlContext& GlContext::operator=(GlContext&& other) noexcept {
    if (this == &other) return *this;
    close();
    display_ = std::exchange(other.display_, nullptr);
    context_ = std::exchange(other.context_, nullptr);
    way_ = std::exchange(other.way_, -1);
    threads_ = other.threads_;
    renderer_ = std::move(other.renderer_);
    return *this;
}

GlContext::~GlContext() { close(); }

}  // namespace sightline

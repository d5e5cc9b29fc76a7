// A GL context without a window, drawn by Mesa in software: the renderer that shares nothing with ours; or somebody else's.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "sightline/base/result.h"

namespace sightline {

/// GL 4.5 core on Mesa's llvmpipe through EGL, with neither display nor graphics card. Sets LIBGL_ALWAYS_SOFTWARE,
/// GALLIUM_DRIVER and LP_NUM_THREADS in the environment of this process: create contexts while no other thread reads it.
///
/// Each context has a driver of its own, with its own threads; there are two ways in, so two contexts can live at once
/// and take turns. One thread at a time may use a context.
class GlContext {
public:
    /// @param threads  that fill pixels; the caller's thread transforms and bins  [limit: 0 to 16; 0: the caller's too]
    /// Errors: no EGL, no software driver, a GL older than 4.5, two contexts alive already.
    static Result<GlContext> create(uint32_t threads = 1);
    /// The context that is current on this thread, whosever it is and whatever draws it. There must be one, and stay while
    /// what was made in it is used, for makeCurrent() does nothing. Errors: a GL older than 4.5.
    static Result<GlContext> current();

    GlContext(GlContext&& other) noexcept;
    GlContext& operator=(GlContext&& other) noexcept;
    ~GlContext();

    /// GL calls of this thread go to this context from now on.
    void makeCurrent() const;

    uint32_t threads() const { return threads_; }
    const std::string& renderer() const { return renderer_; }  ///< driver and version, as the GL says them

private:
    GlContext() = default;
    Status open(int way);
    void close();
    void readRenderer();

    void* display_ = nullptr;
    void* context_ = nullptr;  ///< null: somebody else's
    int way_ = -1;             ///< which of the ways in this one has taken; -1: none
    uint32_t threads_ = 0;
    std::string renderer_;
};

}  // namespace sightline

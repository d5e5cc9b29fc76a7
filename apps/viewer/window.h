// A window with a GL: what the user does in it, frame by frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "apps/viewer/gui.h"
#include "sightline/base/result.h"

namespace sightline::viewer {

/// Opens a window of OpenGL 4.5, or of 3.3 where there is no more, and closes it when it goes. One at a time.
class Window {
public:
    /// Errors (kInput): there is no display, or no OpenGL 3.3.
    /// It is seen from the first frame on.
    static Result<Window> open(const std::string& title, uint32_t width, uint32_t height);
    Window(Window&& other) noexcept;
    Window& operator=(Window&&) = delete;
    ~Window();

    enum class Next : uint8_t {
        kFrame,  ///< the next frame, at once
        kRest,   ///< the next frame when something is done in the window, or a tenth of a second later
        kEnd,
    };
    /// Draws frames until the user closes the window or `draw` says so.
    /// @param draw  draw(input, width, height): draws into the window's GL
    void run(const std::function<Next(const Input& input, uint32_t width, uint32_t height)>& draw);
    /// Pixels for one of the system's units: 2 on many small screens.
    float scale() const;

private:
    Window() = default;
    void* window_ = nullptr;
};

}  // namespace sightline::viewer

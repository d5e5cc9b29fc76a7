// What the window shows while a scene is read and prepared: what is being done, and how far it is.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "apps/viewer/gui.h"

namespace sightline::viewer {

/// How far some work has come.
struct LoadingPart {
    std::string what;  ///< "preparing meshes"; empty: nobody has said
    double part = 0;   ///< [0 to 1]
};

class LoadingScreen {
public:
    /// A context of OpenGL 3.3 or later must be current, here and in all that follows.
    static Result<LoadingScreen> create();

    /// Errors: of the GL.
    /// @param title  of what is loaded
    Status frame(const Input& input, uint32_t width, uint32_t height, float scale, const std::string& title,
                 const LoadingPart& now);
    /// Into the window.
    void show(uint32_t width, uint32_t height) const { image_.show(width, height); }
    const ScreenImage& image() const { return image_; }

private:
    Gui gui_;
    ScreenImage image_;
};

}  // namespace sightline::viewer

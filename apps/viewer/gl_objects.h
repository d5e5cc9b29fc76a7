// What the viewer has in the GL: buffers, arrays, programs and images to draw into; of OpenGL 3.3.
// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "apps/gl/objects.h"
#include "sightline/tools/report/pictures/png.h"

namespace sightline::viewer {

/// Places with a colour each, handed on as `ink`.
inline constexpr const char* kInkVertexShader = R"(#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 colour;
uniform mat4 to_clip;
flat out vec3 ink;
void main() {
    gl_Position = to_clip * vec4(place, 1.0);
    ink = colour;
}
)";

GlName makeBuffer(GLenum target, std::span<const std::byte> bytes, GLenum usage);
GlName makeArray();

/// An image of several samples a pixel, and the same of one, which can be read and shown.
class ScreenImage {
public:
    /// Makes it anew where the size is another one. Errors: too large, no memory.
    /// @param smooth  several samples a pixel
    Status resize(uint32_t width, uint32_t height, bool smooth);
    void begin() const;    ///< what is drawn goes here, and the viewport is all of it
    void resolve() const;  ///< the samples of each pixel into one
    /// Copies it into the window.
    void show(uint32_t window_width, uint32_t window_height) const;
    /// What it shows, once it is resolved.  Errors: of the GL.
    Result<tools::Image<tools::Rgb>> picture() const;
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

private:
    uint32_t width_ = 0, height_ = 0;
    GlName colour_, depth_, framebuffer_, resolved_colour_, resolved_;
};

}  // namespace sightline::viewer

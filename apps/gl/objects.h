// What lives in the GL and must be deleted: buffers, vertex arrays, programs, images to draw into.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "sightline/base/result.h"

namespace sightline {

/// What the GL did not do.
Error glFault(const std::string& what);

/// One name of the GL and what deletes it. The context that it came from must be current when it goes.
class GlName {
public:
    using Delete = void (*)(uint32_t);

    GlName() = default;
    GlName(uint32_t name, Delete remove) : name_(name), remove_(remove) {}
    GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)), remove_(other.remove_) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(name_, other.name_);
        std::swap(remove_, other.remove_);
        return *this;
    }
    ~GlName() {
        if (name_ != 0) remove_(name_);
    }

    uint32_t get() const { return name_; }

private:
    uint32_t name_ = 0;
    Delete remove_ = nullptr;
};

/// A buffer that never changes.
GlName makeGlBuffer(std::span<const std::byte> bytes);
GlName makeGlVertexArray();

/// Errors: the compiler's or the linker's first line.
Result<GlName> makeGlProgram(const std::string& vertex_shader, const std::string& fragment_shader);
/// The same of OpenGL 4.3 or later.
Result<GlName> makeGlComputeProgram(const std::string& shader);

/// An image to draw into: one colour and a 32-bit float depth per pixel.
struct GlTarget {
    uint32_t width = 0, height = 0;
    GlName colour, depth, framebuffer;

    /// @param colour_format  sized internal format, as GL_R32UI
    /// Errors: larger than the GL can draw, no memory.
    static Result<GlTarget> create(uint32_t colour_format, uint32_t width, uint32_t height);
};

/// What went wrong since the last call, if anything did.
Status checkGl(const char* during);

}  // namespace sightline

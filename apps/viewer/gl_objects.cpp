// What the viewer has in the GL: buffers, arrays, programs and images to draw into; of OpenGL 3.3.
// SPDX-License-Identifier: MIT
#include "apps/viewer/gl_objects.h"

#include <algorithm>

namespace sightline::viewer {
namespace {

constexpr GLsizei kSamples = 4;

GlName makeRenderbuffer(GLsizei samples, GLenum format, uint32_t width, uint32_t height) {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, static_cast<GLsizei>(width),
                                     static_cast<GLsizei>(height));
    return {name, [](uint32_t old) { glDeleteRenderbuffers(1, &old); }};
}

GlName makeFramebuffer() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    return {name, [](uint32_t old) { glDeleteFramebuffers(1, &old); }};
}

void attach(GLenum where, const GlName& renderbuffer) {
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, renderbuffer.get());
}

}  // namespace

GlName makeBuffer(GLenum target, std::span<const std::byte> bytes, GLenum usage) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), usage);
    return {name, [](uint32_t old) { glDeleteBuffers(1, &old); }};
}

GlName makeArray() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return {name, [](uint32_t old) { glDeleteVertexArrays(1, &old); }};
}

Status ScreenImage::resize(uint32_t width, uint32_t height, bool smooth) {
    if (width == width_ && height == height_) return success();
    GLint most = 0, samples = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    glGetIntegerv(GL_MAX_SAMPLES, &samples);
    if (width > static_cast<uint32_t>(most) || height > static_cast<uint32_t>(most))
        return Error{Error::Kind::kInput,
                     "OpenGL: an image of " + std::to_string(width) + "x" + std::to_string(height) + " is too large"};
    width_ = height_ = 0;  // nothing is here if the rest fails
    samples = smooth ? std::min(samples, GLint{kSamples}) : 0;
    colour_ = makeRenderbuffer(samples, GL_RGBA8, width, height);
    depth_ = makeRenderbuffer(samples, GL_DEPTH_COMPONENT32F, width, height);
    framebuffer_ = makeFramebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
    attach(GL_COLOR_ATTACHMENT0, colour_);
    attach(GL_DEPTH_ATTACHMENT, depth_);
    const GLenum first = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    resolved_colour_ = makeRenderbuffer(0, GL_RGBA8, width, height);
    resolved_ = makeFramebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_.get());
    attach(GL_COLOR_ATTACHMENT0, resolved_colour_);
    if (first != GL_FRAMEBUFFER_COMPLETE || glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return Error{Error::Kind::kInput, "OpenGL: there is no room for an image of " + std::to_string(width) + "x" +
                                              std::to_string(height)};
    if (const Status made = checkGl("making an image"); !made) return made;
    width_ = width;
    height_ = height;
    return success();
}

void ScreenImage::begin() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
    glViewport(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_));
}

void ScreenImage::resolve() const {
    const auto right = static_cast<GLint>(width_), top = static_cast<GLint>(height_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.get());
    glBlitFramebuffer(0, 0, right, top, 0, 0, right, top, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_.get());
}

void ScreenImage::show(uint32_t window_width, uint32_t window_height) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.get());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, static_cast<GLint>(width_), static_cast<GLint>(height_), 0, 0,
                      static_cast<GLint>(window_width), static_cast<GLint>(window_height), GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
}

Result<tools::Image<tools::Rgb>> ScreenImage::picture() const {
    tools::Image<tools::Rgb> picture(width_, height_);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    std::vector<tools::Rgb> rows(picture.pixels.size());
    glReadPixels(0, 0, static_cast<GLsizei>(picture.width), static_cast<GLsizei>(picture.height), GL_RGB,
                 GL_UNSIGNED_BYTE, rows.data());
    for (uint32_t y = 0; y < picture.height; ++y)
        std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(size_t{picture.height - 1 - y} * picture.width),
                    picture.width, picture.pixels.begin() + static_cast<std::ptrdiff_t>(size_t{y} * picture.width));
    if (const Status done = checkGl("reading a picture"); !done) return done.error();
    return picture;
}

}  // namespace sightline::viewer

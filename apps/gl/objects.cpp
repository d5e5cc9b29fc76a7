// What lives in the GL and must be deleted: buffers, vertex arrays, programs, images to draw into.
// SPDX-License-Identifier: MIT
#include "apps/gl/objects.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstdio>
#include <initializer_list>

namespace sightline {
namespace {

std::string firstLine(const char* text) {
    const std::string all(text);
    return all.substr(0, all.find('\n'));
}

Result<GlName> makeShader(GLenum kind, const std::string& source) {
    GlName shader(glCreateShader(kind), [](uint32_t name) { glDeleteShader(name); });
    const char* text = source.c_str();
    glShaderSource(shader.get(), 1, &text, nullptr);
    glCompileShader(shader.get());
    GLint good = GL_FALSE;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &good);
    if (good == GL_TRUE) return shader;
    char log[512] = "";
    glGetShaderInfoLog(shader.get(), sizeof log, nullptr, log);
    const char* const name = kind == GL_VERTEX_SHADER ? "vertex" : kind == GL_FRAGMENT_SHADER ? "fragment" : "compute";
    return glFault(std::string(name) + " shader: " + firstLine(log));
}

Result<GlName> linkProgram(std::initializer_list<const GlName*> shaders) {
    GlName program(glCreateProgram(), [](uint32_t name) { glDeleteProgram(name); });
    for (const GlName* shader : shaders) glAttachShader(program.get(), shader->get());
    glLinkProgram(program.get());
    GLint good = GL_FALSE;
    glGetProgramiv(program.get(), GL_LINK_STATUS, &good);
    if (good == GL_TRUE) return program;
    char log[512] = "";
    glGetProgramInfoLog(program.get(), sizeof log, nullptr, log);
    return glFault("program: " + firstLine(log));
}

GlName makeRenderbuffer(GLenum format, uint32_t width, uint32_t height) {
    GLuint name = 0;
    glCreateRenderbuffers(1, &name);
    glNamedRenderbufferStorage(name, format, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    return {name, [](uint32_t old) { glDeleteRenderbuffers(1, &old); }};
}

}  // namespace

Error glFault(const std::string& what) { return {Error::Kind::kInput, "OpenGL: " + what}; }

GlName makeGlBuffer(std::span<const std::byte> bytes) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    // A buffer of no bytes is an error in the GL.
    const std::byte none[4] = {};
    if (bytes.empty()) bytes = none;
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
    return {name, [](uint32_t old) { glDeleteBuffers(1, &old); }};
}

GlName makeGlVertexArray() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return {name, [](uint32_t old) { glDeleteVertexArrays(1, &old); }};
}

Result<GlName> makeGlProgram(const std::string& vertex_shader, const std::string& fragment_shader) {
    const Result<GlName> vertex = makeShader(GL_VERTEX_SHADER, vertex_shader);
    if (!vertex) return vertex.error();
    const Result<GlName> fragment = makeShader(GL_FRAGMENT_SHADER, fragment_shader);
    if (!fragment) return fragment.error();
    return linkProgram({&*vertex, &*fragment});
}

Result<GlName> makeGlComputeProgram(const std::string& shader) {
    const Result<GlName> made = makeShader(GL_COMPUTE_SHADER, shader);
    if (!made) return made.error();
    return linkProgram({&*made});
}

Result<GlTarget> GlTarget::create(uint32_t colour_format, uint32_t width, uint32_t height) {
    GLint limits[2] = {0, 0}, size = 0;
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, limits);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &size);
    if (width > static_cast<uint32_t>(std::min(limits[0], size)) ||
        height > static_cast<uint32_t>(std::min(limits[1], size)))
        return glFault("an image of " + std::to_string(width) + "x" + std::to_string(height) + " is too large");
    GlTarget target;
    target.width = width;
    target.height = height;
    target.colour = makeRenderbuffer(colour_format, width, height);
    target.depth = makeRenderbuffer(GL_DEPTH_COMPONENT32F, width, height);
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    target.framebuffer = {name, [](uint32_t old) { glDeleteFramebuffers(1, &old); }};
    glNamedFramebufferRenderbuffer(name, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target.colour.get());
    glNamedFramebufferRenderbuffer(name, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth.get());
    if (glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return glFault("the image to draw into is not complete");
    if (const Status made = checkGl("making an image"); !made) return made.error();
    return target;
}

Status checkGl(const char* during) {
    const GLenum code = glGetError();
    if (code == GL_NO_ERROR) return success();
    char text[16];
    std::snprintf(text, sizeof text, "0x%04x", static_cast<unsigned>(code));
    return glFault(std::string("error ") + text + " while " + during);
}

}  // namespace sightline

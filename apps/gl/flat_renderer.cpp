// The independent renderer's flat-shaded picture: what our z-buffer is timed against.
// SPDX-License-Identifier: MIT
#include "apps/gl/flat_renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "apps/gl/gl_view.h"
#include "apps/gl/objects.h"
#include "apps/gl/provoking.h"
#include "sightline/math/box.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline {
using namespace studies;
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;
layout(location = 2) in vec4 base;
layout(location = 0) uniform mat4 to_clip;
layout(location = 4) uniform vec3 sun;
flat out vec4 colour;
void main() {
    gl_Position = to_clip * vec4(position, 1.0);
    colour = vec4(base.rgb * (0.35 + 0.65 * max(dot(normal.xyz, sun), 0.0)), base.a);
}
)";

constexpr const char* kFragmentShader = R"(#version 450 core
flat in vec4 colour;
layout(location = 0) out vec4 shown;
void main() { shown = colour; }
)";

struct Vertex {
    glm::vec3 position;  ///< world, relative to the anchor
    uint32_t normal;     ///< of the triangle that it speaks for: 10 bits each, signed
    uint32_t colour;
};

uint32_t packNormal(const glm::dvec3& normal) {
    const double length = glm::length(normal);
    uint32_t packed = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int part = length > 0 ? static_cast<int>(std::lround(511.0 * normal[axis] / length)) : 0;
        packed |= (static_cast<uint32_t>(part) & 1023u) << (10 * axis);
    }
    return packed;
}

uint32_t colourOf(uint32_t id) {
    uint64_t mixed = (id + 1) * 0x9e3779b97f4a7c15ull;
    mixed ^= mixed >> 29;
    return (static_cast<uint32_t>(mixed & 0x7f7f7f) + 0x404040u) | 0xff000000u;
}

/// All items of a list as one mesh.
struct Merged {
    glm::dvec3 anchor{0.0};
    std::vector<Vertex> vertices;
    std::vector<uint32_t> single, double_sided;

    void add(const DrawList& list, size_t item, std::span<const uint32_t> colours);
};

void Merged::add(const DrawList& list, size_t index, std::span<const uint32_t> colours) {
    const DrawItem& item = list.items()[index];
    const ProvokingMesh made = makeProvoking(item);
    const bool mirrored = glm::determinant(glm::dmat3(item.transform)) < 0;
    const auto worldOf = [&](uint32_t position) {
        return glm::dvec3(item.transform * glm::dvec4(glm::dvec3(item.mesh.positions[position]), 1.0)) - anchor;
    };
    const uint32_t base = static_cast<uint32_t>(vertices.size());
    for (size_t i = 0; i < made.position.size(); ++i) {
        Vertex vertex{glm::vec3(worldOf(made.position[i])), 0, 0};
        const uint32_t t = made.triangle[i];
        if (t != ProvokingMesh::kNone) {
            const uint32_t* corners = &item.mesh.indices[3 * size_t{t}];
            const glm::dvec3 a = worldOf(corners[0]), b = worldOf(corners[1]), c = worldOf(corners[2]);
            vertex.normal = packNormal((mirrored ? -1.0 : 1.0) * glm::cross(b - a, c - a));
            vertex.colour = colours.empty() ? colourOf(item.id) : colours[list.firstSurface(index) + t];
        }
        vertices.push_back(vertex);
    }
    const auto append = [&](const std::vector<uint32_t>& from, std::vector<uint32_t>& to) {
        for (size_t i = 0; i + 2 < from.size(); i += 3) {
            const uint32_t first = from[i] + base, second = from[i + 1] + base;
            to.push_back(mirrored ? second : first);
            to.push_back(mirrored ? first : second);
            to.push_back(from[i + 2] + base);
        }
    };
    append(made.single, single);
    append(made.double_sided, double_sided);
}

glm::dvec3 centreOf(std::span<const DrawItem> items) {
    Box3d all;
    for (const DrawItem& item : items) {
        const glm::dvec3 place(item.transform[3]);
        if (std::isfinite(place.x + place.y + place.z)) all.grow(place);
    }
    return items.empty() ? glm::dvec3(0.0) : all.center();
}

}  // namespace

struct GlFlatRenderer::State {
    explicit State(const GlContext& in) : context(in) {}
    ~State() { context.makeCurrent(); }

    const GlContext& context;
    glm::dmat4 place{1.0};                  ///< of the merged mesh in the world
    std::vector<glm::vec3> corners;         ///< of its box
    uint32_t single = 0, double_sided = 0;  ///< indices; the single-sided ones come first
    GlName vertices, indices, array, program;
    GlTarget target;

    void upload(const Merged& merged);
};

void GlFlatRenderer::State::upload(const Merged& merged) {
    place[3] = glm::dvec4(merged.anchor, 1.0);
    Box3d box;
    for (const Vertex& vertex : merged.vertices) box.grow(glm::dvec3(vertex.position));
    for (int i = 0; i < 8 && !merged.vertices.empty(); ++i)
        corners.emplace_back(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                             i & 4 ? box.max.z : box.min.z);
    single = static_cast<uint32_t>(merged.single.size());
    double_sided = static_cast<uint32_t>(merged.double_sided.size());
    std::vector<uint32_t> both = merged.single;
    both.insert(both.end(), merged.double_sided.begin(), merged.double_sided.end());
    vertices = makeGlBuffer(std::as_bytes(std::span(merged.vertices)));
    indices = makeGlBuffer(std::as_bytes(std::span(both)));
    array = makeGlVertexArray();
    glVertexArrayVertexBuffer(array.get(), 0, vertices.get(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(array.get(), indices.get());
    for (GLuint attribute = 0; attribute < 3; ++attribute) {
        glEnableVertexArrayAttrib(array.get(), attribute);
        glVertexArrayAttribBinding(array.get(), attribute, 0);
    }
    glVertexArrayAttribFormat(array.get(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribFormat(array.get(), 1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, offsetof(Vertex, normal));
    glVertexArrayAttribFormat(array.get(), 2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Vertex, colour));
}

GlFlatRenderer::GlFlatRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlFlatRenderer::GlFlatRenderer(GlFlatRenderer&&) noexcept = default;
GlFlatRenderer& GlFlatRenderer::operator=(GlFlatRenderer&&) noexcept = default;
GlFlatRenderer::~GlFlatRenderer() = default;

Result<GlFlatRenderer> GlFlatRenderer::create(const GlContext& context, const DrawList& list,
                                              std::span<const uint32_t> colours) {
    context.makeCurrent();
    auto state = std::make_unique<State>(context);
    Result<GlName> program = makeGlProgram(kVertexShader, kFragmentShader);
    if (!program) return program.error();
    state->program = std::move(*program);
    Merged merged;
    merged.anchor = centreOf(list.items());
    for (size_t i = 0; i < list.items().size(); ++i) merged.add(list, i, colours);
    state->upload(merged);
    if (const Status done = checkGl("uploading meshes"); !done) return done.error();
    return GlFlatRenderer(std::move(state));
}

Status GlFlatRenderer::draw(const View& view) {
    State& state = *state_;
    state.context.makeCurrent();
    if (state.target.width != view.width || state.target.height != view.height) {
        Result<GlTarget> target = GlTarget::create(GL_RGBA8, view.width, view.height);
        if (!target) return target.error();
        state.target = std::move(*target);
    }
    DrawItem whole;
    whole.mesh.positions = state.corners;
    whole.transform = state.place;
    const GlView gl_view = makeGlView(view, {&whole, 1});
    const glm::mat4 to_clip(gl_view.objectToClip(state.place));
    const glm::vec3 sun = glm::normalize(glm::vec3(0.4f, 0.8f, 0.45f));
    const GLfloat black[4] = {0, 0, 0, 0}, nowhere = 0.0f;
    glBindFramebuffer(GL_FRAMEBUFFER, state.target.framebuffer.get());
    glViewport(0, 0, static_cast<GLsizei>(view.width), static_cast<GLsizei>(view.height));
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_COLOR, 0, black);
    glClearBufferfv(GL_DEPTH, 0, &nowhere);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glFrontFace(gl_view.frontIsClockwise(state.place) ? GL_CW : GL_CCW);
    glCullFace(GL_BACK);
    glUseProgram(state.program.get());
    glUniformMatrix4fv(0, 1, GL_FALSE, &to_clip[0][0]);
    glUniform3fv(4, 1, &sun[0]);
    glBindVertexArray(state.array.get());
    glEnable(GL_CULL_FACE);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(state.single), GL_UNSIGNED_INT, nullptr);
    glDisable(GL_CULL_FACE);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(state.double_sided), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(size_t{state.single} * sizeof(uint32_t)));
    glFinish();
    return checkGl("drawing");
}

Result<std::vector<uint32_t>> GlFlatRenderer::read() const {
    const State& state = *state_;
    state.context.makeCurrent();
    std::vector<uint32_t> pixels(size_t{state.target.width} * state.target.height);
    if (pixels.empty()) return pixels;
    glBindFramebuffer(GL_FRAMEBUFFER, state.target.framebuffer.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, static_cast<GLsizei>(state.target.width), static_cast<GLsizei>(state.target.height), GL_RGBA,
                 GL_UNSIGNED_BYTE, pixels.data());
    if (const Status done = checkGl("reading a picture"); !done) return done.error();
    return pixels;
}

}  // namespace sightline

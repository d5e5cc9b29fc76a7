// The independent renderer's id-buffer: which surface Mesa sees at each pixel.
// SPDX-License-Identifier: MIT
#include "apps/gl/id_renderer.h"

#include <epoxy/gl.h>

#include <map>
#include <tuple>
#include <vector>

#include "apps/gl/gl_view.h"
#include "apps/gl/objects.h"
#include "apps/gl/provoking.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline {
using namespace studies;
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in uint triangle;
layout(location = 0) uniform dmat4 to_clip;
layout(location = 8) uniform uint first_surface;
flat out uint surface;
void main() {
    gl_Position = vec4(to_clip * dvec4(dvec3(position), 1.0));
    surface = first_surface + triangle;
}
)";

constexpr const char* kFragmentShader = R"(#version 450 core
flat in uint surface;
layout(location = 0) out uint shown;
void main() { shown = surface; }
)";

struct Vertex {
    glm::vec3 position;
    uint32_t triangle;
};

struct Range {
    uint32_t first = 0, count = 0;  ///< indices
};

struct MeshRange {
    Range single, double_sided;
    uint32_t base_vertex = 0;
};

using MeshKey = std::tuple<const void*, const void*, const void*, const void*>;

MeshKey keyOf(const DrawItem& item) {
    return {item.mesh.positions.data(), item.mesh.indices.data(), item.double_sided.data(), item.writes_depth.data()};
}

}  // namespace

struct GlIdRenderer::State {
    State(const GlContext& in, const DrawList& of) : context(in), list(of) {}
    ~State() { context.makeCurrent(); }

    const GlContext& context;
    const DrawList& list;
    std::vector<MeshRange> meshes;
    std::vector<uint32_t> mesh_of;  ///< per item
    GlName vertices, indices, array, program;
    GlTarget target;

    void upload();
    void drawItems(const GlView& view) const;
};

void GlIdRenderer::State::upload() {
    std::vector<Vertex> all_vertices;
    std::vector<uint32_t> all_indices;
    std::map<MeshKey, uint32_t> known;
    const auto append = [&](const std::vector<uint32_t>& more) {
        const Range range{static_cast<uint32_t>(all_indices.size()), static_cast<uint32_t>(more.size())};
        all_indices.insert(all_indices.end(), more.begin(), more.end());
        return range;
    };
    for (const DrawItem& item : list.items()) {
        const auto [found, is_new] = known.try_emplace(keyOf(item), static_cast<uint32_t>(meshes.size()));
        mesh_of.push_back(found->second);
        if (!is_new) continue;
        const ProvokingMesh made = makeProvoking(item);
        MeshRange mesh;
        mesh.base_vertex = static_cast<uint32_t>(all_vertices.size());
        mesh.single = append(made.single);
        mesh.double_sided = append(made.double_sided);
        meshes.push_back(mesh);
        for (size_t i = 0; i < made.position.size(); ++i)
            all_vertices.push_back({item.mesh.positions[made.position[i]], made.triangle[i]});
    }
    vertices = makeGlBuffer(std::as_bytes(std::span(all_vertices)));
    indices = makeGlBuffer(std::as_bytes(std::span(all_indices)));
    array = makeGlVertexArray();
    glVertexArrayVertexBuffer(array.get(), 0, vertices.get(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(array.get(), indices.get());
    for (GLuint attribute = 0; attribute < 2; ++attribute) {
        glEnableVertexArrayAttrib(array.get(), attribute);
        glVertexArrayAttribBinding(array.get(), attribute, 0);
    }
    glVertexArrayAttribFormat(array.get(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribIFormat(array.get(), 1, 1, GL_UNSIGNED_INT, offsetof(Vertex, triangle));
}

void GlIdRenderer::State::drawItems(const GlView& view) const {
    const auto draw = [](const MeshRange& mesh, const Range& range) {
        if (range.count == 0) return;
        glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                                 reinterpret_cast<const void*>(size_t{range.first} * sizeof(uint32_t)),
                                 static_cast<GLint>(mesh.base_vertex));
    };
    for (size_t i = 0; i < list.items().size(); ++i) {
        const DrawItem& item = list.items()[i];
        const MeshRange& mesh = meshes[mesh_of[i]];
        const glm::dmat4 to_clip = view.objectToClip(item.transform);
        glUniformMatrix4dv(0, 1, GL_FALSE, &to_clip[0][0]);
        glUniform1ui(8, list.firstSurface(i));
        glFrontFace(view.frontIsClockwise(item.transform) ? GL_CW : GL_CCW);
        glEnable(GL_CULL_FACE);
        draw(mesh, mesh.single);
        glDisable(GL_CULL_FACE);
        draw(mesh, mesh.double_sided);
    }
}

GlIdRenderer::GlIdRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlIdRenderer::GlIdRenderer(GlIdRenderer&&) noexcept = default;
GlIdRenderer& GlIdRenderer::operator=(GlIdRenderer&&) noexcept = default;
GlIdRenderer::~GlIdRenderer() = default;

Result<GlIdRenderer> GlIdRenderer::create(const GlContext& context, const DrawList& list) {
    context.makeCurrent();
    auto state = std::make_unique<State>(context, list);
    Result<GlName> program = makeGlProgram(kVertexShader, kFragmentShader);
    if (!program) return program.error();
    state->program = std::move(*program);
    state->upload();
    if (const Status done = checkGl("uploading meshes"); !done) return done.error();
    return GlIdRenderer(std::move(state));
}

Status GlIdRenderer::draw(const View& view) {
    State& state = *state_;
    state.context.makeCurrent();
    if (state.target.width != view.width || state.target.height != view.height) {
        Result<GlTarget> target = GlTarget::create(GL_R32UI, view.width, view.height);
        if (!target) return target.error();
        state.target = std::move(*target);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, state.target.framebuffer.get());
    glViewport(0, 0, static_cast<GLsizei>(view.width), static_cast<GLsizei>(view.height));
    const GLuint none[4] = {HiddenImage::kNone, 0, 0, 0};
    const GLfloat nowhere = 0.0f;
    glDepthMask(GL_TRUE);
    glClearBufferuiv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &nowhere);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glCullFace(GL_BACK);
    glUseProgram(state.program.get());
    glBindVertexArray(state.array.get());
    state.drawItems(makeGlView(view, state.list.items()));
    glFinish();
    return checkGl("drawing ids");
}

Result<HiddenImage> GlIdRenderer::read() const {
    const State& state = *state_;
    state.context.makeCurrent();
    HiddenImage image;
    image.width = state.target.width;
    image.height = state.target.height;
    image.surface.assign(size_t{image.width} * image.height, HiddenImage::kNone);
    if (image.surface.empty()) return image;
    glBindFramebuffer(GL_FRAMEBUFFER, state.target.framebuffer.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, static_cast<GLsizei>(image.width), static_cast<GLsizei>(image.height), GL_RED_INTEGER,
                 GL_UNSIGNED_INT, image.surface.data());
    if (const Status done = checkGl("reading ids"); !done) return done.error();
    return image;
}

}  // namespace sightline

// OpenGL's occlusion queries as OcclusionQueries wants them: items drawn with their numbers, boxes asked about.
// SPDX-License-Identifier: MIT
#include "apps/gl/queries.h"

#include <epoxy/gl.h>

#include "apps/gl/gl_view.h"
#include "apps/gl/meshes.h"
#include "sightline/cull/queries/box_mesh.h"

namespace sightline {
using namespace studies;
namespace {

constexpr const char* kItemVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 0) uniform mat4 to_clip;
void main() { gl_Position = to_clip * vec4(position, 1.0); }
)";

constexpr const char* kItemFragmentShader = R"(#version 450 core
layout(location = 4) uniform uint item;
layout(location = 0) out uint shown;
void main() { shown = item; }
)";

}  // namespace

struct GlQueryDevice::State : GlMeshes {
    State(const GlContext& in, std::span<const DrawItem> of, GLenum kind)
        : GlMeshes(in), items(of), target_kind(kind) {}

    ~State() { context.makeCurrent(); }

    std::span<const DrawItem> items;
    GLenum target_kind;
    std::vector<GlMesh> meshes;
    std::vector<uint32_t> mesh_of;  ///< per item
    GlMesh box;
    GlView view;
    std::vector<GlName> queries;  ///< by question
    bool asking = false;

    void upload();
    void place(const glm::dmat4& transform) const;
    void change(bool to_asking);
};

void GlQueryDevice::State::upload() {
    std::vector<glm::vec3> all_vertices;
    std::vector<uint32_t> all_indices;
    GlMeshNumbers known;
    for (const DrawItem& item : items) {
        mesh_of.push_back(known.of(item));
        if (mesh_of.back() < meshes.size()) continue;
        meshes.push_back(appendGlMesh(item, all_vertices, all_indices));
    }
    box.base_vertex = static_cast<uint32_t>(all_vertices.size());
    box.single = {static_cast<uint32_t>(all_indices.size()), 36};
    all_vertices.insert(all_vertices.end(), std::begin(kCubeCorners), std::end(kCubeCorners));
    all_indices.insert(all_indices.end(), std::begin(kCubeTriangles), std::end(kCubeTriangles));
    store(all_vertices, all_indices, 1);
}

void GlQueryDevice::State::place(const glm::dmat4& transform) const {
    const glm::mat4 to_clip(view.objectToClip(transform));
    glUniformMatrix4fv(0, 1, GL_FALSE, &to_clip[0][0]);
}

/// A box's sample at the depth that is there passes; an item's does not, so that of two at one depth the first is shown.
void GlQueryDevice::State::change(bool to_asking) {
    if (asking == to_asking) return;
    asking = to_asking;
    const GLboolean writes = to_asking ? GL_FALSE : GL_TRUE;
    glColorMask(writes, writes, writes, writes);
    glDepthMask(writes);
    glDepthFunc(to_asking ? GL_GEQUAL : GL_GREATER);
}

GlQueryDevice::GlQueryDevice(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlQueryDevice::GlQueryDevice(GlQueryDevice&&) noexcept = default;
GlQueryDevice& GlQueryDevice::operator=(GlQueryDevice&&) noexcept = default;
GlQueryDevice::~GlQueryDevice() = default;

Result<GlQueryDevice> GlQueryDevice::create(const GlContext& context, std::span<const DrawItem> items,
                                            GlQueryKind kind) {
    context.makeCurrent();
    auto state =
        std::make_unique<State>(context, items, kind == GlQueryKind::kAny ? GL_ANY_SAMPLES_PASSED : GL_SAMPLES_PASSED);
    if (const Status made = state->compile(kItemVertexShader, kItemFragmentShader); !made) return made.error();
    state->upload();
    if (const Status done = checkGl("uploading meshes"); !done) return done.error();
    return GlQueryDevice(std::move(state));
}

Status GlQueryDevice::beginFrame(const View& view) {
    State& state = *state_;
    state.context.makeCurrent();
    state.change(false);
    if (Status ready = state.begin(view, GL_R32UI); !ready) return ready;
    const GLuint none[4] = {kNone, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, none);
    state.view = makeGlView(view, state.items);
    return success();
}

Status GlQueryDevice::endFrame() {
    state_->context.makeCurrent();
    state_->change(false);
    glFinish();
    return checkGl("drawing items and asking about boxes");
}

void GlQueryDevice::draw(std::span<const uint32_t> items) {
    State& state = *state_;
    state.change(false);
    for (const uint32_t item : items) {
        const glm::dmat4& transform = state.items[item].transform;
        const GlMesh& mesh = state.meshes[state.mesh_of[item]];
        state.place(mesh.placed(transform));
        glUniform1ui(4, item);
        mesh.draw(state.view.frontIsClockwise(transform));
    }
}

void GlQueryDevice::ask(uint32_t question, std::span<const Box3d> boxes) {
    State& state = *state_;
    state.change(true);
    while (state.queries.size() <= question) {
        GLuint name = 0;
        glGenQueries(1, &name);
        state.queries.emplace_back(name, [](uint32_t old) { glDeleteQueries(1, &old); });
    }
    glBeginQuery(state.target_kind, state.queries[question].get());
    for (const Box3d& box : boxes) {
        const glm::dmat4 transform = cubeToBox(box);
        state.place(transform);
        state.box.draw(state.view.frontIsClockwise(transform));
    }
    glEndQuery(state.target_kind);
}

bool GlQueryDevice::hasAnswer(uint32_t question) {
    GLuint there = GL_FALSE;
    glGetQueryObjectuiv(state_->queries[question].get(), GL_QUERY_RESULT_AVAILABLE, &there);
    return there == GL_TRUE;
}

uint64_t GlQueryDevice::answer(uint32_t question) {
    GLuint64 samples = 0;
    glGetQueryObjectui64v(state_->queries[question].get(), GL_QUERY_RESULT, &samples);
    return state_->target_kind == GL_SAMPLES_PASSED || samples == 0 ? samples : ~uint64_t{0};
}

Result<std::vector<uint32_t>> GlQueryDevice::readItems() const {
    std::vector<uint32_t> items(size_t{state_->target.width} * state_->target.height);
    if (const Status done = state_->read(GL_RED_INTEGER, GL_UNSIGNED_INT, items, "reading items"); !done)
        return done.error();
    return items;
}

Result<std::vector<uint32_t>> GlQueryDevice::readDepths() const {
    std::vector<uint32_t> depths(size_t{state_->target.width} * state_->target.height);
    if (const Status done = state_->read(GL_DEPTH_COMPONENT, GL_FLOAT, depths, "reading depths"); !done)
        return done.error();
    return depths;
}

}  // namespace sightline

// The independent renderer: which surface Mesa sees at each pixel, and a flat-shaded picture to time our z-buffer against.
// SPDX-License-Identifier: MIT
#include "apps/gl/renderers.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "apps/gl/gl_view.h"
#include "apps/gl/meshes.h"
#include "apps/gl/provoking.h"
#include "sightline/math/box.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline {
using namespace studies;
namespace {

constexpr const char* kIdVertexShader = R"(#version 450 core
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

constexpr const char* kIdFragmentShader = R"(#version 450 core
flat in uint surface;
layout(location = 0) out uint shown;
void main() { shown = surface; }
)";

struct IdVertex {
    glm::vec3 position;
    uint32_t triangle;
};

constexpr const char* kFlatVertexShader = R"(#version 450 core
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

constexpr const char* kFlatFragmentShader = R"(#version 450 core
flat in vec4 colour;
layout(location = 0) out vec4 shown;
void main() { shown = colour; }
)";

struct FlatVertex {
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
    std::vector<FlatVertex> vertices;
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
        FlatVertex vertex{glm::vec3(worldOf(made.position[i])), 0, 0};
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

struct GlIdRenderer::State : GlMeshes {
    State(const GlContext& in, const DrawList& of) : GlMeshes(in), list(of) {}

    const DrawList& list;
    std::vector<GlMesh> meshes;
    std::vector<uint32_t> mesh_of;  ///< per item

    void upload();
    void drawItems(const GlView& view) const;
};

void GlIdRenderer::State::upload() {
    std::vector<IdVertex> all_vertices;
    std::vector<uint32_t> all_indices;
    GlMeshNumbers known;
    const auto append = [&](const std::vector<uint32_t>& more) {
        const GlRange range{static_cast<uint32_t>(all_indices.size()), static_cast<uint32_t>(more.size())};
        all_indices.insert(all_indices.end(), more.begin(), more.end());
        return range;
    };
    for (const DrawItem& item : list.items()) {
        mesh_of.push_back(known.of(item));
        if (mesh_of.back() < meshes.size()) continue;
        const ProvokingMesh made = makeProvoking(item);
        GlMesh mesh;
        mesh.base_vertex = static_cast<uint32_t>(all_vertices.size());
        mesh.single = append(made.single);
        mesh.double_sided = append(made.double_sided);
        meshes.push_back(mesh);
        for (size_t i = 0; i < made.position.size(); ++i)
            all_vertices.push_back({item.mesh.positions[made.position[i]], made.triangle[i]});
    }
    store(all_vertices, all_indices, 2);
    glVertexArrayAttribIFormat(array.get(), 1, 1, GL_UNSIGNED_INT, offsetof(IdVertex, triangle));
}

void GlIdRenderer::State::drawItems(const GlView& view) const {
    for (size_t i = 0; i < list.items().size(); ++i) {
        const DrawItem& item = list.items()[i];
        const GlMesh& mesh = meshes[mesh_of[i]];
        const glm::dmat4 to_clip = view.objectToClip(item.transform);
        glUniformMatrix4dv(0, 1, GL_FALSE, &to_clip[0][0]);
        glUniform1ui(8, list.firstSurface(i));
        mesh.draw(view.frontIsClockwise(item.transform));
    }
}

GlIdRenderer::GlIdRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlIdRenderer::GlIdRenderer(GlIdRenderer&&) noexcept = default;
GlIdRenderer& GlIdRenderer::operator=(GlIdRenderer&&) noexcept = default;
GlIdRenderer::~GlIdRenderer() = default;

Result<GlIdRenderer> GlIdRenderer::create(const GlContext& context, const DrawList& list) {
    context.makeCurrent();
    auto state = std::make_unique<State>(context, list);
    if (const Status made = state->compile(kIdVertexShader, kIdFragmentShader); !made) return made.error();
    state->upload();
    if (const Status done = checkGl("uploading meshes"); !done) return done.error();
    return GlIdRenderer(std::move(state));
}

Status GlIdRenderer::draw(const View& view) {
    State& state = *state_;
    if (Status ready = state.begin(view, GL_R32UI); !ready) return ready;
    const GLuint none[4] = {HiddenImage::kNone, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, none);
    state.drawItems(makeGlView(view, state.list.items()));
    glFinish();
    return checkGl("drawing ids");
}

Result<HiddenImage> GlIdRenderer::read() const {
    const GlTarget& target = state_->target;
    HiddenImage image;
    image.width = target.width;
    image.height = target.height;
    image.surface.assign(size_t{image.width} * image.height, HiddenImage::kNone);
    if (const Status done = state_->read(GL_RED_INTEGER, GL_UNSIGNED_INT, image.surface, "reading ids"); !done)
        return done.error();
    return image;
}

struct GlFlatRenderer::State : GlMeshes {
    using GlMeshes::GlMeshes;

    glm::dmat4 place{1.0};                  ///< of the merged mesh in the world
    std::vector<glm::vec3> corners;         ///< of its box
    uint32_t single = 0, double_sided = 0;  ///< indices; the single-sided ones come first

    void upload(const Merged& merged);
};

void GlFlatRenderer::State::upload(const Merged& merged) {
    place[3] = glm::dvec4(merged.anchor, 1.0);
    Box3d box;
    for (const FlatVertex& vertex : merged.vertices) box.grow(glm::dvec3(vertex.position));
    for (int i = 0; i < 8 && !merged.vertices.empty(); ++i)
        corners.emplace_back(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                             i & 4 ? box.max.z : box.min.z);
    single = static_cast<uint32_t>(merged.single.size());
    double_sided = static_cast<uint32_t>(merged.double_sided.size());
    std::vector<uint32_t> both = merged.single;
    both.insert(both.end(), merged.double_sided.begin(), merged.double_sided.end());
    store(merged.vertices, both, 3);
    glVertexArrayAttribFormat(array.get(), 1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, offsetof(FlatVertex, normal));
    glVertexArrayAttribFormat(array.get(), 2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(FlatVertex, colour));
}

GlFlatRenderer::GlFlatRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlFlatRenderer::GlFlatRenderer(GlFlatRenderer&&) noexcept = default;
GlFlatRenderer& GlFlatRenderer::operator=(GlFlatRenderer&&) noexcept = default;
GlFlatRenderer::~GlFlatRenderer() = default;

Result<GlFlatRenderer> GlFlatRenderer::create(const GlContext& context, const DrawList& list,
                                              std::span<const uint32_t> colours) {
    context.makeCurrent();
    auto state = std::make_unique<State>(context);
    if (const Status made = state->compile(kFlatVertexShader, kFlatFragmentShader); !made) return made.error();
    Merged merged;
    merged.anchor = centreOf(list.items());
    for (size_t i = 0; i < list.items().size(); ++i) merged.add(list, i, colours);
    state->upload(merged);
    if (const Status done = checkGl("uploading meshes"); !done) return done.error();
    return GlFlatRenderer(std::move(state));
}

Status GlFlatRenderer::draw(const View& view) {
    State& state = *state_;
    if (Status ready = state.begin(view, GL_RGBA8); !ready) return ready;
    DrawItem whole;
    whole.mesh.positions = state.corners;
    whole.transform = state.place;
    const GlView gl_view = makeGlView(view, {&whole, 1});
    const glm::mat4 to_clip(gl_view.objectToClip(state.place));
    const glm::vec3 sun = glm::normalize(glm::vec3(0.4f, 0.8f, 0.45f));
    const GLfloat black[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, black);
    glFrontFace(gl_view.frontIsClockwise(state.place) ? GL_CW : GL_CCW);
    glUniformMatrix4fv(0, 1, GL_FALSE, &to_clip[0][0]);
    glUniform3fv(4, 1, &sun[0]);
    glEnable(GL_CULL_FACE);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(state.single), GL_UNSIGNED_INT, nullptr);
    glDisable(GL_CULL_FACE);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(state.double_sided), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(size_t{state.single} * sizeof(uint32_t)));
    glFinish();
    return checkGl("drawing");
}

Result<std::vector<uint32_t>> GlFlatRenderer::read() const {
    const GlTarget& target = state_->target;
    std::vector<uint32_t> pixels(size_t{target.width} * target.height);
    if (const Status done = state_->read(GL_RGBA, GL_UNSIGNED_BYTE, pixels, "reading a picture"); !done)
        return done.error();
    return pixels;
}

}  // namespace sightline

// Draws a scene's objects with the GL: lit, tinted, see-through, or their numbers.
// SPDX-License-Identifier: MIT
#include "apps/viewer/scene_drawer.h"

#include <algorithm>

#include "sightline/tools/report/pictures/scene_look.h"

namespace sightline::viewer {
using namespace tools;
namespace {

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 to_clip;
uniform mat4 to_world;  // relative to the eye
uniform vec4 sections[8];
out vec3 place;
out float gl_ClipDistance[8];
void main() {
    place = (to_world * vec4(position, 1.0)).xyz;
    gl_Position = to_clip * vec4(position, 1.0);
    for (int i = 0; i < 8; ++i) gl_ClipDistance[i] = dot(sections[i], vec4(place, 1.0));
}
)";

constexpr const char* kFragmentShader = R"(#version 330 core
in vec3 place;
uniform vec3 base;
uniform float opacity;
out vec4 shown;
void main() {
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
    vec3 to_eye = normalize(-place);
    if (dot(normal, to_eye) < 0.0) normal = -normal;
    float sun = max(dot(normal, normalize(vec3(0.4, 0.8, 0.45))), 0.0), head = dot(normal, to_eye);
    vec3 lit = base * (0.28 + 0.5 * sun + 0.3 * head);
    shown = vec4(pow(clamp(lit, 0.0, 1.0), vec3(1.0 / 2.2)), opacity);
}
)";

constexpr const char* kNumberFragmentShader = R"(#version 330 core
in vec3 place;
uniform uint number;
out vec4 shown;
void main() {
    uint n = number + 1u;
    shown = vec4(float(n & 255u), float(n >> 8 & 255u), float(n >> 16 & 255u), float(n >> 24 & 255u)) / 255.0;
}
)";

constexpr float kGlass = 0.35f;  // opacity of what is not solid

bool hasClipControl() {
    static const bool has = epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control");
    return has;
}

void setSections(GLint at, const GlView& view, std::span<const glm::dvec4> sections) {
    glm::vec4 planes[8];
    for (size_t i = 0; i < 8; ++i) {
        planes[i] = glm::vec4(0, 0, 0, 1);  // everything is inside
        if (i >= sections.size()) continue;
        const glm::dvec4& plane = sections[i];
        planes[i] = glm::vec4(glm::vec3(plane), static_cast<float>(plane.w + glm::dot(glm::dvec3(plane), view.eye)));
    }
    glUniform4fv(at, 8, &planes[0][0]);
    for (GLenum i = 0; i < 8; ++i) {
        if (i < sections.size()) glEnable(GL_CLIP_DISTANCE0 + i);
        else glDisable(GL_CLIP_DISTANCE0 + i);
    }
}

}  // namespace

void setDepth(bool writes) {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(writes ? GL_TRUE : GL_FALSE);
    if (hasClipControl()) glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDepthFunc(hasClipControl() ? GL_GEQUAL : GL_LEQUAL);
    glClearDepth(hasClipControl() ? 0.0 : 1.0);
}

glm::dmat4 toClipOf(const GlView& view, const glm::dmat4& transform) {
    glm::dmat4 to_clip = view.objectToClip(transform);
    if (hasClipControl()) return to_clip;
    for (int column = 0; column < 4; ++column) to_clip[column][2] = to_clip[column][3] - 2.0 * to_clip[column][2];
    return to_clip;
}

Result<SceneDrawer> SceneDrawer::create(const Scene& scene, const ClusterOrder& clusters) {
    SceneDrawer drawer;
    drawer.scene_ = &scene;
    Result<GlName> program = makeGlProgram(kVertexShader, kFragmentShader);
    if (!program) return program.error();
    Result<GlName> numbers = makeGlProgram(kVertexShader, kNumberFragmentShader);
    if (!numbers) return numbers.error();
    drawer.program_ = std::move(*program);
    drawer.number_program_ = std::move(*numbers);
    const auto uniform = [](const GlName& of, const char* name) { return glGetUniformLocation(of.get(), name); };
    drawer.to_clip_ = uniform(drawer.program_, "to_clip");
    drawer.to_world_ = uniform(drawer.program_, "to_world");
    drawer.base_ = uniform(drawer.program_, "base");
    drawer.opacity_ = uniform(drawer.program_, "opacity");
    drawer.sections_ = uniform(drawer.program_, "sections");
    drawer.number_to_clip_ = uniform(drawer.number_program_, "to_clip");
    drawer.number_to_world_ = uniform(drawer.number_program_, "to_world");
    drawer.number_sections_ = uniform(drawer.number_program_, "sections");
    drawer.number_ = uniform(drawer.number_program_, "number");

    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (const Mesh& mesh : scene.meshes) {
        Held held;
        held.base_vertex = static_cast<uint32_t>(positions.size());
        const auto addLevel = [&](std::span<const Primitive> primitives, std::span<const uint32_t> of) {
            const auto first = static_cast<uint32_t>(indices.size());
            std::vector<Range>& ranges = held.levels.emplace_back();
            for (const Primitive& primitive : primitives)
                if (primitive.triangle_count > 0)
                    ranges.push_back({first + 3 * primitive.first_triangle, 3 * primitive.triangle_count,
                                      scene.materials[primitive.material].double_sided, primitive.material});
            indices.insert(indices.end(), of.begin(), of.end());
        };
        addLevel(mesh.primitives, mesh.indices);
        for (const MeshLod& lod : mesh.lods) addLevel(lod.primitives, lod.indices);
        held.clusters = static_cast<uint32_t>(indices.size());
        for (const uint32_t triangle : clusters(static_cast<uint32_t>(drawer.meshes_.size())))
            indices.insert(indices.end(), mesh.indices.begin() + 3 * std::ptrdiff_t{triangle},
                           mesh.indices.begin() + 3 * std::ptrdiff_t{triangle} + 3);
        positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
        drawer.meshes_.push_back(std::move(held));
    }
    drawer.array_ = makeArray();
    glBindVertexArray(drawer.array_.get());
    drawer.vertices_ = makeBuffer(GL_ARRAY_BUFFER, std::as_bytes(std::span(positions)), GL_STATIC_DRAW);
    drawer.indices_ = makeBuffer(GL_ELEMENT_ARRAY_BUFFER, std::as_bytes(std::span(indices)), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    glBindVertexArray(0);
    if (const Status done = checkGl("uploading the scene"); !done) return done.error();
    return drawer;
}

void SceneDrawer::begin(const GlView& view, std::span<const glm::dvec4> sections) {
    view_ = view;
    numbers_ = false;
    triangles_ = 0;
    glUseProgram(program_.get());
    glBindVertexArray(array_.get());
    setSections(sections_, view, sections);
    setDepth(true);
}

void SceneDrawer::beginNumbers(const GlView& view, std::span<const glm::dvec4> sections) {
    view_ = view;
    numbers_ = true;
    glUseProgram(number_program_.get());
    glBindVertexArray(array_.get());
    setSections(number_sections_, view, sections);
    setDepth(true);
    glDisable(GL_BLEND);
}

/// Where an object is, and how its fronts turn in the image.
void SceneDrawer::place(uint32_t object) {
    const glm::dmat4& transform = scene_->objects[object].transform;
    const glm::mat4 to_clip(toClipOf(view_, transform));
    glm::dmat4 from_eye = transform;
    from_eye[3] -= glm::dvec4(view_.eye, 0.0);
    const glm::mat4 to_world(from_eye);
    glUniformMatrix4fv(numbers_ ? number_to_clip_ : to_clip_, 1, GL_FALSE, &to_clip[0][0]);
    glUniformMatrix4fv(numbers_ ? number_to_world_ : to_world_, 1, GL_FALSE, &to_world[0][0]);
    glFrontFace(view_.frontIsClockwise(transform) ? GL_CW : GL_CCW);
}

void SceneDrawer::drawRange(const Held& mesh, const Range& range) const {
    if (range.double_sided) glDisable(GL_CULL_FACE);
    else glEnable(GL_CULL_FACE);
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                             reinterpret_cast<const void*>(size_t{range.first} * sizeof(uint32_t)),
                             static_cast<GLint>(mesh.base_vertex));
}

/// What of an object is drawn.
std::span<const SceneDrawer::Range> SceneDrawer::rangesOf(uint32_t object, uint8_t level,
                                                          std::span<const DrawRange> runs) {
    const uint32_t mesh = scene_->objects[object].mesh;
    if (runs.empty()) return meshes_[mesh].rangesOf(level);
    runs_.clear();
    for (const DrawRange& run : runs) {
        const uint32_t material = scene_->meshes[mesh].primitives[run.part].material;
        runs_.push_back({meshes_[mesh].clusters + 3 * run.first, 3 * run.count,
                         scene_->materials[material].double_sided, material});
    }
    return runs_;
}

void SceneDrawer::draw(uint32_t object, const Paint& paint, uint8_t level, std::span<const DrawRange> runs) {
    const SceneObject& of = scene_->objects[object];
    const Held& mesh = meshes_[of.mesh];
    place(object);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    for (const Range& range : rangesOf(object, level, runs)) {
        const bool solid = isSolid(scene_->materials[range.material]);
        const float opacity = solid ? paint.opacity : std::min(paint.opacity, kGlass);
        if (opacity < 1) glEnable(GL_BLEND);
        else glDisable(GL_BLEND);
        glDepthMask(opacity < 1 ? GL_FALSE : GL_TRUE);
        const glm::vec3 own(colourOf(*scene_, of, {.material = range.material})),
            base = glm::mix(own, paint.tint, paint.tinted);
        glUniform1f(opacity_, opacity);
        glUniform3fv(base_, 1, &base[0]);
        drawRange(mesh, range);
        triangles_ += range.count / 3;
    }
}

void SceneDrawer::drawNumber(uint32_t object, uint8_t level, std::span<const DrawRange> runs) {
    place(object);
    glUniform1ui(number_, object);
    for (const Range& range : rangesOf(object, level, runs)) drawRange(meshes_[scene_->objects[object].mesh], range);
}

}  // namespace sightline::viewer

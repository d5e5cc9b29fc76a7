// Lines, boxes and flat faces in the world: frusta, portals, bounds, shut doors; lines are faint behind something.
// SPDX-License-Identifier: MIT
#include "apps/viewer/line_drawer.h"

#include "apps/viewer/scene_drawer.h"

namespace sightline::viewer {
namespace {

constexpr const char* kFragmentShader = R"(#version 330 core
flat in vec3 ink;
uniform float opacity;
out vec4 shown;
void main() { shown = vec4(ink, opacity); }
)";

}  // namespace

Result<LineDrawer> LineDrawer::create() {
    LineDrawer drawer;
    Result<GlName> program = makeGlProgram(kInkVertexShader, kFragmentShader);
    if (!program) return program.error();
    drawer.program_ = std::move(*program);
    drawer.to_clip_ = glGetUniformLocation(drawer.program_.get(), "to_clip");
    drawer.opacity_ = glGetUniformLocation(drawer.program_.get(), "opacity");
    drawer.array_ = makeArray();
    glBindVertexArray(drawer.array_.get());
    drawer.buffer_ = makeBuffer(GL_ARRAY_BUFFER, {}, GL_STREAM_DRAW);
    for (const GLuint attribute : {0u, 1u}) {
        glEnableVertexAttribArray(attribute);
        glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                              reinterpret_cast<const void*>(attribute * sizeof(glm::vec3)));
    }
    glBindVertexArray(0);
    return drawer;
}

void LineDrawer::line(const glm::dvec3& from, const glm::dvec3& to, const glm::vec3& colour) {
    lines_.push_back({from, to, colour});
    changed_ = true;
}

void LineDrawer::hexahedron(const glm::dvec3 (&corners)[8], const glm::vec3& colour) {
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            if ((corner >> axis & 1) == 0) line(corners[corner], corners[corner | 1 << axis], colour);
}

void LineDrawer::box(const Box3d& box, const glm::vec3& colour) {
    glm::dvec3 corners[8];
    for (int i = 0; i < 8; ++i)
        corners[i] = {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z};
    hexahedron(corners, colour);
}

void LineDrawer::outline(std::span<const glm::dvec3> points, const glm::vec3& colour) {
    for (size_t i = 0; i < points.size(); ++i) line(points[i], points[(i + 1) % points.size()], colour);
}

void LineDrawer::face(std::span<const glm::dvec3> points, const glm::vec3& colour) {
    for (size_t i = 2; i < points.size(); ++i)
        for (const size_t corner : {size_t{0}, i - 1, i}) faces_.push_back({points[corner], colour});
    changed_ = true;
}

void LineDrawer::draw(const GlView& view, float behind) {
    if (lines_.empty() && faces_.empty()) return;
    glUseProgram(program_.get());
    glBindVertexArray(array_.get());
    if (changed_) {
        vertices_.clear();
        origin_ = lines_.empty() ? faces_.front().place : lines_.front().from;
        for (const Line& line : lines_) {
            vertices_.push_back({glm::vec3(line.from - origin_), line.colour});
            vertices_.push_back({glm::vec3(line.to - origin_), line.colour});
        }
        for (const Corner& corner : faces_) vertices_.push_back({glm::vec3(corner.place - origin_), corner.colour});
        glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(Vertex)), vertices_.data(),
                     GL_STREAM_DRAW);
        changed_ = false;
    }
    glm::dmat4 from_origin(1.0);
    from_origin[3] = glm::dvec4(origin_, 1.0);
    const glm::mat4 to_clip(toClipOf(view, from_origin));
    glUniformMatrix4fv(to_clip_, 1, GL_FALSE, &to_clip[0][0]);
    for (GLenum i = 0; i < 8; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
    const auto count = static_cast<GLsizei>(2 * lines_.size());
    if (!faces_.empty()) {
        setDepth(true);
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        glUniform1f(opacity_, 1.0f);
        glDrawArrays(GL_TRIANGLES, count, static_cast<GLsizei>(faces_.size()));
    }
    if (lines_.empty()) return;
    setDepth(false);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (behind > 0) {
        glDisable(GL_DEPTH_TEST);
        glUniform1f(opacity_, behind);
        glDrawArrays(GL_LINES, 0, count);
        glEnable(GL_DEPTH_TEST);
    }
    glUniform1f(opacity_, 1.0f);
    glDrawArrays(GL_LINES, 0, count);
}

}  // namespace sightline::viewer

// Meshes of many items in one array of the GL, and what draws from it into an image.
// SPDX-License-Identifier: MIT
#include "apps/gl/meshes.h"

#include "sightline/math/box.h"

namespace sightline {

void GlMesh::draw(bool clockwise) const {
    const auto drawRange = [&](const GlRange& range) {
        if (range.count == 0) return;
        glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                                 reinterpret_cast<const void*>(size_t{range.first} * sizeof(uint32_t)),
                                 static_cast<GLint>(base_vertex));
    };
    glFrontFace(clockwise ? GL_CW : GL_CCW);
    glEnable(GL_CULL_FACE);
    drawRange(single);
    glDisable(GL_CULL_FACE);
    drawRange(double_sided);
}

GlMesh appendGlMesh(const studies::DrawItem& item, std::vector<glm::vec3>& positions, std::vector<uint32_t>& indices) {
    GlMesh mesh;
    mesh.base_vertex = static_cast<uint32_t>(positions.size());
    Box3f box;
    for (const glm::vec3& position : item.mesh.positions) box.grow(position);
    if (box.finite()) mesh.middle = box.center();
    for (const glm::vec3& position : item.mesh.positions) positions.push_back(position - mesh.middle);
    for (const bool both : {false, true}) {
        GlRange& range = both ? mesh.double_sided : mesh.single;
        range.first = static_cast<uint32_t>(indices.size());
        for (size_t t = 0; t < item.mesh.triangles(); ++t) {
            if (!item.writes_depth.empty() && item.writes_depth[t] == 0) continue;
            if ((!item.double_sided.empty() && item.double_sided[t] != 0) != both) continue;
            indices.insert(indices.end(), item.mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * t),
                           item.mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
        }
        range.count = static_cast<uint32_t>(indices.size()) - range.first;
    }
    return mesh;
}

Status GlMeshes::compile(const char* vertex_shader, const char* fragment_shader) {
    Result<GlName> made = makeGlProgram(vertex_shader, fragment_shader);
    if (!made) return made.error();
    program = std::move(*made);
    return success();
}

void GlMeshes::store(std::span<const std::byte> bytes, size_t vertex_size, std::span<const uint32_t> all_indices,
                     GLuint attributes) {
    vertices = makeGlBuffer(bytes);
    indices = makeGlBuffer(std::as_bytes(all_indices));
    array = makeGlVertexArray();
    glVertexArrayVertexBuffer(array.get(), 0, vertices.get(), 0, static_cast<GLsizei>(vertex_size));
    glVertexArrayElementBuffer(array.get(), indices.get());
    for (GLuint attribute = 0; attribute < attributes; ++attribute) {
        glEnableVertexArrayAttrib(array.get(), attribute);
        glVertexArrayAttribBinding(array.get(), attribute, 0);
    }
    glVertexArrayAttribFormat(array.get(), 0, 3, GL_FLOAT, GL_FALSE, 0);
}

Status GlMeshes::begin(const View& view, GLenum colour_format) {
    context.makeCurrent();
    if (target.width != view.width || target.height != view.height) {
        Result<GlTarget> made = GlTarget::create(colour_format, view.width, view.height);
        if (!made) return made.error();
        target = std::move(*made);
    }
    const GLfloat nowhere = 0.0f;
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
    glViewport(0, 0, static_cast<GLsizei>(view.width), static_cast<GLsizei>(view.height));
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_DEPTH, 0, &nowhere);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glCullFace(GL_BACK);
    glUseProgram(program.get());
    glBindVertexArray(array.get());
    return success();
}

Status GlMeshes::read(GLenum format, GLenum type, std::vector<uint32_t>& pixels, const char* during) const {
    if (pixels.empty()) return success();
    context.makeCurrent();
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, static_cast<GLsizei>(target.width), static_cast<GLsizei>(target.height), format, type,
                 pixels.data());
    return checkGl(during);
}

}  // namespace sightline

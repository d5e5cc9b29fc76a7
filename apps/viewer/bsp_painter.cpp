// A scene in the order of a BSP tree: its pieces drawn one over the other, farthest first, without a depth buffer.
// SPDX-License-Identifier: MIT
#include "apps/viewer/bsp_painter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "apps/viewer/scene_drawer.h"
#include "sightline/tools/report/pictures/scene_look.h"

namespace sightline::viewer {
using namespace tools;
namespace {

constexpr const char* kFragmentShader = R"(#version 330 core
flat in vec3 ink;
out vec4 shown;
void main() { shown = vec4(pow(clamp(ink, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0); }
)";

constexpr glm::dvec3 kLight(0.4, 0.8, 0.45);

struct Vertex {
    glm::vec3 place, colour;
};

}  // namespace

Result<std::unique_ptr<BspPainter>> BspPainter::create(const Scene& scene) {
    if (const uint64_t triangles = drawnTriangles(scene); triangles > kMostTriangles)
        return Error{Error::Kind::kUsage, "the scene has " + std::to_string(triangles) +
                                              " triangles, and a tree is made of " + std::to_string(kMostTriangles) +
                                              " at most"};
    std::unique_ptr<BspPainter> made(new BspPainter(scene));
    if (const Status ready = made->prepare(); !ready) return ready.error();
    return made;
}

Status BspPainter::prepare() {
    const DrawList& list = list_.list();
    scene_ = buildBspScene(list);
    const BspTree& tree = scene_.tree;
    if (list_.bounds().finite()) origin_ = list_.bounds().center();
    std::vector<Vertex> vertices;
    fans_.resize(tree.pieces.size());
    for (const BspNode& node : tree.nodes) {
        const glm::dvec3 normal(node.plane);
        const double light = 0.35 + 0.65 * std::abs(glm::dot(normal, glm::normalize(kLight)));
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            const BspPiece& piece = tree.pieces[i];
            const DrawList::Place of = list.placeOf(piece.number);
            const std::span<const uint8_t> sides = list.items()[of.item].double_sided;
            fans_[i] = {static_cast<uint32_t>(vertices.size()), piece.count, !sides.empty() && sides[of.triangle] != 0};
            const glm::vec3 colour(light * list_.colourOf(of.item, of.triangle));
            for (const glm::dvec3& point : tree.outline(piece))
                vertices.push_back({glm::vec3(point - origin_), colour});
        }
    }
    Result<GlName> program = makeGlProgram(kInkVertexShader, kFragmentShader);
    if (!program) return program.error();
    program_ = std::move(*program);
    to_clip_ = glGetUniformLocation(program_.get(), "to_clip");
    array_ = makeArray();
    glBindVertexArray(array_.get());
    vertices_ = makeBuffer(GL_ARRAY_BUFFER, std::as_bytes(std::span(vertices)), GL_STATIC_DRAW);
    indices_ = makeBuffer(GL_ELEMENT_ARRAY_BUFFER, {}, GL_STREAM_DRAW);
    for (const GLuint attribute : {0u, 1u}) {
        glEnableVertexAttribArray(attribute);
        glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                              reinterpret_cast<const void*>(attribute * sizeof(glm::vec3)));
    }
    glBindVertexArray(0);
    return checkGl("uploading a BSP tree");
}

/// Walks the tree for a view, and uploads what it sees in that order.
void BspPainter::sort(const View& view) {
    const glm::dvec4 eye = isOrthographic(view)
                               ? bspParallelEye(-glm::dvec3(view.view[0][2], view.view[1][2], view.view[2][2]))
                               : bspEye(eyePosition(view));
    order_.clear();
    end_.clear();
    std::vector<uint32_t> indices;
    const BspTree& tree = scene_.tree;
    walkBackToFront(
        BspStatic{tree}, eye, stack_, [&](uint32_t node) { return mayBeInView(clip_, tree.bounds[node]); },
        [&](uint32_t at) {
            const BspNode& node = tree.nodes[at];
            const bool in_front = glm::dot(node.plane, eye) >= 0;
            // Of several in one plane the first is seen, as a depth buffer has it: it is painted last.
            for (uint32_t i = node.first + node.count; i-- > node.first;) {
                const Fan& fan = fans_[i];
                if (!fan.double_sided && in_front == tree.pieces[i].opposite) continue;
                for (uint32_t k = 2; k < fan.count; ++k)
                    indices.insert(indices.end(), {fan.first_vertex, fan.first_vertex + k - 1, fan.first_vertex + k});
                order_.push_back(i);
                end_.push_back(indices.size());
            }
        });
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(uint32_t)), indices.data(),
                 GL_STREAM_DRAW);
}

void BspPainter::draw(const View& view, const GlView& gl_view, double part) {
    glUseProgram(program_.get());
    glBindVertexArray(array_.get());
    if (const glm::dmat4 clip = view.projection * view.view; clip != clip_) {
        clip_ = clip;
        sort(view);
    }
    drawn_ = static_cast<size_t>(std::llround(std::clamp(part, 0.0, 1.0) * static_cast<double>(order_.size())));
    if (drawn_ == 0) return;
    glm::dmat4 from_origin(1.0);
    from_origin[3] = glm::dvec4(origin_, 1.0);
    const glm::mat4 to_clip(toClipOf(gl_view, from_origin));
    glUniformMatrix4fv(to_clip_, 1, GL_FALSE, &to_clip[0][0]);
    for (GLenum i = 0; i < 8; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
    setDepth(true);
    glDepthFunc(GL_ALWAYS);  // the order alone decides; the depths are for the lines over it
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(end_[drawn_ - 1]), GL_UNSIGNED_INT, nullptr);
    setDepth(true);
}

}  // namespace sightline::viewer

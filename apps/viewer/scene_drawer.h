// Draws a scene's objects with the GL: lit, tinted, see-through, or their numbers.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "apps/gl/gl_view.h"
#include "apps/viewer/gl_objects.h"
#include "sightline/frame/draw_range.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::viewer {

/// How an object looks.
struct Paint {
    glm::vec3 tint{1.0f};
    float tinted = 0;   ///< how much of its colour is the tint's  [0 to 1]
    float opacity = 1;  ///< below 1 it is blended, and hides nothing
};

/// All meshes lie in one buffer. Faces are lit by a sun and by the eye, by their planes: no normals are needed, so that
/// every scene looks alike.
class SceneDrawer {
public:
    /// The order of a mesh's triangles that its clusters are runs of; empty: it has none.
    using ClusterOrder = std::function<std::span<const uint32_t>(uint32_t mesh)>;

    /// @param scene  must outlive it
    static Result<SceneDrawer> create(const tools::Scene& scene, const ClusterOrder& clusters);

    /// @param sections  of the world: what is outside of one is cut away  [size: <= ViewPlanes::kMost]
    void begin(const GlView& view, std::span<const glm::dvec4> sections);
    /// @param level  of detail: 0 is the finest, and stands in for what the mesh has not
    /// @param runs   of its clusters; none: all of it
    void draw(uint32_t object, const Paint& paint, uint8_t level = 0, std::span<const DrawRange> runs = {});
    /// Instead of begin() and draw(): colours that are the numbers of objects, plus 1.
    void beginNumbers(const GlView& view, std::span<const glm::dvec4> sections);
    void drawNumber(uint32_t object, uint8_t level = 0, std::span<const DrawRange> runs = {});
    uint64_t triangles() const { return triangles_; }  ///< drawn since begin()

private:
    struct Range {
        uint32_t first = 0, count = 0;  ///< indices
        bool double_sided = false;
        uint32_t material = 0;
    };
    struct Held {
        std::vector<std::vector<Range>> levels;  ///< finest first
        uint32_t base_vertex = 0;
        uint32_t clusters = 0;  ///< where the indices begin in their order

        const std::vector<Range>& rangesOf(uint8_t level) const { return levels[level < levels.size() ? level : 0]; }
    };

    void place(uint32_t object);
    std::span<const Range> rangesOf(uint32_t object, uint8_t level, std::span<const DrawRange> runs);
    void drawRange(const Held& mesh, const Range& range) const;

    const tools::Scene* scene_ = nullptr;
    GlName vertices_, indices_, array_, program_, number_program_;
    std::vector<Held> meshes_;
    GlView view_;
    GLint to_clip_ = -1, to_world_ = -1, base_ = -1, opacity_ = -1, sections_ = -1, number_ = -1;
    GLint number_to_clip_ = -1, number_to_world_ = -1, number_sections_ = -1;
    std::vector<Range> runs_;  ///< of the object that is drawn
    bool numbers_ = false;
    uint64_t triangles_ = 0;
};

/// Reversed depth where the GL has glClipControl(); else its own, which sees less far.
void setDepth(bool writes);
/// The matrix for it.
glm::dmat4 toClipOf(const GlView& view, const glm::dmat4& transform);

}  // namespace sightline::viewer

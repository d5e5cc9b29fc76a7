// Lines, boxes and flat faces in the world: frusta, portals, bounds, shut doors; lines are faint behind something.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "apps/gl/gl_view.h"
#include "apps/viewer/gl_objects.h"
#include "sightline/math/box.h"

namespace sightline::viewer {

class LineDrawer {
public:
    static Result<LineDrawer> create();

    void clear() {
        lines_.clear();
        faces_.clear();
        changed_ = true;
    }
    void line(const glm::dvec3& from, const glm::dvec3& to, const glm::vec3& colour);
    void box(const Box3d& box, const glm::vec3& colour);
    /// The twelve edges between corners that are numbered as a box's are: bit k is the side on axis k.
    void hexahedron(const glm::dvec3 (&corners)[8], const glm::vec3& colour);
    /// A closed outline.
    void outline(std::span<const glm::dvec3> points, const glm::vec3& colour);
    /// A flat, convex face, solid from both sides.
    void face(std::span<const glm::dvec3> points, const glm::vec3& colour);
    size_t count() const { return lines_.size(); }

    /// @param behind  opacity of what is behind something  [0 to 1]
    void draw(const GlView& view, float behind);

private:
    struct Line {
        glm::dvec3 from, to;
        glm::vec3 colour;
    };
    struct Vertex {
        glm::vec3 place, colour;
    };

    struct Corner {
        glm::dvec3 place;
        glm::vec3 colour;
    };

    std::vector<Line> lines_;
    std::vector<Corner> faces_;  ///< three for a triangle
    std::vector<Vertex> vertices_;
    glm::dvec3 origin_{0.0};  ///< that uploaded places are relative to
    bool changed_ = true;
    GlName buffer_, array_, program_;
    GLint to_clip_ = -1, opacity_ = -1;
};

}  // namespace sightline::viewer

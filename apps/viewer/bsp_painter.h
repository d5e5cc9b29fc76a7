// A scene in the order of a BSP tree: its pieces drawn one over the other, farthest first, without a depth buffer.
// SPDX-License-Identifier: MIT
//
// Henry Fuchs, Zvi Kedem, Bruce Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "apps/gl/gl_view.h"
#include "apps/viewer/gl_objects.h"
#include "sightline/bsp/bsp_walk.h"
#include "sightline/studies/hidden/bsp/bsp_frame.h"
#include "sightline/tools/report/pictures/render_list.h"

namespace sightline::viewer {

class BspPainter {
public:
    static constexpr uint32_t kMostTriangles = 200'000;  ///< a larger tree takes many seconds

    /// Builds the tree of what is solid, as it stands.
    /// @param scene  must outlive it
    /// Errors: more triangles than that; of the GL.
    static Result<std::unique_ptr<BspPainter>> create(const tools::Scene& scene);

    /// Draws the first pieces of the order that the view's eye sees them in. Backs of single-sided ones have no place in it,
    /// nor has most of what lies outside of the view.
    /// @param part  of the pieces  [0 to 1]
    void draw(const View& view, const GlView& gl_view, double part);
    size_t pieces() const { return order_.size(); }  ///< in the order
    size_t drawn() const { return drawn_; }
    size_t triangles() const { return drawn_ == 0 ? 0 : end_[drawn_ - 1] / 3; }  ///< drawn

private:
    /// A piece as a fan of triangles.
    struct Fan {
        uint32_t first_vertex = 0, count = 0;
        bool double_sided = false;
    };

    explicit BspPainter(const tools::Scene& scene) : list_(scene) {}
    Status prepare();
    void sort(const View& view);

    tools::RenderList list_;
    studies::BspScene scene_;
    std::vector<Fan> fans_;        ///< per piece of the tree
    std::vector<uint32_t> order_;  ///< pieces
    std::vector<size_t> end_;      ///< per piece of the order: of its indices
    BspStack stack_;
    glm::dmat4 clip_{0.0};  ///< of the view that the order is of; 0: of none
    glm::dvec3 origin_{0.0};
    size_t drawn_ = 0;
    GlName vertices_, indices_, array_, program_;
    GLint to_clip_ = -1;
};

}  // namespace sightline::viewer

// A scene as hidden-surface methods take it: what may be in view, one item an object, and what casts shadows on it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {
using namespace studies;

/// The scene must outlive it. Objects whose bounds or transform are not finite are not drawn; deforming ones stand in
/// their rest pose. Only solid surfaces (isSolid()) are drawn. An item's id is its object's index.
class RenderList {
public:
    RenderList(const Scene& scene, const View& view);
    /// Of all objects, for many views.
    explicit RenderList(const Scene& scene);
    RenderList(const RenderList&) = delete;
    RenderList& operator=(const RenderList&) = delete;

    const Scene& scene() const { return scene_; }
    const DrawList& list() const { return list_; }                  ///< of the objects that may be in view, or all
    std::span<const DrawItem> casters() const { return casters_; }  ///< all objects: shadows come from outside, too
    const Box3d& bounds() const { return bounds_; }                 ///< of the scene, as far as it is finite

    uint64_t keyOf(uint32_t surface) const { return scene_.objects[list_.idOf(surface)].key; }
    glm::dvec3 colourOf(uint32_t item, uint32_t triangle) const;

private:
    struct Flags {
        std::vector<uint8_t> double_sided, solid;  // per triangle
    };
    std::vector<DrawItem> chooseItems(const View* view);

    const Scene& scene_;
    std::vector<Flags> flags_;  // per mesh
    std::vector<DrawItem> casters_, items_;
    DrawList list_;
    Box3d bounds_;
};

}  // namespace sightline::tools

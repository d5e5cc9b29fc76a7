// A scene as hidden-surface methods take it: what may be in view, one item an object, and what casts shadows on it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/render_list.h"

#include <algorithm>

#include "sightline/tools/report/pictures/scene_look.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {
using namespace studies;

RenderList::RenderList(const Scene& scene, const View& view)
    : scene_(scene), items_(chooseItems(&view)), list_(items_), bounds_(coreOf(scene).bounds) {}
RenderList::RenderList(const Scene& scene)
    : scene_(scene), items_(chooseItems(nullptr)), list_(items_), bounds_(coreOf(scene).bounds) {}

std::vector<DrawItem> RenderList::chooseItems(const View* view) {
    flags_.resize(scene_.meshes.size());
    for (size_t m = 0; m < flags_.size(); ++m) {
        const Mesh& mesh = scene_.meshes[m];
        flags_[m].double_sided.assign(mesh.triangles(), 0);
        flags_[m].solid.assign(mesh.triangles(), 1);
        for (const Primitive& primitive : mesh.primitives) {
            const Material& material = scene_.materials[primitive.material];
            std::fill_n(flags_[m].double_sided.begin() + primitive.first_triangle, primitive.triangle_count,
                        material.double_sided);
            std::fill_n(flags_[m].solid.begin() + primitive.first_triangle, primitive.triangle_count,
                        isSolid(material));
        }
    }
    const glm::dmat4 clip = view ? view->projection * view->view : glm::dmat4(1.0);
    std::vector<DrawItem> items;
    for (size_t i = 0; i < scene_.objects.size(); ++i) {
        const SceneObject& object = scene_.objects[i];
        const Mesh& mesh = scene_.meshes[object.mesh];
        const Box3d box = transformBox(mesh.bounds, object.transform);
        if (!box.finite()) continue;
        DrawItem item;
        item.mesh = {mesh.positions, mesh.indices};
        item.double_sided = flags_[object.mesh].double_sided;
        item.writes_depth = flags_[object.mesh].solid;
        item.transform = object.transform;
        item.id = static_cast<uint32_t>(i);
        casters_.push_back(item);
        if (!view || mayBeInView(clip, box)) items.push_back(item);
    }
    return items;
}

glm::dvec3 RenderList::colourOf(uint32_t item, uint32_t triangle) const {
    const SceneObject& object = scene_.objects[items_[item].id];
    const std::vector<Primitive>& primitives = scene_.meshes[object.mesh].primitives;
    const auto next = std::upper_bound(primitives.begin(), primitives.end(), triangle,
                                       [](uint32_t t, const Primitive& p) { return t < p.first_triangle; });
    // Empty primitives share their first triangle with the next one: the last of them holds it.
    return sightline::tools::colourOf(scene_, object, next == primitives.begin() ? primitives.front() : next[-1]);
}

}  // namespace sightline::tools

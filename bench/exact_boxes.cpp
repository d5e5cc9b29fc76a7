// The same box test on an exact z-buffer: what an occlusion buffer without rounding or gaps would keep.
// SPDX-License-Identifier: MIT
#include "bench/exact_boxes.h"

#include "bench/flat_boxes.h"
#include "sightline/cull/occlusion.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;

ExactBoxes::ExactBoxes(const Scene& scene) : scene_(scene), boxes_(objectBoxes(scene)) {
    for (const Mesh& mesh : scene.meshes) {
        std::vector<uint8_t>& both = double_sided_.emplace_back(mesh.triangles(), 0);
        std::vector<uint8_t>& writes = writes_depth_.emplace_back(mesh.triangles(), 0);
        for (const Primitive& primitive : mesh.primitives)
            for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
                both[t] = scene.materials[primitive.material].double_sided;
                writes[t] = scene.materials[primitive.material].hides() && !mesh.deforms;
            }
    }
}

ExactBoxes::Answer ExactBoxes::test(const View& view, uint32_t occlusion_size, uint32_t supersampling) const {
    const Screen screen = makeScreen(view, occlusion_size);
    const Frustum frustum = makeFrustum(view);
    std::vector<DrawItem> items;
    FlatBoxes flat(boxes_);
    const size_t in_frustum = cullFrustum(frustum, flat.arrays, flat.kept);
    for (size_t i = 0; i < in_frustum; ++i) {
        const SceneObject& object = scene_.objects[flat.kept[i]];
        DrawItem item;
        item.mesh = {scene_.meshes[object.mesh].positions, scene_.meshes[object.mesh].indices};
        item.double_sided = double_sided_[object.mesh];
        item.writes_depth = writes_depth_[object.mesh];
        item.transform = object.transform;
        item.id = flat.kept[i];
        items.push_back(item);
    }
    Answer answer;
    ZBufferSettings settings;
    settings.samples = supersampling;
    if (supersampling > 0) answer.seen = renderZBuffer(items, view, settings).seen;
    answer.seen.resize(boxes_.size(), 0);

    View widened = view;  // the occlusion buffer's pixels: the viewport and its margin for jitter
    widened.width = screen.width;
    widened.height = screen.height;
    const double wide_x = 1.0 + 2.0 * view.jitter / view.width, wide_y = 1.0 + 2.0 * view.jitter / view.height;
    for (int column = 0; column < 4; ++column) {
        widened.projection[column][0] /= wide_x;
        widened.projection[column][1] /= wide_y;
    }
    const ZBufferImage image = renderZBuffer(items, widened, {});
    answer.kept.assign(boxes_.size(), 0);
    for (size_t i = 0; i < boxes_.size(); ++i) {
        glm::dmat4 to_world(1.0);
        to_world[3] = glm::dvec4(screen.eye, 1.0);
        const BoxAnswer box = projectBox(objectScreen(screen, to_world), roundOutward(boxes_[i], screen.eye));
        answer.kept[i] = box.doubt;
        if (box.doubt || box.outside) continue;
        for (int32_t y = box.rect.y0; y <= box.rect.y1 && !answer.kept[i]; ++y)
            for (int32_t x = box.rect.x0; x <= box.rect.x1 && !answer.kept[i]; ++x)
                answer.kept[i] =
                    image.depth[static_cast<size_t>(y) * image.width + static_cast<size_t>(x)] <= box.rect.nearness;
    }
    return answer;
}

}  // namespace sightline::bench

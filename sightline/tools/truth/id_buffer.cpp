// The id-buffer witness: the frame drawn by the reference renderer, supersampled and shifted by a seeded jitter.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/id_buffer.h"

#include <algorithm>

#include "sightline/base/random.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"

namespace sightline::tools {
using namespace studies;
namespace {

/// In rising order of the objects, so that the answer does not depend on the tree.
std::vector<uint32_t> objectsInFrustum(const SceneFacts& facts, const SightLines& sight) {
    std::vector<uint32_t> objects;
    facts.objects().walk([&](const Box3d& box) { return sight.touches(box); },
                         [&](uint32_t object) {
                             if (sight.touches(facts.box(object))) objects.push_back(object);
                         });
    std::sort(objects.begin(), objects.end());
    return objects;
}

}  // namespace

std::vector<DrawItem> drawItems(const SceneFacts& facts, const std::vector<uint32_t>& objects) {
    std::vector<DrawItem> items;
    items.reserve(objects.size());
    for (uint32_t i = 0; i < objects.size(); ++i) {
        const Mesh& mesh = facts.mesh(objects[i]);
        const MeshFacts& mesh_facts = facts.facts(objects[i]);
        DrawItem item;
        item.mesh = {mesh.positions, mesh.indices};
        item.double_sided = mesh_facts.double_sided;
        if (!mesh_facts.all_hide) item.writes_depth = mesh_facts.hides;
        item.transform = facts.scene().objects[objects[i]].transform;
        item.id = i;
        items.push_back(item);
    }
    return items;
}

uint64_t drawIdBuffer(const SceneFacts& facts, const View& view, const SightLines& sight,
                      const IdBufferSettings& settings, const std::function<void(uint32_t, const glm::dvec2&)>& seen) {
    const std::vector<uint32_t> objects = objectsInFrustum(facts, sight);
    const std::vector<DrawItem> items = drawItems(facts, objects);
    Random random(settings.seed);
    ZBufferSettings pass;
    pass.samples = settings.supersampling;
    pass.want_generated = false;
    pass.stop = settings.stop;
    pass.offset.x = random.uniform(-0.5, 0.5) / settings.supersampling;
    pass.offset.y = random.uniform(-0.5, 0.5) / settings.supersampling;
    const uint64_t width = uint64_t(view.width) * settings.supersampling;
    const uint64_t height = uint64_t(view.height) * settings.supersampling;
    pass.row_count = static_cast<uint32_t>(std::clamp<uint64_t>(settings.band_samples / width, 1, height));
    ZBufferImage image;
    for (uint64_t row = 0; row < height; row += pass.row_count) {
        pass.first_row = static_cast<uint32_t>(row);
        renderZBuffer(items, view, pass, image);
        if (settings.stop && settings.stop()) return width * row;
        for (uint32_t i = 0; i < image.seen.size(); ++i) {
            if (!image.seen[i]) continue;
            const double column = image.seen_at[i] % width + 0.5;
            const double line = double(row) + image.seen_at[i] / width + 0.5;
            const glm::dvec2 pixel = glm::dvec2(column, line) / double(settings.supersampling) + pass.offset;
            seen(objects[i], 2.0 * pixel / glm::dvec2(view.width, view.height) - 1.0);
        }
    }
    return width * height;
}

}  // namespace sightline::tools

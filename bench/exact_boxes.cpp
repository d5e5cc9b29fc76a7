// The same box test on an exact z-buffer: what an occlusion buffer without rounding or gaps would keep.
// SPDX-License-Identifier: MIT
#include "bench/cases.h"
#include "bench/flat_boxes.h"
#include "bench/occlusion_truth.h"
#include "sightline/cull/occlusion.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/truth/scene_facts.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

/// Per object.
struct Answer {
    std::vector<uint8_t> kept;  ///< not hidden by the z-buffer, whether inside the frustum or not
    std::vector<uint8_t> seen;  ///< has one of 4x4 samples a pixel
};

/// Draws all of a scene's triangles into a z-buffer of the size of the query's occlusion buffer, and tests its objects' boxes, as
/// rectangles with their nearest depth.
Answer testExactly(const SceneFacts& facts, const std::vector<Box3d>& boxes, const View& view,
                   uint32_t occlusion_size) {
    const Screen screen = makeScreen(view, occlusion_size);
    std::vector<DrawItem> items;
    FlatBoxes flat(boxes);
    const size_t in_frustum = cullFrustum(makeFrustum(view), flat.arrays, flat.kept);
    for (size_t i = 0; i < in_frustum; ++i) {
        const uint32_t object = flat.kept[i];
        DrawItem item;
        item.mesh = {facts.mesh(object).positions, facts.mesh(object).indices};
        item.double_sided = facts.facts(object).double_sided;
        item.writes_depth = facts.facts(object).hides;
        item.transform = facts.scene().objects[object].transform;
        item.id = object;
        items.push_back(item);
    }
    Answer answer;
    answer.seen = renderZBuffer(items, view, {.samples = 4}).seen;
    answer.seen.resize(boxes.size(), 0);

    View widened = view;  // the occlusion buffer's pixels: the viewport and its margin for jitter
    widened.width = screen.width;
    widened.height = screen.height;
    const double wide_x = 1.0 + 2.0 * view.jitter / view.width, wide_y = 1.0 + 2.0 * view.jitter / view.height;
    for (int column = 0; column < 4; ++column) {
        widened.projection[column][0] /= wide_x;
        widened.projection[column][1] /= wide_y;
    }
    const ZBufferImage image = renderZBuffer(items, widened, {});
    answer.kept.assign(boxes.size(), 0);
    glm::dmat4 to_world(1.0);
    to_world[3] = glm::dvec4(screen.eye, 1.0);
    for (size_t i = 0; i < boxes.size(); ++i) {
        const BoxAnswer box = projectBox(objectScreen(screen, to_world), roundOutward(boxes[i], screen.eye));
        answer.kept[i] = box.doubt || (!box.outside && !isBehind(image, box.rect));
    }
    return answer;
}

}  // namespace

void measureTightness(const Scene& scene, const CameraPath& path, uint32_t occlusion_size, const std::string& where,
                      Table& table) {
    LoadedWorld loaded = loadWorld(scene);
    const Snapshot now = loaded.world.commit();
    const SceneFacts facts(scene);
    const std::vector<Box3d> boxes = objectBoxes(scene);
    Query query;
    std::vector<uint8_t> reasons(scene.objects.size());
    double kept = 0, exactly_kept = 0, seen = 0;
    for (const CameraFrame& frame : path.frames) {
        const View view = makeView(frame, 1280, 720);
        kept += static_cast<double>(query.visible(now, view, {.occlusion_size = occlusion_size}).objects.size());
        query.reasons(reasons);
        const Answer answer = testExactly(facts, boxes, view, occlusion_size);
        for (size_t i = 0; i < reasons.size(); ++i) {
            exactly_kept += answer.kept[i] && reasons[i] != 1 + static_cast<int>(Stage::kFrustum);
            seen += answer.seen[i];
        }
    }
    const Rows row{table, where, "objects", 1.0 / static_cast<double>(path.frames.size())};
    row("objects kept", kept, "same boxes, exact z-buffer", exactly_kept);
    row("objects kept (over-estimate)", kept, "seen by a 4x4 id-buffer", seen);
}

}  // namespace sightline::bench

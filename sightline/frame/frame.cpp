// What a view fixes for one answer, computed once: its planes, its screen, its limits, and what is left of the world.
// SPDX-License-Identifier: MIT
#include "sightline/frame/frame.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/frame/image_part.h"
#include "sightline/geom/off.h"
#include "sightline/math/stretch.h"

namespace sightline::detail {

void Frame::begin(const SnapshotState* now, const View& from, const QuerySettings& how,
                  std::span<const uint32_t> shown) {
    world = now;
    view = from;
    settings = how;
    stages = stagesInUse(view, settings);
    candidates = nullptr;
    volumes = {};
    volume_owners = {};
    sizes.clear();
    objects = 0;
    off = 0;
    problem = problemOf(view);
    usable = problem == ViewProblem::kNone;
    if (usable) {
        frustum = makeFrustum(view);
        limits = makeViewLimits(view, frustum.eye);
        if (!uses(Stage::kFrustum)) limits.dropWindow();
        screen = makeScreen(view, settings.occlusion_size);
    }
    if (!world) return;
    if (world->lods.size() < 2 || !usable) stages &= ~stageBit(Stage::kLod);
    if (uses(Stage::kLod)) lods = makeLodMeasure(view);
    if (usable) sizes.begin(*world, view, settings, stages, frustum.eye, shown);
    noteOff();
    every_layer = (world->common_layers & view.layers) != 0 || world->count == 0;
    objects = world->count;
    if (every_layer) return;
    objects = 0;
    for (uint32_t place = 0; place < world->placed.size(); ++place) objects += isInLayers(place);
    for (const uint32_t row : world->unbounded) objects += (world->objects[row].layers & view.layers) != 0;
}

void Frame::noteOff() {
    if (!usable) return;
    const auto note = [&](bool is_off, Off what) { off |= is_off ? offBit(what) : 0; };
    const bool cells_asked = world->cell_state.cells && (settings.stages & kCellStages);
    const bool remembers = settings.proofs || settings.unasked_answers > 0;
    const bool frustum = uses(Stage::kFrustum), occlusion = uses(Stage::kOcclusion);
    note(cells_asked && view.sections.count > 0 && !(stages & kCellStages), Off::kCellsBySections);
    note(view.eye_radius != 0.0, Off::kStagesByEyeRadius);
    note(view.window.count > 0 && !frustum, Off::kWindowByStages);
    note(settings.bins > 1 && !(frustum && occlusion), Off::kBinsByStages);
    note(settings.stateless && occlusion && remembers, Off::kMemoryByStateless);
    note(!settings.stateless && settings.proofs && occlusion && !frustum, Off::kCertificatesByStages);
    note(uses(Stage::kLod) && occlusion, Off::kOccludersByLods);
    const bool parts = uses(Stage::kVolumes) || (settings.proofs && !settings.stateless && occlusion && frustum);
    note(parts && !world->volumes && world->occluders.size() > 1, Off::kCertificatesByWorld);
}

Box3d Frame::boundsAt(uint32_t place) const {
    SIGHTLINE_DEBUG_ASSERT(place < world->bvh.order.size() && world->bvh.order[place] != PlacedBvh::kNone);
    const uint32_t at = world->bvh.slot[world->bvh.order[place]];
    const Box3f box = slotBox(world->bvh.nodes[at / 8], static_cast<int>(at % 8));
    return {world->bvh.origin + glm::dvec3(box.min), world->bvh.origin + glm::dvec3(box.max)};
}

bool Frame::errsLittle(uint32_t place) const {
    SIGHTLINE_DEBUG_ASSERT(world->placed[place].coarser.index > 0 &&
                           world->placed[place].coarser.index < world->lods.size());
    const HeldLods& held = *world->lods[world->placed[place].coarser.index];
    if (settings.budget > 0.0) return held.levels.size() > 1;
    const double unit = largestStretch(world->objectAt(place).transform) * pixelsOfUnit(lods, boundsAt(place));
    return held.least_error * unit <= settings.lod_error;
}

void Frame::narrowTo(const Candidates* left) {
    SIGHTLINE_DEBUG_ASSERT(!left || (left->stages() & ~kCellStages) == 0);
    candidates = left;
    stages &= ~kCellStages | (left ? left->stages() : 0);
}

uint64_t Frame::countObjects(const PlaceRange& places) const {
    SIGHTLINE_DEBUG_ASSERT(places.first + places.count <= world->placed.size() && places.empty <= places.count);
    if (candidates) return candidates->count(places.first, places.first + places.count);
    if (every_layer) return places.count - places.empty;
    uint64_t within = 0;
    for (uint32_t place = places.first; place < places.first + places.count; ++place) within += isInLayers(place);
    return within;
}

uint32_t Frame::candidateSlots(const BvhNode& node) const {
    uint32_t slots = 0;
    for (int slot = 0; slot < 8; ++slot)
        slots |= uint32_t{node.count[slot] != 0 &&
                          (!candidates || candidates->any(node.first[slot], node.first[slot] + node.count[slot]))}
                 << slot;
    return slots;
}

PixelRect Frame::inWindow(uint32_t place, PixelRect rect) const {
    const WindowRect* const window = candidates ? candidates->window(place) : nullptr;
    if (!window) return rect;
    SIGHTLINE_DEBUG_ASSERT(usable);
    // A thousandth of a pixel is far more than rounding, in float, moves it.
    const auto pixel = [](float at, double wide, uint32_t size, double more) {
        const double x = 0.5 * size * (static_cast<double>(at) / wide + 1.0) + more;
        return static_cast<int32_t>(std::floor(std::clamp(x, -1.0, size + 1.0)));
    };
    const double wide_x = 1.0 + 2.0 * view.jitter / view.width, wide_y = 1.0 + 2.0 * view.jitter / view.height;
    rect.x0 = std::max(rect.x0, pixel(window->left, wide_x, screen.width, -1e-3));
    rect.x1 = std::min(rect.x1, pixel(window->right, wide_x, screen.width, 1e-3));
    rect.y0 = std::max(rect.y0, pixel(window->bottom, wide_y, screen.height, -1e-3));
    rect.y1 = std::min(rect.y1, pixel(window->top, wide_y, screen.height, 1e-3));
    return rect;
}

uint32_t allPlanes(const Frame& frame) {
    SIGHTLINE_DEBUG_ASSERT(frame.frustum.count <= kLimitBit);
    SIGHTLINE_DEBUG_ASSERT(frame.limits.volume.count <= 32 - kLimitBit);
    return ((1u << frame.frustum.count) - 1) | (frame.limits.volume.allPlanes() << kLimitBit);
}

uint32_t partCount(const Frame& frame) {
    const uint32_t both = stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
    if (frame.settings.bins < 2 || !frame.usable || (frame.stages & both) != both) return 1;
    return std::clamp(frame.columns(), 1u, std::min(frame.settings.bins, ImagePart::kMost));
}

}  // namespace sightline::detail

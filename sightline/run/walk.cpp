// The walk behind a query: front to back over the hierarchy, stage by stage; and what it notes on request.
// SPDX-License-Identifier: MIT
#include "sightline/run/walk.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

#include <hwy/cache_control.h>

#include "sightline/base/assert.h"
#include "sightline/geom/depth_order.h"
#include "sightline/run/occluder_form.h"

namespace sightline::detail {
namespace {

using Clock = std::chrono::steady_clock;

uint64_t since(Clock::time_point start) {
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
}

/// Bit per slot of a node that has a child.
uint32_t usedSlots(const BvhNode& node) {
    uint32_t used = 0;
    for (int slot = 0; slot < 8; ++slot) used |= uint32_t{node.count[slot] != 0} << slot;
    return used;
}

void prefetch(const BvhNode& node) {
    const char* at = reinterpret_cast<const char*>(&node);
    for (size_t line = 0; line < sizeof(BvhNode); line += 64) hwy::Prefetch(at + line);
}

/// What is smaller than a thirty-second of the buffer in both directions hides next to nothing, and is not drawn.
bool isSmall(const Screen& screen, const PixelRect& rect) {
    const auto least = static_cast<int32_t>(std::max(screen.width, screen.height) / 32);
    return rect.x1 - rect.x0 < least && rect.y1 - rect.y0 < least;
}

}  // namespace

bool Walk::isHiddenHere(PixelRect rect, Seams seams) { return !tiles.clip(rect) || isHidden(tiles, rect, seams); }

PixelRect Walk::inWindow(uint32_t place, PixelRect rect) const {
    const WindowRect* const window = admission ? admission->window(place) : nullptr;
    if (!window) return rect;
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

/// Cuts the rectangles of a node's objects to their windows; culls those of which nothing is left.
uint32_t Walk::cutToWindows(const BvhNode& node, uint32_t left, ScreenAnswer& on_screen) {
    if (!admission || !admission->uses(Stage::kPortals)) return left;
    for (uint32_t bits = left & ~(on_screen.doubt | on_screen.outside); bits; bits &= bits - 1) {
        const int slot = std::countr_zero(bits);
        if (!(node.child[slot] & BvhNode::kLeaf)) continue;
        PixelRect& rect = on_screen.rects[slot];
        rect = inWindow(node.first[slot], rect);
        if (rect.x0 <= rect.x1 && rect.y0 <= rect.y1) continue;
        cull(placesBelow(node, slot), Stage::kPortals, nullptr);
        left &= ~(1u << slot);
    }
    return left;
}

void Walk::push(const Pending& entry) {
    undecided += entry.kind != Pending::Kind::kCluster;
    pending.push(entry);
}

uint64_t Walk::inLayers(const PlaceRange& places) const {
    if (admission) return admission->count(places.first, places.first + places.count);
    if (every_layer) return places.count - places.empty;
    uint64_t within = 0;
    for (uint32_t place = places.first; place < places.first + places.count; ++place)
        within += (state().placed[place].layers & view.layers) != 0;
    return within;
}

/// @param rect   that decided; null: a plane or a volume did
/// @param hider  place of the object that the volume belongs to
void Walk::cull(const PlaceRange& places, Stage stage, const PixelRect* rect, uint32_t hider) {
    of(stage).culled += inLayers(places);
    culled.push_back({places, stage});
    if (record) noteCull(places, stage, rect, hider);
}

void WalkRecord::clear() {
    draws.clear();
    culls.clear();
    owners.clear();
    stopped = false;
    if (log) log->clear();
}

void Walk::noteDraw(const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box, uint32_t triangles) {
    record->draws.push_back({static_cast<uint32_t>(&instance - instances.data()), cluster, triangles, box});
    if (record->log) record->log->noteDraw();
}

void Walk::noteCull(const PlaceRange& places, Stage stage, const PixelRect* rect, uint32_t hider) {
    WalkRecord::Cull note{places, stage, stage == Stage::kFrustum && rect, PixelRect(), hider};
    if (rect) note.rect = *rect;
    record->culls.push_back(note);
    if (stage != Stage::kFrustum && record->stopsAt(places)) {
        record->stopped = true;
        undecided = 0;
    }
}

void Walk::noteKept(const Pending& entry, Look look) {
    if (!record->stopsAt({entry.index})) return;
    record->stopped = true;
    record->kept = {entry.rect, entry.testable, look};
    undecided = 0;
}

void Walk::begin(const SnapshotState* now, const View& new_view) {
    snapshot = now;
    view = new_view;
    view.stages = stagesInUse(view);
    stats = {};
    undecided = 0;
    pending.clear();
    instances.clear();
    visible.clear();
    kept.clear();
    culled.clear();
    second.clear();
    tiles.clear(0, 0);
    sizes.clear();
    volumes.clear();
    if (remembers) last.begin(now, view.last_visible_first);
    if (record) record->clear();
    tiles.log = record ? record->log : nullptr;
    view.stages &= ~kCellStages | (admission ? admission->stages() : 0);
    if (!snapshot) return;
    every_layer = (state().common_layers & view.layers) != 0 || state().count == 0;
    stats.objects = state().count;
    if (every_layer || bin.index > 0) return;
    stats.objects = 0;
    for (uint32_t place = 0; place < state().placed.size(); ++place)
        stats.objects += (state().placed[place].layers & view.layers) != 0;
    for (const uint32_t row : state().unbounded) stats.objects += (state().objects[row].layers & view.layers) != 0;
}

void Walk::keep(const ObjectRecord& object) {
    if (!(object.layers & view.layers)) return;
    visible.push_back({object.key, object.id});
    ++of(Stage::kFrustum).doubt;
}

/// Keeps the objects at the given places of the hierarchy that are admitted.
void Walk::reportAdmitted(uint32_t first, uint32_t count) {
    admission->forEach(first, first + count, [&](uint32_t place) {
        const PlacedObject& placed = state().placed[place];
        if (placed.layers & view.layers) visible.push_back(placed.visible);
    });
}

/// Keeps the objects at the given places of the hierarchy.
void Walk::report(uint32_t first, uint32_t count) {
    if (count == 1) {
        const PlacedObject& placed = state().placed[first];
        if (placed.layers & view.layers) visible.push_back(placed.visible);
        return;
    }
    if (admission) return reportAdmitted(first, count);
    while (count > 0) {
        const std::span<const PlacedObject> run = state().placed.run(first, count);
        for (const PlacedObject& placed : run)
            if (placed.layers & view.layers) visible.push_back(placed.visible);
        first += static_cast<uint32_t>(run.size());
        count -= static_cast<uint32_t>(run.size());
    }
}

/// Without a usable view nothing can be proved hidden.
void Walk::keepEverything() {
    for (uint32_t item = 0; item < state().count; ++item) keep(state().object(item));
}

/// Culls the children that lie in a volume.
VolumesAnswer Walk::askVolumes(const BvhNode& node, const EyeBoxes& boxes, VolumeRange range, uint32_t left) {
    const auto start = view.time_stages ? Clock::now() : Clock::time_point();
    const VolumesAnswer answer = volumes.test(boxes, range, left);
    if (view.time_stages) of(Stage::kVolumes).nanoseconds += since(start);
    for (int slot = 0; slot < 8; ++slot)
        if (answer.hidden >> slot & 1)
            cull(placesBelow(node, slot), Stage::kVolumes, nullptr, volumes.owner(answer.volume[slot]));
    return answer;
}

/// Asks the frustum, and what the view adds to it.
FrustumAnswer Walk::askPlanes(const EyeBoxes& boxes, uint32_t planes) const {
    FrustumAnswer answer = testFrustum(frustum, boxes, planes);
    if (planes >> kLimitBit != 0) {
        const FrustumAnswer beside = testViewVolume(limits.volume, boxes, planes >> kLimitBit);
        answer.outside |= beside.outside;
        for (int slot = 0; slot < 8; ++slot) answer.planes[slot] |= beside.planes[slot] << kLimitBit;
    }
    if (refining && planes) answer.outside |= refine(boxes, answer);
    return answer;
}

void Walk::chooseRefinement() {
    refining = view.refinement != Refinement::kNone && uses(Stage::kFrustum);
    if (!refining) return;
    ViewVolume volume = volumeOf(frustum);
    intersect(volume, limits.volume);
    refined = refineVolume(volume, view.refinement);
}

/// The boxes that are outside although no plane of the view has them outside. What crosses one plane alone reaches inside.
uint32_t Walk::refine(const EyeBoxes& boxes, const FrustumAnswer& answer) const {
    uint32_t asked = 0;
    for (int slot = 0; slot < 8; ++slot) {
        const uint32_t crossed = answer.planes[slot];
        asked |= uint32_t{(crossed & (crossed - 1)) != 0} << slot;
    }
    asked &= ~answer.outside;
    if (asked == 0) return 0;
    uint32_t outside = outsideAny({refined.axes, refined.axis_count}, boxes);
    if (asked & ~outside) outside |= outsideAny({refined.crossed, refined.crossed_count}, boxes);
    return outside & asked;
}

/// Bit per slot of a node that has a child below which something is admitted.
uint32_t Walk::admittedSlots(const BvhNode& node) const {
    if (!admission) return 0xff;
    uint32_t slots = 0;
    for (int slot = 0; slot < 8; ++slot)
        slots |=
            uint32_t{node.count[slot] != 0 && admission->any(node.first[slot], node.first[slot] + node.count[slot])}
            << slot;
    return slots;
}

/// Tests a node's children against the frustum and the volumes and puts those that are left in line.
/// @param slots  the others are passed over
void Walk::expand(const Visit& from, uint32_t slots) {
    const auto start = view.time_stages ? Clock::now() : Clock::time_point();
    ++stats.nodes_visited;
    const BvhNode& node = state().bvh.nodes[from.node];
    const EyeBoxes boxes = eyeBoxes(node, state().bvh.origin - frustum.eye);
    FrustumAnswer answer;
    if (uses(Stage::kFrustum)) answer = askPlanes(boxes, from.planes);
    if (view.time_stages) of(Stage::kFrustum).nanoseconds += since(start);
    uint32_t left = 0;
    for (int slot = 0; slot < 8; ++slot) {
        if (node.count[slot] == 0 || !(slots >> slot & 1)) continue;
        if (answer.outside >> slot & 1) cull(placesBelow(node, slot), Stage::kFrustum, nullptr);
        else left |= 1u << slot;
    }
    if (left && sizes.inUse()) left &= ~cullBySize(from.node, boxes, left);
    VolumesAnswer hidden;
    if (left && from.volumes.count) {
        hidden = askVolumes(node, boxes, from.volumes, left);
        left &= ~hidden.hidden;
    }
    if (!left) return;
    ScreenAnswer on_screen = projectBoxes(screen, boxes);
    left = cutToWindows(node, left, on_screen);
    if (isPart()) left &= ~findBeside(on_screen, boxes, left);
    for (int slot = 0; slot < 8; ++slot) {
        if (!(left >> slot & 1)) continue;
        const uint32_t planes = uses(Stage::kFrustum) ? answer.planes[slot] : 0;
        meet(node, slot, {node.child[slot], planes, hidden.range[slot]}, on_screen);
    }
}

/// @param below  the child as a node: planes and volumes that it crosses
void Walk::meet(const BvhNode& node, int slot, const Visit& below, const ScreenAnswer& on_screen) {
    const bool doubt = on_screen.doubt >> slot & 1, outside = on_screen.outside >> slot & 1;
    if (outside && uses(Stage::kFrustum)) return cull(placesBelow(node, slot), Stage::kFrustum, &on_screen.rects[slot]);
    Pending entry;
    const bool leaf = node.child[slot] & BvhNode::kLeaf;
    entry.kind = leaf ? Pending::Kind::kObject : Pending::Kind::kNode;
    entry.index = node.child[slot] & ~BvhNode::kLeaf;
    entry.below = placesBelow(node, slot);
    entry.planes = below.planes;
    entry.volumes = below.volumes;
    entry.rect = on_screen.rects[slot];
    if (doubt) entry.rect.nearness = std::numeric_limits<float>::infinity();
    if (outside) entry.rect.nearness = -std::numeric_limits<float>::infinity();
    entry.testable = !doubt && !outside;
    if (doubt && leaf) ++of(Stage::kOcclusion).doubt;
    push(entry);
}

/// Whether an object that nobody has asked about yet hides: not what a lossy stage or the window may cull.
bool Walk::mayHide(uint32_t place) const {
    if (admission && !admission->admits(place)) return false;
    if (sizes.drops(place)) return false;
    const ObjectRecord& object = state().objectAt(place);
    return !limits.windowed() || reachesWindow(limits, object.bounds, object.transform);
}

/// Draws what the last answer drew, nearest first, before anything is asked.
void Walk::drawLast() {
    for (const uint32_t place : last.places())
        if (mayHide(place)) offerOccluder(place, true);
    while (!pending.empty()) visit(pending.pop());
}

void Walk::offerVisible(uint32_t place) {
    if (remembers) last.note(place, state().placed[place].visible.id);
    if (!remembers || !last.has(place)) offerOccluder(place, false);
}

/// Puts the clusters of an object's occluder in line, or draws it at once if there is one only.
/// @param in_line  not at once in any case
void Walk::offerOccluder(uint32_t place, bool in_line) {
    const PlacedObject& placed = state().placed[place];
    if (placed.occluder.index == 0 || !(placed.layers & view.layers)) return;
    const glm::dmat4& transform = state().objectAt(place).transform;
    const HeldOccluder& held = *state().occluders[placed.occluder.index];
    const bool cut = limits.cut() && !isWhole(limits, held, transform);
    // A simpler form hides in the name of all that is drawn of the object.
    const Occluder& occluder = cut ? held : formFor(held, screen, transform, view.occluder_error);
    const uint32_t owner = static_cast<uint32_t>(instances.size());
    instances.push_back(makeOccluderInstance(screen, occluder, transform));
    if (record) record->owners.push_back(place);
    const uint32_t clusters = static_cast<uint32_t>(occluder.clusters.size());
    ScreenAnswer eight;
    for (uint32_t cluster = 0; cluster < clusters; ++cluster) {
        if (cluster % 8 == 0) eight = projectClusters(instances[owner].screen, occluder, cluster);
        const BoxAnswer box(eight, static_cast<int>(cluster % 8));
        if (box.outside || (isPart() && isBeside(box, instances[owner].screen, occluder.clusters[cluster].bounds)))
            continue;
        if (cut && !isWhole(limits, occluder, occluder.clusters[cluster], transform)) continue;
        if (clusters == 1 && !in_line) {
            draw(instances[owner], cluster, box);
            continue;
        }
        Pending entry;
        entry.kind = Pending::Kind::kCluster;
        entry.index = cluster;
        entry.owner = owner;
        entry.rect = box.rect;
        if (box.doubt) entry.rect.nearness = std::numeric_limits<float>::infinity();
        entry.testable = !box.doubt;
        push(entry);
    }
}

void Walk::draw(const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box) {
    if (!box.doubt && isSmall(screen, box.rect)) return;
    if (stats.occluder_triangles >= view.occluder_triangles) {
        stats.budget_spent = true;
        return;
    }
    const uint32_t triangles = drawOccluder(tiles, instance, cluster, box);
    stats.occluder_triangles += triangles;
    if (view.balance_bins) countWork(box.rect, !box.doubt, 300.0 + 15.0 * triangles);
    if (record) noteDraw(instance, cluster, box, triangles);
}

void Walk::visit(const Pending& entry) {
    const bool occlusion = uses(Stage::kOcclusion);
    if (entry.kind == Pending::Kind::kCluster) {
        BoxAnswer box;
        box.rect = entry.rect;
        box.doubt = !entry.testable;
        if (box.doubt || !isHiddenHere(box.rect, Seams::kLeave)) draw(instances[entry.owner], entry.index, box);
        return;
    }
    // A node in doubt is opened: its children's smaller rectangles need fewer seams.
    const Seams seams = entry.kind == Pending::Kind::kNode ? Seams::kLeave : Seams::kResolve;
    if (occlusion && entry.testable && isHiddenHere(entry.rect, seams))
        return cull(entry.below, Stage::kOcclusion, &entry.rect);
    if (entry.kind == Pending::Kind::kNode)
        return expand({entry.index, entry.planes, entry.volumes}, admittedSlots(state().bvh.nodes[entry.index]));
    if (occlusion && lookCloser(entry)) return;
    report(entry.index, 1);
    if (isPart() && kept.size() < visible.size()) kept.push_back({entry.index, entry.rect.nearness});
    const bool again = !second.empty() && second.back().entry.serial == entry.serial;
    if (record && !again) noteKept(entry, view.faces && entry.testable ? Look::kFaces : Look::kBox);
    // Where nothing else is left to ask it hides nothing.
    const bool others = undecided > 0 || second.size() > (again ? 1u : 0u);
    if (occlusion && others && !(entry.testable && isSmall(screen, entry.rect))) offerVisible(entry.index);
}

/// Expands where the walk begins: at the root or, of few objects, at the nodes that hold them.
void Walk::expandAll() {
    if (!admission || admission->nodes().empty()) return expand(root, admittedSlots(state().bvh.nodes[0]));
    for (const NodeSlots& from : admission->nodes()) expand({from.node, root.planes, root.volumes}, from.slots);
}

/// Without the occlusion stage the order does not matter: level by level, so that nodes can be fetched ahead, and whole
/// subtrees that are inside at once.
void Walk::walkUnordered() {
    constexpr size_t kAhead = 8;
    visits.clear();
    const bool from_nodes = admission && !admission->nodes().empty();
    if (from_nodes)
        for (const NodeSlots& from : admission->nodes()) visits.push_back({from.node, root.planes, root.volumes});
    else visits.push_back(root);
    const PlacedBvh& bvh = state().bvh;
    const glm::dvec3 offset = bvh.origin - frustum.eye;
    for (size_t at = 0; at < visits.size(); ++at) {
        const Visit visit = visits[at];
        if (at + kAhead < visits.size()) prefetch(bvh.nodes[visits[at + kAhead].node]);
        ++stats.nodes_visited;
        const BvhNode& node = bvh.nodes[visit.node];
        const EyeBoxes boxes = eyeBoxes(node, offset);
        const FrustumAnswer answer = askPlanes(boxes, visit.planes);
        uint32_t asked = usedSlots(node);
        if (from_nodes) asked = admission->nodes()[at].slots;
        else if (admission) asked &= admittedSlots(node);
        uint32_t gone = sizes.inUse() ? cullBySize(visit.node, boxes, ~answer.outside & asked) : 0;
        VolumesAnswer hidden;
        if (visit.volumes.count) hidden = askVolumes(node, boxes, visit.volumes, ~(answer.outside | gone) & asked);
        gone |= hidden.hidden;
        for (int slot = 0; slot < 8; ++slot) {
            if (!(asked >> slot & 1) || (gone >> slot & 1)) continue;
            const bool decided = answer.planes[slot] == 0 && hidden.range[slot].count == 0 && !sizes.inUse();
            if (answer.outside >> slot & 1) cull(placesBelow(node, slot), Stage::kFrustum, nullptr);
            else if (decided || (node.child[slot] & BvhNode::kLeaf)) report(node.first[slot], node.count[slot]);
            else visits.push_back({node.child[slot], answer.planes[slot], hidden.range[slot]});
        }
    }
}

void Walk::chooseVolumes() {
    const auto start = view.time_stages ? Clock::now() : Clock::time_point();
    volumes.choose(state(), view, frustum, screen, view.occluder_volumes);
    if (view.time_stages) of(Stage::kVolumes).nanoseconds += since(start);
}

void Walk::walk() {
    frustum = makeFrustum(view);
    limits = makeViewLimits(view, frustum.eye);
    if (!uses(Stage::kFrustum)) limits.dropWindow();
    chooseRefinement();
    screen = makeScreen(view, view.occlusion_size);
    sizes.begin(state(), view, frustum.eye);
    volumes.sizes = &sizes;
    volumes.admission = admission;
    volumes.limits = &limits;
    if (uses(Stage::kOcclusion)) {
        tiles.clear(screen.width, screen.height, view.occlusion_detail);
        tiles.gap = closedGap(view);
    }
    if (view.balance_bins) work.assign(tiles.columns + 1, 0.0);
    if (isPart()) {
        tiles.keepColumns(bin.first_column, bin.end_column);
    } else {
        for (const uint32_t row : state().unbounded) keep(state().objects[row]);
    }
    if (state().bvh.nodes.empty()) return;
    const uint32_t planes = ((1u << frustum.count) - 1) | (limits.volume.allPlanes() << kLimitBit);
    if (uses(Stage::kVolumes)) chooseVolumes();
    root = {0, uses(Stage::kFrustum) ? planes : 0, volumes.all()};
    if (!uses(Stage::kOcclusion)) return walkUnordered();
    drawLast();
    expandAll();
    while (undecided > 0) {
        const Pending entry = pending.pop();
        undecided -= entry.kind != Pending::Kind::kCluster;
        const uint64_t seams = tiles.seam_pixels;
        visit(entry);
        if (view.balance_bins)
            countWork(entry.rect, entry.testable, 200.0 + 1000.0 * static_cast<double>(tiles.seam_pixels - seams));
    }
    if (record && record->stopped) return;
    // The closer looks ask a buffer in which all is drawn that was found: their answers do not hang on when the last
    // object was decided.
    while (!second.empty() && !pending.empty()) visit(pending.pop());
    lookAgain();
}

void Walk::finish() {
    stats.seam_pixels = tiles.seam_pixels;
    stats.closed_gaps = tiles.closed_gaps;
    if (isPart()) return;
    if (admission)
        for (const Stage stage : {Stage::kPvs, Stage::kPortals}) of(stage).culled += admission->culled(stage);
    uint64_t left = stats.objects;
    for (int i = 0; i < kStageCount; ++i) {
        const Stage stage = static_cast<Stage>(i);
        of(stage).tested = uses(stage) ? left : 0;
        left -= of(stage).culled;
    }
    stats.visible = visible.size();
    uint64_t culled_objects = 0;
    for (const StageStats& stage : stats.stages) culled_objects += stage.culled;
    SIGHTLINE_ASSERT(stats.visible + culled_objects == stats.objects || (record && record->stopped));
}

void Walk::run(const SnapshotState* now, const View& new_view, const Bin& part) {
    bin = part;
    begin(now, new_view);
    if (!now) return;
    if (isUsable(view) && runsOutward(view)) walk();
    else keepEverything();
    finish();
}

void notAdmitted(const SnapshotState& state, const Admission& admission, std::span<uint8_t> reasons) {
    for (uint32_t place = 0; place < state.placed.size(); ++place)
        if (state.bvh.order[place] != PlacedBvh::kNone && !admission.admits(place))
            reasons[state.itemAt(place)] = static_cast<uint8_t>(1 + static_cast<int>(admission.stageOf(place)));
}

void Walk::reasons(std::span<uint8_t> reasons) const {
    SIGHTLINE_ASSERT(!snapshot || reasons.size() >= state().count);
    std::fill(reasons.begin(), reasons.end(), uint8_t{0});
    if (!snapshot) return;
    if (admission) notAdmitted(state(), *admission, reasons);
    for (const CulledRange& range : culled)
        for (uint32_t place = range.places.first; place < range.places.first + range.places.count; ++place)
            if (state().bvh.order[place] != PlacedBvh::kNone && (!admission || admission->admits(place)))
                reasons[state().itemAt(place)] = static_cast<uint8_t>(1 + static_cast<int>(range.stage));
    if (every_layer) return;
    for (uint32_t item = 0; item < state().count; ++item)
        if (!(state().object(item).layers & view.layers)) reasons[item] = 255;
}

}  // namespace sightline::detail

// What can be seen in a snapshot from a view: one front-to-back walk, frustum and occlusion.
// SPDX-License-Identifier: MIT
#include "sightline/run/query.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/cull/frustum.h"
#include "sightline/cull/occlusion.h"
#include "sightline/run/world_state.h"

namespace sightline {
namespace {

using Clock = std::chrono::steady_clock;

uint64_t since(Clock::time_point start) {
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
}

/// Something that the walk has met and not yet looked at. Nearest first; ties in the order of meeting.
struct Pending {
    enum class Kind : uint8_t { kNode, kObject, kCluster };
    PixelRect rect;
    uint32_t serial = 0;
    uint32_t index = 0;             ///< node; place of the object; or cluster
    uint32_t owner = 0;             ///< of a cluster: index into Impl::instances
    uint32_t first = 0, count = 1;  ///< places of the objects below
    uint8_t planes = 0;             ///< of a node: frustum planes that it is not inside of
    Kind kind = Kind::kNode;
    bool testable = false;  ///< the rectangle stands for the bound; else it is in doubt, or outside and kept

    bool operator<(const Pending& other) const {  // std heaps keep the largest at the front
        return rect.nearness != other.rect.nearness ? rect.nearness < other.rect.nearness : serial > other.serial;
    }
};

/// A node on the way down, and the frustum planes that it is not inside of.
struct Visit {
    uint32_t node = 0;
    uint8_t planes = 0;
};

/// What is smaller in both directions hides next to nothing, and is not drawn.  [pixels]
constexpr int32_t kLeastExtent = 4;

bool isSmall(const PixelRect& rect) { return rect.x1 - rect.x0 < kLeastExtent && rect.y1 - rect.y0 < kLeastExtent; }

/// Objects that were culled together.
struct CulledRange {
    uint32_t first = 0, count = 0;
    Stage stage = Stage::kFrustum;
};

}  // namespace

struct Query::Impl {
    explicit Impl(Memory* from) : memory(from) {}

    Memory* const memory;
    Snapshot snapshot;
    View view;
    bool every_layer = true;  ///< no object is outside the view's layers
    Frustum frustum;
    Screen screen;
    DepthTiles tiles{memory};
    Array<Pending> pending{memory};
    Array<Visit> visits{memory};
    Array<OccluderInstance> instances{memory};
    Array<Visible> visible{memory};
    Array<Visible> before{memory};  ///< the last answer's objects
    Array<CulledRange> culled{memory};
    Array<float> depth_image{memory};
    Array<Visible> appeared{memory}, disappeared{memory};
    Array<uint32_t> mark{memory};  ///< per ObjectId::index: 1 + place in `before`, while changes() runs; else 0
    QueryStats stats;
    uint32_t serial = 0;
    uint32_t undecided = 0;  ///< nodes and objects in line; without any, nothing is left to hide

    const detail::SnapshotState& state() const { return snapshot.state(); }
    bool uses(Stage stage) const { return view.stages & stageBit(stage); }
    StageStats& of(Stage stage) { return stats.stages[static_cast<int>(stage)]; }

    void begin(const Snapshot& now, const View& new_view);
    void keepEverything();
    void walk();
    void walkFrustumOnly(uint32_t node, uint8_t planes);
    void expand(uint32_t node, uint8_t planes);
    void meet(const BvhNode& node, int slot, uint8_t planes, const ScreenAnswer& on_screen);
    void visit(const Pending& entry);
    void keep(uint32_t item);
    void report(uint32_t first, uint32_t count);
    void offerOccluder(uint32_t place);
    void draw(const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box);
    void cull(uint32_t first, uint32_t count, Stage stage);
    uint64_t inLayers(uint32_t first, uint32_t count) const;
    void push(Pending entry);
    void finish();
};

void Query::Impl::push(Pending entry) {
    entry.serial = serial++;
    undecided += entry.kind != Pending::Kind::kCluster;
    pending.push_back(entry);
    std::push_heap(pending.begin(), pending.end());
}

/// How many objects of a range of places are within the view's layers.
uint64_t Query::Impl::inLayers(uint32_t first, uint32_t count) const {
    if (every_layer) return count;
    uint64_t within = 0;
    for (uint32_t place = first; place < first + count; ++place)
        within += ((*state().placed)[place].layers & view.layers) != 0;
    return within;
}

void Query::Impl::cull(uint32_t first, uint32_t count, Stage stage) {
    of(stage).culled += inLayers(first, count);
    culled.push_back({first, count, stage});
}

void Query::Impl::begin(const Snapshot& now, const View& new_view) {
    snapshot = now;
    view = new_view;
    stats = {};
    serial = undecided = 0;
    pending.clear();
    instances.clear();
    std::swap(visible, before);
    visible.clear();
    culled.clear();
    tiles.clear(0, 0);
    if (!snapshot) return;
    every_layer = (state().common_layers & view.layers) != 0 || state().count == 0;
    stats.objects = state().count;
    if (every_layer) return;
    stats.objects = 0;
    for (uint32_t item = 0; item < state().count; ++item)
        stats.objects += (state().object(item).layers & view.layers) != 0;
}

/// Keeps an object that no stage can look at.
void Query::Impl::keep(uint32_t item) {
    const detail::ObjectRecord& object = state().object(item);
    if (!(object.layers & view.layers)) return;
    visible.push_back({object.key, object.id});
    ++of(Stage::kFrustum).doubt;
}

/// Keeps the objects at the given places of the hierarchy.
void Query::Impl::report(uint32_t first, uint32_t count) {
    const detail::PlacedObject* placed = state().placed->data();
    for (uint32_t place = first; place < first + count; ++place)
        if (placed[place].layers & view.layers) visible.push_back(placed[place].visible);
}

/// Without a usable view nothing can be proved hidden.
void Query::Impl::keepEverything() {
    for (uint32_t item = 0; item < state().count; ++item) keep(item);
}

/// Tests a node's children against the frustum and puts those that are left in line.
void Query::Impl::expand(uint32_t index, uint8_t planes) {
    const auto start = view.time_stages ? Clock::now() : Clock::time_point();
    ++stats.nodes_visited;
    const BvhNode& node = state().bvh.nodes[index];
    const EyeBoxes boxes = eyeBoxes(node, state().bvh.origin - frustum.eye);
    FrustumAnswer answer;
    if (uses(Stage::kFrustum)) answer = testFrustum(frustum, boxes, planes);
    if (view.time_stages) of(Stage::kFrustum).nanoseconds += since(start);
    uint32_t left = 0;
    for (int slot = 0; slot < 8; ++slot) {
        if (node.count[slot] == 0) continue;
        if (answer.outside >> slot & 1) cull(node.first[slot], node.count[slot], Stage::kFrustum);
        else left |= 1u << slot;
    }
    if (!left) return;
    const ScreenAnswer on_screen = projectBoxes(screen, boxes);
    for (int slot = 0; slot < 8; ++slot)
        if (left >> slot & 1) meet(node, slot, uses(Stage::kFrustum) ? answer.planes[slot] : 0, on_screen);
}

void Query::Impl::meet(const BvhNode& node, int slot, uint8_t planes, const ScreenAnswer& on_screen) {
    const bool doubt = on_screen.doubt >> slot & 1, outside = on_screen.outside >> slot & 1;
    if (outside && uses(Stage::kFrustum)) return cull(node.first[slot], node.count[slot], Stage::kFrustum);
    Pending entry;
    const bool leaf = node.child[slot] & BvhNode::kLeaf;
    entry.kind = leaf ? Pending::Kind::kObject : Pending::Kind::kNode;
    entry.index = node.child[slot] & ~BvhNode::kLeaf;
    entry.first = node.first[slot];
    entry.count = node.count[slot];
    entry.planes = planes;
    entry.rect = on_screen.rects[slot];
    if (doubt) entry.rect.nearness = std::numeric_limits<float>::infinity();
    if (outside) entry.rect.nearness = -std::numeric_limits<float>::infinity();
    entry.testable = !doubt && !outside;
    if (doubt && leaf) ++of(Stage::kOcclusion).doubt;
    push(entry);
}

/// Puts the clusters of a visible object's occluder in line, or draws it at once if there is one only.
void Query::Impl::offerOccluder(uint32_t place) {
    const detail::PlacedObject& placed = (*state().placed)[place];
    if (placed.occluder.index == 0 || !(placed.layers & view.layers)) return;
    const Occluder& occluder = *state().occluders[placed.occluder.index];
    const uint32_t owner = static_cast<uint32_t>(instances.size());
    instances.push_back(makeOccluderInstance(screen, occluder, state().objectAt(place).transform));
    const uint32_t clusters = static_cast<uint32_t>(occluder.clusters.size());
    for (uint32_t cluster = 0; cluster < clusters; ++cluster) {
        const BoxAnswer box = projectBox(instances[owner].screen, occluder.clusters[cluster].bounds);
        if (box.outside) continue;
        if (clusters == 1) {
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

void Query::Impl::draw(const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box) {
    if (!box.doubt && isSmall(box.rect)) return;
    if (stats.occluder_triangles >= view.occluder_triangles) {
        stats.budget_spent = true;
        return;
    }
    stats.occluder_triangles += drawOccluder(tiles, instance, cluster, box);
}

void Query::Impl::visit(const Pending& entry) {
    const bool occlusion = uses(Stage::kOcclusion);
    if (entry.kind == Pending::Kind::kCluster) {
        BoxAnswer box;
        box.rect = entry.rect;
        box.doubt = !entry.testable;
        if (box.doubt || !isHidden(tiles, box.rect, Seams::kLeave)) draw(instances[entry.owner], entry.index, box);
        return;
    }
    // A node in doubt is opened: its children's smaller rectangles need fewer seams.
    const Seams seams = entry.kind == Pending::Kind::kNode ? Seams::kLeave : Seams::kResolve;
    if (occlusion && entry.testable && isHidden(tiles, entry.rect, seams))
        return cull(entry.first, entry.count, Stage::kOcclusion);
    if (entry.kind == Pending::Kind::kNode) return expand(entry.index, entry.planes);
    report(entry.index, 1);
    if (occlusion && undecided > 0 && !(entry.testable && isSmall(entry.rect))) offerOccluder(entry.index);
}

/// Without the occlusion stage the order does not matter: depth first, and whole subtrees that are inside at once.
void Query::Impl::walkFrustumOnly(uint32_t root, uint8_t all_planes) {
    Array<Visit>& stack = visits;
    stack.assign(1, {root, all_planes});
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        ++stats.nodes_visited;
        const BvhNode& node = state().bvh.nodes[visit.node];
        const EyeBoxes boxes = eyeBoxes(node, state().bvh.origin - frustum.eye);
        const FrustumAnswer answer = testFrustum(frustum, boxes, visit.planes);
        for (int slot = 0; slot < 8; ++slot) {
            if (node.count[slot] == 0) continue;
            if (answer.outside >> slot & 1) cull(node.first[slot], node.count[slot], Stage::kFrustum);
            else if (answer.planes[slot] == 0 || (node.child[slot] & BvhNode::kLeaf))
                report(node.first[slot], node.count[slot]);
            else stack.push_back({node.child[slot], answer.planes[slot]});
        }
    }
}

void Query::Impl::walk() {
    frustum = makeFrustum(view);
    screen = makeScreen(view, view.occlusion_size);
    if (uses(Stage::kOcclusion)) tiles.clear(screen.width, screen.height);
    for (uint32_t item : state().unbounded) keep(item);
    if (state().bvh.nodes.empty()) return;
    const uint8_t planes = static_cast<uint8_t>(uses(Stage::kFrustum) ? (1u << frustum.count) - 1 : 0);
    if (!uses(Stage::kOcclusion)) return walkFrustumOnly(0, planes);
    expand(0, planes);
    while (undecided > 0) {
        std::pop_heap(pending.begin(), pending.end());
        const Pending entry = pending.back();
        pending.pop_back();
        undecided -= entry.kind != Pending::Kind::kCluster;
        visit(entry);
    }
}

void Query::Impl::finish() {
    of(Stage::kFrustum).tested = uses(Stage::kFrustum) ? stats.objects : 0;
    of(Stage::kOcclusion).tested = uses(Stage::kOcclusion) ? stats.objects - of(Stage::kFrustum).culled : 0;
    stats.visible = visible.size();
    stats.seam_pixels = tiles.seam_pixels;
    uint64_t culled_objects = 0;
    for (const StageStats& stage : stats.stages) culled_objects += stage.culled;
    SIGHTLINE_ASSERT(stats.visible + culled_objects == stats.objects);
}

Query::Query(Memory* memory) : impl_(makeOwned<Impl>(memory, memory)) {}
Query::~Query() = default;
Query::Query(Query&&) noexcept = default;
Query& Query::operator=(Query&&) noexcept = default;

VisibleSet Query::visible(const Snapshot& now, const View& view) {
    const auto start = Clock::now();
    Impl& impl = *impl_;
    impl.begin(now, view);
    if (now) {
        if (isUsable(view)) impl.walk();
        else impl.keepEverything();
        impl.finish();
    }
    impl.stats.nanoseconds = since(start);
    if (view.time_stages && impl.uses(Stage::kOcclusion))
        impl.of(Stage::kOcclusion).nanoseconds = impl.stats.nanoseconds - impl.of(Stage::kFrustum).nanoseconds;
    return {impl.visible, impl.stats};
}

VisibleChanges Query::changes() {
    Impl& impl = *impl_;
    impl.appeared.clear();
    impl.disappeared.clear();
    uint32_t last = 0;
    for (const auto* set : {&impl.before, &impl.visible})
        for (const Visible& v : *set) last = std::max(last, v.id.index);
    if (impl.mark.size() <= last) impl.mark.resize(last + 1, 0);
    for (size_t i = 0; i < impl.before.size(); ++i) impl.mark[impl.before[i].id.index] = static_cast<uint32_t>(i + 1);
    for (const Visible& v : impl.visible) {
        uint32_t& mark = impl.mark[v.id.index];
        if (mark > 0 && impl.before[mark - 1].id == v.id) mark = 0;
        else impl.appeared.push_back(v);
    }
    for (const Visible& v : impl.before) {
        uint32_t& mark = impl.mark[v.id.index];
        if (mark > 0) impl.disappeared.push_back(v);
        mark = 0;
    }
    return {impl.appeared, impl.disappeared};
}

void Query::reasons(std::span<uint8_t> reasons) const {
    const Impl& impl = *impl_;
    SIGHTLINE_ASSERT(!impl.snapshot || reasons.size() >= impl.state().count);
    std::fill(reasons.begin(), reasons.end(), uint8_t{0});
    if (!impl.snapshot) return;
    const detail::SnapshotState& state = impl.state();
    for (const CulledRange& range : impl.culled)
        for (uint32_t place = range.first; place < range.first + range.count; ++place)
            reasons[state.itemOf(state.bvh.order[place])] = static_cast<uint8_t>(1 + static_cast<int>(range.stage));
    if (impl.every_layer) return;
    for (uint32_t item = 0; item < state.count; ++item)
        if (!(state.object(item).layers & impl.view.layers)) reasons[item] = 255;
}

Query::DepthImage Query::depthImage() {
    Impl& impl = *impl_;
    DepthTiles& tiles = impl.tiles;
    for (uint32_t tile = 0; tile < tiles.form.size(); ++tile) writeOut(tiles, tile);
    impl.depth_image.assign(size_t{tiles.width} * tiles.height, 0.0f);
    for (uint32_t y = 0; y < tiles.height; ++y)
        for (uint32_t x = 0; x < tiles.width; ++x) {
            const size_t tile = size_t{y / 8} * tiles.stride + x / 8;
            const uint32_t pixel = y % 8 * 8 + x % 8;
            if (tiles.coveredBits(static_cast<uint32_t>(tile)) >> pixel & 1)
                impl.depth_image[size_t{y} * tiles.width + x] = tiles.depth[64 * tile + pixel];
        }
    return {tiles.width, tiles.height, impl.depth_image};
}

}  // namespace sightline

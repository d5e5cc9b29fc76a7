// Which objects can darken what a view shows, for one light: the casters that a shadow map has to draw.
// SPDX-License-Identifier: MIT
#include "sightline/query/shadow_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/cull/contribution.h"
#include "sightline/cull/shadow_casters.h"
#include "sightline/frame/stopwatch.h"
#include "sightline/frame/traversal_state.h"
#include "sightline/geom/frustum.h"
#include "sightline/tree/descend.h"
#include "sightline/world/world_state.h"

namespace sightline {
namespace {

using detail::SnapshotState;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The part of the world that a camera's image shows, as half spaces: dot(n, p) + d >= 0, d for the given origin.
struct Cuts {
    glm::dvec4 planes[8];
    uint32_t count = 0;
    glm::dvec3 origin{0.0};

    void add(const glm::dvec3& n, double d) {
        SIGHTLINE_DEBUG_ASSERT(count < 8);
        planes[count++] = glm::dvec4(n, d);
    }
    /// The same from another origin.
    Cuts from(const glm::dvec3& other) const {
        Cuts out = *this;
        out.origin = other;
        for (uint32_t i = 0; i < count; ++i) out.planes[i].w += glm::dot(glm::dvec3(planes[i]), other - origin);
        return out;
    }
};

/// @param begin, end  distances along the direction of view between which a cascade lies
Cuts cutsOf(const View& view, double begin, double end) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view));
    const Frustum frustum = makeFrustum(view);
    Cuts cuts;
    cuts.origin = frustum.eye;
    for (uint32_t i = 0; i < frustum.count; ++i) cuts.planes[cuts.count++] = frustum.planes[i];
    const glm::dvec3 toward = glm::normalize(glm::dvec3(makeContributionMeasure(view).toward));
    // A direction in float is off by some 1e-7: cascades overlap by more than that.
    const auto wide = [](double distance) { return 1e-6 * (1.0 + std::abs(distance)); };
    if (begin > 0) cuts.add(toward, wide(begin) - begin);
    if (end < kInfinity) cuts.add(-toward, end + wide(end));
    return cuts;
}

/// Axes across a sun's rays.
glm::dmat3 sunAxes(const glm::dvec3& direction) {
    const glm::dvec3 d = glm::normalize(direction);
    const glm::dvec3 side = std::abs(d.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(d, side));
    return {x, glm::cross(x, d), d};
}

bool isUsable(const Light& light) {
    const auto finite = [](const glm::dvec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    if (!finite(light.direction) || !finite(light.position)) return false;
    const double length = glm::length(light.direction);
    if (light.kind != LightKind::kPoint && !(length > 1e-150 && length < 1e150)) return false;
    if (light.kind == LightKind::kDirectional) return true;
    if (!(light.near > 0 && light.range > light.near && light.range < 1e15)) return false;
    return light.kind == LightKind::kPoint || (light.half_angle > 0 && light.half_angle < 1.5);
}

/// The bounds of a box's corners along three axes.
Box3d alongAxes(const Box3d& box, const glm::dmat3& axes, const glm::dvec3& origin) {
    glm::dmat4 turn(glm::transpose(axes));
    turn[3] = glm::dvec4(-(glm::transpose(axes) * origin), 1.0);
    return transformBox(box, turn);
}

/// Bounds, along three axes, of the part of a box that half spaces leave: each half space in turn cuts the bounds that
/// the others have left. They are not exact.
Box3d shrink(Box3d box, const Cuts& cuts, const glm::dmat3& axes) {
    for (int round = 0; round < 3; ++round)
        for (uint32_t i = 0; i < cuts.count; ++i) {
            const glm::dvec3 n = glm::transpose(axes) * glm::dvec3(cuts.planes[i]);
            double most = cuts.planes[i].w;
            for (int axis = 0; axis < 3; ++axis) most += std::max(n[axis] * box.min[axis], n[axis] * box.max[axis]);
            if (most < -1e-9 * std::abs(cuts.planes[i].w)) return Box3d();
            for (int axis = 0; axis < 3; ++axis) {
                if (std::abs(n[axis]) < 1e-9) continue;
                // n x + (most of the others) >= 0
                const double own = std::max(n[axis] * box.min[axis], n[axis] * box.max[axis]);
                const double room = 1e-9 * (std::abs(most) + std::abs(own));
                const double limit = -(most - own + room) / n[axis];
                if (n[axis] > 0) box.min[axis] = std::max(box.min[axis], limit);
                else box.max[axis] = std::min(box.max[axis], limit);
                if (box.min[axis] > box.max[axis]) return Box3d();
                most = cuts.planes[i].w;
                for (int k = 0; k < 3; ++k) most += std::max(n[k] * box.min[k], n[k] * box.max[k]);
            }
        }
    return box;
}

}  // namespace

struct ShadowQuery::Impl {
    explicit Impl(Memory* from) : memory(from), query(from) {}

    Memory* const memory;
    Query query;  ///< of what the light sees
    ReceiverMask mask{memory};
    Array<uint32_t> bits{memory};     ///< per place: cascades that it may darken
    Array<uint8_t> why{memory};       ///< per place: how far it came with any mask; kHere with the last one
    Array<uint8_t> in_light{memory};  ///< per place: in the light's frustum, of any cascade or face
    Array<uint8_t> reasons{memory};   ///< per item, of what the light sees
    Array<detail::NodeVisit> visits{memory};
    Array<Visible> casters{memory};
    Array<uint32_t> cascades{memory};

    void begin(const SnapshotState& state);
    Box3d boxAt(const SnapshotState& state, uint32_t place) const { return detail::worldBounds(state.objectAt(place)); }
    bool fitSun(const SnapshotState& state, std::span<const Visible> receivers, const Light& light, const Cuts& cuts,
                const CasterSettings& settings, View& out) const;
    void addLight(const Snapshot& now, const View& light, std::span<const Visible> receivers, const Cuts& cuts,
                  const CasterSettings& settings, uint32_t bit);
    void addLights(const Snapshot& now, const View& view, std::span<const Visible> receivers, const Light& light,
                   const CasterSettings& settings);
    void keepAll(const SnapshotState& state, uint32_t layers);
    void walkMask(const SnapshotState& state);
    CasterStats collect(const SnapshotState& state, uint32_t layers);
};

namespace {

constexpr uint8_t kNotMet = 0, kBeside = 1, kBehind = 2, kPassed = 3, kFarthest = 3, kHere = 4;

}  // namespace

void ShadowQuery::Impl::begin(const SnapshotState& state) {
    bits.assign(state.placed.size(), 0);
    why.assign(state.placed.size(), kNotMet);
    in_light.assign(state.placed.size(), 0);
    casters.clear();
    cascades.clear();
}

/// Makes a parallel view that just holds the parts of receivers within the cuts, and all that may cast shadows on them.
/// False: no receiver lies there.
bool ShadowQuery::Impl::fitSun(const SnapshotState& state, std::span<const Visible> receivers, const Light& light,
                               const Cuts& cuts, const CasterSettings& settings, View& out) const {
    SIGHTLINE_DEBUG_ASSERT(!state.bvh.nodes.empty() && settings.mask_size > 0);
    const glm::dmat3 axes = sunAxes(light.direction);
    Box3d lit;
    for (const Visible& receiver : receivers) {
        const uint32_t place = state.placeOf(receiver.id);
        if (place == PlacedBvh::kNone) continue;
        lit.grow(shrink(alongAxes(boxAt(state, place), axes, cuts.origin), cuts, axes));
    }
    if (lit.empty()) return false;
    Box3d world;
    const BvhNode& root = state.bvh.nodes[0];
    for (int slot = 0; slot < 8; ++slot)
        for (int axis = 0; root.count[slot] > 0 && axis < 3; ++axis) {
            world.min[axis] = std::min(world.min[axis], root.min[axis][slot] + state.bvh.origin[axis]);
            world.max[axis] = std::max(world.max[axis], root.max[axis][slot] + state.bvh.origin[axis]);
        }
    const double first = alongAxes(world, axes, cuts.origin).min.z;
    const glm::dvec3 size = lit.size();
    const double room = 1e-6 * (1.0 + std::max({size.x, size.y, lit.max.z - first})), longer = std::max(size.x, size.y);
    // A texel of room for what a filter reaches and for thin receivers.
    const double margin = settings.filter + room + 2.0 * longer / settings.mask_size;
    const glm::dvec2 across(size.x + 2 * margin, size.y + 2 * margin);
    const double texel = std::max(across.x, across.y) / settings.mask_size;
    out.width = std::clamp(static_cast<uint32_t>(std::ceil(across.x / texel)), 1u, settings.mask_size);
    out.height = std::clamp(static_cast<uint32_t>(std::ceil(across.y / texel)), 1u, settings.mask_size);
    const glm::dvec3 middle(lit.center().x, lit.center().y, first - 2 * room);
    const glm::dvec3 eye = cuts.origin + axes * middle;
    out.view = glm::dmat4(glm::transpose(glm::dmat3(axes[0], axes[1], -axes[2])));
    out.view[3] = glm::dvec4(-(glm::dmat3(out.view) * eye), 1.0);
    const double z_far = lit.max.z - middle.z + settings.bias + 2 * room;
    out.projection = orthographic(across.y, across.x / across.y, room, z_far);
    return true;
}

/// Notes how far each object comes by the mask; whole subtrees where the mask culls a node.
void ShadowQuery::Impl::walkMask(const SnapshotState& state) {
    SIGHTLINE_DEBUG_ASSERT(why.size() == state.placed.size());
    const auto note = [&](const BvhNode& node, int slot, uint8_t answer) {
        for (uint32_t place = node.first[slot]; place < node.first[slot] + node.count[slot]; ++place) {
            why[place] = std::max<uint8_t>(why[place], answer);
            if (answer == kPassed) why[place] |= kHere;
        }
    };
    visits.assign(1, {});
    descendByLevels(state.bvh.nodes, visits, [&](const detail::NodeVisit& visit) {
        const BvhNode& node = state.bvh.nodes[visit.node];
        forEachSlot(usedSlots(node), [&](int slot) {
            Box3d box;
            for (int axis = 0; axis < 3; ++axis) {
                box.min[axis] = node.min[axis][slot] + state.bvh.origin[axis];
                box.max[axis] = node.max[axis][slot] + state.bvh.origin[axis];
            }
            if (!(node.child[slot] & BvhNode::kLeaf)) {
                if (mask.mayHoldCaster(box)) visits.push_back({node.child[slot]});
                else note(node, slot, kBeside);
                return;
            }
            const CasterAnswer said = mask.ask(box);
            note(node, slot,
                 said == CasterAnswer::kMayDarken         ? kPassed
                 : said == CasterAnswer::kBehindReceivers ? kBehind
                                                          : kBeside);
        });
    });
}

/// @param light  its view, with the mask's size
void ShadowQuery::Impl::addLight(const Snapshot& now, const View& light, std::span<const Visible> receivers,
                                 const Cuts& cuts, const CasterSettings& settings, uint32_t bit) {
    const SnapshotState& state = now.state();
    SIGHTLINE_DEBUG_ASSERT(bit != 0 && isUsable(light));
    const LightGrid grid = makeLightGrid(light);
    const double texel = glm::length(grid.step[0]);  // of a parallel view, or at distance one
    mask.begin(grid, settings.filter / texel, settings.bias);
    const Cuts here = cuts.from(grid.eye);
    for (const Visible& receiver : receivers) {
        const uint32_t place = state.placeOf(receiver.id);
        mask.addReceiver(place == PlacedBvh::kNone ? Box3d() : boxAt(state, place), {here.planes, here.count});
    }
    mask.finish();
    for (uint8_t& known : why) known &= kFarthest;
    walkMask(state);

    View seen = light;
    seen.jitter = 0.5;
    QuerySettings how;
    how.stages =
        settings.occlusion ? stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion) : stageBit(Stage::kFrustum);
    how.second_look = false;  // nor are clusters: a surface casts with both sides, and would be asked by one
    how.occlusion_size = std::max(seen.width, seen.height);
    const VisibleSet set = query.visible(now, seen, how);
    for (const Visible& object : set.objects) {
        const uint32_t place = state.placeOf(object.id);
        if (place == PlacedBvh::kNone) continue;  // kept in any case
        if (why[place] & kHere) bits[place] |= bit;
    }
    reasons.resize(state.count);
    query.reasons(reasons);
    for (uint32_t place = 0; place < in_light.size(); ++place) {
        if (state.bvh.order[place] == PlacedBvh::kNone) continue;
        const uint8_t reason = reasons[state.itemAt(place)];
        in_light[place] |= reason == 0 || reason == 1 + static_cast<uint8_t>(Stage::kOcclusion);
    }
}

/// A view of each cascade of a sun, of a spot's cone, or of the six faces around a point.
void ShadowQuery::Impl::addLights(const Snapshot& now, const View& view, std::span<const Visible> receivers,
                                  const Light& light, const CasterSettings& settings) {
    begin(now.state());
    View seen;
    seen.layers = view.layers;
    if (light.kind == LightKind::kDirectional) {
        const size_t count = std::max<size_t>(1, std::min<size_t>(settings.cascades.size(), 32));
        for (size_t k = 0; k < count; ++k) {
            const double first = k > 0 ? settings.cascades[k - 1] : 0.0;
            const double end = settings.cascades.empty() ? kInfinity : settings.cascades[k];
            const Cuts cuts = cutsOf(view, first, end);
            if (fitSun(now.state(), receivers, light, cuts, settings, seen))
                addLight(now, seen, receivers, cuts, settings, 1u << k);
        }
        return;
    }
    const Cuts cuts = cutsOf(view, 0, kInfinity);
    seen.width = seen.height = settings.mask_size;
    if (light.kind == LightKind::kSpot) {
        seen.view = lookAt(light.position, light.position + glm::normalize(light.direction), {0, 1, 0});
        seen.projection = perspective(2.0 * light.half_angle, 1.0, light.near, light.range);
        return addLight(now, seen, receivers, cuts, settings, 1);
    }
    for (uint32_t face = 0; face < 6; ++face) {
        glm::dvec3 toward(0.0);
        toward[static_cast<int>(face / 2)] = face % 2 ? -1.0 : 1.0;
        seen.view = lookAt(light.position, light.position + toward, {0, 1, 0});
        seen.projection = perspective(1.5707963267948966, 1.0, light.near, light.range);
        addLight(now, seen, receivers, cuts, settings, 1u << face);
    }
}

void ShadowQuery::Impl::keepAll(const SnapshotState& state, uint32_t layers) {
    for (uint32_t item = 0; item < state.count; ++item) {
        const detail::ObjectRecord& object = state.object(item);
        if (!(object.layers & layers)) continue;
        casters.push_back({object.key, object.id});
        cascades.push_back(~0u);
    }
}

CasterStats ShadowQuery::Impl::collect(const SnapshotState& state, uint32_t layers) {
    CasterStats stats;
    SIGHTLINE_DEBUG_ASSERT(bits.size() == state.placed.size() && in_light.size() == bits.size() &&
                           why.size() == bits.size());
    for (uint32_t place = 0; place < bits.size(); ++place) {
        const detail::PlacedObject& object = state.placed[place];
        if (!(object.layers & layers)) continue;
        if (bits[place] != 0) {
            casters.push_back(object.visible);
            cascades.push_back(bits[place]);
        } else if (in_light[place]) {
            const uint8_t known = why[place] & kFarthest;
            stats.in_shadow += known == kPassed;
            stats.behind += known == kBehind;
            stats.beside += known <= kBeside;
        }
    }
    for (const uint32_t row : state.unbounded) {
        const detail::ObjectRecord& object = state.objects[row];
        if (!(object.layers & layers)) continue;
        casters.push_back({object.key, object.id});
        cascades.push_back(~0u);
    }
    stats.in_light = casters.size() + stats.in_shadow + stats.behind + stats.beside;
    return stats;
}

ShadowQuery::ShadowQuery(Memory* memory) : impl_(makeOwned<Impl>(memory, memory)) {}
ShadowQuery::~ShadowQuery() = default;
ShadowQuery::ShadowQuery(ShadowQuery&&) noexcept = default;
ShadowQuery& ShadowQuery::operator=(ShadowQuery&&) noexcept = default;

CasterSet ShadowQuery::casters(const Snapshot& now, const View& view, std::span<const Visible> receivers,
                               const Light& light, const CasterSettings& settings) {
    Impl& impl = *impl_;
    CasterSet out;
    impl.casters.clear();
    impl.cascades.clear();
    if (!now) return out;
    const detail::Stopwatch watch;
    const SnapshotState& state = now.state();
    CasterSettings limited = settings;
    // A renderer may cut casters as it cuts what it shows: a caster that is cut shadows less than a whole one.
    limited.occlusion = settings.occlusion && view.sections.count == 0;
    limited.mask_size = std::clamp(settings.mask_size, 1u, 4096u);
    limited.filter = settings.filter > 0 && settings.filter < kInfinity ? settings.filter : 0.0;
    limited.bias = settings.bias > 0 && settings.bias < kInfinity ? settings.bias : 0.0;
    if (!isUsable(view) || !isUsable(light)) impl.keepAll(state, view.layers);
    else if (!state.bvh.nodes.empty()) impl.addLights(now, view, receivers, light, limited);
    if (state.bvh.nodes.empty()) impl.begin(state);
    if (isUsable(view) && isUsable(light)) out.stats = impl.collect(state, view.layers);
    out.stats.receivers = receivers.size();
    out.stats.nanoseconds = watch.nanoseconds();
    out.casters = impl.casters;
    out.cascades = impl.cascades;
    return out;
}

}  // namespace sightline

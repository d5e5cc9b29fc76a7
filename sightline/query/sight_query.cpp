// Questions without an image: whether something stands between two points, and what may be seen from a region.
// SPDX-License-Identifier: MIT
#include "sightline/query/sight_query.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cells/pvs.h"
#include "sightline/math/finite.h"
#include "sightline/tree/descend.h"
#include "sightline/world/seen_objects.h"
#include "sightline/world/world_state.h"

namespace sightline {
namespace {

using detail::ObjectRecord;
using detail::SnapshotState;

double farOf(const glm::dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

/// A segment against boxes: what it misses blocks nothing, so that rounding does no harm.
class BoxLine {
public:
    BoxLine(const glm::dvec3& from, const glm::dvec3& to) : from_(from) {
        const glm::dvec3 way = to - from;
        for (int axis = 0; axis < 3; ++axis)
            inverse_[axis] = std::abs(way[axis]) > 1e-300 ? 1 / way[axis] : std::copysign(1e300, way[axis]);
    }
    template <class T>
    bool meets(const Box<T>& box) const {
        constexpr double kSlack = 1e-6;
        double enter = -kSlack, leave = 1 + kSlack;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (static_cast<double>(box.min[axis]) - from_[axis]) * inverse_[axis],
                         b = (static_cast<double>(box.max[axis]) - from_[axis]) * inverse_[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave + kSlack;
    }

private:
    glm::dvec3 from_, inverse_;
};

/// A segment against triangles in the world, with room for what rounding may have moved.
class ExactLine {
public:
    /// @param error  no coordinate of a triangle is off by more
    ExactLine(const glm::dvec3& from, const glm::dvec3& to, double error)
        : from_(from), way_(to - from), error_(error) {}

    /// Whether it passes the inside of a triangle, or of two triangles 0 1 2 and 0 2 3, from the side that sees them
    /// counter-clockwise. Where it goes round no side of the outline the wrong way, the outline winds around it, and so
    /// it meets a triangle; it does so between its ends, for these are on both sides of both planes.
    bool passes(const glm::dvec3* corners, int count) const {
        SIGHTLINE_DEBUG_ASSERT((count == 3 || count == 4) && error_ >= 0);
        const double way = farOf(way_);
        double size = 0, far = way;
        for (int i = 0; i < count; ++i) {
            size = std::max(size, farOf(corners[i] - corners[0]));
            far = std::max(far, way + farOf(corners[i] - from_));
        }
        // Volumes are sums of six products of three lengths, of which two are off by `error` at most.
        const double error = 64 * (error_ + 0x1p-50 * far), least = size * far * error;
        for (int i = 2; i < count; ++i) {
            const glm::dvec3 across = glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
            if (!(glm::dot(across, from_ - corners[0]) > least)) return false;
            if (!(glm::dot(across, from_ + way_ - corners[0]) < -least)) return false;
        }
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 a = corners[i] - from_, b = corners[(i + 1) % count] - from_;
            if (!(glm::dot(way_, glm::cross(b, a)) > way * far * error)) return false;
        }
        return true;
    }

private:
    glm::dvec3 from_, way_;
    double error_;
};

bool blocks(const Occluder& occluder, const glm::dmat4& transform, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dmat4 back = glm::inverse(transform);
    const BoxLine near(glm::dvec3(back * glm::dvec4(from, 1)), glm::dvec3(back * glm::dvec4(to, 1)));
    double far = std::max(farOf(from), farOf(to)) + farOf(glm::dvec3(transform[3]));
    for (int column = 0; column < 3; ++column)
        far +=
            farOf(glm::dvec3(transform[column])) * std::max(std::abs(static_cast<double>(occluder.bounds.min[column])),
                                                            std::abs(static_cast<double>(occluder.bounds.max[column])));
    const ExactLine line(from, to, 0x1p-50 * far);
    const bool mirrored = glm::determinant(glm::dmat3(transform)) < 0;
    for (const OccluderCluster& cluster : occluder.clusters) {
        if (!near.meets(cluster.bounds)) continue;
        for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p) {
            const OccluderPolygon& polygon = occluder.polygons[p];
            glm::dvec3 corners[4];
            for (int i = 0; i < polygon.corners(); ++i) {
                const uint32_t v = cluster.first_vertex + polygon.vertex[i];
                SIGHTLINE_DEBUG_ASSERT(polygon.vertex[i] < cluster.vertex_count && v < occluder.x.size());
                corners[i] = glm::dvec3(transform * glm::dvec4(occluder.x[v], occluder.y[v], occluder.z[v], 1));
            }
            if (mirrored) std::reverse(corners, corners + polygon.corners());
            if (line.passes(corners, polygon.corners())) return true;
            if (!polygon.double_sided) continue;
            std::reverse(corners, corners + polygon.corners());
            if (line.passes(corners, polygon.corners())) return true;
        }
    }
    return false;
}

}  // namespace

struct SightQuery::Impl {
    Array<uint32_t> waiting, cells;
    Array<uint64_t> rows;  ///< of objects: a bit for each that was found
    Array<Visible> objects;
    PotentiallyVisible by_cells, by_objects;
    std::shared_ptr<const detail::AttachedCells> rows_of;

    explicit Impl(Memory* memory)
        : waiting(memory), cells(memory), rows(memory), objects(memory), by_cells(memory), by_objects(memory) {}

    bool findCells(const SnapshotState& now, const Box3d& region, uint32_t layers);
    void takeAll(const SnapshotState& now, uint32_t layers);
    void takeSeen(const SnapshotState& now, uint32_t layers);
};

SightQuery::SightQuery(Memory* memory) : impl_(makeOwned<Impl>(memory, memory)) {}
SightQuery::~SightQuery() = default;
SightQuery::SightQuery(SightQuery&&) noexcept = default;
SightQuery& SightQuery::operator=(SightQuery&&) noexcept = default;

SightLine SightQuery::look(const Snapshot& now, const glm::dvec3& from, const glm::dvec3& to,
                           const SightSettings& settings) {
    if (!now || !isFinite(from) || !isFinite(to)) return {};
    const SnapshotState& state = now.state();
    if (state.bvh.nodes.empty()) return {};
    const BoxLine line(from - state.bvh.origin, to - state.bvh.origin);
    SightLine found;
    Array<uint32_t>& waiting = impl_->waiting;
    waiting.assign(1, 0);
    while (!waiting.empty() && !found.blocked) {
        const BvhNode& node = state.bvh.nodes[waiting.back()];
        waiting.pop_back();
        forEachSlot(usedSlots(node), [&](int slot) {
            if (found.blocked || !line.meets(slotBox(node, slot))) return;
            const uint32_t child = node.child[slot];
            if ((child & BvhNode::kLeaf) == 0) return waiting.push_back(child);
            const detail::PlacedObject& placed = state.placed[node.first[slot]];
            if (!(placed.layers & settings.layers) || placed.occluder.index == 0) return;
            if (std::find(settings.ignored.begin(), settings.ignored.end(), placed.visible.id) !=
                settings.ignored.end())
                return;
            const ObjectRecord& object = state.objectAt(node.first[slot]);
            if (!blocks(*state.occluders[placed.occluder.index], object.transform, from, to)) return;
            found = {true, placed.visible};
        });
    }
    return found;
}

/// Finds the rows that tell what is seen from a region; false if nothing does.
bool SightQuery::Impl::findCells(const SnapshotState& now, const Box3d& region, uint32_t layers) {
    const detail::CellState& state = now.cell_state;
    if (rows_of != state.cells) {
        by_cells.clear();
        by_objects.clear();
    }
    rows_of = state.cells;  // or none: what is kept of another world goes, whose memory may
    if (!state.cells || !region.finite() || region.empty()) return false;
    if (!state.walls_stand || (state.has_walls && !(now.common_layers & layers))) return false;
    const auto& views = state.cells->views;
    if (!views && !state.cells->hasRows()) return false;
    glm::dvec3 corners[8];
    for (int i = 0; i < 8; ++i)
        corners[i] = {i & 1 ? region.max.x : region.min.x, i & 2 ? region.max.y : region.min.y,
                      i & 4 ? region.max.z : region.min.z};
    if (!(views ? views->graph : state.cells->graph).cellsAround(corners, 0, cells)) return false;
    if (views) by_objects.update(views->graph, *views, cells);
    else by_cells.update(state.cells->graph, state.cells->rows, cells);
    return (views ? by_objects : by_cells).known();
}

void SightQuery::Impl::takeAll(const SnapshotState& now, uint32_t layers) {
    objects.clear();
    for (uint32_t item = 0; item < now.count; ++item) {
        const ObjectRecord& object = now.object(item);
        if (object.layers & layers) objects.push_back({object.key, object.id});
    }
}

/// Writes the objects that the rows show, those that are in no cell, and those without bounds.
void SightQuery::Impl::takeSeen(const SnapshotState& now, uint32_t layers) {
    rows.assign((now.objects.size() + 63) / 64, 0);
    const auto take = [&](uint32_t row) {
        SIGHTLINE_DEBUG_ASSERT(row < now.objects.size());
        rows[row / 64] |= uint64_t{1} << row % 64;
    };
    detail::forEachSeenObject(now.cell_state, by_cells, by_objects, take);
    for (const uint32_t row : now.unbounded) take(row);
    if (now.cell_state.free_count > 0)
        now.cell_state.free.forEachWord(0, now.bvh.order.size(), [&](uint32_t word, uint64_t bits) {
            for (; bits; bits &= bits - 1)
                take(now.bvh.order[64 * word + static_cast<uint32_t>(std::countr_zero(bits))]);
        });
    objects.clear();
    for (size_t word = 0; word < rows.size(); ++word)
        for (uint64_t bits = rows[word]; bits; bits &= bits - 1) {
            const ObjectRecord& object = now.objects[64 * word + static_cast<size_t>(std::countr_zero(bits))];
            if (object.layers & layers) objects.push_back({object.key, object.id});
        }
}

RegionSet SightQuery::seenFrom(const Snapshot& now, const Box3d& region, uint32_t layers) {
    if (!now) return {};
    const SnapshotState& state = now.state();
    Impl& impl = *impl_;
    const bool known = impl.findCells(state, region, layers);
    if (known) impl.takeSeen(state, layers);
    else impl.takeAll(state, layers);
    return {impl.objects, known};
}

}  // namespace sightline

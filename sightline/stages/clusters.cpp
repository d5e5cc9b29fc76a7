// The stage of clusters: of kept objects only the clusters that face the eye, lie in the view and are not hidden.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998.
#include "sightline/base/assert.h"
#include "sightline/stages/stage_memory.h"

#include <algorithm>
#include <bit>

#include "sightline/cull/facing_clusters.h"
#include "sightline/stages/pipeline.h"

namespace sightline::detail {
namespace {

/// Eight clusters' bounds from one on.
EyeBoxes boundsOf(const DrawClusters& clusters, size_t first) {
    SIGHTLINE_DEBUG_ASSERT(first % 8 == 0 && first + 8 <= clusters.stride);
    EyeBoxes boxes;
    for (int axis = 0; axis < 3; ++axis) {
        std::copy_n(clusters.row(DrawClusters::kMin + axis) + first, 8, boxes.min[axis]);
        std::copy_n(clusters.row(DrawClusters::kMax + axis) + first, 8, boxes.max[axis]);
    }
    return boxes;
}

uint64_t countBits(std::span<const uint8_t> bytes) {
    uint64_t count = 0;
    for (const uint8_t byte : bytes) count += static_cast<uint64_t>(std::popcount(byte));
    return count;
}

/// Whether neither the near plane nor a section cuts a box: then the eye is outside of the solid in it.
/// @param object  the view's buffer seen from the box's space; null: there is none
bool seesOutside(const Box3f& box, const Screen* object, const View& view) {
    if (!object || view.sections.count > 0) return false;
    Screen guarded = *object;
    guarded.near.w -= 2.0 * guarded.near_guard;
    const BoxAnswer answer = projectBox(guarded, box);
    return !answer.doubt && !answer.outside;
}

/// Whether a rectangle is hidden in each part of the image that it meets, and meets one.
bool isHiddenInAll(std::span<DepthTiles* const> parts, const PixelRect& rect) {
    bool meets = false;
    for (DepthTiles* const tiles : parts) {
        PixelRect here = rect;
        if (!tiles->clip(here)) continue;
        if (!isHidden(*tiles, here, Seams::kLeave)) return false;
        meets = true;
    }
    return meets;
}

}  // namespace

/// Leaves the clusters of which some triangle may be seen from its front.
void ClusterMemory::findFacing(const DrawClusters& clusters, const ObjectRecord& object, const View& view,
                               const Screen* screen, QueryStats& stats) {
    const size_t count = clusters.count();
    SIGHTLINE_DEBUG_ASSERT(clusters.first.size() == count + 1 && clusters.facing.count() <= count);
    // The facing tests write whole sixteens.
    left_.assign((std::max(count, clusters.facing.count()) + 15) / 16 * 2, 0);
    findBackClusters(clusters.facing, facingEye(view, object.transform), kAllFacingTests, left_);
    for (const ClosedClusters& solid : clusters.closed) {
        SIGHTLINE_DEBUG_ASSERT(size_t{solid.first} + solid.count <= clusters.facing.count());
        if (seesOutside(solid.box, screen, view)) continue;
        for (uint32_t i = solid.first; i < solid.first + solid.count; ++i)
            left_[i / 8] &= static_cast<uint8_t>(~(1u << i % 8));
    }
    stats.clusters_back += countBits(left_);
    for (uint8_t& byte : left_) byte = static_cast<uint8_t>(~byte);
    for (size_t i = count; i < 8 * left_.size(); ++i) left_[i / 8] &= static_cast<uint8_t>(~(1u << i % 8));
}

/// Leaves, of these, the clusters that lie in the view and are not hidden.
void ClusterMemory::findSeen(const DrawClusters& clusters, const Frame& frame, const Screen& screen,
                             std::span<DepthTiles* const> tiles, QueryStats& stats) {
    const bool frustum = frame.uses(Stage::kFrustum), occlusion = frame.uses(Stage::kOcclusion);
    if (!frustum && !occlusion) return;
    SIGHTLINE_DEBUG_ASSERT(8 * left_.size() >= clusters.count());
    for (size_t byte = 0; 8 * byte < clusters.count(); ++byte) {
        if (left_[byte] == 0) continue;
        const ScreenAnswer on_screen = projectBoxes(screen, boundsOf(clusters, 8 * byte));
        for (uint32_t bits = left_[byte]; bits; bits &= bits - 1) {
            const int which = std::countr_zero(bits);
            const uint8_t bit = static_cast<uint8_t>(1u << which);
            if (on_screen.outside & bit) {
                if (!frustum) continue;
                ++stats.clusters_outside;
            } else {
                if (!occlusion || on_screen.doubt & bit || !isHiddenInAll(tiles, on_screen.rects[which])) continue;
                ++stats.clusters_hidden;
            }
            left_[byte] &= static_cast<uint8_t>(~bit);
        }
    }
}

/// Writes the runs of the clusters that are left.
void ClusterMemory::addRanges(const DrawClusters& clusters, uint32_t gap, uint32_t visible, QueryStats& stats) {
    const size_t begin = ranges_.size();
    for (size_t i = 0; i < clusters.count(); ++i) {
        if (!(left_[i / 8] >> i % 8 & 1)) continue;
        const uint32_t first = clusters.first[i], end = clusters.first[i + 1], part = clusters.part[i];
        SIGHTLINE_DEBUG_ASSERT(first <= end && end <= clusters.triangles.size());
        if (ranges_.size() > begin) {
            DrawRange& last = ranges_.back();
            if (last.part == part && first - (last.first + last.count) <= gap) {
                last.count = end - last.first;
                continue;
            }
        }
        ranges_.push_back({visible, first, end - first, part});
    }
    for (size_t i = begin; i < ranges_.size(); ++i) stats.drawn_triangles += ranges_[i].count;
    stats.draw_ranges += ranges_.size() - begin;
}

/// @returns whether something is left of the object
bool ClusterMemory::select(const Frame& frame, const DrawClusters& clusters, const ObjectRecord& object,
                           std::span<DepthTiles* const> tiles, uint32_t visible, QueryStats& stats) {
    stats.clusters_tested += clusters.count();
    Screen placed;
    if (frame.usable) placed = objectScreen(frame.screen, object.transform);
    findFacing(clusters, object, frame.view, frame.usable ? &placed : nullptr, stats);
    if (frame.usable) findSeen(clusters, frame, placed, tiles, stats);
    if (countBits(left_) == 0) return false;
    stats.cluster_triangles += clusters.triangles.size();
    addRanges(clusters, frame.settings.cluster_gap, visible, stats);
    return true;
}

QueryStats ClusterMemory::look(const Frame& frame, uint32_t row, AnswerView& answer) {
    QueryStats stats;
    SIGHTLINE_DEBUG_ASSERT(frame.world && row < frame.world->objects.size());
    const ObjectRecord& object = frame.world->objects[row];
    if (object.clusters.index == 0 || !frame.usable || !frame.uses(Stage::kClusters)) return stats;
    const size_t before = ranges_.size();
    select(frame, *frame.world->clusters[object.clusters.index], object, answer.tiles, 0, stats);
    ranges_.resize(before);
    return stats;
}

void ClusterMemory::clear() {
    ranges_.clear();
    culled_.clear();
}

void ClusterMemory::run(const Frame& frame, AnswerView& answer) {
    SIGHTLINE_DEBUG_ASSERT(answer.lods.empty() || answer.lods.size() == answer.visible.size());
    SIGHTLINE_DEBUG_ASSERT(ranges_.empty() && culled_.empty());
    size_t left = 0;
    for (size_t i = 0; i < answer.visible.size(); ++i) {
        const Visible v = answer.visible[i];
        const bool coarse = !answer.lods.empty() && (answer.lods[i].level > 0 || answer.lods[i].from > 0);
        const uint32_t row = frame.world->find(v.id);
        SIGHTLINE_DEBUG_ASSERT(row != IdSlot::kNowhere);
        const ObjectRecord& object = frame.world->objects[row];
        const DrawClusters* clusters = frame.world->clusters[object.clusters.index].get();
        if (!answer.lods.empty()) answer.lods[left] = answer.lods[i];
        if (clusters && !coarse &&
            !select(frame, *clusters, object, answer.tiles, static_cast<uint32_t>(left), answer.stats))
            culled_.push_back(row);
        else answer.visible[left++] = v;
    }
    answer.visible.resize(left);
    answer.stats.of(Stage::kClusters).culled = culled_.size();
    SIGHTLINE_DEBUG_ASSERT(answer.stats.visible >= culled_.size());
    answer.stats.visible -= culled_.size();
}

void ClusterMemory::reasons(const SnapshotState& now, std::span<uint8_t> reasons) const {
    for (const uint32_t row : culled_) reasons[now.itemOf(row)] = 1 + static_cast<uint8_t>(Stage::kClusters);
}

void cullClusters(const Frame& frame, StageMemory& memory, AnswerView& answer) {
    if (frame.world->clusters.size() > 1) memory.clusters.run(frame, answer);
}

}  // namespace sightline::detail
